/* Size of one estimator in bytes for the GOE_WINDOW_MAX of this compilation. */
#include <stdio.h>

#include "goe.h"

int main(void) {
    printf("%lu\n", (unsigned long)sizeof(goe_estimator_t));
    return 0;
}

/* Bytes of one estimator at the GOE_WINDOW_MAX that this file is compiled with. */
#include <stdio.h>

#include "goe.h"

int main(void) {
    printf("%lu\n", (unsigned long)sizeof(goe_estimator_t));
    return 0;
}

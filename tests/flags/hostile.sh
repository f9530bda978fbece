#!/usr/bin/env bash
# Compiles the library, the flight layer and its MAVLink messages among other people's macros, and with the poorest C library that
# it may meet: sqrtf, memcpy, memset and the compiler's own headers, everything undeclared an error. Public headers in C++ too. Macros and
# declarations concern the front end alone, so no code is generated. gcc reads C99 with this machine's C library, clang GNU C17 with the
# poor one; with GOE_LONG=1 each compiler reads both standards with both libraries.
set -euo pipefail
. "$(dirname "$0")/common.sh"
here=$root/tests/flags
warnings=(-Wall -Wextra -Wundef -Wshadow -Werror)

cd "$scratch"
cat >header.cpp <<'END'
#include "goe_flight.h"
#include "goe_mavlink_map.h"
int main() { return goe_flight_action_text(GOE_FLIGHT_NONE) == nullptr; }
END

compiled=0
# compile <compiler> <flag>...: every source
compile() {
    "$@" "${warnings[@]}" "${all_includes[@]}" -fsyntax-only "${all_sources[@]}" || fail "$*"
    compiled=$((compiled + ${#all_sources[@]}))
}

# poor <compiler> <flag>...: only the compiler's own headers and the minimal library's
poor() {
    local own
    own=$("$1" -print-file-name=include)
    compile "$@" -nostdinc -isystem "$own" -isystem "$here/poor_c_library" -ffreestanding \
        -Werror=implicit-function-declaration
}

for compiler in $(compilers gcc clang-19); do
    if [ -n "${GOE_LONG:-}" ]; then
        for standard in c99 gnu17; do
            compile "$compiler" -std=$standard -include "$here/hostile.h"
            poor "$compiler" -std=$standard -include "$here/hostile.h"
        done
    elif [ "$compiler" = gcc ]; then
        compile gcc -std=c99 -include "$here/hostile.h"
    else
        poor "$compiler" -std=gnu17 -include "$here/hostile.h"
    fi
done
for compiler in $(compilers g++ clang++-19); do
    for standard in c++11 c++17; do
        "$compiler" -std=$standard "${warnings[@]}" -include "$here/hostile.h" "${all_includes[@]}" -fsyntax-only header.cpp ||
            fail "$compiler -std=$standard: the public headers"
    done
done
if command -v arm-none-eabi-gcc >/dev/null; then
    poor arm-none-eabi-gcc -std=c99 -include "$here/hostile.h" -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 \
        -mfloat-abi=hard
fi
[ $compiled -gt 0 ] || exit 77

# The test itself must detect errors: a file that uses such a name, or calls a function that the minimal library lacks, must not compile.
echo 'enum { NEAR }; int probe(void);' >macro.c
! gcc -include "$here/hostile.h" -fsyntax-only macro.c 2>/dev/null || fail "hostile.h does not notice NEAR"
printf '#include <math.h>\nfloat probe(float x);\nfloat probe(float x) { return fabsf(x); }\n' >call.c
! gcc -std=c99 -nostdinc -isystem "$here/poor_c_library" -ffreestanding -fno-builtin \
    -Werror=implicit-function-declaration -fsyntax-only call.c 2>/dev/null || fail "the poor library does not notice fabsf"
echo "hostile macros and a poor C library: $compiled compilations without a warning"

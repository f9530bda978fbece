#!/usr/bin/env bash
# The self-check reports the effects of flags and modes of the floating-point unit on the library on this machine. If it
# reports nothing, the replay's hash must be the golden one: then the flag has changed nothing.
#
#   host_self_check.sh <golden hash>
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../flags/common.sh"
golden=$1

contracted=0x01u reassociated=0x02u reciprocal=0x04u flushed=0x08u excess=0x10u rounding=0x20u any=0x3Fu
machine=
failed=0
ran=0

# objects <folder> <flag>... -- <file>...: compiles the files into the folder, once for all uses
objects() {
    local folder=$1 flags=()
    shift
    while [ "$1" != -- ]; do
        flags+=("$1")
        shift
    done
    shift
    [ ! -d "$folder" ] || return 0
    mkdir "$folder"
    (cd "$folder" && "$compiler" "${flags[@]}" -I"$root/lib" -I"$here" -c "$@")
}

# prove <name> <mode> <expected bits> <allowed bits> <strict|loose> <link flags> <compiler> <flag>...
#   strict: the bits must be reported; loose: or the hash is golden
prove() {
    local name=$1 mode=$2 expected=$3 allowed=$4 strict=$5 link=$6 compiler=$7
    shift 7
    local library judge rest
    local define=(-DMODE="MODE_$mode" -DEXPECTED="$expected" -DALLOWED="$allowed")
    [ "$strict" = strict ] || define+=(-DGOLDEN="0x${golden}u")
    command -v "$compiler" >/dev/null || return 0
    # If only the hash can show that a flag has no effect, the whole library is compiled with it.
    local checked=("$root/lib/goe_self_check.c")
    [ "$strict" = strict ] || checked=("${library_sources[@]}")
    library="$scratch/library $strict $compiler $*"
    objects "$library" -std=gnu99 -O2 -ffp-contract=off -fno-math-errno "$@" -- "${checked[@]}"
    # The judging program is compiled without special flags.
    judge="$scratch/judge $compiler $machine"
    # shellcheck disable=SC2086 # several flags or none
    objects "$judge" -std=gnu99 -O1 -ffp-contract=off $machine -- "$here/replay.c" "$here/embedded_logs.c"
    # The rest of the library.
    rest="$scratch/rest $compiler $machine"
    # shellcheck disable=SC2086 # several flags or none
    objects "$rest" -std=gnu99 -O1 -ffp-contract=off $machine -- "${library_sources[@]}"
    [ -e "$rest/rest.a" ] || ar rcs "$rest/rest.a" "$rest"/*.o
    # shellcheck disable=SC2086 # several flags or none
    "$compiler" -std=gnu99 -O1 -ffp-contract=off $machine "${define[@]}" -I"$root/lib" -I"$here" \
        "$here/self_check_main.c" "$judge"/*.o "$library"/*.o "$rest/rest.a" $link -lm -o "$scratch/check"
    ran=$((ran + 1))
    echo -n "$name, $compiler $*: "
    if ! "$scratch/check"; then
        echo "FAILED: $name: $compiler $*" >&2
        failed=1
    fi
}

for compiler in gcc clang-19; do
    strict=strict
    [ $compiler = gcc ] || strict=loose # clang ignores some flags
    prove plain NONE 0u 0u strict "" $compiler
    prove "rounding up" UP $rounding $any strict "" $compiler
    prove "rounding down" DOWN $rounding $any strict "" $compiler
    prove "rounding to zero" TO_ZERO $rounding $any strict "" $compiler
    if [ "$(uname -m)" = x86_64 ]; then
        if grep -qw fma /proc/cpuinfo; then
            prove contraction NONE $contracted 0u strict "" $compiler -mfma -ffp-contract=fast
        fi
        prove "subnormal results to zero" FLUSH $flushed 0u strict "" $compiler
        prove "subnormal operands to zero" FLUSH_OPERANDS $flushed 0u strict "" $compiler
    fi
    prove reciprocals NONE $reciprocal 0u $strict "" $compiler -freciprocal-math
    prove "fast math" NONE $reassociated $any strict "" $compiler -ffast-math
    prove "fast math at -O3" NONE $reassociated $any strict "" $compiler -O3 -ffast-math
    prove "reordering" NONE $reassociated $any strict "" $compiler -fassociative-math -fno-signed-zeros \
        -fno-trapping-math
done
if [ "$(uname -m)" = x86_64 ]; then
    # at link time alone: gcc's start-up code switches the processor
    prove "fast math at link time" NONE $flushed 0u strict -ffast-math gcc
    prove "x87" NONE $excess $any strict "" gcc -mfpmath=387
    if echo '#include <math.h>' | gcc -m32 -x c - -fsyntax-only 2>/dev/null; then
        machine=-m32
        prove "x87, 32 bit" NONE $excess $any strict "" gcc -m32 -mfpmath=387
    else
        echo "skipped: x87, 32 bit: there is no 32-bit C library here (gcc-multilib)"
    fi
fi
[ $ran -gt 0 ] || exit 77
exit $failed

#!/usr/bin/env bash
# Checks the external symbols of the library's objects, and that they contain no writable data.
#
#   symbols.sh host|arm     gcc and clang of this machine, or the cross compiler for the Cortex-M4F
#
# On the host gcc compiles at -O0, clang at -O2; with GOE_LONG=1 each compiles at all three levels.
set -euo pipefail
. "$(dirname "$0")/common.sh"

own=(-std=c99 -ffp-contract=off -fno-math-errno)
allowed='memcpy|memset|sqrtf'

# check <name> <nm> <allowed symbols> <compiler and flags>...
check() {
    local name=$1 nm=$2 allowed=$3 defined wanted strange writable
    shift 3
    rm -f ./*.o
    "$@" "${all_includes[@]}" -c "${all_sources[@]}" || fail "$*"
    defined=$("$nm" -g --defined-only ./*.o | awk 'NF == 3 { print $3 }' | sort -u)
    wanted=$("$nm" -u ./*.o | awk '$1 == "U" { print $2 }' | sort -u)
    wanted=$(comm -13 <(echo "$defined") <(echo "$wanted") | xargs)
    strange=$(xargs -n 1 <<<"$wanted" | grep -vxE "$allowed|" || true)
    [ -z "$strange" ] || fail "$name: refers to $strange"
    strange=$(grep -v '^goe_' <<<"$defined" || true)
    [ -z "$strange" ] || fail "$name: defines names without the prefix goe_: $strange"
    writable=$("$nm" -A --defined-only ./*.o | grep -E ' [bBdDcCsSgG] ' || true)
    [ -z "$writable" ] || fail "$name: writable data: $writable"
    echo "$name: refers to ${wanted:-nothing}"
}

cd "$scratch"
case ${1:-} in
    host)
        mapfile -t present < <(compilers gcc clang-19)
        for compiler in "${present[@]}"; do
            if [ "$compiler" = gcc ]; then levels=(-O0); else levels=(-O2); fi
            [ -z "${GOE_LONG:-}" ] || levels=(-O0 -O2 -Os)
            for level in "${levels[@]}"; do
                check "$compiler $level" nm "$allowed" \
                    "$compiler" "${own[@]}" "$level" -fno-pic -fno-stack-protector
            done
        done ;;
    arm)
        # No double precision and no 64-bit division in hardware: only a time difference may call a conversion, and only the
        # milliseconds of a MAVLink message a division.
        if ! command -v arm-none-eabi-gcc >/dev/null; then
            echo "skipped: no arm-none-eabi-gcc"
            exit 77
        fi
        levels=(-Os)
        [ -z "${GOE_LONG:-}" ] || levels=(-O2 -Os)
        for level in "${levels[@]}"; do
            check "Cortex-M4F $level" arm-none-eabi-nm "$allowed|__aeabi_l2f|__aeabi_uldivmod" \
                arm-none-eabi-gcc "${own[@]}" "$level" -mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard
        done ;;
    *)
        echo "usage: $0 host|arm" >&2
        exit 2 ;;
esac

#!/usr/bin/env bash
# Every combination of the parts (GOE_WITH_WINDOW, _FILTER, _HAZARD; _TARGET_MOTION, a part of the filter method): compiles without a
# warning under the flags of the firmwares, passes the unit tests of its parts, and answers with the same bits as every other
# combination with the same part.
#
# The whole library is in the build that runs this test, with its unit tests; here it only answers. Every combination is read for
# warnings. Two are compiled and tested: each method with the hazard; with GOE_LONG=1 all are.
#
#   parts.sh <folder for the builds> <folder of unity.c> <program parts of the whole library>
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../flags/common.sh"
. "$here/../flags/firmwares.sh"
builds=$1
unity=$2
whole=$3
mkdir -p "$builds"

mapfile -t all_flags < <(reading_flags)

# syntax <definition>...: warnings of gcc, with GOE_LONG=1 of clang too, with the warnings of all firmwares, without code
syntax() {
    local compiler accepted
    for compiler in $(compilers gcc ${GOE_LONG:+clang-19}); do
        mapfile -t accepted < <(known "$compiler" "${all_flags[@]}")
        "$compiler" -std=c99 "${accepted[@]}" -Werror -Wundef -fsyntax-only "$@" -I"$root/lib" "${library_sources[@]}" ||
            fail "$compiler, warnings of the firmwares, $*"
    done
}

# combination <window> <filter> <hazard> <target_motion>: 1 or 0 each
combination() {
    local name="W$1 R$2 H$3 M$4" tree=$builds/$1$2$3$4
    local definitions=("-DGOE_WITH_WINDOW=$1" "-DGOE_WITH_FILTER=$2" "-DGOE_WITH_HAZARD=$3" "-DGOE_WITH_TARGET_MOTION=$4")
    syntax "${definitions[@]}"
    {
        cmake -S "$root" -B "$tree" -G Ninja -DCMAKE_BUILD_TYPE=Release "-DCMAKE_C_FLAGS_RELEASE=-O1" "${definitions[@]}" \
            -DGOE_WERROR=ON -DGOE_BUILD_HOST=OFF -DGOE_BUILD_TESTS=ON -DGOE_TEST_PORTS=OFF -DGOE_INSTALL=OFF -DUNITY_DIR="$unity" &&
            cmake --build "$tree"
    } >"$tree.log" 2>&1 || {
        tail -n 40 "$tree.log" >&2
        fail "$name does not build"
    }
    ctest --test-dir "$tree" -L unit -j 2 >"$tree.log" 2>&1 || {
        tail -n 40 "$tree.log" >&2
        fail "$name: unit tests"
    }
    echo "$name: $(grep -oE '[0-9]+ tests? failed out of [0-9]+' "$tree.log")"
    answers "$name" "$tree/tests/parts/parts" "$4"
}

# answers <name> <program> <target_motion>
answers() {
    local said
    said=$("$2") || fail "$1: a method that was left out is not refused"
    echo "$1: $(grep bytes <<<"$said")"
    [ "$3" = 0 ] || grep -v bytes <<<"$said" >>"$builds/answers" # without target_motion the filter method says other things
}

: >"$builds/answers"
for window in 1 0; do
    for filter in 1 0; do
        for hazard in 1 0; do
            case $window$filter$hazard${GOE_LONG:+all} in
                00*) ;;
                111*) syntax && answers "the whole" "$whole" 1 ;;
                101* | 011* | *all) combination $window $filter $hazard 1 ;;
                *) syntax "-DGOE_WITH_WINDOW=$window" "-DGOE_WITH_FILTER=$filter" "-DGOE_WITH_HAZARD=$hazard" ;;
            esac
        done
    done
done

if [ -n "${GOE_LONG:-}" ]; then
    combination 1 1 1 0
    combination 0 1 0 0
else
    syntax -DGOE_WITH_TARGET_MOTION=0
    syntax -DGOE_WITH_WINDOW=0 -DGOE_WITH_HAZARD=0 -DGOE_WITH_TARGET_MOTION=0
fi

# Each part gives the same answers in every combination that contains it.
sort -u "$builds/answers"
[ "$(sort -u "$builds/answers" | wc -l)" = 4 ] || fail "a part's answers depend on what else is compiled in"

#!/usr/bin/env bash
# Every combination of the parts (GOE_WITH_WINDOW, _REFINED, _HAZARD; _MOVERS, a part of the refined method): compiles without a
# warning under the flags of the firmwares, passes the unit tests of its parts, and answers with the same bits as every other
# combination with the same part.
#
#   parts.sh <folder for the builds> <folder of unity.c>
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../flags/common.sh"
. "$here/../flags/firmwares.sh"
builds=$1
unity=$2
mkdir -p "$builds"

# syntax <definition>...: warnings of both compilers under each firmware's flags, without generating code
syntax() {
    local compiler firmware accepted
    for compiler in $(compilers gcc clang-19); do
        for firmware in "${firmwares[@]}"; do
            firmware_flags "$firmware"
            mapfile -t accepted < <(known "$compiler" "${flags[@]}")
            "$compiler" -std=c99 "${accepted[@]}" -Werror -Wundef -fsyntax-only "$@" -I"$root/lib" "${library_sources[@]}" ||
                fail "$compiler, flags of $firmware, $*"
        done
    done
}

# combination <window> <refined> <hazard> <movers>: 1 or 0 each
combination() {
    local name="W$1 R$2 H$3 M$4" tree=$builds/$1$2$3$4
    local definitions=("-DGOE_WITH_WINDOW=$1" "-DGOE_WITH_REFINED=$2" "-DGOE_WITH_HAZARD=$3" "-DGOE_WITH_MOVERS=$4")
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
    "$tree/tests/parts/parts" >"$tree.parts" || fail "$name: a method that was left out is not refused"
    echo "$name: $(grep -oE '[0-9]+ tests? failed out of [0-9]+' "$tree.log"), $(grep bytes "$tree.parts")"
    [ "$4" = 0 ] || grep -v bytes "$tree.parts" >>"$builds/answers" # without movers the refined method gives other answers
}

: >"$builds/answers"
for window in 1 0; do
    for refined in 1 0; do
        for hazard in 1 0; do
            [ $window$refined = 00 ] || combination $window $refined $hazard 1
        done
    done
done

combination 1 1 1 0
combination 0 1 0 0

# Each part gives the same answers in every combination that contains it.
sort -u "$builds/answers"
[ "$(sort -u "$builds/answers" | wc -l)" = 4 ] || fail "a part's answers depend on what else is compiled in"

#!/usr/bin/env bash
# The kernels, rings and names of lib/ depend on a few numbers. Changing one of them alone must not give a library that compiles and
# computes nonsense: the static assertions of the dependent file stop the compiler.
set -euo pipefail
. "$(dirname "$0")/common.sh"

# compiles <folder>: whether the whole library there compiles. Files with static assertions come first: one of them is to stop it.
compiles() {
    local file asserting others
    mapfile -t asserting < <(grep -l STATIC_ASSERT "$1"/*.c "$1"/*/*.c)
    mapfile -t others < <(grep -L STATIC_ASSERT "$1"/*.c "$1"/*/*.c)
    for file in "${asserting[@]}" "${others[@]}"; do
        gcc -std=c99 -w -fsyntax-only -I"$1" "$file" 2>"$scratch/log" || return 1
    done
}

# refused <number> <other values>...: with each of these the library must not compile, and the message names the reason
refused() {
    local number=$1 value
    shift
    for value in "$@"; do
        rm -rf "${scratch:?}/lib"
        cp -r "$root/lib" "$scratch/lib"
        sed -i -E "s/^(#define $number) .*/\1 $value/" "$scratch"/lib/*.h "$scratch"/lib/*/*.h
        grep -qhE "^#define $number $value$" "$scratch"/lib/*.h "$scratch"/lib/*/*.h || fail "there is no #define $number"
        if compiles "$scratch/lib"; then
            fail "$number = $value compiles"
        fi
        grep -q goe_assert_ "$scratch/log" || {
            cat "$scratch/log" >&2
            fail "$number = $value: not a static assertion that stops it"
        }
        echo "$number = $value: $(grep -o 'goe_assert_[a-z_]*' "$scratch/log" | head -n 1)"
    done
}

cp -r "$root/lib" "$scratch/lib"
compiles "$scratch/lib" || fail "the library as it is does not compile"
refused GOE_STATES 9 11
refused GOE_ROWS_MAX 8 10
refused GOE_FEATURES 5 7
refused GOE_NUISANCES 2 4
refused GOE_KEPT 5 7
refused GOE_CHANGED 6 8
refused GOE_UNWEIGHTED 2 4
refused GOE_FAULT_COUNTS 13 15

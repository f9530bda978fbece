#!/usr/bin/env bash
# Compiles, links and runs a C++ program that includes the public headers under strict warnings: by gcc in C++11, by clang in C++20;
# with GOE_LONG=1 by both in these and C++17.
set -euo pipefail
. "$(dirname "$0")/common.sh"

warnings=(-Wall -Wextra -Wpedantic -Werror -Wundef -Wold-style-cast -Wuseless-cast -Wshadow -Wconversion
    -Wsign-conversion -Wcast-qual -Wzero-as-null-pointer-constant -Wmissing-declarations -Wredundant-decls -Wswitch-enum)

mapfile -t present < <(compilers g++ clang++-19)
if [ ${#present[@]} = 0 ]; then
    echo "skipped: no C++ compiler"
    exit 77
fi
cd "$scratch"
gcc -std=c99 "${all_includes[@]}" -c "${all_sources[@]}"
for compiler in "${present[@]}"; do
    mapfile -t accepted < <(known "$compiler" "${warnings[@]}")
    if [ "$compiler" = g++ ]; then standards=(c++11); else standards=(c++20); fi
    [ -z "${GOE_LONG:-}" ] || standards=(c++11 c++17 c++20)
    for standard in "${standards[@]}"; do
        "$compiler" "-std=$standard" "${accepted[@]}" "${all_includes[@]}" "$root/tests/flags/header.cpp" ./*.o -lm -o header ||
            fail "$compiler -std=$standard"
        ./header || fail "the program made by $compiler -std=$standard"
    done
done
echo "header in C++11 and C++20${GOE_LONG:+ and C++17, each}: ${present[*]}"

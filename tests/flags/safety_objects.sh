#!/usr/bin/env bash
# Compiles the safety tests (of tests/c, tests/flight and tests/mavlink) and their dependencies without special flags, so that they can
# recognize a NaN: once for all firmwares. <folder>/<compiler> then contains the objects of one program, whose argument selects the test.
#
#   safety_objects.sh <folder>      UNITY_INCLUDE locates the test framework
set -euo pipefail
. "$(dirname "$0")/common.sh"
folder=$1

shopt -s nullglob
tests=("$root"/tests/c/test_safety*.c "$root"/tests/flight/test_flight_safety*.c "$root"/tests/mavlink/test_mavlink_safety*.c)
support=()
for file in "$root"/tests/c/*.c "$root"/tests/flight/*.c "$root"/tests/mavlink/*.c; do
    [[ $(basename "$file") == test_* || $(basename "$file") == mavlink_echo.c ]] || support+=("$file")
done
if [ ${#tests[@]} = 0 ]; then
    fail "no safety test tests/c/test_safety*.c"
fi

# Each test keeps its own main(), setUp() and tearDown() under unique names.
{
    echo '#include <string.h>'
    for file in "${tests[@]}"; do
        name=$(basename "$file" .c)
        echo "int ${name}_main(void); void ${name}_set_up(void); void ${name}_tear_down(void);"
    done
    echo 'static void (*set_up)(void), (*tear_down)(void);'
    echo 'void setUp(void); void setUp(void) { set_up(); }'
    echo 'void tearDown(void); void tearDown(void) { tear_down(); }'
    echo 'int main(int count, char **words) {'
    for file in "${tests[@]}"; do
        name=$(basename "$file" .c)
        echo "    if (count == 2 && !strcmp(words[1], \"$name\")) {"
        echo "        set_up = ${name}_set_up;"
        echo "        tear_down = ${name}_tear_down;"
        echo "        return ${name}_main();"
        echo '    }'
    done
    echo '    return 2;'
    echo '}'
} >"$scratch/safety_programs.c"

rm -rf "$folder"
for compiler in $(compilers gcc clang-19); do
    mkdir -p "$folder/$compiler"
    cd "$folder/$compiler"
    plain=("$compiler" -std=c99 -O0 "${all_includes[@]}" -I"$root/tests/c" -I"$root/tests/flight" -I"$root/tests/mavlink"
        -I"$UNITY_INCLUDE" -c)
    "${plain[@]}" "$scratch/safety_programs.c" "${support[@]}" || fail "$compiler: what the safety tests need"
    for file in "${tests[@]}"; do
        name=$(basename "$file" .c)
        "${plain[@]}" "$file" -Dmain="${name}_main" -DsetUp="${name}_set_up" -DtearDown="${name}_tear_down" ||
            fail "$compiler: $file"
    done
done
basename -a -s .c "${tests[@]}" >"$folder/names"

#!/usr/bin/env bash
# Compiles the library, the flight layer and its MAVLink messages as one firmware does, without a warning, and runs the safety tests
# on the result.
#
#   firmware_flags.sh px4|ardupilot|betaflight|inav
#
# Every host compiler there is; C99, C11 and GNU C17; with and without NDEBUG. The safety tests (of tests/c, tests/flight and
# tests/mavlink) are compiled plainly, so that they can tell a NaN, and are linked with the firmware's flags, which may change the
# floating-point unit's mode. UNITY_INCLUDE and UNITY_LIBRARY say where the test framework is.
set -euo pipefail
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/firmwares.sh"

firmware=${1:-}
firmware_flags "$firmware" || {
    echo "usage: $0 px4|ardupilot|betaflight|inav" >&2
    exit 2
}

shopt -s nullglob
safety_tests=("$root"/tests/c/test_safety*.c "$root"/tests/flight/test_flight_safety*.c
    "$root"/tests/mavlink/test_mavlink_safety*.c)
support=()
for file in "$root"/tests/c/*.c "$root"/tests/flight/*.c "$root"/tests/mavlink/*.c; do
    [[ $(basename "$file") == test_* || $(basename "$file") == mavlink_echo.c ]] || support+=("$file")
done
if [ ${#safety_tests[@]} = 0 ]; then
    fail "no safety test tests/c/test_safety*.c"
fi

# compile <compiler> <flag>...: the whole library into the current folder
compile() {
    local compiler=$1
    shift
    "$compiler" "$@" -Werror "${all_includes[@]}" -c "${all_sources[@]}" || fail "$compiler $*"
    compiled=$((compiled + ${#all_sources[@]}))
}

# run_safety <compiler> <flag>...: with the library's objects in the current folder
run_safety() {
    local compiler=$1 file program
    shift
    for file in "${safety_tests[@]}"; do
        program=$scratch/$(basename "$file" .c)
        mkdir -p "$scratch/plain"
        (cd "$scratch/plain" && rm -f ./*.o && "$compiler" -std=c99 -O1 "${all_includes[@]}" -I"$root/tests/c" \
            -I"$root/tests/flight" -I"$root/tests/mavlink" -I"$UNITY_INCLUDE" -c "$file" "${support[@]}") || fail "$compiler: $file"
        "$compiler" "$@" ./*.o "$scratch"/plain/*.o "$UNITY_LIBRARY" -lm -o "$program" || fail "link: $compiler $*"
        "$program" >"$scratch/log" 2>&1 || {
            cat "$scratch/log" >&2
            fail "$(basename "$program") under $compiler $*"
        }
        ran=$((ran + 1))
    done
}

compiled=0
ran=0
mkdir "$scratch/objects"
cd "$scratch/objects"
mapfile -t present < <(compilers gcc clang-19)
for compiler in "${present[@]}"; do
    mapfile -t common < <(known "$compiler" "${flags[@]}")
    compile "$compiler" -std=c99 "${levels[0]}" "${common[@]}" -DNDEBUG
    for standard in c11 gnu17 c99; do
        compile "$compiler" "-std=$standard" "${levels[0]}" "${common[@]}"
    done
    run_safety "$compiler" "${levels[0]}" "${common[@]}"
    level=$(known "$compiler" "${levels[1]}")
    compile "$compiler" -std=c99 "${level:--O3}" "${common[@]}"
    run_safety "$compiler" "${level:--O3}" "${common[@]}"
done
echo "$firmware: ${present[*]}: $compiled compilations without a warning, $ran safety programs ran"

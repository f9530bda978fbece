#!/usr/bin/env bash
# Compiles the library, the flight layer and its MAVLink messages with one firmware's flags, without a warning, and runs the safety tests
# on the result.
#
#   firmware_flags.sh px4|ardupilot|betaflight|inav
#
# C99: code, which is tested, and warnings that only come with code. gcc compiles at the firmware's usual level, with Betaflight's flags
# clang too; with GOE_LONG=1 gcc and clang compile at both. dialects.sh reads the sources in the other dialects, with both compilers.
#
# The safety tests are those of safety_objects.sh, linked with the firmware's flags, which may change the floating-point unit's mode.
# UNITY_INCLUDE and UNITY_LIBRARY locate the test framework, SAFETY_OBJECTS the objects of safety_objects.sh.
set -euo pipefail
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/firmwares.sh"

firmware=${1:-}
firmware_flags "$firmware" || {
    echo "usage: $0 px4|ardupilot|betaflight|inav" >&2
    exit 2
}

objects=${SAFETY_OBJECTS:-}
if [ -z "$objects" ]; then
    objects=$scratch/safety
    bash "$root/tests/flags/safety_objects.sh" "$objects"
fi
mapfile -t safety_tests <"$objects/names"
[ ${#safety_tests[@]} != 0 ] || fail "no safety test"

# compile <compiler> <flag>...: the whole library into the current folder
compile() {
    local compiler=$1
    shift
    "$compiler" "$@" -Werror "${all_includes[@]}" -c "${all_sources[@]}" || fail "$compiler $*"
    compiled=$((compiled + ${#all_sources[@]}))
}

# run_safety <compiler> <flag>...: with the library's objects in the current folder
run_safety() {
    local compiler=$1 name
    shift
    "$compiler" "$@" ./*.o "$objects/$compiler"/*.o "$UNITY_LIBRARY" -lm -o "$scratch/safety_program" ||
        fail "link: $compiler $*"
    for name in "${safety_tests[@]}"; do
        "$scratch/safety_program" "$name" >"$scratch/log" 2>&1 || {
            cat "$scratch/log" >&2
            fail "$name under $compiler $*"
        }
        ran=$((ran + 1))
    done
}

compiled=0
ran=0
mkdir "$scratch/objects"
second_compiler=
if [ "$firmware" = betaflight ] || [ -n "${GOE_LONG:-}" ]; then
    second_compiler=clang-19 # -ffast-math: gcc leaves some comparisons with NaN as they are, clang does not
fi
# shellcheck disable=SC2086 # one word or none
mapfile -t present < <(compilers gcc $second_compiler)
for compiler in "${present[@]}"; do
    mapfile -t common < <(known "$compiler" "${flags[@]}")
    cd "$scratch/objects"
    second=$(known "$compiler" "${levels[1]}")
    chosen=("${levels[0]}" "${second:--O3}")
    [ -n "${GOE_LONG:-}" ] || chosen=("${levels[0]}")
    for level in "${chosen[@]}"; do
        compile "$compiler" -std=c99 "$level" "${common[@]}"
        run_safety "$compiler" "$level" "${common[@]}"
    done
done
echo "$firmware: ${present[*]}: $compiled compilations without a warning, $ran safety programs ran"

#!/usr/bin/env bash
# [A13]
# Builds a target's preset and runs its tests under QEMU.
#
#   build_target.sh <preset> <folder for the build> <all|safety|none: tests of tests/c> <folder of unity.c>
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
preset=$1
tree=$2/$1

need() {
    if ! command -v "$1" >/dev/null; then
        echo "skipped: no $1"
        exit 77
    fi
}

case $preset in
    rv32*)
        need riscv64-unknown-elf-gcc
        need qemu-system-riscv32 ;;
    *)
        need arm-none-eabi-gcc
        need qemu-system-arm ;;
esac
case $preset in
    *-clang-*) need clang-19 ;;
esac

# Most compiler faults show early, and the host runs all: the safety tests run a tenth of the preset's length, the other tests of tests/c
# do not run. GOE_LONG=1: the preset's length and all tests, as tools/evidence.sh --long does.
length=()
tests=$3
if [ -z "${GOE_LONG:-}" ]; then
    length=(-DPORT_ENVIRONMENT=GOE_TEST_UPDATES=1000)
    [ "$tests" != all ] || tests=safety
fi

cd "$root"
cmake --preset "$preset" -B "$tree" -DGOE_TARGET_TESTS="$tests" -DUNITY_DIR="$4" "${length[@]}" >"$tree.log" 2>&1 || {
    cat "$tree.log" >&2
    exit 1
}
cmake --build "$tree" >"$tree.log" 2>&1 || {
    tail -n 60 "$tree.log" >&2
    exit 1
}
ctest --test-dir "$tree" --output-on-failure

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

# Most compiler faults show early, and the host runs all: the safety tests run a tenth of the preset's length, the other tests draw a
# tenth of their cases. GOE_LONG=1: the preset's length and all cases, as tools/evidence.sh --long does.
length=()
if [ -n "${GOE_LONG:-}" ]; then
    length=(-DGOE_TARGET_SHARE=1)
else
    length=(-DPORT_ENVIRONMENT=GOE_TEST_UPDATES=1000)
fi

cd "$root"
cmake --preset "$preset" -B "$tree" -DGOE_TARGET_TESTS="$3" -DUNITY_DIR="$4" "${length[@]}" >"$tree.log" 2>&1 || {
    cat "$tree.log" >&2
    exit 1
}
cmake --build "$tree" >"$tree.log" 2>&1 || {
    tail -n 60 "$tree.log" >&2
    exit 1
}
ctest --test-dir "$tree" --output-on-failure

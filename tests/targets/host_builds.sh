#!/usr/bin/env bash
# The hashes of the replay, and of the replay through the flight layer, are the golden ones for each compiler of this machine,
# vectorized, optimized at link time, and with 32 bits. GOE_LONG=1: every level.
#
#   host_builds.sh <golden hash> <golden hash of the flight layer>
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
. "$here/../flags/common.sh"
levels=()
others=("gcc -O3 -march=native -funroll-loops" "gcc -O2 -m32 -msse2 -mfpmath=sse" "clang-19 -O3 -march=native -flto -fuse-ld=lld")
if [ -n "${GOE_LONG:-}" ]; then
    levels+=(-O0 -O1 -O2 -Os -O3 "-O3 -march=native")
    others+=("clang-19 -O3 -march=native -funroll-loops" "gcc -O2 -flto" "gcc -O3 -march=native -flto" "clang-19 -O2 -flto" "clang-19 -O3 -march=native -flto")
fi
golden=$1
flight_golden=$2

own=(-std=c99 -ffp-contract=off -fno-math-errno "${all_includes[@]}" -I"$here")
sources=("$here/replay.c" "$here/embedded_logs.c")
failed=0
ran=0

# possible <compiler> <flag>...: whether this machine has the components that the flags need
possible() {
    echo '#include <math.h>
int main(void) { return 0; }' | "$@" -x c - -o "$scratch/probe" 2>/dev/null && return
    echo "skipped: $* is not possible here"
    return 1
}

# try <compiler> <flag>...: every file is compiled once; each program links what it calls
try() {
    local line
    rm -rf "$scratch/objects"
    mkdir "$scratch/objects"
    (cd "$scratch/objects" && "$1" "${own[@]}" "${@:2}" -c "${all_sources[@]}" "${sources[@]}")
    "$1" "${own[@]}" "${@:2}" "$here/replay_main.c" "$scratch"/objects/*.o -lm -o "$scratch/replay"
    "$1" "${own[@]}" "${@:2}" "$here/flight_main.c" "$scratch"/objects/*.o -lm -o "$scratch/flight"
    line=$("$scratch/replay")
    ran=$((ran + 1))
    echo "$line  $*"
    if [[ $line != "replay $golden "*" self_check 0x00" ]]; then
        echo "FAILED: $* (expected $golden and self_check 0x00)" >&2
        failed=1
    fi
    line=$("$scratch/flight")
    if [[ $line != "flight $flight_golden "* ]]; then
        echo "FAILED: $* ($line, expected $flight_golden)" >&2
        failed=1
    fi
}

for compiler in gcc clang-19; do
    command -v "$compiler" >/dev/null || continue
    for level in "${levels[@]}"; do
        # shellcheck disable=SC2086 # several flags
        try "$compiler" $level
    done
done
for flags in "${others[@]}"; do
    command -v "${flags%% *}" >/dev/null || continue
    # shellcheck disable=SC2086 # several words
    if possible $flags; then
        try $flags
    fi
done
[ $ran -gt 0 ] || exit 77
exit $failed

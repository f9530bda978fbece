#!/usr/bin/env bash
# Speeds on one core of this machine, not asserted by any test: rows per second of goe_replay, over a long log of a repeated
# recorded flight, and through a pipe with every column filled; the share of a core that goe_companion takes in flight.
#
#   tools/bench.sh [rows]   default 1000000
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
rows=${1:-1000000}
flight=tests/data/corner
runs=3

python=.venv/bin/python
cmake --build build --target goe_replay >/dev/null
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# Each repetition is a new obstacle at a later time.
awk -F, -v OFS=, -v rows="$rows" '
    NR == 1 { for (i = 1; i <= NF; i++) { if ($i == "t_s") t = i; if ($i == "id") id = i } print; next }
    { sub(/\r$/, ""); line[NR - 1] = $0; last = $t }
    END {
        n = NR - 1
        for (k = 0; k < rows; k++) {
            $0 = line[k % n + 1]
            repetition = int(k / n)
            $t = sprintf("%.6f", $t + repetition * (last + 1))
            $id = repetition + 1
            print
        }
    }' $flight/frames.csv >"$scratch/frames.csv"

# best <method>: rows per second, best of the runs
best() {
    local best=0 start end speed
    for _ in $(seq $runs); do
        start=$(date +%s%N)
        build/sim_host/goe_replay --method "$1" --camera $flight/camera.ini --frames "$scratch/frames.csv" \
            --out "$scratch/out.csv"
        end=$(date +%s%N)
        speed=$((rows * 1000000000 / (end - start)))
        [ $speed -le $best ] || best=$speed
    done
    echo $best
}

# filled: rows per second of processor time, best of the runs
filled() { GOE_REPLAY=build/sim_host/goe_replay "$python" tests/host/bench_replay.py "$rows"; }

# in_flight: seconds of processor time for each second of a flight, least of the runs
in_flight() { GOE_COMPANION=build/port/companion/goe_companion "$python" tests/companion/bench_companion.py; }

cached() { sed -n "s/^$1:[A-Z]*=//p" build/CMakeCache.txt; }
compiler=$(cached CMAKE_C_COMPILER)
filter=$(best filter)
window=$(best window)
echo "goe_replay --method filter: $filter rows/s, best of $runs runs over $rows rows"
echo "goe_replay --method window:  $window rows/s, $((100 * window / filter)) % of filter"
if [ -x $python ]; then
    filled=$(filled)
    echo "goe_replay, every column filled, through a pipe: $filled rows/s of processor time, $((100 * filled / filter)) % of filter"
    if cmake --build build --target goe_companion >/dev/null 2>&1; then
        echo "goe_companion, 200 poses and 30 images of 8 obstacles a second: $(in_flight) of a core, flown in simulated time"
    else
        echo "left out, as it cannot be built: goe_companion"
    fi
else
    echo "left out, as tools/setup.sh has not run: every column filled, goe_companion"
fi
echo "machine:  $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)"
echo "compiler: $("$compiler" --version | head -n 1)"
echo "flags:    $(cached CMAKE_C_FLAGS) $(cached CMAKE_C_FLAGS_RELEASE) -std=c99 -ffp-contract=off -fno-math-errno"

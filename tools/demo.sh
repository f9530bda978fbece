#!/usr/bin/env bash
# Shows the estimator at work: sets up, builds, replays a small recorded flight past the corner of a building and prints
# what was found.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"

tools/setup.sh --demo
log=.cache/demo-build.log
if [ ! -e build/CMakeCache.txt ]; then
    cmake --preset default -DGOE_BUILD_TESTS=OFF >$log 2>&1 || { cat $log >&2; exit 1; }
fi
cmake --build build --target goe_replay >$log 2>&1 || { cat $log >&2; exit 1; }

out=build/demo.csv
build/sim_host/goe_replay --method window --out $out tests/data/corner
.venv/bin/python -m goe_tools table --truth tests/data/corner/truth.csv $out
echo
echo "Every image's estimate, with its one-sigma, is in $root/$out"

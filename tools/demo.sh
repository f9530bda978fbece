#!/usr/bin/env bash
# Shows the estimator at work: sets up, builds, replays a small recorded flight past the corner of a building, flies the
# paper's campaign and more in simulation, flies the flight layer's orders towards obstacles, prints Table 3 (the paper's
# numbers, the window method's, the filter method's), writes the report, and says in a few lines what was shown.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"

echo "The demo takes one to two minutes; the first time, set-up takes some five minutes before that."
tools/setup.sh --demo
SECONDS=0
log=.cache/demo-build.log
cmake --preset default -DGOE_BUILD_HOST=ON >$log 2>&1 || { cat $log >&2; exit 1; }
cmake --build build --target goe_replay goe_sim goe_campaign goe_avoid >$log 2>&1 || { cat $log >&2; exit 1; }

echo "A recorded approach, replayed (simulated flight, whole pixels):"
echo
out=build/demo.csv
build/sim_host/goe_replay --out $out tests/data/corner
.venv/bin/python -m goe_tools table --truth tests/data/corner/truth.csv $out
echo
echo "The paper's campaign and what goes beyond it, flown in simulation:"
echo
campaign=build/campaign
build/sim_host/goe_campaign --seeds 1 --out $campaign
echo
echo "Collision courses with the orders carried out and without, and passes, flown in simulation:"
echo
orders=build/avoid.csv
build/sim_host/goe_avoid --runs 20 --csv $orders
echo
.venv/bin/python -m goe_tools view tests/data/corner --out build/view.html
recorded=tests/evidence/goals.json # a release's
goals=()
[ ! -e $recorded ] || goals=(--goals "$recorded")
.venv/bin/python -m goe_tools report $campaign --table --out build/report.html --avoid $orders "${goals[@]}" \
    --approach tests/data/corner --rare tests/data/rare_events.json --summary
echo
echo "Every image's estimate of the replay: $root/$out"
echo "The campaign's statistics:            $root/$campaign/cases.csv"
echo "Every run of the orders:              $root/$orders"
echo "The report:                           $root/build/report.html"
echo "The replay, with a slider over time:  $root/build/view.html"
echo "More tools:                           . .venv/bin/activate, then python -m goe_tools --help"
echo
echo "Done in $SECONDS s after set-up."

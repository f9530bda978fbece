#!/usr/bin/env bash
# Demonstrates goe: sets up, builds, replays a recorded approach, flies the paper's campaign and collision courses in
# simulation, builds the live page, writes the report, and ends with a summary in words.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
if [ $# != 0 ]; then
    sed -n '2,/^set/ { /^#/ s/^# \{0,1\}//p }' "$0"
    [[ $1 == -h || $1 == --help ]] && exit 0 || exit 2
fi

echo "The demo takes two minutes on an idle machine. The first time, set-up takes some five minutes before that."
tools/setup.sh --demo
SECONDS=0
log=.cache/demo-build.log
out=build/demo.csv campaign=build/campaign orders=build/avoid.csv
python=.venv/bin/python

step() { printf '\n%3d s  %s\n' $SECONDS "$1"; }

step "Building the programs."
cmake --preset default -DGOE_BUILD_HOST=ON >$log 2>&1 || { cat $log >&2; exit 1; }
cmake --build build --target goe_replay goe_sim goe_campaign goe_avoid >$log 2>&1 || { cat $log >&2; exit 1; }

step "Building the live page: the library, compiled to WebAssembly."
live=()
if $python -m goe_tools live --out build/live.html 2>$log; then
    live=(--live build/live.html)
else
    sed 's/^/  No live page: /' $log
fi

step "Replaying a recorded approach (simulated flight, rounded to whole pixels). Times, meters, ± 1 sigma:"
echo
build/sim_host/goe_replay --out $out tests/data/corner
$python -m goe_tools table --truth tests/data/corner/truth.csv $out
$python -m goe_tools view tests/data/corner --out build/view.html >/dev/null

step "Flying the paper's campaign and more, in simulation:"
echo
build/sim_host/goe_campaign --seeds 1 --out $campaign

step "Flying collision courses with and without the orders, and passes, in simulation:"
echo
build/sim_host/goe_avoid --runs 20 --csv $orders

step "The paper's Table 3, then the report:"
echo
recorded=tests/evidence/goals.json # of a release; measuring the goals takes hours
goals=()
[ ! -e $recorded ] || goals=(--goals "$recorded")
$python -m goe_tools report $campaign --table --out build/report.html --avoid $orders "${goals[@]}" "${live[@]}" \
    --view build/view.html --approach tests/data/corner --rare tests/data/rare_events.json --summary

echo
[ ${#live[@]} = 0 ] || echo "Fly yourself, in a browser:  $root/build/live.html"
echo "The report:                  $root/build/report.html"
echo "The replay, with a slider:   $root/build/view.html"
echo "Numbers:                     $root/$out, $root/$campaign/cases.csv, $root/$orders"
echo "The programs:                $root/build/sim_host: goe_replay, goe_sim, goe_campaign, goe_avoid"
echo "More tools:                  . .venv/bin/activate, then python -m goe_tools --help"
echo
echo "Done in $SECONDS s after set-up."

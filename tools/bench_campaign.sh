#!/usr/bin/env bash
# Cases per second of goe_campaign on all cores. A case is one flight with all estimators.
#
#   tools/bench_campaign.sh [seeds] [program]   default 10, build/sim_host/goe_campaign
#   tools/bench_campaign.sh --quick             the paper's study alone, once
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
runs=3
quick=false
if [ "${1:-}" = --quick ]; then
    quick=true
    runs=1
    shift
fi
seeds=${1:-10}
program=${2:-$root/build/sim_host/goe_campaign}

scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

fact() { sed -n "s/^ *\"$1\": \([0-9.]*\),*$/\1/p" "$scratch/campaign.json"; }

# bench <name> <argument>...: the best of several runs
bench() {
    local name=$1 best=0 start end
    shift
    for _ in $(seq $runs); do
        start=$(date +%s%N)
        "$program" "$@" --quiet --out "$scratch"
        end=$(date +%s%N)
        [ $best -ne 0 ] && [ $((end - start)) -ge $best ] || best=$((end - start))
    done
    awk -v name="$name" -v ns="$best" -v cases="$(fact flights)" -v frames="$(fact frames)" -v runs="$(fact runs)" 'BEGIN {
        s = ns / 1e9
        printf "%-28s %6.1f s  %6.0f cases/s  %8.0f frames/s  (%d cases, %d frames, %d runs of the library)\n",
            name, s, cases / s, frames / s, cases, frames, runs
    }'
}

bench "paper's study, 1 seed" --studies paper --seeds 1
if ! $quick; then
    bench "whole campaign, 1 seed" --seeds 1
    bench "whole campaign, $seeds seeds" --seeds "$seeds"
fi
echo "jobs:     $(fact jobs)"
echo "machine:  $(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)"

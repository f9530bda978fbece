#!/usr/bin/env bash
# Evidence for the library's promises, as one table of figures, goals and dates.
#
#   tools/evidence.sh --quick             parts that fit in ten minutes
#   tools/evidence.sh --long              everything; keeps the figures in build/evidence/record.json
#   tools/evidence.sh --show              prints that record, or the newest release's
#   tools/evidence.sh --release VERSION   makes tests/evidence/VERSION.json from that record
#
# Further options are those of python -m ci evidence --help. Exit status 1: a goal was missed, or a part did not build or run.
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
tools/setup.sh >&2
export OPENBLAS_NUM_THREADS=1
exec .venv/bin/python -m ci evidence "$@"

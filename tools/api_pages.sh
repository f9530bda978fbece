#!/usr/bin/env bash
# Builds the pages of the C interface from the public headers of lib and port/flight with Doxygen; its warnings are errors.
#
#   tools/api_pages.sh [DIR]   writes DIR/html/index.html; default: build/api
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
if [ $# -gt 1 ] || [[ ${1:-} == -* ]]; then
    sed -n '2,/^set/ { /^#/ s/^# \{0,1\}//p }' "$0" >&2
    exit 2
fi
out=${1:-$root/build/api}
mkdir -p "$out"
GOE_API_OUT=$(cd "$out" && pwd)
cd "$root"
if ! command -v doxygen >/dev/null; then
    echo "api_pages: there is no doxygen; tools/setup.sh installs it" >&2
    exit 1
fi
version=$(sed -nE 's/^#define GOE_VERSION_(MAJOR|MINOR|PATCH) ([0-9]+)$/\2/p' lib/goe.h | paste -sd.)
GOE_API_PYTHON=${PYTHON:-python3}
[ ! -x .venv/bin/python ] || GOE_API_PYTHON=.venv/bin/python
export GOE_VERSION=$version GOE_API_OUT GOE_API_PYTHON
doxygen tools/api/Doxyfile
echo "$GOE_API_OUT/html/index.html"

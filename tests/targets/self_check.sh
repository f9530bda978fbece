#!/usr/bin/env bash
# The self-check under an emulator. If it reports nothing, the compiler does not use its flags: then the whole library with these
# flags, built now, must give the golden hash.
#
#   self_check.sh <build> <image> <target of the whole library's image> <that image> <emulator>...
set -euo pipefail
build=$1 image=$2 target=$3 whole=$4
shift 4

if said=$("$@" "$image" 2>&1); then
    echo "$said"
    exit 0
fi
echo "$said"
[[ $said == "self_check 0x00, "* ]] || exit 1
cmake --build "$build" --target "$target"
"$@" "$whole"

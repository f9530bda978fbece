#!/usr/bin/env bash
# Reads the library, the flight layer and its MAVLink messages in C11 and GNU C17, with the warnings of all firmwares as errors: gcc the
# one, clang the other; with GOE_LONG=1 each both. C99 is compiled by firmware_flags.sh. No code is generated: a dialect changes what the front end accepts. NDEBUG changes
# nothing, as no source names it.
set -euo pipefail
. "$(dirname "$0")/common.sh"
. "$(dirname "$0")/firmwares.sh"

! grep -nE '\bNDEBUG\b|assert\.h' "${all_sources[@]}" "$root"/lib/*.h "$root"/lib/*/*.h "$root"/port/{flight,mavlink,sqrtf}/*.h ||
    fail "a source depends on NDEBUG"

read=0
mapfile -t all_flags < <(reading_flags)
for compiler in $(compilers gcc clang-19); do
    mapfile -t accepted < <(known "$compiler" "${all_flags[@]}")
    if [ "$compiler" = gcc ]; then standards=(c11); else standards=(gnu17); fi
    [ -z "${GOE_LONG:-}" ] || standards=(c11 gnu17)
    for standard in "${standards[@]}"; do
        "$compiler" "-std=$standard" "${accepted[@]}" -Werror "${all_includes[@]}" -fsyntax-only "${all_sources[@]}" ||
            fail "$compiler -std=$standard"
        read=$((read + ${#all_sources[@]}))
    done
done
[ $read -gt 0 ] || exit 77
echo "C11 and GNU C17: $read readings without a warning"

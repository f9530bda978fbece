#!/usr/bin/env bash
# Limits and parts from the firmware's own header, GOE_CONFIG_HEADER; and limits that goe_limits.h refuses.
set -euo pipefail
. "$(dirname "$0")/common.sh"

cd "$scratch"
cat >program.c <<'END'
#include "goe.h"
#include "goe_settings_list.h"
typedef char window_is_16[GOE_WINDOW_MAX == 16 ? 1 : -1];
typedef char cameras_are_3[GOE_CAMERAS_MAX == 3 ? 1 : -1];
typedef char no_hazard[GOE_WITH_HAZARD == 0 ? 1 : -1];
END
cat >firmware.h <<'END'
#define GOE_WINDOW_MAX 16
#define GOE_CAMERAS_MAX 3
#define GOE_WITH_HAZARD 0
END
compile() { gcc -std=c99 -Wall -Wextra -Werror -fsyntax-only -I"$root/lib" -I. "$@" 2>log; }

compile '-DGOE_CONFIG_HEADER="firmware.h"' program.c "${library_sources[@]}" || fail "$(cat log)"
if compile program.c; then
    fail "the limits are those of the header without GOE_CONFIG_HEADER"
fi
for bad in -DGOE_WINDOW_MAX=2 -DGOE_WINDOW_MAX=65 -DGOE_CAMERAS_MAX=0 -DGOE_CAMERAS_MAX=9 \
    "-DGOE_WITH_WINDOW=0 -DGOE_WITH_FILTER=0"; do
    read -ra words <<<"$bad"
    if compile "${words[@]}" "$root/lib/goe_settings.c"; then
        fail "$bad compiles"
    fi
    grep -q "must be" log || fail "$bad: goe_limits.h does not say why"
done
for good in 3 64; do
    compile -DGOE_WINDOW_MAX=$good "$root/lib/goe_settings.c" || fail "GOE_WINDOW_MAX=$good: $(cat log)"
done
echo "limits and parts come from the firmware's header, and bad ones are refused"

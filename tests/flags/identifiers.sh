#!/usr/bin/env bash
# Words that the library's sources must not contain: double, heap, stdio, libm functions except sqrtf.
# Comments are stripped before the search.
set -euo pipefail
. "$(dirname "$0")/common.sh"

types='double|long double|_Complex'
keywords='goto|setjmp|longjmp'
calls='malloc|calloc|realloc|free|alloca'
calls="$calls|printf|fprintf|sprintf|snprintf|puts|fputs|putchar|scanf|fopen|abort|exit|assert"
calls="$calls|(sin|cos|tan|asin|acos|atan|atan2|hypot|pow|exp|log|fma|floor|ceil|round|fmod|fmin|fmax)[fl]?"
calls="$calls|sqrt|sqrtl|fabs|fabsf|fabsl|isnan|isinf|isfinite|isnormal|fpclassify|signbit"
headers='#include *<(stdio|stdlib|tgmath|complex|assert|errno|fenv)\.h>'

bad=0
mapfile -t files < <(find "$root/lib" "$root/port/flight" "$root/port/mavlink" -name '*.[ch]')
for file in "${files[@]}"; do
    stripped=$scratch/stripped
    gcc -fpreprocessed -dD -E -P -w "$file" >"$stripped"
    if grep -nE "\\b($types|$keywords)\\b|\\b($calls) *\\(" "$stripped" >"$scratch/found" ||
        grep -nE "$headers" "$file" >"$scratch/found"; then
        echo "$file: forbidden:" >&2
        cat "$scratch/found" >&2
        bad=1
    fi
done
[ $bad = 0 ] || fail "forbidden words"

# Every floating-point constant has the suffix f: one of these would find a double constant.
cd "$scratch"
mapfile -t flags < <(known gcc -Wdouble-promotion -Wunsuffixed-float-constants -Wfloat-conversion -Wvla)
gcc -std=c99 "${flags[@]}" -Werror "${all_includes[@]}" -fsyntax-only "${all_sources[@]}" || fail "double precision or variable-length arrays"
echo "no forbidden word in ${#files[@]} files"

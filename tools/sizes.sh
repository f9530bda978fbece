#!/usr/bin/env bash
# Memory of one estimator and code of the library, for the tables of lib/README.md; of the flight layer, for those of
# port/flight/README.md; and of its MAVLink messages, for that of port/mavlink/README.md.
#
#   tools/sizes.sh          prints the tables
#   tools/sizes.sh <words>  ... of the code only the rows whose name has these words, such as "Cortex-M4F gcc"
#   tools/sizes.sh --check  fails if an estimator at the default window is larger than 2.1 KiB, or if lib/README.md
#                           states other bytes per estimator
set -euo pipefail
. "$(dirname "$0")/../tests/flags/common.sh"
cd "$scratch"

limit_bytes=2100
m4f=(-mcpu=cortex-m4 -mthumb -mfpu=fpv4-sp-d16 -mfloat-abi=hard)
mapfile -t flight_sources < <(find "$root/port/flight" -name '*.c' | sort)
mapfile -t mavlink_sources < <(find "$root/port/mavlink" -name '*.c' | sort)
sources=("${library_sources[@]}") # what code_row measures
wanted=${1:-}

# estimator_bytes [window]
estimator_bytes() {
    gcc -std=c99 ${1:+-DGOE_WINDOW_MAX=$1} -I"$root/lib" "$root/tests/flags/sizeof.c" -o sizeof
    ./sizeof
}

state_rows() {
    local window
    for window in 3 8 16 32 64; do
        echo "| $window | $(estimator_bytes $window) |"
    done
}

# code_row <name> <size program> <compiler and flags>...
code_row() {
    local name=$1 size=$2
    shift 2
    [[ $name == *"$wanted"* ]] || return 0
    if command -v "$1" >/dev/null; then
        "$@" -std=c99 -ffp-contract=off -fno-math-errno "${all_includes[@]}" -c "${sources[@]}"
        # .data.rel.ro contains constants that are addresses: read-only once loaded
        "$size" -A ./*.o | awk -v name="$name ($("$1" -dumpversion))" \
            '/^\.(text|rodata|data\.rel\.ro)/ { code += $2 } /^\.(data|bss)/ && !/^\.data\.rel\.ro/ { data += $2 }
             END { printf "| %s | %d | %d |\n", name, code, data }'
        rm -f ./*.o
    fi
}

if [ "${1:-}" = --check ]; then
    bytes=$(estimator_bytes)
    echo "estimator at the default window: $bytes bytes"
    if [ "$bytes" -gt $limit_bytes ]; then
        echo "FAILED: more than $limit_bytes" >&2
        exit 1
    fi
    if [ -e "$root/lib/README.md" ]; then
        while read -r row; do
            if ! grep -qxF "$row" "$root/lib/README.md"; then
                echo "FAILED: lib/README.md has no line \"$row\" (tools/sizes.sh prints its table)" >&2
                exit 1
            fi
        done <<<"$(state_rows)"
    fi
    exit 0
fi

echo "| largest window \`GOE_WINDOW_MAX\` | bytes per estimator |"
echo "|---|---|"
state_rows
echo
echo "| library code | code and constants, bytes | writable data, bytes |"
echo "|---|---|---|"
for level in -O2 -Os; do
    code_row "x86-64 gcc $level" size gcc $level
done
for level in -O2 -Os; do
    code_row "x86-64 clang $level" size clang-19 $level
done
for level in -O2 -Os; do
    code_row "Cortex-M4F gcc $level" arm-none-eabi-size arm-none-eabi-gcc $level "${m4f[@]}"
done
echo
echo "| flight layer, obstacles at a time | bytes of \`goe_flight_t\`, Cortex-M4F |"
echo "|---|---|"
if command -v arm-none-eabi-gcc >/dev/null; then
    for slots in 1 2 4 8; do
        printf '#include "goe_flight.h"\nextern char state[];\nchar state[sizeof(goe_flight_t)];\n' >flight.c
        arm-none-eabi-gcc -std=c99 "${m4f[@]}" "-DGOE_FLIGHT_SLOTS=$slots" "${all_includes[@]}" -c flight.c
        echo "| $slots | $(arm-none-eabi-nm -S -t d flight.o | awk '/ state$/ { print $2 + 0 }') |"
    done
fi
rm -f ./*.o
echo
echo "| flight layer, code | code and constants, bytes | writable data, bytes |"
echo "|---|---|---|"
sources=("${flight_sources[@]}")
for level in -O2 -Os; do
    code_row "Cortex-M4F gcc $level" arm-none-eabi-size arm-none-eabi-gcc $level "${m4f[@]}"
done
for file in "${flight_sources[@]}"; do
    sources=("$file")
    code_row "Cortex-M4F gcc -Os: $(basename "$file")" arm-none-eabi-size arm-none-eabi-gcc -Os "${m4f[@]}"
done
echo
echo "| MAVLink messages, code | code and constants, bytes | writable data, bytes |"
echo "|---|---|---|"
sources=("${mavlink_sources[@]}")
for level in -O2 -Os; do
    code_row "Cortex-M4F gcc $level" arm-none-eabi-size arm-none-eabi-gcc $level "${m4f[@]}"
done
for file in "${mavlink_sources[@]}"; do
    sources=("$file")
    code_row "Cortex-M4F gcc -Os: $(basename "$file")" arm-none-eabi-size arm-none-eabi-gcc -Os "${m4f[@]}"
done

# shellcheck shell=bash
# Common parts of the checks in this folder, in tests/targets and of tools/sizes.sh. Sourced.

# shellcheck disable=SC2034 # used by files that source this one
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# The library's sources, including those in folders of lib/; they compile with -I"$root/lib".
# shellcheck disable=SC2034
mapfile -t library_sources < <(find "$root/lib" -name '*.c' | sort)

# The same with the flight layer, its MAVLink messages and the square root of the ports, which follow the same rules; they compile with
# "${all_includes[@]}".
# shellcheck disable=SC2034
mapfile -t all_sources < <(find "$root/lib" "$root/port/flight" "$root/port/mavlink" "$root/port/sqrtf" -name '*.c' | sort)
# shellcheck disable=SC2034
all_includes=(-I"$root/lib" -I"$root/port/flight" -I"$root/port/mavlink" -I"$root/port/sqrtf")

# The host compilers that are installed.
compilers() {
    local name
    for name in "$@"; do
        if command -v "$name" >/dev/null; then
            echo "$name"
        fi
    done
}

# takes <flag>...: whether $compiler accepts the flags for $language without a message
takes() {
    echo 'int main(void) { return 0; }' |
        "$compiler" -Werror "$@" -x "$language" - -o "$scratch/probe" >/dev/null 2>&1
}

# known <compiler> <flag>...: the flags that this compiler accepts without a message, one a line.
known() {
    local compiler=$1 flag language=c
    [[ $compiler != *++* ]] || language=c++
    shift
    if takes "$@"; then # all flags at once, which most compilers accept
        printf '%s\n' "$@"
        return
    fi
    for flag in "$@"; do
        if takes "$flag"; then
            echo "$flag"
        fi
    done
}

fail() {
    echo "FAILED: $*" >&2
    exit 1
}

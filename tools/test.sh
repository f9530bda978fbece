#!/usr/bin/env bash
# Sets up, builds and runs every test. Says at the end what was skipped. Exit status 0: nothing failed.
#
#   tools/test.sh           everything
#
# Every step's full output is kept in .cache/test/. GOE_KITTI_DIR names a folder of recorded flights to compare
# goe_replay with the references on; UNITY_DIR the sources of the Unity test framework, where they are not to be fetched.
set -uo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root" || exit 1
logs=.cache/test
rm -rf $logs
mkdir -p $logs
python=$root/.venv/bin/python
flights=${GOE_KITTI_DIR:-../shared/data/kitti}
export GOE_REPLAY=$root/build/sim_host/goe_replay
export OPENBLAS_NUM_THREADS=1 # numpy: the matrices are small, threads only get into each other's way

failed=()
skipped=()

log_of() { echo "$logs/$(tr -c '[:alnum:]\n' _ <<<"$1").log"; }

# step <name> <command>...: quiet if it succeeds
step() {
    local name=$1 start=$SECONDS log
    log=$(log_of "$1")
    shift
    if "$@" >"$log" 2>&1; then
        printf 'ok      %-44s %4d s\n' "$name" $((SECONDS - start))
    else
        printf 'FAILED  %-44s %4d s   %s\n' "$name" $((SECONDS - start)) "$log"
        echo "--------------------------------------------------------------------------- last lines of $log"
        tail -n "${tail_lines:-60}" "$log"
        echo "---------------------------------------------------------------------------"
        failed+=("$name")
        return 1
    fi
}

skip() { skipped+=("$1"); }

has() { command -v "$1" >/dev/null; }

# closing <name> <pattern>: the lines of a step's log that tell its result
closing() { grep -E "$2" "$(log_of "$1")" | sed 's/^/        /'; }

finish() {
    echo
    if [ ${#skipped[@]} != 0 ]; then
        printf 'skipped: %s\n' "${skipped[@]}"
    else
        echo "skipped: nothing"
    fi
    if [ ${#failed[@]} != 0 ]; then
        printf 'FAILED: %s\n' "${failed[@]}"
        exit 1
    fi
    echo "all tests passed in $SECONDS s"
    exit 0
}

configure() { cmake --preset "$1" -DGOE_BUILD_TESTS=ON ${UNITY_DIR:+-DUNITY_DIR="$UNITY_DIR"}; }
build() { configure "$1" && cmake --build --preset "$1"; }
build_and_ctest() { build "$1" && ctest --preset "$1" -j "$jobs"; }

sources() { find lib sim_host tests -name '*.[ch]' -o -name '*.cpp'; }
check_format() { sources | xargs clang-format-19 --dry-run -Werror; }
tidy() {
    find "$root/lib" "$root/sim_host" -name '*.c' -print0 |
        xargs -0 -n 1 -P "$jobs" clang-tidy-19 --quiet -p build-clang 2>&1 | sed '/warnings\{0,1\} generated\.$/d'
}

# The sanitizers' goe_replay over every log of the tests.
replay_sanitized() {
    local folder
    for folder in tests/data/*/; do
        build-asan/sim_host/goe_replay --out "$logs/sanitized.csv" "$folder" || return 1
    done
}

test_replay_sanitized() { GOE_REPLAY=$root/build-asan/sim_host/goe_replay run_pytest tests/host; }
run_pytest() { "$python" -m pytest -q -rs -p no:cacheprovider -c tools/pyproject.toml "$@"; }

jobs=$(nproc)
tools/setup.sh || exit 1

if ! step "build" build default; then
    skip "everything else, as nothing could be built"
    finish
fi

if step "ctest" ctest --preset default -j "$jobs"; then # every target under QEMU among it
    closing ctest 'tests passed|Total Test time'
fi
while read -r name; do
    skip "ctest: $name"
done < <(sed -nE 's/.* Test +#[0-9]+: ([a-z0-9_]+) \.*\*\*\*(Skipped|Not Run).*/\1/p' $logs/ctest.log)

if step "pytest" run_pytest tests; then
    closing pytest '(passed|failed|skipped).* in [0-9.]+'
    while read -r reason; do skip "pytest: $reason"; done < <(sed -n 's/^SKIPPED //p' $logs/pytest.log)
fi

step "golden data are what their generator makes" "$python" -m goe_tools golden --check tests/c/golden
step "embedded logs are what their generator makes" \
    "$python" -m goe_tools embed_logs --out tests/targets/embedded_logs.c --check
if has arm-none-eabi-gcc && has qemu-system-arm && has riscv64-unknown-elf-gcc && has qemu-system-riscv32; then
    step "cost ledger" "$python" -m goe_tools ledger --check
else
    skip "cost ledger (needs the ARM and RISC-V compilers and QEMU)"
fi
step "ruff" "$python" -m ruff check --config tools/pyproject.toml tools tests
step "compare with the references: tests/data" "$python" -m goe_tools compare tests/data/*/
if [ -d "$flights" ]; then
    step "compare with the references: recorded flights" "$python" -m goe_tools compare "$flights"/*/
else
    skip "comparison on recorded flights: no folder $flights (GOE_KITTI_DIR)"
fi

if step "sanitizers" build_and_ctest asan; then
    closing sanitizers 'tests passed'
    step "sanitizers: goe_replay on logs" replay_sanitized
    step "sanitizers: goe_replay on bad input" test_replay_sanitized && closing "sanitizers: goe_replay on bad input" passed
fi

if has clang-19; then
    step "clang" build_and_ctest clang && closing clang 'tests passed'
else
    skip "clang: unit tests and the firmwares' flags (no clang-19)"
fi
if has clang-19 && has clang-tidy-19; then
    step "clang-tidy" tidy
else
    skip "clang-tidy (needs clang-19 and clang-tidy-19)"
fi
if has clang-format-19; then
    step "clang-format" check_format
else
    skip "clang-format (not installed)"
fi
if has shellcheck; then
    step "shellcheck" shellcheck tools/*.sh tests/flags/*.sh tests/targets/*.sh .ci/run
else
    skip "shellcheck (not installed)"
fi
finish

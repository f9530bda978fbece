#!/usr/bin/env bash
# Sets up, builds and runs the tests. Names at the end the skipped steps and the slowest ones. Exit status 0: nothing
# failed.
#
#   tools/test.sh           everything
#   tools/test.sh --quick   build, unit tests, golden hashes, and the Python tests that the latest changes affect: those
#                           since the branch main, or since GOE_SINCE; on main since the commit before. After 150 s, and
#                           60 s after the build, no further Python test begins; the skipped ones are counted
#
# Two steps run at a time. A line for each appears when it has ended, with its own time and that of the processors. Every step's full
# output is kept in .cache/test/. Ctrl-C ends all that runs. GOE_KITTI_DIR names a folder of recorded flights to compare goe_replay
# with the references on; UNITY_DIR the sources of the Unity test framework, where they are not to be fetched. CI=true: a missing
# tool is a failure. GOE_LONG=1: also what a release needs: every target, compiler, level and part, the quick part of
# the proof, the analyzer of clang-tidy, and the Python tests marked release.
set -uo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root" || exit 1
quick=false
case ${1:-} in
    --quick) quick=true ;;
    '') ;;
    *)
        sed -n '2,/^set/ { /^#/ s/^# \{0,1\}//p }' "$0" >&2
        exit 2 ;;
esac
logs=.cache/test
rm -rf $logs
mkdir -p $logs
python=$root/.venv/bin/python
flights=${GOE_KITTI_DIR:-../shared/data/kitti}
export GOE_REPLAY=$root/build/sim_host/goe_replay
export OPENBLAS_NUM_THREADS=1 # numpy: the matrices are small, threads only get into each other's way

# -------------------------------------------------------------------------------------------------------------- steps

# All by a step's name.
steps=()
declare -A command_of=() after_of=() shows_of=() start_of=()
declare -A state_of=() # waiting, running, ok, failed, left out
declare -A name_of_process=() # those that run
declare -A wall_of=() processor_of=()
skipped=()
missing=()
side_by_side=2
tail_lines=60
quick_s=150 # of a quick run, after which no further Python test begins ...
affected_s=60 # ... but so long they begin after the build, however long the set-up took

log_of() { echo "$logs/$(tr -c '[:alnum:]\n' _ <<<"$1").log"; }

# add <name> <command>...: a step for run_steps. With after=<name>: once that one has succeeded. With shows=<pattern>: the
# lines of its log that show its result.
add() {
    local name=$1
    shift
    steps+=("$name")
    command_of[$name]=$(printf '%q ' "$@")
    after_of[$name]=${after:-}
    shows_of[$name]=${shows:-}
    state_of[$name]=waiting
}

# In a process group of its own, to end it together with all that it starts.
start() {
    local name=$1 log
    log=$(log_of "$name")
    set -m
    {
        TIMEFORMAT='%0U %0S'
        time eval "${command_of[$name]}" >"$log" 2>&1
    } 2>"$log.time" </dev/null &
    set +m
    name_of_process[$!]=$name
    start_of[$name]=$SECONDS
    state_of[$name]=running
}

# The next step that may start, if there is one.
next_ready() {
    local name before
    for name in "${steps[@]}"; do
        [ "${state_of[$name]}" = waiting ] || continue
        before=${after_of[$name]}
        if [ -z "$before" ] || [ "${state_of[$before]}" = ok ]; then
            echo "$name"
            return
        fi
    done
}

# Their names, with commas between them.
running() {
    local name names=
    for name in "${steps[@]}"; do
        if [ "${state_of[$name]}" = running ]; then
            names="${names:+$names, }$name"
        fi
    done
    echo "$names"
}

# On a terminal the line below the results names what runs.
show_running() {
    [ ! -t 1 ] || printf '\r\033[K...     %s' "$(running)"
}

# report <name> <exit status>
report() {
    local name=$1 status=$2 log wall user system word
    log=$(log_of "$name")
    wall=$((SECONDS - start_of[$name]))
    read -r user system < <(tail -n 1 "$log.time")
    rm -f "$log.time"
    word=ok
    state_of[$name]=ok
    if [ "$status" != 0 ]; then
        word=FAILED
        state_of[$name]=failed
    fi
    [ ! -t 1 ] || printf '\r\033[K'
    printf '%-7s %-46s %4d s   processor %4d s\n' $word "$name" $wall $((user + system))
    wall_of[$name]=$wall
    processor_of[$name]=$((user + system))
    processor_s=$((processor_s + user + system))
    if [ $word = FAILED ]; then
        echo "--------------------------------------------------------------------------- last lines of $log"
        tail -n $tail_lines "$log"
        echo "---------------------------------------------------------------------------"
    elif [ -n "${shows_of[$name]}" ]; then
        grep -E "${shows_of[$name]}" "$log" | sed 's/^/        /'
    fi
}

# Runs all steps that are waiting, and what may start after them.
run_steps() {
    local name process status
    while true; do
        while [ ${#name_of_process[@]} -lt $side_by_side ]; do
            name=$(next_ready)
            [ -n "$name" ] || break
            start "$name"
        done
        [ ${#name_of_process[@]} != 0 ] || break
        show_running
        wait -n -p process
        status=$?
        name=${name_of_process[${process:-0}]:-}
        if [ -n "$name" ]; then
            unset "name_of_process[$process]"
            report "$name" $status
        fi
    done
    for name in "${steps[@]}"; do
        if [ "${state_of[$name]}" = waiting ]; then
            state_of[$name]="left out"
            skip "$name, as this failed: ${after_of[$name]}"
        fi
    done
}

# descendants <process>...: their children, and theirs
descendants() {
    local IFS=, children=()
    mapfile -t children < <(ps -o pid= --ppid "$*" | tr -d ' ')
    if [ ${#children[@]} != 0 ]; then
        printf '%s\n' "${children[@]}"
        descendants "${children[@]}"
    fi
}

# Ends all steps that run: by SIGINT first, which lets tests remove their files, then by SIGKILL.
end_all() {
    trap '' INT TERM HUP
    local process left
    mapfile -t left < <(descendants "${!name_of_process[@]}")
    for process in "${!name_of_process[@]}"; do
        kill -INT -- "-$process" 2>/dev/null
    done
    for _ in $(seq 30); do
        [ -n "$(jobs -r)" ] || break
        sleep 0.1
    done
    for process in "${!name_of_process[@]}"; do
        kill -KILL -- "-$process" 2>/dev/null
    done
    [ ${#left[@]} = 0 ] || kill -KILL "${left[@]}" 2>/dev/null
    wait
}

interrupted() {
    local what
    what=$(running)
    end_all 2>/dev/null
    [ ! -t 1 ] || printf '\r\033[K'
    echo "interrupted: ${what:-set-up}"
    exit 130
}
trap interrupted INT TERM HUP

skip() { skipped+=("$1"); }

# A step that a missing tool leaves out.
lacks() {
    skip "$1"
    [ "${CI:-}" != true ] || missing+=("$1")
}

has() { command -v "$1" >/dev/null; }

show_slowest() {
    local name
    echo "slowest steps, and their share of the processors:"
    for name in "${!wall_of[@]}"; do
        printf '%6d s %6d s   %s\n' "${wall_of[$name]}" "${processor_of[$name]}" "$name"
    done | sort -rn | head -n 5
}

# The tests that failed in a step, by the summaries of pytest and CTest.
failed_tests() {
    sed -nE 's/^(FAILED|ERROR) (.*::.*)/        \2/p; s/^[[:space:]]*([0-9]+ - .* \((Failed|Timeout|Not Run|[A-Za-z ]*Exception[^)]*|SEGFAULT|Subprocess [a-z]+)\)).*/        \1/p' \
        "$(log_of "$1")"
}

finish() {
    local name failed=()
    for name in "${steps[@]}"; do
        [[ ${state_of[$name]} == ok || ${state_of[$name]} == "left out" ]] || failed+=("$name")
    done
    echo
    show_slowest
    [ ${#skipped[@]} = 0 ] || printf 'skipped: %s\n' "${skipped[@]}"
    [ ${#missing[@]} = 0 ] || printf 'FAILED, as CI must skip nothing: %s\n' "${missing[@]}"
    for name in "${failed[@]}"; do
        echo "FAILED: $name"
        failed_tests "$name"
    done
    if [ ${#failed[@]} != 0 ] || [ ${#missing[@]} != 0 ]; then
        echo "failed in $SECONDS s; ${#skipped[@]} skipped"
        exit 1
    fi
    echo "all tests passed in $SECONDS s, $processor_s s of the processors; ${#skipped[@]} skipped"
    exit 0
}

# ------------------------------------------------------------------------------------------------------- what they run

configure() { cmake --preset "$1" -DGOE_BUILD_TESTS=ON ${UNITY_DIR:+-DUNITY_DIR="$UNITY_DIR"}; }
build() { configure "$1" && cmake --build --preset "$1"; }
build_and_ctest() { build "$1" && ctest --preset "$1" -j "$jobs"; }

# Subjects of the newest commits: at most 72 characters, an imperative, no full stop.
subject_rule='^[A-Z][a-z-]+ .*[^.]$'
not_imperative='^(The|An?|This|That|It|What|Some|[A-Z][a-z]*(ing|ions?)) '
check_subjects() {
    local line bad=0
    git rev-parse --is-inside-work-tree >/dev/null 2>&1 || return 0
    while read -r line; do
        if [ ${#line} -gt 72 ] || ! [[ $line =~ $subject_rule ]] || [[ $line =~ $not_imperative ]]; then
            echo "subject of a commit: '$line': at most 72 characters, an imperative, no full stop" >&2
            bad=1
        fi
    done < <(git log --no-merges -n 50 --format=%s)
    return $bad
}

sources() { find lib port sim_host tests -name target -prune -o \( -name '*.[ch]' -o -name '*.[ch]pp' \) -print; }
check_format() { sources | xargs clang-format-19 --dry-run -Werror; }
# Its analyzer takes three quarters of the time: without it, gcc's analyzer alone reads lib/ and port/flight, and none the rest.
tidy() {
    local checks='-clang-analyzer-*'
    [ -z "${GOE_LONG:-}" ] || checks=
    "$python" -m ci tidy_commands .cache/evidence/coverage .cache/tidy || return 1
    find "$root"/{lib,port/{flight,mavlink,companion,sqrtf,examples,nuttx,zephyr},sim_host} -name '*.c' -print0 |
        xargs -0 -n 1 -P "$jobs" clang-tidy-19 --quiet --checks="$checks" -p .cache/tidy 2>&1 | sed '/warnings\{0,1\} generated\.$/d'
}

# Programs of the build with the sanitizers: over every log of the tests, and by the tests that try to break them.
replay_sanitized() {
    local folder
    for folder in tests/data/*/; do
        "$sanitized/sim_host/goe_replay" --out "$logs/sanitized.csv" "$folder" || return 1
    done
}

test_replay_sanitized() { GOE_REPLAY=$root/$sanitized/sim_host/goe_replay run_pytest tests/host; }
test_companion_sanitized() {
    GOE_COMPANION=$root/$sanitized/port/companion/goe_companion run_pytest tests/companion/test_companion_disturbed.py
}
# pytest_affected <part>: 0 or 1, every second file. Where all their tests are marked release, pytest returns 5.
pytest_affected() {
    local files status=0
    mapfile -t files < <(awk "NR % 2 == $1" "$logs/affected")
    if [ ${#files[@]} = 0 ]; then
        echo "the change affects no test in Python"
    else
        GOE_TESTS_END=$tests_end run_pytest "${files[@]}" || status=$?
        [ "$status" = 5 ] || return "$status"
    fi
}
run_pytest() { "$python" -m pytest -q -rfEs --rootdir "$root" -p no:cacheprovider -c tools/pyproject.toml "$@"; }

# ---------------------------------------------------------------------------------------------------------------- run

jobs=$(nproc)
export CMAKE_BUILD_PARALLEL_LEVEL=$jobs # of the first build, which runs alone
processor_s=0
check_subjects || exit 1
tools/setup.sh || exit 1

add "build" build default
run_steps
if [ "${state_of[build]}" != ok ]; then
    skip "everything else, as nothing could be built"
    finish
fi

if $quick; then
    add "ruff" "$python" -m ruff check --config tools/pyproject.toml tools tests port/python
    shows='tests passed' add "unit tests" ctest --preset default -L unit -j "$jobs"
    add "golden hashes" ctest --test-dir build/tests/targets --output-on-failure -R '^(flight_)?replay$'
    "$python" -m ci affected >"$logs/affected" || exit 1
    tests_end=$(($(date +%s) + (SECONDS < quick_s - affected_s ? quick_s - SECONDS : affected_s)))
    for part in 1 0; do
        shows='(passed|failed|skipped).* in [0-9.]+|affects no test' add "affected Python tests, part $part" pytest_affected $part
    done
    run_steps
    while read -r reason; do skip "pytest: $reason"; done < <(sed -n 's/^SKIPPED //p' $logs/affected*.log)
    finish
fi

# What takes a moment comes first, then what takes longest. The steps that run at a time share the processors: pytest, the longest,
# keeps one of two until it ends.
jobs=$(((jobs + side_by_side - 1) / side_by_side))
export CMAKE_BUILD_PARALLEL_LEVEL=$jobs
add "ruff" "$python" -m ruff check --config tools/pyproject.toml tools tests port/python
if has clang-format-19; then
    add "clang-format" check_format
else
    lacks "clang-format (not installed)"
fi
if has shellcheck; then
    add "shellcheck" shellcheck tools/*.sh tests/flags/*.sh tests/targets/*.sh .ci/run
else
    lacks "shellcheck (not installed)"
fi
add "golden data are what their generator makes" "$python" -m bench golden --check tests/c/golden
add "embedded logs are what their generator makes" \
    "$python" -m ci embed_logs --out tests/targets/embedded_logs.c --check
add "compare with the references: tests/data" "$python" -m bench compare tests/data/*/
if [ -d "$flights" ]; then
    add "compare with the references: recorded flights" "$python" -m bench compare "$flights"/*/
else
    skip "comparison on recorded flights: no folder $flights (GOE_KITTI_DIR)"
fi

# The longest first, in one process. tests/host and the hostile senders run below, with the sanitizers.
shows='(passed|failed|skipped).* in [0-9.]+' add "pytest" run_pytest tests \
    --ignore=tests/host --ignore=tests/companion/test_companion_disturbed.py
if [ -n "${GOE_LONG:-}" ] && has frama-c; then
    add "proof: quick part" "$python" -m ci evidence --quick --only proof --jobs 1
elif [ -n "${GOE_LONG:-}" ]; then
    lacks "proof (no frama-c)"
fi
# One build of clang counts what the unit tests reach, and has the sanitizers. Without clang gcc's has them.
sanitized=build-asan
sanitizers=sanitizers
if has clang-19 && has llvm-cov-19 && has llvm-profdata-19 &&
    find "$(clang-19 --print-resource-dir)/" -name 'libclang_rt.profile*' | grep -q .; then
    add "clang: build" build coverage
    sanitized=.cache/evidence/coverage
    sanitizers="clang: build"
    export LLVM_PROFILE_FILE=/dev/null # what counts names its own
    after="clang: build" shows='^\| coverage' add "sanitizers: unit tests and their coverage" \
        "$python" -m ci evidence --quick --only coverage --jobs "$jobs"
    after="sanitizers: unit tests and their coverage" shows='tests passed' add "sanitizers: other unit tests" \
        ctest --preset coverage -E '^(c|flight)_' -j "$jobs"
else
    shows='tests passed' add "sanitizers" build_and_ctest asan
    lacks "coverage of the unit tests (needs clang-19, llvm-19 and libclang-rt-19-dev)"
fi
if has clang-19 && has clang-tidy-19; then
    after="clang: build" add "clang-tidy" tidy
else
    lacks "clang-tidy (needs clang-19 and clang-tidy-19)"
fi
after=$sanitizers add "sanitizers: goe_replay on logs" replay_sanitized
shows=passed after=$sanitizers add "sanitizers: goe_replay on bad input" test_replay_sanitized
shows=passed after=$sanitizers add "sanitizers: goe_companion and hostile senders" test_companion_sanitized
left_out=release
[ -z "${GOE_LONG:-}" ] || left_out=nothing
shows='tests passed|Total Test time' add "ctest: targets" \
    ctest --test-dir build/tests/targets -LE "$left_out" --output-on-failure -j "$jobs" # under QEMU
if has arm-none-eabi-gcc && has qemu-system-arm && has riscv64-unknown-elf-gcc && has qemu-system-riscv32; then
    # Of the builds that ctest has made, three targets; a release measures all.
    after="ctest: targets" add "cost ledger" "$python" -m ci ledger --check m4f-gcc-os m4f-gcc-o2 m0plus-gcc-os
    after="cost ledger" add "cost of the flight layer" "$python" -m ci flight_cost
else
    lacks "cost ledger (needs the ARM and RISC-V compilers and QEMU)"
fi
shows='tests passed|Total Test time' add "ctest: all but targets" ctest --preset default -LE "targets|$left_out" -j "$jobs"
if has cppcheck && has gcc; then
    shows='MISSED' add "MISRA C:2012, gcc -fanalyzer" "$python" -m ci evidence --quick --only misra --only analyzers --jobs 1
else
    lacks "MISRA C:2012 and gcc -fanalyzer (no cppcheck or gcc)"
fi
run_steps

while read -r name; do
    skip "ctest: $name"
done < <(sed -nE 's/.* Test +#[0-9]+: ([a-z0-9_-]+) \.*\*\*\*(Skipped|Not Run).*/\1/p' $logs/ctest*.log)
while read -r reason; do skip "pytest: $reason"; done < <(sed -n 's/^SKIPPED //p' $logs/pytest.log)
finish

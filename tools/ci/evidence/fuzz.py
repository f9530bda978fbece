"""Fuzzing: looks for inputs that violate a promise, and counts those that do not.

Targets are those of tests/fuzz. Quick: every corpus, and some seconds of random inputs. Long: slices of a minute, with
counts kept in ``.cache/evidence/fuzz_state.json``, so a stopped run continues; updates of the library until the goal
is reached, plain and under the sanitizers, and a share of time for every other target.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from pathlib import Path

from goe_tools.places import ROOT

from .fuzz_state import Build, State, read_state, write_state
from .parts import Amount, NotHereError
from .record import Result, Row

HASH = ROOT / "tests" / "targets" / "golden_hash.txt"
CORPUS = ROOT / "tests" / "fuzz" / "corpus"
FOLDER = ROOT / ".cache" / "evidence"
UPDATES = 1_000_000_000
SANITIZED_SHARE = 10  # one update in this many runs under the sanitizers
SLICE_S = 60.0
OTHERS_S = {"quick": 1.0, "long": 180.0}  # for each target except the estimator, in each build
FUZZER_S = 120  # libFuzzer's search, each target
QUICK_S = 14.0  # for the estimator, quick
SCRATCH = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None  # for parsers of files: in memory
BROKEN = "inputs that broke something"
LEAST_SEEN = 1  # least updates with a status that counts as reached

PLAIN = Build("default", "build")
SANITIZED = Build("fuzz", "build-fuzz")
MEMORY = Build("fuzz-msan", "build-fuzz-msan")
# Targets for MSan: code of the project only.
WITHOUT_LIBRARIES = ("estimator", "flips", "flight", "mavlink", "text")
TARGETS = (*WITHOUT_LIBRARIES, "log", "simulation", "companion")

# Abort on errors, which keeps the input; no leak checks of a program that counts its end with atexit().
OPTIONS = {
    "ASAN_OPTIONS": "abort_on_error=1:detect_leaks=1",
    "UBSAN_OPTIONS": "print_stacktrace=1:halt_on_error=1:abort_on_error=1",
    "MSAN_OPTIONS": "abort_on_error=1",
}


class BrokenError(Exception):
    """A target failed; the text describes how."""


# ------------------------------------------------------------------------------------------------------------- programs


def build(of: Build, targets: list[str], jobs: int) -> None:
    """Updates a build folder."""
    if not (ROOT / of.folder / "CMakeCache.txt").exists():
        _run(["cmake", "--preset", of.preset, "-DGOE_BUILD_TESTS=ON"])
    _run(["cmake", "--build", "--preset", of.preset, "-j", str(jobs), "--target", *targets])


def _run(command: list[str]) -> str:
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise BrokenError(
            f"{' '.join(command)}: exit status {done.returncode}\n{done.stdout[-2000:]}{done.stderr[-2000:]}"
        )
    return done.stdout


def program(of: Build, target: str, kind: str = "fuzz") -> Path:
    return ROOT / of.folder / "tests" / "fuzz" / f"{kind}_{target}"


def corpus(target: str) -> list[str]:
    """Text is mutated from its corpus; the estimator and the flight layer also take longer, arbitrary bytes."""
    return [] if target in ("estimator", "flips", "flight", "mavlink") else [str(CORPUS / target)]


def drive(of: Build, target: str, arguments: list[str], keep: Path) -> dict[str, float]:
    """Runs a target and returns its counts."""
    with tempfile.TemporaryDirectory(dir=SCRATCH) as scratch:
        command = [str(program(of, target)), "--keep", str(keep), *arguments]
        environment = {**os.environ, **OPTIONS, "TMPDIR": scratch}
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", env=environment, check=False)
    if done.returncode != 0:
        raise BrokenError(f"{' '.join(command)}: exit status {done.returncode}\n{done.stderr[-3000:]}")
    counts: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return counts


def edges_of(log: str) -> int:
    """libFuzzer's latest count of covered edges."""
    found = [line.split("cov: ")[1].split()[0] for line in log.splitlines() if "cov: " in line]
    return int(found[-1]) if found else 0


def search(target: str, keep: Path, seconds: int) -> dict[str, float]:
    """Runs libFuzzer from a growing copy of the corpus in .cache."""
    grown = FOLDER / "corpus" / target
    grown.mkdir(parents=True, exist_ok=True)
    command = [
        str(program(SANITIZED, target, "libfuzzer")), f"-max_total_time={seconds}", "-timeout=60", "-rss_limit_mb=2048",
        "-max_len=4096", "-print_final_stats=1", f"-artifact_prefix={keep}/broken-libfuzzer-{target}-", str(grown),
        str(CORPUS / target),
    ]  # fmt: skip
    with tempfile.TemporaryDirectory(dir=SCRATCH) as scratch:
        environment = {**os.environ, **OPTIONS, "TMPDIR": scratch}
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", env=environment, check=False)
    if done.returncode != 0:
        raise BrokenError(f"{' '.join(command)}: exit status {done.returncode}\n{done.stderr[-3000:]}")
    runs = [line.split()[-1] for line in done.stderr.splitlines() if "stat::number_of_executed_units" in line]
    return {"runs": float(runs[-1]) if runs else 0.0, "seconds": float(seconds), "edges": float(edges_of(done.stderr))}


# ----------------------------------------------------------------------------------------------------------------- jobs


@dataclass(frozen=True)
class Job:
    of: Build
    target: str
    seconds: float
    fuzzer: bool = False  # libFuzzer's search

    @property
    def name(self) -> str:
        return f"{self.of.preset}/{self.target}" + ("/libfuzzer" if self.fuzzer else "")


def next_job(state: State, updates: int, busy: list[Job]) -> Job | None:
    """The job farthest from its goal; None once all goals are met, or in progress."""
    goals = {PLAIN: updates - updates // SANITIZED_SHARE, SANITIZED: updates // SANITIZED_SHARE}
    share: dict[Job, float] = {}
    for of, goal in goals.items():
        job = Job(of, "estimator", SLICE_S)
        share[job] = state.count(job.name, "updates") / goal
    others = [Job(of, target, SLICE_S) for of in (SANITIZED, MEMORY) for target in TARGETS if _has(of, target)]
    others += [Job(SANITIZED, target, float(FUZZER_S), True) for target in TARGETS]
    for job in others:
        wanted = FUZZER_S if job.fuzzer else OTHERS_S["long"]
        if job not in busy:
            share[job] = state.count(job.name, "seconds") / (wanted - 1.0)
    job = min(share, key=lambda job: share[job])
    return job if share[job] < 1.0 else None


def _has(of: Build, target: str) -> bool:
    if of == MEMORY:
        return target in WITHOUT_LIBRARIES
    return target != "estimator"  # has a separate goal


def run_job(job: Job, seed: int, keep: Path) -> dict[str, float]:
    if job.fuzzer:
        return search(job.target, keep, int(job.seconds))
    arguments = ["--random", str(seed), "--seconds", str(job.seconds), *corpus(job.target)]
    return drive(job.of, job.target, arguments, keep)


def run_slices(state: State, updates: int, jobs: int, keep: Path, place: Path) -> None:
    """Runs until all goals are met, or something broke. Keeps the counts after every slice."""
    running: dict[Future[dict[str, float]], Job] = {}
    with ThreadPoolExecutor(jobs) as pool:
        while True:
            while len(running) < jobs and not state.broken:
                job = next_job(state, updates, list(running.values()))
                if job is None:
                    break
                running[pool.submit(run_job, job, state.next_seed(), keep)] = job
            if not running:
                return
            for done in wait(running, return_when=FIRST_COMPLETED).done:
                job = running.pop(done)
                try:
                    state.add(job.name, done.result())
                except BrokenError as error:
                    state.broken.append(f"{job.name}: {error}")
                write_state(place, state)


# ----------------------------------------------------------------------------------------------------------------- rows


def run_corpora(state: State, of: Build, targets: tuple[str, ...], keep: Path) -> None:
    for target in targets:
        try:
            state.add(f"{of.preset}/{target}/corpus", drive(of, target, [str(CORPUS / target)], keep))
        except BrokenError as error:
            state.broken.append(f"{target}: {error}")


def number(value: float) -> str:
    return f"{value:,.0f}"


def rows_of(state: State, updates: int) -> list[Row]:
    plain = state.count("default/estimator", "updates")
    sanitized = state.sum_over("fuzz/estimator", "updates")
    memory = state.count("fuzz-msan/estimator", "updates")
    counts = state.all_of("estimator")
    statuses = {name: count for name, count in counts.items() if name.startswith("status_")}
    reached = [name for name, count in statuses.items() if count >= LEAST_SEEN]
    kinds = ("fresh_window", "fresh_refined", "fresh_window_with_filter")
    fresh = sum(counts.get(name, 0.0) for name in kinds)
    goal = updates // SANITIZED_SHARE
    rows = [
        Row("updates through goe_update, every answer checked", number(plain + sanitized + memory), number(updates),
            plain + sanitized + memory >= updates),
        Row("... of them under ASan and UBSan", number(sanitized), number(goal), sanitized >= goal),
        Row("... under MSan", number(memory), "some", memory > 0),
        Row("... with method window, filter", f"{number(counts.get('updates_window', 0))}, "
            f"{number(counts.get('updates_refined', 0))}", "both", None),
        Row("... with a new solution", number(fresh), "", None),
        Row("... with target motion estimated; with late poses detected",
            f"{number(counts.get('movers_followed', 0))}; {number(counts.get('latency_reported', 0))}", "both",
            min(counts.get("movers_followed", 0), counts.get("latency_reported", 0)) > 0),
        Row("bits flipped in flight", number(state.all_of("flips").get("flips", 0.0)), "some",
            state.all_of("flips").get("flips", 0.0) > 0),
        Row("statuses of images reached", f"{len(reached)} of {len(statuses)}", "all", len(reached) == len(statuses)),
        Row(BROKEN, str(len(state.broken)), "0", not state.broken),
    ]  # fmt: skip
    for target in TARGETS:
        runs = sum(counts.get("runs", 0.0) for name, counts in state.counts.items() if name.split("/")[1] == target)
        edges = state.count(f"fuzz/{target}/libfuzzer", "edges")
        rows.append(Row(f"inputs of {target}", number(runs), "", None))
        if edges > 0:
            rows.append(Row(f"... edges covered, {target}", number(edges), "", None))
    return rows


def report_of(state: State) -> str:
    lines = ["Counts of each build and target."]
    for name, counts in sorted(state.counts.items()):
        lines += ["", name] + [f"  {what:32} {number(count):>16}" for what, count in counts.items()]
    lines += ["", *state.broken]
    return "\n".join(lines)


def run_quick(jobs: int, keep: Path) -> State:
    """Uses only the default build: the tests run the corpora under the sanitizers."""
    state = State(HASH.read_text().split()[0])
    build(PLAIN, [f"fuzz_{target}" for target in TARGETS], jobs)
    run_corpora(state, PLAIN, TARGETS, keep)
    for target in TARGETS:
        seconds = QUICK_S if target == "estimator" else OTHERS_S["quick"]
        try:
            state.add(f"default/{target}", run_job(Job(PLAIN, target, seconds), state.next_seed(), keep))
        except BrokenError as error:
            state.broken.append(f"{target}: {error}")
    return state


def still_broken(keep: Path) -> list[str]:
    """Kept inputs of earlier runs that still fail; removes the others, and fuzzing continues."""
    failing = []
    for path in sorted(keep.glob("broken-*")):
        name = path.name.split("-")
        target = name[2] if name[1] == "libfuzzer" else name[1].replace("fuzz_", "", 1)
        try:
            drive(SANITIZED, target, [str(path)], keep)
            path.unlink()
        except BrokenError as error:
            failing.append(f"{path.name}: {error}")
    return failing


def run_long(updates: int, jobs: int, keep: Path) -> State:
    if shutil.which("clang-19") is None:
        raise NotHereError("clang-19 is not installed")
    place = FOLDER / "fuzz_state.json"
    state = read_state(place, HASH.read_text().split()[0])
    build(PLAIN, ["fuzz_estimator"], jobs)
    build(SANITIZED, [f"{kind}_{target}" for kind in ("fuzz", "libfuzzer") for target in TARGETS], jobs)
    build(MEMORY, [f"fuzz_{target}" for target in WITHOUT_LIBRARIES], jobs)
    state.broken = still_broken(keep)
    run_slices(state, updates, jobs, keep, place)
    return state


def run(amount: Amount) -> Result:
    keep = FOLDER / "broken"
    keep.mkdir(parents=True, exist_ok=True)
    updates = amount.updates or UPDATES
    try:
        state = run_long(updates, amount.jobs, keep) if amount.long else run_quick(amount.jobs, keep)
    except BrokenError as error:
        raise RuntimeError(f"the targets cannot be built: {error}") from None
    rows = rows_of(state, updates)
    if not amount.long:  # the goals of a long run do not apply to a quick one
        rows = [
            row if row.what.startswith("inputs that broke") else Row(row.what, row.figure, "", None) for row in rows
        ]
    return Result(rows, report_of(state))

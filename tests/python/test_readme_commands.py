"""Every command in a README is run: here with small arguments, or by the test or step that a table names."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path

import pytest
from bench.__main__ import main as bench_main
from bench.optimum.goals import command as goals
from bench.optimum.goals import work
from bench.optimum.goals.goal import Goal
from goe_tools.__main__ import main
from goe_tools.flights import box_logs
from goe_tools.library import ready
from goe_tools.live.modules import missing
from synthetic_campaign import write_campaign

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ("lib", "port", "sim_host", "tests", "tools")
PROGRAMS = ("goe_replay", "goe_sim", "goe_campaign", "goe_avoid", "goe_companion", "cmake", "ctest")
SECONDS = 1800  # guard against a hang
ODMD_CLIPS = 40  # of each set's 800

# ------------------------------------------------------------------------------------------------ what the READMEs say


def pages() -> list[Path]:
    """README.md of all folders, and the other pages of tests/."""
    return [ROOT / "README.md", *sorted(page for folder in FOLDERS for page in (ROOT / folder).rglob("*.md"))]


def is_command(text: str) -> bool:
    words = text.split()
    if not words or words[0].endswith("/"):
        return False
    if words[0] in PROGRAMS or words[:2] in (["python", "-m"], ["python3", "-m"]):
        return True
    is_program = "/" in words[0] and not (ROOT / words[0]).is_dir() and Path(words[0]).suffix in ("", ".sh")
    return words[0].endswith(".sh") or (is_program and words[0].split("/")[0] in ("tools", "build"))


def commands_of(text: str) -> list[str]:
    """All commands of a page, verbatim: in sh blocks, in indented blocks, in code within a line."""
    found: list[str] = []
    text = text.replace("\\\n", " ")
    for block in re.findall(r"^```sh\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        lines = [re.sub(r"(^|\s)#.*", "", line) for line in block.splitlines()]
        found += [line for line in lines if line.strip()]
    text = re.sub(r"^```.*?^```$", "", text, flags=re.MULTILINE | re.DOTALL)
    found += [line for line in re.findall(r"^ {4}(\S.*)$", text, re.MULTILINE) if is_command(line)]
    found += [code for code in re.findall(r"(?<!`)`([^`]+)`(?!`)", text) if is_command(code)]
    return [" ".join(part.split()) for line in found for part in line.split("&&")]


def named(command: str) -> str:
    """A command without the parts that its user fills in: options in brackets, words such as DIR, FILE.html or
    <preset>."""
    words = re.sub(r"\[[^\]]*\]", "", command).split()
    return " ".join(word for word in words if not re.fullmatch(r"[A-Z]+(\.[a-z]+)?|<[^>]*>", word))


def all_commands() -> dict[str, str]:
    """The first page that names each command, by the command's name."""
    places: dict[str, str] = {}
    for page in pages():
        for command in commands_of(page.read_text(encoding="utf-8")):
            places.setdefault(named(command), str(page.relative_to(ROOT)))
    return places


# ---------------------------------------------------------------------------------------- what runs them, and what here


@dataclass(frozen=True)
class By:
    """The test or step that runs a command. ``words``: the text of the call there."""

    file: str
    words: str


# A key that ends in "..." covers all commands that begin with it.
CHAIN = 'CHAIN, EXAMPLE = ("convert", "goe_replay", "table", "view"), ("goe_sim",)'
RUN_BY = {
    "tools/test.sh": By(".ci/run", "tools/test.sh"),
    "tools/test.sh --quick": By("tests/python/test_test_run.py", '"tools/test.sh", "--quick"'),
    "cmake --install": By("tests/CMakeLists.txt", "--install"),
    "cmake --install build": By("tests/python/test_install.py", '"cmake", "--install", BUILD'),
    "cc -Ilib ...": By("tests/python/test_examples.py", 'r"^cc '),
    "cmake -S . -B build-deb ...": By("tests/python/test_packages_hosts.py", "(cmake .*)"),
    "cmake --build build-deb": By("tests/python/test_packages_hosts.py", "(cmake .*)"),
    "cmake --build build-deb --target package": By(
        "tests/python/test_packages_hosts.py", '"cmake", "--build", build, "--target", "package"'
    ),
    "cc main.c $(pkg-config --cflags --libs goe-flight) -o main": By(
        "tests/python/test_packages_hosts.py", 'passed("cc", source, *flags'
    ),
    "conan create .": By("tests/python/test_packages_hosts.py", "conan create ."),
    'conan create . -o "&:with_target_motion=False"': By(
        "tests/python/test_packages_hosts.py", "conan create . -o '&:with_target_motion=False'"
    ),
    "python -m ci packages --check": By("tests/python/test_packages.py", '"packages", "--check"'),
    "python -m ci packages --sbom": By("tests/python/test_sbom.py", '"packages", "--sbom"'),
    "python -m ci packages --write": By("tests/python/test_packages.py", '"packages", "--write"'),
    "python -m ci packages --target ...": By("tests/python/test_packages.py", '"packages", "--target"'),
    "pip install ./port/python": By(
        "tools/setup.sh", "pip install --quiet --disable-pip-version-check --no-build-isolation"
    ),
    "cmake --preset": By("tools/test.sh", "cmake --preset"),
    "cmake --build --preset": By("tools/test.sh", "cmake --build --preset"),
    "ctest --preset": By("tools/test.sh", "ctest --preset"),
    "build/tests/targets/replay": By("tests/targets/host.cmake", "goe_check_hash(replay replay)"),
    "build/tests/targets/flight_replay": By("tests/targets/host.cmake", "goe_check_flight_hash(flight_replay"),
    "build/tests/fuzz/fuzz_estimator --random 1 --seconds 20": By("tools/ci/evidence/fuzz.py", "fuzz_estimator"),
    "python -m ci evidence --long --only fuzz": By("tests/python/test_evidence_fuzz.py", '"evidence", "--long"'),
    "build/tests/flight/flight_recorded": By("tests/flight/CMakeLists.txt", "flight_recorded"),
    "host_builds.sh": By("tests/targets/host.cmake", "host_builds.sh"),
    "host_self_check.sh": By("tests/targets/host.cmake", "host_self_check.sh"),
    "build_target.sh": By("tests/targets/host.cmake", "build_target.sh"),
    "tests/parts/parts.sh": By("tests/CMakeLists.txt", "parts/parts.sh"),
    "tests/flags/invariants.sh": By("tests/CMakeLists.txt", "flags/invariants.sh"),
    "tools/api_pages.sh": By("tests/python/test_api_pages.py", '"tools" / "api_pages.sh"'),
    "tools/evidence.sh": By("tests/python/test_evidence.py", '"tools" / "evidence.sh"'),
    "tools/evidence.sh ...": By("tests/python/test_evidence.py", '"tools" / "evidence.sh"'),
    "tools/setup.sh": By("tools/test.sh", "setup.sh"),
    "goe_replay": By("tests/host/test_replay.py", "goe_replay"),
    "goe_replay log --out estimates.csv": By("tests/python/test_chain.py", CHAIN),
    "goe_sim --obstacle ...": By("tests/python/test_chain.py", CHAIN),
    "python -m goe_tools table...": By("tests/python/test_chain.py", CHAIN),
    "python -m goe_tools view log --out log.html": By("tests/python/test_chain.py", CHAIN),
    "goe_replay --set": By("tests/host/test_replay.py", '"--set"'),
    "goe_replay --settings": By("tools/ci/settings_table.py", '"--settings"'),
    "goe_sim": By("tests/sim/test_sim_log.py", "goe_sim"),
    "goe_sim --features": By("tests/sim/test_sim_boxes.py", '"--features"'),
    "goe_campaign": By("tests/sim/test_campaign.py", "goe_campaign"),
    "goe_campaign --part K/N": By(
        "tests/sim/test_campaign.py", 'goe_campaign, folder, "--studies", "paper", "--series"'
    ),
    "goe_companion": By("tests/companion/companion.py", "goe_companion"),
    "build/port/companion/goe_companion port/companion/companion.ini": By(
        "tests/companion/companion.py", '"companion" / "goe_companion"'
    ),
    "goe_avoid --several --new-ids": By("tests/sim/test_avoid.py", '"--new-ids"'),
    "goe_avoid --several": By("tests/sim/test_avoid.py", '"--several"'),
    "cmake --preset default": By("tools/test.sh", 'cmake --preset "$1"'),
    "cmake --build --preset default": By("tools/test.sh", 'cmake --build --preset "$1"'),
    "cmake --build --preset default --target goe_companion": By("tools/test.sh", 'cmake --build --preset "$1"'),
    "goe_avoid": By("tests/sim/test_avoid.py", "goe_avoid"),
    "python -m bench attack_tables --write": By("tests/python/test_attack.py", '"attack_tables"'),
    "python -m goe_tools bound": By("tests/python/test_optimum.py", '"bound"'),
    "python -m goe_tools campaign --out": By("tests/python/test_spread.py", '"campaign", "--studies"'),
    "python -m bench compare": By("tests/python/test_compare.py", '"compare"'),
    "python -m goe_tools convert...": By("tests/python/test_convert.py", '"convert", f"--{kind}"'),
    "python -m goe_tools mcap...": By("tests/python/test_mcap.py", '"mcap", str(folder), "--out"'),
    "python -m bench lies...": By("tests/python/test_lies.py", '"lies", "--flights"'),
    "python -m goe_tools montecarlo...": By("tests/python/test_montecarlo.py", '"montecarlo", str(scenario), "--runs"'),
    "python -m goe_tools noise...": By("tests/python/test_noise.py", '"noise", *logs'),
    "python -m ci embed_logs": By("tools/test.sh", "ci embed_logs"),
    "python -m ci evidence ...": By("tests/python/test_evidence_requirements.py", '"evidence", how'),
    "python -m ci flight_cost": By("tools/test.sh", "ci flight_cost"),
    "python -m ci ledger": By("tools/test.sh", "ci ledger"),
    "python -m ci ledger --check": By("tools/test.sh", "ci ledger --check"),
    "python -m ci ledger --write": By("tests/python/test_cost.py", '"ledger", "--write"'),
    "python -m goe_tools live --out live.html": By("tests/python/test_live_page.py", '"live", "--out"'),
    "python -m goe_tools offline": By("tests/python/test_optimum.py", '"offline"'),
    "python -m bench peers": By("tests/python/test_peers.py", "peers"),
    "python -m bench peers --quick": By("tests/python/test_peers.py", '"peers", "--quick"'),
    "python -m bench peers update --tinyekf": By("tests/python/test_peers.py", '"peers", "--quick"'),
    "python -m bench peers window --cmsis-dsp": By("tests/python/test_peers.py", '"peers", "--quick"'),
    "python -m goe_tools report --table --out": By("tools/demo.sh", "report $campaign --table --out"),
    "python -m goe_tools scene ...": By("tests/python/test_scene.py", "python -m goe_tools scene"),
    "python -m goe_tools jsbsim_flight": By("tests/sim/test_sim_jsbsim.py", "jsbsim_flight"),
    "python -m goe_tools view": By("tests/python/test_view_command.py", '"view"'),
    "python -m goe_tools view --png --theme dark": By("tests/python/test_view_command.py", '"view"'),
    "python -m goe_tools view --svg": By("tests/python/test_view_command.py", '"view"'),
    "python -m ci settings --write lib/README.md": By("tests/python/test_settings_table.py", '"settings", "--write"'),
    "python -m ci settings_header --write": By("tests/python/test_public_headers.py", '"settings_header", "--write"'),
}

# Commands in a foreign source tree that no test machine has.
IN_A_TREE_OF_ZEPHYR = "needs a workspace of Zephyr: tests/rtos builds the same sources with stand-ins"
IN_A_TREE_OF_NUTTX = "needs NuttX and its apps: tests/rtos builds the same sources with stand-ins"
IN_A_TREE_OF_ARDUPILOT = "needs ArduPilot: tests/ardupilot builds the same sources over headers of its own"
NOT_RUN = {
    "west ...": IN_A_TREE_OF_ZEPHYR,
    "export EXTRA_ZEPHYR_MODULES=...": IN_A_TREE_OF_ZEPHYR,
    "ln -s <goe>/port/nuttx ...": IN_A_TREE_OF_NUTTX,
    "cd nuttx": IN_A_TREE_OF_NUTTX,
    "tools/configure.sh -l sim:nsh": IN_A_TREE_OF_NUTTX,
    "kconfig-tweak ...": IN_A_TREE_OF_NUTTX,
    "make": IN_A_TREE_OF_NUTTX,
    "make olddefconfig": IN_A_TREE_OF_NUTTX,
    "python3 -m pip install empy==3.3.4 ...": IN_A_TREE_OF_ARDUPILOT,
    "Tools/environment_install/install-prereqs-ubuntu.sh -y": IN_A_TREE_OF_ARDUPILOT,
}


def output_of(*words: str | Path, **environment: str) -> str:
    done = subprocess.run(
        [str(word) for word in words], cwd=ROOT, env={**os.environ, **environment}, capture_output=True, text=True,
        timeout=SECONDS,
    )  # fmt: skip
    assert done.returncode == 0, f"{words}: exit status {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout


@pytest.fixture
def built() -> Path:
    """The build folder that README.md's commands use."""
    if not (ROOT / "build" / "CMakeCache.txt").exists():
        pytest.skip("nothing is built in build/ (tools/test.sh builds)")
    return ROOT / "build"


@pytest.fixture
def set_up() -> None:
    if not (ROOT / ".venv" / "installed").exists():
        pytest.skip("tools/setup.sh has not run")
    try:
        ready()  # otherwise the command would install the package in the .venv of this checkout
    except FileNotFoundError as reason:
        pytest.skip(str(reason))


@pytest.fixture
def few_flights(monkeypatch: pytest.MonkeyPatch) -> None:
    few = replace(
        work.QUICK, seeds=1, field_seeds=1, random=4, offline=2, rivals=2, recorded=1, recorded_seeds=1,
        precision_seeds=1, boxes=1, attack=1, hazard=4,
    )  # fmt: skip
    monkeypatch.setattr(goals, "QUICK", few)
    monkeypatch.setattr(goals, "FULL", few)
    all_clips = box_logs.odmd_flights
    monkeypatch.setattr(box_logs, "odmd_flights", lambda folder: islice(all_clips(folder), ODMD_CLIPS))


def test_demo(built: Path, set_up: None) -> None:
    """[D1]"""
    if os.environ.get("GOE_TESTS_END"):
        pytest.skip("takes two minutes: not in a quick run")
    text = output_of("tools/demo.sh")
    assert "filter, the default method: better than the paper in" in text
    (page,) = re.findall(r"^The report: +(.*)$", text, re.MULTILINE)
    assert Path(page) == built / "report.html"
    written = Path(page).read_text(encoding="utf-8")
    assert written.rstrip().endswith("</html>") and "of 60 collision courses" in written
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    (duration,) = re.findall(r"^tools/demo.sh +# (.*?):", readme, re.MULTILINE)
    assert text.startswith(f"The demo takes {duration} ")
    summary = text.split("What this showed, in simulation:")[1]
    for question in ("How early", "How certain", "Collisions", "The paper"):
        assert f"* {question}: " in summary
    assert "goals met" not in text
    live = re.findall(r"^Fly yourself, in a browser: +(.*)$", summary, re.MULTILINE)
    assert live == ([] if missing() else [str(built / "live.html")])
    if live:
        assert Path(live[0]).exists() and summary.index("Fly yourself") < summary.index("The report:")
        assert written.index('href="live.html"') < written.index('href="report_paper.html"')


def test_the_example_prints_the_readme_s_figures(built: Path) -> None:
    """[D4]"""
    lines = output_of(built / "tests" / "readme_example").splitlines()
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    said = " ".join(readme.split("The first estimate comes with the second image: ")[1].split("\n## ")[0].split())
    first = re.fullmatch(r"ok +(.* m ahead), +(.* to the left), +(.* m) wide, +(.* m) high", lines[0])
    assert first is not None and len(lines) == 9
    assert said.startswith("{}, {}, {} wide and {} high, and with the tenth ".format(*first.groups()))
    assert f"tenth {lines[-1].split(', ')[0].split(maxsplit=1)[1]}" in said


def test_sizes() -> None:
    text, flight = output_of("tools/sizes.sh", "x86-64 gcc -Os").split("| flight layer, obstacles", 1)
    flight_page = (ROOT / "port" / "flight" / "README.md").read_text(encoding="utf-8")
    assert all(row in flight_page for row in re.findall(r"^\| \d+ \| \d+ \|$", flight, re.MULTILINE))
    readme = (ROOT / "lib" / "README.md").read_text(encoding="utf-8")
    states = re.findall(r"^\| \d+ \| \d+ \|$", text, re.MULTILINE)
    (code,) = re.findall(r"^\| x86.*$", text, re.MULTILINE)
    assert len(states) == 5
    assert all(row in readme for row in states)
    assert re.fullmatch(r"\| x86-64 gcc -Os \(\d+\) \| [1-9]\d{4} \| 0 \|", code)


@pytest.mark.release
def test_bench(built: Path, set_up: None) -> None:
    text = output_of("tools/bench.sh", "1000")
    rates = re.findall(r"^goe_replay --method (\w+): +(\d+) rows/s", text, re.MULTILINE)
    assert [method for method, _ in rates] == ["filter", "window"]
    rates += re.findall(r"^goe_replay, (every column) filled.*: (\d+) rows/s", text, re.MULTILINE)
    assert len(rates) == 3 and all(int(rate) > 0 for _, rate in rates)
    if (built / "port" / "companion" / "goe_companion").exists():
        (share,) = re.findall(r"^goe_companion, .*: (\d\.\d+) of a core", text, re.MULTILINE)
        assert float(share) > 0.0
    assert re.search(r"^machine: +\S.*\ncompiler: +\S.*\nflags: +\S", text, re.MULTILINE)


def test_bench_campaign(built: Path) -> None:
    text = output_of("tools/bench_campaign.sh", "--quick")
    assert re.match(r"paper's study, 1 seed +[\d.]+ s +[1-9]\d* cases/s .*\(156 cases, ", text)


@pytest.mark.release
def test_set_up_with_rivals(tmp_path: Path, set_up: None) -> None:
    """In a copy whose list of rivals is empty: nothing is fetched, and the missing GTSAM is reported."""
    shutil.copytree(ROOT / "tools", tmp_path / "tools", ignore=shutil.ignore_patterns("__pycache__", "*.egg-info"))
    (tmp_path / "tools" / "requirements-rivals.txt").write_text("# none\n")
    bin_folder = tmp_path / ".venv" / "bin"
    bin_folder.mkdir(parents=True)
    (bin_folder / "python").write_text(f'#!/bin/sh\nexec {ROOT}/.venv/bin/python "$@"\n')
    (bin_folder / "python").chmod(0o755)
    # Files by which tools/setup.sh recognizes a complete .venv.
    wanted = [(tmp_path / "tools" / name).read_text() for name in ("requirements.txt", "pyproject.toml")]
    for name in ("lib", "port/flight", "port/cmake", "port/python"):  # the sources of the installed package goe
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__"))
    version = output_of("python3", "--version")
    (tmp_path / ".venv" / "installed").write_text(f"{version}{''.join(wanted)}{tmp_path}\n")
    text = output_of(tmp_path / "tools" / "setup.sh", "--rivals", UNITY_DIR="not looked for", PYTHON="python3")
    assert "making .cache/rivals" in text
    assert "making .venv" not in text and "building the Python package" not in text
    assert "there is no GTSAM for this Python" in text
    assert (tmp_path / ".cache" / "rivals" / "installed").exists()


def test_targets_are_listed(built: Path) -> None:
    text = output_of("ctest", "--test-dir", built, "-L", "targets", "-N")
    assert len(re.findall(r"Test +#\d+: target_[\w-]+-(gcc|clang)-(os|o2)$", text, re.MULTILINE)) == 28


@pytest.mark.release
def test_quick_goals_and_their_report(tmp_path: Path, few_flights: None, built: Path) -> None:
    file, page = tmp_path / "goals.json", tmp_path / "page.html"
    assert bench_main(["goals", "--quick", "--json", str(file)]) == 0
    rows = json.loads(file.read_text())["goals"]
    assert not any(row["asked"] or row["met"] is not None for row in rows)
    groups = {row["group"] for row in rows}
    assert len(groups) >= len(goals.GROUPS) - len(goals.ABSENT)
    campaign = write_campaign(tmp_path / "campaign")
    assert main(["report", str(campaign), "--goals", str(file), "--out", str(page)]) == 0
    assert "too few flights for a verdict" in page.read_text(encoding="utf-8")


@pytest.mark.release
def test_orders_and_their_report(tmp_path: Path, built: Path) -> None:
    file, page = tmp_path / "avoid.csv", tmp_path / "page.html"
    text = output_of(built / "sim_host" / "goe_avoid", "--runs", "2", "--csv", file)
    assert text.count("| mast | 2 |") == 2
    assert main(["report", str(write_campaign(tmp_path / "campaign")), "--avoid", str(file), "--out", str(page)]) == 0
    assert "of 6 collision courses" in page.read_text(encoding="utf-8")


def test_goals(few_flights: None, built: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """[D5]"""
    assert bench_main(["goals", "--only", "gauss1"]) == 0
    assert re.search(r"\d+ of \d+ goals met", capsys.readouterr().out)


@pytest.mark.parametrize("chosen", ["boxes", "attack,hazard", "float32", "rivals"])
def test_goals_of_some_groups(
    chosen: str, monkeypatch: pytest.MonkeyPatch, built: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """These groups alone; test_quick_goals_and_their_report measures each."""
    measured: list[str] = []

    def measure(name: str, amount: work.Amount) -> list[Goal]:
        measured.append(name)
        return [Goal(name, "error", "%", {"Z0": 1.0}, (0.0, 2.0), ("Z0",))]

    monkeypatch.setattr(goals, "GROUPS", dict.fromkeys(goals.GROUPS, measure))
    assert bench_main(["goals", "--only", chosen]) == 0
    assert measured == chosen.split(",")
    assert f"{len(measured)} of {len(measured)} goals met" in capsys.readouterr().out


@pytest.mark.release
def test_goals_of_the_settling_half(few_flights: None, built: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """These tracks differ, and so do the figures."""
    texts = []
    for half in ("settle", "judge"):
        assert bench_main(["goals", "--only", "attack", "--half", half]) == 0
        texts.append(capsys.readouterr().out)
    assert texts[0] != texts[1]


RUN_HERE: dict[str, Callable[..., None]] = {
    "tools/demo.sh": test_demo,
    "tools/sizes.sh": test_sizes,
    "tools/bench.sh": test_bench,
    "tools/bench_campaign.sh": test_bench_campaign,
    "tools/setup.sh --rivals": test_set_up_with_rivals,
    "ctest -L targets": test_targets_are_listed,
    "python -m bench goals": test_goals,
    "python -m bench goals --only boxes": test_goals_of_some_groups,
    "python -m bench goals --only rivals --json tests/data/rivals.json": test_goals_of_some_groups,
    "python -m bench goals --only attack,hazard": test_goals_of_some_groups,
    "python -m bench goals --only attack --half settle": test_goals_of_the_settling_half,
    "python -m bench goals --only float32": test_goals_of_some_groups,
    "python -m bench goals --quick": test_quick_goals_and_their_report,
    "python -m bench goals --json": test_quick_goals_and_their_report,
    "python -m goe_tools report --goals --out": test_quick_goals_and_their_report,
    "python -m goe_tools report --avoid --out": test_orders_and_their_report,
    "goe_avoid --csv": test_orders_and_their_report,
}

# ------------------------------------------------------------------------------------------------------ the two agree


def own_name(command: str) -> str:
    """The name of a command: compare, demo.sh, --install."""
    tool = re.match(r"python -m (?:goe_tools|bench|ci) (\w+)", command)
    words = command.split()
    if tool:
        return tool.group(1)
    return words[-1] if words[-1].startswith("--") else words[0].rpartition("/")[2]


def matches(key: str, command: str) -> bool:
    return command.startswith(key[: -len("...")]) if key.endswith("...") else command == key


def test_every_command_is_run() -> None:
    commands = all_commands()
    keys = [*RUN_HERE, *RUN_BY, *NOT_RUN]
    unknown = [command for command in commands if not any(matches(key, command) for key in keys)]
    assert not unknown, "no test runs: " + "; ".join(f"{command} ({commands[command]})" for command in unknown)
    idle = [key for key in keys if not any(matches(key, command) for command in commands)]
    assert not idle, "no README names any more: " + "; ".join(idle)


@pytest.mark.parametrize("command", RUN_BY)
def test_command_is_run_elsewhere(command: str) -> None:
    by = RUN_BY[command]
    file = ROOT / by.file
    assert by.words in file.read_text(encoding="utf-8")
    assert own_name(command) in by.words


SAMPLE = """
```sh
tools/first.sh   # a comment
# python -m goe_tools nothing
cmake --preset x && ctest
```
```c
goe_update(); /* `tools/not.sh` */
```
Text with `tools/second.sh --all`, `goe_sim [--wind FILE]`, `goe_hazard()`, `--quick`, `lib/goe.h`, `tools/` and
`python -m goe_tools report
DIR --out FILE.html`; `build/tests/replay` and `<x> --y`.

    python -m goe_tools scene --reach 3 \\
        --out here
    some listing
"""


def test_commands_are_found() -> None:
    assert [named(command) for command in commands_of(SAMPLE)] == [
        "tools/first.sh", "cmake --preset x", "ctest", "python -m goe_tools scene --reach 3 --out here",
        "tools/second.sh --all", "goe_sim", "python -m goe_tools report --out", "build/tests/replay",
    ]  # fmt: skip

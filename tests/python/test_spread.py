"""Work in several processes, and on a cluster that loses one."""

from __future__ import annotations

import json
import os
import re
import shutil
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from pathlib import Path

import cloudpickle
import numpy as np
import pytest
from bench.__main__ import main as bench_main
from bench.optimum.goals.outcome import Outcome, Task, perform
from goe_tools.__main__ import main
from goe_tools.flights.noise import NOISES
from goe_tools.flights.simulated import random_scenes
from goe_tools.spread import Workers, _client, each, spread

cloudpickle.register_pickle_by_value(sys.modules[__name__])  # no worker can import it
ROOT = Path(__file__).resolve().parents[2]
HANG_S = 600  # guard against a hang
KILLED = "killed"
CAMPAIGN = "conditioning"  # the fastest study with all obstacles


def cube(number: int) -> int:
    return number**3


def late_cube(folder: Path, number: int) -> int:
    """Marks the call and its process. All but the first wait until a process was killed."""
    (folder / f"{number}-{os.getpid()}").touch()
    while number > 0 and not (folder / KILLED).exists():
        time.sleep(0.01)
    return cube(number)


def marked_by(folder: Path) -> set[str]:
    """The processes that took a call."""
    return {path.name.split("-")[1] for path in folder.iterdir() if "-" in path.name}


def wait_for(what: Callable[[], bool]) -> None:
    """Raises TimeoutError after HANG_S."""
    end_s = time.monotonic() + HANG_S
    while not what():
        if time.monotonic() > end_s:
            raise TimeoutError
        time.sleep(0.05)


def flights(count: int) -> list[Task]:
    return [Task(scene, NOISES["field"], (1, number)) for number, scene in enumerate(random_scenes(count))]


def assert_same(some: list[Outcome], others: list[Outcome]) -> None:
    assert len(some) == len(others) > 0
    for one, other in zip(some, others):
        assert one.name == other.name and one.nis == other.nis and one.nis_ratio == other.nis_ratio
        assert np.array_equal(one.covariance, other.covariance, equal_nan=True)
        assert np.array_equal(one.filter.error, other.filter.error, equal_nan=True)


@pytest.fixture(scope="module")
def conditioning(built: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A campaign written by goe_campaign itself."""
    folder = tmp_path_factory.mktemp("whole") / "campaign"
    command = [str(ROOT / "build/sim_host/goe_campaign"), "--quiet", "--studies", CAMPAIGN, "--out", str(folder)]
    subprocess.run(command, check=True)
    return folder


def assert_same_campaign(one: Path, other: Path) -> None:
    """Equal except for the record of how it was flown."""
    files = [{path.relative_to(folder) for path in folder.rglob("*")} for folder in (one, other)]
    assert files[0] == files[1]
    for name in files[0] - {Path("campaign.json")}:
        if (one / name).is_file():
            assert (one / name).read_bytes() == (other / name).read_bytes(), name
    facts = [json.loads((folder / "campaign.json").read_text(encoding="utf-8")) for folder in (one, other)]
    for reported in facts:
        del reported["jobs"], reported["wall_s"]
    assert facts[0] == facts[1]


def test_a_campaign_in_parts_is_the_whole(conditioning: Path, tmp_path: Path) -> None:
    (tmp_path / "series").mkdir()
    (tmp_path / "series" / "7_disc.csv").write_text("of an earlier campaign")
    (tmp_path / "notes.txt").write_text("mine")
    assert main(["campaign", "--studies", CAMPAIGN, "--out", str(tmp_path), "--jobs", "2"]) == 0
    assert (tmp_path / "notes.txt").read_text() == "mine"
    (tmp_path / "notes.txt").unlink()
    assert_same_campaign(tmp_path, conditioning)


def test_a_campaign_that_cannot_be(tmp_path: Path, built: None, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").touch()
    for words, reported in (
        (["--studies", "winds", "--out", str(tmp_path / "c")], "--studies: 'winds' is not paper"),
        (["--seeds", "0", "--out", str(tmp_path / "c")], "--seeds: must be 1 to 1000, not 0"),
        (["--out", str(tmp_path / "file" / "c")], "file/c: cannot be written"),
    ):
        assert main(["campaign", *words, "--jobs", "1"]) == 2
        assert reported in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["file"]


def test_flights_are_those_of_one_process(built: None) -> None:
    assert_same(*(each(perform, flights(12), Workers(jobs), "flights") for jobs in (1, 2)))


def test_the_order_is_that_of_the_tasks() -> None:
    assert list(spread(cube, range(200), Workers(2))) == [number**3 for number in range(200)]


def test_a_killed_process_is_reported() -> None:
    def die(number: int) -> int:
        if number == 3:
            os.kill(os.getpid(), signal.SIGKILL)
        return number

    with pytest.raises(ValueError, match="a process of --jobs was killed"):
        list(spread(die, range(20), Workers(2)))


def test_a_cluster_that_loses_a_worker(conditioning: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One of two workers dies in the middle, and the other one repeats its work. The flights equal local ones."""
    distributed, dask = pytest.importorskip("distributed"), pytest.importorskip("dask")
    monkeypatch.setattr("goe_tools.spread.CONNECT_S", HANG_S)
    with (
        dask.config.set({"distributed.comm.timeouts.connect": f"{HANG_S}s"}),
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
        ) as cluster,
    ):
        results = spread(partial(late_cube, tmp_path), range(40), Workers(scheduler=cluster.scheduler_address))
        first = next(results)
        wait_for(lambda: len(marked_by(tmp_path)) == 2)
        worker = next(iter(cluster.workers.values()))
        os.kill(worker.process.pid, signal.SIGKILL)
        (tmp_path / KILLED).touch()
        assert [first, *results] == [number**3 for number in range(40)]
        flown = each(perform, flights(4), Workers(scheduler=cluster.scheduler_address), "flights")
        assert_same(flown, each(perform, flights(4), Workers(), "flights"))
        words = ["--studies", CAMPAIGN, "--out", str(tmp_path / "campaign")]
        assert main(["campaign", *words, "--scheduler", cluster.scheduler_address]) == 0
        _client(cluster.scheduler_address).close()
    assert_same_campaign(tmp_path / "campaign", conditioning)
    shutil.rmtree(tmp_path / "campaign")
    assert len(marked_by(tmp_path)) >= 2


def test_no_scheduler_there(built: None, capsys) -> None:
    pytest.importorskip("distributed")
    assert bench_main(["goals", "--quick", "--only", "field", "--scheduler", "nonsense://1"]) == 2
    assert "--scheduler nonsense://1: " in capsys.readouterr().err


def children(parent: int) -> list[int]:
    listed = subprocess.run(["ps", "-o", "pid=", "--ppid", str(parent)], capture_output=True, text=True)
    return [int(word) for word in listed.stdout.split()]


def catches_ctrl_c(process: int) -> bool:
    """The program ignores Ctrl-C while it starts processes."""
    (caught,) = re.findall(r"^SigCgt:\s+(\w+)$", Path(f"/proc/{process}/status").read_text(), re.MULTILINE)
    return int(caught, 16) >> (signal.SIGINT - 1) & 1 == 1


def test_ctrl_c_ends_all_processes(built: None) -> None:
    command = [sys.executable, "-m", "bench", "goals", "--only", "gauss1", "--jobs", "2"]
    with subprocess.Popen(command, cwd=ROOT, start_new_session=True, stderr=subprocess.PIPE, text=True) as program:
        wait_for(lambda: len(children(program.pid)) >= 2 and catches_ctrl_c(program.pid))
        born = children(program.pid)
        os.killpg(program.pid, signal.SIGINT)
        _, reported = program.communicate(timeout=HANG_S)
        assert program.returncode == 130
        assert reported.strip().splitlines()[-1] == "bench goals: interrupted" and "Traceback" not in reported
    assert len(born) >= 2
    wait_for(lambda: not any(Path(f"/proc/{pid}").exists() for pid in born))

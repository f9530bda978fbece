"""Work in several processes, and on a cluster that loses one."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import time
from functools import partial
from pathlib import Path

import cloudpickle
import numpy as np
import pytest
from goe_tools.__main__ import main
from goe_tools.optimum.flights.noise import NOISES
from goe_tools.optimum.flights.simulated import random_scenes
from goe_tools.optimum.goals.outcome import Outcome, Task, perform
from goe_tools.spread import Workers, each, spread

cloudpickle.register_pickle_by_value(sys.modules[__name__])  # no worker could import it
ROOT = Path(__file__).resolve().parents[2]
CAMPAIGN = "conditioning"  # the quickest of its studies with all obstacles in it


def cube(mark: Path | None, number: int) -> int:
    """Slow once the file is there, and says that it was asked."""
    if mark is not None:
        (mark / f"{number}-{os.getpid()}").touch()
        time.sleep(0.05)
    return number**3


def flights(count: int) -> list[Task]:
    return [Task(scene, NOISES["field"], (1, number)) for number, scene in enumerate(random_scenes(count))]


def assert_same(some: list[Outcome], others: list[Outcome]) -> None:
    assert len(some) == len(others) > 0
    for one, other in zip(some, others):
        assert one.name == other.name and one.nis == other.nis and one.misfit == other.misfit
        assert np.array_equal(one.covariance, other.covariance, equal_nan=True)
        assert np.array_equal(one.refined.error, other.refined.error, equal_nan=True)


@pytest.fixture(scope="module")
def conditioning(built: None, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """What goe_campaign itself writes."""
    folder = tmp_path_factory.mktemp("whole") / "campaign"
    command = [str(ROOT / "build/sim_host/goe_campaign"), "--quiet", "--studies", CAMPAIGN, "--out", str(folder)]
    subprocess.run(command, check=True)
    return folder


def assert_same_campaign(one: Path, other: Path) -> None:
    """But for how it was flown."""
    files = [{path.relative_to(folder) for path in folder.rglob("*")} for folder in (one, other)]
    assert files[0] == files[1]
    for name in files[0] - {Path("campaign.json")}:
        if (one / name).is_file():
            assert (one / name).read_bytes() == (other / name).read_bytes(), name
    facts = [json.loads((folder / "campaign.json").read_text(encoding="utf-8")) for folder in (one, other)]
    for told in facts:
        del told["jobs"], told["wall_s"]
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
    for words, told in (
        (["--studies", "winds", "--out", str(tmp_path / "c")], "--studies: 'winds' is not paper"),
        (["--seeds", "0", "--out", str(tmp_path / "c")], "--seeds: must be 1 to 1000, not 0"),
        (["--out", str(tmp_path / "missing" / "c")], "missing/c: cannot be written"),
    ):
        assert main(["campaign", *words, "--jobs", "1"]) == 2
        assert told in capsys.readouterr().err
    assert list(tmp_path.iterdir()) == []


def test_flights_are_those_of_one_process(built: None) -> None:
    assert_same(*(each(perform, flights(12), Workers(jobs), "flights") for jobs in (1, 2)))


def test_the_order_is_that_of_the_tasks() -> None:
    assert list(spread(partial(cube, None), range(200), Workers(2))) == [number**3 for number in range(200)]


def test_a_killed_process_is_told() -> None:
    def die(number: int) -> int:
        if number == 3:
            os.kill(os.getpid(), signal.SIGKILL)
        return number

    with pytest.raises(ValueError, match="a process of --jobs was killed"):
        list(spread(die, range(20), Workers(2)))


def test_a_cluster_that_loses_a_worker(conditioning: Path, tmp_path: Path) -> None:
    """Two workers; one of them dies in the middle, and the other one does its work again. Flights come back as they are
    here."""
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
    ) as cluster:
        results = spread(partial(cube, tmp_path), range(40), Workers(scheduler=cluster.scheduler_address))
        first = next(results)
        worker = next(iter(cluster.workers.values()))
        os.kill(worker.process.pid, signal.SIGKILL)
        assert [first, *results] == [number**3 for number in range(40)]
        flown = each(perform, flights(4), Workers(scheduler=cluster.scheduler_address), "flights")
        assert_same(flown, each(perform, flights(4), Workers(), "flights"))
        words = ["--studies", CAMPAIGN, "--out", str(tmp_path / "campaign")]
        assert main(["campaign", *words, "--scheduler", cluster.scheduler_address]) == 0
    assert_same_campaign(tmp_path / "campaign", conditioning)
    shutil.rmtree(tmp_path / "campaign")
    assert len({path.name.split("-")[1] for path in tmp_path.iterdir()}) >= 2


def test_no_scheduler_there(built: None, capsys) -> None:
    pytest.importorskip("distributed")
    assert main(["goals", "--quick", "--only", "field", "--scheduler", "nonsense://1"]) == 2
    assert "--scheduler nonsense://1: " in capsys.readouterr().err


def children(parent: int) -> list[int]:
    listed = subprocess.run(["ps", "-o", "pid=", "--ppid", str(parent)], capture_output=True, text=True)
    return [int(word) for word in listed.stdout.split()]


def test_ctrl_c_ends_all_processes(built: None) -> None:
    command = [sys.executable, "-m", "goe_tools", "goals", "--only", "gauss1", "--jobs", "2"]
    with subprocess.Popen(command, cwd=ROOT, start_new_session=True, stderr=subprocess.PIPE, text=True) as program:
        deadline = time.monotonic() + 60
        while len(children(program.pid)) < 2 and time.monotonic() < deadline:
            time.sleep(0.2)
        born = children(program.pid)
        time.sleep(1.0)
        os.killpg(program.pid, signal.SIGINT)
        _, told = program.communicate(timeout=60)
        assert program.returncode == 130
        assert told.strip().splitlines()[-1] == "goe_tools goals: interrupted" and "Traceback" not in told
    assert len(born) >= 2
    deadline = time.monotonic() + 20
    while any(Path(f"/proc/{pid}").exists() for pid in born) and time.monotonic() < deadline:
        time.sleep(0.2)
    assert not any(Path(f"/proc/{pid}").exists() for pid in born)

"""The comparison passes where the answers agree, and finds differences."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from bench.__main__ import main
from bench.reference import compare
from bench.reference.settings import Settings
from goe_tools.logs.obslog import FEATURES, ObservationLog, read_log, write_log
from goe_tools.logs.projection import quaternion_of, yaw_pitch_roll
from goe_tools.logs.scene import Scene, make_log

ROOT = Path(__file__).resolve().parents[2]


def run(replay: Path, *arguments: object) -> int:
    return main(["compare", "--replay", str(replay), *(str(argument) for argument in arguments)])


def test_agreement(corner_folder: Path, fake_replay, capsys) -> None:
    assert run(fake_replay(), corner_folder) == 0
    printed = capsys.readouterr()
    assert "100.000%" in printed.out
    assert "length_sd_m" in printed.out
    assert "float32 0/0/0, float64 0/0/0" in printed.out
    assert printed.err == ""


@pytest.mark.parametrize("options", [("--model", "disc"), ("--model", "line", "--window", "5"), ("--window", "12")])
def test_options_reach_all_three(options: tuple[str, ...], corner_folder: Path, fake_replay) -> None:
    assert run(fake_replay(), *options, corner_folder) == 0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"columns": ["x0_m"], "ulp": 5, "rows": [30]}, "float32: 5 ULP apart, 4 allowed"),
        ({"columns": ["z0_m"], "ulp": 1}, "values have identical bits, minimum 99.9%"),
        ({"columns": ["width_m"], "ulp": 30000}, "float64: width_m: 99th percentile"),
        ({"columns": ["x0_sd_m"], "ulp": 3000000}, "float64: x0_sd_m: 99th percentile"),
        ({"columns": ["orientation_deg"], "ulp": 20000}, "float64: orientation_deg: 99th percentile"),
        ({"columns": ["height_m"], "drop": True, "rows": [30]}, "1 empty fields differ"),
        ({"status": "stale", "rows": [30]}, "float64: 1 statuses, models or numbers of points differ"),
    ],
)
def test_differences_are_found(change: dict, message: str, corner_folder: Path, fake_replay, capsys) -> None:
    assert run(fake_replay(**change), corner_folder) == 1
    assert message in capsys.readouterr().err


def test_one_bad_log_among_good_ones(corner_folder: Path, tmp_path: Path, fake_replay, capsys) -> None:
    write_log(tmp_path / "other", make_log(Scene(width_m=10.0, alpha_deg=15.0, run_s=2.0)))
    assert run(fake_replay(columns=["x_m"], ulp=5, rows=[30]), tmp_path / "other", corner_folder) == 1
    assert "other: BEYOND" not in capsys.readouterr().err


def test_a_log_without_any_estimate(tmp_path: Path, fake_replay) -> None:
    write_log(tmp_path / "short", make_log(Scene(run_s=0.5)))
    assert run(fake_replay(exit_status=1), tmp_path / "short") == 0


def test_logs_that_the_references_do_not_support(
    corner_log: ObservationLog, tmp_path: Path, fake_replay, capsys
) -> None:
    boxed = [replace(frame, box_px=(1.0, None, None, None)) for frame in corner_log.frames[-1:]]
    write_log(tmp_path / "boxes", replace(corner_log, frames=corner_log.frames[:-1] + boxed))
    assert run(fake_replay(), tmp_path / "boxes") == 2
    assert "frames.csv: contains bounding boxes" in capsys.readouterr().err
    counted = [replace(frame, reset_count=7) for frame in corner_log.frames]
    write_log(tmp_path / "resets", replace(corner_log, frames=corner_log.frames[:9] + counted[9:]))
    assert run(fake_replay(), tmp_path / "resets") == 2
    assert "frames.csv: reset_count: changes within a track" in capsys.readouterr().err
    write_log(tmp_path / "two", replace(corner_log, camera2=corner_log.camera))
    assert run(fake_replay(), tmp_path / "two") == 2
    assert "camera.ini: camera2: a second camera" in capsys.readouterr().err
    write_log(tmp_path / "counted", replace(corner_log, frames=counted))  # a counter alone is no reset
    assert run(fake_replay(), tmp_path / "counted") == 0


def test_bad_input(corner_folder: Path, tmp_path: Path, fake_replay, capsys) -> None:
    assert run(fake_replay(), tmp_path / "nowhere") == 2
    assert "no such folder" in capsys.readouterr().err
    assert run(tmp_path / "no_program", corner_folder) == 2
    assert "cannot be run" in capsys.readouterr().err
    assert run(fake_replay(exit_status=2), corner_folder) == 2
    assert "exit status 2" in capsys.readouterr().err
    (corner_folder / "frames.csv").write_text("t_s,id\n")
    assert run(fake_replay(), corner_folder) == 2
    assert "frames.csv:1: n_m: column is missing" in capsys.readouterr().err


def test_rows_must_belong_together(corner_folder: Path) -> None:
    log = read_log(corner_folder)
    with pytest.raises(ValueError, match="0 rows of estimates for 49 rows"):
        compare.compare_rows(log, [], Settings())


def test_ulp_index() -> None:
    values = np.array([1.0, -1.0, 0.0, -0.0, 1e-45, -1e-45], dtype=np.float32)
    up = np.nextafter(values, np.float32(np.inf))
    assert np.all(compare.ulp_index(up) - compare.ulp_index(values) == 1)
    assert compare.ulp_index(np.float32(0.0)) == compare.ulp_index(np.float32(-0.0))


def test_too_many_followed_decisions_and_any_disputed_one() -> None:
    result = compare.Result(decisions=1000, followed=["rises"] * 10)
    assert result.failures() == []
    result.followed.append("rises")
    assert any("11 of 1000 decisions followed" in failure for failure in result.failures())
    result = compare.Result(decisions=1000, disputed=["abeam"])
    assert any("disputed decisions: abeam" in failure for failure in result.failures())


def test_the_built_program_on_the_committed_logs(replay: Path) -> None:
    """[A3]"""
    folders = [path.parent for path in sorted((ROOT / "tests" / "data").glob("*/frames.csv"))]
    assert folders
    for model in ("auto", "disc", "line"):
        assert run(replay, "--model", model, *folders) == 0


def turning_log(blind: int, visible: int, turn_deg: float, camera) -> ObservationLog:
    """Views of a box. The camera looks aside in the first images, some of which contain no feature."""
    scene = Scene(
        width_m=12.0, length_m=20.0, height_m=25.0, x0_m=-30.0, z0_m=180.0, alpha_deg=20.0, course_deg=40.0,
        altitude_m=20.0, wobble_deg=2.0, run_s=5.0, rounding="pixel", clip=True, camera=camera,
    )  # fmt: skip
    log = make_log(scene)
    for k, frame in enumerate(log.frames[: blind + visible]):
        turn = yaw_pitch_roll(scene.course_deg - turn_deg - k, 0.0, 0.0)
        frame.attitude = tuple(float(number) for number in quaternion_of(turn))
        if k < blind:
            for name in FEATURES:
                setattr(frame, name, None)
    return log


@pytest.mark.parametrize("turn_deg", [0.0, 50.0, 65.0, 85.0, 130.0, 179.0])
@pytest.mark.parametrize(("blind", "visible"), [(5, 0), (1, 1), (0, 4), (4, 9)])
def test_the_built_program_on_tracks_that_begin_with_a_turn(
    blind: int, visible: int, turn_deg: float, replay: Path, tmp_path: Path, real_camera
) -> None:
    """The first image with a feature defines T. Until then a turn restarts the track."""
    write_log(tmp_path, turning_log(blind, visible, turn_deg, real_camera))
    log, settings = read_log(tmp_path), Settings()
    result = compare.compare_rows(log, compare.run_replay(replay, tmp_path, settings), settings)
    assert result.failures() == [] and result.single.total == 0
    assert all(max(column.ulp_single, default=0) == 0 for column in result.columns.values())
    if visible == 0 or (visible < 8 and turn_deg >= 65.0):  # T is that of the flight
        assert result.conditioned > 10


def test_the_built_program_on_random_flights(replay: Path, tmp_path: Path, real_camera) -> None:
    generator = np.random.default_rng(11)
    for k in range(8):
        shape = str(generator.choice(["box", "cylinder"]))
        scene = Scene(
            shape, *generator.uniform(3.0, 25.0, 3), x0_m=generator.uniform(-40.0, 40.0), altitude_m=30.0,
            z0_m=generator.uniform(80.0, 250.0), alpha_deg=generator.uniform(-90.0, 90.0), wobble_deg=2.0, clip=True,
            path=str(generator.choice(["straight", "arc", "weave"])), course_deg=generator.uniform(-180.0, 180.0),
            rounding="pixel", run_s=6.0, camera=real_camera,
        )  # fmt: skip
        write_log(tmp_path / str(k), make_log(scene))
        log = read_log(tmp_path / str(k))
        settings = Settings(window=int(generator.choice([3, 8, 20])))
        result = compare.compare_rows(log, compare.run_replay(replay, tmp_path / str(k), settings), settings)
        assert result.single.total == result.presence_single == 0
        assert all(max(column.ulp_single, default=0) == 0 for column in result.columns.values())
        assert not result.disputed

"""Fixtures shared by the tests of the Python tools."""

from __future__ import annotations

import os
import stat
import sys
from pathlib import Path

import pytest
from goe_tools.library import ready
from goe_tools.logs.obslog import Camera, ObservationLog, write_log
from goe_tools.logs.scene import Scene, make_log

ROOT = Path(__file__).resolve().parents[2]

FAKE_REPLAY = """#!{python}
'''A stand-in for goe_replay: prints the window method's answers in float32, one column changed on demand.'''
import sys
sys.path.insert(0, {tools!r})
import numpy as np
from goe_tools.logs.estimates import LABELS, NUMBERS
from goe_tools.logs.obslog import read_log
from bench.reference.settings import Settings
from bench.reference.window import WindowMethod

option = {{name: sys.argv[i + 1] for i, name in enumerate(sys.argv) if name.startswith("--")}}
change = {change!r}
log = read_log(sys.argv[-1])
methods = {{}}
lines = [",".join((*LABELS, *NUMBERS))]
for number, frame in enumerate(log.frames):
    settings = Settings(model=option["--model"], window=int(option["--window"]))
    method = methods.setdefault(frame.id, WindowMethod(log.camera, settings, np.float32))
    estimate = method.update(frame).estimate
    if number in change.get("rows", range(10**9)):
        if "status" in change:
            estimate.status = change["status"]
        for name in change.get("columns", ()):
            if name in estimate.values:
                bits = np.float32(estimate.values[name]).view(np.uint32) + np.uint32(change.get("ulp", 0))
                estimate.values[name] = bits.view(np.float32)
                if change.get("drop"):
                    del estimate.values[name]
    labels = [repr(frame.t_s), str(frame.id), estimate.status, estimate.model, str(estimate.images_used)]
    numbers = ["%.9g" % estimate.values[name] if name in estimate.values else "" for name in NUMBERS]
    lines.append(",".join(labels + numbers))
open(option["--out"], "w").write("\\n".join(lines) + "\\n")
sys.exit({exit_status})
"""


@pytest.fixture
def real_camera() -> Camera:
    """A camera with a value for every setting: lens, mounting, lever arm, different focal lengths."""
    return Camera(
        1280.0, 960.0, 900.0, 905.0, 640.0, 480.0, -0.1, 0.02, 0.001, 0.0005, -0.003,
        mount_roll_deg=2.0, mount_pitch_deg=-5.0, mount_yaw_deg=-10.0, offset_x_m=1.0, offset_y_m=0.5, offset_z_m=0.2,
    )  # fmt: skip


@pytest.fixture
def corner_log(real_camera: Camera) -> ObservationLog:
    """A box next to a winding path, in whole pixels. It exercises both models and both kinds of frames."""
    scene = Scene(
        width_m=12.0, length_m=20.0, height_m=25.0, x0_m=-30.0, z0_m=180.0, alpha_deg=20.0, path="weave",
        weave_amplitude_m=4.0, altitude_m=20.0, course_deg=40.0, wobble_deg=2.0, run_s=6.0, rounding="pixel",
        clip=True, camera=real_camera,
    )  # fmt: skip
    return make_log(scene)


@pytest.fixture
def corner_folder(tmp_path: Path, corner_log: ObservationLog) -> Path:
    folder = tmp_path / "corner"
    write_log(folder, corner_log)
    return folder


@pytest.fixture
def fake_replay(tmp_path: Path):
    """Makes a stand-in for goe_replay. ``change`` is rows, columns, ulp, drop or status."""

    def make(exit_status: int = 0, **change: object) -> Path:
        path = tmp_path / f"replay{len(list(tmp_path.iterdir()))}"
        text = FAKE_REPLAY.format(
            python=sys.executable, tools=str(ROOT / "tools"), change=change, exit_status=exit_status
        )
        path.write_text(text)
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
        return path

    return make


@pytest.fixture
def replay() -> Path:
    """The built goe_replay; skips the test without it."""
    candidates = [os.environ.get("GOE_REPLAY"), str(ROOT / "build" / "sim_host" / "goe_replay")]
    for candidate in candidates:
        if candidate and Path(candidate).is_file():
            return Path(candidate)
    pytest.skip("goe_replay is not built (GOE_REPLAY names it)")


@pytest.fixture(scope="session")
def report_pages(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report's first page, of synthetic data, with every section; the other pages are in the same folder. The
    approach is the demo's, if the library can be called."""
    from goe_tools.report import data, page  # here, because the import is slow
    from synthetic_campaign import write_avoid, write_campaign, write_goals

    folder = tmp_path_factory.mktemp("report")
    try:
        ready()
        approach = ROOT / "tests" / "data" / "corner"
    except FileNotFoundError:
        approach = None
    campaign = data.read_campaign(
        write_campaign(folder / "campaign"), goals=write_goals(folder / "goals.json", hostile=True),
        avoid=write_avoid(folder / "avoid.csv"), rare=ROOT / "tests" / "data" / "rare_events.json", approach=approach,
    )  # fmt: skip
    doors = page.Doors(folder / "live.html", folder / "view.html")
    for name in ("live.html", "view.html"):
        (folder / name).write_text("<title>elsewhere</title>", encoding="utf-8")
    page.write_page(campaign, folder / "report.html", doors)
    return folder / "report.html"


@pytest.fixture(scope="session")
def built() -> None:
    """Skips the test, with the reason, if the Python package cannot load the library."""
    try:
        ready()
    except FileNotFoundError as reason:
        pytest.skip(str(reason))

"""The command goe_tools view: pages and pictures of any log, and errors for bad input."""

from __future__ import annotations

import dataclasses
import math
import os
import re
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest
import view_logs
from goe_tools import library
from goe_tools.__main__ import main
from goe_tools.logs.obslog import ObservationLog, write_truth

MOST_KB = 4000.0


@pytest.fixture(autouse=True)
def built() -> None:
    try:
        library.ready()
    except FileNotFoundError as error:
        pytest.skip(str(error))


def test_without_flags_it_writes_the_page_here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["view", str(view_logs.CORNER)]) == 0
    assert [path.name for path in tmp_path.iterdir()] == ["view.html"]


def test_the_page_of_a_long_log_is_bounded(tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    assert main(["view", str(view_logs.written(view_logs.long(), tmp_path / "log")), "--out", str(page)]) == 0
    assert page.stat().st_size < 1000.0 * MOST_KB
    assert re.search(r"2,\d\d\d of them are shown|3,000 of them are shown", page.read_text(encoding="utf-8"))


# -------------------------------------------------------------------------------------------------------- command line


@pytest.mark.parametrize(
    ("make", "status"),
    [(view_logs.one_frame, 1), (view_logs.nothing_answered, 1), (view_logs.spoiled, 0), (view_logs.moving, 0)],
)
def test_any_log_is_shown(make: Callable[[], ObservationLog], status: int, tmp_path: Path) -> None:
    folder = view_logs.written(make(), tmp_path / "log")
    outputs = [tmp_path / name for name in ("page.html", "picture.png")]
    flags = [word for flag, output in zip(("--out", "--png"), outputs) for word in (flag, str(output))]
    assert main(["view", str(folder), *flags]) == status
    assert all(output.stat().st_size > 5000 for output in outputs)
    assert not list(tmp_path.glob("*.part"))


def test_truth_of_its_own_and_truth_that_is_not_there(tmp_path: Path) -> None:
    log = view_logs.boxes()
    nowhere = dataclasses.replace(log.truth[1], center_n_m=math.nan, width_m=math.nan)
    write_truth(tmp_path / "nan.csv", {1: nowhere})
    folder = view_logs.written(dataclasses.replace(log, truth={}), tmp_path / "log")
    page = tmp_path / "page.html"
    assert main(["view", str(folder), "--out", str(page)]) == 0
    assert "the truth" not in page.read_text(encoding="utf-8")
    assert main(["view", str(folder), "--truth", str(tmp_path / "nan.csv"), "--out", str(page)]) == 0
    assert "the truth" in page.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (["nowhere"], "nowhere: no such folder"),
        (["LOG", "--truth", "none.csv"], "none.csv: No such file"),
        (["LOG", "--id", "9"], "no obstacle 9; there are 1"),
        (["LOG", "--out", "LOG/frames.csv"], "the output would replace "),
        (["LOG", "--out", "LOG"], "is a folder"),
        (["LOG", "--set", "detector.nothing=1"], "detector.nothing: no such setting"),
        (["LOG", "--set", "detector.point_noise_px=-1"], "detector.point_noise_px = -1: not within 0.05 to 100 px"),
        (["LOG", "--window", "999"], "window.points = 999: not within 3 to 64 images"),
    ],
)  # fmt: skip
def test_bad_usage(change: list[str], said: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = view_logs.written(view_logs.one_frame(), tmp_path / "log")
    assert main(["view", *(word.replace("LOG", str(folder)) for word in change)]) == 2
    assert said in capsys.readouterr().err
    assert not (tmp_path / "view.html").exists()


@pytest.mark.parametrize(
    "words_",
    [["--set", "point_noise_px=1"], ["--set", "detector.point_noise_px=x"], ["--margin", "-1"], ["--theme", "red"],
     ["--png", "x.svg"], ["--svg", "x.html"]],
)
def test_bad_flags(words_: list[str], tmp_path: Path) -> None:
    with pytest.raises(SystemExit) as stopped:
        main(["view", str(view_logs.CORNER), "--out", str(tmp_path / "x.html"), *words_])
    assert stopped.value.code == 2


def test_a_closed_pipe(tmp_path: Path) -> None:
    reading, writing = os.pipe()
    os.close(reading)
    words = [sys.executable, "-m", "goe_tools", "view", str(view_logs.CORNER), "--out", str(tmp_path / "page.html")]
    done = subprocess.run(words, stdout=writing, stderr=subprocess.PIPE, text=True)
    os.close(writing)
    assert done.returncode == 2
    assert done.stderr == "goe_tools view: standard output: Broken pipe\n"


def test_a_broken_log(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder = view_logs.written(view_logs.one_frame(), tmp_path / "log")
    rows = (folder / "frames.csv").read_text().splitlines()
    (folder / "frames.csv").write_text("\n".join([rows[0], rows[1].replace("1200.0", "far"), ""]))
    assert main(["view", str(folder)]) == 2
    assert "frames.csv:2: n_m: 'far' is not a number" in capsys.readouterr().err
    (folder / "frames.csv").write_text(rows[0] + "\n")
    assert main(["view", str(folder)]) == 2
    assert "there are no rows" in capsys.readouterr().err


# ------------------------------------------------------------------------------------------------------------ pictures


def test_a_moment_that_the_log_does_not_have(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for word in ("--at=99", "--at=-1"):
        assert main(["view", str(view_logs.CORNER), word, "--out", str(tmp_path / "page.html")]) == 2
        said = capsys.readouterr().err
        assert said == f"goe_tools view: --at: {word[5:]} s is not in the log, which goes from 0 to 30 s\n"
    assert list(tmp_path.iterdir()) == []


def test_pictures(tmp_path: Path) -> None:
    from PIL import Image

    for theme in ("light", "dark"):
        word = ["--png", str(tmp_path / f"{theme}.png"), "--theme", theme, "--at", "12"]
        assert main(["view", str(view_logs.CORNER), *word]) == 0
    assert not (tmp_path / "view.html").exists()
    pages = [Image.open(BytesIO((tmp_path / f"{theme}.png").read_bytes())).convert("L") for theme in ("light", "dark")]
    assert [page.size for page in pages] == [(1600, 1040)] * 2
    assert np.median(np.array(pages[0])) > 240 > 40 > np.median(np.array(pages[1]))


def test_svg_follows_its_reader(tmp_path: Path) -> None:
    from goe_tools.view.picture import LIGHT

    twice = []
    for name in ("a.svg", "b.svg"):
        assert main(["view", str(view_logs.CORNER), "--svg", str(tmp_path / name)]) == 0
        twice.append((tmp_path / name).read_text(encoding="utf-8"))
    assert twice[0] == twice[1]
    root = ElementTree.fromstring(twice[0])
    assert root.get("viewBox") == "0 0 576 374.4"
    assert root[0].tag.endswith("title") and " ahead, " in (root[0].text or "").replace("\u00a0", " ")
    assert "prefers-color-scheme: dark" in twice[0]
    for name in ("ink", "panel", "estimate", "true", "course", "own"):
        assert f"var(--{name})" in twice[0], name
    bare = re.findall(r"(?:fill|stroke): (#[0-9a-f]{6})(?!; (?:fill|stroke): var)", twice[0])
    assert not set(bare) & set(LIGHT.values())
    assert len(twice[0]) < 250_000
    texts = re.findall(r"<!-- (.*?) -->", twice[0])
    for name in ("flown path", "later path", "estimate", "camera's view", "truth", "this moment"):
        assert name in texts, name  # the legend
    assert any(text.startswith("2σ region") for text in texts) and any("closest approach" in text for text in texts)
    assert any("± is 1σ" in text for text in texts)


def test_the_first_picture_of_the_readme_is_drawn_by_the_command(tmp_path: Path) -> None:
    """Words and numbers are compared; another version of the drawing library may place strokes differently."""
    picture = view_logs.ROOT / "tools" / "goe_tools" / "view" / "approach.svg"
    assert f"]({picture.relative_to(view_logs.ROOT)})" in (view_logs.ROOT / "README.md").read_text(encoding="utf-8")
    assert main(["view", str(view_logs.CORNER), "--svg", str(tmp_path / "now.svg")]) == 0
    pictures = [path.read_text(encoding="utf-8") for path in (picture, tmp_path / "now.svg")]
    words, words_now = (re.findall(r"<!-- (.*?) -->", text) for text in pictures)
    assert words == words_now and len(words) > 20

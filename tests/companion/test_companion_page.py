"""The scripts of the companion's page: they run, and send what they promise."""

from __future__ import annotations

import contextlib
import json
import re
import sys
import types
from typing import Any

import pytest
from companion import ROOT

PAGE = ROOT / "port" / "companion" / "README.md"
RAW = [[100.0, 100.0, 140.0, 200.0], [300.0, 100.0, 330.0, 220.0], [600.0, 300.0, 640.0, 340.0]]
SMOOTHED = [[305.0, 104.0, 329.0, 218.0], [104.0, 104.0, 138.0, 196.0]]  # the tracker has lost the third
IDS, SCORES, CLASSES = [7, 9], [0.9, 0.8], [0, 1]


class Ended(Exception):
    """Ends a script that runs forever."""


class Sent(list[tuple[bytes, Any]]):
    """Collects the datagrams of a script."""

    def sendto(self, data: bytes, address: Any) -> None:
        self.append((data, address))


def run(word: str, monkeypatch: pytest.MonkeyPatch) -> list[dict[str, Any]]:
    """Runs the script that contains this word, until its third line. Returns the lines."""
    sent = Sent()

    def pause(_: float) -> None:
        if len(sent) == 3:
            raise Ended

    monkeypatch.setattr("socket.socket", lambda *_: sent)
    monkeypatch.setattr("time.sleep", pause)
    scripts = re.findall(r"^```python\n(.*?)^```$", PAGE.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    (script,) = [script for script in scripts if word in script]
    with contextlib.suppress(Ended):
        exec(compile(script, PAGE.name, "exec"), {})
    assert len(sent) == 3 and {address for _, address in sent} == {("127.0.0.1", 14600)}
    return [json.loads(data) for data, _ in sent]


def test_the_first_try_sends_one_box(monkeypatch: pytest.MonkeyPatch) -> None:
    assert "from = udp:127.0.0.1:14600" in (ROOT / "port" / "companion" / "companion.ini").read_text(encoding="utf-8")
    for line in run("time.sleep", monkeypatch):
        (detection,) = line["detections"]
        assert detection["id"] == 1 and len(detection["box"]) == 4


class Tensor(list[Any]):
    def tolist(self) -> list[Any]:
        return list(self)

    def int(self) -> Tensor:
        return self


class Boxes:
    def __init__(self, xyxy: list[Any], ids: list[int] | None) -> None:
        self.xyxy, self.id = Tensor(xyxy), None if ids is None else Tensor(ids)
        self.conf, self.cls = Tensor(SCORES[: len(xyxy)]), Tensor(CLASSES[: len(xyxy)])

    def __len__(self) -> int:
        return len(self.xyxy)


class Model:
    """As ultralytics: the tracker's own callback, which replaces the boxes, is added at the first track()."""

    def __init__(self, _: str) -> None:
        self.callbacks: list[Any] = []
        self.names, self.images = {0: "pole", 1: "house"}, 0

    def add_callback(self, event: str, call: Any) -> None:
        assert event == "on_predict_postprocess_end"
        self.callbacks.append(call)

    def track(self, _: Any, persist: bool, verbose: bool) -> list[Any]:
        assert persist and not verbose
        if self.images == 0:
            self.callbacks.append(self._replace)
        self.images += 1
        predictor = types.SimpleNamespace(results=[types.SimpleNamespace(boxes=Boxes(RAW, None))])
        for call in self.callbacks:
            call(predictor)
        return list(predictor.results)

    def _replace(self, predictor: Any) -> None:
        predictor.results[0].boxes = Boxes(SMOOTHED, IDS) if self.images != 2 else Boxes([], None)


def test_the_tracker_s_ids_come_with_the_detector_s_boxes(monkeypatch: pytest.MonkeyPatch) -> None:
    """An image without an obstacle has a line, too."""
    turns = iter([True, True, True, False])
    camera = types.SimpleNamespace(grab=lambda: next(turns), retrieve=lambda: (True, "image"))
    monkeypatch.setitem(sys.modules, "cv2", types.SimpleNamespace(VideoCapture=lambda _: camera))
    monkeypatch.setitem(sys.modules, "ultralytics", types.SimpleNamespace(YOLO=Model))
    lines = run("ultralytics", monkeypatch)
    expected = [
        {"id": 7, "score": 0.9, "class": "pole", "box": RAW[1]},
        {"id": 9, "score": 0.8, "class": "house", "box": RAW[0]},
    ]
    assert [line["detections"] for line in lines] == [expected, [], expected]

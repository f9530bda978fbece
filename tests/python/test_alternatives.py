"""tools/bench/ALTERNATIVES.md: its tables repeat the recorded figures, and its claims follow from them."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

from bench.optimum.rivals import RIVALS
from goe_tools.report.goals_file import QUANTITIES

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "tools" / "bench" / "ALTERNATIVES.md"
RECORD = ROOT / "tests" / "data" / "rivals.json"
NAMES = {
    "filter": "goe, `filter`",
    "window": "goe, `window` (the paper)",
    "triangulation": "GTSAM, triangulation of the corners",
    "inverse_depth": "inverse-depth Kalman filter",
    "bearing_angle": "bearing-angle Kalman filter",
    "inverse_size": "inverse-size line fit",
}
NOISES = {"gauss1": "1 px, exact pose", "field": "errors of real sensors"}


def recorded() -> dict[tuple[str, str, str], dict[str, float]]:
    """Recorded values by quantity, for each noise, figure and method."""
    found = {}
    for row in json.loads(RECORD.read_text(encoding="utf-8"))["goals"]:
        noise, figure, method = re.fullmatch(
            r"(\w+), (median error|answers)(?:, \d+ flights)?: (\w+)", row["name"]
        ).groups()
        found[noise, figure, method] = {k: math.nan if v is None else v for k, v in row["values"].items()}
    return found


def cell(error: float, answers: float) -> str:
    if not math.isfinite(error):
        return "-"
    return f"{error:.2g}" if answers >= 99.95 else f"{error:.2g} ({answers:.0f} %)"


def table(noise: str) -> list[str]:
    rows = recorded()
    return [
        f"| {name} | " + " | ".join(
            cell(rows[noise, "median error", method][q], rows[noise, "answers", method][q]) for q in QUANTITIES
        ) + " |"
        for method, name in NAMES.items()
    ]  # fmt: skip


def test_all_rivals_are_recorded() -> None:
    assert {*RIVALS, "filter", "window"} == set(NAMES)
    found = recorded()
    assert {(noise, method) for noise, _, method in found} == {(noise, m) for noise in NOISES for m in NAMES}
    flights = re.findall(r"median error, (\d+) flights", RECORD.read_text(encoding="utf-8"))
    assert set(flights) == {"300"} and not json.loads(RECORD.read_text(encoding="utf-8"))["quick"]


def test_the_tables_are_those_of_the_record() -> None:
    blocks = PAGE.read_text(encoding="utf-8").split("<!-- rivals: ")
    shown = {block.split(" ")[0]: block for block in blocks[1:]}
    assert set(shown) == set(NOISES)
    for noise, block in shown.items():
        lines = block.split("-->")[1].strip().splitlines()
        assert lines[2 : 2 + len(NAMES)] == table(noise), "\n".join(table(noise))


def test_the_date_is_that_of_the_record() -> None:
    date = json.loads(RECORD.read_text(encoding="utf-8"))["date"][:10]
    assert f"recorded on {date}" in " ".join(PAGE.read_text(encoding="utf-8").split())


def test_claims_of_the_page_follow_from_its_tables() -> None:
    """With sensor errors the filter has the smallest error in each quantity; other methods answer orientation and
    length more often."""
    found = recorded()
    for q in QUANTITIES:
        errors = {method: found["field", "median error", method][q] for method in NAMES}
        assert min(errors, key=lambda method: errors[method] if math.isfinite(errors[method]) else math.inf) == "filter"
    for q in ("orientation", "L"):
        ours = found["field", "answers", "filter"][q]
        assert any(found["field", "answers", method][q] > ours for method in RIVALS)
    ratio = found["gauss1", "median error", "triangulation"]["X0"] / found["gauss1", "median error", "filter"]["X0"]
    assert 1.0 < ratio < 1.5

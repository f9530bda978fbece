"""Writes a folder like goe_campaign's with invented, deterministic errors, for the tests of the report only."""

from __future__ import annotations

import csv
import json
import math
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

OBSTACLES = {  # W, L, H, lateral distances, altitudes
    "cylinder": (6.0, 6.0, 30.0, (0.0, 30.0, 60.0), (15.0,)),
    "building": (15.0, 40.0, 89.0, (0.0, 75.0, 150.0), (44.5,)),
    "truck": (2.5, 7.0, 2.5, (0.0, 12.5, 25.0), (2.5, 5.0)),
    "long-truck": (2.5, 18.0, 4.0, (0.0, 12.5, 25.0), (4.0, 8.0)),
}
ANGLES = (-45.0, -20.0, 0.0, 20.0, 45.0)
FRACTIONS = (0.2, 0.4, 0.6, 1.0)
QUANTITIES = ("z0", "x0", "width", "length", "height", "orientation")
BOX_ROLLS = (0.0, 5.0, 10.0, 25.0)
REFINED_SHARE = 0.05  # relative to the scatter of the window method
SPREAD = {  # error by model: percent of the truth; meters for the height, degrees for the orientation
    "disc": {"z0": 2.0, "x0": 12.0, "width": 30.0, "height": 0.8},
    "auto": {"z0": 3.0, "x0": 9.0, "width": 1.6, "length": 12.0, "height": 0.9, "orientation": 1.2},
}
STUDIES = {  # columns that differ from the paper's study, and the factor on their errors
    "arc": ({"path": "arc:300"}, 0.8),
    "weave": ({"path": "weave:5,6"}, 0.6),
    "ramp": ({"speed_profile": "ramp:0.5"}, 1.0),
    "wind": ({"wind": "dryden:light"}, 1.1),
    "attitude": ({"noise": "attitude"}, 3.0),
    "position": ({"noise": "position"}, 1.6),
    "field": ({"noise": "field"}, 4.0),
}


def setups() -> list[dict[str, Any]]:
    """The 156 cases of Table 2."""
    found = []
    for name, (_, _, _, sides, altitudes) in OBSTACLES.items():
        angles = (0.0,) if name == "cylinder" else ANGLES
        for side, altitude, alpha, glide in product(sides, altitudes, angles, (0.0, 6.0)):
            found.append({"case": len(found), "obstacle": name, "side_m": side, "alpha_deg": alpha,
                          "altitude_m": altitude, "glide_deg": glide})  # fmt: skip
    return found


def _truths(setup: dict[str, Any], model: str) -> dict[str, float]:
    width, length, height, _, _ = OBSTACLES[setup["obstacle"]]
    alpha = math.radians(setup["alpha_deg"])
    shift = length / 2.0 if model in ("auto", "box") else 0.0
    return {
        "z0": 340.0 - shift * math.cos(alpha), "x0": -setup["side_m"] - shift * math.sin(alpha), "width": width,
        "length": length, "height": height, "orientation": setup["alpha_deg"],
    }  # fmt: skip


def _row(
    rng: np.random.Generator, setup: dict[str, Any], model: str, seed: int, fraction: float, scale: float, **other: Any
) -> dict[str, Any]:
    line = 0.0 if model == "disc" or (setup["side_m"] == 0.0 and setup["alpha_deg"] == 0.0) else 0.7
    far = 0.5 + setup["side_m"] / 40.0
    row: dict[str, Any] = {
        "study": "paper", **setup, "path": "straight", "speed_profile": "constant", "wind": "none", "noise": "rounding",
        "seed": seed, "window": 8, "fps_hz": 8.0,
        "method": "window", "model": model, "fraction": fraction, "frames": 144,
        "solved": 130, "used": round(130 * fraction), "fresh_line_share": line, "swapped": 0,
        "baseline_m": 15.0 * rng.uniform(0.9, 1.1), "condition": 20.0 * far * rng.uniform(0.8, 1.3),
        "roll_deg": 0.0, "z0_covered": None, "x0_covered": None, "height_covered": None,
    }  # fmt: skip
    row.update(other)
    disc = model == "disc" or (model == "auto" and setup["obstacle"] == "cylinder")
    spread = SPREAD["disc" if disc else "auto"]
    for quantity in QUANTITIES:
        truth = _truths(setup, model)[quantity]
        row[f"{quantity}_truth"] = truth
        percent = quantity in ("z0", "x0", "width", "length")
        blind = quantity not in spread or (quantity in ("length", "orientation") and line == 0.0)
        if blind:
            numbers: list[float | None] = [None, None, None]
        else:
            size = spread[quantity] * scale * far * (0.6 + fraction)
            mean, two_sigma = rng.normal(0.0, 0.6 * size), abs(rng.normal(size, 0.3 * size))
            numbers = [mean, two_sigma, math.hypot(mean, two_sigma / 2.0)]
        unit = abs(truth) / 100.0 if percent else 1.0
        for measure, number in zip(("mean", "two_sigma", "rmse"), numbers):
            row[f"{quantity}_{measure}"] = None if number is None else number * unit
            if percent:
                row[f"{quantity}_{measure}_pct"] = None if abs(truth) < 1e-6 else number
    return row


def rows(seeds: int = 1, studies: bool = True) -> list[dict[str, Any]]:
    rng = np.random.default_rng(20260101)
    found = []
    for seed, setup in product(range(1, seeds + 1), setups()):
        models = ("disc",) if setup["obstacle"] == "cylinder" else ("auto", "disc")
        for model, fraction in product(models, FRACTIONS):
            found.append(_row(rng, setup, model, seed, fraction, 1.0))
    if not studies:
        return found
    subset = [s for s in setups() if abs(s["alpha_deg"]) != 20.0 and s["glide_deg"] == 0.0]
    for (study, (change, scale)), setup in product(STUDIES.items(), subset):
        model = "disc" if setup["obstacle"] == "cylinder" else "auto"
        levels = ("dryden:light", "dryden:moderate") if study == "wind" else (None,)
        for level in levels:
            extra = {"study": study, **change, **({"wind": level} if level else {})}
            factor = scale * (1.4 if level == "dryden:moderate" else 1.0)
            for fraction in FRACTIONS:
                found.append(_row(rng, setup, model, 1, fraction, factor, **extra))
    for setup, (window, fps) in product(subset, [(n, 8.0) for n in (4, 8, 16, 32, 64)] + [(8, 2.0), (8, 32.0)]):
        model = "disc" if setup["obstacle"] == "cylinder" else "auto"
        baseline = 17.0 * window / fps
        scale = (17.0 / baseline) ** 1.2
        far = 0.5 + setup["side_m"] / 40.0
        extra = {"study": "conditioning", "window": window, "fps_hz": fps, "baseline_m": baseline,
                 "condition": 300.0 * far / baseline * rng.uniform(0.8, 1.3)}  # fmt: skip
        for fraction in FRACTIONS:
            found.append(_row(rng, setup, model, 1, fraction, scale, **extra))
    return found


def refined_rows(seeds: int = 1, studies: bool = True) -> list[dict[str, Any]]:
    """Rows of the filter method: the paper's study without and with the box as configured shape, and the field
    study."""
    rng = np.random.default_rng(20260102)
    found = []
    for seed, setup, fraction in product(range(1, seeds + 1), setups(), FRACTIONS):
        for model in ("auto",) if setup["obstacle"] == "cylinder" else ("auto", "box"):
            found.append(_row(rng, setup, model, seed, fraction, REFINED_SHARE, method="filter"))
    if studies:
        change, scale = STUDIES["field"]
        for setup, fraction in product(setups(), FRACTIONS):
            if abs(setup["alpha_deg"]) != 20.0 and setup["glide_deg"] == 0.0:
                found.append(_row(rng, setup, "auto", 1, fraction, REFINED_SHARE * scale, method="filter",
                                  study="field", **change))  # fmt: skip
    return found


def box_rows() -> list[dict[str, Any]]:
    """Rows of both methods for upright boxes. Roll improves filter, and its sigmas are right; window is far off."""
    rng = np.random.default_rng(20260103)
    found = []
    for roll, setup, fraction in product(BOX_ROLLS, setups()[:20], FRACTIONS):
        for method, scale, covered in (("filter", 1.0 / (1.0 + roll / 10.0), 0.94), ("window", 40.0, 0.55)):
            shares = dict.fromkeys(("z0_covered", "x0_covered", "height_covered"), covered)
            found.append(_row(rng, setup, "auto", 1, fraction, scale, method=method, study="boxes", noise="field",
                              roll_deg=roll, **shares))  # fmt: skip
    return found


QUANTITY_NAMES = ("X0", "Z0", "orientation", "W", "L", "H")


def _goal(
    group: str, name: str, values: dict[str, float | None], wanted: tuple[float | None, float | None] | None = None,
    asked: tuple[str, ...] = (), unit: str = "1",
) -> dict[str, Any]:  # fmt: skip
    met = None
    if wanted is not None:
        low, high = (-math.inf if wanted[0] is None else wanted[0]), (math.inf if wanted[1] is None else wanted[1])
        asked = asked or tuple(values)
        met = all(values[n] is not None and low <= values[n] <= high for n in asked)  # type: ignore[operator]
    return {"group": group, "name": name, "unit": unit, "wanted": wanted, "asked": list(asked), "values": values,
            "met": met}  # fmt: skip


def _six(*values: float | None) -> dict[str, float | None]:
    return dict(zip(QUANTITY_NAMES, values))


def goals() -> list[dict[str, Any]]:
    """Rows as the goals command writes them. Two goals are missed: W of the coverage, and the moving cars."""
    early = {"cylinder": 15.31, "building": 37.2, "truck": 14.4, "long-truck": 15.1}
    found = [
        _goal("gauss1", "RMSE / bound, median of 12 cases", _six(1.011, 1.022, 1.033, 0.997, 1.055, 1.066), (0, 1.25)),
        _goal("gauss1", "RMSE / bound, 90th percentile", _six(1.5, 1.6, 1.7, 1.4, 1.3, 1.2), (0, 2.0)),
        _goal("gauss1", "within 2 sigma, boxes, all answers", _six(95.1, 94.2, 93.3, 81.7, 95.5, 96.6), (90, 98),
              unit="%"),
        _goal("gauss1", "within 2 sigma, cylinders, at the end", {"X0": 95.0, "Z0": 96.0, "W": 97.0, "H": 91.0},
              (90, 98), unit="%"),
        _goal("gauss1", "NEES over quantities, boxes", {"mean": 1.021, "median": 0.9, "mean without worst 1 %": 0.8},
              (0.97, 1.03), ("mean",)),
        _goal("gauss1", "NIS over rows, boxes", {"mean": 0.987}),
        *(_goal("early: Z0 known to 10%", f"field, {way}", {o: share * v for o, v in early.items()}, unit="s")
          for way, share in (("filter, own 2 sigma", 1.0), ("filter, true error", 1.1), ("window, true error", 0.3))),
        _goal("kitti", "68 moving cars caught, at a share of false flags", {"0 %": 20.0, "5 %": 34.7, "20 %": 50.0},
              (60, 100), ("5 %",), "%"),
        _goal("kitti", "NIS ratio as a flag", {"area under the curve": 0.661}),
        _goal("kitti", "flagged as suspect with the default threshold", {"parked": 1.0, "moving": 14.0}, unit="%"),
    ]  # fmt: skip
    for name, errors in (
        ("filter", _six(0.7, 0.6, 0.15, 0.021, 0.06, 0.02)), ("window", _six(2.1, 5.0, 1.4, 0.37, 1.6, 0.9)),
        ("triangulation", _six(0.53, 5.3, 2.0, 0.27, 0.9, 0.3)),
        ("bearing_angle", _six(1.8, 6.5, None, 0.12, None, None)),
    ):  # fmt: skip
        found.append(_goal("rivals", f"field, median error, 40 flights: {name}", errors, unit="m, deg"))
        shares = _six(*(0.0 if e is None else 100.0 for e in errors.values()))
        found.append(_goal("rivals", f"field, answers: {name}", shares, unit="%"))
    return found


def hostile_goals() -> list[dict[str, Any]]:
    """Lines of the groups attack and hazard: two attacks, of which one misses its goal, and a row of warnings."""
    slope, mover = "attack: configured errors", "attack: moving obstacles"
    return [
        _goal(slope, "slope 3 %: within 2 sigma", _six(73.1, 50.2, 64.3, 54.4, None, 67.6), (90, 100), ("X0", "Z0"),
              "%"),
        _goal(slope, "slope 3 %: within 2 sigma, W", {"W": 54.4}, (50, 100), unit="%"),
        _goal(slope, "slope 3 %: wrong by 5 sigma", {"any": 65.0, "position": 35.8}, unit="%"),
        _goal(slope, "slope 3 %: suspect", {"tracks": 10.8, "images": 2.2, "or covered": 16.7}, unit="%"),
        _goal(mover, "across 5 m/s: flagged as moving", {"4 s": 97.0, "8 s": 100.0, "ever": 100.0}, (90, 100), ("4 s",),
              "%"),
        _goal(mover, "across 5 m/s: suspect", {"tracks": 100.0, "images": 76.9}, unit="%"),
        _goal("hazard", "corners, nominal: true share by predicted", {"0.05 to 0.2": 0.123, "0.2 to 0.5": 0.46}),
        _goal("hazard", "corners, nominal: predicted less true", {"0.05 to 0.2": 0.02, "0.2 to 0.5": 0.11}, (0, 0.1)),
        _goal("hazard", "corners, nominal: within 2 sigma", {"time": 96.0, "miss": 94.0, "clearance": 91.0}, (90, 100),
              unit="%"),
        _goal("hazard", "corners, nominal: unwarned 5 s ahead", {"violators": 0.0}, (0, 0), unit="%"),
    ]  # fmt: skip


def more_goals() -> list[dict[str, Any]]:
    """Coverage and early warning of other groups, for information: as many as a full run has."""
    found = []
    for group in ("gauss0.3", "rounding", "field", "recorded: px4", "recorded: arduplane", "boxes", "kitti"):
        for kind, moment in product(("boxes", "cylinders"), ("all answers", "first answers", "at the end")):
            shares = _six(94.0, 95.0, 96.0, 93.0, 97.0, 92.0)
            found.append(_goal(group, f"within 2 sigma, {kind}, {moment}", shares, unit="%"))
    ways = ("filter, own 2 sigma", "filter, true error", "window, true error")
    for noise, way in product(("rounding", "gauss1"), ways):
        values = {"cylinder": 15.0, "building": 37.0, "truck": 14.0, "long-truck": 15.0}
        found.append(_goal("early: Z0 known to 10%", f"{noise}, {way}", values, unit="s"))  # type: ignore[arg-type]
    return found


AVOID_KINDS = {"mast": (18.0, 7.7, "left"), "building": (19.0, 9.2, "right"), "truck": (35.0, 8.4, "go_around")}


def avoid_rows(runs: int = 20) -> list[dict[str, Any]]:
    """Rows as goe_avoid writes them. The first collision course of each kind has no collision without orders. The last
    one of a truck has a collision with a late order. The second pass of a building gets a false order."""
    rng = np.random.default_rng(20260104)
    found = []
    for course, (kind, (away, ahead, action)), k in product(("collision", "pass"), AVOID_KINDS.items(), range(runs)):
        row: dict[str, Any] = {
            "kind": kind, "course": course, "seed": 1 + k, "delay_s": 0.1, "margin_m": 15.0, "collision_m": 0.95,
            "pass_m": None, "action": action, "ahead_s": ahead + rng.normal(), "late": 0, "false_order": None,
            "closest_without_m": 3.0 if k == 0 else 0.9, "collided_without": int(k > 0),
            "closest_with_m": away + 1.5 * rng.uniform(-1.0, 1.0), "collided_with": 0, "suspect": 0, "assessed": 90,
            "confident": 0,
        }  # fmt: skip
        if course == "pass":
            false = kind == "building" and k == 1
            row |= {"pass_m": 30.0, "false_order": int(false), "closest_without_m": 30.0, "collided_without": 0,
                    "closest_with_m": None, "collided_with": None}  # fmt: skip
            row |= {} if false else {"action": "none", "ahead_s": None}
        elif kind == "truck" and k == runs - 1:
            row |= {"ahead_s": 1.0, "late": 1, "closest_with_m": 0.8, "collided_with": 1}
        found.append(row)
    return found


def write_avoid(path: Path, given_rows: list[dict[str, Any]] | None = None) -> Path:
    _write_csv(path, avoid_rows() if given_rows is None else given_rows)
    return path


def write_goals(path: Path, hostile: bool = False) -> Path:
    rows = goals() + (hostile_goals() + more_goals() if hostile else [])
    path.write_text(json.dumps({"quick": False, "date": "2026-11-01", "goals": rows}), encoding="utf-8")
    return path


def _write_csv(path: Path, table: list[dict[str, Any]]) -> None:
    with path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(table[0])
        for row in table:
            writer.writerow(
                "" if v is None else f"{v:.9g}" if isinstance(v, float) else v for v in (row[k] for k in table[0])
            )


def _series(setup: dict[str, Any]) -> list[dict[str, Any]]:
    rng = np.random.default_rng(setup["case"])
    found, mean = [], None
    for k in range(240):
        noise = 8.0 * math.exp(-k / 60.0)
        raw = setup["alpha_deg"] + rng.normal(0.0, noise) if k > 20 else None
        if raw is not None:
            mean = raw if mean is None else mean + (raw - mean) / min(k - 20, 20)
        found.append({
            "t_s": k / 8.0, "status": "ok" if k > 28 else "converging", "model": "line" if k > 28 else "disc",
            "x0_m": -75.0 + rng.normal(0, 2), "z0_m": 660.0 + rng.normal(0, 5), "width_m": 15 + rng.normal(0, 0.4),
            "orientation_deg": mean, "orientation_raw_deg": raw,
            "front_orientation_deg": None if raw is None else 90.0 + setup["alpha_deg"] + rng.normal(0.0, noise),
            "orientation_true_deg": setup["alpha_deg"],
        })  # fmt: skip
    return found


def write_campaign(folder: Path, seeds: int = 1, studies: bool = True, refined: bool = True) -> Path:
    (folder / "series").mkdir(parents=True)
    table = rows(seeds, studies) + (refined_rows(seeds, studies) if refined else [])
    table += box_rows() if refined and studies else []
    _write_csv(folder / "cases.csv", table)
    for setup in setups():
        if setup["obstacle"] == "building" and setup["alpha_deg"] == -20.0:
            _write_csv(folder / "series" / f"{setup['case']}_auto.csv", _series(setup))
    facts = {"version": "0.0.0-synthetic", "seeds": seeds, "rows": len(table)}
    (folder / "campaign.json").write_text(json.dumps(facts), encoding="utf-8")
    return folder

"""A folder as goe_campaign writes it, with invented errors: for tests of the report only. Deterministic."""

from __future__ import annotations

import csv
import json
import math
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

OBSTACLES = {  # W, L, H, side distances, altitudes
    "cylinder": (6.0, 6.0, 30.0, (0.0, 30.0, 60.0), (15.0,)),
    "building": (15.0, 40.0, 89.0, (0.0, 75.0, 150.0), (44.5,)),
    "truck": (2.5, 7.0, 2.5, (0.0, 12.5, 25.0), (2.5, 5.0)),
    "long-truck": (2.5, 18.0, 4.0, (0.0, 12.5, 25.0), (4.0, 8.0)),
}
ANGLES = (-45.0, -20.0, 0.0, 20.0, 45.0)
FRACTIONS = (0.2, 0.4, 0.6, 1.0)
QUANTITIES = ("z0", "x0", "width", "length", "height", "orientation")
SPREAD = {  # of the error, in percent of the truth or (height, orientation) metres and degrees, by model
    "disc": {"z0": 2.0, "x0": 12.0, "width": 30.0, "height": 0.8},
    "auto": {"z0": 3.0, "x0": 9.0, "width": 1.6, "length": 12.0, "height": 0.9, "orientation": 1.2},
}
STUDIES = {  # columns that differ from the paper's study, and how much larger errors are
    "arc": ({"path": "arc:300"}, 0.8),
    "weave": ({"path": "weave:5,6"}, 0.6),
    "ramp": ({"speed_profile": "ramp:0.5"}, 1.0),
    "wind": ({"wind": "dryden:light"}, 1.1),
    "attitude": ({"noise": "attitude"}, 3.0),
    "position": ({"noise": "position"}, 1.6),
    "field": ({"noise": "field"}, 4.0),
}


def setups() -> list[dict[str, Any]]:
    """Table 2: 156 cases."""
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
    shift = length / 2.0 if model == "auto" else 0.0
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
    }  # fmt: skip
    row.update(other)
    spread = SPREAD["disc" if line == 0.0 and model == "auto" and setup["obstacle"] == "cylinder" else model]
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
            "t_s": k / 8.0, "status": "ok" if k > 28 else "collecting", "model": "line" if k > 28 else "disc",
            "x0_m": -75.0 + rng.normal(0, 2), "z0_m": 660.0 + rng.normal(0, 5), "width_m": 15 + rng.normal(0, 0.4),
            "orientation_deg": mean, "orientation_raw_deg": raw,
            "other_side_deg": None if raw is None else 90.0 + setup["alpha_deg"] + rng.normal(0.0, noise),
            "orientation_true_deg": setup["alpha_deg"],
        })  # fmt: skip
    return found


def write_campaign(folder: Path, seeds: int = 1, studies: bool = True) -> Path:
    (folder / "series").mkdir(parents=True)
    table = rows(seeds, studies)
    _write_csv(folder / "cases.csv", table)
    for setup in setups():
        if setup["obstacle"] == "building" and setup["alpha_deg"] == -20.0:
            _write_csv(folder / "series" / f"{setup['case']}_auto.csv", _series(setup))
    facts = {"version": "0.0.0-synthetic", "seeds": seeds, "rows": len(table)}
    (folder / "campaign.json").write_text(json.dumps(facts), encoding="utf-8")
    return folder

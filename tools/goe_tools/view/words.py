"""The estimate of one image as text: the same on the page, in the picture and for screen readers.

"±" is always 1 sigma. Lengths in meters.
"""

from __future__ import annotations

import math

from .answers import Answers

NOTHING = "–"
OLD_S = 0.05  # an estimate of less age counts as new
NOT_YET = "Not detected yet"
HARD = "\u00a0"  # no line break here
MODELS = {"disc": "a disc", "line": "a front edge", "box": "a box", "prism": "an upright obstacle of unknown depth"}
STATUS = {
    "converging": "collecting images",
    "stale": "no new information in this image",
    "no_detection": "no detection",
    "behind_camera": "the obstacle is not ahead of the camera",
    "lens_failed": "the lens model is not valid there",
    "swapped": "left and right sides are exchanged",
    "edge_on": "the front edge points at the camera",
    "no_edge": "every edge is too short",
    "bad_height": "the height above ground is not positive",
    "no_baseline": "the camera moved too little",
    "no_parallax": "the obstacle does not grow in the image",
    "abeam": "the obstacle is abeam or behind",
    "not_finite": "the image was refused: not a number",
    "out_of_range": "the image was refused: a number out of range",
    "bad_time": "the image was refused: its time",
    "bad_attitude": "the image was refused: its attitude",
    "box_incomplete": "fewer than two usable sides of the box",
    "no_height": "the height above ground is not set",
}
REASONS = {
    "convention": "the inputs contradict each other: axes, signs, mounting, or a pose half a second late",
    "moves": "the obstacle moves",
    "base": "the base corners are not on the ground; they are ignored",
    "shape": "the obstacle is not round",
    "late": "poses and images differ in time",
    "noise": "errors larger than configured, or another shape",
}


def decimals(two_sigma: float, figures: int = 1) -> int:
    """Decimals that show ``figures`` digits of the band, 0 to 2."""
    if not (two_sigma > 0.0 and math.isfinite(two_sigma)):
        return 1
    return min(2, max(0, figures - 1 - math.floor(math.log10(two_sigma))))


def measured(value: float, sigma: float, unit: str = "m", figures: int = 2) -> str:
    """ "473 ± 12 m"; without a sigma the value alone."""
    if not math.isfinite(value):
        return NOTHING
    space = "" if unit in ("°", "") else "\u00a0"
    if not math.isfinite(sigma):
        return f"{value:.{1 if abs(value) >= 10.0 else 2}f}{space}{unit}".replace("-", "−")
    places = decimals(sigma, figures)
    return f"{value:.{places}f}\u00a0±\u00a0{sigma:.{places}f}{space}{unit}".replace("-", "−")


def _value(answers: Answers, k: int, name: str) -> tuple[float, float]:
    stem, unit = name.split("_", 1)
    return float(answers.column[name][k]), float(answers.column[f"{stem}_sd_{unit}"][k])


def place(answers: Answers, k: int) -> str:
    """ "473 ± 12 m ahead, 41 ± 1 m left, 15 ± 1 m wide, 60 ± 2 m high"."""
    z, x = _value(answers, k, "z_m"), _value(answers, k, "x_m")
    if not math.isfinite(z[0]):
        return f"No estimate yet: {STATUS.get(answers.status[k], answers.status[k])}"
    said = [f"{measured(abs(z[0]), z[1], figures=1)}{HARD}{'ahead' if z[0] >= 0.0 else 'behind'}"]
    said.append(f"{measured(abs(x[0]), x[1], figures=1)}{HARD}{'left' if x[0] < 0.0 else 'right'}")
    for name, word in (("width_m", "wide"), ("length_m", "long"), ("height_m", "high")):
        value, sigma = _value(answers, k, name)
        if math.isfinite(value):
            said.append(f"{measured(value, sigma, figures=1)}{HARD}{word}")
    return ", ".join(said)


def approach(answers: Answers, k: int) -> str:
    """The closest approach on the present course; empty if it is not known."""
    time_s, miss = _value(answers, k, "tcpa_s"), _value(answers, k, "dcpa_m")
    if not math.isfinite(time_s[0]):
        return ""
    clear_m, clear_sd_m = _value(answers, k, "clearance_m")
    if time_s[0] == 0.0:
        when, past = "On the present course: closest approach passed", f", {measured(*miss, figures=1)} to the side"
    elif miss[0] == 0.0:
        way = "over" if clear_m >= 0.0 else "into" if clear_m < 0.0 else "over or into"
        when, past = f"On the present course: {way} the obstacle in {measured(*time_s, 's', 1)}", ""
    else:
        when = f"On the present course: closest approach in {measured(*time_s, 's', 1)}"
        past = f", {measured(*miss, figures=1)} to the side"
    if math.isfinite(clear_m):
        over = "above the top" if clear_m >= 0.0 else "below the top"
        past += f", {measured(abs(clear_m), clear_sd_m, figures=1)} {over}"
    return when + past


def state(answers: Answers, k: int) -> str:
    """Model, age and status of the estimate."""
    if answers.model[k] == "none":
        return ""
    text = f"Model: {MODELS.get(answers.model[k], answers.model[k])}"
    if not answers.fresh[k]:
        why = STATUS.get(answers.status[k], answers.status[k].replace("_", " "))
        text += f". {why[0].upper()}{why[1:]}"
        text += f"; the estimate is {answers.age_s[k]:.1f} s old" if answers.age_s[k] >= OLD_S else ""
    elif answers.status[k] == "partial":
        text += ". A part of the image was not used"
    return text


def doubt(answers: Answers, k: int) -> str:
    """Why the estimate is suspect; otherwise the detected anomaly; empty if there is none."""
    reason = answers.reason[k]
    words = REASONS.get(reason, reason)
    if reason == "late":
        words += f", by {float(answers.column['latency_s'][k]):.2f} s".replace("-", "−")
    speed_m_s = math.hypot(*(float(answers.column[f"velocity_{axis}_m_s"][k]) for axis in ("north", "east")))
    if reason == "moves" and speed_m_s > 0.0:
        words += f" at {speed_m_s:.1f}{HARD}m/s; the estimate follows it"
    if answers.suspect[k]:
        return f"Suspect: {words}" if reason != "none" else "Suspect"
    return "" if reason == "none" else words[0].upper() + words[1:]

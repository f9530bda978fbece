"""One image's answer as text for a pilot, shared by the page, the picture and screen readers.

Every "±" is one sigma. Lengths in meters.
"""

from __future__ import annotations

import math

from .answers import Answers

NOTHING = "–"
OLD_S = 0.05  # a younger answer is current
HARD = "\u00a0"  # a non-breaking space
MODELS = {"disc": "a disc", "line": "a front edge", "box": "a box", "prism": "an upright box, of unknown depth"}
STATUS = {
    "converging": "collecting images",
    "stale": "no new information in this image",
    "no_detection": "no detection",
    "behind_camera": "it is not ahead of the camera",
    "lens_failed": "the lens model fails at this point",
    "swapped": "left and right are swapped",
    "edge_on": "the front is viewed edge-on",
    "no_edge": "no edge is long enough",
    "bad_height": "the height above ground is not positive",
    "no_baseline": "the camera moved too little",
    "no_parallax": "the image does not grow",
    "abeam": "it is abeam or behind",
    "not_finite": "the image was refused: not a number",
    "out_of_range": "the image was refused: a number out of range",
    "bad_time": "the image was refused: its time",
    "bad_attitude": "the image was refused: its attitude",
    "box_incomplete": "fewer than two sides of the box are usable",
    "no_height": "the height above ground is not set",
}
REASONS = {
    "convention": "inconsistent inputs: axes, signs, mounting, or a pose half a second late",
    "moves": "it moves",
    "base": "the given base corners are not base corners, and are ignored",
    "shape": "it is not round",
    "late": "poses and images differ in time",
    "noise": "the errors are larger than configured, or it has another shape",
}


def decimals(two_sigma: float, figures: int = 1) -> int:
    """Decimals that show this many figures of the band, 0 to 2."""
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
        return f"No answer yet: {STATUS.get(answers.status[k], answers.status[k])}"
    said = [f"{measured(abs(z[0]), z[1], figures=1)}{HARD}{'ahead' if z[0] >= 0.0 else 'behind'}"]
    said.append(f"{measured(abs(x[0]), x[1], figures=1)}{HARD}{'left' if x[0] < 0.0 else 'right'}")
    for name, word in (("width_m", "wide"), ("length_m", "long"), ("height_m", "high")):
        value, sigma = _value(answers, k, name)
        if math.isfinite(value):
            said.append(f"{measured(value, sigma, figures=1)}{HARD}{word}")
    return ", ".join(said)


def approach(answers: Answers, k: int) -> str:
    """The closest approach at the present velocity; empty if unknown."""
    time_s, miss = _value(answers, k, "tcpa_s"), _value(answers, k, "dcpa_m")
    if not math.isfinite(time_s[0]):
        return ""
    clear_m, clear_sd_m = _value(answers, k, "clearance_m")
    if time_s[0] == 0.0:
        when, past = "At this velocity: it falls behind", f", {measured(*miss, figures=1)} from the path"
    elif miss[0] == 0.0:
        when, past = f"At this velocity: over it in {measured(*time_s, 's', 1)}", ""
    else:
        when = f"At this velocity: closest in {measured(*time_s, 's', 1)}"
        past = f", {measured(*miss, figures=1)} away"
    if math.isfinite(clear_m):
        over = "above its top" if clear_m >= 0.0 else "below its top"
        past += f", {measured(abs(clear_m), clear_sd_m, figures=1)} {over}"
    return when + past


def state(answers: Answers, k: int) -> str:
    """Details of the answer: model, age, status."""
    if answers.model[k] == "none":
        return ""
    said = f"Model: {MODELS.get(answers.model[k], answers.model[k])}"
    if not answers.fresh[k]:
        why = STATUS.get(answers.status[k], answers.status[k].replace("_", " "))
        said += f". {why[0].upper()}{why[1:]}"
        said += f"; the answer is {answers.age_s[k]:.1f} s old" if answers.age_s[k] >= OLD_S else ""
    elif answers.status[k] == "partial":
        said += ". Part of the image was not used"
    return said


def doubt(answers: Answers, k: int) -> str:
    """The cause of suspicion, or a notice about an answer that is not suspect; empty without either."""
    reason = answers.reason[k]
    words = REASONS.get(reason, reason)
    if reason == "late":
        words += f", by {float(answers.column['latency_s'][k]):.2f} s".replace("-", "−")
    speed_m_s = math.hypot(*(float(answers.column[f"velocity_{axis}_m_s"][k]) for axis in ("north", "east")))
    if reason == "moves" and speed_m_s > 0.0:
        words += f", {speed_m_s:.1f}{HARD}m/s, and its velocity is estimated"
    if answers.suspect[k]:
        return f"Suspect: {words}" if reason != "none" else "Suspect"
    return "" if reason == "none" else words[0].upper() + words[1:]

"""The Cramer-Rao bound: no unbiased estimator of the obstacle can have a smaller one-sigma than this.

All images are used, with the noise that the user would state: pixels, attitude (constant and white), height, velocity.
What the position wanders by beyond a constant velocity error (``position_walk_m``) and the drift of the attitude are
left out: with them no estimator can do better than without, so the figure stays a bound.

    python -m goe_tools bound DIR
"""

from __future__ import annotations

import argparse
import dataclasses
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ..flights.flight import QUANTITIES, Flight
from ..flights.noise import FIELD, Noise
from .model import (
    correspond,
    covariances,
    jacobian,
    logged_flights,
    prior_sigmas,
    quantity_slopes,
    row_mask,
    true_state,
    view_of,
    whitened,
)

HEADINGS = ("X0 m", "Z0 m", "orientation deg", "W m", "L m", "H m")
NOISE_OPTIONS = {
    "pixel": ("pixel_px", "PX", "one sigma of an image point"),
    "size-share": ("size_share", "X", "... and of the obstacle's width in the image, which is added"),
    "correlation": ("correlation", "R", "of the image points' errors, from image to image"),
    "shape-share": ("shape_share", "X", "of the width, by which a disc stands badly for the obstacle"),
    "attitude-bias": ("attitude_bias_deg", "DEG", "constant error of the attitude, each axis"),
    "attitude-white": ("attitude_white_deg", "DEG", "error of the attitude in each image"),
    "height": ("height_m", "M", "constant error of the height"),
    "velocity": ("velocity_bias_m_s", "MPS", "constant error of the velocity over ground"),
}


@dataclass
class Bound:
    """One sigma (6,) and covariance (6, 6) of x0, z0, orientation (rad), width, length and height; huge if nothing is
    known of a quantity. For a disc the orientation's means nothing, and the length is the width."""

    sigma: np.ndarray
    covariance: np.ndarray
    state_covariance: np.ndarray  # (12, 12)


def information(flight: Flight, noise: Noise | None = None) -> np.ndarray:
    """(12, 12): Fisher information of the states of ``model`` at the truth, priors included."""
    noise = flight.noise if noise is None else noise
    view, state = view_of(flight), true_state(flight)
    corners = correspond(view, state)
    slopes = jacobian(view, corners, state)
    white = whitened(covariances(view, slopes, state, noise), row_mask(corners.usable), slopes)
    return white.T @ white + np.diag(prior_sigmas(noise, view.box) ** -2)


def inverse(matrix: np.ndarray) -> np.ndarray:
    """Inverse of a symmetric positive matrix whose states differ much in size."""
    scale = 1 / np.sqrt(np.diag(matrix))
    return scale[:, None] * np.linalg.inv(matrix * scale[:, None] * scale) * scale


def bound(flight: Flight, noise: Noise | None = None) -> Bound:
    """The bound with all images of a flight; ``noise``: by default the flight's own."""
    covariance = inverse(information(flight, noise))
    slopes = quantity_slopes(true_state(flight), flight.truth.kind == "box")
    result = slopes @ covariance @ slopes.T
    return Bound(np.sqrt(np.maximum(np.diag(result), 0.0)), result, covariance)


# -------------------------------------------------------------------------------------------------------------- shell


def add_noise_arguments(parser: argparse.ArgumentParser) -> None:
    for option, (name, unit, text) in NOISE_OPTIONS.items():
        default = getattr(FIELD, name)
        parser.add_argument(
            f"--{option}", dest=name, type=float, default=default, metavar=unit, help=f"{text} (default {default:g})"
        )


def noise_of(arguments: argparse.Namespace) -> Noise:
    """The noise that a command line states."""
    values = {name: getattr(arguments, name) for name, _, _ in NOISE_OPTIONS.values()}
    for name, value in values.items():
        if not (math.isfinite(value) and value >= 0.0) or (name == "correlation" and value >= 1.0):
            raise ValueError(f"{name} = {value:g}: must be {'0 to below 1' if name == 'correlation' else 'at least 0'}")
    return dataclasses.replace(FIELD, outliers=0.0, **values)


def printable(values: np.ndarray) -> np.ndarray:
    """In the units of ``HEADINGS``."""
    return np.where(np.arange(len(QUANTITIES)) == 2, np.degrees(values), values)


def print_row(label: str, values: np.ndarray, show: np.ndarray) -> None:
    print(f"{label:22s}" + "".join(f"{v:17.4f}" if ok else f"{'-':>17s}" for v, ok in zip(values, show)))


def shown(flight: Flight) -> np.ndarray:
    """(6,): quantities that the obstacle has."""
    box = flight.truth.kind == "box"
    return np.array([True, True, box, True, box, True])


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("log", type=Path, metavar="DIR", help="log folder with truth.csv")
    parser.add_argument("--disc", action="store_true", help="take every obstacle for a disc")
    add_noise_arguments(parser)


def print_flights(arguments: argparse.Namespace) -> Iterator[Flight]:
    """The flights of the log, each once its name, the headings and the truth are printed."""
    for flight in logged_flights(arguments.log, "disc" if arguments.disc else None):
        print(f"{flight.name}: {flight.truth.kind}, {len(flight.time_s)} images")
        print(" " * 22 + "".join(f"{heading:>17s}" for heading in HEADINGS))
        print_row("truth", printable(flight.truth.values), shown(flight))
        yield flight


def run(arguments: argparse.Namespace) -> int:
    noise = noise_of(arguments)
    for flight in print_flights(arguments):
        print_row("one sigma, at best", printable(bound(flight, noise).sigma), shown(flight))
    return 0

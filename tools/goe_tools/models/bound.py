"""The Cramer-Rao bound: the smallest one-sigma of any unbiased estimator of the obstacle.

The bound uses all images and the configured noise: pixels, attitude (constant and white), height, velocity. It leaves
out the random walk of the position (``position_walk_sd_m``) and the drift of the attitude: they can only make an
estimator
worse, so the figure stays a lower bound.

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
from ..logs.fields import LogError
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
    "size-share": ("size_share", "X", "... plus this share of the obstacle's width in the image"),
    "correlation": ("correlation", "R", "correlation of the image points' errors from image to image"),
    "shape-share": ("shape_error_rel", "X", "shape error of the disc model, share of the width"),
    "attitude-bias": ("attitude_bias_sd_deg", "DEG", "constant error of the attitude, each axis"),
    "attitude-white": ("attitude_white_sd_deg", "DEG", "error of the attitude in each image"),
    "height": ("height_m", "M", "constant error of the height"),
    "velocity": ("velocity_bias_sd_m_s", "MPS", "constant error of the velocity over ground"),
}


@dataclass
class Bound:
    """Sigma (6,) and covariance (6, 6) of x0, z0, orientation (rad), width, length and height; huge for a quantity that
    the images do not determine. For a disc, ignore the orientation; the length equals the width."""

    sigma: np.ndarray
    covariance: np.ndarray
    state_covariance: np.ndarray  # (12, 12)


def information(flight: Flight, noise: Noise | None = None) -> np.ndarray:
    """(12, 12): Fisher information of the states of ``model`` at the truth, including priors."""
    noise = flight.noise if noise is None else noise
    view, state = view_of(flight), true_state(flight)
    corners = correspond(view, state)
    slopes = jacobian(view, corners, state)
    white = whitened(covariances(view, slopes, state, noise), row_mask(corners.usable), slopes)
    return white.T @ white + np.diag(prior_sigmas(noise, view.box) ** -2)


def inverse(matrix: np.ndarray) -> np.ndarray:
    """Inverse of a symmetric positive matrix with states of very different size."""
    scale = 1 / np.sqrt(np.diag(matrix))
    return scale[:, None] * np.linalg.inv(matrix * scale[:, None] * scale) * scale


def bound(flight: Flight, noise: Noise | None = None) -> Bound:
    """The bound from all images of a flight; ``noise``: by default that of the flight."""
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
    """The noise that the options configure."""
    values = {name: getattr(arguments, name) for name, _, _ in NOISE_OPTIONS.values()}
    for name, value in values.items():
        if not (math.isfinite(value) and value >= 0.0) or (name == "correlation" and value >= 1.0):
            raise ValueError(f"{name} = {value:g}: must be {'0 to below 1' if name == 'correlation' else 'at least 0'}")
    return dataclasses.replace(FIELD, outliers=0.0, **values)


def printable(values: np.ndarray) -> np.ndarray:
    """Converts to the units of ``HEADINGS``."""
    return np.where(np.arange(len(QUANTITIES)) == 2, np.degrees(values), values)


def print_row(label: str, values: np.ndarray, show: np.ndarray) -> None:
    print(f"{label:22s}" + "".join(f"{v:17.4f}" if ok else f"{'-':>17s}" for v, ok in zip(values, show)))


def shown(flight: Flight) -> np.ndarray:
    """(6,): whether the obstacle has the quantity."""
    box = flight.truth.kind == "box"
    return np.array([True, True, box, True, box, True])


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument(
        "log", type=Path, metavar="DIR", help="log folder with points and truth.csv; boxes are not used"
    )
    parser.add_argument("--disc", action="store_true", help="model every obstacle as a disc")
    add_noise_arguments(parser)


def print_flights(arguments: argparse.Namespace) -> Iterator[Flight]:
    """Yields the flights of the log, after printing name, headings and truth of each. LogError: a track without
    points."""
    flights = logged_flights(arguments.log, "disc" if arguments.disc else None)
    blind = [flight.name for flight in flights if not flight.seen.any()]
    if blind or not flights:
        reason = f"no points in the images of {', '.join(blind)}; boxes are not used" if blind else "no truth"
        raise LogError(arguments.log / "frames.csv", 0, "", reason)
    for flight in flights:
        print(f"{flight.name}: {flight.truth.kind}, {len(flight.time_s)} images")
        print(" " * 22 + "".join(f"{heading:>17s}" for heading in HEADINGS))
        print_row("truth", printable(flight.truth.values), shown(flight))
        yield flight


def run(arguments: argparse.Namespace) -> int:
    noise = noise_of(arguments)
    for flight in print_flights(arguments):
        print_row("smallest one sigma", printable(bound(flight, noise).sigma), shown(flight))
    return 0

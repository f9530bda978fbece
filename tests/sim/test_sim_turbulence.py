"""Turbulence against the analytic Dryden spectra of MIL-F-8785C."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.signal import welch
from sim_support import run

SPAN_M = 1.9
FOOT = 0.3048
KNOT = 1852.0 / 3600.0


def gusts(probe: Path, w20: float, airspeed: float, height: float, step: float, count: int, seed: int) -> np.ndarray:
    """Series (count, 6): u, v, w in m/s, p, q, r in rad/s."""
    text = run(probe, "turbulence", w20, airspeed, height, step, count, seed).stdout
    return np.fromstring(text, sep=" ").reshape(count, 6)


def figures(w20: float, height: float) -> tuple[float, float, float, float]:
    """sigma_u, sigma_w in m/s; L_u, L_w in m."""
    feet = min(max(height / FOOT, 10.0), 1000.0)
    base = 0.177 + 0.000823 * feet
    return 0.1 * w20 / base**0.4, 0.1 * w20, feet * FOOT / base**1.2, feet * FOOT


def spectra(omega: np.ndarray, w20: float, airspeed: float, height: float) -> list[np.ndarray]:
    """One-sided, over angular frequency, of u, v, w, p, q, r."""
    su, sw, lu, lw = figures(w20, height)

    def first(sigma: float, scale: float) -> np.ndarray:
        return sigma**2 * 2 * scale / (np.pi * airspeed) / (1 + (scale * omega / airspeed) ** 2)

    def second(sigma: float, scale: float) -> np.ndarray:
        x = (scale * omega / airspeed) ** 2
        return sigma**2 * scale / (np.pi * airspeed) * (1 + 3 * x) / (1 + x) ** 2

    v, w = second(su, lu), second(sw, lw)
    four, three = 4 * SPAN_M / (np.pi * airspeed), 3 * SPAN_M / (np.pi * airspeed)
    p = sw**2 / (airspeed * lw) * 0.8 * (np.pi * lw / (4 * SPAN_M)) ** (1 / 3) / (1 + (four * omega) ** 2)
    q = (omega / airspeed) ** 2 / (1 + (four * omega) ** 2) * w
    r = (omega / airspeed) ** 2 / (1 + (three * omega) ** 2) * v
    return [first(su, lu), v, w, p, q, r]


@pytest.mark.parametrize(
    ("w20", "airspeed", "height"), [(15 * KNOT, 17.0, 15.0), (30 * KNOT, 17.0, 44.5), (30 * KNOT, 25.0, 150.0)]
)
def test_spectra(sim_probe: Path, w20: float, airspeed: float, height: float) -> None:
    """Welch estimate over 4000 s in six bands of under half a decade. A band averages so many bins that 12 % is
    three sigma. Bands end at a tenth of the sampling frequency, where sampled and continuous spectrum agree to 3 %."""
    step, count = 0.01, 400_000
    series = gusts(sim_probe, w20, airspeed, height, step, count, 11)
    frequency, density = welch(series, fs=1 / step, nperseg=16384, axis=0, detrend=False)
    omega = 2 * np.pi * frequency
    edges = np.geomspace(0.15, 0.1 * 2 * np.pi / step, 7)
    for axis, analytic in enumerate(spectra(omega, w20, airspeed, height)):
        for low, high in zip(edges[:-1], edges[1:]):
            band = (omega >= low) & (omega < high)
            ratio = np.mean(density[band, axis] / (2 * np.pi) / analytic[band])
            tolerance = 0.35 if low < 0.5 else 0.12
            assert ratio == pytest.approx(1.0, abs=tolerance), f"axis {axis}, {low:.2f} to {high:.2f} rad/s"


def test_starts_in_its_stationary_state(sim_probe: Path) -> None:
    """The standard deviation over 300 seeds is right at the first step and a second later: no transient."""
    su, sw, *_ = figures(15 * KNOT, 15.0)
    first = np.array([gusts(sim_probe, 15 * KNOT, 17.0, 15.0, 0.01, 101, seed) for seed in range(1, 301)])
    for k in (0, 100):
        spread = np.sqrt(np.mean(first[:, k, :3] ** 2, axis=0))
        assert spread == pytest.approx([su, su, sw], rel=0.15)
        assert np.abs(first[:, k, :3].mean(axis=0)) == pytest.approx([0, 0, 0], abs=0.25 * su)


@pytest.mark.parametrize("height", [3.5, 15.0, 90.0, 300.0])
def test_gusts_do_not_depend_on_the_step(sim_probe: Path, height: float) -> None:
    """Variance and correlation are exact at any step, also at one at which a crude discretization would fail."""
    su, sw, lu, lw = figures(15 * KNOT, height)
    for scale, columns in ((lu, [0, 1]), (lw, [2])):
        series = gusts(sim_probe, 15 * KNOT, 17.0, height, scale / 17.0, 100_000, 3)  # one time constant
        assert series[:, :3].std(axis=0) == pytest.approx([su, su, sw], rel=0.02)
        for column in columns:
            x = series[:, column]
            # at a lag of one time constant: exp(-1); of the second-order form, (1 - 1/2) exp(-1)
            expected = np.exp(-1.0) * (1.0 if column == 0 else 0.5)
            assert np.mean(x[1:] * x[:-1]) / np.mean(x**2) == pytest.approx(expected, abs=0.012)


def test_still_air_is_still(sim_probe: Path) -> None:
    assert not gusts(sim_probe, 0.0, 17.0, 15.0, 0.01, 100, 1).any()


def test_heights_outside_the_model_take_its_limits(sim_probe: Path) -> None:
    low, lowest = (gusts(sim_probe, 7.0, 17.0, h, 0.01, 50, 1) for h in (-2.0, 10 * FOOT))
    high, highest = (gusts(sim_probe, 7.0, 17.0, h, 0.01, 50, 1) for h in (2000.0, 1000 * FOOT))
    assert np.array_equal(low, lowest) and np.array_equal(high, highest) and not np.array_equal(low, high)


def test_streams_are_uniform_normal_and_apart(sim_probe: Path) -> None:
    """SplitMix64's bits; streams of one seed have nothing in common; moments of both distributions."""
    rows = {
        s: np.array([line.split() for line in run(sim_probe, "random", 42, s, 50_000).stdout.splitlines()])
        for s in (1, 2)
    }
    bits, uniform, normal = rows[1][:, 0], rows[1][:, 1].astype(float), rows[1][:, 2].astype(float)
    assert not set(bits) & set(rows[2][:, 0]) and len(set(bits)) == len(bits)
    assert abs(np.corrcoef(uniform, rows[2][:, 1].astype(float))[0, 1]) < 0.02
    assert uniform.mean() == pytest.approx(0.5, abs=0.005) and uniform.var() == pytest.approx(1 / 12, rel=0.02)
    assert uniform.min() >= 0.0 and uniform.max() < 1.0
    assert normal.mean() == pytest.approx(0.0, abs=0.02) and normal.std() == pytest.approx(1.0, rel=0.01)
    assert (normal**4).mean() == pytest.approx(3.0, rel=0.05)

    def mix(z: int) -> int:
        mask = 2**64 - 1
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9 & mask
        z = (z ^ (z >> 27)) * 0x94D049BB133111EB & mask
        return z ^ (z >> 31)

    gamma, mask = 0x9E3779B97F4A7C15, 2**64 - 1
    counter = mix((mix((42 + gamma) & mask) + 1 * gamma) & mask)
    expected = [mix((counter + (i + 1) * gamma) & mask) for i in range(100)]
    assert [int(b) for b in bits[:100]] == expected

"""The library's arctangent, sine and cosine in float32, on which its bits depend."""

from __future__ import annotations

import numpy as np

F = np.float32
ZERO, HALF, ONE = F(0.0), F(0.5), F(1.0)
TAN_PI_8 = F(0.414213562)
ATAN = (F(0.333327567), F(0.199718793), F(0.138244538), F(0.0790259837))
SIN = (F(0.166666507), F(0.00833197866), F(0.000194956362))
COS = (F(0.0416666469), F(0.00138873675), F(2.44384516e-05))
QUARTER_PI_RAD, HALF_PI_RAD = F(0.785398163), F(1.57079633)
RAD_PER_DEG = F(0.0174532925)
NINETY = F(90.0)
PER_NINETY = ONE / NINETY


def arctan_of_fraction(t: np.float32) -> np.float32:
    z = t * t
    return t - t * (z * (ATAN[0] - z * (ATAN[1] - z * (ATAN[2] - z * ATAN[3]))))


def arctan_of_unit(t: np.float32) -> np.float32:
    if t <= TAN_PI_8:
        return arctan_of_fraction(t)
    return QUARTER_PI_RAD + arctan_of_fraction((t - ONE) / (t + ONE))


def arctan_rad(y: np.float32, x: np.float32) -> np.float32:
    size = np.abs(y)
    angle = arctan_of_unit(size / x) if size <= x else HALF_PI_RAD - arctan_of_unit(x / size)
    return -angle if y < ZERO else angle


def sincos_deg(deg: np.float32) -> tuple[np.float32, np.float32]:
    quarter = int(deg * PER_NINETY + (-HALF if deg < ZERO else HALF))
    t = (deg - F(quarter) * NINETY) * RAD_PER_DEG
    z = t * t
    s = t - t * (z * (SIN[0] - z * (SIN[1] - z * SIN[2])))
    c = ONE - HALF * z + z * z * (COS[0] - z * (COS[1] - z * COS[2]))
    return ((s, c), (c, -s), (-s, -c), (-c, s))[quarter & 3]

"""One track, linearized: measurements, unknowns, and the effect of each setting's errors.

With n rows r (measured minus predicted, focal lengths), X their derivatives by the unknowns (n, p), and s_i the sigmas
given by the settings,

    r = X b + errors        covariance of the errors = sum over i of s_i^2 B_i

b is arbitrary. B of errors that are correlated over time contains exp(-|t - t'|/tau), with a time constant that is also
a setting."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

MOST_IMAGES = 40  # of a piece; a longer track is split into pieces with separate unknowns


@dataclass(frozen=True)
class Effect:
    """Errors of a setting, for a sigma of 1. ``by``: (n, m) effect of m independent errors; ``weight``: (n, n)
    correlation between each two rows, None: the same errors in all rows."""

    by: np.ndarray
    weight: np.ndarray | None = None

    def matrix(self) -> np.ndarray:
        """(n, n): covariance of the rows."""
        result = self.by @ self.by.T
        return result if self.weight is None else result * self.weight

    def only(self, kept: np.ndarray) -> Effect:
        return Effect(self.by[kept], None if self.weight is None else self.weight[np.ix_(kept, kept)])


@dataclass(frozen=True)
class Fading:
    """Errors with the sigma ``size`` (n,) for a setting of 1, in rows of one ``series`` (n,), correlated over the time
    in ``time_setting``."""

    time_setting: str
    size: np.ndarray
    series: np.ndarray

    def matrices(self, time_s: np.ndarray, value: float) -> tuple[np.ndarray, np.ndarray]:
        """Covariance (n, n), and its derivative by the setting."""
        outer = np.where(self.series[:, None] == self.series, self.size[:, None] * self.size, 0.0)
        apart = np.abs(np.subtract.outer(time_s, time_s))
        if value <= 0.0:
            return outer * (apart == 0.0), np.zeros_like(outer)
        kept = outer * np.exp(-apart / value)
        return kept, kept * apart / value**2

    def only(self, kept: np.ndarray) -> Fading:
        return Fading(self.time_setting, self.size[kept], self.series[kept])


@dataclass
class Rows:
    """The rows of one track, or of a piece of a long one."""

    name: str
    time_s: np.ndarray  # (n,)
    image: np.ndarray  # (n,) number of the image
    residual: np.ndarray  # (n,)
    unknown: np.ndarray  # (n, p)
    effects: dict[str, Effect]  # by setting
    fading: dict[str, Fading]  # by setting

    def covariance(self, values: dict[str, float]) -> np.ndarray:
        """Covariance of the rows, (n, n)."""
        result = np.zeros((len(self.residual),) * 2)
        for name, effect in self.effects.items():
            if values[name] > 0.0:
                result += values[name] ** 2 * effect.matrix()
        for name, fading in self.fading.items():
            result += values[name] ** 2 * self._faded(fading, values)[0]
        return result

    def _faded(self, fading: Fading, values: dict[str, float]) -> tuple[np.ndarray, np.ndarray]:
        return fading.matrices(self.time_s, values[fading.time_setting])

    def slope(self, values: dict[str, float], name: str) -> np.ndarray:
        """(n, n): derivative of the covariance by the logarithm of a setting."""
        result = np.zeros((len(self.residual),) * 2)
        if name in self.effects:
            result += 2.0 * values[name] ** 2 * self.effects[name].matrix()
        for share, fading in self.fading.items():
            if name == share:
                result += 2.0 * values[share] ** 2 * self._faded(fading, values)[0]
            elif name == fading.time_setting:
                result += values[share] ** 2 * values[name] * self._faded(fading, values)[1]
        return result

    def slope_after(self, p: np.ndarray, values: dict[str, float], name: str) -> np.ndarray:
        """(n, n): ``p`` times ``slope``; cheap if few errors affect all rows."""
        effect = self.effects.get(name)
        if effect is None or effect.weight is not None:
            return p @ self.slope(values, name)
        return 2.0 * values[name] ** 2 * (p @ effect.by) @ effect.by.T

    def settings(self) -> set[str]:
        return {*self.effects, *self.fading, *(fading.time_setting for fading in self.fading.values())}

    def only(self, kept: np.ndarray) -> Rows:
        """The rows with a flag in ``kept`` (n,)."""
        return Rows(
            self.name, self.time_s[kept], self.image[kept], self.residual[kept], self.unknown[kept],
            {name: effect.only(kept) for name, effect in self.effects.items()},
            {name: fading.only(kept) for name, fading in self.fading.items()},
        )  # fmt: skip

    def pieces(self) -> list[Rows]:
        """Pieces of at most ``MOST_IMAGES`` images."""
        images = np.unique(self.image)
        parts = np.array_split(images, -(-len(images) // MOST_IMAGES)) if len(images) else []
        return [self.only(np.isin(self.image, part)) for part in parts]

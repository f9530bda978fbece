"""By how much residuals exceed the configured noise over a track, and how correlated they are, as in the library."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

SCATTER_KEPT, CORRELATION_MOST = (float(np.float32(share)) for share in (0.985, 0.9))  # as in the library
SCATTER_CLIP, SCATTER_SEED = 10.0, 10.0
MEAN_SEEDS, MEAN_IMAGES, RATIO_MOST = 8, 64, 20.0
CHANCE = float(np.float32(0.07))  # one sigma of both means: only an excess widens the sigmas


def _beyond_chance(excess: float) -> float:
    return excess - CHANCE**2 / excess if excess > CHANCE else 0.0


@dataclass
class Scatter:
    """Size of the normalized residuals compared with the configured noise, and their correlation with the image
    before."""

    before: np.ndarray  # (4,) by side, sigmas; 0: none
    products: float = 0.0
    squares: float = 0.0
    recent: float = 0.0  # mean of nis over rows, over the latest images
    whole: float = 0.0  # mean of its excess over 1, over the whole track
    images: int = 0

    def take(self, side: np.ndarray, residual: np.ndarray) -> None:
        now = np.zeros(4)
        now[side] = np.clip(residual, -SCATTER_CLIP, SCATTER_CLIP)
        both = (now != 0) & (self.before != 0)
        self.products = SCATTER_KEPT * self.products + float(now[both] @ self.before[both])
        self.squares = SCATTER_KEPT * self.squares + float(now[both] @ now[both])
        self.before = now

    def take_fit(self, ratio: float) -> None:
        self.images += 1
        heard = self.images + MEAN_SEEDS
        self.recent += (min(ratio, RATIO_MOST) - self.recent) / min(heard, MEAN_IMAGES)
        self.whole += (min(ratio - 1, RATIO_MOST) - self.whole) / heard

    def factor(self) -> float:
        correlation = min(_beyond_chance(self.products / (self.squares + SCATTER_SEED)), CORRELATION_MOST)
        excess = max(self.recent - 1, self.whole)
        scale = 1 + (_beyond_chance(excess) if excess > 0 else excess)
        return max(scale * (1 + correlation) / (1 - correlation), 1.0)

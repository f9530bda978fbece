"""An estimator's answer for one image, and goe_replay's output file.

Column names and order are those of goe_replay's output.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from .fields import Row, read_integer, read_number, read_rows

QUANTITIES = (
    "x0_m",
    "z0_m",
    "x_m",
    "z_m",
    "width_m",
    "length_m",
    "height_m",
    "orientation_deg",
    "center_n_m",
    "center_e_m",
)
LABELS = ("t_s", "id", "status", "model", "images_used")


def sigma_name(quantity: str) -> str:
    """x0_m -> x0_sd_m."""
    stem, unit = quantity.rsplit("_", 1)
    return f"{stem}_sd_{unit}"


SIGMAS = tuple(sigma_name(quantity) for quantity in QUANTITIES)
NUMBERS = tuple(name for quantity in QUANTITIES for name in (quantity, sigma_name(quantity)))


@dataclass
class Estimate:
    """One row of output. ``values`` contains only the observable quantities and their sigmas, by column name."""

    status: str
    model: str = "none"
    images_used: int = 0
    values: dict[str, float] = field(default_factory=dict)
    suspect: bool = False
    reason: str = "none"  # why it is suspect; "late" also without suspicion


def _estimate(row: Row, path: Path, line: int) -> tuple[float, int, Estimate]:
    values = {name: read_number(row[name], path, line, name) for name in NUMBERS if row[name]}
    estimate = Estimate(
        row["status"],
        row["model"],
        read_integer(row["images_used"], path, line, "images_used"),
        values,
        suspect=row.get("suspect") == "1",  # output before 0.3 has neither column
        reason=row.get("reason") or "none",
    )
    return read_number(row["t_s"], path, line, "t_s"), read_integer(row["id"], path, line, "id"), estimate


def read_estimates(path: Path) -> list[tuple[float, int, Estimate]]:
    """Reads goe_replay's output: (t_s, id, estimate) per row."""
    path, columns = Path(path), (*LABELS, *NUMBERS)
    return [_estimate(row, path, line) for line, row in read_rows(path, columns, columns)]

"""What an estimator says of one image, and the file that goe_replay writes of it.

Column names and order are those of goe_replay's output.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass, field
from pathlib import Path

from .obslog import LogError

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
LABELS = ("t_s", "id", "status", "model", "n_used")


def sigma_name(quantity: str) -> str:
    """x0_m -> x0_sd_m."""
    stem, unit = quantity.rsplit("_", 1)
    return f"{stem}_sd_{unit}"


SIGMAS = tuple(sigma_name(quantity) for quantity in QUANTITIES)
NUMBERS = tuple(name for quantity in QUANTITIES for name in (quantity, sigma_name(quantity)))


@dataclass
class Estimate:
    """One row of output. ``values`` holds the observable quantities and their sigmas only, by column name."""

    status: str
    model: str = "none"
    n_used: int = 0
    values: dict[str, float] = field(default_factory=dict)
    suspect: bool = False
    reason: str = "none"  # why it is suspect; "late" also of one that is not


def read_estimates(path: Path) -> list[tuple[float, int, Estimate]]:
    """Reads goe_replay's output: (t_s, id, estimate) per row."""
    path = Path(path)
    try:
        with open(path, encoding="utf-8", newline="") as file:
            reader = csv.DictReader(file, strict=True)
            missing = [name for name in (*LABELS, *NUMBERS) if name not in (reader.fieldnames or ())]
            if missing:
                raise LogError(path, 1, missing[0], "column is missing")
            result = []
            for row in reader:
                if None in row or None in row.values():
                    raise LogError(path, reader.line_num, "", "number of fields differs from the header's")
                name = ""
                try:
                    values = {}
                    for name in NUMBERS:
                        if row[name]:
                            values[name] = float(row[name])
                    name = "n_used"
                    estimate = Estimate(
                        row["status"],
                        row["model"],
                        int(row["n_used"]),
                        values,
                        suspect=row.get("suspect") == "1",  # logs of before 0.3 have neither column
                        reason=row.get("reason") or "none",
                    )
                    name = "t_s"
                    result.append((float(row["t_s"]), int(row["id"]), estimate))
                except ValueError:
                    raise LogError(path, reader.line_num, name, f"'{row[name]}' is not a number") from None
            return result
    except OSError as error:
        raise LogError(path, 0, "", error.strerror or str(error)) from None

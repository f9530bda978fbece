"""The figures of all pages, in their order: the paper's 5 to 14 with this campaign's numbers, and others.

A figure is drawn twice: wide (panels side by side) and narrow (panels one below the other, for phones). A new one is a
function that draws, one that describes, and an entry in ``FIGURES``.
"""

from __future__ import annotations

from ..style import QUANTITY_NAMES
from .avoid import AVOID_FIGURE
from .conditioning import (
    describe_condition_scatter,
    describe_conditioning,
    draw_condition_scatter,
    draw_conditioning,
)
from .drawing import FigureSpec
from .orientation import describe_orientation, draw_orientation
from .refined import REFINED_FIGURES
from .sorted_errors import describe_sorted_errors, draw_sorted_errors
from .studies import describe_studies, draw_studies

_ERRORS = (
    (6, "z0", "disc"), (7, "x0", "disc"), (8, "width", "disc"), (9, "z0", "line"), (10, "x0", "line"),
    (11, "width", "line"), (12, "length", "line"), (13, "height", "disc"), (14, "height", "line"),
)  # fmt: skip


def _error_figure(number_in_paper: int, quantity: str, model: str) -> FigureSpec:
    name = QUANTITY_NAMES[quantity]
    return FigureSpec(
        f"fig{number_in_paper:02d}_{quantity}_{model}",
        f"Figure {number_in_paper}. {name[0].upper() + name[1:]}, {model} model",
        "figures",
        draw_sorted_errors(quantity, model),
        describe_sorted_errors(quantity, model),
    )


FIGURES: tuple[FigureSpec, ...] = (
    *REFINED_FIGURES,
    AVOID_FIGURE,
    FigureSpec("fig05_orientation", "Figure 5. Orientation of a building", "figures", draw_orientation,
               describe_orientation),
    *(_error_figure(*entry) for entry in _ERRORS),
    FigureSpec("studies", "Errors by study", "studies", draw_studies, describe_studies),
    FigureSpec("conditioning", "Condition number and error by setting", "conditioning", draw_conditioning,
               describe_conditioning),
    FigureSpec("condition_scatter", "Error against condition number", "conditioning", draw_condition_scatter,
               describe_condition_scatter, in_page="png"),
)  # fmt: skip

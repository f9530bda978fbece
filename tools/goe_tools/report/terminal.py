"""Table 3 as plain text."""

from __future__ import annotations

from collections import Counter

from rich import box
from rich.console import Console
from rich.table import Table

from . import paper_table3 as t3
from . import refined as rf
from . import statistics as st
from .data import Campaign
from .style import NAMES, number

HEADINGS = ("Z0 %", "X0 %", "W %", "L %", "H m")
MARKS = {st.BETTER: "+", st.REPRODUCED: "=", st.MEANS_ONLY: "~", st.WORSE: "!", st.NOT_IN_PAPER: " "}
MIN_WIDTH = 78
SHORT = {"switching": "auto"}  # keeps the table within its width


def print_table3(campaign: Campaign, console: Console | None = None) -> None:
    console = console or Console(highlight=False)
    if console.width < MIN_WIDTH:
        console.width = MIN_WIDTH
    rows = st.table3(campaign.cases)
    table = Table(box=box.SIMPLE_HEAD, pad_edge=False, show_edge=False, collapse_padding=True)
    table.add_column("object/model")
    for heading in HEADINGS:
        table.add_column(heading, justify="right", no_wrap=True)
    refined = {(obstacle, model): cells for obstacle, model, cells in rf.table3(campaign)}
    for obstacle, model, cells in rows:
        table.add_row(f"{NAMES[obstacle]}/{SHORT.get(model, model)}", *(_cell_text(cell) for cell in cells))
        if (obstacle, model) in refined:
            table.add_row("  filter", *(_refined_text(cell) for cell in refined[obstacle, model]), style="bold")
    title = "Table 3, range of most errors: paper / window method"
    console.print(f"{title}; filter ×times narrower" if refined else title, style="bold")
    console.print(table)
    _print_verdicts(console, rows)
    if refined:
        _print_refined(console, rf.papers(campaign))


def _print_verdicts(console: Console, rows: list[tuple[str, str, list[st.Cell | None]]]) -> None:
    count = Counter(cell.verdict for _, _, cells in rows for cell in cells if cell is not None and cell.paper)
    console.print(
        f"+ half the paper's range or less ({count[st.BETTER]})   = reproduced ({count[st.REPRODUCED]})   "
        f"~ means only ({count[st.MEANS_ONLY]})\n"
        f"! not reproduced ({count[st.WORSE]})   >: most values lie outside\n"
        f"window method: mean ± 2 sigma of {t3.MOST:.0%} of the cases, last {t3.FRACTION:.0%} of the\n"
        "solved images; simulation"
    )


def _print_refined(console: Console, cells: list[rf.Trio]) -> None:
    fivefold, better = (sum(cell.factor >= least for cell in cells) for least in (rf.FIVEFOLD, 1.0))
    console.print(
        f"filter, the default method: better than the paper in {better} of {len(cells)} numbers,\n"
        f"at least {rf.FIVEFOLD:g} times in {fivefold} (× how many times narrower than the paper's range)"
    )


def _refined_text(cell: rf.Trio | None) -> str:
    if cell is None:
        return "-"
    return f"{number(cell.refined)} ×{number(cell.factor)}"


def _cell_text(cell: st.Cell | None) -> str:
    if cell is None:
        return "-"
    return f"{cell.paper if cell.paper else '-'} / {number(cell.bars)} {MARKS[cell.verdict]}"

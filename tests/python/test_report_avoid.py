"""The report's section on the flight layer's orders: reader of goe_avoid's runs, sentence, table, figure, page."""

from __future__ import annotations

import re
from html import unescape
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from goe_tools.__main__ import main
from goe_tools.logs.obslog import LogError
from goe_tools.report import avoid as av
from goe_tools.report import page
from goe_tools.report.avoid_file import Avoid, read_avoid
from goe_tools.report.data import Campaign, read_campaign
from goe_tools.report.figures.avoid import describe_avoid, draw_avoid
from synthetic_campaign import avoid_rows, write_avoid, write_campaign

NBSP = "\u00a0"


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory) -> Campaign:
    folder = tmp_path_factory.mktemp("campaign")
    return read_campaign(write_campaign(folder / "c", studies=False), avoid=write_avoid(folder / "avoid.csv"))


def runs_of(folder: Path, rows: list[dict[str, Any]]) -> Avoid:
    return read_avoid(write_avoid(folder / "avoid.csv", rows))


def kept(course: str, *kinds: str) -> list[dict[str, Any]]:
    return [row for row in avoid_rows() if row["course"] == course and row["kind"] in kinds]


# ---------------------------------------------------------------------------------------------------------- the reader


def test_written_runs_are_read(tmp_path: Path) -> None:
    avoid = runs_of(tmp_path, avoid_rows())
    assert len(avoid) == 120
    assert (len(avoid.flown("collision")), len(avoid.flown("pass", "truck"))) == (60, 20)
    assert np.isnan(avoid.flown("pass")["closest_with_m"]).all()
    assert np.sum(avoid.flown("pass").ordered) == 1


@pytest.mark.parametrize(
    ("line", "column", "field", "message"),
    [
        (1, "collided_with", "colided_with", "collided_with: this column is missing"),
        (2, "kind", "tree", "kind: 'tree' is not mast, building or truck"),
        (3, "course", "", "course: '' is not collision or pass"),
        (4, "action", "up", "action: 'up' is not none, left, right, climb, go_around or hold"),
        (5, "ahead_s", "12;3", "ahead_s: '12;3' is not a number"),
        (6, "closest_without_m", "", "closest_without_m: empty"),
        (7, "closest_with_m", "-1", "closest_with_m: -1 is not a number from 0 on"),
        (8, "closest_with_m", "inf", "closest_with_m: inf is not a number from 0 on"),
        (9, "collided_with", "2", "collided_with: 2 is not 0 or 1"),
        (10, "collided_with", "", "collided_with: empty"),
        (70, "collided_with", "0", "collided_with: 0, but only a collision course has one"),
        (11, "false_order", "0", "false_order: 0, but only a pass has one"),
        (71, "pass_m", "", "pass_m: empty"),
        (72, "pass_m", "20", "pass_m: 20, but 30 in line 62"),
        (12, "margin_m", "10", "margin_m: 10, but 15 in line 2"),
        (13, "ahead_s", "", "ahead_s: empty, but there was an order"),
        (73, "ahead_s", "3", "ahead_s: 3, but there was no order"),
        (74, "late", "1", "late: 1, but there was no order"),
        (75, "false_order", "1", "false_order: 1, but the action contradicts it"),
        (14, "suspect", "91", "suspect: 91, more than were assessed"),
        (15, "seed", "13", "seed: 13 was flown before"),
    ],
)
def test_a_bad_field_is_named(tmp_path: Path, line: int, column: str, field: str, message: str) -> None:
    file = write_avoid(tmp_path / "avoid.csv")
    lines = [text.split(",") for text in file.read_text(encoding="utf-8").splitlines()]
    lines[line - 1][lines[0].index(column)] = field
    file.write_text("\n".join(map(",".join, lines)) + "\n", encoding="utf-8")
    with pytest.raises(LogError) as caught:
        read_avoid(file)
    assert str(caught.value) == f"{file}:{line}: {message}"


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", ": no rows"),
        (b"kind,course\nmast\n", ":2: 1 fields, the header has 2"),
        (b"\xff\n", ":1: not UTF-8 text: "),
    ],
)
def test_a_file_that_is_none_of_it_is_named(
    tmp_path: Path, content: bytes, message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "avoid.csv"
    with pytest.raises(LogError, match="No such file"):
        read_avoid(file)
    file.write_bytes(content)
    folder, out = write_campaign(tmp_path / "c", studies=False), tmp_path / "page.html"
    assert main(["report", str(folder), "--avoid", str(file), "--out", str(out)]) == 2
    assert f"{file}{message}" in capsys.readouterr().err and not out.exists()


# -------------------------------------------------------------------------------------------------------- the sentence


def test_the_sentence_follows_from_the_runs(tmp_path: Path) -> None:
    rows = avoid_rows()
    assert av.sentence(runs_of(tmp_path, rows)) == (
        "Without goe, 57 of 60 collision courses end in a collision; with goe's orders followed, 1 does "
        f"(truck 1; 1 after a late order); 1 of 60 passes at 30{NBSP}m (1.7{NBSP}%) gets a false order."
    )
    least = min(row["closest_with_m"] for row in kept("collision", "mast", "building"))
    rows = kept("collision", "mast", "building") + kept("pass", "mast")
    assert av.sentence(runs_of(tmp_path, rows)) == (
        "Without goe, 38 of 40 collision courses end in a collision; with goe's orders followed, none does, "
        f"and the closest aircraft stays {least:.1f}{NBSP}m away; none of 20 passes at 30{NBSP}m gets a false order."
    )


def test_the_sentence_of_half_of_the_runs(tmp_path: Path) -> None:
    assert av.sentence(runs_of(tmp_path, kept("pass", "mast"))).startswith("None of 20 passes")
    (course,) = [row for row in kept("collision", "mast") if row["seed"] == 2]
    course |= {"collided_with": 1, "closest_with_m": 0.5}
    assert av.sentence(runs_of(tmp_path, [course])) == (
        "Without goe, 1 of 1 collision course ends in a collision; with goe's orders followed, 1 does (mast 1)."
    )


# ----------------------------------------------------------------------------------------------------------- the table


def test_the_table_follows_from_the_runs(campaign: Campaign) -> None:
    assert campaign.avoid is not None
    rows = {str(row["title"]): row["cells"] for row in av.table(campaign.avoid)}
    assert list(rows) == ["Mast", "Building", "Truck, on approach"]
    closest = sorted(row["closest_with_m"] for row in kept("collision", "mast"))
    ahead = sorted(row["ahead_s"] for row in kept("collision", "mast"))
    cells = [cell["text"] for cell in rows["Mast"]]  # type: ignore[attr-defined]
    assert cells == [
        "20", "19", "0", f"{closest[0]:.1f} / {closest[1]:.1f} / {closest[10]:.1f}",
        f"{ahead[0]:.1f} / {ahead[10]:.1f}", "0", "0", "20", f"0 (0.0{NBSP}%)",
    ]  # fmt: skip
    assert rows["Building"][-1]["text"] == f"1 (5.0{NBSP}%)"  # type: ignore[index]
    red = [i for i, cell in enumerate(rows["Truck, on approach"]) if cell["css"]]  # type: ignore[arg-type]
    assert [av.heads(campaign.avoid)[i] for i in red] == ["collisions with", "late orders"]


def test_runs_without_an_order_are_counted_and_have_no_time(tmp_path: Path) -> None:
    rows = [row | {"action": "none", "ahead_s": None} for row in kept("collision", "mast")] + kept("pass", "truck")
    mast, truck = av.table(runs_of(tmp_path, rows))
    assert [cell["text"] for cell in mast["cells"]][4:] == ["– / –", "0", "20", "", ""]  # type: ignore[attr-defined]
    assert [cell["text"] for cell in truck["cells"]][:8] == [*[""] * 7, "20"]  # type: ignore[attr-defined]


# --------------------------------------------------------------------------------------------------- figure and page


def test_the_figure_shows_both_distributions_of_every_kind(campaign: Campaign) -> None:
    assert campaign.avoid is not None
    for narrow in (False, True):
        figure = draw_avoid(campaign, narrow)
        assert figure is not None
        panels = figure.axes
        assert [one.get_title() for one in panels] == ["Mast", "Building", "Truck, on approach"]
        for one, row in zip(panels, av.courses(campaign.avoid)):
            without, with_orders = one.lines[-2:]
            for line, ascending in ((without, row.closest_without_m), (with_orders, row.closest_with_m)):
                x, y = np.asarray(line.get_xdata()), np.asarray(line.get_ydata())
                assert x[1:-1].tolist() == ascending.tolist()
                assert y[-1] == y[-2] == 100.0 and y[10] == pytest.approx(50.0)
    caption, alt = describe_avoid(campaign)
    assert len(caption) > 40 and av.sentence(campaign.avoid) in alt


def test_the_axis_is_not_stretched_by_a_run_that_passes_far_off(tmp_path: Path, campaign: Campaign) -> None:
    rows = avoid_rows()
    rows[3]["closest_with_m"] = 400.0
    far = read_campaign(campaign.folder, avoid=write_avoid(tmp_path / "avoid.csv", rows))
    figure = draw_avoid(far, False)
    assert figure is not None
    assert figure.axes[0].get_xlim()[1] < 60.0
    assert "1 of 20 pass farther away" in [text.get_text() for text in figure.axes[0].texts]


def test_the_page_has_the_section_where_runs_are_given(campaign: Campaign) -> None:
    assert campaign.avoid is not None
    text = page.render_pages(campaign, [])[page.ANSWERS]
    assert '<a href="#avoid">' in text
    section = unescape(text.split('<section id="avoid">')[1].split("</section>")[0])
    assert av.sentence(campaign.avoid) in section
    assert "100 ms late" in section and "passes at 30 m" in section and "margin is 15 m" in section
    assert section.count('<th scope="row">') == 3
    assert re.search(r'class="n miss" data-label="collisions with">1<', section)
    without = "".join(page.render_pages(read_campaign(campaign.folder), []).values())
    assert 'id="avoid"' not in without and "#avoid" not in without


def test_the_page_of_passes_alone_and_of_courses_alone(campaign: Campaign, tmp_path: Path) -> None:
    for course, other in (("pass", "late orders"), ("collision", "false orders")):
        file = write_avoid(tmp_path / "avoid.csv", kept(course, "mast"))
        alone = read_campaign(campaign.folder, avoid=file)
        section = page.render_pages(alone, [])[page.ANSWERS].split('<section id="avoid">')[1].split("</section>")[0]
        assert section.count('<th scope="row">') == 1 and other not in section
        assert (draw_avoid(alone, False) is None) == (course == "pass")

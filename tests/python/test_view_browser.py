"""The page of goe_tools view in headless Chromium: at any moment text and drawing show the answers of goe_replay;
mouse, keys, light and dark scheme, a phone."""

from __future__ import annotations

import csv
import math
import os
import re
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import chromium
import numpy as np
import pytest
import view_logs
from chromium import HANG_S, hold_time, open_page, screenshot, set_size, step_time
from goe_tools import library
from goe_tools.__main__ import main
from goe_tools.logs.obslog import ObservationLog, read_log, write_truth
from goe_tools.view.answers import Options
from goe_tools.view.story import story_of

WIDE, PHONE = (1280, 900), (400, 844)  # px

selenium = pytest.importorskip("selenium", reason="the browser test needs selenium (pip)")
pytestmark = pytest.mark.skipif(chromium.MISSING, reason=chromium.WHY_MISSING)

Row = dict[str, str]


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    driver = chromium.start(tmp_path_factory.mktemp("profile"))
    hold_time(driver)
    yield driver
    driver.quit()


@pytest.fixture(scope="module")
def make_page(tmp_path_factory: pytest.TempPathFactory) -> Callable[..., Path]:
    """Writes the page of a log, once for each name; the log is in the same folder."""
    try:
        library.ready()
    except FileNotFoundError as error:
        pytest.skip(str(error))
    pages: dict[str, Path] = {}

    def make(name: str, log: Callable[[], ObservationLog], *words: str) -> Path:
        if name not in pages:
            folder = tmp_path_factory.mktemp(name)
            view_logs.written(log(), folder / "log")
            assert main(["view", str(folder / "log"), "--out", str(folder / "page.html"), *words]) in (0, 1)
            pages[name] = folder / "page.html"
        return pages[name]

    return make


def waited(browser: Any, script: str, *arguments: Any) -> Any:
    """The result of a script, once it is true."""
    from selenium.webdriver.support.ui import WebDriverWait

    return WebDriverWait(browser, HANG_S, poll_frequency=0.02).until(lambda b: b.execute_script(script, *arguments))


def opened(browser: Any, page: Path, size: tuple[int, int] = WIDE, dark: bool = False) -> None:
    """Opens a page, or reuses it as the previous test left it, because loading takes a second. Nothing may be
    fetched."""
    scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": [scheme]})
    if browser.current_url == page.as_uri():
        set_size(browser, size)
        return
    open_page(browser, page, size)
    assert waited(browser, "return document.documentElement.dataset.ready") == "yes"
    assert chromium.requested(browser) == [page.as_uri()]


def assert_quiet(browser: Any) -> None:
    assert browser.get_log("browser") == []
    assert chromium.requested(browser) == []


def assert_fits(browser: Any) -> None:
    overflow = browser.execute_script(
        "const w = document.documentElement.clientWidth; return [...document.body.querySelectorAll('*')]"
        ".filter(e => !e.closest('svg') && e.getClientRects().length && e.getBoundingClientRect().right > w + 1)"
        ".map(e => e.outerHTML.slice(0, 80))"
    )
    assert overflow == []
    assert browser.execute_script("return document.documentElement.scrollWidth <= document.documentElement.clientWidth")


def moved(browser: Any, moment: int) -> None:
    """Drags the slider."""
    browser.execute_script(
        "const e = document.getElementById('time'); e.value = arguments[0]; e.dispatchEvent(new Event('input'))", moment
    )
    waited(browser, "return document.documentElement.dataset.shown === arguments[0]", str(moment))


def shown(browser: Any) -> int:
    return int(browser.execute_script("return document.documentElement.dataset.shown"))


def said(browser: Any) -> dict[str, str]:
    """Text of sentence, clock and of each chart's head, by its key."""
    return browser.execute_script(
        "const texts = {}; for (const id of ['place', 'approach', 'state', 'clock', 'doubt', 'model'])"
        " texts[id] = document.getElementById(id).innerText;"
        " for (const c of document.querySelectorAll('.chart[data-key]'))"
        " texts[c.dataset.key] = c.querySelector('output').innerText;"
        " for (const k in texts) texts[k] = texts[k].replaceAll('\\u00a0', ' '); return texts"
    )


def replayed(page: Path, replay: Path, key: int) -> list[Row]:
    """goe_replay's own rows of one obstacle."""
    out = page.with_name("estimates.csv")
    done = subprocess.run([replay, "--residuals", "--out", out, page.with_name("log")], capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stderr
    with open(out, newline="", encoding="utf-8") as file:
        return [row for row in csv.DictReader(file) if int(row["id"]) == key]


def assert_says(text: str, value: str, sigma: str, where: str) -> None:
    """A text like "473 ± 12 m left" rounds a value and its sigma."""
    if not value:
        assert text == "–", where
        return
    number, band = (re.fullmatch(r"−?([\d.]+) ± ([\d.]+)[ °].*", text) or pytest.fail(f"{where}: {text}")).groups()
    for texts, true in ((number, abs(float(value))), (band, float(sigma))):
        half_digit = 0.5 * 10.0 ** -len(texts.partition(".")[2])
        assert abs(float(texts) - true) <= half_digit + 1e-6, f"{where}: {text}, goe_replay: {value}, {sigma}"


QUANTITIES = {
    "z_m": "z_sd_m", "x_m": "x_sd_m", "width_m": "width_sd_m", "height_m": "height_sd_m", "length_m": "length_sd_m",
    "orientation_deg": "orientation_sd_deg",
}  # fmt: skip


def assert_is_row(texts: dict[str, str], row: Row) -> None:
    where = f"{row['t_s']} s"
    assert texts["clock"] == f"{float(row['t_s']):.2f} s"
    for name, sigma in QUANTITIES.items():
        if name in texts:
            assert_says(texts[name], row[name], row[sigma], f"{where}: {name}")
    assert texts["nis_ratio"] == (f"{float(row['nis_ratio']):.2f}" if row["nis_ratio"] else "–"), where
    assert texts["model"] == ("–" if row["model"] == "none" else row["model"]), where
    assert texts["doubt"].startswith("Suspect") == (row["suspect"] == "1"), where
    if not row["z_m"]:
        assert texts["place"].startswith("No estimate yet"), where
        return
    assert texts["x_m"].endswith("left" if float(row["x_m"]) < 0.0 else "right")
    for part, name in (("ahead", "z_m"), ("left|right", "x_m"), ("wide", "width_m"), ("high", "height_m")):
        (found,) = re.findall(rf"[\d.]+ ± [\d.]+ m (?:{part})", texts["place"]) or [""]
        assert_says(found or "–", row[name], row[QUANTITIES[name]], f"{where}: {part}")


DRAWN_IN = (  # no plot is wider than the page, and its colors are the page's
    "return [...document.querySelectorAll('.main-svg')].every(s => s.getBoundingClientRect().right <= arguments[0])"
    " && document.querySelector('#map .xtick text').style.fill"
    " === getComputedStyle(document.querySelector('figcaption')).color"
)


def corner() -> ObservationLog:
    return read_log(view_logs.CORNER)


# -------------------------------------------------------------------------------------------------------------- moments


@pytest.mark.parametrize(
    ("name", "log"),
    [
        pytest.param("corner", corner, marks=pytest.mark.release), ("boxes", view_logs.boxes),
        pytest.param("moving", view_logs.moving, marks=pytest.mark.release),
    ],
)  # fmt: skip
def test_the_text_is_that_of_goe_replay(
    name: str, log: Callable[[], ObservationLog], make_page: Callable[..., Path], browser: Any, replay: Path
) -> None:
    page = make_page(name, log)
    rows = replayed(page, replay, 1)
    opened(browser, page)
    for moment in (0, 1, 7, len(rows) // 3, len(rows) // 2, len(rows) - 9, len(rows) - 1):
        moved(browser, moment)
        assert_is_row(said(browser), rows[moment])
    assert_quiet(browser)


def test_the_drawing_is_that_of_goe_replay(make_page: Callable[..., Path], browser: Any, replay: Path) -> None:
    """The charts contain the CSV's floats; the band is two sigma wide; the outline on the map has the reported
    width."""
    page = make_page("corner", corner)
    rows = replayed(page, replay, 1)
    opened(browser, page)
    for name, sigma in QUANTITIES.items():
        traces = browser.execute_script(
            "const p = document.querySelector(`[data-key=${arguments[0]}] .plot`);"
            "const finite = v => Number.isFinite(v) ? v : null;"
            "return p.data.map(t => ({name: t.name, fill: t.fill, y: Array.from(t.y, finite)}))", name,
        )  # fmt: skip
        estimate = next(trace["y"] for trace in traces if trace["name"] == "estimate")
        assert [np.float32(math.nan if v is None else v).tobytes() for v in estimate] == [
            np.float32(row[name] or math.nan).tobytes() for row in rows
        ], name
        band = next(trace["y"] for trace in traces if trace["fill"] == "toself" and trace["name"] != "estimate")
        tops = [float(row[name]) + 2.0 * float(row[sigma]) for row in rows if row[name]]
        assert max(v for v in band if v is not None) == pytest.approx(max(tops), rel=1e-5)
    last = len(rows) - 1
    moved(browser, last)
    x, y = browser.execute_script(
        "const t = document.getElementById('map').data.find(t => t.name === 'outline'); return [t.x, t.y]"
    )
    assert math.dist((x[0], y[0]), (x[1], y[1])) == pytest.approx(float(rows[last]["width_m"]), rel=1e-4)
    assert math.dist((x[1], y[1]), (x[2], y[2])) == pytest.approx(float(rows[last]["length_m"]), rel=1e-4)


def test_when_to_act_is_shown(make_page: Callable[..., Path], browser: Any) -> None:
    act = story_of("boxes", view_logs.boxes(), Options()).tracks[0].answers.act
    opened(browser, make_page("boxes", view_logs.boxes))
    for moment in (int(np.argmin(act)), int(np.argmax(act))):
        moved(browser, moment)
        warned = browser.execute_script(
            "return document.getElementById('approach').parentElement.classList.contains('too-close')"
        )
        assert warned == ("act now" in said(browser)["approach"]) == bool(act[moment]), moment
    assert 0 < act.sum() < len(act)
    assert_quiet(browser)


def test_the_maps_fill_their_card(make_page: Callable[..., Path], browser: Any) -> None:
    """Of a straight flight: both maps next to each other, nothing cut by the player, a key for every kind of line."""
    opened(browser, make_page("corner", corner))
    card, whole, close, caption, player = browser.execute_script(
        "return ['.map', '#map', '#close', '.map figcaption', '.player'].map(s => {"
        " const r = document.querySelector(s).getBoundingClientRect(); return [r.left, r.top, r.right, r.bottom]; })"
    )
    assert whole[2] <= close[0] and abs(whole[1] - close[1]) < 2 and abs(whole[3] - close[3]) < 2
    assert (whole[2] - whole[0]) + (close[2] - close[0]) > 0.9 * (card[2] - card[0])
    assert (whole[3] - whole[1]) > 0.7 * (card[3] - card[1])
    assert caption[3] <= player[1]
    drawn = browser.execute_script(
        "return document.getElementById('map').data.filter(t => t.x.length).map(t => t.name)"
    )
    keys = browser.execute_script("return [...document.querySelectorAll('.map .key')].map(e => e.classList[1])")
    names = {
        "wedge": "look", "region": "region", "outline": "estimate", "later": "later", "flown": "own",
        "truths": "true", "course": "course", "miss": "course", "closest": "course",
    }  # fmt: skip
    assert {names[name] for name in drawn if name in names} == set(keys)


def test_both_maps_have_one_scale(make_page: Callable[..., Path], browser: Any) -> None:
    opened(browser, make_page("corner", corner))
    for view in ("whole", "ahead"):
        browser.execute_script("document.querySelector(`input[value=${arguments[0]}]`).click()", view)
        moved(browser, 60 if view == "whole" else 80)
        for name in ("map", "close"):  # until it is drawn; ranges are rounded
            assert waited(
                browser, "const l = document.getElementById(arguments[0])._fullLayout;"
                "const scale = axis => (axis.range[1] - axis.range[0]) / axis._length;"
                "return Math.abs(scale(l.xaxis) / scale(l.yaxis) - 1) < 3e-3", name,
            ), (view, name)  # fmt: skip


# ----------------------------------------------------------------------------------------------------- several at once


def test_several_obstacles(make_page: Callable[..., Path], browser: Any, replay: Path) -> None:
    page = make_page("several", view_logs.several)
    opened(browser, page)
    names = browser.execute_script("return [...document.querySelectorAll('#obstacle option')].map(o => o.innerText)")
    assert names == ["3", "7", "11"]
    for index, key in enumerate((3, 7, 11)):
        browser.execute_script(
            "const e = document.getElementById('obstacle'); e.value = arguments[0];"
            "e.dispatchEvent(new Event('change'))",
            index,
        )
        moved(browser, 75)
        assert_is_row(said(browser), next(r for r in replayed(page, replay, key) if abs(float(r["t_s"]) - 7.5) < 1e-9))
        drawn = browser.execute_script(
            "const d = Object.fromEntries(document.getElementById('map').data.map(t => [t.name, t]));"
            "const polygons = t => t.x.filter(v => v === null).length;"
            "return {names: d.names.text, own: polygons(d.outline), others: polygons(d.others),"
            " truths: polygons(d.truths)}"
        )
        assert drawn == {"names": ["3", "7", "11"], "own": 1, "others": 2, "truths": 3}
    moved(browser, 10)  # the chimney, chosen, comes later
    assert said(browser)["place"] == "Not detected yet"
    for index in (0, 2):  # selected again, it is shown once it is visible
        browser.execute_script(
            "const e = document.getElementById('obstacle'); e.value = arguments[0];"
            "e.dispatchEvent(new Event('change'))",
            index,
        )
    assert shown(browser) > 26 and " ahead" in said(browser)["place"].replace("\u00a0", " ")
    moved(browser, 76)  # the truck is visible in every third image
    browser.execute_script(
        "const e = document.getElementById('obstacle'); e.value = 1; e.dispatchEvent(new Event('change'))"
    )
    waited(browser, "return document.getElementById('state').innerText.startsWith('No image of it for 0.1 s')")
    assert_quiet(browser)


# ---------------------------------------------------------------------------------------------------------------- keys


def pressed(browser: Any, key: str) -> None:
    from selenium.webdriver.common.action_chains import ActionChains

    ActionChains(browser, duration=0).send_keys(key).perform()


def test_by_keyboard(make_page: Callable[..., Path], browser: Any) -> None:
    from selenium.webdriver.common.keys import Keys

    opened(browser, make_page("corner", corner))
    last = 120
    for _ in range(12):
        pressed(browser, Keys.TAB)
        if browser.execute_script("return document.activeElement.id") == "time":
            break
    assert browser.execute_script("return document.activeElement.id") == "time"
    for key, moment in (
        (Keys.HOME, 0), (Keys.ARROW_RIGHT, 1), (Keys.ARROW_UP, 2), (Keys.ARROW_LEFT, 1), (Keys.PAGE_UP, 7),
        (Keys.END, last), (Keys.ARROW_RIGHT, last), (Keys.PAGE_DOWN, last - 6),
    ):  # fmt: skip
        pressed(browser, key)
        waited(browser, "return document.documentElement.dataset.shown === arguments[0]", str(moment))
        assert browser.execute_script("return Number(document.getElementById('time').value)") == moment
    label, text = browser.execute_script(
        "return ['aria-label', 'aria-valuetext'].map(a => document.getElementById('time').getAttribute(a))"
    )
    assert label == "Time" and re.match(r"28\.50 seconds: \d+(\.\d)? ", text.replace("\u00a0", " "))

    pressed(browser, Keys.HOME)
    browser.execute_script(
        "const e = document.getElementById('speed'); e.value = '5'; e.dispatchEvent(new Event('change'))"
    )
    pressed(browser, Keys.SPACE)
    waited(browser, "return document.getElementById('play').getAttribute('aria-pressed') === 'true'")
    step_time(browser, 0.4)
    assert 3 < shown(browser) < last
    assert browser.execute_script("return document.getElementById('now').getAttribute('aria-live')") == "off"
    pressed(browser, Keys.SPACE)
    waited(browser, "return document.getElementById('play').getAttribute('aria-pressed') === 'false'")
    stopped = shown(browser)
    assert 3 < stopped < last
    step_time(browser, 0.4)
    assert shown(browser) == stopped


def test_everything_has_a_name(make_page: Callable[..., Path], browser: Any) -> None:
    opened(browser, make_page("several", view_logs.several))
    nodes = browser.execute_cdp_cmd("Accessibility.getFullAXTree", {})["nodes"]
    roles: dict[str, list[str]] = {}
    for node in nodes:
        if not node.get("ignored"):
            roles.setdefault(node["role"]["value"], []).append(node.get("name", {}).get("value", ""))
    for role in ("slider", "button", "radio", "combobox", "image"):
        assert roles.get(role), role
        assert all(roles[role]), (role, roles[role])


# --------------------------------------------------------------------------------------------------- light, dark, phone


@pytest.mark.parametrize("dark", [False, True], ids=["light", "dark"])
@pytest.mark.parametrize("size", [WIDE, PHONE], ids=["wide", "phone"])
def test_looks(make_page: Callable[..., Path], browser: Any, size: tuple[int, int], dark: bool, tmp_path: Path) -> None:
    """When the color scheme or the size changes, without reloading."""
    opened(browser, make_page("several", view_logs.several), size, dark)
    waited(browser, DRAWN_IN, size[0])
    assert_fits(browser)
    ink, paper, tick = browser.execute_script(
        "const g = (e, p) => getComputedStyle(e)[p].match(/\\d+/g).slice(0, 3).map(Number);"
        "return [g(document.body, 'color'), g(document.body, 'backgroundColor'),"
        " g(document.querySelector('#map .xtick text'), 'fill')]"
    )
    assert (sum(ink) > 600 > 150 > sum(paper)) if dark else (sum(ink) < 150 < 600 < sum(paper))
    assert abs(sum(tick) - sum(paper)) > 250  # the plots' own text has contrast, too
    plots = browser.execute_script(
        "return [...document.querySelectorAll('.js-plotly-plot')].map(p => p.getBoundingClientRect().width)"
    )
    assert len(plots) >= 10 and min(plots) > 250
    folder = Path(os.environ.get("GOE_SCREENSHOTS", tmp_path))
    folder.mkdir(parents=True, exist_ok=True)
    screenshot(browser, folder / f"view_{'dark' if dark else 'light'}_{size[0]}.png")
    assert_quiet(browser)


# ------------------------------------------------------------------------------------------------------------- any log


def with_nan_truth(tmp_path_factory: pytest.TempPathFactory) -> Path:
    import dataclasses

    truth = view_logs.boxes().truth[1]
    file = tmp_path_factory.mktemp("truth") / "nan.csv"
    write_truth(file, {1: dataclasses.replace(truth, center_n_m=math.nan, height_m=math.nan)})
    return file


@pytest.mark.parametrize(
    ("name", "log", "place"),
    [
        pytest.param("one", view_logs.one_frame, "No estimate yet: collecting images", marks=pytest.mark.release),
        ("nothing", view_logs.nothing_answered, "No estimate yet: no detection"),
        ("spoiled", view_logs.spoiled, ""), pytest.param("long", view_logs.long, "", marks=pytest.mark.release),
        pytest.param("nan", view_logs.boxes, "", marks=pytest.mark.release),
    ],
)  # fmt: skip
def test_any_log(
    name: str, log: Callable[[], ObservationLog], place: str, make_page: Callable[..., Path], browser: Any,
    tmp_path_factory: pytest.TempPathFactory,
) -> None:  # fmt: skip
    page = make_page(name, log, *(("--truth", str(with_nan_truth(tmp_path_factory))) if name == "nan" else ()))
    assert page.stat().st_size < 4e6
    opened(browser, page)
    last = browser.execute_script("return Number(document.getElementById('time').max)")
    for moment in sorted({0, last // 2, last}):
        moved(browser, moment)
        assert not place or said(browser)["place"] == place
    assert_fits(browser)
    assert_quiet(browser)


def test_spoiled_rows_are_shown(make_page: Callable[..., Path], browser: Any, replay: Path) -> None:
    """For a refused image the page shows the older answer and the reason. Resets are marked above the slider."""
    page = make_page("spoiled", view_logs.spoiled)
    opened(browser, page)
    rows = replayed(page, replay, 1)
    times = browser.execute_script("return document.querySelectorAll('#strip .reset').length")
    assert times == 2
    seen = set()
    for moment in range(30):
        moved(browser, moment)
        state, clock = said(browser)["state"], float(said(browser)["clock"].split()[0])
        row = next(r for r in rows if r["t_s"] not in ("nan",) and abs(float(r["t_s"]) - clock) < 1e-6)
        if "the estimate is" in state:
            seen.add(row["status"])
    assert "bad_attitude" in seen or "not_finite" in seen


def test_an_old_browser_shows_a_message(make_page: Callable[..., Path], browser: Any) -> None:
    page = make_page("one", view_logs.one_frame)
    script = browser.execute_cdp_cmd(
        "Page.addScriptToEvaluateOnNewDocument", {"source": "delete window.DecompressionStream"}
    )
    try:
        open_page(browser, page, WIDE)
        assert waited(browser, "return document.documentElement.dataset.ready") == "failed"
        assert "cannot unpack the page" in browser.execute_script("return document.getElementById('problem').innerText")
    finally:
        browser.execute_cdp_cmd("Page.removeScriptToEvaluateOnNewDocument", {"identifier": script["identifier"]})

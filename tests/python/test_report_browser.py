"""Opens the report's pages in headless Chromium: every figure is there, nothing is fetched, the console is silent, they
fit; the first page is short."""

from __future__ import annotations

import base64
import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import chromium
import pytest
from chromium import open_page, screenshot
from goe_tools.report import data, page
from goe_tools.report.figures import FIGURES
from synthetic_campaign import write_avoid, write_goals

WIDE, PHONE = (1280, 900), (400, 844)  # px
MOST_HEIGHT = 6000  # px of the first page, wide
PAGES = ("report.html", "report_goals.html", "report_paper.html")

DATA = Path(__file__).resolve().parents[1] / "data"
APPROACH, RARE = DATA / "corner", DATA / "rare_events.json"

selenium = pytest.importorskip("selenium", reason="the browser test needs selenium (pip)")
pytestmark = pytest.mark.skipif(chromium.MISSING, reason=chromium.WHY_MISSING)


@pytest.fixture(scope="module")
def report(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The first page: of the campaign that GOE_CAMPAIGN_DIR names, of the goals' file that GOE_GOALS names, and of
    goe_avoid's runs that GOE_AVOID_RUNS names; without the first of synthetic data."""
    named, goals, runs = (os.environ.get(name) for name in ("GOE_CAMPAIGN_DIR", "GOE_GOALS", "GOE_AVOID_RUNS"))
    if not named:
        return request.getfixturevalue("report_pages")
    out = tmp_path_factory.mktemp("report") / "report.html"
    doors = page.Doors(out.with_name("live.html"), out.with_name("view.html"))
    for name in ("live.html", "view.html"):
        out.with_name(name).write_text("<title>elsewhere</title>", encoding="utf-8")
    campaign = data.read_campaign(
        Path(named), goals=Path(goals) if goals else write_goals(out.with_name("goals.json"), hostile=True),
        avoid=Path(runs) if runs else write_avoid(out.with_name("avoid.csv")), rare=RARE, approach=APPROACH,
    )  # fmt: skip
    page.write_page(campaign, out, doors)
    return out


@pytest.fixture(scope="module")
def shots(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder for screenshots: GOE_SCREENSHOTS, or one that pytest removes."""
    given = os.environ.get("GOE_SCREENSHOTS")
    folder = Path(given) if given else tmp_path_factory.mktemp("shots")
    folder.mkdir(parents=True, exist_ok=True)
    return folder


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    driver = chromium.start(tmp_path_factory.mktemp("profile"))
    yield driver
    driver.quit()


@pytest.mark.parametrize("size", [pytest.param(WIDE, marks=pytest.mark.release), PHONE], ids=["wide", "phone"])
def test_pages_in_browser(browser: Any, report: Path, shots: Path, size: tuple[int, int], request: Any) -> None:
    keys = []
    for name in PAGES:
        file = report.with_name(name)
        open_page(browser, file, size)
        figures = browser.execute_script(
            "return [...document.querySelectorAll('figure')].map(f => { const i = f.querySelector('img');"
            " const r = i.getBoundingClientRect(), c = f.querySelector('figcaption'); return {key: f.id,"
            " natural: [i.naturalWidth, i.naturalHeight], shown: [r.width, r.height], alt: i.alt,"
            " caption: c ? c.innerText : i.className}; })"
        )
        for figure in figures:
            assert min(figure["natural"]) > 100, figure["key"]
            assert min(figure["shown"]) > 100, figure["key"]
            assert len(figure["alt"]) > 40, figure["key"]
            assert len(figure["caption"]) > 40 or figure["caption"].startswith("approach"), figure["key"]
        keys += [figure["key"] for figure in figures if figure["key"]]

        overflow = browser.execute_script(
            "const w = document.documentElement.clientWidth; return [...document.body.querySelectorAll('*')]"
            ".filter(e => e.getBoundingClientRect().right > w + 1 && getComputedStyle(e).position !== 'absolute'"
            " && !e.closest('thead')).map(e => e.outerHTML.slice(0, 80))"
        )
        assert overflow == [], name
        assert browser.execute_script("return document.documentElement.scrollWidth") <= size[0]
        small = browser.execute_script(
            "return [...document.body.querySelectorAll('*')].filter(e => [...e.childNodes].some(n => n.nodeType === 3"
            " && n.textContent.trim()) && e.getClientRects().length && parseFloat(getComputedStyle(e).fontSize) < 11)"
            ".map(e => e.outerHTML.slice(0, 80))"
        )
        assert small == [], name

        assert chromium.requested(browser) == [file.as_uri()]
        assert browser.get_log("browser") == []
        screenshot(browser, shots / f"{file.stem}_{request.node.callspec.id}.png")
    assert sorted(keys) == sorted(spec.key for spec in FIGURES)


def test_the_first_page_is_short_and_leads_to_the_others(browser: Any, report: Path) -> None:
    open_page(browser, report, WIDE)
    assert browser.execute_script("return document.documentElement.scrollHeight") <= MOST_HEIGHT
    doors = browser.execute_script("return [...document.querySelectorAll('nav.doors a')].map(a => a.href)")
    names = ["live.html", "view.html", "report_paper.html", "report_goals.html"]
    assert doors == [report.with_name(name).as_uri() for name in names]
    top = browser.execute_script("return document.querySelector('ul.answers').getBoundingClientRect().bottom")
    assert top <= WIDE[1]  # the three answers are there without scrolling
    for name in names:
        browser.get(report.as_uri())
        browser.execute_script("document.querySelector(`nav.doors a[href='${arguments[0]}']`).click()", name)
        assert browser.current_url == report.with_name(name).as_uri()


CONTRAST = (  # texts with little contrast, or on a bright ground
    "const bright = c => { const [r, g, b] = c.match(/[\\d.]+/g).map(x => (x / 255) ** 2.2);"
    " return .2126 * r + .7152 * g + .0722 * b; };"
    "const under = e => { for (; e; e = e.parentElement) { const c = getComputedStyle(e).backgroundColor;"
    " if (c !== 'rgba(0, 0, 0, 0)') return c; } };"
    "return [...document.body.querySelectorAll('*')].filter(e => e.innerText && e.innerText.trim()).map(e => {"
    " const a = bright(getComputedStyle(e).color), b = bright(under(e));"
    " return [(Math.max(a, b) + .05) / (Math.min(a, b) + .05), b, e.outerHTML.slice(0, 80)]; })"
    ".filter(([ratio, ground]) => ratio < 4.5 || ground > .1)"
)


@pytest.mark.release
def test_dark(browser: Any, report: Path, shots: Path) -> None:
    """Follows the reader's color scheme: no white remains, and text contrasts with its background."""
    browser.execute_cdp_cmd(
        "Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": "dark"}]}
    )
    try:
        for name in PAGES:
            open_page(browser, report.with_name(name), WIDE)
            weak = browser.execute_script(CONTRAST)
            assert weak == [], name
            screenshot(browser, shots / f"{Path(name).stem}_dark.png")
    finally:
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})


@pytest.mark.release
def test_print(browser: Any, report: Path, shots: Path) -> None:
    open_page(browser, report.with_name("report_paper.html"), WIDE)
    printed = browser.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True, "printBackground": False})
    pdf = base64.b64decode(printed["data"])
    file = shots / "report_print.pdf"
    file.write_bytes(pdf)
    assert pdf.startswith(b"%PDF-") and len(pdf) > 50_000
    if shutil.which("pdftoppm"):
        subprocess.run(["pdftoppm", "-r", "60", "-png", str(file), str(shots / "report_print")], check=True)
        pages = sorted(shots.glob("report_print-*.png"))
        assert 5 <= len(pages) <= 30

"""Opens the report in headless Chromium: every figure is there, nothing is fetched, the console is silent, the layout
fits."""

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
from synthetic_campaign import write_avoid, write_campaign, write_goals

WIDE, PHONE = (1280, 900), (390, 844)  # px

selenium = pytest.importorskip("selenium", reason="the browser test needs selenium (pip)")
pytestmark = pytest.mark.skipif(chromium.MISSING, reason=chromium.WHY_MISSING)


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The report of the campaign in GOE_CAMPAIGN_DIR, the goals' file in GOE_GOALS and goe_avoid's runs in
    GOE_AVOID_RUNS; without a variable the data are synthetic."""
    folder = tmp_path_factory.mktemp("report")
    given = os.environ.get("GOE_CAMPAIGN_DIR")
    campaign = Path(given) if given else write_campaign(folder / "campaign")
    path = os.environ.get("GOE_GOALS")
    goals = Path(path) if path else write_goals(folder / "goals.json")
    flown = os.environ.get("GOE_AVOID_RUNS")
    avoid = Path(flown) if flown else write_avoid(folder / "avoid.csv")
    page.write_page(data.read_campaign(campaign, goals=goals, avoid=avoid), folder / "report.html")
    return folder / "report.html"


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


@pytest.mark.parametrize("size", [WIDE, PHONE], ids=["wide", "phone"])
def test_page_in_browser(browser: Any, report: Path, shots: Path, size: tuple[int, int], request: Any) -> None:
    open_page(browser, report, size)

    figures = browser.execute_script(
        "return [...document.querySelectorAll('figure')].map(f => { const i = f.querySelector('img');"
        " const r = i.getBoundingClientRect(); return {key: f.id, natural: [i.naturalWidth, i.naturalHeight],"
        " shown: [r.width, r.height], alt: i.alt, caption: f.querySelector('figcaption').innerText}; })"
    )
    assert [figure["key"] for figure in figures] == [spec.key for spec in FIGURES]
    for figure in figures:
        assert min(figure["natural"]) > 100, figure["key"]
        assert min(figure["shown"]) > 100, figure["key"]
        assert len(figure["alt"]) > 40 and len(figure["caption"]) > 40, figure["key"]

    overflow = browser.execute_script(
        "const w = document.documentElement.clientWidth; return [...document.body.querySelectorAll('*')]"
        ".filter(e => e.getBoundingClientRect().right > w + 1 && getComputedStyle(e).position !== 'absolute'"
        " && !e.closest('thead')).map(e => e.outerHTML.slice(0, 80))"
    )
    assert overflow == []

    assert chromium.requested(browser) == [report.as_uri()]
    assert browser.get_log("browser") == []
    screenshot(browser, shots / f"report_{request.node.callspec.id}.png")


def test_dark(browser: Any, report: Path, shots: Path) -> None:
    """Follows the reader's color scheme: no white remains, and text contrasts with its background."""
    browser.execute_cdp_cmd(
        "Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": "dark"}]}
    )
    try:
        open_page(browser, report, WIDE)
        weak = browser.execute_script(
            "const bright = c => { const [r, g, b] = c.match(/[\\d.]+/g).map(x => (x / 255) ** 2.2);"
            " return .2126 * r + .7152 * g + .0722 * b; };"
            "const under = e => { for (; e; e = e.parentElement) { const c = getComputedStyle(e).backgroundColor;"
            " if (c !== 'rgba(0, 0, 0, 0)') return c; } };"
            "return [...document.body.querySelectorAll('*')].filter(e => e.innerText && e.innerText.trim()).map(e => {"
            " const a = bright(getComputedStyle(e).color), b = bright(under(e));"
            " return [(Math.max(a, b) + .05) / (Math.min(a, b) + .05), b, e.outerHTML.slice(0, 80)]; })"
            ".filter(([ratio, ground]) => ratio < 4.5 || ground > .1)"
        )
        assert weak == []
        screenshot(browser, shots / "report_dark.png")
    finally:
        browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": []})


def test_print(browser: Any, report: Path, shots: Path) -> None:
    open_page(browser, report, WIDE)
    printed = browser.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True, "printBackground": False})
    pdf = base64.b64decode(printed["data"])
    file = shots / "report_print.pdf"
    file.write_bytes(pdf)
    assert pdf.startswith(b"%PDF-") and len(pdf) > 50_000
    if shutil.which("pdftoppm"):
        subprocess.run(["pdftoppm", "-r", "60", "-png", str(file), str(shots / "report_print")], check=True)
        pages = sorted(shots.glob("report_print-*.png"))
        assert 5 <= len(pages) <= 30

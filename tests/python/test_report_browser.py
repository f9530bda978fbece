"""Opens the report in headless Chromium: every figure is there, nothing is fetched, the console is silent, it fits."""

from __future__ import annotations

import base64
import json
import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from goe_tools.report import data, page
from goe_tools.report.figures import FIGURES
from synthetic_campaign import write_avoid, write_campaign, write_goals

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
CHROMEDRIVER = shutil.which("chromedriver")
WIDE, PHONE = (1280, 900), (390, 844)  # px
LEAST_INK = 0.005  # share of a screenshot's or print's bytes that a blank page has not

selenium = pytest.importorskip("selenium", reason="the browser test needs selenium (pip)")
pytestmark = pytest.mark.skipif(
    CHROMIUM is None or CHROMEDRIVER is None, reason="the browser test needs chromium and chromium-driver"
)


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page to look at: of the campaign that GOE_CAMPAIGN_DIR names, of the goals' file that
    GOE_GOALS names, and of goe_avoid's runs that GOE_AVOID_RUNS names; what is not named is invented."""
    folder = tmp_path_factory.mktemp("report")
    given = os.environ.get("GOE_CAMPAIGN_DIR")
    campaign = Path(given) if given else write_campaign(folder / "campaign")
    told = os.environ.get("GOE_GOALS")
    goals = Path(told) if told else write_goals(folder / "goals.json")
    flown = os.environ.get("GOE_AVOID_RUNS")
    avoid = Path(flown) if flown else write_avoid(folder / "avoid.csv")
    page.write_page(data.read_campaign(campaign, goals=goals, avoid=avoid), folder / "report.html")
    return folder / "report.html"


@pytest.fixture(scope="module")
def shots(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Where screenshots go: GOE_SCREENSHOTS, or a folder that pytest removes."""
    given = os.environ.get("GOE_SCREENSHOTS")
    folder = Path(given) if given else tmp_path_factory.mktemp("shots")
    folder.mkdir(parents=True, exist_ok=True)
    return folder


@pytest.fixture(scope="module")
def browser(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    options.binary_location = str(CHROMIUM)
    for argument in (
        "headless", "no-sandbox", "disable-gpu", "disable-quic", "no-first-run", "disable-background-networking",
        "disable-component-update", "disable-sync", "disable-default-apps", "disable-dev-shm-usage",
        "hide-scrollbars", f"user-data-dir={tmp_path_factory.mktemp('profile')}",
    ):  # fmt: skip
        options.add_argument(f"--{argument}")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service(str(CHROMEDRIVER)))
    yield driver
    driver.quit()


def open_page(browser: Any, report: Path, size: tuple[int, int]) -> None:
    width, height = size
    browser.get_log("performance"), browser.get_log("browser")  # what came before is not this page's
    browser.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride",
        {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600},
    )
    browser.get(report.as_uri())
    for _ in range(50):  # pictures are decoded in the background
        if browser.execute_script("return [...document.images].every(i => i.complete)"):
            return
    browser.execute_async_script(
        "const done = arguments[0]; Promise.allSettled([...document.images].map(i => i.decode())).then(() => done())"
    )


def screenshot(browser: Any, file: Path) -> None:
    """The whole page, not only what the window shows."""
    size = browser.execute_cdp_cmd("Page.getLayoutMetrics", {})["cssContentSize"]
    clip = {"x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1}
    shot = browser.execute_cdp_cmd("Page.captureScreenshot", {"captureBeyondViewport": True, "clip": clip})
    file.write_bytes(base64.b64decode(shot["data"]))
    assert file.stat().st_size > LEAST_INK * size["width"] * size["height"]


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

    requested = []
    for entry in browser.get_log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent":
            requested.append(message["params"]["request"]["url"])
    away = [url for url in requested if not url.startswith("data:")]
    assert away == [report.as_uri()]
    assert browser.get_log("browser") == []
    screenshot(browser, shots / f"report_{request.node.callspec.id}.png")


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

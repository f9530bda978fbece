"""Headless Chromium for the tests of web pages."""

from __future__ import annotations

import base64
import json
import shutil
from pathlib import Path
from typing import Any

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
CHROMEDRIVER = shutil.which("chromedriver")
MISSING = CHROMIUM is None or CHROMEDRIVER is None
WHY_MISSING = "the browser test needs chromium and chromium-driver"
HANG_S = 300  # guard against a hang
LEAST_INK = 0.005  # a screenshot or print with a smaller share of the reference's bytes is blank


def start(profile: Path) -> Any:
    """Starts a driver. The caller ends it with ``quit()``."""
    from selenium import webdriver
    from selenium.webdriver.chrome.service import Service

    options = webdriver.ChromeOptions()
    options.binary_location = str(CHROMIUM)
    for argument in (
        "headless", "no-sandbox", "disable-gpu", "disable-quic", "no-first-run", "disable-background-networking",
        "disable-component-update", "disable-sync", "disable-default-apps", "disable-dev-shm-usage",
        "hide-scrollbars", f"user-data-dir={profile}",
    ):  # fmt: skip
        options.add_argument(f"--{argument}")
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    driver = webdriver.Chrome(options=options, service=Service(str(CHROMEDRIVER)))
    driver.set_script_timeout(HANG_S)
    driver.get("about:blank")  # leaves the browser's own start page, whose requests would be counted
    return driver


# Everything that is animated by performance.now() or by frame times runs on the test's clock, which advances only by
# step_time().
HELD_TIME = """
  let now_ms = 1000;
  const frame = window.requestAnimationFrame.bind(window);
  performance.now = () => now_ms;
  window.requestAnimationFrame = (call) => frame(() => call(now_ms));
  window.stepTime = (seconds, done) => { now_ms += 1000 * seconds; frame(() => frame(done)); };
"""


def hold_time(browser: Any) -> None:
    """Applies to all pages that are opened from now on."""
    browser.execute_cdp_cmd("Page.addScriptToEvaluateOnNewDocument", {"source": f"{{ {HELD_TIME} }}"})


def step_time(browser: Any, seconds: float) -> None:
    """Returns when the page has drawn the state at the new time."""
    browser.execute_async_script("stepTime(...arguments)", seconds)


def set_size(browser: Any, size: tuple[int, int]) -> None:
    width, height = size
    browser.execute_cdp_cmd(
        "Emulation.setDeviceMetricsOverride",
        {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": width < 600},
    )


def open_page(browser: Any, page: Path, size: tuple[int, int]) -> None:
    browser.get_log("performance"), browser.get_log("browser")  # drops entries of the previous page
    set_size(browser, size)
    browser.get(page.as_uri())
    for _ in range(50):  # pictures are decoded in the background
        if browser.execute_script("return [...document.images].every(i => i.complete)"):
            return
    browser.execute_async_script(
        "const done = arguments[0]; Promise.allSettled([...document.images].map(i => i.decode())).then(() => done())"
    )


def requested(browser: Any) -> list[str]:
    """URLs fetched since the page was opened, without data URLs."""
    found = []
    for entry in browser.get_log("performance"):
        message = json.loads(entry["message"])["message"]
        if message["method"] == "Network.requestWillBeSent":
            found.append(message["params"]["request"]["url"])
    return [url for url in found if not url.startswith(("data:", "blob:"))]


def screenshot(browser: Any, file: Path, whole: bool = True) -> None:
    """Saves the whole page, or only the visible part of the window."""
    if whole:
        size = browser.execute_cdp_cmd("Page.getLayoutMetrics", {})["cssContentSize"]
        clip = {"x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1}
        shot = browser.execute_cdp_cmd("Page.captureScreenshot", {"captureBeyondViewport": True, "clip": clip})
        least = LEAST_INK * size["width"] * size["height"]
    else:
        shot, least = browser.execute_cdp_cmd("Page.captureScreenshot", {}), 0.0
    file.write_bytes(base64.b64decode(shot["data"]))
    assert file.stat().st_size > least

"""Opens the live page (port/wasm) in headless Chromium: the hash is right, sliders and keys work, the layout fits."""

from __future__ import annotations

import base64
import json
import os
import struct
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import chromium
import pytest
from goe_tools.__main__ import main
from goe_tools.live import modules, page

ROOT = Path(__file__).resolve().parents[2]
WIDE, PHONE = (1280, 800), (400, 860)  # px

selenium = pytest.importorskip("selenium", reason="the browser test needs selenium (pip)")
pytestmark = [
    pytest.mark.skipif(chromium.MISSING, reason=chromium.WHY_MISSING),
    pytest.mark.skipif(bool(modules.missing()), reason=f"WebAssembly needs {', '.join(modules.missing())}"),
]


@pytest.fixture(scope="module")
def built() -> modules.Modules:
    return modules.build(ROOT / "build-wasm")


@pytest.fixture(scope="module")
def live(built: modules.Modules, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The page as its command writes it."""
    file = tmp_path_factory.mktemp("live") / "live.html"
    assert main(["live", "--out", str(file)]) == 0
    return file


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
    chromium.hold_time(driver)
    yield driver
    driver.quit()


def open_page(browser: Any, file: Path, fragment: str, size: tuple[int, int] = WIDE, scheme: str = "light") -> None:
    """Waits until the page has verified its module, or failed to."""
    from selenium.webdriver.support.ui import WebDriverWait

    browser.get("about:blank")
    browser.get_log("performance"), browser.get_log("browser")  # drops entries of the previous page
    browser.execute_cdp_cmd(
        "Emulation.setEmulatedMedia", {"features": [{"name": "prefers-color-scheme", "value": scheme}]}
    )
    chromium.set_size(browser, size)
    browser.get(f"{file.as_uri()}#{fragment}")
    wait = WebDriverWait(browser, chromium.HANG_S, poll_frequency=0.02)
    wait.until(lambda b: b.execute_script("return document.documentElement.dataset.ready"))


def state(browser: Any) -> dict[str, Any]:
    """The displayed proof and decision, and each quantity with its 1-sigma uncertainty; None if unknown."""
    read = (
        "const of = id => document.getElementById(id), d = of('order').dataset, s = {};"
        "for (const id of ['ahead', 'side', 'width', 'height']) { const v = of(id + '-value').dataset;"
        " s[id] = v.value ? [Number(v.value), Number(v.sigma)] : null; }"
        "return {...s, proof: of('proof').className, hash: of('proof').innerText, order: of('order').className,"
        " line: of('order-line').innerText, doubts: of('doubts').innerText, suspect: d.suspect, at: Number(d.at),"
        " play: of('play').innerText, box: of('box') ? Number(of('box').getAttribute('width')) : 0,"
        " ground: document.querySelector('#camera .ground').getAttribute('points')};"
    )
    return browser.execute_script(read)


def drag(browser: Any, control: str, value: float) -> dict[str, Any]:
    """Moves a slider, or selects a choice. Returns the displayed state after that."""
    browser.execute_script(
        "const [name, value] = arguments; const all = [...document.querySelectorAll(`[data-control=${name}]`)];"
        "const one = all.length > 1 ? all.find(e => e.value === String(value)) : all[0];"
        "if (all.length > 1) one.checked = true; else if (one.type === 'checkbox') one.checked = value === 1;"
        "else one.value = value; one.dispatchEvent(new Event('input', {bubbles: true}));",
        control, value,
    )  # fmt: skip
    return state(browser)


def press(browser: Any, *keys: str) -> None:
    from selenium.webdriver import ActionChains

    chain = ActionChains(browser)
    for key in keys:
        chain.send_keys(key)
    chain.perform()


def screenshot(browser: Any, file: Path) -> None:
    size = browser.execute_cdp_cmd("Page.getLayoutMetrics", {})["cssContentSize"]
    clip = {"x": 0, "y": 0, "width": size["width"], "height": size["height"], "scale": 1}
    shot = browser.execute_cdp_cmd("Page.captureScreenshot", {"captureBeyondViewport": True, "clip": clip})
    file.write_bytes(base64.b64decode(shot["data"]))
    assert file.stat().st_size > 15_000


VIEWS = {
    "corners": "t=4",
    "boxes_truck_roll": "t=10.5&kind=1&side_m=8&roll_deg=20&detector=0",
    "suspect": "t=11.5&detector=0&knows=0&pixel_px=5",
    "mast": "t=16&kind=2&side_m=0",
    "begin": "t=0",
    "end": "t=19&side_m=40&detector=0",
}


LOOKS = [("wide", "light", view) for view in VIEWS] + [
    ("wide", "dark", "boxes_truck_roll"),
    ("wide", "dark", "suspect"),
    ("phone", "light", "suspect"),
    ("phone", "light", "boxes_truck_roll"),
    ("phone", "dark", "corners"),
    ("tablet", "light", "mast"),
]
SIZES = {"wide": WIDE, "tablet": (1024, 768), "phone": PHONE}


@pytest.mark.parametrize(("screen", "scheme", "view"), LOOKS, ids=["-".join(look) for look in LOOKS])
def test_page(browser: Any, live: Path, shots: Path, screen: str, scheme: str, view: str) -> None:
    size = SIZES[screen]
    open_page(browser, live, VIEWS[view], size, scheme)
    shown = state(browser)
    assert shown["proof"] == "right" and page.golden_hash() in shown["hash"]
    assert browser.execute_script("return document.documentElement.scrollWidth") <= size[0]
    overflow = browser.execute_script(
        "const w = document.documentElement.clientWidth; return [...document.body.querySelectorAll('*')]"
        ".filter(e => !e.closest('svg') && e.getBoundingClientRect().right > w + 1).map(e => e.outerHTML.slice(0, 80))"
    )
    assert overflow == []
    cut = browser.execute_script(
        "return [...document.querySelectorAll('.figure p, button, legend, #order')]"
        ".filter(e => e.scrollWidth > e.clientWidth + 1).map(e => e.outerHTML.slice(0, 80))"
    )
    assert cut == []
    messages = [json.loads(entry["message"])["message"] for entry in browser.get_log("performance")]
    urls = [m["params"]["request"]["url"] for m in messages if m["method"] == "Network.requestWillBeSent"]
    assert [url for url in urls if not url.startswith(("data:", "about:"))] == [live.as_uri()]
    assert browser.get_log("browser") == []
    background = browser.execute_script("return getComputedStyle(document.body).backgroundColor")
    assert (background == "rgb(255, 255, 255)") == (scheme == "light")
    screenshot(browser, shots / f"live_{view}_{scheme}_{screen}.png")


def test_one_screen(browser: Any, live: Path) -> None:
    open_page(browser, live, "t=5")
    assert browser.execute_script("return document.querySelector('main').getBoundingClientRect().bottom") <= WIDE[1]


def test_noise_widens_the_band(browser: Any, live: Path) -> None:
    for detector in (0, 1):
        open_page(browser, live, f"t=10&detector={detector}&pixel_px=1")
        calm = state(browser)
        noisy = drag(browser, "pixel_px", 6)
        assert noisy["ahead"][1] > (1.1 if detector == 0 else 2.0) * calm["ahead"][1]
        assert noisy["suspect"] == calm["suspect"] == ""


def test_unconfigured_noise_is_suspect(browser: Any, live: Path) -> None:
    open_page(browser, live, "t=12&pixel_px=6&detector=0")
    assert state(browser)["doubts"] == ""
    unconfigured = drag(browser, "knows", 0)
    assert unconfigured["suspect"] in ("noise", "late", "convention")
    assert unconfigured["doubts"].startswith("Suspect: ")


def test_a_high_altimeter_makes_things_large(browser: Any, live: Path) -> None:
    """Until the growth of the image shows the range."""
    open_page(browser, live, "t=4&knows=0&detector=0")
    low, high = drag(browser, "height_offset_m", -8), drag(browser, "height_offset_m", 8)
    for quantity in ("ahead", "width", "height"):
        assert high[quantity][0] > 1.1 * low[quantity][0], quantity


def test_roll_turns_the_box_but_not_the_estimate(browser: Any, live: Path) -> None:
    """A box around a rolled mast is wider than the mast; the estimate is not."""
    open_page(browser, live, "t=13.6&kind=2&detector=0&roll_deg=0&pixel_px=0.5")
    level = state(browser)
    rolled = drag(browser, "roll_deg", 25)
    assert rolled["ground"] != level["ground"]
    assert rolled["box"] > 2.0 * level["box"]
    for shown in (level, rolled):
        width, sigma = shown["width"]
        assert abs(width - 4.0) < 3.0 * sigma < 3.0


def test_obstacle_and_side(browser: Any, live: Path) -> None:
    open_page(browser, live, "t=12&detector=1")
    heights = [drag(browser, "kind", kind)["height"][0] for kind in (1, 0, 2)]
    assert heights == pytest.approx([4.0, 25.0, 40.0], rel=0.15)
    drag(browser, "kind", 0)
    left, ahead, right = (drag(browser, "side_m", side) for side in (-40, 0, 40))
    assert left["side"][0] == pytest.approx(-40.0, abs=3.0) and right["side"][0] == pytest.approx(40.0, abs=3.0)
    assert left["order"] == right["order"] == "clear" and "to the side" in left["line"]
    assert ahead["order"] == "go-around" and "through the obstacle" in ahead["line"]


def test_the_region_shrinks_on_the_truth(browser: Any, live: Path) -> None:
    open_page(browser, live, "t=2")
    early = browser.execute_script("return Number(document.getElementById('region').getAttribute('rx'))")
    press(browser, "\ue010")  # End
    late = browser.execute_script("return Number(document.getElementById('region').getAttribute('rx'))")
    assert late < 0.2 * early
    assert state(browser)["ahead"][0] == pytest.approx(26.0, abs=2.0)


def test_keys(browser: Any, live: Path) -> None:
    open_page(browser, live, "t=5")
    assert state(browser)["at"] == 50 and "Play" in state(browser)["play"]
    press(browser, "\ue014", "\ue014", "\ue012")  # right, right, left
    assert state(browser)["at"] == 51
    press(browser, " ")
    assert "Pause" in state(browser)["play"]
    chromium.step_time(browser, 0.25)
    assert state(browser)["at"] == 53
    press(browser, "k")
    chromium.step_time(browser, 1.0)
    assert "Play" in state(browser)["play"] and state(browser)["at"] == 53
    press(browser, "r")
    assert "Pause" in state(browser)["play"] and state(browser)["at"] == 0
    press(browser, " ", "\ue011")  # pause, Home
    assert state(browser)["at"] == 0
    press(browser, "\ue010")
    before = state(browser)
    press(browser, "n")
    after = state(browser)
    assert after["at"] == before["at"] and after["ahead"] != before["ahead"]


def test_focused_controls_keep_their_keys(browser: Any, live: Path) -> None:
    open_page(browser, live, "t=5")
    browser.execute_script("document.getElementById('side_m').focus()")
    side = state(browser)["side"][0]
    press(browser, *["\ue014"] * 10)  # right
    moved = state(browser)
    assert moved["at"] == 50 and moved["side"][0] == pytest.approx(side + 10.0, abs=3.0)
    browser.execute_script("document.getElementById('play').focus()")
    press(browser, " ")
    assert "Pause" in state(browser)["play"]
    press(browser, " ")
    assert "Play" in state(browser)["play"]


def test_it_says_why_there_is_no_estimate_yet(browser: Any, live: Path) -> None:
    open_page(browser, live, "t=0")
    shown = state(browser)
    assert shown["order"] == "nothing" and shown["ahead"] is None
    head, first = browser.execute_script(
        "return [document.getElementById('order-head').textContent,"
        " document.getElementById('order-line').textContent.match(/First estimate in ([\\d.]+) s/)]"
    )
    assert head == "Collecting images" and "One image contains no range" in shown["line"]
    open_page(browser, live, f"t={first[1]}")
    assert state(browser)["ahead"] is not None


def test_reduced_motion_shows_an_estimate_and_stands_still(browser: Any, live: Path) -> None:
    from selenium.webdriver.support.ui import WebDriverWait

    features = [{"name": "prefers-reduced-motion", "value": "reduce"}]
    browser.get("about:blank")
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia", {"features": features})
    browser.get(live.as_uri())
    wait = WebDriverWait(browser, chromium.HANG_S, poll_frequency=0.02)
    wait.until(lambda b: b.execute_script("return document.documentElement.dataset.ready"))
    first = state(browser)
    assert first["ahead"] is not None and "Play" in first["play"]
    chromium.step_time(browser, 0.45)
    assert state(browser)["at"] == first["at"]


def test_controls_speak_plainly(browser: Any, live: Path) -> None:
    open_page(browser, live, "t=5")
    says = "return document.getElementById(`${arguments[0]}-says`).textContent"
    for name, values in {
        "height_offset_m": {0: "none", 3: "reads 3 m too high", -8: "reads 8 m too low"},
        "roll_deg": {0: "none", 20: "20° each way"},
        "side_m": {0: "on the course", -40: "40 m left of the course"},
    }.items():
        for value, text in values.items():
            drag(browser, name, value)
            assert browser.execute_script(says, name) == text


def test_it_plays_by_itself(browser: Any, live: Path) -> None:
    open_page(browser, live, "")
    chromium.step_time(browser, 0.45)
    assert state(browser)["at"] == 4


@pytest.mark.parametrize("spoiled", ["constant", "logs", "code"])
def test_a_wrong_byte_is_reported(browser: Any, built: modules.Modules, tmp_path: Path, spoiled: str) -> None:
    """A wrong bit of degrees per radian; a wrong bit of the logs; a library that is no valid WebAssembly."""
    if spoiled == "constant":
        constant = struct.pack("<f", 57.2957795)
        wrong = replace(built, goe=built.goe.replace(constant, bytes([constant[0] ^ 1]) + constant[1:]))
    elif spoiled == "logs":
        at = built.golden.index(struct.pack("<fff", 120.0, -75.0, -25.0))  # position of the first image
        wrong = replace(built, golden=built.golden[:at] + bytes([built.golden[at] ^ 1]) + built.golden[at + 1 :])
    else:
        wrong = replace(built, goe=b"\1" + built.goe[1:])
    assert wrong != built
    file = tmp_path / "wrong.html"
    file.write_text(page.page(wrong), encoding="utf-8")
    open_page(browser, file, "t=5")
    proof = browser.execute_script("const p = document.getElementById('proof'); return [p.className, p.innerText];")
    assert proof[0] == "wrong" and "wrong" in proof[1] and "trust nothing" in proof[1]
    assert (page.golden_hash() in proof[1]) == (spoiled != "code")

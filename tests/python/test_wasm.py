"""The library as WebAssembly (port/wasm): its size, and its bits under node against those of C."""

from __future__ import annotations

import json
import re
import shutil
import struct
import subprocess
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any

import pytest
from goe_tools.__main__ import main
from goe_tools.cli import EXIT_BAD_INPUT
from goe_tools.live import modules, page

ROOT = Path(__file__).resolve().parents[2]
TESTS = ROOT / "tests" / "wasm"
NODE = shutil.which("node")
# of the library: 60,000 before the decision rule and the sigmas of shapes, 65,536 before the smoothed path, 66,560
# before the removal of small jumps
MOST_BYTES = 66_700

# kind, detector, roll, pixel, height offset, side, knows, seed: in the order of LIVE_CONTROLS
FLIGHTS = (
    (0, 0, 5, 1, 0, -24, 1, 1),
    (0, 1, 20, 0.5, 4, 0, 1, 2),
    (1, 0, 0, 3, -6, 18, 0, 3),
    (1, 1, 12, 1.5, 0, -60, 0, 4),
    (2, 0, 25, 8, 10, 60, 0, 5),
    (2, 1, 7, 0, 0, -3, 1, 6),
)


@pytest.fixture(scope="module")
def built() -> modules.Modules:
    absent = modules.missing()
    if absent:
        pytest.skip(f"WebAssembly needs {', '.join(absent)}")
    return modules.build(ROOT / "build-wasm")


def under_node(folder: Path, given: modules.Modules, flights: tuple[tuple[float, ...], ...] = ()) -> dict[str, Any]:
    """Output of tests/wasm/fly.mjs for these modules."""
    if NODE is None:
        pytest.skip("needs node; tests/python/test_live_page.py tries the hash in Chromium")
    for name, content in asdict(given).items():
        (folder / f"{name}.wasm").write_bytes(content)
    command = [NODE, str(TESTS / "fly.mjs"), str(folder), json.dumps(flights)]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


@pytest.fixture(scope="module")
def flown(built: modules.Modules, tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    return under_node(tmp_path_factory.mktemp("node"), built, FLIGHTS)


def test_size(built: modules.Modules) -> None:
    assert len(built.goe) <= MOST_BYTES


def test_the_readme_states_the_sizes(built: modules.Modules) -> None:
    text = (ROOT / "port" / "wasm" / "README.md").read_text(encoding="utf-8")
    printed = dict(re.findall(r"^\| `(\w+)\.wasm` \| ([\d,]+) \|", text, re.MULTILINE))
    assert set(printed) == {"goe", "flight", "golden"}
    for name, size in printed.items():
        assert abs(len(getattr(built, name)) / int(size.replace(",", "")) - 1.0) < 0.02, name


def numbers(text: str, form: str) -> dict[str, float]:
    return {name: float(value) for name, value in re.findall(form, text, re.MULTILINE)}


def test_numbers_that_are_stated_twice_agree() -> None:
    """The intent in README.md and the rule of the library; camera and margin as the page draws them."""
    port = ROOT / "port" / "wasm"
    define, const = r"#define (\w+) ([\d.]+)f?\b", r"\b([A-Z_]+) = ([\d.]+)"
    rule = numbers((port / "live.c").read_text(encoding="utf-8"), define)
    assert set(rule) == {"MARGIN_M", "CLEARANCE_M"}
    plan = f"{rule['MARGIN_M']}f, {rule['CLEARANCE_M']}f, since_s, 0.0f}}; /* margin, clearance, m */"
    assert plan in (ROOT / "README.md").read_text(encoding="utf-8")
    source = (ROOT / "lib" / "hazard" / "goe_decide.c").read_text(encoding="utf-8")
    (defaults,) = re.findall(r"by_default = \{(.*)f\};", source)
    conflict_probability_max, act_within_s, suspect_factor, stale_growth_m_s = map(float, defaults.split("f, "))
    words = (
        f"within {rule['MARGIN_M']:g} m to the side and {rule['CLEARANCE_M']:g} m above the top "
        f"with a probability of at least {100 * conflict_probability_max:g} %, "
        f"and may reach the obstacle within {act_within_s:g} s. "
        f"Both distances are {suspect_factor:g} times as large while the estimate is suspect, "
        f"and grow by {stale_growth_m_s:g} m for each second without a new estimate."
    )
    assert words in (port / "page" / "page.html.j2").read_text(encoding="utf-8")
    approach = numbers((port / "approach.h").read_text(encoding="utf-8"), define)
    camera = numbers((port / "page" / "camera.mjs").read_text(encoding="utf-8"), const)
    assert approach["APPROACH_IMAGE_WIDTH_PX"] == camera["WIDTH"]
    assert approach["APPROACH_IMAGE_HEIGHT_PX"] == camera["HEIGHT"]
    assert approach["APPROACH_FOCAL_PX"] == camera["FOCAL"]
    drawn = numbers((port / "page" / "map.mjs").read_text(encoding="utf-8"), const)
    assert drawn["MARGIN_M"] == rule["MARGIN_M"]


def test_the_modules_import_nothing_from_the_host(flown: dict[str, Any]) -> None:
    assert flown["imports"] == []
    assert set(flown["flightImports"]) <= set(flown["exports"])
    assert {"memory", "goe_init", "goe_update", "goe_covariance", "goe_hazard", "goe_reset"} <= set(flown["exports"])
    header = (ROOT / "lib" / "goe.h").read_text(encoding="utf-8")
    assert flown["version"] == ".".join(re.findall(r"#define GOE_VERSION_(?:MAJOR|MINOR|PATCH) (\d+)", header))


def test_golden_hash(flown: dict[str, Any]) -> None:
    """[A13]"""
    assert flown["selfCheck"] == 0
    assert flown["hash"] == page.golden_hash()


def test_a_wrong_bit_is_reported(built: modules.Modules, tmp_path: Path) -> None:
    """One bit of degrees per radian, wherever the module contains the constant; and bits of the logs."""
    constant = struct.pack("<f", 57.2957795)
    assert constant in built.goe
    wrong = [replace(built, goe=built.goe.replace(constant, bytes([constant[0] ^ 1]) + constant[1:]))]
    logs = built.golden.index(struct.pack("<fff", 120.0, -75.0, -25.0))  # position, then height of the first image
    for at in (logs, logs + 5, logs + 14):
        wrong.append(replace(built, golden=built.golden[:at] + bytes([built.golden[at] ^ 1]) + built.golden[at + 1 :]))
    hashes = {under_node(tmp_path, spoiled)["hash"] for spoiled in wrong}
    assert len(hashes) == len(wrong) and page.golden_hash() not in hashes


def test_flights_are_those_of_c(flown: dict[str, Any], tmp_path: Path) -> None:
    program = tmp_path / "fly"
    port = ROOT / "port" / "wasm"
    sources = [*(ROOT / "lib").rglob("*.c"), port / "live.c", port / "approach.c", TESTS / "fly_main.c"]
    flags = ["-std=c99", "-O0", "-ffp-contract=off", "-fno-math-errno", f"-I{ROOT / 'lib'}", f"-I{port}"]
    subprocess.run(["cc", *flags, *map(str, sources), "-o", str(program), "-lm"], check=True)
    for controls, lines in zip(FLIGHTS, flown["flights"]):
        printed = subprocess.run([program, *map(str, controls)], capture_output=True, text=True, check=True).stdout
        assert printed.splitlines() == lines, controls
    assert len({line for lines in flown["flights"] for line in lines}) > 1000


def reports(lines: list[str]) -> list[dict[str, float]]:
    """By the names of live.h."""
    header = (ROOT / "port" / "wasm" / "live.h").read_text(encoding="utf-8")
    names = re.findall(r"X\((\w+)\)", header.split("#define LIVE_FIELDS(X)")[1].split("/*")[0])
    return [dict(zip(names, struct.unpack(f">{len(names)}f", bytes.fromhex(line.split()[0])))) for line in lines]


FAIR_NOISE_PX = 3.0  # of the detector; a larger one, which is not configured, makes boxes larger than they can be
NOTHING_KNOWN, CLEAR, IN_DOUBT, GO_AROUND, UNCERTAIN = range(5)  # the order in live.h


def order_after(before: float, r: dict[str, float]) -> float:
    """By the definitions of goe_decide and of live.h; only "clear" ends an order to go around."""
    if int(r["valid"]) & 1 == 0:
        return before
    uncertain = before if before == GO_AROUND else UNCERTAIN
    doubt = 1.5 if r["suspect"] else 1.0
    if r["conflict_probability"] < 0.1:
        aside = r["dcpa_m"] - r["dcpa_sd_m"] >= 15.0 * doubt + r["age_s"]
        above = r["has_clearance"] and r["clearance_m"] - r["clearance_sd_m"] >= 10.0 * doubt + r["age_s"]
        return CLEAR if aside or above else uncertain
    if r["tcpa_s"] ** 2 <= 12.0 * (r["tcpa_s"] + 2.0 * r["tcpa_sd_s"]):
        return GO_AROUND
    return IN_DOUBT if r["tcpa_s"] - 2.0 * r["tcpa_sd_s"] > 12.0 else uncertain


def test_orders_are_those_of_the_decision_rule(flown: dict[str, Any]) -> None:
    """Nothing is clear while the obstacle is larger in the image than it can be at its range. A report does not state
    this, but an obstacle that stands still seldom is so large, unless the detector is noisier than configured."""
    seen: dict[float, int] = {}
    doubted = 0
    for controls, lines in zip(FLIGHTS, flown["flights"]):
        before = float(NOTHING_KNOWN)
        for r in reports(lines):
            expected = order_after(before, r)
            old = r["age_s"] > 2.0 and before != GO_AROUND  # of detections without an answer
            doubt = before if before == GO_AROUND else UNCERTAIN
            outgrown = r["order"] == doubt and expected in (CLEAR, IN_DOUBT)
            assert r["order"] == expected or outgrown or (old and r["order"] == UNCERTAIN)
            doubted += outgrown and not old and controls[3] <= FAIR_NOISE_PX
            before = r["order"]
            seen[before] = seen.get(before, 0) + 1
    assert set(seen) == {NOTHING_KNOWN, CLEAR, IN_DOUBT, GO_AROUND, UNCERTAIN}
    assert doubted < 0.1 * (seen[CLEAR] + seen[IN_DOUBT])


def test_bad_command_lines(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    assert main(["live", "--out", str(tmp_path)]) == EXIT_BAD_INPUT
    assert "is a folder" in capsys.readouterr().err
    (tmp_path / "file").touch()
    assert main(["live", "--out", str(tmp_path / "file" / "page.html")]) == EXIT_BAD_INPUT
    assert f"{tmp_path / 'file'}: File exists" in capsys.readouterr().err
    monkeypatch.setenv("PATH", str(tmp_path))
    assert main(["live", "--out", str(tmp_path / "page.html")]) == EXIT_BAD_INPUT
    assert "needs cmake, ninja, clang-19, wasm-ld-19, wasm-opt" in capsys.readouterr().err


def test_a_broken_build_is_reported(tmp_path: Path) -> None:
    if modules.missing():
        pytest.skip("needs the compiler")
    (tmp_path / "CMakeCache.txt").write_text("broken")
    with pytest.raises(ValueError, match="exit status"):
        modules.build(tmp_path)


def test_scripts_are_joined(tmp_path: Path) -> None:
    (tmp_path / "a.mjs").write_text('import { two } from "./b.mjs";\nexport const four = two + two;\n')
    (tmp_path / "b.mjs").write_text("const one = 1;\nexport const two = one + one;\n")
    text = page.joined(tmp_path / "a.mjs")
    assert text.index("const module_b") < text.index("const { two } = module_b;") < text.index("return { four }")
    (tmp_path / "a.mjs").write_text('import * as b from "./b.mjs";\n')
    with pytest.raises(ValueError, match=r"import \* as b"):
        page.joined(tmp_path / "a.mjs")

"""port/zephyr without Zephyr: its CMake files, Kconfig, sample and test, with stand-ins for the tree's files."""

from __future__ import annotations

import json
import os
import re
import subprocess
from pathlib import Path
from typing import Any

import pytest
import yaml
from kconfig_of import ROOT, ZEPHYR, apply, parse, write
from scripted import assert_flown

STAND_IN = Path(__file__).resolve().parent / "zephyr"
SAMPLE = ZEPHYR / "samples" / "sensor_loop"
GOLDEN_BITS = ZEPHYR / "tests" / "golden_bits"
SECONDS = 1800  # guard against a hang

# Keys of module.yml in Zephyr 3.4.0, compared on 2026-11-22.
MODULE_KEYS = {"name", "build", "tests", "samples", "boards", "blobs"}
BUILD_KEYS = {"cmake", "kconfig", "cmake-ext", "kconfig-ext", "depends", "settings"} | {
    f"sysbuild-{key}" for key in ("cmake", "kconfig", "cmake-ext", "kconfig-ext")
}
# ... and the used keys of sample.yaml and testcase.yaml.
SCENARIO_KEYS = {
    "tags", "platform_allow", "timeout", "harness", "harness_config", "filter", "extra_configs", "min_flash", "min_ram",
}  # fmt: skip


def run(*words: str | Path, **environment: str) -> str:
    done = subprocess.run(
        [str(word) for word in words], env={**os.environ, **environment}, stdin=subprocess.DEVNULL, capture_output=True,
        text=True, timeout=SECONDS,
    )  # fmt: skip
    assert done.returncode == 0, f"{words}: exit status {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout


def configure(application: Path, folder: Path, *assignments: str, flags: str = "-O0") -> Path:
    """Configures, and returns the build folder. Kconfig's values are those of prj.conf and the assignments."""
    parsed = parse(ZEPHYR, folder)
    apply(parsed, [*(application / "prj.conf").read_text().splitlines(), *assignments])
    write(parsed, folder, '#define CONFIG_BOARD "host"\n#define CONFIG_KERNEL_INIT_PRIORITY_DEFAULT 40\n')
    run(
        "cmake", "-G", "Ninja", "-S", application, "-B", folder / "build", f"-DSTAND_IN_CONFIG={folder}",
        f"-DCMAKE_C_FLAGS={flags}", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", ZEPHYR_BASE=str(STAND_IN),
    )  # fmt: skip
    return folder / "build"


def build(application: Path, folder: Path, *assignments: str, flags: str = "-O0", link: str = "") -> Path:
    """Builds, and returns the program."""
    tree = configure(application, folder, *assignments, flags=flags)
    run("cmake", f"-DCMAKE_EXE_LINKER_FLAGS={link}", tree)
    run("cmake", "--build", tree, "-j", "2")
    return tree / "app"


def compiled(tree: Path) -> dict[str, str]:
    """The command of each file of this repository, by its path there."""
    commands = json.loads((tree / "compile_commands.json").read_text())
    paths = {str(Path(entry["file"]).resolve()): entry["command"] for entry in commands}
    return {str(Path(path).relative_to(ROOT)): command for path, command in paths.items()}


def scenarios(page: Path) -> dict[str, dict[str, Any]]:
    """The scenarios of sample.yaml or testcase.yaml, each with the common part."""
    read = yaml.safe_load(page.read_text())
    common = read.get("common", {})
    return {
        name: {**common, **own, "extra_configs": [*common.get("extra_configs", []), *own.get("extra_configs", [])]}
        for name, own in read["tests"].items()
    }


def said_by(page: Path) -> list[str]:
    """Regular expressions of a run's output; they are the same for every scenario."""
    (expected,) = {json.dumps(scenario["harness_config"]) for scenario in scenarios(page).values()}
    config = json.loads(expected)
    assert config["type"] == "multi_line" and config["ordered"]
    return config["regex"]


def assert_said(page: Path, text: str) -> None:
    lines = iter(line.strip() for line in text.splitlines())  # as twister does
    for pattern in said_by(page):
        assert any(re.search(pattern, line) for line in lines), f"{pattern} is missing, or in another order, in\n{text}"


@pytest.fixture(scope="module")
def sample(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return build(SAMPLE, tmp_path_factory.mktemp("sample"))


# ------------------------------------------------------------------------------------------------------------ manifests


def test_module_file() -> None:
    module = yaml.safe_load((ZEPHYR / "zephyr" / "module.yml").read_text())
    assert set(module) <= MODULE_KEYS and set(module["build"]) <= BUILD_KEYS
    assert module["name"] == "goe"
    assert (ZEPHYR / module["build"]["cmake"] / "CMakeLists.txt").is_file()
    assert (ZEPHYR / module["build"]["kconfig"]).is_file()
    for key, page in (("samples", "sample.yaml"), ("tests", "testcase.yaml")):
        assert all(list((ZEPHYR / folder).glob(f"*/{page}")) for folder in module[key])


@pytest.mark.parametrize("page", [SAMPLE / "sample.yaml", GOLDEN_BITS / "testcase.yaml"], ids=lambda page: page.name)
def test_scenarios_set_known_options(page: Path, tmp_path: Path) -> None:
    libraries = set()
    for name, scenario in scenarios(page).items():
        assert name.startswith("goe.") and set(scenario) <= SCENARIO_KEYS
        parsed = parse(ZEPHYR, tmp_path)
        apply(parsed, [*(page.parent / "prj.conf").read_text().splitlines(), *scenario["extra_configs"]])
        libraries |= set(scenario["extra_configs"])
    assert {f"CONFIG_{library}=y" for library in ("MINIMAL_LIBC", "NEWLIB_LIBC", "PICOLIBC")} <= libraries


# ---------------------------------------------------------------------------------------------------------- the module


def test_every_source_is_in_the_library(tmp_path: Path) -> None:
    found = compiled(configure(SAMPLE, tmp_path, "CONFIG_GOE_MAVLINK=y", "CONFIG_MINIMAL_LIBC=y"))
    folders = ("lib", "port/flight", "port/mavlink", "port/sqrtf")
    wanted = {str(file.relative_to(ROOT)) for folder in folders for file in (ROOT / folder).rglob("*.c")}
    assert wanted <= set(found)
    for file in wanted:
        assert "-ffp-contract=off" in found[file] and "-DGOE_FLIGHT_SLOTS=4" in found[file]
        assert "-Dsqrtf=goe_sqrtf" in found[file]
    assert "-Dsqrtf" not in found["port/zephyr/samples/sensor_loop/src/main.c"]
    assert "-DGOE_FLIGHT_SLOTS=4" in found["port/zephyr/samples/sensor_loop/src/main.c"]


def test_floats_are_not_vectorised_where_helium_would_flush_them(tmp_path: Path) -> None:
    flags = "-fno-tree-vectorize -fno-tree-slp-vectorize"
    for value in "yn":
        (tmp_path / value).mkdir()
        found = compiled(configure(SAMPLE, tmp_path / value, f"CONFIG_ARMV8_1_M_MVEF={value}"))
        assert (flags in found["lib/goe_estimator.c"]) == (value == "y")


def test_parts_left_out(tmp_path: Path) -> None:
    off = ("GOE_WITH_FILTER", "GOE_WITH_HAZARD", "GOE_SELF_CHECK")
    found = compiled(configure(SAMPLE, tmp_path, *(f"CONFIG_{name}=n" for name in off), "CONFIG_GOE_WINDOW_MAX=5"))
    assert not any(file.startswith(("port/flight", "port/mavlink", "port/sqrtf")) for file in found)
    assert "port/zephyr/goe_start.c" not in found
    command = found["lib/goe_estimator.c"]
    assert "-DGOE_WINDOW_MAX=5" in command and "GOE_FLIGHT_SLOTS" not in command
    parts = {"WINDOW": 1, "FILTER": 0, "TARGET_MOTION": 0, "HAZARD": 0}
    assert all(f"-DGOE_WITH_{part}={value} " in command for part, value in parts.items())


def test_golden_bits(tmp_path: Path) -> None:
    """With the square root that a build with the minimal C library gets."""
    page = GOLDEN_BITS / "testcase.yaml"
    program = build(GOLDEN_BITS, tmp_path, "CONFIG_MINIMAL_LIBC=y", flags="-O1 -DGOE_SQRTF_IN_INTEGERS")
    assert_said(page, run(program))
    for file in ("golden_hash.txt", "flight_hash.txt"):
        (golden,) = (ROOT / "tests" / "targets" / file).read_text().split()
        assert any(golden in pattern for pattern in said_by(page))


@pytest.mark.release
def test_wrong_arithmetic_is_reported_at_start(tmp_path: Path) -> None:
    text = run(build(SAMPLE, tmp_path, flags="-O1 -ffast-math"))
    assert re.match(r"goe: goe_self_check\(\) returned 0x(?!00)..: ", text)


# ---------------------------------------------------------------------------------------------------------- the sample


def test_sample_prints_the_lines_of_its_pages(sample: Path) -> None:
    text = run(sample)
    assert_said(SAMPLE / "sample.yaml", text)
    assert_flown(text)
    assert "\nimages 135, dropped 0; messages lost 0\n" in text


@pytest.mark.release
def test_sample_with_a_shared_floating_point_unit(tmp_path: Path) -> None:
    assert_flown(run(build(SAMPLE, tmp_path, "CONFIG_FPU=y", "CONFIG_FPU_SHARING=y", "CONFIG_MINIMAL_LIBC=y")))


@pytest.mark.release
def test_sample_ends_if_the_layer_does_not_start(tmp_path: Path) -> None:
    lines = run(build(SAMPLE, tmp_path, link="-Wl,--wrap=goe_flight_init")).splitlines()
    assert lines[1:] == ["goe: no start: status -32, setting (none)", "done"]


def test_sample_survives_an_estimator_that_is_too_slow(sample: Path) -> None:
    text = run(sample, STAND_IN_HURRY="1")
    (lost,) = re.findall(r"messages lost (\d+)\n", text)
    assert int(lost) > 0
    assert text.splitlines()[-1] == "done"

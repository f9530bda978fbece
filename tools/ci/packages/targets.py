"""Content of each package. A target fills one or more subfolders of the staging folder."""

from __future__ import annotations

import re
import zipfile
from collections.abc import Callable
from pathlib import Path

from .facts import Facts
from .staging import Stage, Words, render

CONFIG = '#ifndef GOE_CONFIG_HEADER\n#define GOE_CONFIG_HEADER "goe_config.h"\n#endif\n'
CONFIG_PLACE = "#ifdef GOE_CONFIG_HEADER\n#include GOE_CONFIG_HEADER\n#endif\n"
# Boards with 32 bits or more: AVR has 16-bit int and too little memory.
ARDUINO_CORES = (
    "esp32", "esp8266", "mbed", "mbed_giga", "mbed_nano", "mbed_nicla", "mbed_opta", "mbed_portenta", "mbed_rp2040",
    "nrf52", "renesas", "renesas_portenta", "renesas_uno", "rp2040", "sam", "samd", "stm32", "teensy", "zephyr",
)  # fmt: skip
PLATFORMIO_PLATFORMS = (
    "atmelsam", "espressif32", "espressif8266", "freescalekinetis", "gd32v", "maxim32", "native", "nordicnrf51",
    "nordicnrf52", "nxpimxrt", "nxplpc", "raspberrypi", "renesas-ra", "sifive", "siliconlabsefm32", "ststm32", "teensy",
    "titiva",
)  # fmt: skip
CONAN_LIMITS = ("GOE_WINDOW_MAX", "GOE_CAMERAS_MAX")  # the project's build has no option for the flight layer's slots
ZIP_DATE = (1980, 1, 1, 0, 0, 0)  # gives the same bytes at any time


def cargo_manifest(facts: Facts) -> str:
    return render(facts, "rust/Cargo.toml.j2", packed=False)


def python_manifest(facts: Facts) -> str:
    return render(facts, "python/pyproject.toml.j2", packed=False)


CLASS_ROW = re.compile(
    r'^ {4}\{"(\w+)", \{([\d.]+)f, ([\d.]+)f\}, \{([\d.]+)f, ([\d.]+)f\}, GOE_KIND_(\w+)\},', re.MULTILINE
)
SIGMA_OF_SPAN = re.compile(r"^#define SIGMA_OF_SPAN ([\d.]+)f", re.MULTILINE)


def python_kinds(facts: Facts) -> str:
    """The companion's table of classes."""
    text = (facts.root / "port/companion/obstacle_class.c").read_text(encoding="utf-8")
    rows, sigma = CLASS_ROW.findall(text), SIGMA_OF_SPAN.findall(text)
    if len(rows) != text.count(", GOE_KIND_") or not rows or len(sigma) != 1:
        raise ValueError("port/companion/obstacle_class.c: its table is not understood")
    return "".join(
        [
            '"""Sizes of usual classes, from the companion\'s obstacle_class.c, which names their origin.\n\n',
            'Made by `python -m ci packages --write`; do not edit.\n"""\n\n',
            f"SIGMA_OF_SPAN = {sigma[0]}\n",
            "CLASSES = {  # name: (least, greatest width), (least, greatest height), shape; m; 0: unknown\n",
            *(f'    "{name}": (({a}, {b}), ({c}, {d}), "{shape}"),\n' for name, a, b, c, d, shape in rows),
            "}\n",
        ]
    )


def tools_manifest(facts: Facts) -> str:
    """The tools' manifest, written by hand except for the version."""
    text = (facts.root / TOOLS).read_text(encoding="utf-8")
    text, count = re.subn(r'^version = ".*"$', f'version = "{facts.version}"', text, flags=re.MULTILINE)
    if count != 1:
        raise ValueError(f"{TOOLS}: needs exactly one line with the version")
    return text


TOOLS = "tools/pyproject.toml"
# Manifests in the tree, and their content.
COMMITTED: dict[str, Callable[[Facts], str]] = {
    "port/python/pyproject.toml": python_manifest,
    "port/rust/Cargo.toml": cargo_manifest,
    TOOLS: tools_manifest,
}
# Tables in the tree that are not of a version, and their content.
TABLES: dict[str, Callable[[Facts], str]] = {"port/python/src/goe/_kinds.py": python_kinds}


def rust(facts: Facts, words: Words, folder: Path) -> list[Path]:
    stage = Stage(facts, words, folder / "goe")
    for name in ("src", "tests", "examples"):
        stage.copy_tree(f"port/rust/{name}", name)
    for name in ("build.rs", "rustfmt.toml"):
        stage.copy(f"port/rust/{name}", name)
    stage.render("Cargo.toml", "rust/Cargo.toml.j2", packed=True)
    stage.copy_library("csrc/lib")
    stage.copy_flight("csrc/flight")
    stage.copy_page("rust")
    return [stage.folder]


def python(facts: Facts, words: Words, folder: Path) -> list[Path]:
    stage = Stage(facts, words, folder / "goe")
    for name in ("src", "examples"):
        stage.copy_tree(f"port/python/{name}", name)
    glue = facts.root / "port" / "python" / "csrc"
    stage.copy_files("port/python/csrc", tuple(path.name for path in sorted(glue.iterdir()) if path.is_file()), "csrc")
    for name in ("CMakeLists.txt", "bindings.py"):
        stage.copy(f"port/python/{name}", name)
    stage.copy("port/cmake/goe_compile.cmake", "csrc/cmake/goe_compile.cmake")
    stage.render("pyproject.toml", "python/pyproject.toml.j2", packed=True)
    stage.copy_library("csrc/lib")
    stage.copy_flight("csrc/flight")
    stage.copy_page("python")
    return [stage.folder]


def zip_folder(folder: Path, version: str) -> Path:
    """The format of the Arduino IDE: one folder in an archive."""
    place = folder.parent / f"{folder.name}-{version}.zip"
    with zipfile.ZipFile(place, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted(folder.rglob("*")):
            if path.is_file():
                info = zipfile.ZipInfo(path.relative_to(folder.parent).as_posix(), ZIP_DATE)
                info.external_attr = 0o644 << 16
                info.compress_type = zipfile.ZIP_DEFLATED
                archive.writestr(info, path.read_bytes())
    return place


def arduino(facts: Facts, words: Words, folder: Path) -> list[Path]:
    """Two libraries, since Arduino compiles only included ones. A header selects the parts, since Arduino gives a
    library no flags."""
    goe = Stage(facts, words, folder / "goe")
    goe.copy_library("src")
    limits = (facts.root / "lib" / "goe_limits.h").read_text(encoding="utf-8")
    if limits.count(CONFIG_PLACE) != 1:
        raise ValueError("lib/goe_limits.h: no place for GOE_CONFIG_HEADER")
    goe.write("src/goe_limits.h", limits.replace(CONFIG_PLACE, CONFIG + CONFIG_PLACE))
    goe.render("src/goe_config.h", "arduino/goe_config.h.j2")
    goe.copy_tree("port/arduino/examples", "examples")
    goe.render("library.properties", "arduino/library.properties.j2", flight=False, architectures=ARDUINO_CORES)
    goe.copy_page("arduino")
    flight = Stage(facts, words, folder / "goe_flight")
    flight.copy_flight("src")
    flight.render("library.properties", "arduino/library.properties.j2", flight=True, architectures=ARDUINO_CORES)
    flight.copy_page("arduino")
    for stage in (goe, flight):
        zip_folder(stage.folder, facts.version)
    return [goe.folder, flight.folder]


def platformio(facts: Facts, words: Words, folder: Path) -> list[Path]:
    """Two libraries, since the dependency finder compiles everything it finds."""
    goe = Stage(facts, words, folder / "goe")
    goe.copy_library("src")
    goe.render("library.json", "platformio/library.json.j2", flight=False, platforms=PLATFORMIO_PLATFORMS)
    goe.copy_page("platformio")
    flight = Stage(facts, words, folder / "goe_flight")
    flight.copy_flight("src")
    flight.render("library.json", "platformio/library.json.j2", flight=True, platforms=PLATFORMIO_PLATFORMS)
    flight.copy_page("platformio")
    return [goe.folder, flight.folder]


def esp_idf(facts: Facts, words: Words, folder: Path) -> list[Path]:
    stage = Stage(facts, words, folder / "goe")
    stage.copy_library("lib")
    stage.copy_flight("flight")
    for name in ("CMakeLists.txt", "Kconfig", "idf_component.yml"):
        stage.render(name, f"esp-idf/{name}.j2")
    stage.copy_tree("port/esp-idf/examples", "examples")
    stage.copy_page("esp-idf")
    return [stage.folder]


def conan(facts: Facts, words: Words, folder: Path) -> list[Path]:
    stage = Stage(facts, words, folder / "goe")
    stage.copy_tree("lib", "lib")
    for name in ("cmake", "flight", "mavlink", "pkgconfig", "debian"):
        stage.copy_tree(f"port/{name}", f"port/{name}")
    stage.copy("CMakeLists.txt", "CMakeLists.txt")
    stage.copy_tree("port/conan/test_package", "test_package")
    limits = [facts.limit(define) for define in CONAN_LIMITS]
    stage.render("conanfile.py", "conan/conanfile.py.j2", limits=limits)
    stage.copy_page("conan")
    return [stage.folder]


TARGETS: dict[str, Callable[[Facts, Words, Path], list[Path]]] = {
    "arduino": arduino,
    "conan": conan,
    "esp-idf": esp_idf,
    "platformio": platformio,
    "python": python,
    "rust": rust,
}

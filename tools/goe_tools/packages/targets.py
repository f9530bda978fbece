"""What each package manager gets. A target fills one folder, or more, of the staging folder's own."""

from __future__ import annotations

import zipfile
from collections.abc import Callable
from pathlib import Path

from .facts import Facts
from .staging import Stage, Words, render

CONFIG = '#ifndef GOE_CONFIG_HEADER\n#define GOE_CONFIG_HEADER "goe_config.h"\n#endif\n'
CONFIG_PLACE = "#ifdef GOE_CONFIG_HEADER\n#include GOE_CONFIG_HEADER\n#endif\n"
ZIP_DATE = (1980, 1, 1, 0, 0, 0)  # the same bytes whenever it is made

COMMITTED = {"port/rust/Cargo.toml": "rust/Cargo.toml.j2"}  # manifests that lie in the tree, and their templates


def committed_text(facts: Facts, name: str) -> str:
    return render(facts, COMMITTED[name], packed=False)


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


def zip_folder(folder: Path, version: str) -> Path:
    """What the Arduino IDE takes: one folder in an archive."""
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
    """Two libraries: what a sketch does not include is not compiled. The parts are in a header, as Arduino gives a
    library no flags of its own."""
    goe = Stage(facts, words, folder / "goe")
    goe.copy_library("src")
    if facts.header.count(CONFIG_PLACE) != 1:
        raise ValueError("lib/goe.h: the place of GOE_CONFIG_HEADER is not there")
    goe.write("src/goe.h", facts.header.replace(CONFIG_PLACE, CONFIG + CONFIG_PLACE))
    goe.render("src/goe_config.h", "arduino/goe_config.h.j2")
    goe.copy_tree("port/arduino/examples", "examples")
    goe.render("library.properties", "arduino/library.properties.j2", flight=False)
    goe.copy_page("arduino")
    flight = Stage(facts, words, folder / "goe_flight")
    flight.copy_flight("src")
    flight.render("library.properties", "arduino/library.properties.j2", flight=True)
    flight.copy_page("arduino")
    for stage in (goe, flight):
        zip_folder(stage.folder, facts.version)
    return [goe.folder, flight.folder]


def platformio(facts: Facts, words: Words, folder: Path) -> list[Path]:
    """Two libraries, as its dependency finder compiles all of what it finds."""
    goe = Stage(facts, words, folder / "goe")
    goe.copy_library("src")
    goe.render("library.json", "platformio/library.json.j2", flight=False)
    goe.copy_page("platformio")
    flight = Stage(facts, words, folder / "goe_flight")
    flight.copy_flight("src")
    flight.render("library.json", "platformio/library.json.j2", flight=True)
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
    stage.copy_tree("lib", "lib", ("*.md",))
    for name in ("cmake", "flight", "mavlink", "pkgconfig", "debian"):
        stage.copy_tree(f"port/{name}", f"port/{name}", ("*.md",))
    stage.copy("CMakeLists.txt", "CMakeLists.txt")
    stage.copy_tree("port/conan/test_package", "test_package")
    stage.render("conanfile.py", "conan/conanfile.py.j2")
    stage.copy_page("conan")
    return [stage.folder]


TARGETS: dict[str, Callable[[Facts, Words, Path], list[Path]]] = {
    "arduino": arduino,
    "conan": conan,
    "esp-idf": esp_idf,
    "platformio": platformio,
    "rust": rust,
}

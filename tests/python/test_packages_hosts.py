"""Packages as their hosts would build them: include paths, options, consumers, without the hosts themselves."""

from __future__ import annotations

import gzip
import os
import re
import shlex
import shutil
import subprocess
from pathlib import Path

import pytest
from ci.__main__ import main
from ci.packages.facts import Facts

pytestmark = pytest.mark.release  # packaging

ROOT = Path(__file__).resolve().parents[2]
FACTS = Facts()
CONSUMER = ROOT / "tests" / "consumer_package" / "main.c"
STARTS = ROOT / "port" / "conan" / "test_package" / "main.c"  # exits with 0 if header and library agree
ARM = ("arm-none-eabi-gcc", "-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard")
SECONDS = 1800  # guard against a hang
MAINTAINER = "NAME <maintainer@goe.invalid>"

# The names from Arduino.h that may collide with a library's, in a minimal header of our own.
ARDUINO_H = """
#include <stdint.h>
#include <stdlib.h>
#define PI 3.1415926535897932384626433832795
#define HIGH 0x1
#define LOW 0x0
#define INPUT 0x0
#define DEG_TO_RAD 0.017453292519943295769236907684886
#define HEX 16
#define min(a, b) ((a) < (b) ? (a) : (b))
#define max(a, b) ((a) > (b) ? (a) : (b))
#define abs(x) ((x) > 0 ? (x) : -(x))
#define round(x) ((x) >= 0 ? (long)((x) + 0.5) : (long)((x) - 0.5))
#define sq(x) ((x) * (x))
#define bit(b) (1UL << (b))
#define F(text) (text)
#define B0 0
typedef bool boolean;
typedef uint8_t byte;
struct Printer {
    void begin(unsigned long) {}
    void print(const char *) {}
    void print(float) {}
    void println(unsigned, int) {}
    void println(const char *) {}
    void println() {}
};
static Printer Serial;
static inline void delay(unsigned long) {}
"""


def run(*words: str | Path, folder: Path = ROOT, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [str(word) for word in words], cwd=folder, env={**os.environ, **environment}, capture_output=True, text=True,
        timeout=SECONDS,
    )  # fmt: skip


def passed(*words: str | Path, folder: Path = ROOT, **environment: str) -> str:
    done = run(*words, folder=folder, **environment)
    assert done.returncode == 0, f"{words}: exit status {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout


def need(*programs: str) -> None:
    for program in programs:
        if not shutil.which(program):
            pytest.skip(f"no {program}")


@pytest.fixture(scope="module")
def staged(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("packages") / "out"
    assert main(["packages", "--out", str(folder)]) == 0
    return folder


# ----------------------------------------------------------------------------------------- Arduino and PlatformIO: flat


def compile_all(folder: Path, out: Path, compiler: tuple[str, ...], *flags: str) -> None:
    """Compiles every source below src with the hosts' include paths, at -O0 to save time."""
    out.mkdir()
    sources = sorted((folder / "src").rglob("*.c"))
    assert sources
    includes = [f"-I{path}" for path in sorted(folder.parent.glob("*/src"))]
    passed(*compiler, "-std=gnu11", "-O0", "-Wall", "-Wextra", "-Werror", *includes, *flags, "-c", *sources, folder=out)


def test_arduino_libraries_and_sketch(staged: Path, tmp_path: Path) -> None:
    compiler = ARM if shutil.which(ARM[0]) else ("cc",)
    for name in ("goe", "goe_flight"):
        compile_all(staged / "arduino" / name, tmp_path / name, compiler, "-fsyntax-only")
    sketch = staged / "arduino" / "goe" / "examples" / "Approach" / "Approach.ino"
    (tmp_path / "Arduino.h").write_text(ARDUINO_H)
    (tmp_path / "sketch.cpp").write_text(f"#include <Arduino.h>\n{sketch.read_text()}\n#include <goe_flight.h>\n")
    includes = [f"-I{path}" for path in (tmp_path, *sorted((staged / "arduino").glob("*/src")))]
    need("g++")
    for standard in ("gnu++11", "gnu++17"):
        passed("g++", f"-std={standard}", "-fno-exceptions", "-Wall", "-Werror", *includes, "-fsyntax-only",
               tmp_path / "sketch.cpp")  # fmt: skip


def test_arduino_part_left_out_by_the_header(staged: Path, tmp_path: Path) -> None:
    """As the page describes: edit goe_config.h. The sketch and the library then have the same estimator."""
    shutil.copytree(staged / "arduino" / "goe", tmp_path / "goe")
    config = tmp_path / "goe" / "src" / "goe_config.h"
    text = config.read_text()
    for part in ("WINDOW", "TARGET_MOTION"):
        text = text.replace(f"#define GOE_WITH_{part} 1", f"#define GOE_WITH_{part} 0")
    config.write_text(text)
    compile_all(tmp_path / "goe", tmp_path / "objects", ("cc",))
    objects = sorted((tmp_path / "objects").glob("*.o"))
    passed("cc", f"-I{config.parent}", STARTS, *objects, "-lm", "-o", tmp_path / "starts")
    assert ": ok, 1400 bytes," in passed(tmp_path / "starts")


def test_platformio_libraries_and_flags(staged: Path, tmp_path: Path) -> None:
    """build_flags apply to the project and its libraries. Without the hazard the flight layer is not included."""
    flags = ("-DGOE_WITH_HAZARD=0", "-DGOE_WINDOW_MAX=16", "-ffp-contract=off")
    compile_all(staged / "platformio" / "goe", tmp_path / "goe", ("cc",), *flags)
    objects = sorted((tmp_path / "goe").glob("*.o"))
    include = f"-I{staged / 'platformio' / 'goe' / 'src'}"
    passed("cc", include, *flags[:2], STARTS, *objects, "-lm", "-o", tmp_path / "starts")
    assert ": ok, 2416 bytes," in passed(tmp_path / "starts")
    compile_all(staged / "platformio" / "goe_flight", tmp_path / "flight", ("cc",), "-fsyntax-only")


# -------------------------------------------------------------------------------------------------------------- ESP-IDF

IDF = """
cmake_minimum_required(VERSION 3.16)
project(stand_in C)
function(idf_component_register)
    cmake_parse_arguments(PARSE_ARGV 0 arg "" "" "SRCS;INCLUDE_DIRS;REQUIRES;PRIV_REQUIRES")
    add_library(component STATIC ${arg_SRCS})
    target_include_directories(component PUBLIC ${arg_INCLUDE_DIRS})
    set(COMPONENT_LIB component PARENT_SCOPE)
endfunction()
include(sdkconfig.cmake)
add_subdirectory(${COMPONENT} component)
add_executable(consumer ${CONSUMER})
target_link_libraries(consumer PRIVATE component m)
"""
RUNS = "void app_main(void);\nint main(void) {\n    app_main();\n    return 0;\n}\n"


def build_component(folder: Path, component: Path, consumer: str, config: dict[str, str]) -> Path:
    need("cmake")
    folder.mkdir()
    (folder / "CMakeLists.txt").write_text(IDF)
    lines = [f'set(CONFIG_{name} "{value}")\n' for name, value in config.items()]
    (folder / "sdkconfig.cmake").write_text("".join(lines))
    passed("cmake", "-S", folder, "-B", folder / "build", f"-DCOMPONENT={component}", f"-DCONSUMER={consumer}")
    passed("cmake", "--build", folder / "build", "-j2")
    return folder / "build"


def all_on() -> dict[str, str]:
    """The default sdkconfig: limits, and y for every enabled option."""
    parts = {part.define: "y" for part in FACTS.parts}
    return {**parts, "GOE_FLIGHT": "y", **{limit.define: str(limit.default) for limit in FACTS.limits}}


def test_esp_idf_component_and_example(staged: Path, tmp_path: Path) -> None:
    component = staged / "esp-idf" / "goe"
    (tmp_path / "run.c").write_text(RUNS)
    example = component / "examples" / "approach" / "main" / "approach.c"
    build = build_component(tmp_path / "idf", component, f"{example};{tmp_path / 'run.c'}", all_on())
    lines = passed(build / "consumer").splitlines()
    assert lines[0] == "self check: 0x00" and re.fullmatch(r"ok: 8\d\.\d m ahead, one sigma 1\d\.\d", lines[-1])
    assert "goe_flight_init" in passed("nm", build / "component" / "libcomponent.a")


def test_esp_idf_parts(staged: Path, tmp_path: Path) -> None:
    """Disabled options are not in sdkconfig at all."""
    config = {"GOE_WITH_FILTER": "y", "GOE_WINDOW_MAX": "8", "GOE_CAMERAS_MAX": "1"}
    build = build_component(tmp_path / "idf", staged / "esp-idf" / "goe", str(STARTS), config)
    assert ": ok, 1400 bytes," in passed(build / "consumer")
    names = passed("nm", build / "component" / "libcomponent.a")
    assert "goe_flight_init" not in names and " T goe_hazard" not in names


def test_esp_idf_kconfig(staged: Path, tmp_path: Path) -> None:
    kconfiglib = pytest.importorskip("kconfiglib", reason="no kconfiglib: Kconfig of the ESP-IDF component")
    config = kconfiglib.Kconfig(str(staged / "esp-idf" / "goe" / "Kconfig"), warn_to_stderr=False)
    assert not config.warnings
    symbols = config.syms
    values = {name: symbols[name].str_value for name in all_on()}
    assert values == all_on()
    assert {s.name for s in config.unique_defined_syms} == set(values)
    symbols["GOE_WITH_FILTER"].set_value("n")
    symbols["GOE_WITH_WINDOW"].set_value("n")
    assert symbols["GOE_WITH_WINDOW"].str_value == "y", "no method is left"
    assert symbols["GOE_WITH_TARGET_MOTION"].str_value == "n"
    symbols["GOE_WITH_HAZARD"].set_value("n")
    assert symbols["GOE_FLIGHT"].str_value == "n"
    symbols["GOE_WINDOW_MAX"].set_value("65")
    assert symbols["GOE_WINDOW_MAX"].str_value == "8"


# ------------------------------------------------------------------------------------------------ pkg-config and Debian


@pytest.fixture(scope="module", params=["whole", "parts"])
def built(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory, staged: Path) -> tuple[str, Path]:
    """Built as port/debian/README.md describes: the whole tree, and Conan's copy, whole but without two parts."""
    need("cmake", "cc")
    build = tmp_path_factory.mktemp(request.param) / "build-deb"
    page = (ROOT / "port" / "debian" / "README.md").read_text(encoding="utf-8")
    configure, make, package = re.findall(r"^(cmake .*)$", page, re.MULTILINE)
    assert package == f"{make} --target package" and '"NAME <ADDRESS>"' in configure
    configure = configure.replace("NAME <ADDRESS>", MAINTAINER)
    more = ["-DCMAKE_BUILD_TYPE=Debug"]
    folder = ROOT
    if request.param == "parts":
        more += ["-DGOE_WITH_TARGET_MOTION=OFF", "-DGOE_WITH_WINDOW=OFF"]
        folder = staged / "conan" / "goe"
    passed(*shlex.split(configure.replace("build-deb", str(build))), *more, folder=folder)
    assert not (build / "debian").exists()  # made when it is packed, and only then
    passed(*make.replace("build-deb", str(build)).split(), "-j2")
    return request.param, build


def flags_of(place: Path, package: str, **environment: str) -> list[str]:
    return shlex.split(passed(
        "pkg-config", "--cflags", "--libs", package, PKG_CONFIG_PATH=str(place), PKG_CONFIG_ALLOW_SYSTEM_CFLAGS="1",
        PKG_CONFIG_ALLOW_SYSTEM_LIBS="1", **environment,
    ))  # fmt: skip


def consume(prefix: Path, out: Path, source: Path, package: str, **environment: str) -> str:
    """Builds and runs a consumer with the flags that pkg-config prints for an installation below a folder."""
    need("pkg-config")
    (place,) = {path.parent for path in prefix.rglob("goe*.pc")}
    flags = flags_of(place, package, **environment)
    assert passed("pkg-config", "--modversion", package, PKG_CONFIG_PATH=str(place)).strip() == FACTS.version
    passed("cc", source, *flags, "-o", out)
    return passed(out)


def test_pkg_config(built: tuple[str, Path], tmp_path: Path) -> None:
    name, build = built
    passed("cmake", "--install", build, "--prefix", tmp_path / "stage")
    bytes_of_estimator = {"whole": 2096, "parts": 1400}[name]
    text = consume(tmp_path / "stage", tmp_path / "starts", STARTS, "goe")
    assert text.startswith(f"goe {FACTS.version}: ok, {bytes_of_estimator} bytes, self check 0x00")
    if name == "whole":
        moved = tmp_path / "moved to here"
        (tmp_path / "stage").rename(moved)
        need_pkgconf()
        assert consume(moved, tmp_path / "consumer", CONSUMER, "goe-flight")
        moved.rename(tmp_path / "root")
        sysroot = {"PKG_CONFIG_SYSROOT_DIR": str(tmp_path / "root")}
        assert consume(tmp_path / "root", tmp_path / "consumer", CONSUMER, "goe-flight", **sysroot)


def need_pkgconf() -> None:
    """The older pkg-config handles spaces and sysroots differently."""
    if "pkgconf" not in passed("pkg-config", "--about"):
        pytest.skip("pkg-config is not pkgconf")


def test_pkg_config_of_absolute_folders(tmp_path: Path) -> None:
    """Configured only: reads the generated file."""
    need("cmake", "cc", "pkg-config")
    (tmp_path / "inc").mkdir()
    places = [f"-DCMAKE_INSTALL_{name}={tmp_path / folder}" for name, folder in (("LIBDIR", "lib"), ("PREFIX", "pre"))]
    options = ("-DGOE_BUILD_HOST=OFF", "-DGOE_BUILD_TESTS=OFF")
    passed("cmake", "-S", ROOT, "-B", tmp_path / "build", *places, *options)
    flags = flags_of(tmp_path / "build" / "lib", "goe")
    assert f"-I{tmp_path}/pre/include" in flags and f"-L{tmp_path}/lib" in flags
    relative = "-DCMAKE_INSTALL_LIBDIR=lib"
    passed("cmake", "-S", ROOT, "-B", tmp_path / "build", relative, f"-DCMAKE_INSTALL_INCLUDEDIR={tmp_path / 'inc'}")
    flags = flags_of(tmp_path / "build" / "lib", "goe")
    assert f"-I{tmp_path}/inc" in flags and f"-L{tmp_path}/build/lib/../../lib" in flags


# CMake commands that are newer than the version that the project requires.
NEWER = {
    "COMMAND_ERROR_IS_FATAL": (3, 19), "cmake_path(": (3, 20), "file(COPY_FILE": (3, 21), "ARCHIVE_CREATE": (3, 18),
    "string(JSON": (3, 19), "file(REAL_PATH": (3, 19), "cmake_language(": (3, 18),
}  # fmt: skip


def test_no_words_of_a_newer_cmake() -> None:
    (version,) = re.findall(r"^cmake_minimum_required\(VERSION (\d+)\.(\d+)\)", (ROOT / "CMakeLists.txt").read_text())
    for folder in ("lib", "port", "tests", "sim_host"):
        for path in sorted([*(ROOT / folder).rglob("CMakeLists.txt"), *(ROOT / folder).rglob("*.cmake")]):
            lines = path.read_text(encoding="utf-8")
            found = [word for word, since in NEWER.items() if word in lines and since > tuple(map(int, version))]
            assert not found, f"{path}: {found}"


def test_debian_package(built: tuple[str, Path], tmp_path: Path) -> None:
    name, build = built
    need("cpack", "dpkg-deb")
    passed("cmake", "--build", build, "--target", "package", SOURCE_DATE_EPOCH="1700000000")
    (package,) = build.glob("*.deb")
    architecture = passed("dpkg", "--print-architecture").strip()
    assert package.name == f"libgoe-dev_{FACTS.version}-1_{architecture}.deb"
    fields = passed("dpkg-deb", "-f", package)
    assert "\nPackage: libgoe-dev\n" in f"\n{fields}" and f"\nVersion: {FACTS.version}-1\n" in fields
    assert f"\nHomepage: {FACTS.url}\n" in fields
    assert "\nSection: libdevel\n" in fields and "\n .\n" in fields and f"\nMaintainer: {MAINTAINER}\n" in fields
    cmake = tuple(map(int, re.findall(r"\d+", passed("cmake", "--version"))[:2]))
    assert ("\nMulti-Arch: same\n" in fields) == (cmake >= (3, 31))
    listed = [line.split(maxsplit=5) for line in passed("dpkg-deb", "-c", package).splitlines()]
    assert all(entry[1] == "root/root" for entry in listed)
    names = {entry[5] for entry in listed}
    papers = {f"./usr/share/doc/libgoe-dev/{file}" for file in ("copyright", "changelog.Debian.gz")}
    assert {"./usr/include/goe.h", "./usr/include/goe_flight.h", *papers} <= names
    triplet = passed("dpkg-architecture", "-qDEB_HOST_MULTIARCH").strip() if shutil.which("dpkg-architecture") else "*"
    libraries = sorted(file for file in names if file.endswith(".a"))
    assert [Path(file).name for file in libraries] == ["libgoe.a", "libgoe_flight.a", "libgoe_mavlink.a"]
    assert all(Path(file).match(f"usr/lib/{triplet}/lib*.a") for file in libraries), libraries
    if name == "whole":
        passed("dpkg-deb", "-x", package, tmp_path / "root")
        assert consume(tmp_path / "root", tmp_path / "consumer", CONSUMER, "goe-flight")
        documents = tmp_path / "root" / "usr" / "share" / "doc" / "libgoe-dev"
        assert "License: MIT" in (documents / "copyright").read_text()
        changelog = gzip.decompress((documents / "changelog.Debian.gz").read_bytes()).decode()
        assert changelog.endswith(f"\n -- {MAINTAINER}  Tue, 14 Nov 2023 22:13:20 +0000\n")


def test_debian_package_without_a_maintainer(tmp_path: Path) -> None:
    need("cmake", "cc")
    options = ("-DGOE_BUILD_HOST=OFF", "-DGOE_BUILD_TESTS=OFF")
    passed("cmake", "-S", ROOT, "-B", tmp_path / "build", *options)
    done = run("cmake", "--install", tmp_path / "build", "--component", "debian", "--prefix", tmp_path / "stage")
    assert done.returncode != 0 and "who answers for the Debian package?" in done.stderr


# ---------------------------------------------------------------------------------- where their own tools are installed


def test_conan_create(staged: Path, tmp_path: Path) -> None:
    need("conan")
    home = str(tmp_path / "home")
    passed("conan", "profile", "detect", CONAN_HOME=home)
    for create, size in (("conan create .", 2096), ("conan create . -o '&:with_target_motion=False'", 1752)):
        text = passed("sh", "-c", f"{create} 2>&1", folder=staged / "conan" / "goe", CONAN_HOME=home)
        assert f"goe {FACTS.version}: ok, {size} bytes, self check 0x00, GOE_STATUS" in text
    for wrong in ("window_max=65", "cameras_max=two"):
        done = run("conan", "create", ".", "-o", f"&:{wrong}", folder=staged / "conan" / "goe", CONAN_HOME=home)
        assert done.returncode != 0 and f"Invalid: {wrong.split('=')[0]} is " in done.stderr


def test_compote_pack(staged: Path, tmp_path: Path) -> None:
    need("compote")
    shutil.copytree(staged / "esp-idf" / "goe", tmp_path / "goe")
    passed("compote", "component", "pack", "--name", "goe", folder=tmp_path / "goe")
    assert (tmp_path / "goe" / "dist" / f"goe_{FACTS.version}.tgz").is_file()

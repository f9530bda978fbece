"""The Rust crate: its tests and parts, and the logs through its safe types, on the host and on a Cortex-M4F."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
CRATE = ROOT / "port" / "rust"
BAREMETAL = ROOT / "port" / "baremetal"
TARGET = "thumbv7em-none-eabihf"
CORTEX_M4F = ("-mcpu=cortex-m4", "-mthumb", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard")
MEMORY = ("ROM_ORIGIN=0", "ROM_LENGTH=0x400000", "RAM_ORIGIN=0x20000000", "RAM_LENGTH=0x400000", "STACK_LENGTH=0x8000")
SECONDS = 1800  # guard against a hang


def run(
    *words: str | Path, folder: Path = CRATE, target: Path | None = None, **more: str
) -> subprocess.CompletedProcess[str]:
    environment = {**os.environ, "CARGO_TERM_COLOR": "never", **more}
    if target:
        environment["CARGO_TARGET_DIR"] = str(target)
    return subprocess.run(
        [str(word) for word in words], cwd=folder, env=environment, capture_output=True, text=True, timeout=SECONDS
    )


def passed(*words: str | Path, folder: Path = CRATE, target: Path | None = None) -> str:
    done = run(*words, folder=folder, target=target)
    assert done.returncode == 0, f"{words}: {done.stdout}{done.stderr}"
    return done.stdout + done.stderr  # QEMU writes the image's output to stderr


def names_the_network(text: str) -> bool:
    """The messages of cargo and its HTTP library when there is no network."""
    return bool(
        re.search(r"resolve host|connect to|network (error|failure)|timed? ?out|HTTP re(quest|sponse)", text, re.I)
    )


@pytest.fixture(scope="module")
def target() -> Path:
    """The folder in which cargo builds, or the reason why it cannot."""
    if not shutil.which("cargo") or not shutil.which("rustc"):
        pytest.skip("no cargo: the Rust crate is not tested")
    version = tuple(int(n) for n in re.findall(r"\d+", passed("rustc", "--version"))[:2])
    if version < (1, 81):
        pytest.skip(f"rustc {version[0]}.{version[1]} is older than 1.81: the Rust crate is not tested")
    if run("cargo", "fetch", "--offline").returncode:
        done = run("cargo", "fetch")
        if done.returncode and names_the_network(done.stderr):
            pytest.skip("cargo cannot get the crate cc: the Rust crate is not tested")
        assert done.returncode == 0, done.stderr
    return ROOT / "build" / "rust"


def test_the_crates_own_tests_and_the_bits_of_c(target: Path) -> None:
    """[A13]"""
    text = passed("cargo", "test", "--offline", "--workspace", target=target)
    counts = [int(n) for n in re.findall(r"test result: ok\. (\d+) passed", text)]
    assert sum(count > 0 for count in counts) == 5, text  # of src, its two files, the golden file, the documentation
    assert "estimates_have_the_bits_of_c ... ok" in text and "the_flight_layer_has_the_bits_of_c ... ok" in text


def test_the_example_goes_around(target: Path) -> None:
    text = passed("cargo", "run", "--quiet", "--offline", "--example", "approach", target=target)
    assert re.search(r"m ahead, +[\d.]+ s to go", text) and "go around" in text.splitlines()[-1]


def test_only_the_network_is_an_excuse(target: Path, tmp_path: Path) -> None:
    """A proxy that does not exist is an excuse; a wrong manifest is not."""
    shutil.copytree(CRATE, tmp_path / "rust", ignore=shutil.ignore_patterns("target", "Cargo.lock"))
    manifest = tmp_path / "rust" / "golden" / "Cargo.toml"
    dead = {"CARGO_HOME": str(tmp_path / "home"), "CARGO_NET_RETRY": "0", "CARGO_HTTP_PROXY": "http://127.0.0.1:9"}
    done = run("cargo", "fetch", folder=tmp_path / "rust", **dead)
    assert done.returncode != 0 and names_the_network(done.stderr), done.stderr
    manifest.write_text(manifest.read_text().replace('cc = "', 'cc = "x'))
    done = run("cargo", "fetch", folder=tmp_path / "rust")
    assert done.returncode != 0 and not names_the_network(done.stderr), done.stderr


@pytest.mark.release
@pytest.mark.parametrize("features", ["window", "filter", "window,filter", "target_motion", "window,flight"])
def test_each_combination_of_parts_compiles(target: Path, features: str) -> None:
    words = ("--offline", "--no-default-features", "--features", features)
    assert "warning" not in passed("cargo", "check", "--all-targets", *words, target=target)


@pytest.mark.release
def test_parts(target: Path) -> None:
    words = ("--no-default-features", "--features", "filter,hazard", "--test", "estimator")
    assert "test result: ok" in passed("cargo", "test", "--offline", *words, target=target)


def test_no_method_is_refused(target: Path) -> None:
    done = run("cargo", "check", "--offline", "--no-default-features", target=target)
    assert done.returncode != 0 and "one of the features `window` and `filter` is needed" in done.stderr


def test_another_layout_does_not_compile(target: Path, tmp_path: Path) -> None:
    """A field that only C has; then offsets and constants that are wrong in Rust."""
    text = (CRATE / "src" / "layout.rs").read_text(encoding="utf-8")
    assert "        nis_ratio: 144," in text
    header = (ROOT / "lib" / "goe.h").read_text(encoding="utf-8")
    for name in ("lib", "port/rust", "port/flight"):
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("target"))
    other = re.sub(r"^    float nis; ", "    float nis, another; ", header, flags=re.MULTILINE)
    assert other != header
    (tmp_path / "lib" / "goe.h").write_text(other, encoding="utf-8")
    done = run("cargo", "check", "--offline", folder=tmp_path / "port" / "rust", target=target)
    assert done.returncode != 0 and "goe_estimate_t_nis_ratio" in done.stderr
    (tmp_path / "lib" / "goe.h").write_text(header, encoding="utf-8")
    changes = (
        ("layout.rs", "nis_ratio: 144", "nis_ratio: 148", "goe_estimate_t_nis_ratio"),
        ("layout.rs", "sent_us: 8", "sent_us: 12", "goe_flight_frame_t_sent_us"),
        ("ffi.rs", "GOE_NO_EDGE = -5", "GOE_NO_EDGE = -50", "constant_GOE_NO_EDGE"),
        ("ffi.rs", "GOE_FLIGHT_HOLD = 5", "GOE_FLIGHT_HOLD = 4", "constant_GOE_FLIGHT_HOLD"),
    )
    for name, right, wrong, reported in changes:
        text = (CRATE / "src" / name).read_text(encoding="utf-8")
        assert right in text
        changed = tmp_path / "port" / "rust" / "src" / name
        changed.write_text(text.replace(right, wrong), encoding="utf-8")
        done = run("cargo", "check", "--offline", folder=tmp_path / "port" / "rust", target=target)
        assert done.returncode != 0 and reported in done.stderr, done.stderr
        changed.write_text(text, encoding="utf-8")


@pytest.mark.release
def test_style(target: Path) -> None:
    if run("cargo", "clippy", "--version").returncode or run("cargo", "fmt", "--version").returncode:
        pytest.skip("cargo has no clippy or no rustfmt")
    passed("cargo", "fmt", "--all", "--check")
    words = ("--workspace", "--offline", "--all-targets", "--", "-D", "warnings")
    passed("cargo", "clippy", *words, target=target)


def need(*programs: str) -> None:
    """Skips the test without these programs and Rust for the Cortex-M4F."""
    for program in programs:
        if not shutil.which(program):
            pytest.skip(f"no {program}")
    if not list(Path(run("rustc", "--print", "sysroot").stdout.strip()).glob(f"lib/rustlib/{TARGET}/lib/libcore*")):
        pytest.skip(f"no Rust for {TARGET} (rustup target add {TARGET})")


ALONE = """
[package]
name = "alone"
version = "0.0.0"
edition = "2021"

[dependencies]
goe = {{ path = "{crate}" }}

[profile.dev]
panic = "abort"

[profile.release]
panic = "abort"
"""
ALONE_MAIN = """
#![no_std]
#![no_main]

use goe::flight::{Flight, FlightSettings};
use goe::{Estimator, Image, Plan, Settings};

#[panic_handler]
fn panic(_: &core::panic::PanicInfo) -> ! {
    loop {}
}

#[no_mangle]
pub extern "C" fn _start() -> ! {
    let settings = Settings::for_camera(914.0, 914.0, 640.0, 640.0, 1280.0, 1280.0);
    if let Ok(mut tower) = Estimator::new(&settings) {
        let _ = core::hint::black_box(tower.update(&Image::default()));
        let _ = core::hint::black_box(tower.hazard(&Plan::default()));
    }
    let _ = core::hint::black_box(Flight::new(&settings, &FlightSettings::default()));
    loop {}
}
"""


@pytest.mark.parametrize("profile", ["dev", "release"])
def test_an_image_that_cargo_alone_links(target: Path, tmp_path: Path, profile: str) -> None:
    """Without a C library: the optimizer makes sqrtf an instruction, and unoptimized builds take it from
    compiler_builtins."""
    need("arm-none-eabi-gcc", "arm-none-eabi-nm")
    (tmp_path / "src").mkdir()
    (tmp_path / "src" / "main.rs").write_text(ALONE_MAIN)
    (tmp_path / "Cargo.toml").write_text(ALONE.format(crate=CRATE))
    shutil.copyfile(CRATE / "Cargo.lock", tmp_path / "Cargo.lock")  # the same cc
    passed("cargo", "build", "--offline", "--profile", profile, "--target", TARGET, folder=tmp_path, target=target)
    image = target / TARGET / {"dev": "debug"}.get(profile, profile) / "alone"
    names = passed("arm-none-eabi-nm", image)
    assert " goe_update\n" in names and not re.search(r"^ +[Uw] ", names, re.MULTILINE)
    assert bool(re.search(r" sqrtf$", names, re.MULTILINE)) == (profile == "dev")


def test_on_a_cortex_m4f(target: Path, tmp_path: Path) -> None:
    """The same logs, the same hashes, with port/baremetal's start-up, under QEMU."""
    need("arm-none-eabi-gcc", "qemu-system-arm")
    words = ("--offline", "--release", "--target", TARGET)
    passed("cargo", "build", *words, "--package", "goe-golden", target=target)
    image = tmp_path / "golden.elf"
    passed(
        "arm-none-eabi-gcc", "-std=gnu11", "-DGOE_BARE_METAL", "-Os", *CORTEX_M4F, "-nostartfiles",
        f"-T{BAREMETAL / 'image.ld'}", "-Wl,-e,port_start,--gc-sections,--no-warn-rwx-segments,-z,noexecstack",
        "-Wl,--no-enum-size-warning", *(f"-Wl,--defsym,{place}" for place in MEMORY),
        *(BAREMETAL / name for name in ("semihosting.c", "start_arm.c", "c_library.c")),
        target / TARGET / "release" / "libgoe_golden.a", "-lm", "-o", image,
    )  # fmt: skip
    text = passed(
        "qemu-system-arm", "-M", "mps2-an386", "-nographic", "-monitor", "none", "-serial", "none",
        "-semihosting-config", "enable=on,target=native", "-kernel", image,
    )  # fmt: skip
    for name, file in (("replay", "golden_hash.txt"), ("flight", "flight_hash.txt")):
        golden = (ROOT / "tests" / "targets" / file).read_text(encoding="utf-8").split()[0]
        assert re.search(rf"^{name} {golden} \d+$", text, re.MULTILINE), text

"""Values of the Kconfig files of port/zephyr and port/nuttx, and the files that a build derives from them."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

import kconfiglib

ROOT = Path(__file__).resolve().parents[2]
ZEPHYR = ROOT / "port" / "zephyr"
NUTTX = ROOT / "port" / "nuttx"

# The symbols of the trees' own Kconfig files that ours read or our samples set.
OF_THE_TREE = {
    ZEPHYR: (
        "MINIMAL_LIBC",
        "NEWLIB_LIBC",
        "PICOLIBC",
        "INIT_STACKS",
        "THREAD_STACK_INFO",
        "FPU",
        "FPU_SHARING",
        "ARMV8_1_M_MVEF",
    ),
    NUTTX: ("LIBM", "LIBM_NONE", "DISABLE_PTHREAD", "BUILD_KERNEL", "ARM_HAVE_MVE"),
}


def parse(port: Path, folder: Path) -> kconfiglib.Kconfig:
    """Parses a port's Kconfig below one that defines the tree's symbols. A warning is an error."""
    top = folder / "Kconfig.top"
    symbols = "".join(f'config {name}\n\tbool "{name}"\n\n' for name in OF_THE_TREE[port])
    numbers = 'config MAIN_STACK_SIZE\n\tint "main"\n\tdefault 1024\n\n'
    top.write_text(f'{symbols}{numbers}source "{port / "Kconfig"}"\n')
    parsed = kconfiglib.Kconfig(str(top), warn_to_stderr=False)
    assert not parsed.warnings, parsed.warnings
    return parsed


def apply(parsed: kconfiglib.Kconfig, assignments: Iterable[str]) -> None:
    """Applies lines CONFIG_<name>=<value>, as in prj.conf; each must have its effect."""
    for line in assignments:
        name, _, value = line.strip().partition("=")
        if not name or name.startswith("#"):
            continue
        symbol = parsed.syms.get(name[len("CONFIG_") :])
        assert symbol is not None and symbol.nodes, f"no Kconfig file defines {name}"
        assert symbol.set_value(value), line
    for line in assignments:
        name, _, value = line.strip().partition("=")
        if name and not name.startswith("#"):
            assert parsed.syms[name[len("CONFIG_") :]].str_value == value, f"{line} has no effect"


def write(parsed: kconfiglib.Kconfig, folder: Path, extra_header: str = "") -> None:
    """Writes .config for make, config.cmake for CMake, autoconf.h for C."""
    parsed.write_config(str(folder / ".config"))
    parsed.write_autoconf(str(folder / "autoconf.h"))
    with (folder / "autoconf.h").open("a") as file:
        file.write(extra_header)
    lines = [
        line.partition("=") for line in (folder / ".config").read_text().splitlines() if line.startswith("CONFIG_")
    ]
    (folder / "config.cmake").write_text("".join(f"set({name} {value})\n" for name, _, value in lines))

"""The targets: presets <processor>-<compiler>-<os|o2> of CMakePresets.json."""

from __future__ import annotations

import shutil

PROCESSORS = ("m0plus", "m4f", "m7-sp", "m7-dp", "m33", "m55", "rv32imac", "rv32imafc")


def presets() -> list[str]:
    """All presets of targets, in the order of the tables."""
    return [
        f"{processor}-{compiler}-{level}"
        for processor in PROCESSORS
        for compiler in ("gcc", "clang")
        for level in ("os", "o2")
        if compiler == "gcc" or not processor.startswith("rv32")
    ]


def missing_tool(preset: str) -> str | None:
    """The first missing program that a preset needs."""
    tools = ["cmake", "ninja", "cc"]
    if preset.startswith("rv32"):
        tools += ["riscv64-unknown-elf-gcc", "qemu-system-riscv32"]
    else:
        tools += ["arm-none-eabi-gcc", "qemu-system-arm"]
    if "-clang-" in preset:
        tools.append("clang-19")
    return next((tool for tool in tools if shutil.which(tool) is None), None)


def processor_title(preset: str) -> str:
    processor = preset.rsplit("-", 2)[0]
    name = processor.upper() if processor.startswith("rv") else "Cortex-" + processor.upper().replace("PLUS", "+")
    return name.replace("-SP", " (single)").replace("-DP", " (double)")


def compiler_title(preset: str) -> str:
    _, compiler, level = preset.rsplit("-", 2)
    return f"{compiler} -O{level[1]}"

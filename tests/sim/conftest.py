"""Finds the programs: GOE_SIM, GOE_CAMPAIGN and so on name them; by default they are looked for in build/."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

BUILD = Path(__file__).resolve().parents[2] / "build"
PLACES = {
    "goe_replay": ("GOE_REPLAY", BUILD / "sim_host"),
    "goe_sim": ("GOE_SIM", BUILD / "sim_host"),
    "goe_campaign": ("GOE_CAMPAIGN", BUILD / "sim_host"),
    "goe_avoid": ("GOE_AVOID", BUILD / "sim_host"),
    "sim_probe": ("GOE_SIM_PROBE", BUILD / "tests" / "sim"),
    "avoid_probe": ("GOE_AVOID_PROBE", BUILD / "tests" / "sim"),
    "campaign_probe": ("GOE_CAMPAIGN_PROBE", BUILD / "tests" / "sim"),
}


def program(name: str) -> Path:
    """The program's path. If it is not built, the test is skipped; if a variable names a wrong path, the test fails."""
    variable, folder = PLACES[name]
    named = os.environ.get(variable)
    path = Path(named) if named else folder / name
    if named:
        assert path.is_file(), f"{variable} names no file: {path}"
    elif not path.is_file():
        pytest.skip(f"{name} is not built ({variable} names it)")
    return path


@pytest.fixture(scope="session")
def goe_sim() -> Path:
    return program("goe_sim")


@pytest.fixture(scope="session")
def goe_avoid() -> Path:
    return program("goe_avoid")


@pytest.fixture(scope="session")
def avoid_probe() -> Path:
    return program("avoid_probe")


@pytest.fixture(scope="session")
def sim_probe() -> Path:
    return program("sim_probe")


@pytest.fixture(scope="session")
def programs() -> dict[str, Path]:
    return {name: program(name) for name in ("goe_campaign", "goe_replay", "campaign_probe")}

"""The companion's dialect, generated as its build does, and fleets of flights."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import ModuleType
from xml.etree import ElementTree

import pytest
from companion import ROOT

pymavlink = pytest.importorskip("pymavlink", reason="pymavlink is not installed")

from flights import Fleet, MakeFleet, Plan  # noqa: E402 - after the checks that skip

OWN = (ROOT / "port" / "companion" / "companion.xml", ROOT / "port" / "mavlink" / "goe.xml")
COMMON = ("minimal.xml", "standard.xml", "common.xml")
# Two more messages that the companion sends: one from a dialect with many others, one that pymavlink does not have yet.
ARDUPILOT_ONE = "OBSTACLE_DISTANCE_3D"
TARGET_ABSOLUTE = {
    "timestamp": "uint64_t",
    "id": "uint8_t",
    "sensor_capabilities": "uint8_t",
    "lat": "int32_t",
    "lon": "int32_t",
    "alt": "float",
    "vel": "float[3]",
    "acc": "float[3]",
    "q_target": "float[4]",
    "rates": "float[3]",
    "position_std": "float[2]",
    "vel_std": "float[3]",
    "acc_std": "float[3]",
}


def with_more(definitions: Path) -> str:
    """A dialect of companion.xml and these two messages, without the enumerations that they refer to."""
    root = ElementTree.Element("mavlink")
    ElementTree.SubElement(root, "include").text = "companion.xml"
    messages = ElementTree.SubElement(root, "messages")
    found = ElementTree.parse(definitions / "ardupilotmega.xml").find(f"messages/message[@name='{ARDUPILOT_ONE}']")
    assert found is not None
    for field in found.iter("field"):
        field.attrib.pop("enum", None)
    messages.append(found)
    target = ElementTree.SubElement(messages, "message", id="510", name="TARGET_ABSOLUTE")
    for name, kind in TARGET_ABSOLUTE.items():
        ElementTree.SubElement(target, "field", type=kind, name=name).text = name
    return ElementTree.tostring(root, encoding="unicode")


def generate(folder: Path) -> Path:
    """A Python module from companion.xml and its includes, which mavgen expects in the same folder."""
    from pymavlink.generator import mavgen

    definitions = Path(pymavlink.__file__).parent / "dialects" / "v20"
    (folder / "tests.xml").write_text(with_more(definitions), encoding="utf-8")
    for source in (*OWN, *(definitions / name for name in COMMON)):
        (folder / source.name).write_bytes(source.read_bytes())
    module = folder / "companion_dialect.py"
    options = mavgen.Opts(str(module), wire_protocol="2.0", language="Python3", validate=False)
    assert mavgen.mavgen(options, [str(folder / "tests.xml")])
    return module


def load_dialect(folder: Path) -> ModuleType:
    path = generate(folder)
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    sys.modules[path.stem] = module
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="session")
def dialect(tmp_path_factory: pytest.TempPathFactory) -> ModuleType:
    return load_dialect(tmp_path_factory.mktemp("dialect"))


@pytest.fixture(scope="module")
def make_fleet(dialect: ModuleType, tmp_path_factory: pytest.TempPathFactory) -> Iterator[MakeFleet]:
    """Makes fleets whose processes end with the module in any case."""
    fleets: list[Fleet] = []

    def make(plans: Sequence[Plan]) -> Fleet:
        fleets.append(Fleet(dialect, tmp_path_factory.mktemp("fleet"), plans))
        return fleets[-1]

    yield make
    for fleet in fleets:
        fleet.close()

"""The parameter comments of port/ardupilot/AP_GOE, from which ArduPilot makes its documentation, and the README's
account of them."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PORT = ROOT / "port" / "ardupilot"
SOURCE = (PORT / "AP_GOE" / "AP_GOE_Params.cpp").read_text(encoding="utf-8")
LOGGING = (PORT / "AP_GOE" / "AP_GOE_Logging.cpp").read_text(encoding="utf-8")
README = (PORT / "README.md").read_text(encoding="utf-8")

# The used subset of the closed lists in ArduPilot's Tools/autotest/param_metadata/param.py (4.7-dev, commit 90700977c5,
# read on 22 Nov 2026).
UNITS = {"m", "m/s", "s", "deg", "Hz"}
FIELDS = {"DisplayName", "Description", "User", "Range", "Units", "Values", "Bitmask", "RebootRequired"}
NEEDED = {"DisplayName", "Description", "User"}

# A ground station accepts a wider range: 0 has a special meaning.
WIDER = {"FY": "0 100000", "WIDTH": "0 32767", "HEIGHT": "0 32767"}


@dataclass(frozen=True)
class Parameter:
    name: str
    fields: dict[str, str]
    member: str


def parameters() -> list[Parameter]:
    found = []
    blocks = re.findall(r"((?: *// @.*\n)+)\s*AP_GROUPINFO\w*\(\"(\w+)\", \d+, AP_GOE, (\w+)", SOURCE)
    for comment, name, member in blocks:
        fields = dict(re.findall(r"// @(\w+): (.*)", comment))
        assert fields.pop("Param") == name
        found.append(Parameter(name, fields, member))
    return found


def ranges() -> dict[str, tuple[float, float]]:
    """Ranges of the settings, by the field that AP_GOE assigns."""
    found = {}
    text = (ROOT / "lib" / "goe_settings_list.h").read_text(encoding="utf-8")
    for name, low, high in re.findall(r"X\(([\w.\[\]]+), REAL, \"[^\"]*\", ([-\d.e]+)f, ([-\d.e]+)f,", text):
        found[name] = (float(low), float(high))
    text = (ROOT / "port" / "flight" / "goe_flight_settings_list.h").read_text(encoding="utf-8")
    for name, low, high in re.findall(r"GOE_FLIGHT_SETTING\((\w+), ([\d.e]+)f, ([\d.e]+)f,", text):
        found[name] = (float(low), float(high))
    return found


def assigned() -> dict[str, str]:
    """The field of the settings for each member that it is read from."""
    code = SOURCE[SOURCE.index("void AP_GOE::read_params") :]
    pattern = r"(camera|estimator|layer)\.([\w.\[\]]+) = (?:or_else\()?(_\w+)"
    return {member: ("camera." if of == "camera" else "") + name for of, name, member in re.findall(pattern, code)}


@pytest.mark.parametrize("parameter", parameters(), ids=lambda p: p.name)
def test_each_parameter_is_documented(parameter: Parameter) -> None:
    assert set(parameter.fields) >= NEEDED
    assert set(parameter.fields) <= FIELDS
    assert parameter.fields.get("Units", "m") in UNITS
    assert {"Range", "Values", "Bitmask"} & set(parameter.fields)


@pytest.mark.parametrize("parameter", parameters(), ids=lambda p: p.name)
def test_its_range_is_that_of_the_setting(parameter: Parameter) -> None:
    setting = assigned().get(parameter.member)
    if setting is None:
        assert parameter.name in {"ENABLE", "OA_SIGMA", "REPORT_HZ", "OPTIONS"}
    elif parameter.name in WIDER:
        assert parameter.fields["Range"] == WIDER[parameter.name]
    else:
        low, high = parameter.fields["Range"].split()
        assert (float(low), float(high)) == ranges()[setting]


def test_a_user_sets_fifteen() -> None:
    users = [parameter.fields["User"] for parameter in parameters()]
    assert users.count("Standard") == 15
    assert users.count("Advanced") == len(users) - 15 == 11  # lens and mounting of the camera


def test_a_bad_setting_has_the_name_of_its_parameter() -> None:
    names = dict(re.findall(r'\{"([\w.\[\]]+)", "GOE_(\w+)"\}', SOURCE))
    table = {parameter.member: parameter.name for parameter in parameters()}
    made = {field: table[member] for member, field in assigned().items()}
    assert {field.removeprefix("navigation."): name for field, name in names.items()} == {
        field.removeprefix("navigation."): name for field, name in made.items()
    }


def test_every_parameter_is_read() -> None:
    assert len(parameters()) == len(re.findall(r"AP_GROUPINFO\w*\(", SOURCE)) == 26
    for parameter in parameters():
        assert sum(parameter.member in path.read_text(encoding="utf-8") for path in (PORT / "AP_GOE").iterdir()) >= 2


def test_log_labels_are_documented() -> None:
    messages = re.findall(r"((?:// @.*\n)+)[^\"]*\"(GOE\w)\", \"([\w,]+)\"", LOGGING)
    assert [name for _, name, _ in messages] == ["GOEO", "GOEH", "GOEA", "GOES"]
    for comment, name, labels in messages:
        assert re.search(r"// @LoggerMessage: (\w+)", comment).group(1) == name  # type: ignore[union-attr]
        assert re.findall(r"// @Field: (\w+):", comment) == labels.split(",")


def test_names_in_the_readme_exist() -> None:
    names = {parameter.name for parameter in parameters()}
    for name in re.findall(r"`GOE_([A-Z_]+)`", README):
        assert name in names or name in {"FEATURES", "OBSTACLE", "HAZARD", "STATUS"} or name.startswith("WITH_"), name
    assert f"all {len(names)}" in README
    header = (PORT / "AP_GOE" / "AP_GOE.h").read_text(encoding="utf-8")
    for function in ("handle_unknown", "handle_message", "update"):
        assert f"{function}(" in header and function in README
    folders = re.search(r"\['AP_GOE'\] \+ \['AP_GOE/' \+ d for d in \(([^)]*)\)", README)
    assert folders
    sources = [*(ROOT / "lib").rglob("*.c"), *(ROOT / "port/flight").glob("*.c"), *(ROOT / "port/mavlink").glob("*.c")]
    listed = {name.strip(" '") for name in folders.group(1).split(",")}
    assert listed == {str(path.parent.relative_to(ROOT)).replace("port/", "") for path in sources}

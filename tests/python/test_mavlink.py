"""port/mavlink against pymavlink: the code that mavgen makes of goe.xml and the standard messages packs the same bytes
as the codec."""

from __future__ import annotations

import importlib.util
import random
import re
import shutil
import struct
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

mavparse = pytest.importorskip("pymavlink.generator.mavparse", reason="pymavlink is not installed")

ROOT = Path(__file__).resolve().parents[2]
LAYER = ROOT / "port" / "mavlink"
DIALECTS = Path(mavparse.__file__).parents[1] / "dialects" / "v20"
ROUNDS = 100

# mavlink/mavlink of 2026-07, development.xml: names and types only. pymavlink 2.4.50 has no such message yet.
NEWER = """<?xml version="1.0"?>
<mavlink>
  <include>goe.xml</include>
  <messages>
    <message id="510" name="TARGET_ABSOLUTE">
      <description>Position of a target.</description>
      <field type="uint64_t" name="timestamp">.</field>
      <field type="uint8_t" name="id">.</field>
      <field type="uint8_t" name="sensor_capabilities">.</field>
      <field type="int32_t" name="lat">.</field>
      <field type="int32_t" name="lon">.</field>
      <field type="float" name="alt">.</field>
      <field type="float[3]" name="vel">.</field>
      <field type="float[3]" name="acc">.</field>
      <field type="float[4]" name="q_target">.</field>
      <field type="float[3]" name="rates">.</field>
      <field type="float[2]" name="position_std">.</field>
      <field type="float[3]" name="vel_std">.</field>
      <field type="float[3]" name="acc_std">.</field>
    </message>
  </messages>
</mavlink>
"""

# Fields whose name in C differs from the name in the XML.
RENAMED = {"ICAO_address": "icao_address"}

# Enumerations of goe.xml with the same numbers in the headers: entries by their prefix in the XML, and the prefix in C.
SAME_NUMBERS = {
    "GOE_FEATURE_BOX_": ("GOE_MAVLINK_FEATURE_BOX_", ("LEFT", "TOP", "RIGHT", "BOTTOM")),
    "GOE_TIME_BASE_": ("GOE_FLIGHT_", ("AUTOPILOT", "SENDER", "AGE")),
    "GOE_SHAPE_": ("GOE_MODEL_", ("NONE", "DISC", "LINE", "BOX", "PRISM")),
    "GOE_KIND_SHAPE_": ("GOE_KIND_", ("UNKNOWN", "ROUND", "OTHER")),
    "GOE_OBSTACLE_FLAG_": ("GOE_MAVLINK_", ("SUSPECT", "RECEDING", "IN_VIEW", "WORST", "LATE", "ORDER")),
    "GOE_ACTION_": ("GOE_FLIGHT_", ("NONE", "LEFT", "RIGHT", "CLIMB", "GO_AROUND", "HOLD")),
    "GOE_ALIVE_": ("GOE_MAVLINK_", ("DETECTOR", "POSE", "POSE_AGREES")),
}
SUFFIXES = {"AUTOPILOT": "_CLOCK", "SENDER": "_CLOCK", "DETECTOR": "_ALIVE", "POSE": "_ALIVE"}
POINTS = ("LEFT", "RIGHT", "TOP", "BASE_LEFT", "BASE_NEAR", "BASE_RIGHT")


@dataclass(frozen=True)
class Row:
    """A line of goe_mavlink_messages.h."""

    key: str
    name: str
    id: int
    crc_extra: int
    length_min: int
    length: int


def table() -> list[Row]:
    text = (LAYER / "goe_mavlink_messages.h").read_text(encoding="utf-8")
    found = re.findall(r'^GOE_MAVLINK_INFO\((\w+), "(\w+)", (\d+), (\d+), (\d+), (\d+)\)$', text, re.MULTILINE)
    return [Row(key, name, *(int(number) for number in numbers)) for key, name, *numbers in found]


TABLE = table()


def mavgen(language: str, out: Path, xml: Path, *options: str) -> str:
    command = [sys.executable, "-m", "pymavlink.tools.mavgen", "--lang", language, "--wire-protocol", "2.0"]
    done = subprocess.run(
        [*command, *options, "-o", str(out), str(xml)], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    assert done.returncode == 0, done.stdout
    return done.stdout


def load(path: Path) -> ModuleType:
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope="module")
def definitions(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """goe.xml in a folder with a dialect that includes it, as any user can arrange it."""
    folder = tmp_path_factory.mktemp("definitions")
    shutil.copy(LAYER / "goe.xml", folder)
    (folder / "newer.xml").write_text(NEWER, encoding="utf-8")
    return folder


@pytest.fixture(scope="module")
def newer(definitions: Path) -> ModuleType:
    mavgen("Python3", definitions / "newer.py", definitions / "newer.xml")
    return load(definitions / "newer.py")


@pytest.fixture(scope="module")
def modules(newer: ModuleType) -> dict[str, ModuleType]:
    """The generated module of each message, by the message's name."""
    everything = __import__("pymavlink.dialects.v20.all", fromlist=["all"])
    own = {message.msgname for message in newer.mavlink_map.values()}
    return {row.name: newer if row.name in own else everything for row in TABLE}


# ------------------------------------------------------------------------------------------------------------ the table


@pytest.mark.parametrize("language", ["C", "Python3"])
def test_mavgen_takes_goe_xml_without_a_murmur(tmp_path: Path, language: str) -> None:
    said = mavgen(language, tmp_path / "goe", LAYER / "goe.xml", "--strict-units")
    assert "Validating" in said
    assert not re.search("warn|error|duplicate|invalid|not ", said, re.IGNORECASE), said


def test_the_table_has_every_message_of_the_header_in_its_order() -> None:
    header = (LAYER / "goe_mavlink.h").read_text(encoding="utf-8")
    block = header[: header.index("} goe_mavlink_message_t;")].rsplit("typedef enum {", 1)[1]
    assert [f"GOE_MAVLINK_{row.key}" for row in TABLE] == re.findall(r"GOE_MAVLINK_\w+(?=,)", block)


@pytest.mark.parametrize("row", TABLE, ids=lambda row: row.name)
def test_ids_sizes_and_checksums_are_those_of_the_definitions(definitions: Path, row: Row) -> None:
    standard = [DIALECTS / "common.xml", DIALECTS / "ardupilotmega.xml"]
    paths = [definitions / "goe.xml", definitions / "newer.xml", *standard]
    found = [message for path in paths for message in mavparse.MAVXML(str(path), "2.0").message]
    (message,) = (message for message in found if message.name == row.name)
    assert (message.id, message.crc_extra) == (row.id, row.crc_extra)
    assert (message.wire_min_length, message.wire_length) == (row.length_min, row.length)


def test_our_ids_are_nobody_else_s() -> None:
    everything = __import__("pymavlink.dialects.v20.all", fromlist=["all"])
    assert not {row.id for row in TABLE if row.name.startswith("GOE_")} & set(everything.mavlink_map)


# --------------------------------------------------------------------------------------------------- Python against C


def compile_c(out: Path, sources: list[Path], *options: str) -> Path:
    compiler = shutil.which("cc")
    if compiler is None:
        pytest.skip("no C compiler")
    includes = [f"-I{ROOT / folder}" for folder in ("lib", "port/flight", "port/mavlink", "tests/mavlink")]
    command = [compiler, "-std=c99", "-O1", *options, *includes, *map(str, sources), "-lm", "-o", str(out)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return out


@pytest.fixture(scope="module")
def echo(tmp_path_factory: pytest.TempPathFactory) -> Path:
    tests = ROOT / "tests" / "mavlink"
    sources = [tests / "mavlink_echo.c", tests / "any_message.c", LAYER / "goe_mavlink.c"]
    return compile_c(tmp_path_factory.mktemp("echo") / "mavlink_echo", sources)


def value(kind: str, dice: random.Random) -> Any:
    """Any value of a field's type; often 0, which truncates messages, or the largest."""
    if kind == "float":
        return dice.choice([0.0, float("nan"), -0.0, dice.uniform(-1e3, 1e3), 3.4028234663852886e38])
    bits = int(re.sub(r"\D", "", kind))
    least, most = (0, 2**bits - 1) if kind.startswith("u") else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    return dice.choice([0, 0, least, most, dice.randint(least, most)])


def content(cls: Any, dice: random.Random) -> list[Any]:
    """Values of every field, as the constructor takes them."""
    values = []
    for name in cls.fieldnames:
        kind = cls.fieldtypes[cls.fieldnames.index(name)]
        count = cls.array_lengths[cls.ordered_fieldnames.index(name)]
        if kind == "char":
            values.append(bytes(dice.choice(b"GOE123") for _ in range(dice.randrange(count))))
        elif count > 0:
            values.append([value(kind, dice) for _ in range(count)])
        else:
            values.append(value(kind, dice))
    return values


@dataclass(frozen=True)
class Sent:
    message: Any
    frame: bytes


def sent_by_python(modules: dict[str, ModuleType], row: Row) -> list[Sent]:
    dice = random.Random(row.id)
    cls = modules[row.name].mavlink_map[row.id]
    sender = modules[row.name].MAVLink(None, srcSystem=dice.randrange(256), srcComponent=dice.randrange(256))
    all_sent = []
    for number in range(ROUNDS):
        sender.seq = (200 + number) % 256
        message = cls(*content(cls, dice))
        all_sent.append(Sent(message, bytes(message.pack(sender))))
    return all_sent


def echoed(echo: Path, sent: list[bytes]) -> list[bytes]:
    lines = "".join(frame.hex() + "\n" for frame in sent)
    done = subprocess.run([str(echo)], input=lines, capture_output=True, text=True, check=True)
    return [bytes.fromhex(line) for line in done.stdout.splitlines()]


@pytest.mark.parametrize("row", TABLE, ids=lambda row: row.name)
def test_c_repacks_the_messages_of_python_byte_by_byte(modules: dict[str, ModuleType], echo: Path, row: Row) -> None:
    frames = [sent.frame for sent in sent_by_python(modules, row)]
    assert len({len(frame) for frame in frames}) > 1  # ends of several lengths were truncated
    assert echoed(echo, frames) == frames


def single(field: Any) -> Any:
    """Rounded to the 32 bits of the wire."""
    if isinstance(field, list):
        return [single(one) for one in field]
    return struct.unpack("<f", struct.pack("<f", field))[0]


def bits(field: Any) -> Any:
    """The bits of a float, so that a NaN equals itself."""
    if isinstance(field, (list, tuple)):
        return [bits(one) for one in field]
    return struct.pack("<d", field) if isinstance(field, float) else field


def comparable(field: Any, kind: str) -> Any:
    if kind == "char":
        return (field.decode() if isinstance(field, bytes) else field).rstrip("\0")
    return bits(single(field) if kind == "float" else field)


@pytest.mark.parametrize("row", TABLE, ids=lambda row: row.name)
def test_python_reads_the_messages_that_c_packs(modules: dict[str, ModuleType], echo: Path, row: Row) -> None:
    all_sent = sent_by_python(modules, row)
    reader = modules[row.name].MAVLink(None)
    for sent, frame in zip(all_sent, echoed(echo, [sent.frame for sent in all_sent])):
        (message,) = reader.parse_buffer(frame)
        assert message.get_type() == row.name
        for name, kind in zip(message.fieldnames, message.fieldtypes):
            read, stated = getattr(message, name), getattr(sent.message, name)
            assert comparable(read, kind) == comparable(stated, kind), name


def test_an_unknown_frame_is_recognized_as_such(echo: Path) -> None:
    done = subprocess.run([str(echo)], input="fd\n\nfd0100000001010000000000\n", capture_output=True, text=True)
    assert done.stdout.splitlines() == ["?", "?", "?"]


# ---------------------------------------------------------------------------------------------- mavgen's C against ours

PROGRAM = """#include <stdio.h>
#include <string.h>
#include "newer/mavlink.h"
#include "goe_mavlink.h"
#include "goe_mavlink_map.h"

static uint32_t state = 1u;
static int bad;

static void fill(uint8_t *bytes, size_t count) {
    for (size_t i = 0; i < count; i++) {
        state = state * 1664525u + 1013904223u;
        bytes[i] = (uint8_t)(state >> 24);
        bytes[i] = (state >> 8) % 3u == 0u ? 0u : bytes[i];
    }
}

#define SAME(field, ours_field) \\
    if (sizeof theirs.field != sizeof ours.ours_field || \\
        memcmp(&theirs.field, &ours.ours_field, sizeof theirs.field)) { \\
        printf("%s\\n", #field); \\
        bad = 1; \\
    }
#define NUMBER(xml, own) \\
    if ((int)(xml) != (int)(own)) { \\
        printf("%s is %d\\n", #xml, (int)(xml)); \\
        bad = 1; \\
    }
"""

CHECK = """
static void check_{name}(void) {{
    for (int k = 0; k < {rounds}; k++) {{
        mavlink_message_t message;
        mavlink_{name}_t theirs;
        goe_mavlink_{own}_t ours;
        goe_mavlink_sender_t sender = {{7u, 191u, 0u}};
        uint8_t payload[GOE_MAVLINK_PAYLOAD_MAX];
        uint8_t frame[GOE_MAVLINK_FRAME_MAX];
        uint8_t buffer[MAVLINK_MAX_PACKET_LEN];
        memset(&message, 0, sizeof message);
        fill(payload, {length});
        message.msgid = {id};
        message.len = {length};
        memcpy(_MAV_PAYLOAD_NON_CONST(&message), payload, {length});
        mavlink_msg_{name}_decode(&message, &theirs);
        goe_mavlink_read_{own}(payload, {length}, &ours);
{fields}
        mavlink_msg_{name}_encode(7, 191, &message, &theirs);
        sender.sequence = message.seq;
        const size_t size = mavlink_msg_to_send_buffer(buffer, &message);
        const size_t packed = goe_mavlink_pack_{own}(&ours, payload);
        if (goe_mavlink_frame(&sender, GOE_MAVLINK_{key}, payload, packed, frame) != size ||
            memcmp(frame, buffer, size)) {{
            printf("frame of {name}\\n");
            bad = 1;
        }}
    }}
}}
"""


def checks(modules: dict[str, ModuleType], rows: list[Row]) -> str:
    text = ""
    for row in rows:
        names = modules[row.name].mavlink_map[row.id].fieldnames
        fields = "\n".join(f"        SAME({name}, {RENAMED.get(name, name)})" for name in names)
        text += CHECK.format(
            name=row.name.lower(), own=row.key.lower(), key=row.key, id=row.id, length=row.length, fields=fields,
            rounds=ROUNDS,
        )  # fmt: skip
    return text


def numbers() -> str:
    pairs = [
        (f"{prefix}{name}", f"{own}{name}{SUFFIXES.get(name, '')}")
        for prefix, (own, names) in SAME_NUMBERS.items()
        for name in names
    ]
    pairs += [(f"GOE_FEATURE_{name}", f"GOE_MAVLINK_FEATURE_POINT << {i}") for i, name in enumerate(POINTS)]
    return "".join(f"    NUMBER({xml}, {own})\n" for xml, own in pairs)


def run_against(headers: Path, first: str, text: str) -> None:
    program = headers / "check.c"
    program.write_text(PROGRAM.replace("newer/mavlink.h", first) + text, encoding="utf-8")
    built = compile_c(headers / "check", [program, LAYER / "goe_mavlink.c"], "-isystem", str(headers), "-w")
    done = subprocess.run([str(built)], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (0, "")


def main_of(rows: list[Row], more: str = "") -> str:
    calls = "".join(f"    check_{row.name.lower()}();\n" for row in rows)
    return f"\nint main(void) {{\n{calls}{more}    return bad;\n}}\n"


def test_generated_c_agrees_on_our_messages_and_numbers(
    tmp_path: Path, definitions: Path, modules: dict[str, ModuleType], newer: ModuleType
) -> None:
    mavgen("C", tmp_path, definitions / "newer.xml")
    rows = [row for row in TABLE if modules[row.name] is newer]
    assert len(rows) == 5
    run_against(tmp_path, "newer/mavlink.h", checks(modules, rows) + main_of(rows, numbers()))


def test_generated_c_agrees_on_the_standard_messages(
    tmp_path: Path, modules: dict[str, ModuleType], newer: ModuleType
) -> None:
    mavgen("C", tmp_path, DIALECTS / "ardupilotmega.xml", "--no-validate")
    rows = [row for row in TABLE if modules[row.name] is not newer]
    assert len(rows) == 6
    run_against(tmp_path, "ardupilotmega/mavlink.h", checks(modules, rows) + main_of(rows))


def test_every_number_of_the_dialect_is_compared(definitions: Path) -> None:
    named = {f"{prefix}{name}" for prefix, (_, names) in SAME_NUMBERS.items() for name in names}
    named |= {f"GOE_FEATURE_{name}" for name in POINTS}
    enums = mavparse.MAVXML(str(definitions / "goe.xml"), "2.0").enum
    assert named == {entry.name for enum in enums for entry in enum.entry if not entry.end_marker}


# --------------------------------------------------------------------------------------------------------------- README


def readme() -> str:
    return (LAYER / "README.md").read_text(encoding="utf-8")


def test_the_readme_states_ids_and_sizes() -> None:
    stated = dict(re.findall(r"^\| `([A-Z_0-9]+)` \| (\d+) \|", readme(), re.MULTILINE))
    assert {name: int(number) for name, number in stated.items()} == {row.name: row.id for row in TABLE}
    frames = dict(re.findall(r"^\| `(GOE_\w+)` \| \d+ \| ([^|]*) \|", readme(), re.MULTILINE))
    for row in TABLE[:4]:
        wanted = {str(row.length_min + 12), str(row.length + 12)}
        assert set(re.findall(r"\d+", frames[row.name])) == wanted, row.name


def test_the_readme_states_the_cost_of_the_code() -> None:
    done = subprocess.run([ROOT / "tools" / "sizes.sh", "goe_mavlink"], capture_output=True, text=True, check=True)
    rows = re.findall(r"^\| Cortex-M4F.*\|$", done.stdout, re.MULTILINE)
    versions = set(re.findall(r"\(([\d.]+)\)", "".join(rows)))
    if not versions or not all(f"({version})" in readme() for version in versions):
        pytest.skip(f"sizes were measured with another compiler than {versions or 'none'}")
    assert len(rows) == 3
    assert all(row in readme() for row in rows)


def test_c_reads_the_messages_of_the_readme_s_camera(newer: ModuleType, echo: Path) -> None:
    """The example runs unchanged, with a link that stores the bytes."""
    (example,) = re.findall(r"^```python\n(.*?)^```$", readme(), re.MULTILINE | re.DOTALL)
    written: list[bytes] = []

    class Link:
        def write(self, data: bytes) -> None:
            written.append(bytes(data))

    before = sys.modules.get("goe")  # the Python package has that name, too
    sys.modules["goe"] = newer
    try:
        scope: dict[str, Any] = {}
        exec(example, scope)  # the README's own code
        scope["send"](Link(), 1280, 720, [(3, 600, 300, 700, 420, 0.9), (4, 10, 20, 40, 60, 0.5)], 0.035)
        scope["send"](Link(), 1280, 720, [], 0.035)
    finally:
        del sys.modules["goe"]
        if before is not None:
            sys.modules["goe"] = before
    assert echoed(echo, written) == written
    reader = newer.MAVLink(None)
    first, second, empty = (reader.parse_buffer(frame)[0] for frame in written)
    assert (first.number, second.number, empty.number) == (2, 2, 0)
    assert list(first.box) == [-400, -600, 600, 600]
    assert (first.obstacle_id, first.score, first.time_base, first.visible) == (3, 90, 2, 15)
    assert first.age_usec >= 35000

"""Generates the headers that PX4 would generate from port/px4's messages and parameters, for the stand-in: the
topics' structures, and a table of the parameters with their ranges."""

from __future__ import annotations

import argparse
import re
from dataclasses import dataclass, field
from pathlib import Path

TYPES = {
    "bool": "bool", "float32": "float", "float64": "double", "uint8": "uint8_t", "int8": "int8_t", "uint16": "uint16_t",
    "int16": "int16_t", "uint32": "uint32_t", "int32": "int32_t", "uint64": "uint64_t", "int64": "int64_t",
}  # fmt: skip
HEAD = "/* Made by tests/px4/px4_headers.py. */\n#pragma once\n\n"
NAME_MAX = 16  # MAVLink's limit on the characters of a parameter's name


def topic_of(message: Path) -> str:
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", message.stem).lower()


def header_of(message: Path) -> str:
    """The structure of a message, with its constants, and its topic."""
    constants: list[str] = []
    fields: list[str] = []
    queue = 1
    for number, text in enumerate(message.read_text(encoding="utf-8").splitlines(), 1):
        line = text.split("#")[0].strip()
        if not line:
            continue
        match = re.fullmatch(r"(\w+)(?:\[(\d+)\])? (\w+)(?: = (-?\d+))?", line)
        if match is None or match[1] not in TYPES:
            raise SystemExit(f"{message}:{number}: not understood: {text}")
        kind, length, name, value = match.groups()
        if name == "ORB_QUEUE_LENGTH":
            queue = int(value)
        elif value is not None:
            constants.append(f"    static constexpr {TYPES[kind]} {name} = {value};")
        else:
            fields.append(f"    {TYPES[kind]} {name}{f'[{length}]' if length else ''};")
    topic = topic_of(message)
    body = "\n".join(constants + fields)
    return f'{HEAD}#include "standin.hpp"\n\nstruct {topic}_s {{\n{body}\n}};\n\nSTANDIN_TOPIC({topic}, {queue})\n'


@dataclass
class Parameter:
    name: str
    values: dict[str, str] = field(default_factory=dict)
    bits: int = 0

    @property
    def is_int(self) -> bool:
        return self.values["type"] != "float"

    def number(self, key: str) -> float:
        text = self.values[key]
        return {"false": 0.0, "true": 1.0}[text] if text in ("false", "true") else float(text)

    @property
    def range(self) -> tuple[float, float]:
        if self.values["type"] == "boolean":
            return 0.0, 1.0
        return (0.0, 2.0**self.bits - 1.0) if self.bits else (self.number("min"), self.number("max"))


def parameters_of(module: Path) -> list[Parameter]:
    """Reads the subset of YAML in module.yaml: a name is indented by six blanks, its keys by eight, bits by ten."""
    found: list[Parameter] = []
    for line in module.read_text(encoding="utf-8").splitlines():
        if name := re.fullmatch(r" {6}(GOE_\w+):", line):
            found.append(Parameter(name[1]))
        elif key := re.fullmatch(r" {8}(\w+): (.+)", line):
            found[-1].values[key[1]] = key[2]
        elif re.fullmatch(r" {10}\d+: .+", line):
            found[-1].bits += 1
    for parameter in found:
        if len(parameter.name) > NAME_MAX:
            raise SystemExit(f"{module}: {parameter.name} is longer than {NAME_MAX} characters")
    return found


def table_of(parameters: list[Parameter]) -> str:
    ids = "".join(f"    {p.name},\n" for p in parameters)
    rows = "".join(
        f'    {{"{p.name}", {str(p.is_int).lower()}, {p.range[0]!r}, {p.range[1]!r}, {p.number("default")!r}}},\n'
        for p in parameters
    )
    return (
        f"{HEAD}#include <cstdint>\n\nnamespace px4\n{{\n\nenum class params : uint16_t {{\n{ids}}};\n\n"
        "struct standin_parameter_t {\n    const char *name;\n    bool is_int;\n"
        "    double least, most, standard;\n};\n\n"
        f"constexpr int standin_parameters = {len(parameters)};\n"
        f"static const standin_parameter_t standin_parameter[] = {{\n{rows}}};\n\n}} // namespace px4\n"
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--port", type=Path, required=True, help="folder port/px4")
    parser.add_argument("--out", type=Path, required=True, help="where uORB/topics/ and parameters/ go")
    arguments = parser.parse_args()
    topics = arguments.out / "uORB" / "topics"
    folder = arguments.out / "parameters"
    topics.mkdir(parents=True, exist_ok=True)
    folder.mkdir(parents=True, exist_ok=True)
    for message in sorted((arguments.port / "msg").glob("*.msg")):
        (topics / f"{topic_of(message)}.h").write_text(header_of(message), encoding="utf-8")
    module = arguments.port / "src" / "modules" / "goe" / "module.yaml"
    (folder / "px4_parameters.hpp").write_text(table_of(parameters_of(module)), encoding="utf-8")


if __name__ == "__main__":
    main()

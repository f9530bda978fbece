"""Writes the C source of the extension module goe._goe: cffi's wrapper around the library's own headers.

    python bindings.py --lib DIR --flight DIR --cmake DIR [--out FILE]

Types, constants and functions are taken from goe.h with its parts, goe_flight.h and the glue's headers as they are, and
the C compiler holds cffi's idea of every size and offset against its own. CMakeLists.txt runs this whenever the package
is built.

``fingerprint`` identifies the sources of a module: a checkout can check whether the installed one is its own.
Without ``--out`` it is printed.
"""

from __future__ import annotations

import argparse
import hashlib
import re
from collections.abc import Iterator
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent
MODULE = "goe._goe"
SOURCES = (".c", ".h", ".py", ".pyi", ".toml", ".cmake")  # what counts in a fingerprint
OWN_BUILD = "CMakeLists.txt"  # ... of the package itself

TYPES = {
    "goe.h": (
        "goe_status_t", "goe_model_t", "goe_method_t", "goe_pose_t", "goe_pixel_t", "goe_box_t", "goe_image_noise_t",
        "goe_kind_t", "goe_image_t", "goe_sigma_t", "goe_reason_t", "goe_estimate_t", "goe_intent_t", "goe_hazard_t",
        "goe_rule_t", "goe_decision_t",
    ),
    "goe_python.h": ("goe_python_setting_t", "goe_python_rule_t"),
    "goe_flight.h": (
        "goe_flight_status_t", "goe_flight_attitude_t", "goe_flight_position_t", "goe_flight_detection_t",
        "goe_flight_frame_t", "goe_flight_action_t", "goe_flight_reason_t", "goe_flight_assessment_t",
        "goe_flight_obstacle_t", "goe_flight_counters_t",
    ),
    "goe_python_flight.h": (),
}  # fmt: skip
FUNCTIONS = {
    "goe.h": (
        "goe_update", "goe_covariance", "goe_hazard", "goe_rule_default", "goe_decide", "goe_earliest_tcpa_s",
        "goe_reset",
        "goe_status_text", "goe_reason_text", "goe_self_check",
    ),
    "goe_python.h": (
        "goe_python_setting", "goe_python_camera_settings", "goe_python_init", "goe_python_update",
        "goe_python_image_taken",
    ),
    "goe_flight.h": (
        "goe_flight_attitude", "goe_flight_position", "goe_flight_pose", "goe_flight_timesync", "goe_flight_frame",
        "goe_flight_assess", "goe_flight_obstacle", "goe_flight_sectors", "goe_flight_restart",
        "goe_flight_action_text", "goe_flight_reason_text",
    ),
    "goe_python_flight.h": ("goe_python_flight_setting", "goe_python_flight_init", "goe_python_flight_change"),
}  # fmt: skip
OWN_MEMORY = {  # structs of which Python reads these fields only
    "goe.h": "typedef struct { uint32_t fault_counts[GOE_FAULT_COUNTS]; ...; } goe_estimator_t;",
    "goe_flight.h": "typedef struct { goe_flight_counters_t counters; uint32_t capture_us; ...; } goe_flight_t;",
}
LIMITS = ("GOE_WINDOW_MAX", "GOE_CAMERAS_MAX", "GOE_FLIGHT_SLOTS")  # as compiled
CONSTANT = re.compile(r"^#define (GOE_\w+) +((?:0x)?[0-9A-Fa-f]+)u?(?=\s)", re.MULTILINE)
GUARD = re.compile(r"#ifndef (\w+)\n#define \1 ")
OWN_PART = re.compile(r'^#include "(\w+\.h)"\n', re.MULTILINE)
PRIVATE = ("goe_state.h",)

# ------------------------------------------------------------------------------------------------------- declarations


def without_comments(text: str) -> str:
    return re.sub(r"/\*.*?\*/", " ", text, flags=re.DOTALL)


def with_parts(header: Path) -> str:
    """The text of goe.h with its public parts in place of their #include; of another header its own text."""

    def part(match: re.Match[str]) -> str:
        path = header.with_name(match[1])
        return match[0] if path.name in PRIVATE else path.read_text(encoding="utf-8")

    text = header.read_text(encoding="utf-8")
    return OWN_PART.sub(part, text) if header.name == "goe.h" else text


def the_one(pattern: str, text: str, what: str) -> str:
    found = re.findall(pattern, text, re.MULTILINE)
    if len(found) != 1:
        raise ValueError(f"{what}: found {len(found)} times, not once")
    return str(found[0])


def constants(text: str) -> Iterator[str]:
    """#define of a number, but for those that a compiler's flag may change."""
    optional = set(GUARD.findall(text))
    for name, number in CONSTANT.findall(without_comments(text)):
        if name not in optional:
            yield f"#define {name} {number}"


def declarations_of(name: str, text: str) -> Iterator[str]:
    """What cffi is to know of one header."""
    yield from constants(text)
    plain = without_comments(text)
    yield from re.findall(r"^enum \{[^}]*\};", plain, re.MULTILINE)
    for wanted in TYPES[name]:
        yield the_one(rf"^(typedef (?:struct|enum) \{{[^{{}}]*\}} {wanted};)", plain, wanted)
    if name in OWN_MEMORY:
        yield OWN_MEMORY[name]
    for wanted in FUNCTIONS[name]:
        yield the_one(rf"^(?:GOE_NODISCARD )?(\w[\w *]*?\b{wanted}\([^;]*\);)", plain, wanted)


def declarations(headers: dict[str, str]) -> str:
    """Of all headers, by name."""
    lines = [f"#define {limit} ..." for limit in LIMITS] + ["extern const char goe_python_fingerprint[];"]
    for name in TYPES:
        lines += declarations_of(name, headers[name])
    return "\n".join(lines)


# -------------------------------------------------------------------------------------------------------- fingerprint


def sources(lib: Path, flight: Path, cmake: Path) -> Iterator[tuple[str, Path]]:
    """All sources of a module, with the same names in a checkout and in a packed folder."""
    folders = {
        "lib": lib.rglob("*"), "flight": flight.glob("*"), "cmake": cmake.glob("goe_compile.cmake"),
        "package": (path for folder in ("", "csrc", "src/goe") for path in (PACKAGE / folder).glob("*")),
    }  # fmt: skip
    roots = {"lib": lib, "flight": flight, "cmake": cmake, "package": PACKAGE}
    for name, paths in folders.items():
        for path in sorted(paths):
            if path.is_file() and (path.suffix in SOURCES or path == PACKAGE / OWN_BUILD):
                yield f"{name}/{path.relative_to(roots[name]).as_posix()}", path


def fingerprint(lib: Path, flight: Path, cmake: Path) -> str:
    """Of the sources' bytes and names, 64 hexadecimal digits."""
    total = hashlib.sha256()
    for name, path in sources(lib, flight, cmake):
        total.update(f"{name} {hashlib.sha256(path.read_bytes()).hexdigest()}\n".encode())
    return total.hexdigest()


# -------------------------------------------------------------------------------------------------------------- module


def module(headers: dict[str, str], printed: str, out: Path) -> None:
    import cffi

    builder = cffi.FFI()
    builder.cdef(declarations(headers))
    includes = "".join(f'#include "{name}"\n' for name in TYPES)
    builder.set_source(MODULE, f'{includes}static const char goe_python_fingerprint[] = "{printed}";\n')
    builder.emit_c_code(str(out))  # leaves a file alone that says so already


def main() -> None:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--lib", type=Path, required=True, metavar="DIR", help="sources of the library")
    parser.add_argument("--flight", type=Path, required=True, metavar="DIR", help="sources of the flight layer")
    parser.add_argument("--cmake", type=Path, required=True, metavar="DIR", help="where goe_compile.cmake is")
    parser.add_argument("--out", type=Path, metavar="FILE", help="C file to write")
    given = parser.parse_args()
    printed = fingerprint(given.lib, given.flight, given.cmake)
    if given.out is None:
        print(printed)
        return
    folders = {"goe.h": given.lib, "goe_flight.h": given.flight}
    headers = {name: with_parts(folders.get(name, PACKAGE / "csrc") / name) for name in TYPES}
    module(headers, printed, given.out)


if __name__ == "__main__":
    main()

"""Evaluation of Frama-C's output in the proof's part of the evidence, and the table of explained alarms."""

from __future__ import annotations

import csv
import re
import subprocess
from pathlib import Path

import pytest
from ci.evidence import contracts, frama_c, proof
from ci.evidence.frama_c import Property, Run
from goe_tools.places import PUBLIC_HEADERS, ROOT

HEAD = "directory\tfile\tline\tfunction\tproperty kind\tstatus\tproperty\n"


def test_properties_are_those_of_the_library_and_the_drivers(tmp_path: Path) -> None:
    table = tmp_path / "report.csv"
    table.write_text(
        HEAD
        + "lib/window\tgoe_mean.c\t12\tgoe_mean_add\tindex_bound\tUnknown\tmean->next  < 8\n"
        + "lib/window\tgoe_mean.c\t13\tgoe_mean_add\tindex_bound\tUnknown\tmean->next < 8\n"
        + "FRAMAC_SHARE/libc\tstring.h\t1\tmemcpy\tprecondition\tUnknown\tvalid_dest\n"
        + "tests/proof\tany.c\t9\tcheck_window\tuser assertion\tValid\t0 <= 1\n"
    )
    assert frama_c.read_properties(table) == (
        Property("lib/window/goe_mean.c", "goe_mean_add", "index_bound", "Unknown", "mean->next < 8"),
        Property("proof/any.c", "check_window", "user assertion", "Valid", "0 <= 1"),
    )


def test_functions_are_read_from_the_logs() -> None:
    output = (
        "[eva] computing for function goe_reset <- proof_reset.\n  Called from tests/proof/calls.c:60.\n"
        "[eva] computing for function average_0 <- goe_health_take <- \n              proof_x.\n"
        "  Called from lib/refined/goe_health.c:55.\n[eva] Done for function average_0\n"
    )
    reached = frama_c.reached_functions(output)
    assert {"goe_reset", "lib/refined/goe_health.c:average"} <= reached
    assert not any(name.endswith("_0") for name in reached)


def test_functions_of_the_library_are_recognized_by_file_or_name(tmp_path: Path) -> None:
    (tmp_path / "a.h").write_text("/* int no(void); */\nint one(int x);\nstatic inline int two(void) { return 1; }\n")
    (tmp_path / "a.c").write_text("int one(int x) { return x; }\n")
    assert frama_c.library_functions(tmp_path) == {"one", "two"}
    assert "lib/refined/goe_health.c:average" in frama_c.library_functions()


@pytest.mark.parametrize(
    ("parameters", "clauses"),
    [
        ("void", ""),
        ("int count, float x", ""),
        ("goe_t *a, const goe_t *b", r"requires \valid(a); requires \valid_read(b);"),
        (
            "const float r[9], float by[restrict GOE_N][3]",
            r"requires \valid_read(r + (0 .. 8)); requires \valid(by + (0 .. GOE_N - 1));",
        ),
        ("const goe_covariance_t covariance", r"requires \valid_read(covariance + (0 .. GOE_QUANTITIES - 1));"),
        ("const goe_view_t *view, goe_rows_t *rows", "requires goe_view_is_open(view); requires goe_rows_hold(rows);"),
        ("goe_view_t *view", r"requires \valid(view) && goe_view_is_open(view);"),
        ("const char **text", r"requires \valid(text);"),
    ],
)
def test_a_contract_is_made_of_a_signature(parameters: str, clauses: str) -> None:
    before = "/* One. */\n#define goe_no(a) (a)\n"
    made_of = contracts.with_contracts(f"{before}static int one({parameters}) {{\n}}\n", "goe_x.c")
    assert made_of == before + (f"/*@ {clauses} */ " if clauses else "") + f"static int one({parameters}) {{\n}}\n"


def test_a_public_function_takes_null() -> None:
    made_of = contracts.with_contracts("void goe_one(goe_t *a);\n", "goe.h")
    assert made_of == "/*@ requires a == \\null || \\valid(a); */ void goe_one(goe_t *a);\n"


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("/*@ requires i < 3; */\nvoid goe_one(const goe_t *a, int i);\n", "goe_x.h"),
        ("void goe_one(goe_t *a) {\n}\n", "goe_x.c"),  # the header has its contract
    ],
)
def test_an_existing_contract_is_kept(text: str, name: str) -> None:
    assert contracts.with_contracts(text, name) == text


def test_no_contract_of_the_library_only_repeats_the_generated_one() -> None:
    """A contract equal to the generated one would only double the work; and generation leaves each other contract as it
    is."""
    for path in sorted(frama_c.LIBRARY.rglob("*.[ch]")):
        text = path.read_text(encoding="utf-8")
        for match in contracts.functions(text, path.suffix == ".c"):
            before = text[: match.start()]
            output = before[before.rfind("/*@") :] if contracts.has_contract(before) else ""
            made_of = contracts.contract(match["parameters"], path.name in PUBLIC_HEADERS)
            assert not output or sorted(re.split(r" && |; requires ", " ".join(output.split())[12:-4])) != sorted(
                re.split(r" && |; requires ", made_of.strip()[12:-4])
            ), f"{path.name}: {match['name']}: remove its contract"


BUILTINS = """#include <stddef.h>
int Frama_C_interval(int low, int high);
unsigned Frama_C_unsigned_int_interval(unsigned low, unsigned high);
float Frama_C_float_interval(float low, float high);
void Frama_C_make_unknown(char *at, size_t size);
"""


def test_the_drivers_compile_with_the_library_as_it_is(tmp_path: Path) -> None:
    (tmp_path / "__fc_builtin.h").write_text(BUILTINS)
    folders = [f"-I{folder}" for folder in (frama_c.LIBRARY, frama_c.DRIVERS, tmp_path)]
    for source in frama_c.DRIVERS.glob("*.c"):
        words = [
            "cc",
            "-std=c99",
            "-fsyntax-only",
            *folders,
            "-include",
            str(frama_c.DRIVERS / "builtins.h"),
            str(source),
        ]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr


def test_the_options_name_functions_that_exist() -> None:
    limits = proof.PLAIN[proof.PLAIN.index("-eva-slevel-function") + 1]
    names = {limit.split(":")[0] for limit in limits.split(",")}
    assert names <= {name.split(":")[-1] for name in frama_c.library_functions()}


def made(driver: str, *entries: Property) -> Run:
    return Run(driver, "gcc_x86_64", 1.0, entries, frozenset({driver}))


def alarm(text: str, status: str = "Unknown") -> Property:
    return Property("lib/goe_x.c", "goe_x", "index_bound", status, text)


def test_new_alarms_gone_ones_and_those_without_a_reason_are_distinguished() -> None:
    found = proof.alarms_of([made("proof_a", alarm("old"), alarm("new"), alarm("proved", "Valid"), alarm("silent"))])
    explained = {
        ("proof_a", *alarm("old").key): "a reason",
        ("proof_a", *alarm("silent").key): " ",
        ("proof_a", *alarm("gone").key): "a reason",
        ("proof_b", *alarm("not run").key): "a reason",
    }
    new, gone, silent = proof.compare(found, explained, {"proof_a"})
    assert [key[-1] for key in new] == ["new"]
    assert [key[-1] for key in gone] == ["gone"]
    assert [key[-1] for key in silent] == ["silent"]


def test_a_precondition_counts_as_proved_only_if_every_call_meets_it() -> None:
    def requires(status: str, text: str) -> Property:
        return Property("lib/goe_x.h", "goe_x", "precondition", status, text)

    runs = [
        made("proof_a", requires("Valid", "valid(x)"), requires("Valid", "i < 3")),
        made("proof_b", requires("Unknown", "i < 3")),
    ]
    assert proof.preconditions(runs) == (1, 2)


def test_the_table_of_alarms_names_drivers_and_functions_that_exist_and_gives_each_a_reason() -> None:
    drivers = {driver.name for driver in proof.ALL}
    with proof.ALARMS.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        assert set(row["drivers"].split()) <= drivers
        assert len(row["reason"].split()) > 3, row
        source = (ROOT / row["file"] if row["file"].startswith("lib/") else ROOT / "tests" / row["file"]).read_text()
        assert re.search(rf"\b{re.sub(r'_[0-9]+$', '', row['function'])}\b", source), row


@pytest.mark.parametrize("name", sorted({driver.name for driver in proof.ALL}))
def test_every_driver_is_defined(name: str) -> None:
    code = "".join(path.read_text() for path in sorted(frama_c.DRIVERS.glob("*.c")))
    assert re.search(rf"^void {name}\(void\)", code, re.MULTILINE)

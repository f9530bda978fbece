"""The cost ledger: measuring, comparing, and the pages that show it."""

from __future__ import annotations

import re
from collections import Counter
from pathlib import Path

import pytest
from bench.running import LedgerError
from ci.__main__ import main
from ci.cost import book, growth, guarantees, instructions, measuring, pages, parts, stack, stated
from ci.cost import ledger as command
from ci.cost.building import Build, library_command, shown_flags
from ci.cost.instructions import PUBLIC
from ci.cost.longest.loop_bounds import Row
from ci.cost.longest.proving import Proof
from ci.cost.longest.trip_counts import Trips
from ci.cost.modules import bytes_of_object
from goe_tools.places import PUBLIC_HEADERS, interface

ROOT = Path(__file__).resolve().parents[2]
ROWS_MOST = 450  # of the ledger: some 11 rows for each public function

# -------------------------------------------------------------------------------------------------------------- stack


@pytest.mark.parametrize(
    ("line", "frame"),
    [
        ("   0:\tpush\t{r4, r5, lr}", 12),
        ("   0:\tstmdb\tsp!, {r4, r5, r6, r7, r8, lr}", 24),
        ("   0:\tstmdb\tsp!, {r4-r8, lr}", 24),
        ("   0:\tvpush\t{d8}", 8),
        ("   0:\tvpush\t{d8-d15}", 64),
        ("   0:\tvpush\t{s16-s19}", 16),
        ("   0:\tsub\tsp, #248\t@ 0xf8", 248),
        ("   0:\tsub.w\tsp, sp, #1024", 1024),
        ("   0:\tstr.w\tlr, [sp, #-4]!", 4),
        ("   0:\taddi\tsp,sp,-32", 32),
        ("   0:\tadd\tsp,sp,-32", 32),
        ("   0:\tadd\tsp,sp,32", 0),
        ("   0:\tadd\tsp, #248", 0),
        ("   0:\tpop\t{r4, pc}", 0),
        ("   0:\tldr\tr0, [sp, #4]", 0),
    ],
)
def test_frames_from_machine_code(line: str, frame: int) -> None:
    assert stack.frame_of_line(line) == frame


@pytest.mark.parametrize(
    ("line", "target"),
    [
        ("   0:\tbl\t1234 <goe_fold_deg>", "1234"),
        ("   0:\tb.w\t12a4 <memcpy>", "12a4"),
        ("   0:\tbne.n\t12 <goe_update+0x10>", None),
        ("   0:\tjal\t80003de8 <__mulsf3>", "80003de8"),
        ("   0:\tjal\tra,80003de8 <__mulsf3>", "80003de8"),
        ("   0:\tj\t80003de8 <memset>", "80003de8"),
    ],
)
def test_calls_from_machine_code(line: str, target: str | None) -> None:
    found = stack.CALL.search(line)
    assert (found.group(1) if found else None) == target


def graph_of(**functions: tuple[int, list[int | str]]) -> dict[int, stack.Function]:
    """Functions at addresses 0, 1, ...: name = (frame, callees)."""
    return {
        address: stack.Function(name, frame, set(callees))
        for address, (name, (frame, callees)) in enumerate(functions.items())
    }


def test_deepest_path_of_a_call_graph() -> None:
    graph = graph_of(top=(16, [1, 2]), shallow=(100, []), deep=(8, [3]), deeper=(96, []))
    assert stack.deepest(graph, 0) == 16 + 8 + 96


def test_recursion_is_refused() -> None:
    """[A10]"""
    with pytest.raises(LedgerError, match="recursion: a -> b -> a"):
        stack.deepest(graph_of(a=(8, [1]), b=(8, [0])), 0)


@pytest.mark.parametrize("callee", [7, "an indirect call"])
def test_an_unknown_callee_is_refused(callee: int | str) -> None:
    with pytest.raises(LedgerError, match="unknown callee: a -> "):
        stack.deepest(graph_of(a=(8, [callee])), 0)


# ------------------------------------------------------------------------------------------------------------ modules


def host_build(tree: Path, library: Path) -> Build:
    """A build of this machine's compiler, as the tools describe it."""
    words = ["gcc", "-std=c99", "-O2", "-DGOE_WINDOW_MAX=8", "-fstack-usage", f"-I{library}"]
    return Build("host", tree, "none", "", "gcc", words, [])


def test_modules_are_named_by_folder_and_file(tmp_path: Path) -> None:
    built = host_build(tmp_path, tmp_path)
    objects = tmp_path / "lib" / "CMakeFiles" / "goe.dir"
    (objects / "image").mkdir(parents=True)
    for name in ("goe_update.c.obj", "image/goe_camera.c.obj", "image/goe_camera.c.su"):
        (objects / name).touch()
    assert [built.module(path) for path in built.library_files("obj")] == ["goe_update", "image/goe_camera"]
    names = instructions.module_names(built)
    assert names == {"goe_update.c.obj": "goe_update", "goe_camera.c.obj": "image/goe_camera"}
    (objects / "goe_camera.c.obj").touch()
    with pytest.raises(LedgerError, match="modules need different file names"):
        instructions.module_names(built)


def test_code_of_an_image_belongs_to_its_modules() -> None:
    text = """
Linker script and memory map
 .text.main     0x00000100       0x10 main.c.obj
 .text.goe_look 0x00000200       0x20 lib/libgoe.a(goe_camera.c.obj)
 .text.unused   0x00000000        0x0 lib/libgoe.a(goe_camera.c.obj)
 .text.start    0x00000300       0x10 port/libgoe_port.a(start.c.obj)
 .text          0x00000110       0x30 /usr/lib/libc.a(memcpy.o)
 .text          0x00000140       0x30 /usr/lib/libgcc.a(_divsi3.o)
"""
    found = instructions.code_of_map(text, {"goe_camera.c.obj": "image/goe_camera"})
    assert [(code.start, code.end, code.module, code.name) for code in found] == [
        (0x110, 0x140, "C library", "memcpy"),
        (0x140, 0x170, "compiler's library", "_divsi3"),
        (0x200, 0x220, "image/goe_camera", "goe_look"),
    ]


def test_bytes_of_an_object_by_kind() -> None:
    sizes = ".text.goe_a  100  0\n.text  8  0\n.rodata.str1.4  20  0\n.bss  4  0\n.comment  99  0\n"
    assert bytes_of_object(sizes) == {"code": 108, "constants": 20, "data": 4}


def test_the_command_of_the_library_is_found_in_folders_too() -> None:
    other = {"command": "gcc -O0 -o tests/CMakeFiles/x.dir/x.c.obj -c x.c"}
    own = {"command": "gcc -Os -std=c99 -fstack-usage -o lib/CMakeFiles/goe.dir/image/goe_camera.c.obj -c y.c"}
    words = library_command([other, own])
    assert words == ["gcc", "-Os", "-std=c99", "-fstack-usage"]
    assert shown_flags([*words, "-fdebug-prefix-map=/home/me/goe=."]) == "-Os -std=c99"
    with pytest.raises(ValueError, match="no file of the library"):
        library_command([other])


# -------------------------------------------------------------------------------------------------------------- parts

PARTS_HEADER = """
#if GOE_WITH_HAZARD && !GOE_WITH_FILTER
#error "the hazard needs the filter method"
#endif
typedef struct {
    char always[100], window[10 * GOE_WITH_WINDOW + 1], filter[1000 * GOE_WITH_FILTER + 1];
} goe_estimator_t;
"""


def library_with_parts(folder: Path, header: str) -> Path:
    """A library in folders in which each part is one function."""
    for part in parts.PARTS:
        lines = ['#include "goe.h"', f"#if GOE_WITH_{part.upper()}", f"int {part}(int a) {{ return 3 * a; }}", "#endif"]
        (folder / part).mkdir(parents=True)
        (folder / part / f"goe_{part}.c").write_text("\n".join([*lines, ""]), encoding="utf-8")
    (folder / "goe.h").write_text(header, encoding="utf-8")
    return folder


def test_parts_are_measured_once_the_header_knows_them(tmp_path: Path) -> None:
    library = library_with_parts(tmp_path / "lib", PARTS_HEADER)
    found = parts.measured_parts(host_build(tmp_path, library), tmp_path, library)
    assert [part.name for part in found] == [
        "window", "filter", "window and filter", "filter and hazard", "everything",
    ]  # fmt: skip
    sizes = {part.name: part.state for part in found}
    assert sizes == {"window": 112, "filter": 1102, "window and filter": 1112, "filter and hazard": 1102,
                     "everything": 1112}  # fmt: skip
    code = {part.name: part.code for part in found}
    assert 0 < code["window"] < code["window and filter"] < code["everything"]


def test_no_parts_without_the_macros(tmp_path: Path) -> None:
    library = library_with_parts(tmp_path / "lib", "/* GOE_WITH_WINDOW alone is not enough */\n")
    assert parts.measured_parts(host_build(tmp_path, library), tmp_path, library) == []
    assert pages.part_table({book.key(book.CODE, book.TOTAL): 1}) == []


def test_a_header_that_does_not_compile_is_no_refusal(tmp_path: Path) -> None:
    library = library_with_parts(tmp_path / "lib", "#include <not_there.h>\n" + PARTS_HEADER)
    with pytest.raises(LedgerError, match=r"not_there\.h"):
        parts.measured_parts(host_build(tmp_path, library), tmp_path, library)


# ----------------------------------------------------------------------------------------------------- ledger's file


def test_a_ledger_reads_as_it_was_written() -> None:
    ledger: book.Ledger = {
        "a": {"compiler": "gcc, 12", "code bytes: total": 3, "instructions: f: mean": 1.5},
        "b": {"compiler": "clang", "code bytes: total": 4, "code bytes: x": 5, "instructions: f: mean": 2.0},
    }
    text = book.text_of(ledger)
    assert book.ledger_of(text) == ledger
    assert text.splitlines()[2:4] == ["code bytes: total,3,4", "code bytes: x,,5"]  # rows of one kind stay together


@pytest.mark.parametrize("text", ["", "target,a\n", "figure,a\ncode,1,2\n"])
def test_no_ledger_is_refused(text: str) -> None:
    with pytest.raises(ValueError, match="ledger"):
        book.ledger_of(text)


def test_measuring_one_target_keeps_the_others() -> None:
    before: book.Ledger = {"m4f-gcc-os": {"x": 1}, "m4f-gcc-o2": {"x": 2}}
    assert command.merged(before, {"m4f-gcc-o2": {"x": 3}, "m0plus-gcc-os": {"x": 4}}) == {
        "m0plus-gcc-os": {"x": 4}, "m4f-gcc-os": {"x": 1}, "m4f-gcc-o2": {"x": 3},
    }  # fmt: skip


def test_growth_beyond_two_percent_is_reported() -> None:
    before: book.Figures = {"code": 1000, "data bytes: total": 0, "compiler": "x"}
    same: book.Figures = {"data bytes: total": 0}
    assert growth.grown(before, {**same, "code": 1020, "compiler": "y"}) == []
    assert growth.grown(before, {**same, "code": 1021}) == ["code: 1000 -> 1021"]
    assert growth.grown(before, {"code": 1, "data bytes: total": 1}) == ["data bytes: total: 0 -> 1"]
    assert growth.grown(before, {**same, "code": 1, "rodata": 1}) == ["rodata: 1, not in the ledger"]
    assert growth.grown(before, {**same, "code": 1, "data bytes: goe_x": 1}) == [
        "data bytes: goe_x: 1, not in the ledger"
    ]
    assert growth.grown(before, same) == ["code: 1000 in the ledger, no longer measured"]


def test_targets_of_another_compiler_are_named_not_compared(capsys: pytest.CaptureFixture[str]) -> None:
    before: book.Ledger = {"a": {"compiler": "12", "code": 1}, "b": {"compiler": "12", "code": 1}}
    now: book.Ledger = {name: {"compiler": "13", "code": 2} for name in "ac"} | {"b": {"compiler": "12", "code": 2}}
    assert growth.compare(before, now) == ["c: not in the ledger", "b: code: 1 -> 2"]
    assert "skipped: a: " in capsys.readouterr().out


# -------------------------------------------------------------------------------------------------------------- pages


def committed() -> book.Ledger:
    return book.read(command.LEDGER)


def test_committed_pages_show_the_committed_ledger() -> None:
    """[A23]"""
    assert pages.wrong_pages(ROOT, committed()) == []
    assert len(command.LEDGER.read_text(encoding="utf-8").splitlines()) < ROWS_MOST


def copy_of_pages(folder: Path) -> Path:
    for page in (*pages.PAGES, *(Path("lib") / name for name in PUBLIC_HEADERS)):
        (folder / page).parent.mkdir(parents=True, exist_ok=True)
        (folder / page).write_bytes((ROOT / page).read_bytes())
    return folder


def test_a_figure_that_only_the_ledger_has_is_reported(tmp_path: Path) -> None:
    root, ledger = copy_of_pages(tmp_path), committed()
    ledger["m4f-gcc-os"]["code bytes: total"] = 1
    assert [text.split(":")[0] for text in pages.wrong_pages(root, ledger)] == ["README.md", "tests/targets/LEDGER.md"]
    pages.write_pages(root, ledger)
    assert pages.wrong_pages(root, ledger) == []


def test_measurements_are_written_to_the_ledger_and_its_pages(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    root, file = copy_of_pages(tmp_path), tmp_path / "ledger.csv"
    book.write(file, committed())
    now = committed()["m4f-gcc-os"] | {"stack bytes painted: goe_update": 4321}
    monkeypatch.setattr(command, "ROOT", root)
    monkeypatch.setattr(command, "measured", lambda wanted, folder, jobs: {preset: now for preset in wanted})
    rest = ["--ledger", str(file), "m4f-gcc-os"]
    assert main(["ledger", "--check", *rest]) == 1
    assert "m4f-gcc-os: stack bytes painted: goe_update: " in capsys.readouterr().err
    assert main(["ledger", "--write", *rest]) == 0
    assert book.read(file) == committed() | {"m4f-gcc-os": now}
    assert all(" (4321) |" in (root / page).read_text(encoding="utf-8") for page in pages.PAGES)
    assert main(["ledger", "--check", *rest]) == 0
    assert main(["ledger", "--check-pages", "--ledger", str(file)]) == 0


def test_a_guarantee_that_the_readme_does_not_state_is_reported(tmp_path: Path) -> None:
    """[A23]"""
    root = copy_of_pages(tmp_path)
    readme = root / "README.md"
    text = readme.read_text(encoding="utf-8")
    assert text.count("59,150 instructions") == 2
    readme.write_text(text.replace("59,150 instructions", "few instructions"), encoding="utf-8")
    assert ["59,150 instructions" in wrong for wrong in pages.wrong_pages(root, committed())] == [True]


def test_a_cost_that_the_header_understates_is_reported(tmp_path: Path) -> None:
    """[A23]"""
    root = copy_of_pages(tmp_path)
    ledger = committed()
    header = root / "lib" / "goe_hazard.h"
    limits = stated.stated(interface(root / "lib"))
    assert limits["instructions proved: goe_update"] == 59150
    assert limits["instructions proved: goe_update with lens distortion"] == 82100
    assert limits["instructions proved: goe_update, window"] == 5700
    assert len(limits) == 2 * len(PUBLIC) + 2
    hazard = r"at most \d+ instructions(, \d+ bytes of stack\. \*/\nGOE_NODISCARD goe_status_t goe_hazard\()"
    text = re.sub(hazard, r"at most 10 instructions\1", header.read_text(encoding="utf-8"))
    header.write_text(text, encoding="utf-8")
    proved = ledger[stated.TARGET]["instructions proved: goe_hazard"]
    assert pages.wrong_pages(root, ledger) == [
        f"public headers: instructions proved: goe_hazard: at most 10, but {stated.TARGET} has {proved}"
    ]
    (root / "lib" / "goe.h").write_text("nothing", encoding="utf-8")
    with pytest.raises(ValueError, match="state no cost of goe_settings_default, goe_init"):
        pages.wrong_pages(root, ledger)


def test_a_broken_promise_is_reported() -> None:
    ledger = committed()
    assert guarantees.broken_promises(ledger) == []
    ledger["m4f-gcc-o2"]["instructions proved: goe_update"] = 59151
    ledger["m4f-clang-os"]["instructions: goe_update: max"] = 99999  # a target without a promise
    ledger["rv32imac-gcc-o2"]["data bytes: total"] = 4
    ledger["m4f-gcc-o2"]["calls to other libraries"] = "memcpy malloc"
    assert guarantees.broken_promises(ledger) == [
        "m4f-gcc-o2: instructions proved: goe_update: 59151, promised 59150",
        "m4f-gcc-o2: the library calls malloc",
        "rv32imac-gcc-o2: data bytes: total: 4, promised 0",
    ]


def test_the_table_of_guarantees_shows_where_they_do_not_apply() -> None:
    ledger = committed()
    for preset, value in zip(guarantees.M4F, (2048, 1000, 2049, 1)):
        ledger[preset]["stack bytes computed: goe_update"] = value
    row = next(line for line in guarantees.rows(ledger) if "2,048 bytes of stack" in line)
    cells = [cell.strip() for cell in row.strip("|").split("|")]
    assert cells[1:] == [
        "Cortex-M4F gcc -Os (2,048), gcc -O2 (1,000), clang -O2 (1)", "Cortex-M4F clang -Os (2,049)",
    ]  # fmt: skip


def test_measured_is_at_most_proved_is_at_most_stated() -> None:
    """[A23]"""
    figures = committed()[stated.TARGET]
    limits = stated.stated(interface())
    proved = book.below(figures, book.PROVED)
    assert set(PUBLIC) < set(proved)
    for name in proved:
        most = book.number(figures, book.PROVED, name)
        assert 0 < book.number(figures, book.INSTRUCTIONS, name, "max") <= most
        assert most <= limits.get(book.key(book.PROVED, name), most)


def test_a_contradiction_of_the_proof_stops_the_ledger(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    measured: book.Figures = {"instructions: goe_update: max": 11}
    built = Build("m4f-gcc-o2", tmp_path, "none", "", "gcc", [], [])
    row = Row(7, "loop", "f", "#1", "", "3", "entry", "for a test")
    trips = [Trips("f", 0x100, row, turns, 3) for turns in (3, 4)]
    monkeypatch.setattr(Build, "image", lambda built, kind: tmp_path / kind)
    monkeypatch.setattr(measuring, "code_of", lambda built, image: None)
    for most, turned, lines, wrong in (
        (11, 1, [], ""),
        (10, 1, [], "goe_update: 11 instructions measured, 10 proved"),
        (11, 2, [], "f at 100: counted 4, line 7 of the table has 3"),
        (11, 1, ["line 9: loop g: #1"], "m4f-gcc-o2: line 9: loop g: #1"),
    ):
        proof = Proof(most, Counter())
        monkeypatch.setattr(measuring, "proofs", lambda code, proof=proof: {"goe_update": proof})
        monkeypatch.setattr(measuring, "unused", lambda code, lines=lines: lines)
        monkeypatch.setattr(measuring, "turns", lambda *_, turned=turned: trips[:turned])
        if wrong:
            with pytest.raises(LedgerError, match=wrong):
                measuring.proved_figures(built, measured, tmp_path)
        else:
            found = measuring.proved_figures(built, measured, tmp_path)
            assert found == {"instructions proved: goe_update": 11}


def test_parts_have_a_table_of_their_own() -> None:
    ledger = committed()
    ledger[parts.PARTS_PRESET] |= {
        book.key(book.PART_BYTES, "window"): 7000,
        book.key(book.PART_STATE, "window"): 500,
    }
    assert "| window | 7000 | 500 |" in pages.ledger_tables(ledger).splitlines()

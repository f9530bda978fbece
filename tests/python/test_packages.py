"""Packages for package managers: every manifest agrees with the library, and no file is missing."""

from __future__ import annotations

import ast
import dataclasses
import json
import math
import re
import shutil
import zipfile
from pathlib import Path

import pytest
from ci.__main__ import main
from ci.packages.command import differences
from ci.packages.facts import Facts
from ci.packages.staging import OF_THE_TREE, Words
from ci.packages.targets import COMMITTED, CONFIG, TABLES, TARGETS

ROOT = Path(__file__).resolve().parents[2]
FACTS = Facts()
WORDS = Words('NAME "N" <maintainer@goe.invalid>', "https://goe.invalid/?a=1&b=2")
HEADINGS = ["From this tree", "Into a project", "Parts", "Tests", "Limits"]
PAGES = ("arduino", "conan", "debian", "esp-idf", "pkgconfig", "platformio", "python", "rust")

# From Arduino's library specification.
ARDUINO_CATEGORIES = (
    "Communication", "Data Processing", "Data Storage", "Device Control", "Display", "Other", "Sensors",
    "Signal Input/Output", "Timing", "Uncategorized",
)  # fmt: skip
ARDUINO_FIELDS = (
    "name", "version", "author", "maintainer", "sentence", "paragraph", "category", "url", "architectures",
)  # fmt: skip
ARDUINO_OPTIONAL = ("depends", "dot_a_linkage", "includes", "precompiled", "ldflags", "license")


@pytest.fixture(scope="module")
def staged(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """All targets, with the data of a publisher."""
    folder = tmp_path_factory.mktemp("packages") / "out"
    words = ("--maintainer", WORDS.maintainer, "--url", WORDS.url)
    assert main(["packages", "--out", str(folder), *words]) == 0
    return folder


def below(folder: Path, ending: str) -> set[str]:
    return {path.relative_to(folder).as_posix() for path in folder.rglob(f"*{ending}")}


# ------------------------------------------------------------------------------------------------------------ the facts


def test_the_facts_are_those_of_the_sources() -> None:
    """[GOE_CAMERAS_MAX, GOE_WINDOW_MAX]"""
    cmake = (ROOT / "CMakeLists.txt").read_text(encoding="utf-8")
    options = set(re.findall(r"^option\((GOE_WITH_\w+) ", cmake, re.MULTILINE))
    assert {part.define for part in FACTS.parts} == options
    assert [part.name for part in FACTS.parts] == ["window", "filter", "hazard", "target_motion"]
    assert set(FACTS.sources) == below(ROOT / "lib", ".c") and len(FACTS.sources) > 40
    limits = {limit.define: (limit.low, limit.high, limit.default) for limit in FACTS.limits}
    assert limits == {"GOE_WINDOW_MAX": (3, 64, 8), "GOE_CAMERAS_MAX": (1, 8, 1), "GOE_FLIGHT_SLOTS": (1, 16, 4)}


def test_manifests_in_the_tree_are_renewed() -> None:
    assert differences(FACTS) == []
    assert main(["packages", "--check"]) == 0


@pytest.fixture
def small_tree(tmp_path: Path) -> Path:
    """The files that --check and --write read."""
    for name in (
        *COMMITTED,
        *TABLES,
        "port/companion/obstacle_class.c",
        "lib/goe.h",
        "lib/goe_limits.h",
        "port/rust/Cargo.toml.j2",
        "port/python/pyproject.toml.j2",
    ):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(ROOT / name, tmp_path / name)
    return tmp_path


def test_write_mends_the_manifests_that_check_refuses(small_tree: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    crate, tools = small_tree / "port" / "rust" / "Cargo.toml", small_tree / "tools" / "pyproject.toml"
    crate.write_text("something else")
    tools.write_text(re.sub(r'^version = ".*"$', 'version = "9.9.9"', tools.read_text(), flags=re.MULTILINE))
    monkeypatch.setattr(Facts, "__init__", lambda self: object.__setattr__(self, "root", small_tree))
    assert main(["packages", "--check"]) == 1
    assert main(["packages", "--write"]) == 0
    assert main(["packages", "--check"]) == 0
    for name in COMMITTED:
        assert (small_tree / name).read_bytes() == (ROOT / name).read_bytes(), name


def test_another_size_of_a_class_is_noticed(small_tree: Path) -> None:
    """In a tree whose companion has another table than the Python package."""
    table, facts = small_tree / "port" / "companion" / "obstacle_class.c", dataclasses.replace(FACTS, root=small_tree)
    text = table.read_text()
    table.write_text(text.replace('{"car", {1.8f, 4.8f}', '{"car", {1.7f, 4.8f}'))
    assert [line.split(":")[0] for line in differences(facts)] == list(TABLES)
    assert '"car": ((1.7, 4.8), (1.35, 1.85), "OTHER"),' in TABLES["port/python/src/goe/_kinds.py"](facts)
    table.write_text(text.replace("{1.8f, 4.8f}", "{SMALL, 4.8f}"))
    with pytest.raises(ValueError, match="its table is not understood"):
        differences(facts)


def test_another_version_is_noticed(small_tree: Path) -> None:
    """[GOE_VERSION_MAJOR, GOE_VERSION_MINOR, GOE_VERSION_PATCH]
    In a tree whose goe.h has a newer version than its manifests."""
    header = small_tree / "lib" / "goe.h"
    header.write_text(header.read_text().replace("#define GOE_VERSION_PATCH 0", "#define GOE_VERSION_PATCH 7"))
    facts = dataclasses.replace(FACTS, root=small_tree)
    patched = f"{FACTS.version.rpartition('.')[0]}.7"
    assert facts.version == patched
    assert [line.split(":")[0] for line in differences(facts)] == list(COMMITTED)
    assert all(f'version = "{patched}"' in text(facts) for text in COMMITTED.values())


@pytest.mark.parametrize("words", [("--target", "rust"), ("--url", "https://goe.invalid/"), ("--maintainer", "NAME")])
def test_words_for_staging_alone(words: tuple[str, str], capsys: pytest.CaptureFixture[str]) -> None:
    for what in ("--check", "--write"):
        assert main(["packages", what, *words]) == 2
        assert "require --out" in capsys.readouterr().err


def test_a_header_without_parts_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "lib").mkdir()
    (tmp_path / "lib" / "goe.h").write_text("#define GOE_VERSION_MAJOR 1\n")
    facts = dataclasses.replace(FACTS, root=tmp_path)
    for what in ("version", "parts"):
        with pytest.raises(ValueError, match=r"lib/goe"):
            getattr(facts, what)


def test_nothing_is_written_over(staged: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["packages", "--target", "conan", "--out", str(staged)]) == 2
    assert "exists already" in capsys.readouterr().err


def test_all_or_none_is_staged(tmp_path: Path) -> None:
    (tmp_path / "rust").mkdir()
    assert main(["packages", "--out", str(tmp_path)]) == 2
    assert [path.name for path in tmp_path.iterdir()] == ["rust"]


def test_words_that_would_break_a_manifest(tmp_path: Path) -> None:
    assert main(["packages", "--out", str(tmp_path / "out"), "--maintainer", "NAME\nurl=x"]) == 2
    assert not (tmp_path / "out").exists()


# --------------------------------------------------------------------------------------------------------- staged files


def test_the_read_me_commands_stage_one_target(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for target in ("arduino", "conan", "esp-idf", "platformio", "python", "rust"):
        assert main(["packages", "--target", target, "--out", str(tmp_path)]) == 0
    assert {path.name for path in tmp_path.iterdir()} == set(TARGETS)
    assert str(tmp_path / "esp-idf" / "goe") in capsys.readouterr().out.splitlines()


def test_only_sources_are_staged(staged: Path, tmp_path: Path) -> None:
    """No other file of the tree is staged: build products, caches, editors' files."""
    root = tmp_path / "root"
    for name in ("lib", "port"):
        shutil.copytree(ROOT / name, root / name, ignore=shutil.ignore_patterns("target", "__pycache__"))
    for name in ("LICENSE", "CMakeLists.txt"):
        shutil.copyfile(ROOT / name, root / name)
    for folder in ("lib", "port/flight", "port/rust/src", "port/conan/test_package", "port/cmake"):
        for name in ("build/x.c", "build-deb/x.h", "__pycache__/x.py", ".cache/x.c", "x.c.orig", "x.o", "target/x.rs"):
            (root / folder / name).parent.mkdir(exist_ok=True)
            (root / folder / name).write_text("junk")
    facts = dataclasses.replace(FACTS, root=root)
    for target, stage in TARGETS.items():
        stage(facts, WORDS, tmp_path / target)
        assert below(tmp_path / target, "") == below(staged / target, ""), target


PLACES = {  # of the library's and of the flight layer's sources
    "arduino": ("goe/src", "goe_flight/src"),
    "platformio": ("goe/src", "goe_flight/src"),
    "esp-idf": ("goe/lib", "goe/flight"),
    "conan": ("goe/lib", "goe/port/flight"),
    "python": ("goe/csrc/lib", "goe/csrc/flight"),
    "rust": ("goe/csrc/lib", "goe/csrc/flight"),
}


@pytest.mark.parametrize("target", sorted(TARGETS))
def test_no_source_is_missing_or_changed(staged: Path, target: str) -> None:
    for source, place in zip(("lib", "port/flight"), PLACES[target]):
        for ending in (".c", ".h"):
            names = below(staged / target / place, ending) - {"goe_config.h"}
            assert names == below(ROOT / source, ending)
            for name in names:
                text = (staged / target / place / name).read_text(encoding="utf-8")
                if target == "arduino" and name == "goe_limits.h":
                    text = text.replace(CONFIG, "")
                assert text == (ROOT / source / name).read_text(encoding="utf-8"), name


@pytest.mark.parametrize("target", sorted(TARGETS))
def test_page_licence_and_words(staged: Path, target: str) -> None:
    for folder in {place.split("/")[0] for place in PLACES[target]}:
        stage = staged / target / folder
        assert (stage / "LICENSE").read_text().startswith("MIT License")
        page = (stage / "README.md").read_text(encoding="utf-8")
        for link in re.findall(r"\]\(([^)#]+)\)", page):
            place = (stage / link).resolve()
            assert place.exists() and place.is_relative_to(stage), f"{target}: {link} leads nowhere"
        assert re.findall(r"^## (.*)$", page, re.MULTILINE) == ["Into a project", "Parts", "Limits"]
        assert "<version>" not in page and not re.search(r"goe_tools|python -m (bench|ci)\b", page)
    texts = [path.read_text() for path in (staged / target).rglob("*") if path.is_file() and path.suffix != ".zip"]
    assert not any("{{ facts" in text or "{%" in text for text in texts)
    assert sum(WORDS.url in text for text in texts) >= 1


@pytest.mark.parametrize("host", PAGES)
def test_page_of_the_tree(host: str) -> None:
    """copy_page() relies on the same headings in the same order."""
    page = (ROOT / "port" / host / "README.md").read_text(encoding="utf-8")
    assert re.findall(r"^## (.*)$", page, re.MULTILINE) == HEADINGS
    assert set(OF_THE_TREE) <= set(HEADINGS)
    assert "```console" not in page and not re.search(r"\d (Jan|Nov|Dec)\w* 20\d\d", page)


def test_links_out_of_a_package_go(tmp_path: Path) -> None:
    """Also if by chance a file exists at their target."""
    (tmp_path / "flight").mkdir()
    (tmp_path / "flight" / "README.md").write_text("another page")
    (folder, _) = TARGETS["arduino"](FACTS, WORDS, tmp_path)
    assert (folder / "../flight/README.md").exists()
    assert "../flight" not in (folder / "README.md").read_text(encoding="utf-8")


def test_figures_of_pages_and_manifests() -> None:
    """The numbers in pages and manifests are those of the library's pages."""
    sizes = re.findall(r"^\| 8 \| (\d{4}) \|$", (ROOT / "lib" / "README.md").read_text(encoding="utf-8"), re.MULTILINE)
    (size,) = map(int, sizes)
    assert f"at most {math.ceil(size / 102.4) / 10} KiB" in FACTS.paragraph
    ledger = (ROOT / "README.md").read_text(encoding="utf-8").split("<!-- ledger: begin -->")[1]
    stacks = [int(n) for n in re.findall(r"^\| Cortex[^|]*\|[^|]*\| \d+ \| (\d+) \(\d+\) \|", ledger, re.MULTILINE)]
    stack = f"{min(stacks) / 1000:.1f} to {max(stacks) / 1000:.1f} KB"
    (layer,) = re.findall(r"some (\d+) bytes beyond", (ROOT / "port/flight/README.md").read_text(encoding="utf-8"))
    for host in ("arduino", "esp-idf"):
        page = (ROOT / "port" / host / "README.md").read_text(encoding="utf-8")
        assert f"`goe_update()` takes {stack}\n" in page and f"at most {size:,} bytes each" in page
        assert f"`goe_flight_frame()` {int(layer) / 1000:.1f} KB more" in page
    meson = re.findall(r"version: '>=(.*)'", (ROOT / "port" / "pkgconfig" / "README.md").read_text(encoding="utf-8"))
    assert meson == [FACTS.version.rpartition(".")[0]]


def test_arduino_properties(staged: Path) -> None:
    """The rules of the library specification that a manifest can violate."""
    for name in ("goe", "goe_flight"):
        lines = (staged / "arduino" / name / "library.properties").read_text(encoding="ascii").splitlines()
        fields = dict(line.split("=", 1) for line in lines)
        assert len(fields) == len(lines)
        assert set(ARDUINO_FIELDS) <= set(fields) <= {*ARDUINO_FIELDS, *ARDUINO_OPTIONAL}
        assert all(value == value.strip() and value for value in fields.values())
        assert fields["name"] == name and re.fullmatch(r"[A-Za-z0-9][A-Za-z0-9_.\- ]{0,62}", name)
        assert "arduino" not in name.lower() and not re.search(r"\b(library|lib)\b", name.lower())
        assert fields["version"] == FACTS.version and re.fullmatch(r"\d+\.\d+\.\d+", FACTS.version)
        assert fields["maintainer"] == WORDS.maintainer and fields["url"] == WORDS.url
        assert fields["category"] in ARDUINO_CATEGORIES and fields["license"] == "MIT"
        assert not fields["paragraph"].startswith(fields["sentence"])
        assert re.fullmatch(r"[\w-]+(,[\w-]+)*", fields["architectures"]) and "avr" not in fields["architectures"]
        headers = [staged / "arduino" / name / "src" / header for header in fields["includes"].split(",")]
        assert all(header.is_file() for header in headers)
        assert fields.get("depends") == ({"goe": None, "goe_flight": f"goe (={FACTS.version})"}[name])
    example = staged / "arduino" / "goe" / "examples" / "Approach" / "Approach.ino"  # same name for folder and sketch
    assert example.is_file()


def test_arduino_archive(staged: Path, tmp_path: Path) -> None:
    archive = staged / "arduino" / f"goe-{FACTS.version}.zip"
    with zipfile.ZipFile(archive) as packed:
        names = set(packed.namelist())
        assert all(name.startswith("goe/") for name in names) and packed.testzip() is None
    assert {"goe/library.properties", "goe/src/goe.h", "goe/src/image/goe_align.c"} <= names
    again = TARGETS["arduino"](FACTS, WORDS, tmp_path / "arduino")
    assert (again[0].parent / archive.name).read_bytes() == archive.read_bytes()


def test_arduino_config(staged: Path) -> None:
    """[A24]"""
    text = (staged / "arduino" / "goe" / "src" / "goe_config.h").read_text(encoding="utf-8")
    defined = dict(re.findall(r"^#define (GOE_\w+) (\d+) ", text, re.MULTILINE))
    assert defined == {
        **{part.define: "1" for part in FACTS.parts},
        **{limit.define: str(limit.default) for limit in FACTS.limits},
    }


def test_platformio_manifest(staged: Path) -> None:
    for name in ("goe", "goe_flight"):
        manifest = json.loads((staged / "platformio" / name / "library.json").read_text(encoding="utf-8"))
        assert (manifest["name"], manifest["version"], manifest["license"]) == (name, FACTS.version, "MIT")
        assert (staged / "platformio" / name / "src" / manifest["headers"]).is_file()
        assert manifest.get("dependencies") == (None if name == "goe" else {"goe": FACTS.version})
        assert "-ffp-contract=off" in manifest["build"]["flags"] and manifest["homepage"] == WORDS.url
        assert manifest["platforms"] == sorted(set(manifest["platforms"]))
        assert not {"*", "atmelavr", "atmelmegaavr", "ststm8", "intel_mcs51", "timsp430"} & set(manifest["platforms"])
        assert len(manifest["description"]) <= 255 and all(word.islower() for word in manifest["keywords"])


def test_esp_idf_manifest_and_files(staged: Path) -> None:
    folder = staged / "esp-idf" / "goe"
    manifest = (folder / "idf_component.yml").read_text(encoding="utf-8")
    assert f'version: "{FACTS.version}"\n' in manifest and "license: MIT\n" in manifest
    assert f"\n  - {json.dumps(WORDS.maintainer)}\n" in manifest and f"\nurl: {json.dumps(WORDS.url)}\n" in manifest
    cmake = (folder / "CMakeLists.txt").read_text(encoding="utf-8")
    listed = set(re.findall(r"^ +((?:lib|flight)/\S+\.c)$", cmake, re.MULTILINE))
    assert listed == below(folder, ".c") - {"examples/approach/main/approach.c"}
    kconfig = (folder / "Kconfig").read_text(encoding="utf-8")
    assert all(f"\nconfig {part.define}\n" in kconfig for part in FACTS.parts)


def test_conan_recipe(staged: Path) -> None:
    text = (staged / "conan" / "goe" / "conanfile.py").read_text(encoding="utf-8")
    recipe = {
        target.id: ast.literal_eval(node.value)
        for top in ast.parse(text).body
        for node in (top.body if isinstance(top, ast.ClassDef) else [top])
        if isinstance(node, ast.Assign)
        for target in node.targets
        if isinstance(target, ast.Name)
    }
    assert (recipe["author"], recipe["url"], recipe["topics"]) == (WORDS.maintainer, WORDS.url, FACTS.keywords)
    assert recipe["LIMITS"] == {"window_max": ("GOE_WINDOW_MAX", 3, 64), "cameras_max": ("GOE_CAMERAS_MAX", 1, 8)}
    assert recipe["required_conan_version"] == ">=2.4"
    assert 'rm_safe("with_target_motion")' in text and '"cmake_target_name", "goe::all"' in text
    assert f'    version = "{FACTS.version}"\n' in text and '    license = "MIT"\n' in text
    assert all(f'"with_{part.name}": [True, False]' in text for part in FACTS.parts)


def test_cargo_manifest(staged: Path) -> None:
    text = (staged / "rust" / "goe" / "Cargo.toml").read_text(encoding="utf-8")
    assert f'version = "{FACTS.version}"\n' in text and "[workspace]" not in text
    features = dict(re.findall(r"^(\w+) = \[(.*)\]$", text.split("[features]")[1], re.MULTILINE))
    assert set(features) == {"default", "flight", *(part.name for part in FACTS.parts)}
    assert sorted(re.findall(r'"(\w+)"', features["default"])) == sorted(set(features) - {"default"})
    assert f"homepage = {json.dumps(WORDS.url)}\n" in text
    # Tools of the tests are pinned in a place that no dependent reads.
    assert re.findall(r'^cc = "(.*)"$', text, re.MULTILINE) == ["1.1"]
    golden = (ROOT / "port" / "rust" / "golden" / "Cargo.toml").read_text(encoding="utf-8")
    assert re.findall(r'^cc = "(.*)"$', golden, re.MULTILINE)[0].startswith("=1.")

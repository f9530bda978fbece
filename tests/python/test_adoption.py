"""Files that code hosts and package managers read: workflow, templates, citation, release dates, home page."""

from __future__ import annotations

import datetime
import re
from pathlib import Path
from typing import Any

import pytest
import yaml
from ci.__main__ import main
from ci.packages.facts import Facts

ROOT = Path(__file__).resolve().parents[2]
HOST = ROOT / ".github"
FACTS = Facts()
URL = re.compile(r"https?://[^\s\"'<>)\]}`]+")
OWN = re.compile(r"(?<![a-z0-9])goe(?![a-z0-9])")  # the project's name in a URL
FOR_TESTS = ".invalid"  # a domain reserved by RFC 2606
SOURCES = (".github", "lib", "port", "sim_host", "tests", "tools")


def loaded(path: Path) -> Any:
    return yaml.safe_load(path.read_text(encoding="utf-8"))


def texts() -> dict[Path, str]:
    """All text files of the tree without build products and downloads."""
    found = {}
    for path in (p for folder in SOURCES for p in (ROOT / folder).rglob("*")):
        built = {"__pycache__", "target", "node_modules"} & set(path.parts) or ".egg-info" in str(path)
        if path.is_file() and not built and path.stat().st_size < 2_000_000:
            content = path.read_bytes()
            if b"\0" not in content:
                found[path] = content.decode("utf-8", "replace")
    return found | {ROOT / name: (ROOT / name).read_text(encoding="utf-8") for name in ("README.md", "CMakeLists.txt")}


# ------------------------------------------------------------------------------------------------------- home page


def strays(found: dict[Path, str], url: str) -> list[str]:
    """URLs of the project that are neither the URL of CMakeLists.txt nor below it."""
    return [
        f"{path.name}: {other}"
        for path, text in found.items()
        for other in URL.findall(text)
        if OWN.search(other) and FOR_TESTS not in other and not re.match(rf"{re.escape(url)}(\.git|[/.,;]|$)", other)
    ]


def test_no_other_home_page_is_named() -> None:
    found = texts()
    assert len(found) > 500 and strays(found, FACTS.url) == []


def test_a_stray_home_page_is_found() -> None:
    other = "https://host.example"  # split, because the search includes this file
    moved = {Path("a.md"): f"{FACTS.url}.git", Path("b.md"): f"see {other}/me/goe/wiki", Path("c.md"): f"{other}/goer"}
    assert strays(moved, FACTS.url) == [f"b.md: {other}/me/goe/wiki"]
    assert strays({Path("a.md"): FACTS.url}, f"{other}/goe") == [f"a.md: {FACTS.url}"]


def test_packages_have_the_home_page(tmp_path: Path) -> None:
    assert main(["packages", "--out", str(tmp_path)]) == 0
    manifests = {
        "arduino": "library.properties", "conan": "conanfile.py", "esp-idf": "idf_component.yml",
        "platformio": "library.json", "python": "pyproject.toml", "rust": "Cargo.toml",
    }  # fmt: skip
    for target, name in manifests.items():
        files = list((tmp_path / target).rglob(name))
        assert files and all(FACTS.url in file.read_text(encoding="utf-8") for file in files[:1]), target


def test_pkg_config_has_the_home_page() -> None:
    assert "URL: @PROJECT_HOMEPAGE_URL@\n" in (ROOT / "port" / "pkgconfig" / "goe.pc.in").read_text(encoding="utf-8")


def test_a_tree_without_a_home_page_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "CMakeLists.txt").write_text("project(goe)\n")
    with pytest.raises(ValueError, match="HOMEPAGE_URL"):
        _ = Facts(tmp_path).url


# ------------------------------------------------------------------------------------------------------- code host


def test_the_workflow_runs_the_two_commands() -> None:
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    block = readme.split("## Two commands")[1].split("```sh\n")[1].split("```")[0]
    commands = [line.split("#")[0].strip() for line in block.splitlines()]
    workflow = loaded(HOST / "workflows" / "test.yml")
    ran = [step["run"] for job in workflow["jobs"].values() for step in job["steps"] if "run" in step]
    assert len(commands) == 2 and set(commands) <= set(ran)
    assert workflow["permissions"] == {"contents": "read"}
    assert all(job["container"].startswith("debian:") and job["timeout-minutes"] for job in workflow["jobs"].values())


def test_issue_forms() -> None:
    forms = sorted((HOST / "ISSUE_TEMPLATE").glob("*.yml"))
    assert len(forms) == 3
    for path in forms:
        form = loaded(path)
        if path.name == "config.yml":
            assert [link["url"] for link in form["contact_links"]] == [FACTS.url]
            continue
        assert form["name"] and form["description"]
        ids = [field["id"] for field in form["body"]]
        assert len(ids) == len(set(ids))
        for field in form["body"]:
            assert field["type"] in ("input", "textarea", "dropdown") and field["attributes"]["label"]


def test_files_that_the_pull_request_names() -> None:
    named = re.findall(r"`([\w./]+/[\w.]+)`", (HOST / "pull_request_template.md").read_text(encoding="utf-8"))
    assert len(named) >= 3 and all((ROOT / name).is_file() for name in named)


# -------------------------------------------------------------------------------------------------------- releases


def releases() -> list[tuple[str, str]]:
    """Version and date of each section of the changelog except "Next"."""
    text = (ROOT / "lib" / "CHANGELOG.md").read_text(encoding="utf-8")
    sections = [line[3:] for line in re.findall(r"^## .*$", text, re.MULTILINE) if line != "## Next"]
    found = [re.fullmatch(r"(\d+\.\d+\.\d+) \((\d{4}-\d\d-\d\d)\)", section) for section in sections]
    assert all(found), sections
    return [(match[1], match[2]) for match in found if match]


def test_releases_are_dated_newest_first() -> None:
    found = releases()
    versions = [tuple(map(int, version.split("."))) for version, _ in found]
    dates = [datetime.date.fromisoformat(date) for _, date in found]
    assert len(found) >= 3
    assert versions == sorted(versions, reverse=True) and dates == sorted(dates, reverse=True)


def test_citation() -> None:
    """The citation names the newest release and the paper that the method starts from."""
    cited = loaded(HOST / "CITATION.cff")
    assert {"cff-version", "message", "title", "authors"} <= cited.keys()  # required by the format
    assert (cited["version"], cited["date-released"]) == releases()[0]
    assert cited["authors"] == [{"name": "goe maintainers"}]
    assert (cited["license"], cited["url"]) == (FACTS.license, FACTS.url)
    (paper,) = cited["references"]
    assert paper["title"] in " ".join((ROOT / "README.md").read_text(encoding="utf-8").split())
    assert paper["authors"][0]["family-names"] == "Bauer" and paper["year"] == 2019

"""Fills a folder for a package manager."""

from __future__ import annotations

import json
import re
import shutil
from dataclasses import dataclass
from pathlib import Path

import jinja2

from .facts import Facts

LINK = re.compile(r"\[([^\[\]]*)\]\((?!https?:|#)([^)#]+)(#[^)]*)?\)")
SECTION = re.compile(r"^## ", re.MULTILINE)
OF_THE_TREE = ("From this tree", "Tests")  # sections of a page that do not apply to a package


@dataclass(frozen=True)
class Words:
    """Information from the publisher, which is not in the project."""

    maintainer: str = Facts.owner
    url: str = ""

    def __post_init__(self) -> None:
        for word in (self.maintainer, self.url):
            if not word.isprintable():
                raise ValueError(f"{word!r}: manifests cannot contain such characters")


def quoted(text: str) -> str:
    """Quoted for JSON, Python, TOML and YAML. (Jinja's tojson writes an address's < and > as numbers.)"""
    return json.dumps(text, ensure_ascii=False)


def render(facts: Facts, template: str, **more: object) -> str:
    """Renders a template of port/ with the facts."""
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(facts.root / "port"), undefined=jinja2.StrictUndefined, trim_blocks=True,
        lstrip_blocks=True, keep_trailing_newline=True, autoescape=False,
    )  # fmt: skip
    environment.filters["quoted"] = quoted
    return environment.get_template(template).render(facts=facts, **more)


@dataclass(frozen=True)
class Stage:
    """One package's folder, which must not exist before."""

    facts: Facts
    words: Words
    folder: Path

    def write(self, name: str, text: str) -> None:
        place = self.folder / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_text(text, encoding="utf-8", newline="\n")

    def render(self, name: str, template: str, **more: object) -> None:
        self.write(name, render(self.facts, template, words=self.words, **more))

    def copy(self, source: str, name: str) -> None:
        place = self.folder / name
        place.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(self.facts.root / source, place)

    def copy_files(self, source: str, names: tuple[str, ...], folder: str) -> None:
        for name in names:
            self.copy(f"{source}/{name}", f"{folder}/{name}")

    def copy_library(self, folder: str) -> None:
        self.copy_files("lib", self.facts.sources + self.facts.headers, folder)

    def copy_flight(self, folder: str) -> None:
        self.copy_files("port/flight", self.facts.flight_sources + self.facts.flight_headers, folder)

    def copy_tree(self, source: str, folder: str) -> None:
        self.copy_files(source, self.facts.files(source), folder)

    def copy_page(self, host: str) -> None:
        """The host's README and the license. Links into the project's tree would be broken: only their text stays."""
        page = (self.facts.root / "port" / host / "README.md").read_text(encoding="utf-8")
        first, *sections = SECTION.split(page)
        kept = [f"## {section}" for section in sections if section.partition("\n")[0] not in OF_THE_TREE]

        def link(match: re.Match[str]) -> str:
            place, folder = (self.folder / match[2]).resolve(), self.folder.resolve()
            return match[0] if place.is_relative_to(folder) and place.exists() else match[1]

        page = LINK.sub(link, first + "".join(kept)).replace("<version>", self.facts.version)
        self.write("README.md", page)
        self.copy("LICENSE", "LICENSE")

"""The page: scripts, style and modules of port/wasm in one file, which fetches nothing."""

from __future__ import annotations

import base64
import hashlib
import re
from pathlib import Path

from jinja2 import Environment, FileSystemLoader, StrictUndefined

from ..places import ROOT
from .modules import Modules

PORT = ROOT / "port" / "wasm"
GOLDEN_HASH = ROOT / "tests" / "targets" / "golden_hash.txt"
FIRST_SCRIPT = PORT / "page" / "live.mjs"

IMPORT = re.compile(r'^import \{ ([\w, ]+) \} from "([\w./]+)";$', re.MULTILINE)
EXPORT = re.compile(r"^export (?=(?:async )?(?:function|const|class) (\w+))", re.MULTILINE)


def script_name(path: Path) -> str:
    return f"module_{path.stem}"


def joined(first: Path) -> str:
    """A module and all its imports as one script: each in its own function, which returns the exports.
    ValueError: a file has an import or export of another form than the supported one."""
    order: list[Path] = []
    texts: dict[Path, str] = {}

    def add(path: Path) -> None:
        if path in texts:
            return
        text = texts[path] = path.read_text(encoding="utf-8")
        for _, name in IMPORT.findall(text):
            add((path.parent / name).resolve())
        order.append(path)

    add(first.resolve())
    return "\n".join(wrapped(path, texts[path]) for path in order)


def wrapped(path: Path, text: str) -> str:
    exported = EXPORT.findall(text)

    def bound(match: re.Match[str]) -> str:
        return f"const {{ {match[1]} }} = {script_name((path.parent / match[2]).resolve())};"

    text = EXPORT.sub("", IMPORT.sub(bound, text))
    left = re.search(r"^(?:import|export)\b.*", text, re.MULTILINE)
    if left:
        raise ValueError(f"{path}: {left[0]}: only 'import {{ a, b }} from \"./c.mjs\";' and exported definitions")
    return f"const {script_name(path)} = (() => {{\n{text}\nreturn {{ {', '.join(exported)} }};\n}})();"


def golden_hash() -> str:
    """The hash of the output on every target."""
    return GOLDEN_HASH.read_text(encoding="utf-8").split()[0]


def page(modules: Modules) -> str:
    """The whole page. Its content security policy permits this one script and no request."""
    script = f"\n{joined(FIRST_SCRIPT)}\n"
    digest = base64.b64encode(hashlib.sha256(script.encode("utf-8")).digest()).decode("ascii")
    folder = PORT / "page"
    environment = Environment(loader=FileSystemLoader(folder), undefined=StrictUndefined, trim_blocks=True)
    return environment.get_template("page.html.j2").render(
        script=script,
        script_hash=f"sha256-{digest}",
        style=(folder / "page.css").read_text(encoding="utf-8"),
        golden_hash=golden_hash(),
        goe_module=base64.b64encode(modules.goe).decode("ascii"),
        flight_module=base64.b64encode(modules.flight).decode("ascii"),
        golden_module=base64.b64encode(modules.golden).decode("ascii"),
    )

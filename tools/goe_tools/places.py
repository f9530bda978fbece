"""Paths of the project around this package, and the library's interface."""

from __future__ import annotations

from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
# In lib/; goe.h includes the others.
PUBLIC_HEADERS = ("goe_limits.h", "goe_settings.h", "goe.h", "goe_class.h", "goe_hazard.h", "goe_diagnostics.h")


def interface(lib: Path = ROOT / "lib") -> str:
    """All public headers, one after the other."""
    return "\n".join((lib / name).read_text(encoding="utf-8") for name in PUBLIC_HEADERS if (lib / name).is_file())

"""What tools/goe_tools/peers.py takes from the cost ledger."""

from __future__ import annotations

from .cost.instructions import build_plugin
from .cost.running import ROOT, LedgerError, emulated, output_of

__all__ = ["ROOT", "LedgerError", "build_plugin", "emulated", "output_of"]

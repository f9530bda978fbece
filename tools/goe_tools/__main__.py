"""Command line: python -m goe_tools COMMAND ..."""

from __future__ import annotations

import os
import signal
import sys

if __name__ == "__main__" and signal.getsignal(signal.SIGINT) is signal.default_int_handler:
    signal.signal(signal.SIGINT, lambda *_: os._exit(130))  # Ctrl-C during the slow imports; cli.main() takes over

if __name__ == "__main__":
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # numpy: the matrices are small, threads hinder each other

from collections.abc import Sequence

from . import cli

COMMANDS = {  # name: module with add_arguments and run, and its description
    "bound": (".models.bound", "print the Cramer-Rao bound of a log with points and truth"),
    "scene": (".logs.scene_command", "write a synthetic observation log of a box or a cylinder"),
    "campaign": (".report.campaign_command", "fly goe_campaign in parts, over processes or a cluster"),
    "convert": (".exchange.convert", "make an observation log from an autopilot's log and a detector's table"),
    "jsbsim_flight": (".logs.jsbsim_flight", "fly a scenario with JSBSim and write it as an observation log"),
    "live": (".live.command", "write a page that runs the library, compiled to WebAssembly"),
    "mcap": (".exchange.mcap_command", "write a log and its estimates as MCAP, for Foxglove and PlotJuggler"),
    "montecarlo": (
        ".montecarlo.command",
        "fly a scenario many times in simulation: errors in sigmas, coverage, warnings",
    ),
    "noise": (".noise.command", "find the noise settings that fit logs"),
    "offline": (".models.offline", "fit all images of a log with points and truth at once"),
    "rare": (".report.rare_command", "fly the flight layer's orders many times and keep rare events"),
    "report": (".report.command", "write the campaign's report and print Table 3"),
    "view": (".view.command", "show a log: a page with a map and a slider over time, or a picture"),
    "table": (".logs.table", "print estimates as a table that a pilot can read"),
}


def main(argv: Sequence[str] | None = None) -> int:
    return cli.main("goe_tools", "Tools of the ground obstacle estimator.", COMMANDS, argv)


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, signal.default_int_handler)  # keeps results as Ctrl-C does
    sys.exit(main())

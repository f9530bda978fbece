"""The command ``goals``: every figure that the project promises, with its goal.

    python -m bench goals [--quick] [--only GROUP,...] [--json FILE] [--half HALF] [--jobs N | --scheduler ADDRESS]

A new group of goals is a module in this folder and a line in ``GROUPS``.
"""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from goe_tools import spread
from goe_tools.flights.logged import KITTI_FOLDER
from goe_tools.flights.recorded import RECORDED_FOLDER
from goe_tools.library import ready
from goe_tools.logs.whole_file import write_whole

from ...attack.rows import HALVES
from .attack import attack_group
from .boxes import boxes_group
from .early import early_group
from .field import field_group
from .float32 import float32_group
from .goal import Goal
from .hazard import hazard_group
from .kitti import kitti_group
from .output import as_json, print_group
from .pixel_noise import gauss_group
from .recorded import recorded_group
from .rivals import rivals_group
from .table3 import table3_group
from .thin import thin_group
from .work import FULL, QUICK, Amount

GROUPS: dict[str, Callable[[str, Amount], list[Goal]]] = {
    "gauss0.3": gauss_group,
    "gauss1": gauss_group,
    "rounding": gauss_group,
    "field": field_group,
    "float32": float32_group,
    "table3": table3_group,
    "early": early_group,
    "recorded": recorded_group,
    "kitti": kitti_group,
    "boxes": boxes_group,
    "thin": thin_group,
    "attack": attack_group,
    "hazard": hazard_group,
    "rivals": rivals_group,
}
ABSENT = {
    "float32": "the target goe_python_double is not built",
    "recorded": f"no flights in {RECORDED_FOLDER}",
    "kitti": f"no logs in {KITTI_FOLDER}",
    "thin": "no logs av2, oda in the folder of the boxes",
    "rivals": "the rivals are not installed",
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--quick", action="store_true", help="fewer flights: takes a minute, gives no verdict")
    parser.add_argument("--only", metavar="GROUPS", help=f"some of {','.join(GROUPS)}")
    parser.add_argument("--json", type=Path, metavar="FILE", help="also write the figures to this file")
    parser.add_argument("--worst", type=int, default=0, metavar="N", help="print the N worst flights, errors in sigmas")
    parser.add_argument(
        "--half",
        choices=HALVES,
        default="judge",
        help="tracks of the attacks; the other half is for tuning thresholds",
    )
    spread.add_arguments(parser)


def run(arguments: argparse.Namespace) -> int:
    chosen = arguments.only.split(",") if arguments.only else list(GROUPS)
    for name in chosen:
        if name not in GROUPS:
            raise ValueError(f"--only {name}: not one of {', '.join(GROUPS)}")
    ready()  # reports a missing library before the work starts
    options = {"workers": spread.workers_of(arguments), "worst": arguments.worst, "half": arguments.half}
    amount = Amount(**{**vars(QUICK if arguments.quick else FULL), **options})
    goals: list[Goal] = []
    for name in chosen:
        found = GROUPS[name](name, amount)
        if arguments.quick:
            found = [replace(goal, asked=()) for goal in found]  # too few flights for a verdict
        print_group(name, found, ABSENT.get(name, "no goals"))
        goals += found
    asked = [goal for goal in goals if goal.met is not None]
    print(
        "\nfew flights: no verdict"
        if arguments.quick
        else f"\n{sum(bool(g.met) for g in asked)} of {len(asked)} goals met"
    )
    if arguments.json:
        write_whole(arguments.json, json.dumps(as_json(goals, arguments.quick), indent=1) + "\n")
    return 0

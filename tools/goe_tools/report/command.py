"""The command ``report``."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..logs.whole_file import log_files, refuse_inputs
from .data import read_campaign
from .summary import summary
from .terminal import print_table3


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("campaign", type=Path, metavar="CAMPAIGN_DIR", help="folder that goe_campaign wrote")
    parser.add_argument("--goals", type=Path, metavar="FILE.json", help="what the goals command wrote with --json")
    parser.add_argument("--avoid", type=Path, metavar="FILE.csv", help="what goe_avoid wrote with --csv")
    parser.add_argument("--approach", type=Path, metavar="LOG", help="log folder whose flight the page begins with")
    parser.add_argument("--rare", type=Path, metavar="FILE.json", help="the record that the rare command wrote")
    parser.add_argument("--out", type=Path, metavar="FILE.html", help="page to write; figures go to FILE_figures/")
    parser.add_argument("--summary", action="store_true", help="print in a few lines what all of it shows")
    parser.add_argument("--table", action="store_true", help="print Table 3: the paper's numbers, window, filter")


def run(arguments: argparse.Namespace) -> int:
    if arguments.out is None and not arguments.table and not arguments.summary:
        raise ValueError("nothing to do: give --out FILE.html, --table or --summary")
    campaign = read_campaign(
        arguments.campaign,
        goals=arguments.goals,
        avoid=arguments.avoid,
        rare=arguments.rare,
        approach=arguments.approach,
    )
    if arguments.out is not None:
        read = [arguments.goals, arguments.avoid, arguments.rare, *log_files(arguments.approach or arguments.campaign)]
        refuse_inputs(arguments.out, [*read, arguments.campaign / "cases.csv", arguments.campaign / "campaign.json"])
    if arguments.table:
        print_table3(campaign)
    if arguments.out is not None:
        from .page import write_page  # here: what draws takes its time to start

        write_page(campaign, arguments.out)
    if arguments.summary:
        print("\n".join(summary(campaign)))
    return 0

"""The command ``report``."""

from __future__ import annotations

import argparse
from pathlib import Path

from ..logs.fields import LogError
from ..logs.whole_file import log_files, refuse_inputs
from .data import read_campaign
from .summary import print_summary
from .terminal import print_table3


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("campaign", type=Path, metavar="CAMPAIGN_DIR", help="folder written by goe_campaign")
    parser.add_argument("--goals", type=Path, metavar="FILE.json", help="file of python -m bench goals --json")
    parser.add_argument("--avoid", type=Path, metavar="FILE.csv", help="file of goe_avoid --csv")
    parser.add_argument(
        "--approach", type=Path, metavar="LOG", help="log folder of the flight that the page shows first"
    )
    parser.add_argument("--rare", type=Path, metavar="FILE.json", help="record written by the rare command")
    parser.add_argument("--live", type=Path, metavar="PAGE", help="page of the live command, for a link")
    parser.add_argument("--view", type=Path, metavar="PAGE", help="page of the view command, for a link")
    parser.add_argument(
        "--out", type=Path, metavar="FILE.html", help="page to write; others: FILE_paper.html, FILE_figures/"
    )
    parser.add_argument("--summary", action="store_true", help="print the results in a few sentences")
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
        from .page import Doors, page_files, write_page  # here, because the import is slow

        for page in (arguments.live, arguments.view):
            if page is not None and not page.is_file():
                raise LogError(page, 0, "", "no such file")
        read = [arguments.goals, arguments.avoid, arguments.rare, *log_files(arguments.approach or arguments.campaign)]
        read += [arguments.campaign / "cases.csv", arguments.campaign / "campaign.json", arguments.live, arguments.view]
        for file in page_files(campaign, arguments.out).values():
            refuse_inputs(file, read)
    if arguments.table:
        print_table3(campaign)
    if arguments.out is not None:
        write_page(campaign, arguments.out, Doors(arguments.live, arguments.view))
    if arguments.summary:
        print_summary(campaign)
    return 0

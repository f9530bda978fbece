"""The campaign's report: the paper's results and ours side by side, as one HTML page and as a table for the terminal.

data        what goe_campaign wrote
goals_file  what the goals command wrote
statistics  ranges, verdicts, comparisons of studies
refined     the same of the refined method
style       colours, sizes, names
prose       sentences that follow from the numbers
figures     the paper's figures 5 to 14 and our own
page        the HTML page and the files beside it
terminal    Table 3 as plain text
"""

from __future__ import annotations

import argparse
from pathlib import Path


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("campaign", type=Path, metavar="CAMPAIGN_DIR", help="folder that goe_campaign wrote")
    parser.add_argument("--goals", type=Path, metavar="FILE.json", help="what the goals command wrote with --json")
    parser.add_argument("--out", type=Path, metavar="FILE.html", help="page to write; figures go to FILE_figures/")
    parser.add_argument("--table", action="store_true", help="print Table 3: the paper's numbers, window, refined")


def run(arguments: argparse.Namespace) -> int:
    from .data import read_campaign

    if arguments.out is None and not arguments.table:
        raise ValueError("nothing to do: give --out FILE.html, --table or both")
    campaign = read_campaign(arguments.campaign, goals=arguments.goals)
    if arguments.table:
        from .terminal import print_table3

        print_table3(campaign)
    if arguments.out is not None:
        from .page import write_page

        write_page(campaign, arguments.out)
    return 0

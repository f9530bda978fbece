"""The command ``view``."""

from __future__ import annotations

import argparse
from pathlib import Path

from .. import renamed
from ..logs.numbers import between
from ..logs.obslog import LogError, ObservationLog, read_log, read_truth
from ..logs.whole_file import kept_as, log_files, write_whole
from .answers import SETTING_GROUPS, Options
from .story import MOST_ROWS, Story, story_of

DEFAULT_PAGE = Path("view.html")
EXIT_NO_ANSWER = 1


def _setting(text: str) -> tuple[str, float]:
    name, equals, value = text.partition("=")
    if name in renamed.names():
        raise argparse.ArgumentTypeError(f"unknown setting {name}: now {renamed.names()[name]}")
    if not equals or name.split(".")[0] not in SETTING_GROUPS:
        groups = ", ".join(f"{group}.…" for group in SETTING_GROUPS)
        raise argparse.ArgumentTypeError(f"'{text}' is not NAME=VALUE of a setting in {groups}")
    try:
        return name, float(value)
    except ValueError:
        raise argparse.ArgumentTypeError(f"{name}: '{value}' is not a number") from None


def _method(text: str) -> str:
    now = renamed.names().get(f"--method {text}")
    if now:
        raise argparse.ArgumentTypeError(f"unknown value {text}: now {now}")
    return text


def add_options(parser: argparse.ArgumentParser) -> None:
    """Options of replay and decision, which ``options_of`` reads."""
    add = parser.add_argument
    add(
        "--method",
        type=_method,
        choices=("filter", "window"),
        default="filter",
        help="as goe_replay's (default filter)",
    )
    add("--model", choices=("auto", "disc", "line"), default="auto", help="as goe_replay's (default auto)")
    add("--window", type=int, metavar="N", help="as goe_replay's: images in the window (default 8)")
    add(
        "--set",
        type=_setting,
        action="append",
        default=[],
        metavar="NAME=VALUE",
        help="as goe_replay's; may be repeated",
    )
    add("--margin", type=between(0.0, 1e4), default=15.0, metavar="M", help="too close: to the side (default 15 m)")
    add("--clearance", type=between(0.0, 1e4), default=10.0, metavar="M", help="... and above the top (default 10 m)")


def options_of(arguments: argparse.Namespace) -> Options:
    return Options(
        arguments.method, arguments.model, arguments.window, dict(arguments.set), arguments.margin, arguments.clearance
    )


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("log", type=Path, metavar="LOG", help="folder with camera.ini, frames.csv and, if known, truth.csv")
    add("--truth", type=Path, metavar="FILE", help="truth instead of LOG/truth.csv")
    add(
        "--out",
        type=Path,
        metavar="PAGE",
        help=f"page to write (default {DEFAULT_PAGE}, unless --png or --svg is given)",
    )
    add("--png", type=kept_as(".png"), metavar="FILE", help="picture of one moment: map, distance and size over time")
    add("--svg", type=kept_as(".svg"), metavar="FILE", help="the same; follows the reader's color scheme")
    add("--theme", choices=("light", "dark"), default="light", help="of the PNG (default light)")
    add("--at", type=between(-1e12, 1e12), metavar="S", help="time shown first, and in the picture (default: midway)")
    add(
        "--id",
        type=int,
        metavar="N",
        help="obstacle shown first, and in the picture (default: the one with most estimates)",
    )
    add_options(parser)
    add(
        "--rows", type=between(2, 1e5), default=MOST_ROWS, metavar="N",
        help=f"largest number of images on the page (default {MOST_ROWS}); of more, some are left out",
    )  # fmt: skip


def read(arguments: argparse.Namespace) -> ObservationLog:
    """The log, with the truth of --truth if given."""
    log = read_log(arguments.log)
    if not log.frames:
        raise LogError(arguments.log / "frames.csv", 0, "", "there are no rows")
    if arguments.truth is not None:
        log.truth = read_truth(arguments.truth)
        strange = sorted(log.truth.keys() - {frame.id for frame in log.frames})
        if len(strange) == len(log.truth):
            raise LogError(arguments.truth, 0, "id", "of no obstacle of the log")
    return log


def write(path: Path, content: bytes, arguments: argparse.Namespace) -> None:
    """Whole or not at all."""
    write_whole(path, content, [*log_files(arguments.log), arguments.truth])
    print(f"{path}: {len(content) / 1e3:,.0f} kB")


def moment_of(story: Story, time_s: float) -> int:
    """The last moment at or before a time within the log."""
    first_s, last_s = float(story.time_s[0]), float(story.time_s[-1])
    if not first_s <= time_s <= last_s:
        raise ValueError(f"--at: {time_s:g} s is not in the log, which goes from {first_s:g} to {last_s:g} s")
    return story.at(time_s)


def write_outputs(story: Story, arguments: argparse.Namespace) -> None:
    chosen = story.chosen(arguments.id)
    first = story.first_look(chosen) if arguments.at is None else moment_of(story, arguments.at)
    page = arguments.out if arguments.out or arguments.png or arguments.svg else DEFAULT_PAGE
    if page:
        from .page import render

        write(page, render(story, chosen, first).encode("utf-8"), arguments)
    if arguments.png or arguments.svg:
        from .picture import png, svg  # here, because the import is slow

        if arguments.png:
            write(arguments.png, png(story, chosen, first, arguments.theme), arguments)
        if arguments.svg:
            write(arguments.svg, svg(story, chosen, first), arguments)


def run(arguments: argparse.Namespace) -> int:
    log = read(arguments)
    name = arguments.log.resolve().name
    story = story_of(name, log, options_of(arguments), int(arguments.rows))
    write_outputs(story, arguments)
    answered = sum(int(track.answers.answered.sum()) for track in story.tracks)
    if not answered:
        print(f"{arguments.log}: no row gave an estimate")
        return EXIT_NO_ANSWER
    return 0

"""An entry of the table of attacks, and common goals."""

from __future__ import annotations

from dataclasses import dataclass, field

from goe_tools.report.attack_lines import ANY, COVER, SUSPECT, TRACKS, WRONG

from .scenario import Scenario

Range = tuple[float, float]
FEATURE_NAMES = {
    "corners": "", "outline": ", outline", "boxes": ", by boxes", "boxes with corners": ", by boxes with corners",
}  # fmt: skip


@dataclass(frozen=True)
class Ask:
    """A range for figures of a line; without names for all reported quantities, but at least the position.
    ``if_reported``: no goal if the library reports none of them."""

    line: str
    wanted: Range
    names: tuple[str, ...] = ()
    if_reported: bool = False


@dataclass(frozen=True)
class Row:
    """``settings``: the configuration beyond the camera. ``if_known``: further settings, left out with a message if the
    library does not have them. ``either``: percent of covered answers or of suspect tracks, one of which is
    enough."""

    section: str
    name: str
    scenario: Scenario
    settings: dict[str, float] = field(default_factory=dict)
    if_known: dict[str, float] = field(default_factory=dict)
    asked: tuple[Ask, ...] = ()
    tracks_share: float = 1.0  # of the usual number of tracks
    either: Range | None = None

    @property
    def title(self) -> str:
        return self.name + FEATURE_NAMES[self.scenario.features]


def cover(percent: float, *names: str) -> Ask:
    return Ask(COVER, (percent, 100.0), names)


def wrong(percent: float, name: str = ANY) -> Ask:
    return Ask(WRONG, (0.0, percent), (name,))


def suspect(percent: float) -> Ask:
    return Ask(SUSPECT, (0.0, percent), (TRACKS,))

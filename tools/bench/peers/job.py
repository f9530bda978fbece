"""A problem, its cases and its solvers."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

SLOTS = 64  # most cases of a group: PEER_SLOTS in tools/peers/frame/peer.h


@dataclass(frozen=True)
class Peer:
    """A solver: its source, needs for compiling and linking, and properties."""

    name: str
    source: Path
    against: str  # name of our solver of the same task, the reference of its ratios
    flags: tuple[str, ...] = ()
    defines: tuple[str, ...] = ()  # for its source alone
    more_sources: tuple[Path, ...] = ()
    libraries: tuple[str, ...] = ()
    on_target: bool = True

    @property
    def all_ours(self) -> bool:
        """Whether all its sources and headers are ours."""
        return not self.libraries and not any(flag.startswith("-isystem") for flag in self.flags)


@dataclass(frozen=True)
class Group:
    """Cases reported together. ``cases``: one a row, the floats of peer_case_t."""

    name: str
    cases: NDArray[np.float32]


@dataclass(frozen=True)
class Counted:
    """A solver's lower limit, in instructions."""

    name: str
    against: str
    set_name: str  # of compiler flags
    instructions: list[int]


class Job:
    """A problem. ``folder``: of its solvers' sources."""

    title: str
    folder: Path
    error_names: tuple[str, ...]

    def __init__(self, peers: list[Peer], groups: list[Group]) -> None:
        self.peers, self.groups = peers, groups

    def errors(self, peer: Peer, group: Group, answers: NDArray[np.float32]) -> tuple[float | None, ...]:
        """Errors of a solver's answers, one a row, for error_names; None: not reported by the solver."""
        raise NotImplementedError

    def bounds(self, group: Group) -> list[Counted]:
        return []

    def cases_in_c(self) -> str:
        """The source declared in tools/peers/frame/peer.h."""
        rows = [row for group in self.groups for row in group.cases]
        firsts = np.cumsum([0, *(len(group.cases) for group in self.groups)])
        lines = ['#include "peer.h"', "const peer_case_t peer_cases[] = {"]
        lines += ["    {" + ", ".join(f"{float(number).hex()}f" for number in row) + "}," for row in rows]
        lines += ["};", f"const int peer_first[] = {{{', '.join(map(str, firsts))}}};"]
        return "\n".join([*lines, f"const int peer_groups = {len(self.groups)};", ""])


def printed_cases(text: str) -> NDArray[np.float32]:
    """Output of one of our programs: one case a line, its numbers with nine digits, which identify a float exactly."""
    return np.array([[np.float32(word) for word in line.split()] for line in text.splitlines()], dtype=np.float32)

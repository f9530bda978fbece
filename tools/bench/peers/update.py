"""The filter's measurement update: ten states, up to nine rows, three nuisances common to the rows.

Filters differ in the form of their covariance. Each solver starts with the same prior in its form, rounded once, and is
measured until it has the posterior in the same form and the change of the state. The triangle of an information filter
contains no variances yet: for the comparison with solvers that keep a covariance, ours is also measured with the
inverse of the triangle.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .build import (
    FLAG_SETS,
    LIBRARY,
    PEERS,
    ROOT,
    Builder,
    LedgerError,
    library_includes,
    library_sources,
    output_of,
    own_program,
)
from .job import SLOTS, Counted, Group, Job, Peer, printed_cases
from .lower_bound import Operations, householder_update, triangle_inverse
from .others import Others

FOLDER = PEERS / "update"
REPLAY = ROOT / "tests" / "targets"
OURS = "goe, Householder"
OURS_INVERSE = "goe, Householder and inverse"
STATES, NUISANCES, ROWS = 10, 3, 9  # tools/peers/update/job.h
COLUMNS = NUISANCES + STATES + 1
TRIANGLE = STATES * (STATES + 1) // 2
UPPER = np.triu_indices(STATES)  # row by row
RECORDED = (TRIANGLE, 1, COLUMNS * ROWS)  # output of record.c
CASE = (TRIANGLE, TRIANGLE, STATES**2, 1, COLUMNS * ROWS)  # peer_case_t
ANSWER = (STATES, 1, STATES**2)  # peer_answer_t
QUICK_CASES = 4
TEN_STATES = "-DGOE_WITH_TARGET_MOTION=0"  # without augmented states, which no peer has
GROUPS = (9, 5, 3)  # by used rows: a box with all points visible, silhouettes, bounding boxes alone


@dataclass(frozen=True)
class Update:
    """One case in the library's form, in double precision."""

    root: NDArray[np.float64]
    nuisances_root: float
    rows: NDArray[np.float64]  # of nuisances, states, residual

    @staticmethod
    def of_case(case: NDArray[np.float32]) -> Update:
        root, _, _, nuisances, rows = np.split(case.astype(float), np.cumsum(CASE)[:-1])
        return Update(from_rows(root), float(nuisances[0]), rows.reshape(ROWS, COLUMNS))


@dataclass(frozen=True)
class Posterior:
    change: NDArray[np.float64]
    variance: NDArray[np.float64]
    nis: float


def from_rows(packed: NDArray[np.float64]) -> NDArray[np.float64]:
    """Upper triangular, from its elements row by row."""
    full = np.zeros((STATES, STATES))
    full[UPPER] = packed
    return full


def from_columns(packed: NDArray[np.float64]) -> NDArray[np.float64]:
    """Upper triangular, from its elements column by column."""
    full = np.zeros((STATES, STATES))
    full.T[np.tril_indices(STATES)] = packed
    return full


def to_columns(full: NDArray[np.float64]) -> NDArray[np.float64]:
    return full.T[np.tril_indices(STATES)]


# ------------------------------------------------------------------------------------------------------------- answers


def exact(update: Update) -> Posterior:
    """The triangle of all rows together, from numpy's QR."""
    prior = np.zeros((NUISANCES + STATES, COLUMNS))
    prior[:NUISANCES, :NUISANCES] = np.eye(NUISANCES) * update.nuisances_root
    prior[NUISANCES:, NUISANCES:-1] = update.root
    triangle = np.linalg.qr(np.vstack([prior, update.rows]), mode="r")
    root = triangle[NUISANCES:-1, NUISANCES:-1]
    change = np.linalg.solve(root, triangle[NUISANCES:-1, -1])
    return Posterior(change, np.sum(np.linalg.inv(root) ** 2, axis=1), triangle[-1, -1] ** 2)


def variance_of_root(kept: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.sum(np.linalg.inv(from_rows(kept[:TRIANGLE])) ** 2, axis=1)


def variance_of_inverse(kept: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.sum(from_columns(kept[:TRIANGLE]) ** 2, axis=1)


def variance_of_factors(kept: NDArray[np.float64]) -> NDArray[np.float64]:
    factors = from_columns(kept[:TRIANGLE])
    unit = np.triu(factors, 1) + np.eye(STATES)
    return unit**2 @ np.diag(factors)


def variance_of_covariance(kept: NDArray[np.float64]) -> NDArray[np.float64]:
    return np.diag(kept.reshape(STATES, STATES))


@dataclass(frozen=True)
class UpdatePeer(Peer):
    """form: form of the covariance that it keeps."""

    form: str = "root"
    reports_nis: bool = True


VARIANCE_OF = {
    "root": variance_of_root,
    "inverse": variance_of_inverse,
    "factors": variance_of_factors,
    "covariance": variance_of_covariance,
}


class UpdateJob(Job):
    title = "Measurement update of 10 states"
    folder = FOLDER
    error_names = (
        "error of the change, sigmas: worst",
        "of the variances, relative: worst",
        "of the NIS, relative: worst",
    )

    def __init__(self, peers: list[Peer], groups: list[Group]) -> None:
        super().__init__(peers, groups)
        self.updates = {group.name: [Update.of_case(case) for case in group.cases] for group in groups}
        self.exact = {name: [exact(update) for update in updates] for name, updates in self.updates.items()}

    def errors(self, peer: Peer, group: Group, answers: NDArray[np.float32]) -> tuple[float | None, ...]:
        assert isinstance(peer, UpdatePeer)
        worst = np.zeros(3)
        for update, truth, answer in zip(self.updates[group.name], self.exact[group.name], answers):
            change, nis, kept = np.split(answer.astype(float), np.cumsum(ANSWER)[:-1])
            rows = np.count_nonzero(update.rows.any(axis=1))  # the NIS' expectation
            here = [
                np.max(np.abs(change - truth.change) / np.sqrt(truth.variance)),
                np.max(np.abs(VARIANCE_OF[peer.form](kept) / truth.variance - 1.0)),
                abs(nis[0] - truth.nis) / max(truth.nis, rows),
            ]
            worst = np.maximum(worst, here)
        return float(worst[0]), float(worst[1]), float(worst[2]) if peer.reports_nis else None

    def bounds(self, group: Group) -> list[Counted]:
        """Minimum operations of a Householder update of these rows, and of its inverse."""
        counted = []
        for name, against in (("flop count", OURS), ("flop count, with inverse", OURS_INVERSE)):
            counts = []
            for update in self.updates[group.name]:
                operations = Operations()
                root = householder_update(update.root, update.nuisances_root, update.rows, operations).root
                if against == OURS_INVERSE:
                    triangle_inverse(root, operations)
                counts.append(operations)
            own, best = FLAG_SETS
            counted.append(Counted(name, against, own, [count.separate for count in counts]))
            counted.append(Counted(name, against, best, [count.fused for count in counts]))
        return counted


# --------------------------------------------------------------------------------------------------------------- cases


def recorded_updates(builder: Builder) -> NDArray[np.float32]:
    """Output of record.c, each update once: some tracks are flown twice, with other settings."""
    source = FOLDER / "record.c"
    names = sorted(set(re.findall(r"\b__wrap_(\w+)", source.read_text(encoding="utf-8"))))
    sources = [source, REPLAY / "replay.c", REPLAY / "embedded_logs.c", *library_sources()]
    includes = [f"-I{FOLDER}", f"-I{REPLAY}", *library_includes(), TEN_STATES]
    program = own_program(builder, "record", sources, includes, [f"-Wl,--wrap={name}" for name in names])
    builder.make()
    rows = printed_cases(output_of([program]))
    if not len(rows):
        raise LedgerError(f"{source}: the library called none of {', '.join(names)}")
    _, first = np.unique(rows, axis=0, return_index=True)
    return rows[np.sort(first)]


def case_of(recorded: NDArray[np.float32]) -> NDArray[np.float32]:
    """The prior in every form."""
    root, nuisances, rows = np.split(recorded, np.cumsum(RECORDED)[:-1])
    inverse = np.linalg.inv(from_rows(root.astype(float)))
    unit = inverse / np.diag(inverse)
    factors = np.triu(unit, 1) + np.diag(np.diag(inverse) ** 2)
    covariance = inverse @ inverse.T
    return np.concatenate([root, to_columns(factors), covariance.ravel(), nuisances, rows]).astype(np.float32)


def used_rows(recorded: NDArray[np.float32]) -> int:
    return int(np.count_nonzero(recorded[-COLUMNS * ROWS :].reshape(ROWS, COLUMNS).any(axis=1)))


def make_groups(recorded: NDArray[np.float32], most: int) -> list[Group]:
    """Evenly chosen among the updates with the same number of rows."""
    groups = []
    for rows in GROUPS:
        found = [update for update in recorded if used_rows(update) == rows]
        if not found:
            raise LedgerError(f"the embedded logs give no update with {rows} rows")
        chosen = np.unique(np.linspace(0, len(found) - 1, most).round().astype(int))
        groups.append(Group(f"{rows} of {ROWS} rows used", np.array([case_of(found[i]) for i in chosen])))
    return groups


def update_peers(others: Others) -> list[Peer]:
    """Ours are first."""
    library, include = (LIBRARY / "refined" / "goe_srif.c",), (*library_includes(), TEN_STATES)
    peers: list[Peer] = []
    kinds = ((OURS, "Eigen HouseholderQR", "root"), (OURS_INVERSE, "Eigen HouseholderQR and inverse", "inverse"))
    defines = [(f"-DWITH_INVERSE={number}",) for number in range(len(kinds))]
    for (ours, _, form), define in zip(kinds, defines):
        peers.append(UpdatePeer(ours, FOLDER / "peer_goe.c", ours, include, define, library, form=form))
    if others.eigen is not None:
        for (ours, name, form), define in zip(kinds, defines):
            peers.append(UpdatePeer(name, FOLDER / "peer_eigen.cpp", ours, others.eigen, define, form=form))
    peers.append(UpdatePeer("sequential UD", FOLDER / "peer_ud.c", OURS_INVERSE, form="factors"))
    if others.tinyekf is not None:
        source = FOLDER / "peer_tinyekf.c"
        peers.append(UpdatePeer("TinyEKF", source, OURS_INVERSE, others.tinyekf, form="covariance", reports_nis=False))
    return peers


def update_job(builder: Builder, others: Others, quick: bool) -> UpdateJob:
    return UpdateJob(update_peers(others), make_groups(recorded_updates(builder), QUICK_CASES if quick else SLOTS))

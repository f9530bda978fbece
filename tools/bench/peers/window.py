"""The window's fit: a 16 x 3 least squares problem.

Our solver also computes sigmas and rejects bad windows, and is measured with both; the others only solve.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .build import LIBRARY, PEERS, Builder, library_includes, output_of, own_program
from .job import SLOTS, Group, Job, Peer, printed_cases
from .others import Others

FOLDER = PEERS / "window"
OURS = "goe, closed form"
POINTS = 8  # PEER_POINTS in tools/peers/window/job.h
QUICK_CASES = 4
CMSIS_FUNCTIONS = (
    "mat_trans", "mat_mult", "mat_cholesky", "mat_solve_lower_triangular", "mat_solve_upper_triangular", "mat_qr",
    "householder",
)  # fmt: skip


class WindowJob(Job):
    """Answers are W, X0, Z0."""

    title = "Fit of a window of 8 images"
    folder = FOLDER
    error_names = ("error of W, relative: worst", "root mean square")

    def errors(self, peer: Peer, group: Group, answers: NDArray[np.float32]) -> tuple[float | None, ...]:
        if peer.name.startswith("TinyEKF"):  # one step of a filter is a different problem
            return (None, None)
        error = answers[:, 0].astype(float) / np.array([exact_width(case) for case in group.cases]) - 1.0
        return float(np.max(np.abs(error))), float(np.sqrt(np.mean(error**2)))


def exact_width(case: NDArray[np.float32]) -> float:
    """In double precision."""
    dx, dz, xi, zeta = case.astype(float).reshape(4, POINTS)
    one, none = np.ones(POINTS), np.zeros(POINTS)
    rows = np.vstack([np.column_stack([one, none, -dx]), np.column_stack([none, one, -dz])])
    return float(1.0 / np.linalg.lstsq(rows, np.concatenate([xi, zeta]), rcond=None)[0][2])


def make_cases(builder: Builder, count: int) -> NDArray[np.float32]:
    program = own_program(builder, "make_windows", [FOLDER / "make_cases.c"], [f"-I{FOLDER}"])
    builder.make()
    return printed_cases(output_of([program, str(count)]))


def window_peers(others: Others) -> list[Peer]:
    """Ours is first."""
    peers = [
        Peer(OURS, FOLDER / "peer_goe.c", OURS, library_includes(), more_sources=(LIBRARY / "window" / "goe_fit.c",))
    ]
    if others.eigen is not None:
        for number, method in enumerate(("LLT", "LDLT", "ColPivHouseholderQR"), start=1):
            source, defines = FOLDER / "peer_eigen.cpp", (f"-DMETHOD={number}",)
            peers.append(Peer(f"Eigen {method}", source, OURS, others.eigen, defines))
    if others.lapack:
        peers.append(Peer("LAPACK sgels", FOLDER / "peer_lapack.c", OURS, libraries=("-llapacke",), on_target=False))
    if others.cmsis_dsp is not None:
        folder = others.cmsis_dsp
        sources = [folder / "Source" / "MatrixFunctions" / f"arm_{name}_f32.c" for name in CMSIS_FUNCTIONS]
        sources += [folder / "Source" / "BasicMathFunctions" / f"arm_{name}_f32.c" for name in ("dot_prod", "scale")]
        include = (f"-isystem{folder / 'Include'}", f"-isystem{folder / 'PrivateInclude'}", "-D__GNUC_PYTHON__", "-w")
        for number, method in enumerate(("Cholesky", "QR"), start=1):
            source, defines = FOLDER / "peer_cmsis.c", (f"-DMETHOD={number}",)
            peers.append(Peer(f"CMSIS-DSP {method}", source, OURS, include, defines, tuple(sources)))
    if others.tinyekf is not None:
        peers.append(Peer("TinyEKF, one step", FOLDER / "peer_tinyekf.c", OURS, others.tinyekf))
    return peers


def window_job(builder: Builder, others: Others, quick: bool) -> WindowJob:
    cases = make_cases(builder, QUICK_CASES if quick else SLOTS)
    return WindowJob(window_peers(others), [Group(f"{len(cases)} windows", cases)])

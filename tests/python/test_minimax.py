"""The constants of lib/maths are those of the minimax polynomials, and do not exceed their stated error bounds."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from bench.reference.minimax import PROBLEMS, remez

LIBRARY = Path(__file__).resolve().parents[2] / "lib" / "maths"
BOUND = {"ATAN": 5e-9, "SIN": 2e-9, "COS": 1e-10, "NORMAL": 2e-7}


def constants(source: str, name: str) -> np.ndarray:
    """The coefficients, copied from the source."""
    found = re.findall(rf"#define {name}_\d (\S+?)f\b", (LIBRARY / source).read_text())
    return np.array([float(text) for text in found])


@pytest.mark.parametrize("problem", PROBLEMS, ids=lambda problem: problem.name)
def test_source_contains_the_polynomial(problem) -> None:
    polynomial = remez(problem)
    signs = (-1.0) ** np.arange(problem.terms) if problem.alternating else np.sign(polynomial.coefficients)
    np.testing.assert_allclose(constants(problem.source, problem.name), signs * polynomial.coefficients, rtol=2e-8)
    assert polynomial.bound <= BOUND[problem.name]

"""The maximum of a linear program, with a proof in exact numbers.

The solver uses floating point, so its result is not trusted: its multipliers give a bound, which is checked in
fractions. A weak bound would be noticed; a wrong one cannot pass.

    most c x  with  equal x = 0, at_most x <= 0, x >= 0, and x[0] = 1

For any multipliers u, v >= 0 with  c <= u equal + v at_most + w e0  the maximum is at most w.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction

import numpy as np
from bench.running import LedgerError
from scipy.optimize import linprog
from scipy.sparse import csr_matrix

Row = dict[int, int]  # coefficients by variable
DENOMINATOR_MAX = 5040  # of a multiplier: those of flows are integers or simple fractions


@dataclass
class Program:
    cost: list[int] = field(default_factory=list)  # by variable; variable 0 is 1
    equal: list[Row] = field(default_factory=list)
    at_most: list[Row] = field(default_factory=list)

    def variable(self, cost: int = 0) -> int:
        self.cost.append(cost)
        return len(self.cost) - 1


@dataclass(frozen=True)
class Solution:
    most: int
    values: list[float]


def matrix_of(rows: list[Row], columns: int) -> csr_matrix:
    at = [(i, j, value) for i, row in enumerate(rows) for j, value in row.items()]
    where, to, values = zip(*at) if at else ((), (), ())
    return csr_matrix((values, (where, to)), shape=(len(rows), columns), dtype=float)


def fraction_of(number: float) -> Fraction:
    return Fraction(float(number)).limit_denominator(DENOMINATOR_MAX)


def proved(program: Program, equal: list[Fraction], at_most: list[Fraction]) -> Fraction:
    """The bound proved by the multipliers; raises if they prove none."""
    rest = [Fraction(cost) for cost in program.cost]
    for rows, factors in ((program.equal, equal), (program.at_most, at_most)):
        for row, factor in zip(rows, factors):
            if factor:
                for variable, value in row.items():
                    rest[variable] -= factor * value
    if any(factor < 0 for factor in at_most) or any(value > 0 for value in rest[1:]):
        raise LedgerError("the multipliers prove no bound")
    return rest[0]


INFEASIBLE = 2  # scipy's status


def solve(program: Program) -> Solution | None:
    """None if the constraints are infeasible."""
    count = len(program.cost)
    equal = [{0: 1}, *program.equal]
    given = np.zeros(len(equal))
    given[0] = 1.0
    answer = linprog(
        [-cost for cost in program.cost],
        A_ub=matrix_of(program.at_most, count) if program.at_most else None,
        b_ub=np.zeros(len(program.at_most)) if program.at_most else None,
        A_eq=matrix_of(equal, count),
        b_eq=given,
        bounds=(0, None),
        method="highs-ds",
    )
    if answer.status == INFEASIBLE:
        return None
    if answer.status != 0:
        raise LedgerError(f"the longest path is unbounded: {answer.message}")
    by_equal = [fraction_of(-value) for value in answer.eqlin.marginals[1:]]
    by_most = [max(fraction_of(-value), Fraction(0)) for value in answer.ineqlin.marginals]
    bound = proved(program, by_equal, by_most)
    return Solution(bound.numerator // bound.denominator, list(answer.x))

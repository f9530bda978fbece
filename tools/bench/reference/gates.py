"""Named threshold decisions, which allow a comparison of two precisions decision by decision.

A chain in float32 and one in float64 cannot agree at every threshold: if a value is within rounding of it, either
answer is right. A reference that continued with its answer would then be compared with a different computation.
So the float64 method may get the decisions of the float32 one (``guide``). If they differ and the value is
within rounding of the threshold, it follows the guide and counts a *followed* decision; if they differ and the value is
not, it keeps its decision and counts a *disputed* one. Both are reported: the comparison limits the first and allows
none of the second.
"""

from __future__ import annotations

from dataclasses import dataclass, field

UNIT_ROUNDOFF = 2.0**-24  # of float32
ROUNDINGS = 64.0  # accumulated rounding error of the chain, in roundings of the operands' size


@dataclass
class Gates:
    """Decisions taken for one image, by name."""

    guide: dict[str, bool] | None = None
    taken: dict[str, bool] = field(default_factory=dict)
    followed: list[str] = field(default_factory=list)
    disputed: list[str] = field(default_factory=list)

    def decide(self, name: str, answer: bool, distance: float, size: float) -> bool:
        """Takes a decision.

        distance: of the value from the threshold; size: of the value's operands, in the same unit.
        """
        answer = bool(answer)
        if self.guide is not None and name in self.guide and self.guide[name] != answer:
            if abs(distance) <= ROUNDINGS * UNIT_ROUNDOFF * abs(size):
                self.followed.append(name)
                answer = self.guide[name]
            else:
                self.disputed.append(name)
        self.taken[name] = answer
        return answer

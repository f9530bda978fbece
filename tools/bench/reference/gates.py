"""Threshold decisions, named, so that two precisions can be compared decision by decision.

A chain in float32 and one in float64 cannot agree on every threshold: where a value lies within rounding of it, either
answer is right. A reference that carries on with its own answer would then be compared with a different computation.
So the float64 method may be given the decisions of the float32 one (``guide``). Where they differ and the value lies
within rounding of the threshold it follows the guide and counts a *followed* decision; where they differ and the value
does not, it keeps its own and counts a *disputed* one. Neither is hidden: the comparison bounds the first and allows
none of the second.
"""

from __future__ import annotations

from dataclasses import dataclass, field

UNIT_ROUNDOFF = 2.0**-24  # of float32
ROUNDINGS = 64.0  # how many roundings of its operands' size a value may be off by the accumulated rounding of the chain


@dataclass
class Gates:
    """Decisions taken for one image, by name."""

    guide: dict[str, bool] | None = None
    taken: dict[str, bool] = field(default_factory=dict)
    followed: list[str] = field(default_factory=list)
    disputed: list[str] = field(default_factory=list)

    def decide(self, name: str, answer: bool, distance: float, size: float) -> bool:
        """Takes a decision.

        distance: of the value from the threshold; size: of the operands behind the value, in the same unit.
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

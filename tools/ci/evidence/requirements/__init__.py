"""Requirements: what the library promises, and the tests that would fail without it.

marks.py   promises and tests, joined by marks and names; what has no other side
breaks.py  the code broken by hand, and whether the test with the mark fails
part.py    the part of the evidence
"""

from .part import run

__all__ = ["run"]

"""Requirements: the library's promises, and the tests that would fail without them.

marks.py   joins promises and tests by marks and names; finds orphans
breaks.py  breaks the code line by line, and checks that the marked test fails
part.py    the part of the evidence
"""

from .part import run

__all__ = ["run"]

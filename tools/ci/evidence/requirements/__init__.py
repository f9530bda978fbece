"""Requirements: what the library promises, the code that does it, the tests that would fail without it.

rows.py       the tables, tests/requirements/*.csv
sentences.py  the sentences of a source, in which the anchors lie
names.py      what the sources define
check.py      both directions
breaks.py     the code broken by hand, and whether the named test fails
part.py       the part of the evidence
"""

from .part import run

__all__ = ["run"]

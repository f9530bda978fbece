"""Many simulated flights of one scenario: errors in sigmas, coverage, and the quality of the warnings.

``flown.py`` flies one seed and compares the answers with the truth; ``course.py`` checks whether the flown path
violates the margin; ``summary.py`` computes the statistics; ``files.py``, ``figure.py`` and ``page.py`` write the
output; ``command.py`` is the command.
"""

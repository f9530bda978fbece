"""Many simulated flights of one scenario: how large the errors are in sigmas, and what the warnings are worth.

``flown.py`` flies one seed and compares the answers with the truth; ``course.py`` finds out whether the flown path
violates the margin; ``summary.py`` counts; ``files.py``, ``figure.py`` and ``page.py`` write; ``command.py`` is the
command.
"""

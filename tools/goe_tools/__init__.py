"""Logs, numerical references and comparisons for goe, the ground obstacle estimator.

README.md, beside this file, tells what is in which folder.
"""

__version__ = "0.3.0"

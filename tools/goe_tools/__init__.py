"""Logs, numerical references and comparisons for goe, the ground obstacle estimator.

README.md in this folder describes the source layout.
"""

__version__ = "0.4.0"

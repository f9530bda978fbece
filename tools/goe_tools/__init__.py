"""Logs, numerical references and comparisons for goe, the ground obstacle estimator.

obslog       observation logs: camera.ini, frames.csv, truth.csv
scene        synthetic logs of boxes and cylinders
reference64  the paper's chain in float64, solved as the 2N x 3 system of equation (5)
mirror32     the C library's arithmetic in float32, operation by operation
compare      the built goe_replay against both references
golden       the C headers with the unit tests' reference data
table        estimates as a table that a pilot can read
minimax      the library's polynomials
"""

__version__ = "0.1.0"

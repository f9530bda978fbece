"""What the library's window method is held against: two references that share nothing with it but the paper.

settings     the settings of the window method
gates        decisions at thresholds, so that two precisions can be compared one by one
reference64  the paper's chain in float64, solved as the 2N x 3 system of equation (5)
mirror32     the C library's arithmetic in float32, operation by operation
compare      the built goe_replay against both
golden       the C headers with the unit tests' reference data
minimax      the library's polynomials
"""

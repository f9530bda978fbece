"""References for the library's window method.

settings     the settings of the window method
gates        threshold decisions, which allow a comparison of two precisions one by one
window       the paper's chain, in the library's float32 bit by bit or in float64
dense        (5) as the paper writes it, solved as a 2N x 3 system
compare      the built goe_replay against the method in both precisions
golden       the C headers with the unit tests' reference data
minimax      the library's polynomials
"""

"""The library's arithmetic in float32, operation by operation, in the order of the C sources.

Every number is a numpy.float32 and every operation rounds to float32, so that the results carry the same bits as the
C library's, built with its own flags. The names are the C names without their prefix. Decisions at thresholds are noted
by name (Gates), so that the float64 reference can be compared decision by decision.

single      the numbers
angle       arctangent, sine, cosine
rotation    rotation matrices
camera      from a pixel to an aligned point
projection  what is made of aligned points
window      (5) over a window of images, sliding means
intake      what an image must be to be taken at all
estimator   the chain from an image to an estimate
"""

from .estimator import Mirror32

__all__ = ["Mirror32"]

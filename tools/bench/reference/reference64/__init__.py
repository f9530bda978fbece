"""The paper's chain in float64: the independent reference of the library.

Deliberately unlike the library wherever the mathematics allows: rotations are composed from elementary ones, angles
come from numpy's trigonometric functions, (1) is evaluated as printed (its fraction the right way up), the rows of (5)
are kept as the paper writes them, unrotated, the 2N x 3 system in X0/W, Z0/W, 1/W goes to numpy.linalg.lstsq, and the
sigmas come from inv(A^T A) by error propagation.

Frames as in goe.h: NED earth, FRD body, camera x right, y down, z forward; T with X right, Y down, Z along the flight
direction, level. Units: m, rad inside, degrees outside. Aligned points (x, y) are in units of the focal length.

geometry   attitude, lens, the angles of undirected lines
window     (5) over a window of images
track      what one image shows, what a track has collected, what is told of it
estimator  the chain from an image to an estimate
"""

from .estimator import Reference64
from .track import Report

__all__ = ["Reference64", "Report"]

"""The window method in float32 or float64: the paper's chain (lib/window/README.md), written once.

WindowMethod(camera, settings, np.float32) has the library's bits: every number and every operation is a float32, in the
order of the C sources, with the library's polynomials for angles.

WindowMethod(camera, settings, np.float64) follows the equations: the same chain without float32's rounding, angles
from numpy, the lens inverted to the last digits. It also propagates the effect of float32 rounding to each quantity
and may be guided at thresholds (../gates.py), which allows a comparison of both decision by decision.

Both share the formulas of each step, the closed form of (5), the sigmas and the branches of the chain, and the order of
operations with the library. Neither comparison would detect an error there. Independent checks do:

  * ../dense.py keeps the rows as the paper writes them, unrotated, solves the 2N x 3 system with numpy.linalg.lstsq and
    propagates sigmas through inv(A^T A). The golden data of the C fit come from it, and so do the reference solutions
    for the fits of random rows and of every window of a flight;
  * tests/python/test_window_steps.py: rotations against elementary ones and Rodrigues' formula, the lens against the
    distortion, (1) as printed, (2) and (4) by trigonometry, sliding mean and low-pass against numpy's means
    and weights, the sigmas of length, height and center by complex steps;
  * tests/python/test_window_float64.py: exact boxes are correct to 1e-9 on any path, and (2) and (8) have the
    errors that the analysis predicts.

precision    constants and angles of a precision
polynomials  the library's angles in float32
geometry     from a pixel to an aligned point, and functions of aligned points
orientation  the edges of the base, choice of the side edge, the low-pass
fit          (5) over a window of images, sliding means
view         content of one image, and its report
estimator    the chain from an image to an estimate
"""

from .estimator import WindowMethod
from .view import Report

__all__ = ["Report", "WindowMethod"]

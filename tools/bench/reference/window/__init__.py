"""The window method in one precision or the other: the paper's chain (lib/window/README.md), written once.

WindowMethod(camera, settings, np.float32) has the library's bits: every number and every operation is a float32, in the
order of the C sources, with the library's polynomials for angles.

WindowMethod(camera, settings, np.float64) has what the equations say: the same chain without float32's rounding, angles
by numpy, the lens inverted to the last digits. It also propagates what float32's rounding would do to each quantity
and may be guided at thresholds (../gates.py), so that both can be compared decision by decision.

What both share with each other, and in the order of operations with the library: the formulas of each step, the closed
form of (5), the sigmas, the branches of the chain. An error there would show in neither comparison. It shows against
what shares none of it:

  * ../dense.py keeps the rows as the paper writes them, unrotated, solves the 2N x 3 system by numpy.linalg.lstsq and
    propagates sigmas through inv(A^T A): the golden data of the C fit are its, and so are the solutions that the fits
    of random rows and of every window of a flight are compared with;
  * tests/python/test_window_steps.py: rotations against elementary ones and Rodrigues' formula, the lens against the
    distortion, (1) as printed, (2) and (4) by trigonometry, sliding mean and low-pass by numpy's means
    and by weights, the sigmas of length, height and centre by complex steps;
  * tests/python/test_window_float64.py: exact boxes come out to 1e-9 whatever the path, and (2) and (8) are off by what
    the analysis says.

precision    constants and angles of a precision
polynomials  the library's angles in float32
geometry     from a pixel to an aligned point, and what is made of those
orientation  the edges of the base, which is the side edge, the low-pass
fit          (5) over a window of images, sliding means
view         what one image shows and adds, and the report of it
estimator    the chain from an image to an estimate
"""

from .estimator import WindowMethod
from .view import Report

__all__ = ["Report", "WindowMethod"]

"""Distance of the estimator from the best possible accuracy (``goe_tools.models``).

precision  the library in float32 against itself in float64
rounding   the same, image by image
extremes   flights at the limits of the library's inputs
rivals     other published methods
goals      every figure that the project promises, with its goal
"""

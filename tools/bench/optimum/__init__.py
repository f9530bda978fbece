"""How near an estimator comes to what the data allow (``goe_tools.models``).

precision  the library in float32 against itself in float64
rounding   the same, image by image
extremes   flights at the ends of what the library takes
rivals     other people's methods
goals      every figure that the project promises, beside the figure that is reached
"""

"""Sizes of usual classes, from the companion's obstacle_class.c, which names their origin.

Made by `python -m ci packages --write`; do not edit.
"""

SIGMA_OF_SPAN = 0.288675
CLASSES = {  # name: (least, greatest width), (least, greatest height), shape; m; 0: unknown
    "car": ((1.8, 4.8), (1.35, 1.85), "OTHER"),
    "van": ((1.9, 7.7), (1.9, 2.9), "OTHER"),
    "truck": ((1.9, 18.9), (1.8, 4.0), "OTHER"),
    "bus": ((2.1, 18.9), (2.6, 4.0), "OTHER"),
    "motorcycle": ((0.8, 2.4), (1.1, 1.8), "OTHER"),
    "motor": ((0.8, 2.4), (1.1, 1.8), "OTHER"),
    "bicycle": ((0.5, 1.9), (1.0, 1.9), "OTHER"),
    "person": ((0.25, 0.95), (1.3, 1.9), "UNKNOWN"),
    "pedestrian": ((0.25, 0.95), (1.4, 1.9), "UNKNOWN"),
    "people": ((0.25, 0.95), (0.8, 1.9), "UNKNOWN"),
    "pole": ((0.0, 0.0), (6.0, 12.0), "ROUND"),
    "chimney": ((0.0, 0.0), (0.0, 0.0), "ROUND"),
    "house": ((6.0, 20.0), (4.0, 12.0), "OTHER"),
}

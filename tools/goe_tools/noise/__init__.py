"""Noise settings from logs.

rows        one track, linearized: measurements, unknowns, and the effect of each setting's errors
boxes       the rows of upright bounding boxes
points      the rows of silhouette points and base corners
likelihood  the most likely settings for the rows, and their uncertainty
tracks      the tracks of logs
judged      share of the library's answers that are within two sigmas of the truth
command     the command that fits logs and prints the settings
"""

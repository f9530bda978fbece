"""The noise settings that logs ask for.

rows        one track, linearised: what is measured, what is unknown, and how each setting's errors enter
boxes       the rows of upright bounding boxes
points      the rows of silhouette points and base corners
likelihood  the settings that make the rows most likely, and how well they are known
tracks      the tracks of logs
judged      how often the truth lies within what the library then answers
command     the command that fits logs and prints the settings
"""

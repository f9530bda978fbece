"""Hostile flights: the world differs from what the estimator was told, or the told errors are large. Where do the
sigmas hold, and where not?

A generator of its own: it shares no code with goe_sim, with the simulator in optimum/flights or with the library, so
that an error in one shows. float64; an image is a row of an array. Nothing here knows the library: the goals run it.

Axes: NED earth, FRD body, camera (right, down, ahead), T (X right, Y down, Z forward, level) with its origin at the
camera of the first image that shows the obstacle. Flights are drawn in "course" axes (forward, right, down), level,
turned against north by a random heading.

turns      rotation matrices and quaternions
motion     where the aircraft is
solids     what stands or moves there
view       what the camera sees of it
errors     what of all that is told, and how wrong
scenario   the four together: one track
rows       the table: one entry for each attack, and what is asked of it
judging    answers against the truth: confident errors, flags
approach   the same for warnings: closest approach, violations, who was warned
command    the command attack_tables: a file of goals as the tables of README.md
"""

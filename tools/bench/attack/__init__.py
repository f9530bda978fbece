"""Hostile flights: the world differs from the configuration, or the configured errors are large. They show where the
sigmas are correct.

An independent generator: it shares no code with goe_sim, with the simulator in optimum/flights or with the library, so
an error in one of them is detected. float64; an image is a row of an array. Only the goals run the library on these
flights.

Axes: NED earth, FRD body, camera (right, down, ahead), T (X right, Y down, Z forward, level) with its origin at the
camera of the first image that shows the obstacle. Flights are generated in level "course" axes (forward, right, down),
turned from north by a random heading.

turns         rotation matrices and quaternions
motion        motion of the aircraft
solids        obstacles
view          the obstacle in the camera's image
surroundings  what a flat world without neighbors lacks
errors        errors of the reported quantities
scenario      the four together: one track
row           an entry of the table, with its goals
harder        entries of a world harder than the real one
rows          the table: one entry for each attack
judging       answers against the truth: confident errors, flags
approach      the same for warnings: closest approach, violations, warned runs
command       the command attack_tables: a file of goals as the tables of README.md
"""

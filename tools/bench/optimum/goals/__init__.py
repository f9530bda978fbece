"""Every figure that the project promises, beside the figure that is reached.

Flights are simulated here (``flights``), not by goe_sim, so that thousands take seconds; the recorded flights and
KITTI's logs are used where they lie beside the project. The estimator is the C library as firmware would run it.

goal         a line of the table
outcome      a flight to be judged, and what the methods make of it
measures     goals that several groups make of their outcomes
output       the table, and the file for the report
work         how many flights, in how many processes
command      runs the groups: pixel_noise, field, recorded, table3, early, kitti, boxes, attack, hazard, float32,
             rivals
"""

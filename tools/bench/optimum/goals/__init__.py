"""Every figure that the project promises, with its goal.

Flights are simulated here (``flights``), not by goe_sim, so thousands take seconds; recorded flights and
KITTI's logs are used if they are next to the project. The estimator is the C library as in firmware.

goal         a line of the table
outcome      a flight and the results of the methods
measures     goals shared by several groups
output       the table, and the file for the report
work         number of flights and processes
command      runs the groups: pixel_noise, field, recorded, table3, early, kitti, boxes, attack, hazard, float32,
             rivals
"""

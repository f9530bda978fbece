"""Flights past obstacles as arrays over the images of one track.

Frames: NED earth (north, east, down), FRD body, camera (right, down, ahead), T = (right, down, forward) level, with its
origin at the camera of the first image, which shows a feature: with that a track begins. Metres, seconds, radians,
pixels; attitudes are Hamilton quaternions (w, x, y, z) body -> NED. Features in the order of ``FEATURES``.

A ``Scene`` is what is true, a ``Flight`` what an estimator is told, and the truth of the obstacle. ``measure`` makes a
flight of a scene and of a noise; the same seed gives the same flight.

rotations  attitudes as arrays
noise      the errors of a flight's measurements
flight     Flight, Obstacle, the order of features and quantities
scene      Scene, and what a camera sees of it
measured   from a scene to a flight
simulated  scenes of the paper's Table 2, and random ones
recorded   scenes of recorded flights of autopilots
logged     flights of logs with truth
boxes      simulated flights whose features are upright bounding boxes
box_logs   recorded boxes with truth: KITTI's cars, ODMD
"""

"""Flights past obstacles as arrays over the images of one track.

Frames: NED earth (north, east, down), FRD body, camera (right, down, ahead), T = (right, down, forward) level, with its
origin at the camera of the first image with a feature, where a track starts. Meters, seconds, radians, pixels;
attitudes are Hamilton quaternions (w, x, y, z) body -> NED. Features in the order of ``FEATURES``.

A ``Scene`` is the truth; a ``Flight`` contains the input of an estimator and the truth of the obstacle. ``measure``
makes a flight from a scene and a noise; the same seed gives the same flight.

rotations  attitudes as arrays
noise      the errors of a flight's measurements
flight     Flight, Obstacle, the order of features and quantities
scene      Scene, and its image in a camera
measured   makes a flight from a scene
simulated  scenes of the paper's Table 2, and random ones
recorded   scenes of recorded flights of autopilots
logged     flights of logs with truth
boxes      simulated flights with upright bounding boxes as features
box_logs   recorded boxes with truth: KITTI's cars, ODMD
"""

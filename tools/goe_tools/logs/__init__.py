"""Logs as files: the input of a flight, and the answers of an estimator.

obslog         observation logs: camera.ini, frames.csv, truth.csv
camera_file    camera.ini
hints          hints at probable mistakes in a readable log
progress       progress of a long task
estimates      goe_replay's output for a log
table          estimates as a table that a pilot can read
projection     projects a point into the image of a flying camera
scene          synthetic logs of boxes and cylinders
scene_command  the command that writes one
jsbsim_flight  a log of a flight by JSBSim
whole_file     writes files completely or not at all
marked_block   the block of a page that a command writes
"""

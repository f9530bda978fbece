"""Logs: what a flight is told by, and what an estimator answered, as files.

obslog         observation logs: camera.ini, frames.csv, truth.csv
camera_file    camera.ini
hints          what looks wrong in a log although it can be read
progress       how far a long piece of work is
estimates      what goe_replay writes of a log
table          estimates as a table that a pilot can read
projection     where a point lies in the image of a flying camera
scene          synthetic logs of boxes and cylinders
scene_command  the command that writes one
jsbsim_flight  a log of a flight by JSBSim
whole_file     files that appear whole or not at all
marked_block   the block of a page that a command writes
"""

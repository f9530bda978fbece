"""A search for lies: confident errors, false safety and warnings that vanish, in random legal flights.

Simulator and judge are written from goe.h alone: they share neither code nor ideas with the library, the other
simulators or the other judges, which exposes their common errors. float64, arrays over all images of many
flights.

genes      unit numbers of a flight, and its seed
decode     parameters of flights from unit numbers
motion     true position and attitude of the aircraft
shapes     cuboids and cylinders
optics     directions to raw pixels
seen       the output of an ideal detector
errors     random numbers, and the errors of poses
mishaps    missed detections, resets, refused images
features   the detector's reported features
world      all of these together: the library's input, and the truth
answers    runs the library
approach   exact closest approach
judge      errors over sigmas
finds      classifies answers as lies
tally      counts over many flights
search     flights in batches, over processes
evolve     evolves the worst flights
shrink     reduces a find
record     writes a find as a log
show       the table and its goals
command    the command
"""

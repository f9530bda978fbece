"""A search for lies: confident errors, false safety and warnings that vanish, in random legal flights.

Simulator and judge are written from goe.h alone: no code and no idea is that of the library, of the other simulators or
of the other judges, so that an error that they share shows. float64, arrays over all images of many flights.

genes      unit numbers that a flight is made of, and its seed
decode     parameters of flights from unit numbers
motion     where the aircraft truly is
shapes     cuboids and cylinders
optics     directions to raw pixels
seen       what an ideal detector sees
errors     random numbers, and what they do to poses
mishaps    missed detections, resets, refused images
features   what the detector reports
world      all of these together: what the library is given, and what is true
answers    the library, flown
approach   exact closest approach
judge      errors over sigmas
finds      which answers are lies
tally      counts of many flights
search     flights in batches, over processes
evolve     the worst flights bred
shrink     a find made small
record     a find as a log
show       the table and its goals
command    the command
"""

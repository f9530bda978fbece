"""Logs of others: an autopilot's log and a detector's boxes in, MCAP for other people's viewers out.

recording     what an autopilot's log tells of the flight, and its pose at any time
resets        jumps of the autopilot's filter, as the log tells them or as motion gives them away
ulog          PX4's log
dataflash     ArduPilot's log
tlog          a ground station's log of MAVLink messages
detections    the detector's table
clock         how far the camera's clock is off the autopilot's
convert       the command that makes an observation log of both
messages      an observation log and its estimates as messages of Foxglove's schemas
mcap_command  the command that writes them
"""

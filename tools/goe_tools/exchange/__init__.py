"""Exchange with other software: reads an autopilot's log and a detector's boxes, writes MCAP for viewers.

recording     the flight in an autopilot's log, and its pose at any time
resets        detects jumps of the autopilot's filter from the motion
doubts        contradictions between the signals of a log, and odd boxes
ulog_file     the messages of PX4's log without damaged parts
ulog          PX4's log
dataflash     ArduPilot's log
tlog          a ground station's log of MAVLink messages
detections    the detector's table
clock         offset between the camera's clock and the autopilot's
offset        the offset of the command, or why there is none
convert       the command that makes an observation log of both
messages      an observation log and its estimates as messages of Foxglove's schemas
mcap_command  the command that writes them
"""

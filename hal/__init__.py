"""What a NAO offers to software: camera, head, walk, body sensors and a clock.

The protocols are in `hal.protocols`, the values that cross them in `hal.types`, the robot's
figures in `hal.nao`, and the table of backends in `hal.backends`. Nothing here knows what the
robot is used for.
"""

"""LoLA's messages written out by hand from `lola_protocol.yaml`, byte by byte.

Nothing of ours takes part: numbers are given as the four bytes of their IEEE 754 single.
"""

from __future__ import annotations

# value: its bytes as a big-endian float32, worked out by hand
F32 = {
    0.0: "00000000",
    1.0: "3f800000",
    -1.0: "bf800000",
    0.5: "3f000000",
    -0.5: "bf000000",
    0.25: "3e800000",
    0.125: "3e000000",
    -0.375: "bec00000",
    0.75: "3f400000",
    1.5: "3fc00000",
    2.0: "40000000",
    -9.75: "c11c0000",
    32.0: "42000000",
    38.0: "42180000",
    45.5: "42360000",
}


def number(value: float) -> bytes:
    """One float32, its type before it."""
    return b"\xca" + bytes.fromhex(F32[value])


def numbers(*values: float) -> bytes:
    return b"".join(number(value) for value in values)


# 25 joints: HeadYaw 0.5, HeadPitch 0.25, LShoulderPitch 1.5, ..., LHipYawPitch -0.375,
# LHipPitch -0.5, LKneePitch 0.75, RKneePitch 0.125, LHand 1, RHand 0.25, else 0
POSITION = (
    b"\xa8Position\xdc\x00\x19"
    + numbers(0.5, 0.25)
    + numbers(1.5, 0.0, 0.0, 0.0, 0.0)
    + numbers(-0.375, 0.0, -0.5, 0.75, 0.0, 0.0)
    + numbers(0.0, 0.0, 0.125, 0.0, 0.0)
    + numbers(0.0, 0.0, 0.0, 0.0, 0.0)
    + numbers(1.0, 0.25)
)
STIFFNESS = b"\xa9Stiffness\xdc\x00\x19" + numbers(0.5, *[1.0] * 23, -1.0)
TEMPERATURE = b"\xabTemperature\xdc\x00\x19" + numbers(*[38.0] * 10, 45.5, *[38.0] * 14)
CURRENT = b"\xa7Current\xdc\x00\x19" + numbers(*[0.0] * 24, 0.125)
STATUS = b"\xa6Status\xdc\x00\x19" + b"\x00" * 10 + b"\x02" + b"\x00" * 14
BATTERY = b"\xa7Battery\x94" + numbers(0.75, 32.0, -1.0, 38.0)
ACCELEROMETER = b"\xadAccelerometer\x93" + numbers(0.25, -0.5, -9.75)
GYROSCOPE = b"\xa9Gyroscope\x93" + numbers(0.125, 0.25, -0.375)
ANGLES = b"\xa6Angles\x92" + numbers(0.125, -0.5)
SONAR = b"\xa5Sonar\x92" + numbers(1.5, 2.0)
FSR = b"\xa3FSR\x98" + numbers(0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 0.125, 0.0)
TOUCH = b"\xa5Touch\x9e" + numbers(1.0, *[0.0] * 13)
ROBOT_CONFIG = (
    b"\xabRobotConfig\x94\xb4P0000073A07S94700012\xa56.0.0\xb4P0000074A05S93M00061\xa56.0.0"
)
FIELDS = (
    POSITION,
    STIFFNESS,
    TEMPERATURE,
    CURRENT,
    STATUS,
    BATTERY,
    ACCELEROMETER,
    GYROSCOPE,
    ANGLES,
    SONAR,
    FSR,
    TOUCH,
    ROBOT_CONFIG,
)
SENSOR_FRAME = b"\x8d" + b"".join(FIELDS)
SENSOR_FRAME_REVERSED = b"\x8d" + b"".join(reversed(FIELDS))

# what a robot is told: the positions above, all joints at half stiffness but a free right hand,
# a chest of (0.25, 0.5, 1), ears at a half, everything else dark, sonar off
ACTUATOR_FRAME = (
    b"\x8b"
    + POSITION
    + b"\xa9Stiffness\xdc\x00\x19"
    + numbers(*[0.5] * 24, -1.0)
    + b"\xa5Chest\x93"
    + numbers(0.25, 0.5, 1.0)
    + b"\xa4LEar\x9a"
    + numbers(*[0.5] * 10)
    + b"\xa4REar\x9a"
    + numbers(*[0.5] * 10)
    + b"\xa4LEye\xdc\x00\x18"
    + numbers(*[0.0] * 24)
    + b"\xa4REye\xdc\x00\x18"
    + numbers(*[0.0] * 24)
    + b"\xa5LFoot\x93"
    + numbers(0.0, 0.0, 0.0)
    + b"\xa5RFoot\x93"
    + numbers(0.0, 0.0, 0.0)
    + b"\xa5Skull\x9c"
    + numbers(*[0.0] * 12)
    + b"\xa5Sonar\x92\xc2\xc2"
)


def with_bytes(frame: bytes, at: bytes, instead: bytes) -> bytes:
    """A frame in which one stretch of bytes, which must be there, is another of its length."""
    assert frame.count(at) >= 1
    assert len(at) == len(instead)
    return frame.replace(at, instead, 1)

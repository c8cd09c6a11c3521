"""A LoLA that does nothing but keep time: `python -m sim_backend.speak.lola_metronome PATH COUNT`.

It sends so many sensor messages of a standing robot, one every 12 ms, whether they are answered or
not, and prints when it sent each (ns of CLOCK_MONOTONIC, one line). The battery's charge carries
the message's number, so that whoever answered it can say which it was.
"""

from __future__ import annotations

import contextlib
import socket
import struct
import sys
import time

import numpy as np

from hal.lola.priority import be_first
from hal.nao.postures import posture
from hal.types import BodyState
from sim_backend.speak.lola_sensing import sensor_message

PERIOD_NS = 12_000_000
ACCEPT_S = 30.0
_BATTERY = b"\xa7Battery\x94\xca"


def keep_time(path: str, count: int) -> list[int]:
    """Serve one client so many messages; when each was sent."""
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as listener:
        listener.bind(path)
        listener.listen(1)
        listener.settimeout(ACCEPT_S)
        sys.stdout.write("listening\n")
        sys.stdout.flush()
        client, _ = listener.accept()
    with client:
        client.setblocking(False)
        return _beats(client, count)


def _beats(client: socket.socket, count: int) -> list[int]:
    message = bytearray(standing_message())
    at = message.index(_BATTERY) + len(_BATTERY)
    sent, deadline_ns = [], time.monotonic_ns()
    for number in range(count):
        deadline_ns += PERIOD_NS
        time.sleep(max(0, deadline_ns - time.monotonic_ns()) / 1e9)
        message[at : at + 4] = struct.pack(">f", float(number))
        with contextlib.suppress(BlockingIOError):
            while client.recv(65536):
                pass
        sent.append(time.monotonic_ns())
        with contextlib.suppress(BlockingIOError):
            client.send(message)
    time.sleep(0.1)
    return sent


def standing_message() -> bytes:
    """What a robot that stands measures."""
    body = BodyState(
        stamp_ns=0,
        angles_rad=posture("StandInit"),
        gyro_rad_s=np.zeros(3),
        accel_m_s2=np.array([0.0, 0.0, 9.81]),
        torso_roll_pitch_rad=np.zeros(2),
        fsr_kg=np.full(8, 0.65),
        battery=0.0,
        temperature_max_c=40.0,
    )
    return sensor_message(body, np.zeros(3), np.full(26, 0.6), button=False)


if __name__ == "__main__":
    be_first()
    stamps = keep_time(sys.argv[1], int(sys.argv[2]))
    sys.stdout.write(" ".join(map(str, stamps)) + "\n")

"""A daemon that dies or hangs, seen from the robot: it stops at once, then sits down and is let go.

The robot is the simulated one, behind its own LoLA on a real socket; the daemon is a process.
"""

from __future__ import annotations

import signal
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from lola_peer import Peer
from lola_script import Client, hire, wait_for

from hal.lola.channel import LeaveWish
from hal.lola.poses import LEGS, SEAT, STAND
from hal.nao.joints import JOINT_INDEX

YAW = JOINT_INDEX["HeadYaw"]


@pytest.fixture
def peer(tmp_path: Path) -> Iterator[Peer]:
    made = Peer(tmp_path, STAND)
    yield made
    made.close()


@pytest.fixture
def low_peer(tmp_path: Path) -> Iterator[Peer]:
    """One that has not far to sit down."""
    made = Peer(tmp_path, STAND + 0.7 * (SEAT - STAND))
    yield made
    made.close()


def turning(angles: np.ndarray) -> bool:
    return bool(0.1 < angles[YAW] < 1.0)


def test_hung_client_stops_the_head_at_once_and_then_sits_the_robot_down(low_peer: Peer) -> None:
    """S2: SIGSTOP. Its last look had five more seconds to go."""
    peer, knee = low_peer, JOINT_INDEX["LKneePitch"]
    client = Client(peer.path, sit_after_s=1.5)
    try:
        client.wait_ready()
        peer.wait_until(turning)
        client.signal(signal.SIGSTOP)
        hung = time.monotonic()
        yaw, bent = peer.world.angles_rad[YAW], peer.world.angles_rad[knee]
        peer.wait_until(lambda angles: angles[knee] > bent + 0.03)
        assert time.monotonic() - hung > 1.2
        # half a second until its silence counts, at 0.5 rad/s, and as much for a busy machine
        assert peer.world.angles_rad[YAW] - yaw < 0.5 * (0.5 + 0.5)
        line = peer.wait_for_line("the client has gone")
        assert line == "the client has gone; the robot sits, its joints free"
        assert peer.world.angles_rad[LEGS] == pytest.approx(SEAT[LEGS], abs=0.05)
    finally:
        client.close()


def test_killed_client_is_replaced_without_lola_noticing(peer: Peer) -> None:
    """S2 and S8: SIGKILL; the next daemon takes the process over, and nothing has moved."""
    client = Client(peer.path, sit_after_s=5.0)
    try:
        client.wait_ready()
        peer.wait_until(turning)
    finally:
        client.signal(signal.SIGKILL)
        client.close()
    line = hire(peer.path)
    try:
        status = wait_for(line, lambda s: s.connected)
        assert status.connections == 1
        assert status.phase == "holding"
        assert peer.lines == ["a client has connected"]
        assert peer.world.angles_rad[LEGS] == pytest.approx(STAND[LEGS], abs=0.01)
        assert (peer.world.stiffness[LEGS] > 0.0).all()
    finally:
        line.send(LeaveWish())
        assert line.close(10.0)
    assert peer.wait_for_line("gone").endswith("the robot sits, its joints free")
    assert not peer.world.fallen

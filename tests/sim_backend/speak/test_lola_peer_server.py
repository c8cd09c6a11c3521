"""The simulated robot's LoLA on a real socket: rate, one client, and clients that misbehave."""

from __future__ import annotations

import os
import socket
import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from hal.errors import BackendError
from hal.lola.actuators import Actuators, encode_actuators
from hal.lola.poses import STAND
from hal.lola.sensors import Sensors, decode_sensors
from hal.scenario import Scenario
from sim_backend.clocks import RealClock
from sim_backend.defaults import resolved
from sim_backend.speak.lola_body import JointWorld
from sim_backend.speak.lola_server import LolaServer

PATIENCE_S = 10.0


class Peer:
    """A LoLA and its robot in threads of this process."""

    def __init__(self, path: str) -> None:
        self.path = path
        self.world = JointWorld(resolved(Scenario()), "v6", 0, time.monotonic_ns, STAND)
        self._clock = RealClock(self.world)
        self.lines: list[str] = []
        self.server = LolaServer(path, self.world, self.lines.append)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self.server.run, args=(self._stop,))
        self._thread.start()

    def close(self) -> None:
        self._stop.set()
        self._thread.join()
        self._clock.close()


@pytest.fixture
def peer(tmp_path: Path) -> Iterator[Peer]:
    made = Peer(str(tmp_path / "robocup"))
    yield made
    made.close()


def connect(peer: Peer) -> socket.socket:
    link = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    link.settimeout(PATIENCE_S)
    link.connect(peer.path)
    return link


def receive(link: socket.socket) -> Sensors:
    data = b""
    while len(data) < 896:
        more = link.recv(896 - len(data))
        assert more, "hung up"
        data += more
    return decode_sensors(data)


def ended(link: socket.socket) -> bool:
    """Whether the other side hangs up, whatever it still sends."""
    try:
        while link.recv(65536):
            pass
    except ConnectionResetError:
        pass
    return True


def test_messages_come_83_times_a_second(peer: Peer) -> None:
    with connect(peer) as link:
        receive(link)
        begin = time.monotonic()
        for _ in range(50):
            receive(link)
        took = time.monotonic() - begin
    # never sooner; a busy machine may be late, at either end
    assert 50 * 0.012 - 0.015 < took < 2.0 * 50 * 0.012


def test_targets_move_the_robot_and_come_back_as_measurements(peer: Peer) -> None:
    target = STAND.copy()
    target[:2] = (0.5, 0.25)
    message = encode_actuators(Actuators(target, np.full(26, 0.5)))
    with connect(peer) as link:
        for _ in range(60):
            seen = receive(link)
            link.sendall(message)
        assert seen.angles_rad[:2] == pytest.approx([0.5, 0.25], abs=0.005)
        assert (seen.stiffness == 0.5).all()
        assert seen.accel_m_s2[2] == pytest.approx(9.8, abs=0.4)
        assert seen.fsr_kg.sum() == pytest.approx(5.36, abs=0.2)


def test_gyroscope_changes_every_second_message_only(peer: Peer) -> None:
    with connect(peer) as link:
        read = [tuple(receive(link).gyro_rad_s) for _ in range(12)]
    pairs = read[1:] if read[0] != read[1] else read
    for first, second in zip(pairs[0:-1:2], pairs[1::2], strict=False):
        assert first == second
    assert len(set(read)) >= 6


def test_second_client_is_hung_up_on_and_the_first_does_not_notice(peer: Peer) -> None:
    with connect(peer) as first:
        receive(first)
        with connect(peer) as second:
            assert ended(second)
        for _ in range(5):
            receive(first)
    assert "a second client was turned away" in peer.lines


def test_next_client_is_served_when_the_first_has_gone(peer: Peer) -> None:
    for _ in range(3):
        with connect(peer) as link:
            receive(link)


@pytest.mark.parametrize("junk", [b"hello, robot", b"\x81\xa5Chest\x92\x00\x00", b"\xc1"])
def test_client_that_talks_nonsense_is_hung_up_on(peer: Peer, junk: bytes) -> None:
    with connect(peer) as link:
        receive(link)
        link.sendall(junk)
        assert ended(link)
    with connect(peer) as link:
        receive(link)


def test_client_that_does_not_read_is_ignored_until_it_goes(peer: Peer) -> None:
    target = STAND.copy()
    target[0] = 1.0
    with connect(peer) as link:
        watch = threading.Event()
        limit = time.monotonic() + PATIENCE_S
        while not any("does not read" in line for line in peer.lines):
            assert time.monotonic() < limit
            watch.wait(0.02)
        link.sendall(encode_actuators(Actuators(target, np.full(26, 0.5))))
        watch.wait(0.05)
    with connect(peer) as link:
        assert receive(link).angles_rad[0] == pytest.approx(0.0, abs=0.01)


def test_chest_button_is_reported(peer: Peer) -> None:
    with connect(peer) as link:
        assert not receive(link).chest_button
        peer.server.button = True
        assert any(receive(link).chest_button for _ in range(5))


def test_path_in_use_is_refused_and_an_orphan_is_replaced(tmp_path: Path) -> None:
    path = str(tmp_path / "robocup")
    orphan = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    orphan.bind(path)
    orphan.close()
    peer = Peer(path)
    try:
        with pytest.raises(BackendError, match="cannot listen"):
            LolaServer(path, peer.world, print)
        with connect(peer) as link:
            receive(link)
    finally:
        peer.close()
    assert not os.path.exists(path)

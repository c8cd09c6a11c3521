"""Looking at a robot on LoLA: it is listened to, and not a byte is sent."""

from __future__ import annotations

import socket
import threading

import numpy as np
import pytest
from lola_literal import SENSOR_FRAME

from hal.backends import OpenOptions, examine
from hal.clock import MonotonicClock
from hal.types import Frame
from hal.video.server import FrameServer
from hal.video.slot import SlotCamera

SIZE = (160, 120)


class Listened:
    """A LoLA of one client: sends what it is given, keeps what it is told."""

    def __init__(self, path, message):
        self.told = b""
        self._listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._listener.bind(str(path))
        self._listener.listen(1)
        self._message = message
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self):
        link, _ = self._listener.accept()
        with link:
            link.sendall(self._message)
            while data := link.recv(4096):
                self.told += data

    def close(self):
        self._thread.join(5.0)
        self._listener.close()


@pytest.fixture
def pictures(tmp_path):
    """A camera whose pictures are half bright, taken again and again."""
    camera = SlotCamera("top", SIZE, MonotonicClock())
    server = FrameServer(f"unix:{tmp_path}/camera", camera)
    server.start()
    over = threading.Event()

    def take():
        number = 0
        while not over.wait(0.02):
            yuyv = np.full((SIZE[1], SIZE[0], 2), 128, dtype=np.uint8)
            camera.slot.put(Frame(MonotonicClock().now_ns(), yuyv, "top", 0.0, number))
            number += 1

    thread = threading.Thread(target=take, daemon=True)
    thread.start()
    yield server.address
    over.set()
    thread.join(5.0)
    server.close()


def visited(tmp_path, device, message):
    robot = Listened(tmp_path / "robocup", message)
    section = {"socket": str(tmp_path / "robocup"), "device": device}
    options = OpenOptions(width=SIZE[0], height=SIZE[1], section=section)
    found = {finding.check: finding for finding in examine("lola", options)}
    robot.close()
    return robot, found


def test_what_comes_is_told_and_nothing_is_sent(tmp_path, pictures):
    robot, found = visited(tmp_path, pictures, SENSOR_FRAME)
    assert robot.told == b""
    assert found["lola"].status == "ok"
    assert "6.0.0" in found["lola"].text
    assert {"joints", "battery", "camera socket"} <= set(found)
    assert found["camera clock"].status == "ok"
    assert found["camera light"].text == "mean brightness 128 of 255"


def test_rubbish_and_no_camera_are_findings(tmp_path):
    robot, found = visited(tmp_path, f"unix:{tmp_path}/none", b"\x00" * 896)
    assert robot.told == b""
    assert found["lola"].status == "fail"
    assert found["camera"].status == "fail"
    assert all(finding.advice for finding in found.values())

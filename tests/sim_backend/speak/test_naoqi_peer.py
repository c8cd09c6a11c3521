"""The peer as anybody's program sees it: plain qi calls, signatures and answers as on a robot."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator
from typing import Any

import pytest

from hal.backends import OpenOptions, speak
from hal.errors import BackendError
from hal.nao.joints import JOINT_NAMES
from sim_backend.speak.naoqi_options import PeerOptions, split

qi = pytest.importorskip("qi", reason="the package qi is not installed")
pytestmark = pytest.mark.qi

ANSWERS_S = 60.0
NO_PARAMETER = 0xDEAD404


@pytest.fixture(scope="module")
def session() -> Iterator[Any]:
    """Served in this process: connected to by its url all the same."""
    stop, served = threading.Event(), threading.Event()
    told: dict[str, object] = {}

    def ready(said: dict[str, object]) -> None:
        told.update(said)
        served.set()

    options = OpenOptions(width=160, height=120)
    thread = threading.Thread(
        target=speak, args=("naoqi", options, "127.0.0.1:0", None, stop, ready)
    )
    thread.start()
    assert served.wait(ANSWERS_S)
    session = qi.Session()
    session.connect(told["url"])
    yield session
    session.close()
    stop.set()
    thread.join(10.0)
    assert not thread.is_alive()


def test_services_of_a_nao(session):
    names = {service["name"] for service in session.services()}
    assert {"ALMotion", "ALVideoDevice", "ALMemory", "ALRobotPosture", "ALAutonomousLife"} <= names


def test_body_by_name_and_by_list(session):
    motion = session.service("ALMotion")
    assert tuple(motion.getBodyNames("Body")) == JOINT_NAMES
    angles = motion.getAngles("Body", True)
    assert len(angles) == 26
    assert motion.getAngles(["LKneePitch", "HeadYaw"], True) == pytest.approx(
        [angles[11], angles[0]], abs=0.01
    )
    assert len(motion.getLimits("Head")) == 2
    with pytest.raises(RuntimeError, match="not a valid joint"):
        motion.getAngles("Tail", True)


def test_head_turns_while_a_walk_blocks(session):
    motion = session.service("ALMotion")
    walking = motion.moveTo(0.05, 0.0, 0.0, [["MaxStepX", 0.04]], _async=True)
    motion.setAngles(["HeadYaw"], [0.3], 0.5)
    while abs(motion.getAngles("HeadYaw", True)[0] - 0.3) > 0.02:
        assert not walking.isFinished()
    assert motion.moveIsActive()
    assert walking.value(20_000) is True
    assert not motion.moveIsActive()
    assert motion.getRobotPosition(True)[0] == pytest.approx(0.05, abs=0.005)


def test_interrupted_walk_says_so(session):
    motion = session.service("ALMotion")
    walking = motion.moveTo(0.5, 0.0, 0.0, _async=True)
    while not motion.moveIsActive():
        assert not walking.isFinished()
    assert motion.stopMove() is True
    assert walking.value(5000) is False
    assert motion.getRobotVelocity() == [0.0, 0.0, 0.0]


def test_limp_legs_do_not_walk(session):
    motion = session.service("ALMotion")
    motion.rest()
    assert motion.robotIsWakeUp() is False
    assert motion.moveTo(0.1, 0.0, 0.0) is False
    assert session.service("ALRobotPosture").getPostureFamily() == "Crouching"
    assert motion.wakeUp() is True
    assert session.service("ALRobotPosture").getPosture() == "StandInit"


def test_picture_is_twelve_values_with_raw_bytes(session):
    video = session.service("ALVideoDevice")
    handle = video.subscribeCamera("somebody", 1, 0, 9, 10)
    assert handle == "somebody_0"
    image = video.getImageRemote(handle)
    while not image[0]:
        image = video.getImageRemote(handle)
    assert image[:4] == (160, 120, 2, 9)
    assert type(image[6]) is bytearray
    assert len(image[6]) == 160 * 120 * 2
    assert image[7] == 1
    assert 0 <= image[5] < 1_000_000
    assert video.unsubscribe(handle) is True
    assert video.subscribeCamera("somebody", 1, 0, 11, 10) == ""


def test_controls_have_a_v6s_ranges(session):
    video = session.service("ALVideoDevice")
    assert video.getParameterRange(0, 6) == [0, 1023]
    assert video.setParameter(0, 17, 100) is False
    assert video.setParameter(0, 11, 0) is True
    assert video.setParameter(0, 17, 100) is True
    assert video.getParameter(0, 17) == 100
    assert video.getParameter(0, 33) == NO_PARAMETER


def test_memory_knows_the_body_and_stamps_what_is_written(session):
    memory = session.service("ALMemory")
    gyro = "Device/SubDeviceList/InertialSensor/AccelerometerZ/Sensor/Value"
    found = memory.getListData([gyro, "no such key", "footContactChanged"])
    assert found[0] == pytest.approx(9.81, abs=0.5)
    assert found[1:] == [None, True]
    memory.insertData("somebody/mark", 5)
    value, seconds, micros = memory.getTimestamp("somebody/mark")
    assert value == 5
    assert seconds + micros / 1e6 == pytest.approx(
        time.monotonic() + PeerOptions().clock_offset_s, abs=5.0
    )
    with pytest.raises(RuntimeError, match="does not exist"):
        memory.getData("no such key")


@pytest.mark.parametrize(
    ("told", "text"),
    [({"hurry": 1}, "'hurry'"), ({"image": "png"}, "'png'"), (3, "not a table")],
)
def test_options_are_checked(told, text):
    with pytest.raises(BackendError, match=text):
        split(OpenOptions(section={"naoqi": told}))


def test_address_in_use_is_one_line():
    with socket.create_server(("127.0.0.1", 0)) as taken:
        address = f"127.0.0.1:{taken.getsockname()[1]}"
        with pytest.raises(BackendError, match=f"cannot listen on tcp://{address}: .") as caught:
            speak(
                "naoqi", OpenOptions(width=160, height=120), address, None, threading.Event(), print
            )
    assert "\n" not in str(caught.value)


def test_no_other_camera():
    with pytest.raises(BackendError, match="ALVideoDevice"):
        speak("naoqi", OpenOptions(), "", "device", threading.Event(), lambda _said: None)

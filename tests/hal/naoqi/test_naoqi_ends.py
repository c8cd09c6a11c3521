"""The ways in which it ends badly: daemon, watchdog, network or robot gone during a walk."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from naoqi_peer import Peer, until
from naoqi_proxy import Network

from hal.errors import HalError, MotionRefusedError
from hal.types import PlanarMotion

FAR = PlanarMotion(0.6, 0.0, 0.0)
WALKER = Path(__file__).with_name("naoqi_walker.py")
AUTO_EXPOSITION = 11


def start(peer: Peer, what: str) -> subprocess.Popen[str]:
    process = subprocess.Popen(
        [sys.executable, str(WALKER), peer.url, what], stdout=subprocess.PIPE, text=True
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "under way\n"
    return process


def end(process: subprocess.Popen[str]) -> None:
    process.kill()
    process.wait()
    assert process.stdout is not None
    process.stdout.close()


@pytest.mark.parametrize("number", [signal.SIGKILL, signal.SIGSTOP])
def test_daemon_that_dies_or_hangs_leaves_a_standing_robot(peer, number):
    """S2, at a velocity, which NAOqi itself would keep for ever."""
    process = start(peer, "walk")
    try:
        until(lambda: peer.world("truth")["velocity"][0] > 0.05)
        process.send_signal(number)
        begin_s = time.monotonic()
        until(lambda: peer.world("truth")["velocity"] == [0.0, 0.0, 0.0])
        # the last renewal was for 0.4 s
        assert time.monotonic() - begin_s < 0.4 + 0.3
        until(lambda: not peer.is_moving())
        assert time.monotonic() - begin_s < 0.4 + 1.2
    finally:
        end(process)


@pytest.mark.slow
def test_what_a_killed_daemon_could_not_put_back_the_next_one_does(peer):
    end(start(peer, "stand"))
    assert peer.ask.call("ALAutonomousLife", "getState") == "disabled"
    assert peer.ask.call("ALVideoDevice", "getParameter", 0, AUTO_EXPOSITION) == 0
    assert peer.ask.call("ALVideoDevice", "getSubscribers") == ["naod_test_0"]
    robot = peer.robot()
    robot.camera.unseen(20.0)
    robot.close()
    assert peer.ask.call("ALAutonomousLife", "getState") == "solitary"
    assert peer.ask.call("ALBasicAwareness", "isEnabled")
    assert peer.ask.call("ALVideoDevice", "getParameter", 0, AUTO_EXPOSITION) == 1
    assert peer.ask.call("ALVideoDevice", "getSubscribers") == []


def test_no_walk_without_its_watchdog(peer, walker):
    walker.walk.set_velocity(PlanarMotion(0.09, 0.0, 0.0), 10.0)
    until(peer.is_moving)
    first = walker.guard.pid
    os.kill(first, signal.SIGKILL)
    until(lambda: not peer.is_moving())
    # another one is started, and then it may walk again
    until(lambda: walker.guard.pid not in (None, first) and walker.guard.objection is None)
    until(lambda: not walker.walk.status().moving)
    walker.walk.move_to(PlanarMotion(0.02, 0.0, 0.0), 5.0)


@pytest.mark.slow
def test_watchdog_that_hangs_stops_the_walk_and_is_told(peer, walker):
    walker.walk.set_velocity(PlanarMotion(0.09, 0.0, 0.0), 10.0)
    until(peer.is_moving)
    os.kill(walker.guard.pid, signal.SIGSTOP)
    try:
        until(lambda: not peer.is_moving())
        with pytest.raises(MotionRefusedError, match="watchdog is silent"):
            walker.walk.move_to(FAR, 1.0)
    finally:
        os.kill(walker.guard.pid, signal.SIGCONT)
    until(lambda: walker.guard.objection is None)


@pytest.fixture
def network(peer: Peer) -> Iterator[Network]:
    found = Network(peer.url)
    yield found
    found.close()


def test_session_cut_in_the_middle_of_a_walk(peer, network):
    """Cable out: blind, deaf and refusing. Cable in: the robot is stopped first of all."""
    robot = peer.robot(url=network.url)
    try:
        robot.camera.unseen(20.0)
        robot.walk.move_to(FAR, 0.6)
        until(lambda: peer.world("truth")["velocity"][0] > 0.05)
        network.cut()
        until(lambda: robot.walk.error is not None)
        with pytest.raises(MotionRefusedError, match=r"reachable|connected|connection"):
            robot.walk.move_to(FAR, 0.6)
        last_ns = robot.body.latest().stamp_ns
        with pytest.raises(HalError, match=r"reachable|connected|connection"):
            until(lambda: robot.camera.latest(0.3) is None)
        assert robot.body.latest().stamp_ns == last_ns
        assert robot.walk.status().velocity.x >= 0.0
        network.mend()
        until(lambda: not peer.is_moving())
        assert peer.world("truth")["base"][0] < 0.5
        until(lambda: robot.walk.error is None)
        assert robot.body.await_at(time.monotonic_ns(), 10.0)
        robot.camera.next(20.0)
        until(lambda: robot.guard.objection is None)
        assert not robot.walk.status().moving
        robot.walk.move_to(PlanarMotion(0.02, 0.0, 0.0), 5.0)
    finally:
        robot.close()


@pytest.mark.slow
def test_restart_of_the_robot_in_the_middle_of_a_walk(peer, robot):
    """Services are fetched again, life and camera taken over again, and put back at the end."""
    robot.walk.move_to(FAR, 5.0)
    until(peer.is_moving)
    peer.again()
    until(lambda: robot.walk.error is None)
    assert robot.body.await_at(time.monotonic_ns(), 10.0)
    robot.camera.next(20.0)
    until(lambda: peer.ask.call("ALAutonomousLife", "getState") == "disabled")
    until(lambda: robot.guard.objection is None)
    assert not robot.walk.status().moving
    assert not peer.is_moving()
    assert peer.ask.call("ALVideoDevice", "getParameter", 0, AUTO_EXPOSITION) == 0
    robot.walk.move_to(PlanarMotion(0.02, 0.0, 0.0), 5.0)
    robot.close()
    assert peer.ask.call("ALVideoDevice", "getParameter", 0, AUTO_EXPOSITION) == 1


@pytest.mark.slow
def test_robot_that_hangs_makes_everything_stale_and_refusing(peer, walker):
    os.kill(peer.process.pid, signal.SIGSTOP)
    try:
        until(lambda: walker.walk.error is not None)
        with pytest.raises(MotionRefusedError):
            walker.walk.move_to(FAR, 0.5)
        before_ns = walker.body.latest().stamp_ns
        assert not walker.body.await_at(time.monotonic_ns(), 0.3)
        assert walker.body.latest().stamp_ns - before_ns < 1_000_000_000
    finally:
        os.kill(peer.process.pid, signal.SIGCONT)
    until(lambda: walker.walk.error is None)
    assert walker.body.await_at(time.monotonic_ns(), 10.0)


@pytest.mark.slow
def test_missing_services_are_done_without_or_told(peer):
    missing = ["ALAutonomousLife", "ALBasicAwareness", "ALRobotPosture"]
    peer.again("become", {"missing": missing})
    robot = peer.robot()
    try:
        robot.walk.move_to(PlanarMotion(0.02, 0.0, 0.0), 5.0)
    finally:
        robot.close()
    for needed in ("ALMotion", "ALVideoDevice", "ALMemory"):
        peer.again("become", {"missing": [needed]})
        with pytest.raises(HalError, match=needed) as caught:
            peer.robot()
        assert "\n" not in str(caught.value)
    peer.again("become", {"missing": []})


STRICT = (
    "ALVideoDevice.getSubscribers",
    "ALVideoDevice.releaseImage",
    "ALVideoDevice.setParameter",
    "ALMemory.insertData",
    "ALMemory.getTimestamp",
    "ALMemory.getData",
    "ALMotion.robotIsWakeUp",
    "ALMotion.getStiffnesses",
    "ALRobotPosture.getPostureFamily",
    "ALAutonomousLife.setState",
    "ALBasicAwareness.setEnabled",
)


@pytest.mark.slow
def test_robot_that_refuses_all_that_can_be_done_without(peer):
    """Then it sees and walks all the same, and says what it did not get."""
    for method in STRICT:
        peer.world("refuse", method, "not for you")
    robot = peer.robot()
    try:
        for _ in range(3):
            frame = robot.camera.unseen(20.0)
        assert abs(frame.stamp_ns - peer.world("pictureTaken")) < 150_000_000
        assert "kCameraAutoExpositionID" in robot.camera.locked.not_taken
        assert robot.body.clock_offset() is None
        robot.walk.move_to(PlanarMotion(0.05, 0.0, 0.0), 5.0)
        until(peer.is_moving)
        robot.walk.stop()
        until(lambda: not robot.walk.status().moving)
    finally:
        robot.close()
        peer.reset()
        # what it would not let us unsubscribe is left to the next one
        peer.robot().close()


def test_robot_that_is_not_there_is_one_line(peer):
    with pytest.raises(HalError, match="not reachable") as caught:
        peer.robot(url="tcp://127.0.0.1:1")
    assert "\n" not in str(caught.value)

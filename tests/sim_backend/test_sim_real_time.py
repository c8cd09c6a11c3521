"""The world beside the machine's clock."""

from __future__ import annotations

import threading
import time

import pytest
from sim_world import Opened

from hal.errors import BackendError
from hal.types import PlanarMotion


def test_time_runs_by_itself_and_pictures_come_in_it(opened: Opened) -> None:
    robot = opened(real_time=True)
    robot.camera.next(20.0)  # numba compiles on the first picture
    begin = time.monotonic_ns()
    frames = [robot.camera.unseen(2.0) for _ in range(5)]
    assert robot.clock.now_ns() >= frames[-1].stamp_ns
    assert 0.2 < (time.monotonic_ns() - begin) / 1e9 < 2.0
    for frame in frames:
        assert robot.body.at(frame.stamp_ns) is not None
    assert abs(robot.truth().stamp_ns - time.monotonic_ns()) < 1e9


def test_a_motion_ends_by_itself_though_nobody_asks(opened: Opened) -> None:
    robot = opened(real_time=True)
    robot.walk.set_velocity(PlanarMotion(0.08, 0.0, 0.0), 0.2)
    robot.clock.sleep_until(robot.clock.now_ns() + 1_500_000_000)
    status = robot.walk.status()
    assert status.velocity == PlanarMotion(0.0, 0.0, 0.0)
    assert not status.moving


def test_walking_goes_on_while_pictures_are_taken(opened: Opened) -> None:
    robot = opened(real_time=True, size=(640, 480))
    robot.camera.next(20.0)
    stop, seen = threading.Event(), []

    def watch() -> None:
        while not stop.is_set():
            seen.append(robot.camera.unseen(2.0).sequence)

    watcher = threading.Thread(target=watch)
    watcher.start()
    robot.walk.set_velocity(PlanarMotion(0.09, 0.0, 0.0), 10.0)
    robot.clock.sleep_until(robot.clock.now_ns() + 3_000_000_000)
    stop.set()
    watcher.join()
    assert len(seen) > 5
    assert 0.08 < robot.walk.status().odometry.x < 0.25


def test_real_time_cannot_be_stepped(opened: Opened) -> None:
    robot = opened(real_time=True)
    with pytest.raises(BackendError, match="lock-step"):
        robot.advance(robot.clock.now_ns() + 1)


def test_a_closed_robot_says_so(opened: Opened) -> None:
    robot = opened(real_time=True)
    robot.close()
    robot.close()
    with pytest.raises(BackendError, match="closed"):
        robot.truth()

"""The backend as the daemon has it, on the simulated robot's LoLA and a picture for a camera."""

from __future__ import annotations

import math
import threading
from collections.abc import Iterator
from pathlib import Path

import cv2
import numpy as np
import pytest
from lola_peer import Peer

from hal.backends import OpenOptions, examine, open_robot
from hal.errors import BackendError, MotionRefusedError
from hal.health import Examined
from hal.lola.poses import LEGS, SEAT, STAND
from hal.nao.joints import JOINT_INDEX
from hal.protocols import Robot
from hal.types import HeadAngles, PlanarMotion

STEP = PlanarMotion(0.1, 0.0, 0.0)


def options(peer: Peer, folder: Path, **more: object) -> OpenOptions:
    picture = folder / "view.png"
    cv2.imwrite(str(picture), np.full((120, 160, 3), 90, np.uint8))
    section = {"socket": peer.path, "device": str(picture), **more}
    return OpenOptions(width=160, height=120, section=section)


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("lola")


@pytest.fixture(scope="module")
def peer(folder: Path) -> Iterator[Peer]:
    """One that sits almost, so that it has not far to go."""
    made = Peer(folder, STAND + 0.8 * (SEAT - STAND))
    yield made
    made.close()


@pytest.fixture(scope="module")
def robot(peer: Peer, folder: Path) -> Iterator[Robot]:
    made = open_robot("lola", options(peer, folder))
    yield made
    made.close()
    assert peer.wait_for_line("gone").endswith("the robot sits, its joints free")
    made.close()


def test_it_says_what_it_is(robot: Robot) -> None:
    assert (robot.info.backend, robot.info.simulated) == ("lola", False)
    assert robot.camera.size == (160, 120)


def test_head_is_turned_clipped_and_comes_back_as_a_measurement(robot: Robot, peer: Peer) -> None:
    peer.wait_until(lambda _angles: peer.world.stiffness[0] > 0.5)
    asked = robot.clock.now_ns()
    sent = robot.head.look(HeadAngles(0.4, 9.0), 3.0)
    assert sent.pitch_rad == pytest.approx(0.4386, abs=1e-3), "the shell's limit at this yaw"
    peer.wait_until(lambda angles: np.allclose(angles[:2], [0.4, sent.pitch_rad], atol=1e-3))
    newest = robot.body.latest()
    past = robot.body.at((asked + newest.stamp_ns) // 2)
    assert past is not None
    assert past.stamp_ns == (asked + newest.stamp_ns) // 2
    assert -0.01 <= past.angles_rad[0] <= 0.41
    assert robot.body.at(robot.clock.now_ns() + 1_000_000_000) is None
    assert robot.body.at(asked - 60_000_000_000) is None


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_what_is_not_finite_is_refused(robot: Robot, bad: float) -> None:
    for refused in (
        lambda: robot.head.look(HeadAngles(bad, 0.0), 1.0),
        lambda: robot.head.look(HeadAngles(0.0, 0.0), bad),
        lambda: robot.walk.set_velocity(PlanarMotion(bad, 0.0, 0.0), 0.3),
        lambda: robot.walk.move_to(PlanarMotion(0.0, 0.0, bad), 0.3),
        lambda: robot.walk.move_to(STEP, bad),
        lambda: robot.walk.renew(bad),
    ):
        with pytest.raises(MotionRefusedError, match="not"):
            refused()


def test_walk_is_refused_with_the_reason_and_stopping_is_not(robot: Robot) -> None:
    for refused in (robot.walk.move_to, robot.walk.set_velocity):
        with pytest.raises(MotionRefusedError, match="no walking engine"):
            refused(STEP, 0.3)
    robot.walk.stop()
    still = PlanarMotion(0.0, 0.0, 0.0)
    assert robot.walk.set_velocity(still, 0.3) == still
    robot.walk.renew(0.3)
    status = robot.walk.status()
    assert (status.moving, status.fallen, status.velocity) == (False, False, still)


def test_examination_is_all_well(robot: Robot) -> None:
    assert isinstance(robot, Examined)
    found = {finding.check: finding for finding in robot.examine()}
    assert found["lola"].status == "ok"
    assert "P0000073A07S94700012" in found["lola"].text
    assert found["joints"].status == "ok"
    assert found["battery"].text == "92%, not charging"


def test_doctor_leaves_a_robot_alone_that_a_daemon_has(
    robot: Robot, peer: Peer, folder: Path
) -> None:
    """Another client of LoLA's would do nobody knows what."""
    found = [f for f in examine("lola", options(peer, folder)) if f.check == "lola"]
    assert [f.text for f in found] == ["a daemon has this robot, and it is left alone"]
    robot.body.latest()
    assert peer.lines == ["a client has connected"]


def test_chest_button_stands_it_up_and_the_walk_is_moving_meanwhile(
    robot: Robot, peer: Peer
) -> None:
    knee = JOINT_INDEX["LKneePitch"]
    before = peer.world.angles_rad[knee]
    assert not robot.walk.status().moving
    press(peer)
    peer.wait_until(lambda angles: abs(angles[knee] - before) > 0.05)
    assert robot.walk.status().moving
    # almost seated is not seated: the press sat it down, and the next one stands it up
    press(peer)
    peer.wait_until(lambda angles: angles[knee] < before - 0.05)
    press(peer)
    peer.wait_until(lambda angles: np.allclose(angles[LEGS], SEAT[LEGS], atol=0.01))
    peer.wait_until(lambda _angles: not peer.world.stiffness.any())
    with pytest.raises(MotionRefusedError, match="rests"):
        robot.head.look(HeadAngles(0.0, 0.0), 1.0)
    with pytest.raises(MotionRefusedError, match="rests"):
        robot.walk.move_to(STEP, 0.3)


def press(peer: Peer) -> None:
    """As long as a finger does: some of LoLA's messages."""
    peer.server.button = True
    threading.Event().wait(0.15)
    peer.server.button = False


@pytest.mark.parametrize(
    ("more", "said"),
    [
        ({"baud": 9600}, "unknown LoLA option 'baud'"),
        ({"socket": ""}, "socket: not a path"),
        ({"socket": "s" * 200}, "socket: not a path"),
        ({"device": 5}, "device: not a text"),
        ({"controls": 5}, "controls: not a table"),
        ({"sit_after_s": 0.0}, "sit_after_s: not positive"),
        ({"sit_after_s": True}, "sit_after_s: not a number"),
        ({"stand_up": "now"}, "stand_up: neither"),
        ({"when_fallen": "cry"}, "when_fallen: neither"),
    ],
)
def test_impossible_options_are_refused_by_name(
    peer: Peer, tmp_path: Path, more: dict[str, object], said: str
) -> None:
    with pytest.raises(BackendError, match=said):
        open_robot("lola", options(peer, tmp_path, **more))


def test_lola_is_of_the_v6_only() -> None:
    with pytest.raises(BackendError, match="LoLA is of the V6"):
        open_robot("lola", OpenOptions(version="v5"))


def test_camera_that_is_not_there_leaves_no_process_behind(tmp_path: Path) -> None:
    peer = Peer(tmp_path, SEAT)
    try:
        with pytest.raises(BackendError, match="camera"):
            open_robot("lola", options(peer, tmp_path, device=str(tmp_path / "none")))
        assert peer.wait_for_line("gone").endswith("the robot sits, its joints free")
    finally:
        peer.close()

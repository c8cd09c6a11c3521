"""Pictures by ALVideoDevice, their time, and the camera's controls."""

from __future__ import annotations

import time

import numpy as np
import pytest
from naoqi_peer import SIZE, until

from hal.errors import CameraTimeoutError, HalError
from hal.nao.cameras import SIZES
from hal.naoqi.ids import PARAMETERS, RESOLUTION_NAMES
from hal.types import HeadAngles

AUTO = [PARAMETERS[f"kCameraAuto{name}ID"] for name in ("Exposition", "WhiteBalance", "Focus")]


def parameter(peer, number, camera=0):
    return peer.ask.call("ALVideoDevice", "getParameter", camera, number)


def test_picture_is_the_one_that_was_taken_when_it_says(peer, robot):
    """The robot's clock is 4321.5 s ahead; all processes here share one, so truth is known."""
    errors = []
    for _ in range(8):
        frame = robot.camera.unseen(5.0)
        errors.append((frame.stamp_ns - peer.world("pictureTaken")) / 1e6)
        assert frame.yuyv.shape == (SIZE[1], SIZE[0], 2)
        assert robot.body.at(frame.stamp_ns) is not None
    # the peer may have taken another one meanwhile, a period later
    assert np.min(np.abs(errors)) < 1.0
    offset, uncertainty = robot.body.clock_offset()
    assert abs(offset / 1e9 - 4321.5) < uncertainty / 1e9 + 1e-6
    assert uncertainty < 20_000_000
    assert not robot.camera.other_clock


@pytest.mark.slow
def test_joints_and_pictures_share_a_clock(peer, robot):
    """The head turns: where a joint was at a time is where it says it was, but for a cycle."""
    robot.head.look(HeadAngles(-0.8, 0.0), 5.0)
    until(lambda: abs(peer.world("head")[0] + 0.8) < 0.01)
    robot.head.look(HeadAngles(0.8, 0.0), 1.0)
    begin_ns = time.monotonic_ns()
    assert robot.body.await_at(begin_ns + 900_000_000, 5.0)
    stamps = [begin_ns + n * 20_000_000 for n in range(15, 44)]
    yaws = [robot.body.at(stamp).angles_rad[0] for stamp in stamps]
    slope, at_begin = np.polyfit([(stamp - begin_ns) / 1e9 for stamp in stamps], yaws, 1)
    assert slope == pytest.approx(1.0, abs=0.1)
    # asked for at `begin`; the servo is 20 ms late and the world ticks at 10 ms
    late_s = (-0.8 - at_begin) / slope
    assert 0.0 < late_s < 0.06


@pytest.mark.slow
def test_three_ways_to_read(robot):
    frame = robot.camera.unseen(5.0)
    newer = robot.camera.unseen(5.0)
    assert newer.sequence > frame.sequence
    begin_ns = time.monotonic_ns()
    assert robot.camera.next(5.0).stamp_ns >= begin_ns
    assert robot.camera.latest(1.0) is not None
    assert robot.camera.latest(0.0) is None
    with pytest.raises(CameraTimeoutError):
        robot.camera.next(0.0)


def test_controls_are_locked_for_colour_and_put_back(peer, robot):
    assert [parameter(peer, number) for number in AUTO] == [0, 0, 0]
    assert parameter(peer, PARAMETERS["kCameraExposureID"]) == 310
    assert parameter(peer, PARAMETERS["kCameraGainID"]) == 52
    assert parameter(peer, PARAMETERS["kCameraFocusID"]) == 0
    assert robot.camera.locked.not_taken == ()
    robot.close()
    assert [parameter(peer, number) for number in AUTO] == [1, 1, 1]
    assert parameter(peer, PARAMETERS["kCameraFocusID"]) == 75
    assert peer.ask.call("ALVideoDevice", "getSubscribers") == []


@pytest.mark.slow
def test_values_that_are_given_are_held_and_what_did_not_take_is_told(peer):
    robot = peer.robot(controls={"exposure": 120, "gain": 40, "white_balance": 4000})
    try:
        robot.camera.unseen(20.0)
        assert parameter(peer, PARAMETERS["kCameraExposureID"]) == 120
        assert parameter(peer, PARAMETERS["kCameraGainID"]) == 40
        # the V6 has no such control
        assert robot.camera.locked.not_taken == ("kCameraWhiteBalanceID",)
    finally:
        robot.close()
    assert parameter(peer, PARAMETERS["kCameraExposureID"]) == 310


def test_stale_subscriptions_of_ours_are_cleaned_and_no_others(peer):
    video = "ALVideoDevice"
    stale = [peer.ask.call(video, "subscribeCamera", "naod_test", 0, 0, 9, 5) for _ in range(6)]
    other = peer.ask.call(video, "subscribeCamera", "naod_testing", 0, 0, 9, 5)
    assert peer.ask.call(video, "subscribeCamera", "naod_test", 0, 0, 9, 5) == ""
    assert "" not in stale
    robot = peer.robot(camera="bottom")
    robot.close()
    assert peer.ask.call(video, "getSubscribers") == [other]
    peer.ask.call(video, "unsubscribe", other)


def test_every_size_has_a_name():
    assert set(RESOLUTION_NAMES) == set(SIZES)


def test_camera_that_refuses_is_one_line(peer):
    peer.world("refuse", "ALVideoDevice.subscribeCamera", "camera\nis broken")
    with pytest.raises(HalError, match=r"subscribeCamera: .*camera") as caught:
        peer.robot()
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("form", ["list", pytest.param("tuple", marks=pytest.mark.slow)])
def test_pixels_that_come_as_a_text_are_the_same_pixels(peer, form):
    """A dynamic list of undeclared bytes: what qi makes of it is a text of their Python form."""
    peer.again("become", {"image": form})
    robot = peer.robot()
    try:
        frame = robot.camera.unseen(20.0)
        peer_says = peer.ask.call("ALVideoDevice", "getImageRemote", "naod_test_0")
        assert type(peer_says).__name__ == form
        assert isinstance(peer_says[6], str)
        # the same scene, but for its noise
        again = robot.camera.unseen(5.0)
        change = np.abs(frame.yuyv.astype(int) - again.yuyv.astype(int))
        assert 0.0 < change.mean() < 4.0
    finally:
        robot.close()
        peer.again("become", {"image": "raw"})


@pytest.mark.slow
def test_pictures_with_a_clock_of_their_own_are_aligned_by_their_arrival(peer):
    peer.again("become", {"picture_offset_s": -7.25})
    robot = peer.robot()
    try:
        errors = []
        for _ in range(12):
            frame = robot.camera.unseen(20.0)
            errors.append((frame.stamp_ns - peer.world("pictureTaken")) / 1e6)
        assert robot.camera.other_clock
        # the simulated picture is 55 to 120 ms on its way; half a period is taken for that
        assert np.median(np.abs(errors)) < 100.0
    finally:
        robot.close()
        peer.again("become", {"picture_offset_s": 0.0})

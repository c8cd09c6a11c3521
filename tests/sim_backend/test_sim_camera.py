"""The camera as its reader sees it: times, losses, noise, blur."""

from __future__ import annotations

import numpy as np
import pytest
from msgspec.structs import replace
from sim_world import CALM, Opened, run, until_standing, with_camera

from hal.errors import CameraTimeoutError
from hal.nao.joints import JOINT_INDEX
from hal.scenario import Scenario
from hal.types import HeadAngles, PlanarMotion
from hal.yuyv import yuyv_from_rgb
from sim_backend.colour import srgb_from_linear
from sim_backend.develop import developed

PERIOD_NS = 1e9 / 15


def test_frames_come_on_a_grid_with_their_latency(opened: Opened) -> None:
    robot = opened(with_camera(latency_s=0.08))
    frames = []
    for _ in range(5):
        frames.append(robot.camera.unseen(1.0))
        late = robot.clock.now_ns() - frames[-1].stamp_ns
        assert late == pytest.approx(80e6 + frames[-1].exposure_s * 0.5e9, abs=2)
    assert [frame.sequence for frame in frames] == [0, 1, 2, 3, 4]
    assert np.diff([frame.stamp_ns for frame in frames]) == pytest.approx(PERIOD_NS, abs=1)
    assert frames[0].yuyv.shape == (120, 160, 2)
    assert (frames[0].camera, frames[0].width, frames[0].height) == ("top", 160, 120)


def test_next_is_taken_from_now_on_and_unseen_may_be_older(opened: Opened) -> None:
    robot = opened()
    run(robot, 1.0)
    now = robot.clock.now_ns()
    old = robot.camera.unseen(1.0)
    assert old.stamp_ns < now
    assert robot.clock.now_ns() == now
    new = robot.camera.next(1.0)
    assert new.stamp_ns - new.exposure_s * 0.5e9 >= now
    assert robot.camera.unseen(1.0).sequence > new.sequence


def test_latest_is_the_newest_or_nothing(opened: Opened) -> None:
    robot = opened()
    assert robot.camera.latest(1.0) is None
    run(robot, 1.0)
    frame = robot.camera.latest(0.5)
    assert frame is not None
    again = robot.camera.latest(0.5)
    assert again is frame
    assert robot.camera.latest(0.01) is None
    newest = robot.camera.unseen(1.0)
    assert newest.sequence == frame.sequence + 1


def test_no_picture_in_time_is_said(opened: Opened) -> None:
    robot = opened()
    with pytest.raises(CameraTimeoutError, match="no picture"):
        robot.camera.next(0.05)
    assert robot.clock.now_ns() == 50_000_000
    lost = opened(with_camera(drop_rate=1.0))
    with pytest.raises(CameraTimeoutError):
        lost.camera.unseen(2.0)
    assert lost.camera.latest(2.0) is None


def test_frames_are_lost_at_the_given_rate(opened: Opened) -> None:
    robot = opened(with_camera(drop_rate=0.3))
    numbers = [robot.camera.unseen(5.0).sequence for _ in range(140)]
    assert len(numbers) / (numbers[-1] + 1) == pytest.approx(0.7, abs=0.09)


def test_noise_has_the_given_strength_and_changes_from_frame_to_frame(opened: Opened) -> None:
    robot, clean = opened(with_camera(noise_std=3.0)), opened(with_camera(noise_std=0.0))
    a, b = robot.camera.unseen(1.0), robot.camera.unseen(1.0)
    truth = clean.camera.unseen(1.0).yuyv.astype(float)
    assert (clean.camera.unseen(1.0).yuyv == truth).all()
    # away from the ends of the range, where noise is cut off
    free = (truth > 12) & (truth < 243)
    for frame in (a, b):
        error = (frame.yuyv - truth)[free]
        assert error.std() == pytest.approx(3.0, abs=0.15)
        # the walls have one level each, and the clean picture's is rounded
        assert error.mean() == pytest.approx(0.0, abs=0.3)
    shared = np.corrcoef((a.yuyv - truth)[free], (b.yuyv - truth)[free])[0, 1]
    assert abs(shared) < 0.05


def test_development_without_noise_is_the_layers_own_conversion() -> None:
    rng = np.random.default_rng(2)
    linear = rng.uniform(-0.1, 1.2, (48, 64, 3)).astype(np.float32)
    wanted = yuyv_from_rgb(srgb_from_linear(linear))
    difference = developed(linear, 0.0, rng).astype(int) - wanted
    assert np.abs(difference).max() <= 1
    assert (difference != 0).mean() < 0.08


def test_a_turning_head_blurs_and_a_still_one_does_not(opened: Opened) -> None:
    sharp, blurred = [], []
    for blur, pictures in ((False, sharp), (True, blurred)):
        robot = opened(with_camera(blur=blur, noise_std=0.0), size=(640, 480))
        pictures.append(robot.camera.next(1.0).yuyv)
        robot.head.look(HeadAngles(0.6, 0.0), 2.0)
        run(robot, 0.1)
        pictures.append(robot.camera.next(1.0).yuyv)
    assert (sharp[0] == blurred[0]).all()
    steps = [np.abs(np.diff(p[1][..., 0].astype(int), axis=1)).max() for p in (sharp, blurred)]
    assert steps[1] < 0.5 * steps[0]


def test_dim_light_takes_longer_and_stays_dimmer(opened: Opened) -> None:
    frames = {}
    for light in (1.0, 0.4):
        robot = opened(replace(CALM, scene=replace(CALM.scene, light=light)))
        frames[light] = robot.camera.next(1.0)
    assert frames[1.0].exposure_s == 0.010
    assert frames[0.4].exposure_s == pytest.approx(0.025)
    assert frames[0.4].yuyv[..., 0].mean() < frames[1.0].yuyv[..., 0].mean() - 30


def test_light_drifts_by_the_minute(opened: Opened) -> None:
    robot = opened(replace(CALM, scene=replace(CALM.scene, light_drift=-0.5)))
    first = robot.camera.next(1.0).yuyv[..., 0].mean()
    run(robot, 60.0)
    assert robot.camera.next(1.0).yuyv[..., 0].mean() < first - 25


def test_measured_angles_at_the_frames_time_explain_the_camera(opened: Opened) -> None:
    robot = opened()
    robot.head.look(HeadAngles(0.5, 0.2), 1.0)
    run(robot, 0.3)
    frame = robot.camera.next(1.0)
    state = robot.body.at(frame.stamp_ns)
    truth = robot._world.snapshot(frame.stamp_ns)
    assert state is not None
    assert state.stamp_ns == frame.stamp_ns
    yaw = JOINT_INDEX["HeadYaw"]
    assert state.angles_rad[yaw] == pytest.approx(truth.angles_rad[yaw], abs=0.003)
    assert 0.05 < state.angles_rad[yaw] < 0.5


def walked(opened: Opened, seed: int) -> list[object]:
    robot = opened(Scenario(), seed=seed)
    robot.head.look(HeadAngles(0.2, -0.1), 1.0)
    robot.walk.move_to(PlanarMotion(0.1, 0.03, 0.2), 30.0)
    seen: list[object] = []
    while robot.walk.status().moving:
        seen.append(robot.camera.unseen(1.0).yuyv.tobytes())
        seen.append(robot.body.latest().angles_rad.tobytes())
    truth = robot.truth()
    return [*seen, truth.base, truth.T_world_camera.tobytes()]


def test_the_same_seed_and_calls_give_the_same_bits(opened: Opened) -> None:
    assert walked(opened, 4) == walked(opened, 4)
    assert walked(opened, 4) != walked(opened, 5)


def test_looking_does_not_change_the_world(opened: Opened) -> None:
    watched, alone = opened(), opened()
    for robot in (watched, alone):
        robot.walk.move_to(PlanarMotion(0.1, 0.0, 0.1), 30.0)
    for _ in range(10):
        watched.camera.unseen(1.0)
        watched.room_view(32, 24)
    until_standing(watched)
    alone.advance(watched.clock.now_ns())
    assert alone.truth().base == watched.truth().base
    assert (alone.camera.latest(1.0).yuyv == watched.camera.latest(1.0).yuyv).all()

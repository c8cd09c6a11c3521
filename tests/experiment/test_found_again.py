"""An object that was lost is found at once when it comes into view, and expected where it is."""

from pathlib import Path

import numpy as np
import pytest

from hal.types import HeadAngles, PlanarMotion
from naod.config import DaemonConfig
from naod.experiment.approach_run import Experiment
from naod.experiment.opening import open_lockstep
from naod.experiment.person import face_corners
from naod.experiment.scenarios import demo_scenario
from naod.geometry.transforms import inverse, planar
from naod.loop.equipment import head_angles
from naod.loop.types import Stop

FRAMES_MAX = 2
AWAY = (HeadAngles(1.9, 0.0), HeadAngles(-1.7, 0.3))


@pytest.fixture(scope="module", params=["can", "board"])
def run(request):
    lockstep = open_lockstep(DaemonConfig(), demo_scenario(request.param, 1), Path(), 1, False)
    Experiment(lockstep, 1).demonstrate()
    yield lockstep
    lockstep.robot.close()


def in_view(run, tick):
    """Whether the whole object is inside the picture, by the truth and the body's angles then."""
    base = tick.truth.base
    T_base_camera = run.equipment.T_base_camera(tick.seen.body)
    T_camera_world = inverse(planar(base.x, base.y, base.yaw) @ T_base_camera)
    T = T_camera_world @ tick.truth.T_world_object
    points = (T[:3, :3] @ face_corners(run.equipment.shape).T).T + T[:3, 3]
    if points[:, 2].min() < 0.05:
        return False
    pixels = run.equipment.camera.project(points)
    size = (run.equipment.camera.width, run.equipment.camera.height)
    return bool((pixels > 0.0).all() and (pixels < np.array(size) - 1.0).all())


def lose(run, away):
    """Somebody turns the head away until the object counts as lost."""
    lost = run.state.lost_count
    for _ in range(60):
        run.tick()
        run.robot.head.look(away, 2.0)
        if run.state.lost_count > lost:
            return
    raise AssertionError("the object was not lost")


def is_it(run, tick):
    """Whether what is taken for the object lies where the object is."""
    if tick.sighting is None:
        return False
    middle = run.equipment.camera.project(object_in_camera(run, tick).reshape(1, 3))[0]
    return bool(np.linalg.norm(tick.sighting.blob.centre_px - middle) < 40.0)


@pytest.mark.parametrize("turned_back", [True, False], ids=["by somebody", "by its search"])
@pytest.mark.parametrize("away", AWAY)
def test_found_within_two_frames_of_coming_into_view(run, away, turned_back):
    back = head_angles(run.robot.body.latest())
    lose(run, away)
    assert run.state.search_from_ns is not None
    seen = 0
    for _ in range(60):
        tick = run.tick()
        if turned_back:
            run.robot.head.look(back, 2.0)
        if tick.seen.frame is None or not in_view(run, tick):
            continue
        seen += 1
        if is_it(run, tick):
            break
    assert 1 <= seen <= FRAMES_MAX
    assert run.state.search_from_ns is None
    assert run.state.target.seen_ns == tick.seen.frame.stamp_ns
    for _ in range(20):
        tick = run.tick()
    assert in_view(run, tick)
    assert is_it(run, tick)


def object_in_camera(run, tick):
    base = tick.truth.base
    T_world_camera = planar(base.x, base.y, base.yaw) @ run.equipment.T_base_camera(tick.seen.body)
    return (inverse(T_world_camera) @ tick.truth.T_world_object)[:3, 3]


def test_it_is_expected_where_it_is_while_the_robot_walks_and_turns_its_head(run, monkeypatch):
    """Odometry, kinematics and their stated uncertainty, picture by picture."""
    priors = []
    sight = run.equipment.sight

    def noting(model, frame, body, prior=None, motion=None):
        priors.append(prior)
        return sight(model, frame, body, prior, motion)

    run.ask(Stop())
    monkeypatch.setattr(run.equipment, "sight", noting)
    squares, sigmas = [], []
    for n in range(60):
        velocity = PlanarMotion(-0.04, 0.06, 0.1) if n < 40 else PlanarMotion(0.0, 0.0, 0.0)
        run.robot.walk.set_velocity(velocity, 1.0)
        if n in (10, 30):
            run.robot.head.look(HeadAngles(0.3, 0.0), 2.0)
        before = len(priors)
        tick = run.tick()
        if len(priors) == before or priors[-1] is None:
            continue
        gap = priors[-1].T_camera_object[:3, 3] - object_in_camera(run, tick)
        covariance = priors[-1].covariance[:3, :3]
        squares.append(gap @ np.linalg.solve(covariance, gap) / 3.0)
        sigmas.append(np.sqrt(np.linalg.eigvalsh(covariance)[-1]))
    assert len(squares) > 40
    assert np.mean(squares) < 2.0
    assert np.median(sigmas) < 0.05

"""Errors against the truth, and what a person marks in the picture."""

import math

import numpy as np
import pytest

from hal.simulation import Truth
from hal.types import PlanarMotion
from naod.errors import InputError
from naod.experiment.person import mark
from naod.experiment.scenarios import demo_scenario
from naod.experiment.summary import final_error, true_ego
from naod.geometry.camera import nominal_camera
from naod.geometry.transforms import planar, rot_z, transform
from naod.pose.objects import Cylinder, Rectangle


def object_pose(x, y, z, azimuth):
    """T_world_object: z axis along the azimuth, y up."""
    z_axis = np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
    up = np.array([0.0, 0.0, 1.0])
    return transform(np.column_stack((np.cross(up, z_axis), up, z_axis)), (x, y, z))


def truth(x, y, yaw, thing):
    R = rot_z(yaw) @ np.array([[0.0, 0, 1], [-1, 0, 0], [0, -1, 0]])
    return Truth(0, PlanarMotion(x, y, yaw), thing, transform(R, (x, y, 0.5)))


def test_a_board_counts_in_the_plane():
    thing = object_pose(1.6, 0, 0.5, math.pi)
    error = final_error("rectangle", truth(1.0, 0, 0, thing), truth(1.003, 0.004, 0.02, thing))
    assert error.position_m == pytest.approx(0.005)
    assert error.yaw_rad == pytest.approx(0.02)
    assert error.reached


def test_a_can_may_be_approached_from_any_side():
    """Turned about the can by 40 degrees the robot stands as well as where it was shown."""
    turn = planar(1.2, 0, 0) @ planar(0, 0, math.radians(40)) @ planar(-1.2, 0, 0)
    shown = truth(0.7, 0.05, 0.1, object_pose(1.2, 0, 0.45, math.pi))
    there = turn @ planar(0.7, 0.05, 0.1)
    end = truth(there[0, 3], there[1, 3], 0.1 + math.radians(40), object_pose(
        1.2, 0, 0.45, math.pi + math.radians(40)))  # fmt: skip
    error = final_error("cylinder", shown, end)
    assert error.position_m == pytest.approx(0.0, abs=1e-12)
    assert error.bearing_rad == pytest.approx(0.0, abs=1e-12)
    assert error.facing_rad == pytest.approx(0.0, abs=1e-12)


def test_a_can_too_near_or_aside_is_not_reached():
    thing = object_pose(1.2, 0, 0.45, math.pi)
    shown = truth(0.7, 0, 0, thing)
    near = final_error("cylinder", shown, truth(0.73, 0, 0, thing))
    assert near.distance_m == pytest.approx(-0.03)
    assert not near.reached
    turned = final_error("cylinder", shown, truth(0.7, 0, 0.05, thing))
    assert turned.yaw_rad == pytest.approx(0.05)
    assert not turned.reached


def test_true_ego_of_a_board_ahead():
    ego = true_ego(truth(1.0, 0, 0, object_pose(1.6, 0, 0.5, math.pi)))
    assert (ego.rho_m, ego.theta_rad, ego.z_m) == pytest.approx((0.6, 0.0, 0.5))
    assert abs(ego.phi_rad) == pytest.approx(math.pi)


@pytest.mark.parametrize("shape", [Cylinder(), Rectangle()])
def test_the_marked_region_lies_on_the_object(shape):
    seen = truth(0.6, 0.02, 0.05, object_pose(1.2, 0, 0.47, math.pi))
    camera = nominal_camera("v6", 640, 480)
    region = mark(seen, shape, camera)
    T = np.linalg.inv(seen.T_world_camera) @ seen.T_world_object
    half = (shape.radius_m if isinstance(shape, Cylinder) else shape.width_m / 2) * 598 / 0.6
    centre = camera.project(T[:3, 3].reshape(1, 3))[0]
    assert abs(region.x + region.width / 2 - centre[0]) < 4
    assert 0.4 * half < region.width / 2 < half


def test_what_is_behind_the_robot_cannot_be_marked():
    seen = truth(2.0, 0, 0, object_pose(1.2, 0, 0.47, math.pi))
    with pytest.raises(InputError, match="cannot be seen"):
        mark(seen, Rectangle(), nominal_camera("v6", 640, 480))


@pytest.mark.parametrize("name", ["can", "board"])
def test_demos_start_elsewhere(name):
    starts = set()
    for seed in range(10):
        scenario = demo_scenario(name, seed)
        start, shown = scenario.robot.start, scenario.goal.demonstrate_at
        assert math.hypot(start[0] - shown[0], start[1] - shown[1]) > 0.3
        starts.add(start)
    assert len(starts) == 10
    assert demo_scenario(name, 3) == demo_scenario(name, 3)

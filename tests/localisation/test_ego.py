"""Ego-cylinder coordinates and how errors of the pose enter them."""

import cv2
import numpy as np
import pytest

from naod.geometry.transforms import transform
from naod.localisation.ego import cartesian_jacobian, ego_pose
from naod.localisation.looks import Look, combine


def random_pose(rng):
    R, _ = cv2.Rodrigues(rng.normal(size=3))
    return transform(R, tuple(rng.uniform(0.2, 1.0, size=3)))


def as_vector(T):
    ego = ego_pose(T)
    return np.array([ego.x_m, ego.y_m, ego.z_m, ego.phi_rad])


def test_round_trip_through_cylinder_coordinates():
    rng = np.random.default_rng(0)
    for _ in range(50):
        T = random_pose(rng)
        ego = ego_pose(T)
        assert (ego.x_m, ego.y_m, ego.z_m) == pytest.approx(tuple(T[:3, 3]))
        assert np.tan(ego.phi_rad) == pytest.approx(T[1, 2] / T[0, 2])


def test_jacobian_equals_finite_differences():
    rng = np.random.default_rng(1)
    step = 1e-6
    for _ in range(20):
        T_base_camera, T_camera_object = random_pose(rng), random_pose(rng)
        if np.hypot(*(T_base_camera @ T_camera_object)[:2, 2]) < 0.2:
            continue
        J = cartesian_jacobian(T_base_camera @ T_camera_object, T_base_camera)
        for column in range(6):
            moved = []
            for sign in (1.0, -1.0):
                delta = np.zeros(6)
                delta[column] = sign * step
                changed = T_camera_object.copy()
                changed[:3, 3] += delta[:3]
                changed[:3, :3] = cv2.Rodrigues(delta[3:])[0] @ T_camera_object[:3, :3]
                moved.append(as_vector(T_base_camera @ changed))
            assert J[:, column] == pytest.approx((moved[0] - moved[1]) / (2 * step), abs=1e-5)


def look(x, y, phi, sigma, stamp=0):
    ego = ego_pose(transform(np.eye(3), (x, y, 0.4)))
    ego = type(ego)(ego.rho_m, ego.theta_rad, ego.z_m, phi)
    return Look(stamp, ego, np.eye(4) * sigma**2)


def test_looks_weigh_by_their_information():
    combined = combine([look(1.0, 0.0, 3.1, 0.01), look(1.01, 0.0, 3.2, 0.02)])
    assert combined.ego.x_m == pytest.approx((1.0 * 4 + 1.01) / 5)
    assert combined.ego.phi_rad == pytest.approx((3.1 * 4 + 3.2) / 5 - 0)
    assert combined.covariance[0, 0] == pytest.approx(1 / (1e4 + 2.5e3))


def test_azimuths_are_averaged_across_the_turn():
    combined = combine([look(1.0, 0.0, 3.13, 0.01), look(1.0, 0.0, -3.13, 0.01)])
    assert abs(combined.ego.phi_rad) == pytest.approx(np.pi)


def test_a_look_that_disagrees_is_left_out():
    looks = [look(1.0, 0.0, 3.0, 0.005), look(1.001, 0.0, 3.0, 0.005), look(1.3, 0.2, 3.0, 0.005)]
    assert combine(looks).ego.x_m == pytest.approx(1.0005, abs=1e-6)


def test_no_looks_is_an_error():
    with pytest.raises(ValueError, match="no looks"):
        combine([])

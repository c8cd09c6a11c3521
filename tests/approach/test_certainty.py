"""Doubt about the way to a goal, against finite differences; what is walked all the same."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hal.types import PlanarMotion
from naod.approach.certainty import (
    Doubt,
    Tolerance,
    displacement_covariance,
    doubt_of,
    is_known,
    known_part,
)
from naod.approach.displacement import displacement, goal_from
from naod.localisation.ego import from_cartesian
from naod.localisation.looks import Look

NEAR = Tolerance(0.01, math.radians(1.0))


def as_vector(point, goal):
    way = displacement(from_cartesian(*point), goal)
    return np.array([way.x, way.y, way.yaw])


@pytest.mark.parametrize("kind", ["cylinder", "rectangle"])
def test_covariance_of_the_way_is_that_of_finite_differences(kind):
    rng = np.random.default_rng(4)
    for _ in range(20):
        goal = goal_from(kind, from_cartesian(0.5, 0.1 * rng.normal(), 0.4, 3.0), 0.001)
        point = np.array([1.0, 0.0, 0.4, 2.8]) + 0.2 * rng.normal(size=4)
        A = rng.normal(size=(4, 4)) * 1e-3
        own, shared = A @ A.T, np.diag([1e-6, 4e-6, 1e-6, 9e-6])
        J = np.zeros((3, 4))
        for column in range(4):
            delta = np.zeros(4)
            delta[column] = 1e-6
            J[:, column] = as_vector(point + delta, goal) - as_vector(point - delta, goal)
        J /= 2e-6
        look = Look(0, from_cartesian(*point), own, shared)
        assert displacement_covariance(look, goal) == pytest.approx(
            J @ (own + shared) @ J.T, abs=1e-10
        )


def test_far_away_the_way_s_own_direction_counts():
    goal = goal_from("rectangle", from_cartesian(0.5, 0.0, 0.4, math.pi), 0.001)
    wide = np.diag([1e-6, 1e-4, 1e-6, 1e-12])
    far = doubt_of(Look(0, from_cartesian(1.0, 0.0, 0.4, math.pi), wide), goal, NEAR)
    assert far.sigma_m == pytest.approx(1e-3, rel=1e-3)
    there = doubt_of(Look(0, from_cartesian(0.505, 0.0, 0.4, math.pi), wide), goal, NEAR)
    assert there.sigma_m == pytest.approx(1e-2, rel=1e-3)


@pytest.mark.parametrize(
    ("step", "doubt", "known"),
    [
        (PlanarMotion(0.2, 0.0, 0.3), Doubt(0.05, 0.1), True),
        (PlanarMotion(0.03, 0.0, 0.3), Doubt(0.05, 0.1), False),
        (PlanarMotion(0.2, 0.0, 0.05), Doubt(0.05, 0.1), False),
        # parts that are near enough already need only be known to the tolerance
        (PlanarMotion(0.2, 0.0, 0.001), Doubt(0.05, 0.01), True),
        (PlanarMotion(0.001, 0.0, 0.3), Doubt(0.009, 0.01), True),
        (PlanarMotion(0.001, 0.0, 0.3), Doubt(0.011, 0.01), False),
        (PlanarMotion(0.001, 0.0, 0.0), Doubt(0.001, 0.02), False),
    ],
)
def test_a_step_is_known_that_is_longer_than_its_doubt(step, doubt, known):
    assert is_known(step, doubt, NEAR) is known


SIZES = st.floats(-1.0, 1.0)
SIGMAS = st.floats(1e-6, 1.0)


@settings(deadline=None)
@given(SIZES, SIZES, SIZES, SIGMAS, SIGMAS)
def test_the_known_part_keeps_its_direction_and_is_never_longer(x, y, yaw, sigma_m, sigma_rad):
    step = PlanarMotion(x, y, yaw)
    part = known_part(step, Doubt(sigma_m, sigma_rad))
    length, walked = math.hypot(x, y), math.hypot(part.x, part.y)
    assert walked <= length + 1e-12
    assert part.x * y == pytest.approx(part.y * x, abs=1e-12)
    assert part.x * x >= 0.0
    assert part.yaw * yaw >= 0.0
    assert abs(part.yaw) <= abs(yaw)
    surer = known_part(step, Doubt(0.5 * sigma_m, 0.5 * sigma_rad))
    assert math.hypot(surer.x, surer.y) >= walked - 1e-12


def test_the_known_part_is_the_mean_of_what_was_measured_so():
    """Ways drawn as long as the one measured, measured with an error: their mean, given it."""
    rng = np.random.default_rng(5)
    ways = 0.02 * rng.normal(size=400_000)
    measured = ways + 0.03 * rng.normal(size=ways.size)
    alike = np.abs(measured - 0.02) < 0.001
    mean = float(ways[alike].mean())
    part = known_part(PlanarMotion(0.02, 0.0, 0.0), Doubt(0.03, 0.1))
    assert part.x == pytest.approx(mean, abs=5e-4)
    assert known_part(PlanarMotion(0.0, 0.0, 0.0), Doubt(0.03, 0.1)) == PlanarMotion(0, 0, 0)

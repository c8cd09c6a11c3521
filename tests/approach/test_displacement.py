"""From ego pose and goal to a displacement of the base."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hal.types import PlanarMotion
from naod.approach.displacement import displacement, goal_from, saturate
from naod.approach.goal import goal_path, load_goals, save_goal
from naod.errors import InputError
from naod.geometry.transforms import inverse, planar, wrap
from naod.localisation.ego import ego_pose

POSES = st.tuples(st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-3.0, 3.0))


def seen_from(base, thing):
    """The ego pose of an object at (x, y, azimuth) from a base at (x, y, yaw)."""
    T = inverse(planar(*base)) @ planar(*thing)
    # the object's z axis is its face's normal: x of the planar pose
    T_base_object = T.copy()
    T_base_object[:3, 2] = T[:3, 0]
    T_base_object[2, 3] = 0.4
    return ego_pose(T_base_object)


@settings(deadline=None)
@given(base=POSES, goal=POSES)
def test_a_board_leads_exactly_to_where_it_was_shown(base, goal):
    thing = (2.5, 0.3, 2.9)
    shown = goal_from("rectangle", seen_from(goal, thing), 0.001)
    step = displacement(seen_from(base, thing), shown)
    reached = planar(*base) @ planar(step.x, step.y, step.yaw)
    assert reached == pytest.approx(planar(*goal), abs=1e-9)


@settings(deadline=None)
@given(base=POSES, goal=POSES)
def test_a_can_leads_to_the_distance_and_bearing_shown(base, goal):
    thing = (2.5, 0.3, 0.0)
    shown = goal_from("cylinder", seen_from(goal, thing), 0.001)
    step = displacement(seen_from(base, thing), shown)
    reached = planar(*base) @ planar(step.x, step.y, step.yaw)
    at_goal = inverse(reached) @ np.array([2.5, 0.3, 0.0, 1.0])
    assert math.hypot(at_goal[0], at_goal[1]) == pytest.approx(shown.rho_m)
    assert wrap(math.atan2(at_goal[1], at_goal[0]) - shown.theta_rad) == pytest.approx(0, abs=1e-9)


@given(x=st.floats(-3, 3), y=st.floats(-3, 3), yaw=st.floats(-3.1, 3.1))
def test_saturation_keeps_the_direction(x, y, yaw):
    step = saturate(PlanarMotion(x, y, yaw), 0.25, 0.5)
    assert math.hypot(step.x, step.y) <= 0.25 + 1e-12
    assert abs(step.yaw) <= 0.5
    assert step.x * y - step.y * x == pytest.approx(0.0, abs=1e-12)
    assert step.x * x + step.y * y >= 0.0


def test_goals_survive_on_disk(tmp_path):
    goal = goal_from("rectangle", seen_from((0, 0, 0), (1.0, 0.2, 3.0)), 0.002)
    save_goal(tmp_path, "desk", goal)
    assert load_goals(tmp_path) == {"desk": goal}


@pytest.mark.parametrize("name", ["", "../x", "a b", "x" * 33])
def test_a_goal_cannot_leave_its_folder(tmp_path, name):
    with pytest.raises(InputError, match="goal name"):
        goal_path(tmp_path, name)

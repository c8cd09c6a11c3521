"""The body in pybullet against the published figures."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import get_args

import numpy as np
import pytest

from hal.nao.feet import SOLE_IN_ANKLE_M
from hal.nao.joints import JOINTS, LOWER_RAD, UPPER_RAD
from hal.nao.links import links
from hal.nao.postures import posture
from hal.types import NaoVersion
from sim_backend.body import Body, camera_in_head
from sim_backend.figures import links_in_torso, standing_torso, total_mass_kg
from sim_backend.poses import inverse, moved, planar


@pytest.fixture(params=get_args(NaoVersion))
def body(request: pytest.FixtureRequest) -> Iterator[Body]:
    body = Body(request.param)
    yield body
    body.close()


def test_top_camera_from_the_left_sole_is_where_the_facts_say(body: Body) -> None:
    frames = body.link_frames(standing_torso(), posture("StandInit"))
    T_sole_camera = inverse(frames["l_ankle"] @ moved(*SOLE_IN_ANKLE_M)) @ frames["Head"]
    T_sole_camera = T_sole_camera @ camera_in_head("top")
    assert T_sole_camera[:3, 3] == pytest.approx((0.08688, -0.05, 0.50361), abs=1e-4)
    forward = T_sole_camera[:3, 2]
    assert math.asin(-forward[2]) == pytest.approx(0.12094, abs=1e-4)
    assert T_sole_camera[:3, 0] == pytest.approx((0.0, -1.0, 0.0), abs=1e-6)


def test_bottom_camera_looks_down_by_its_mount(body: Body) -> None:
    frames = body.link_frames(standing_torso(), posture("StandInit"))
    forward = (frames["Head"] @ camera_in_head("bottom"))[:3, 2]
    assert math.asin(-forward[2]) == pytest.approx(0.1 + 0.692896, abs=1e-5)


def test_all_links_agree_with_the_chain_of_joints_in_any_posture(body: Body) -> None:
    rng = np.random.default_rng(3)
    for _ in range(10):
        angles = rng.uniform(LOWER_RAD, UPPER_RAD)
        T = planar((0.3, -0.4, 1.1)) @ standing_torso()
        frames = body.link_frames(T, angles)
        for name, T_torso_link in links_in_torso(angles).items():
            assert frames[name] == pytest.approx(T @ T_torso_link, abs=2e-6), name


def test_mass_is_that_of_the_published_links() -> None:
    for version in get_args(NaoVersion):
        body = Body(version)
        # the two fingers weigh a milligram each, for want of a figure
        assert body.total_mass_kg() == pytest.approx(total_mass_kg(version), abs=1e-5)
        assert len(links(version)) + 2 == len(JOINTS) + 1
        body.close()


def test_a_body_may_be_closed_twice() -> None:
    body = Body("v6")
    body.close()
    body.close()

"""Forward kinematics against published figures and against a chain multiplied by hand."""

import math

import numpy as np
import pytest

from hal.nao.feet import SOLE_IN_ANKLE_M
from hal.nao.joints import JOINT_INDEX, JOINTS, LOWER_RAD, UPPER_RAD
from hal.nao.links import links
from hal.nao.postures import posture
from naod.geometry.transforms import inverse, transform
from naod.localisation.body_model import BodyModel, T_head_camera


def rotation(axis, angle):
    """Rodrigues' formula."""
    x = np.array(axis) / np.linalg.norm(axis)
    K = np.array([[0, -x[2], x[1]], [x[2], 0, -x[0]], [-x[1], x[0], 0]])
    return np.eye(3) + math.sin(angle) * K + (1 - math.cos(angle)) * K @ K


def chain(link, angles):
    """T_torso_link, joint by joint up the parents."""
    T = np.eye(4)
    while link != "torso":
        joint = next(j for j in JOINTS if j.child == link)
        angle = angles[JOINT_INDEX[joint.name]]
        T = transform(rotation(joint.axis, angle), joint.origin_m) @ T
        link = joint.parent
    return T


@pytest.mark.parametrize("version", ["v5", "v6"])
def test_top_camera_at_stand_init_is_where_it_is_published(version):
    frames = BodyModel(version, "top").frames(posture("StandInit"))
    T = inverse(frames.T_torso_lsole) @ frames.T_torso_camera
    assert T[:3, 3] == pytest.approx((0.08688, -0.05000, 0.50361), abs=1e-4)
    assert math.asin(-T[2, 2]) == pytest.approx(0.12094, abs=1e-5)


@pytest.mark.parametrize("camera", ["top", "bottom"])
def test_frames_equal_the_product_along_the_chain(camera):
    rng = np.random.default_rng(1)
    model = BodyModel("v6", camera)
    for _ in range(20):
        angles = rng.uniform(LOWER_RAD, UPPER_RAD)
        frames = model.frames(angles)
        T_camera = chain("Head", angles) @ T_head_camera(camera, (0, 0, 0))
        T_sole = chain("r_ankle", angles) @ transform(np.eye(3), SOLE_IN_ANKLE_M)
        assert frames.T_torso_camera == pytest.approx(T_camera, abs=1e-9)
        assert frames.T_torso_rsole == pytest.approx(T_sole, abs=1e-9)


@pytest.mark.parametrize(("version", "mass"), [("v5", 5.30535), ("v6", 5.35975)])
def test_masses_sum_to_the_published_total(version, mass):
    assert sum(link.mass_kg for link in links(version).values()) == pytest.approx(mass, abs=1e-9)


def test_centre_of_mass_at_the_zero_posture():
    """`walk_facts.yaml`: the centre of mass is 0.0355 m below the torso's origin."""
    angles = np.zeros(len(JOINTS))
    assert BodyModel("v5").centre_of_mass(angles)[2] == pytest.approx(-0.0355, abs=1e-4)


def test_correction_turns_the_camera_about_its_own_axes():
    plain = T_head_camera("top", (0.0, 0.0, 0.0))
    turned = T_head_camera("top", (0.0, math.radians(5), 0.0))
    R = plain[:3, :3].T @ turned[:3, :3]
    # 5 degrees further down is a rotation of -5 degrees about the optical frame's x
    assert pytest.approx(rotation((1, 0, 0), -math.radians(5)), abs=1e-12) == R
    assert turned[:3, 3] == pytest.approx(plain[:3, 3])

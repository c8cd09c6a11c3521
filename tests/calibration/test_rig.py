"""The chain from the torso to a pixel against the kinematic model, and its derivatives."""

import cv2
import numpy as np
import pytest
from synthetic import ASKEW, HEADS, LENS, SHAPE, rig, truth

from hal.nao.joints import JOINT_INDEX
from naod.calibration.lens import project
from naod.calibration.rig import HEADS as FIRST_HEAD
from naod.calibration.rig import columns_of
from naod.calibration.view import corners_in_object
from naod.localisation.body_model import BodyModel

OTHERS = np.array([0.03, 0.004, -0.003, 0.01])


@pytest.mark.parametrize("camera", ["top", "bottom"])
def test_the_camera_is_where_the_kinematics_say(camera):
    body = BodyModel("v6", camera, tuple(ASKEW))
    angles = np.zeros(26)
    for head in HEADS[:5]:
        angles[JOINT_INDEX["HeadYaw"]] = head.yaw_rad
        angles[JOINT_INDEX["HeadPitch"]] = head.pitch_rad
        ours = rig(camera).T_torso_camera(head, ASKEW)
        assert np.allclose(ours, body.frames(angles).T_torso_camera, atol=1e-12)


def test_the_lens_is_opencvs():
    rng = np.random.default_rng(0)
    points = rng.uniform((-0.4, -0.3, 0.8), (0.4, 0.3, 2.0), (50, 3))
    lens = np.array([*LENS[:4], -0.06])
    K = np.array([[lens[0], 0, lens[2]], [0, lens[1], lens[3]], [0, 0, 1.0]])
    k2, p1, p2, k3 = OTHERS
    theirs, _ = cv2.projectPoints(
        points, np.zeros(3), np.zeros(3), K, np.array([lens[4], k2, p1, p2, k3])
    )
    assert np.allclose(project(points, lens, OTHERS)[0], theirs.reshape(-1, 2), atol=1e-9)


def test_derivatives_are_differences():
    rng = np.random.default_rng(1)
    model = rig("top", OTHERS)
    at = truth(lens=np.array([*LENS[:4], -0.05]), heads=HEADS[:3])
    points = corners_in_object(SHAPE) + rng.normal(0.0, 0.01, (4, 3))
    for number in (0, 2):
        pixels, J = model.pixels(at, HEADS[number], number, points)
        for column, among_all in enumerate(columns_of(number)):
            step = np.zeros(FIRST_HEAD + 6)
            step[among_all] = 1e-6
            moved = [
                model.pixels(at.moved(sign * step), HEADS[number], number, points)[0]
                for sign in (1.0, -1.0)
            ]
            assert np.allclose(
                J[:, :, column], (moved[0] - moved[1]) / 2e-6, rtol=1e-5, atol=1e-4
            ), column
        assert pixels.shape == (4, 2)

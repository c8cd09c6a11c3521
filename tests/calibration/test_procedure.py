"""The whole procedure on rendered, noisy pictures of a robot whose camera sits askew."""

import numpy as np
import pytest

pytest.importorskip("sim_backend.backend")

from rehearsal import ERROR_DEG, config, learnt, opened, settled

from naod.calibration.procedure import Wanted, calibrate
from naod.calibration.warm_up import warm_up


@pytest.fixture
def robot():
    robot = opened()
    settled(robot)
    yield robot
    robot.close()


def test_a_five_degree_error_is_found_to_a_tenth(robot):
    model, shape = learnt(robot)
    told = []
    found = calibrate(robot, config(), model, shape, Wanted(), told.append)
    error = np.abs(np.array(found.correction_deg) - ERROR_DEG)
    assert error.max() < 0.1
    assert (error < 4.0 * np.array(found.sigma_deg)).all()
    assert found.views >= 8
    assert found.camera.fx == pytest.approx(598.0, abs=4.0 * found.lens_sigma[0])


@pytest.mark.parametrize(("width", "height"), [(640, 480), (320, 240)])
def test_the_painted_rectangle_is_found(width, height):
    assert warm_up(config(width=width, height=height))

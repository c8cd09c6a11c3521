"""Rendered pictures of a can from a camera that moves: error and stated sigma against exposure."""

import math
from pathlib import Path

import cv2
import numpy as np
import pytest

from hal.backends import OpenOptions, open_studio
from hal.scenario import Scenario
from naod.config import SegmentationConfig
from naod.geometry.camera import nominal_camera
from naod.geometry.transforms import inverse, transform
from naod.localisation.camera_motion import CameraMotion, motion_px
from naod.localisation.placement import placed
from naod.perception.blob import find_blob
from naod.perception.colour_model import Region
from naod.perception.learning import learn_model
from naod.perception.segmenter import Segmenter
from naod.pose.locate import locate
from naod.pose.objects import Cylinder

CAMERA = nominal_camera("v6", 640, 480)
EXPOSURES_S = (0.0, 0.010, 0.020, 0.033)
VIEWS = 16
TURN_RAD_S = (0.5, 1.0, 0.3)
"""At most, about each of the camera's axes: a head that follows, on a robot that walks."""

SPEED_M_S = 0.1


@pytest.fixture(scope="module")
def studio():
    section = {"scenario": Scenario(), "scenario_folder": Path(), "seed": 0}
    return open_studio("sim", OpenOptions(section=section))


def eye(studio, way_m, azimuth, aside):
    """T_world_camera before the object, turned aside by a rotation vector."""
    T = studio.T_world_object
    place = T[:3, 3] + way_m * (math.cos(azimuth) * T[:3, 2] + math.sin(azimuth) * T[:3, 0])
    place[2] = 0.5
    z = (T[:3, 3] - place) / np.linalg.norm(T[:3, 3] - place)
    x = np.cross(z, (0.0, 0.0, 1.0))
    x /= np.linalg.norm(x)
    R = np.column_stack([x, np.cross(z, x), z])
    return transform(R @ cv2.Rodrigues(np.array(aside))[0], place)


def views(studio):
    rng = np.random.default_rng(1)
    for n in range(VIEWS):
        aside = rng.uniform(-0.1, 0.1, 3) * (1.0, 1.0, 0.3)
        T = eye(studio, rng.uniform(0.45, 1.4), rng.uniform(-0.4, 0.4), aside)
        turn = rng.uniform(-1.0, 1.0, 3) * TURN_RAD_S
        yield n, T, CameraMotion(rng.uniform(-SPEED_M_S, SPEED_M_S, 3), turn)


def moved(T, motion, time_s):
    """The camera a time later."""
    R = T[:3, :3] @ cv2.Rodrigues(motion.turn_rad_s * time_s)[0]
    return transform(R, T[:3, 3] + T[:3, :3] @ motion.velocity_m_s * time_s)


@pytest.fixture(scope="module")
def segmenter(studio):
    T = eye(studio, 0.7, 0.0, (0.0, 0.0, 0.0))
    rows, columns = np.nonzero(studio.mask_at(T))
    x, y, width, height = columns.min(), rows.min(), np.ptp(columns), np.ptp(rows)
    inside = Region(int(x + 0.2 * width), int(y + 0.2 * height), int(0.6 * width),
                    int(0.6 * height))  # fmt: skip
    model = learn_model([studio.frame_at(T, noise_seed=n) for n in range(2)], inside)
    return Segmenter(model, SegmentationConfig(), (CAMERA.width, CAMERA.height))


@pytest.fixture(scope="module")
def measured(studio, segmenter):
    """For each exposure: relative error, relative sigma, squared error over variance, and blur."""
    rows = {exposure_s: [] for exposure_s in EXPOSURES_S}
    for n, T, motion in views(studio):
        true = (inverse(T) @ studio.T_world_object)[:3, 3]
        for exposure_s in EXPOSURES_S:
            poses = [moved(T, motion, share * exposure_s) for share in np.linspace(-0.5, 0.5, 9)]
            yuyv = studio.frame_at(T, np.stack(poses) if exposure_s else None, n)
            px = motion_px(motion, true, CAMERA, exposure_s)
            ends = [(inverse(P) @ studio.T_world_object)[:3, 3] for P in (poses[0], poses[-1])]
            true_px = np.subtract(*CAMERA.project(np.array(ends))[::-1])
            blob = find_blob(segmenter.segment(yuyv), 12)
            pose = locate(yuyv, blob, Cylinder(), CAMERA) if blob else None
            gone = np.full(4, math.nan)
            if pose is not None:
                placement = placed(0, pose, T, None, math.hypot(*px))
                gap = (placement.T_base_object - studio.T_world_object)[:3, 3]
                total = (placement.own + placement.shared)[:3, :3]
                sigma = math.sqrt(np.linalg.eigvalsh(total)[-1])
                square = gap @ np.linalg.solve(total, gap) / 3.0
                gone = np.array([np.linalg.norm(gap), sigma, square, 0.0])
                gone[:2] /= np.linalg.norm(true)
            rows[exposure_s].append([*gone[:3], *px, *true_px])
    return {exposure_s: np.array(row) for exposure_s, row in rows.items()}


def test_predicted_blur_is_the_motion_through_the_picture(measured):
    for row in measured.values():
        assert row[:, 3:5] == pytest.approx(row[:, 5:7], abs=0.01)
    assert np.hypot(*measured[0.033][:, 3:5].T).max() > 15.0


def test_the_object_is_found_however_blurred(measured):
    for row in measured.values():
        assert np.isfinite(row).all()


def test_error_grows_gracefully_with_the_exposure(measured):
    """Half a thousandth sharp; a hundredth at the longest, where the can moves by its own half."""
    errors = {exposure_s: np.median(row[:, 0]) for exposure_s, row in measured.items()}
    assert errors[0.0] < 0.002
    assert errors[0.010] < 0.003
    assert errors[0.020] < 0.005
    assert errors[0.033] < 0.010


def test_sigma_grows_with_it_and_covers_the_error(measured):
    sigmas = [np.median(measured[exposure_s][:, 1]) for exposure_s in EXPOSURES_S]
    assert sigmas == sorted(sigmas)
    assert sigmas[-1] > 2.0 * sigmas[0]
    for row in measured.values():
        assert row[:, 2].mean() < 2.0


@pytest.mark.parametrize("side", ["top", "bottom"])
def test_a_can_cut_off_above_or_below_is_placed_as_well(studio, segmenter, side):
    """Up to half of it: such looks are taken."""
    for n, (way_m, cut) in enumerate([(0.35, 0.2), (0.5, 0.3), (0.8, 0.4), (0.6, 0.5)]):
        reach = 0.0575 / way_m
        pitch = math.atan(240.0 / CAMERA.fy) - reach + 2.0 * reach * cut
        T = eye(studio, way_m, 0.1, (-pitch if side == "top" else pitch, 0.0, 0.0))
        yuyv = studio.frame_at(T, None, n)
        pose = locate(yuyv, find_blob(segmenter.segment(yuyv), 12), Cylinder(), CAMERA)
        assert pose.clipped == (side,)
        gap = (pose.T_camera_object - inverse(T) @ studio.T_world_object)[:3, 3]
        assert np.linalg.norm(gap) < 0.005 * way_m
        assert gap @ np.linalg.solve(pose.covariance[:3, :3], gap) / 3.0 < 5.0

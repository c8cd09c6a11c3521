"""The exact estimators on the simulation's own pictures: shading, sensor noise, blur, a table."""

import numpy as np
import pytest

from hal.scenario import Scenario, ThingSection
from hal.yuyv import yuyv_from_rgb
from naod.config import SegmentationConfig
from naod.geometry.camera import nominal_camera
from naod.geometry.transforms import inverse, rot_x, rot_y, transform
from naod.perception.blob import find_blob
from naod.perception.colour_model import Region, learn
from naod.perception.segmenter import Segmenter
from naod.pose.locate import locate
from naod.pose.objects import Cylinder, Rectangle

studio = pytest.importorskip("sim_backend.studio")
CAMERA = nominal_camera("v6", 640, 480)
SHAPES = {
    "cylinder": Cylinder(radius_m=0.033, height_m=0.115),
    "rectangle": Rectangle(width_m=0.30, height_m=0.20),
}
MARKED_HALF = {"cylinder": (14, 28), "rectangle": (60, 40)}


def viewpoint(target, azimuth, elevation, distance, aside=(0.0, 0.0)):
    """T_world_camera of a camera that looks past the target by `aside` radians."""
    way = np.array(
        [
            np.cos(elevation) * np.cos(azimuth),
            np.cos(elevation) * np.sin(azimuth),
            np.sin(elevation),
        ]
    )
    right = np.cross(-way, (0.0, 0.0, 1.0))
    right /= np.linalg.norm(right)
    R = np.column_stack([right, np.cross(-way, right), -way])
    return transform(R @ rot_x(aside[0]) @ rot_y(aside[1]), target + distance * way)


class Scene:
    """A studio, a colour model learnt in it, and the truth."""

    def __init__(self, kind):
        self.shape = SHAPES[kind]
        self.studio = studio.Studio(Scenario(object=ThingSection(kind=kind)))
        self.target = self.studio.T_world_object[:3, 3]
        facing = self.studio.T_world_object[:3, 2]
        self.front = np.arctan2(facing[1], facing[0])
        T = viewpoint(self.target, self.front, 0.1, 0.7)
        x, y = CAMERA.project((inverse(T) @ np.append(self.target, 1.0))[None, :3])[0]
        w, h = MARKED_HALF[kind]
        frames = [self.studio.frame_at(T, noise_seed=k + 1) for k in range(3)]
        model = learn(frames, Region(int(x) - w, int(y) - h, 2 * w, 2 * h))
        self.segmenter = Segmenter(model, SegmentationConfig(), (640, 480))

    def error(self, T_world_camera, seed, exposure=None):
        """Gap of position (3,) and the pose found."""
        yuyv = self.studio.frame_at(T_world_camera, exposure, noise_seed=seed)
        pose = locate(yuyv, find_blob(self.segmenter.segment(yuyv)), self.shape, CAMERA)
        truth = inverse(T_world_camera) @ np.append(self.target, 1.0)
        return pose.T_camera_object[:3, 3] - truth[:3], pose


@pytest.fixture(scope="module", params=["cylinder", "rectangle"])
def scene(request):
    return Scene(request.param)


def test_median_error_below_half_a_percent_from_near_to_far(scene):
    rng = np.random.default_rng(21)
    near = 0.3 if isinstance(scene.shape, Cylinder) else 0.5
    errors, normalised = [], []
    for distance in (near, 0.8, 1.3, 2.0):
        for k in range(3):
            T = viewpoint(
                scene.target,
                scene.front + rng.uniform(-0.5, 0.5),
                rng.uniform(0.0, 0.6),
                distance,
                rng.uniform(-0.08, 0.08, 2),
            )
            gap, pose = scene.error(T, 100 + k)
            errors.append(np.linalg.norm(gap) / distance)
            normalised.append(gap @ np.linalg.solve(pose.covariance[:3, :3], gap))
    assert np.median(errors) < 0.003
    assert max(errors) < 0.02
    assert np.mean(np.array(normalised) < 7.81) > 0.9


def test_blur_of_a_turning_head_hardly_moves_it(scene):
    rng = np.random.default_rng(22)
    errors = []
    for k in range(4):
        T = viewpoint(scene.target, scene.front + rng.uniform(-0.4, 0.4), 0.25, 0.9)
        # ten pixels of blur
        turn = rng.normal(size=2)
        turn *= 0.017 / np.linalg.norm(turn)
        parts = np.linspace(-0.5, 0.5, 5)
        exposure = np.stack(
            [T @ transform(rot_x(p * turn[0]) @ rot_y(p * turn[1]), (0, 0, 0)) for p in parts]
        )
        gap, _ = scene.error(T, 200 + k, exposure)
        errors.append(np.linalg.norm(gap) / 0.9)
    assert np.median(errors) < 0.01
    assert max(errors) < 0.03


def test_pictures_of_the_studio_are_as_wide_as_its_masks(scene):
    T = viewpoint(scene.target, scene.front, 0.2, 0.9)
    rgb = scene.studio.rgb_at(T)
    found = scene.segmenter.segment(yuyv_from_rgb(rgb)).mask
    truth = scene.studio.mask_at(T)[2::4, 2::4] > 0
    overlap = np.logical_and(found, truth).sum() / np.logical_or(found, truth).sum()
    assert overlap > 0.85

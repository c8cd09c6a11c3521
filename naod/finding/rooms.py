"""Rooms made up to calibrate in: the object or none, and other things of its very colour."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import cv2
import msgspec
import numpy as np
from numpy.typing import NDArray

from hal.backends import OpenOptions, open_studio
from hal.scenario import CameraSection, Scenario, SceneSection, ThingSection
from hal.simulation import Studio
from hal.yuyv import yuv_from_yuyv
from naod.finding.walls import paint_wall
from naod.geometry.camera import PinholeCamera, nominal_camera
from naod.geometry.transforms import Matrix
from naod.perception.blurring import light_from_yuv, yuv_from_light
from naod.perception.colour_model import Region
from naod.pose.objects import ObjectShape, shape_of

Thing = Literal["can", "ribbon", "board"]
Colour = tuple[int, int, int]

SIZE = (320, 240)
NOISE_STD = 1.0
"""Half of the camera's at twice the size: so many more pixels make one of the mask."""

EYE_M = 0.47
TABLE_TOP_M = 0.40
EXPOSURES_S = (0.0, 0.0, 0.010, 0.020, 0.033)
SPEED_MAX_RAD_S = 1.1
FAR_M = {"can": 1.7, "ribbon": 1.7, "board": 2.3}
NEAR_M = 0.35
SPECK_M = 1e-4
CUT_SHARE = 0.25
"""Of the views that have the object on the picture's border."""

OBJECT_HALF_M = 0.06
GLIMPSE_SHARE = 0.1
"""Less of the object than this share of what would fit is neither there nor not there."""

CAN, BOARD = (0.033, 0.115), (0.30, 0.20)
"""Radius, or width, and height in m."""

COLOURS: dict[Thing, Colour] = {
    "can": (200, 20, 30),
    "ribbon": (200, 20, 30),
    "board": (235, 200, 20),
}
OTHERS: tuple[tuple[str, float, float], ...] = (
    ("cylinder", 0.060, 0.06),
    ("cylinder", 0.014, 0.22),
    ("cylinder", 0.018, 0.024),
    ("rectangle", 0.22, 0.05),
    ("rectangle", 0.05, 0.26),
    ("rectangle", 0.09, 0.09),
)
"""Kind, radius or width, height of things of the object's colour that are not the object."""

RIBBON = "ribbon.png"
NEAR_LEVELS = (50.0, 110.0)
"""By how much other things that are nearly of its colour differ from it, in RGB."""


class RoomSpec(msgspec.Struct, frozen=True):
    """`others`: how many things of the object's colour stand about, `near`: of nearly its colour.

    `floor`: where it stands. `walls`: those of a scenario, or "picture" for patches of many
    colours. `tint`: logarithms by which red and blue light are more than in the room at home;
    `contrast`: logarithm of the exponent by which the camera's curve differs from there.
    """

    seed: int
    thing: Thing = "can"
    present: bool = True
    others: int = 0
    floor: bool = False
    light: float = 1.0
    near: int = 0
    walls: str = "clutter"
    tint: tuple[float, float] = (0.0, 0.0)
    contrast: float = 0.0


@dataclass(frozen=True, slots=True)
class View:
    """A picture (H, W, 2) YUYV and the object's mask (H, W), None where it is not there.

    `blur_px`: how far everything moved during the exposure, in its pixels.
    """

    yuyv: NDArray[np.uint8]
    mask: NDArray[np.uint8] | None
    blur_px: float = 0.0


class Room:
    """One room; `folder` is where pictures for textures are made."""

    def __init__(self, spec: RoomSpec, folder: Path) -> None:
        self.spec = spec
        scenario = _scenario(spec, folder)
        self.shape: ObjectShape = shape_of(_object(spec, False))
        self.camera: PinholeCamera = nominal_camera("v6", *SIZE)
        section = {"scenario": scenario, "scenario_folder": folder, "seed": spec.seed}
        options = OpenOptions(width=SIZE[0], height=SIZE[1], section=section)
        self._studio: Studio = open_studio("sim", options)

    def shown(self) -> tuple[NDArray[np.uint8], Region]:
        """A sharp picture from the front, and what a person marks in it: one colour."""
        T = _looking(self._studio.T_world_object, 0.8, 0.0)
        rows, columns = np.nonzero(self._studio.mask_at(T))
        x, y = int(columns.min()), int(rows.min())
        width, height = int(columns.max()) + 1 - x, int(rows.max()) + 1 - y
        upper = 0.68 if self.spec.thing == "ribbon" else 0.2
        region = Region(
            x + width // 5, y + int(upper * height), 3 * width // 5, int((0.88 - upper) * height)
        )
        return self._studio.frame_at(T, noise_seed=self.spec.seed), region

    def views(self, count: int) -> Iterator[View]:
        """From about the room: the object anywhere in the picture, or cut off by its border."""
        rng = np.random.default_rng([self.spec.seed, 31])
        for n in range(count):
            poses = self._poses(rng)
            view = self._view(poses, 1000 * self.spec.seed + n)
            if view is not None:
                yield view

    def _view(self, poses: NDArray[np.float64], noise_seed: int) -> View | None:
        """None where only a glimpse of the object is in the picture."""
        yuyv = self._studio.frame_at(poses[0], poses, noise_seed)
        yuyv = developed(yuyv, self.spec.tint, self.spec.contrast)
        blur_px = self.camera.fx * _angle(poses[0, :3, :3].T @ poses[-1, :3, :3])
        if not self.spec.present:
            return View(yuyv, None, blur_px)
        mask = self._studio.mask_at(poses[0], poses)
        distance = float(np.linalg.norm(poses[0][:3, 3] - self._studio.T_world_object[:3, 3]))
        if np.count_nonzero(mask) > GLIMPSE_SHARE * self._whole(distance):
            return View(yuyv, mask, blur_px)
        return None if mask.any() else View(yuyv, None, blur_px)

    def _whole(self, distance_m: float) -> float:
        """Pixels of the object seen from the front."""
        width = getattr(self.shape, "width_m", 2.0 * getattr(self.shape, "radius_m", 0.0))
        return float(width * self.shape.height_m * (self.camera.fx / distance_m) ** 2)

    def _poses(self, rng: np.random.Generator) -> NDArray[np.float64]:
        """Camera poses through an exposure."""
        way = math.exp(rng.uniform(math.log(NEAR_M), math.log(FAR_M[self.spec.thing])))
        T = _looking(self._studio.T_world_object, way, rng.uniform(-0.6, 0.6))
        aside = rng.uniform(-1.0, 1.0, 3) * (0.25, 0.4, 0.06)
        if rng.random() < CUT_SHARE:
            side = int(rng.integers(2))
            half = (self.camera.height, self.camera.width)[side] / (2.0 * self.camera.fx)
            reach = OBJECT_HALF_M / way
            border = math.atan(half) + rng.uniform(-0.7, 0.7) * reach
            aside[side] = border * rng.choice((-1.0, 1.0))
        T[:3, :3] = T[:3, :3] @ _turned(aside)
        exposure = EXPOSURES_S[int(rng.integers(len(EXPOSURES_S)))]
        way_rad = rng.uniform(0.0, SPEED_MAX_RAD_S) * exposure
        angle = rng.uniform(0.0, 2.0 * math.pi)
        moments = np.linspace(-0.5, 0.5, 5)[:, None] * way_rad
        turns = moments * (math.sin(angle), math.cos(angle), 0.0)
        return np.stack([_step(T, turn) for turn in turns])


def developed(
    yuyv: NDArray[np.uint8], tint: tuple[float, float], contrast: float
) -> NDArray[np.uint8]:
    """A picture (H, W, 2) in light of another colour and by another curve; as in `RoomSpec`."""
    if not any(tint) and not contrast:
        return yuyv
    light = light_from_yuv(yuv_from_yuyv(yuyv).astype(np.float32))
    light *= np.exp(np.array([tint[0], 0.0, tint[1]], dtype=np.float32))
    light = np.clip(light, 0.0, 1.0) ** np.float32(math.exp(contrast))
    yuv = np.clip(np.rint(yuv_from_light(light)), 0, 255).astype(np.uint8)
    out = np.empty_like(yuyv)
    out[..., 0] = yuv[..., 0]
    out[:, 0::2, 1], out[:, 1::2, 1] = yuv[:, 0::2, 1], yuv[:, 0::2, 2]
    return out


def _step(T: Matrix, turn: NDArray[np.float64]) -> Matrix:
    out = T.copy()
    out[:3, :3] = T[:3, :3] @ _turned(turn)
    return out


def _angle(rotation: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(cv2.Rodrigues(rotation)[0]))


def _turned(rotation: NDArray[np.float64]) -> Matrix:
    return np.asarray(cv2.Rodrigues(np.asarray(rotation, dtype=np.float64))[0])


def _looking(T_object: Matrix, way_m: float, azimuth: float) -> Matrix:
    """T_world_camera of a robot that looks at the object from `azimuth` off its face."""
    eye = T_object[:3, 3].copy()
    eye += way_m * (math.cos(azimuth) * T_object[:3, 2] + math.sin(azimuth) * T_object[:3, 0])
    eye[2] = EYE_M
    z = T_object[:3, 3] - eye
    z = z / np.linalg.norm(z)
    x = np.cross(z, (0.0, 0.0, 1.0))
    x = x / np.linalg.norm(x)
    T = np.eye(4)
    T[:3, :3] = np.column_stack([x, np.cross(z, x), z])
    T[:3, 3] = eye
    return T


def _object(spec: RoomSpec, speck: bool) -> ThingSection:
    """A speck stands for an absent object: the table stays."""
    if spec.thing == "board":
        wide, high = (SPECK_M, SPECK_M) if speck else BOARD
        return ThingSection(kind="rectangle", width_m=wide, height_m=high)
    radius, high = (SPECK_M, SPECK_M) if speck else CAN
    bottom = 0.0 if spec.floor else TABLE_TOP_M
    place = (1.2, 0.0, bottom + high / 2.0)
    texture = RIBBON if spec.thing == "ribbon" and not speck else None
    return ThingSection(radius_m=radius, height_m=high, position=place, texture=texture)


def _scenario(spec: RoomSpec, folder: Path) -> Scenario:
    rng = np.random.default_rng([spec.seed, 57])
    own = COLOURS[spec.thing]
    others = [_other(spec, rng, n, own) for n in range(spec.others)]
    others += [_other(spec, rng, n, _near(own, rng)) for n in range(spec.near)]
    _paint_ribbon(folder / RIBBON)
    walls = spec.walls
    if walls == "picture":
        walls = "wall.png"
        paint_wall(folder / walls, spec.seed)
    scene = SceneSection(background=walls, light=spec.light)
    thing = _object(spec, not spec.present)
    camera = CameraSection(noise_std=NOISE_STD)
    return Scenario(object=thing, scene=scene, camera=camera, distractor=tuple(others))


def _near(own: Colour, rng: np.random.Generator) -> Colour:
    way = rng.normal(0.0, 1.0, 3)
    levels = np.array(own) + way / np.linalg.norm(way) * rng.uniform(*NEAR_LEVELS)
    red, green, blue = (int(level) for level in np.clip(np.rint(levels), 0, 255))
    return red, green, blue


def _other(spec: RoomSpec, rng: np.random.Generator, n: int, colour: Colour) -> ThingSection:
    """Something beside where the object is, on its left and right in turn."""
    centre = _object(spec, False).position or (1.6, 0.0, 0.50)
    kind, across, height = OTHERS[int(rng.integers(len(OTHERS)))]
    aside = (1.0 if n % 2 else -1.0) * (rng.uniform(0.01, 0.2) + 0.06 + across)
    aside += math.copysign(0.15, aside) if spec.thing == "board" else 0.0
    sizes = {"radius_m" if kind == "cylinder" else "width_m": across, "height_m": height}
    low = centre[2] if spec.thing == "board" else (0.0 if spec.floor else TABLE_TOP_M)
    z = low if spec.thing == "board" else low + height / 2.0 + 1e-3
    place = (centre[0] - rng.uniform(0.0, 0.1), aside, z)
    return ThingSection(kind=kind, colour=colour, position=place, **sizes)  # type: ignore[arg-type]


def _paint_ribbon(path: Path) -> None:
    """A red wrapper with a white ribbon that runs around it in a wave."""
    image = np.full((128, 256, 3), COLOURS["ribbon"][::-1], dtype=np.uint8)
    x = np.arange(256)
    middle = 58.0 + 9.0 * np.sin(2.0 * np.pi * x / 128.0)
    rows = np.arange(128)[:, None]
    image[np.abs(rows - middle) < 9.0] = (238, 240, 240)
    cv2.imwrite(str(path), image)

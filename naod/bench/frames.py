"""Rendered frames with their truth: a can approached with a turning head, at several exposures."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import msgspec
import numpy as np
from numpy.typing import NDArray

from hal.backends import OpenOptions, open_studio
from hal.scenario import Scenario, SceneSection, ThingSection
from hal.simulation import Studio
from naod.geometry.camera import nominal_camera
from naod.perception.colour_model import Region

PERIOD_S = 1.0 / 15.0
FAR_M, NEAR_M, EYE_M = 1.3, 0.55, 0.47
SWAY_M, SWAY_HZ = 0.02, 1.0
ROLL_RAD = 0.03
YAW_RAD, YAW_HZ = math.radians(14.0), 0.7
PITCH_RAD, PITCH_HZ = math.radians(6.0), 0.9
"""At the fastest 62 degrees a second sideways and 34 up and down, together in every direction."""

SHOWN_SHARE = 0.6
"""Of the object's width and height, what a person marks: safely inside."""

MOMENTS = 5
TABLE_TOP_M = 0.40
SPECK_M = 1e-4
SEEN_MIN_SHARE = 0.0005
"""Of the picture: less of the object than that does not count as being there."""

APPROACH_FRAMES = 20


@dataclass(frozen=True, slots=True)
class Frame:
    """A picture and what it shows.

    yuyv: (H, W, 2) uint8. mask: (H, W) uint8, non-zero = object, None when it is not there.
    T_camera_object: (4, 4) in the middle of the exposure, None where nobody knows. motion_px: of
    the object through the picture during the exposure, right and down.
    """

    yuyv: NDArray[np.uint8]
    mask: NDArray[np.uint8] | None
    T_camera_object: NDArray[np.float64] | None = None
    motion_px: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class Sequence:
    """Frames in the order in which they were taken, the first of them following `shown`.

    `shown` is sharp; `region` is what a person marked in it.
    """

    name: str
    shown: NDArray[np.uint8]
    region: Region
    frames: tuple[Frame, ...]


class WalkSettings(msgspec.Struct, frozen=True):
    """How much of it to render; `background` and `light` as in SCENARIO.toml."""

    count: int = APPROACH_FRAMES
    size: tuple[int, int] = (640, 480)
    seed: int = 0
    background: str = "clutter"
    light: float = 1.0


class Walk:
    """One approach, in one room, that can be taken again with another exposure."""

    def __init__(self, settings: WalkSettings) -> None:
        self.settings = settings
        self._studio = _studio(settings, ThingSection())
        self._camera = nominal_camera("v6", *settings.size)

    def taken(self, name: str, exposure_s: float) -> Sequence:
        """The whole of it. Raises BackendError where no simulation is installed."""
        before = _eye(self._studio, FAR_M, 0.0)
        shown = self._studio.frame_at(before, noise_seed=self._noise(0))
        region = marked_region(self._studio.mask_at(before))
        frames = tuple(self._frame(n, exposure_s) for n in range(1, self.settings.count + 1))
        return Sequence(name, shown, region, frames)

    def without(self, name: str, exposure_s: float) -> Sequence:
        """The same walk after the object was taken away."""
        seen = Walk(msgspec.structs.replace(self.settings, count=0)).taken(name, 0.0)
        speck = ThingSection(
            radius_m=SPECK_M, height_m=SPECK_M, position=(1.2, 0.0, TABLE_TOP_M + SPECK_M)
        )
        empty = _studio(self.settings, speck)
        frames = []
        for n in range(1, self.settings.count + 1):
            poses = self._poses(n, exposure_s)
            yuyv = empty.frame_at(poses[0], poses, self._noise(n))
            frames.append(Frame(yuyv, None, None, self._motion(poses)))
        return Sequence(name, seen.shown, seen.region, tuple(frames))

    def _frame(self, n: int, exposure_s: float) -> Frame:
        poses = self._poses(n, exposure_s)
        mask = self._studio.mask_at(poses[0], poses)
        T_world_camera = poses[MOMENTS // 2]
        T = np.linalg.inv(T_world_camera) @ self._studio.T_world_object
        yuyv = self._studio.frame_at(poses[0], poses, self._noise(n))
        seen = np.count_nonzero(mask) >= SEEN_MIN_SHARE * mask.size
        return Frame(yuyv, mask if seen else None, T, self._motion(poses))

    def _motion(self, poses: NDArray[np.float64]) -> tuple[float, float]:
        places = np.linalg.inv(poses[[0, -1]]) @ self._studio.T_world_object[:, 3]
        pixels = self._camera.project(places[:, :3])
        return float(pixels[1, 0] - pixels[0, 0]), float(pixels[1, 1] - pixels[0, 1])

    def _poses(self, n: int, exposure_s: float) -> NDArray[np.float64]:
        way = FAR_M + (NEAR_M - FAR_M) * min(n / APPROACH_FRAMES, 1.0)
        moments = n * PERIOD_S + np.linspace(-0.5, 0.5, MOMENTS) * exposure_s
        return np.stack([_eye(self._studio, way, float(t)) for t in moments])

    def _noise(self, n: int) -> int:
        return 1000 * self.settings.seed + n


def marked_region(mask: NDArray[np.uint8]) -> Region:
    """What a person marks of an object (H, W) who keeps away from its edges."""
    rows, columns = np.nonzero(mask)
    x, y = int(columns.min()), int(rows.min())
    width, height = int(columns.max()) + 1 - x, int(rows.max()) + 1 - y
    margin = 0.5 * (1.0 - SHOWN_SHARE)
    return Region(
        int(x + margin * width),
        int(y + margin * height),
        max(int(SHOWN_SHARE * width), 1),
        max(int(SHOWN_SHARE * height), 1),
    )


def _studio(settings: WalkSettings, thing: ThingSection) -> Studio:
    scene = SceneSection(background=settings.background, light=settings.light)
    section: dict[str, object] = {
        "scenario": Scenario(object=thing, scene=scene),
        "scenario_folder": Path(),
        "seed": settings.seed,
    }
    width, height = settings.size
    return open_studio("sim", OpenOptions(width=width, height=height, section=section))


def _eye(studio: Studio, way_m: float, t_s: float) -> NDArray[np.float64]:
    """T_world_camera before the object, `way_m` away, at a moment of gait and head."""
    T_object = studio.T_world_object
    gait = 2.0 * math.pi * SWAY_HZ * t_s
    eye = T_object[:3, 3] + way_m * T_object[:3, 2]
    eye += SWAY_M * math.sin(gait) * T_object[:3, 0]
    eye[2] = EYE_M
    ahead = T_object[:3, 3] - eye
    z = ahead / np.linalg.norm(ahead)
    x = np.cross(z, (0.0, 0.0, 1.0))
    x /= np.linalg.norm(x)
    T = np.eye(4)
    T[:3, :3] = np.column_stack([x, np.cross(z, x), z]) @ _head(gait, t_s)
    T[:3, 3] = eye
    return T


def _head(gait: float, t_s: float) -> NDArray[np.float64]:
    yaw = YAW_RAD * math.sin(2.0 * math.pi * YAW_HZ * t_s)
    pitch = PITCH_RAD * math.sin(2.0 * math.pi * PITCH_HZ * t_s)
    roll = ROLL_RAD * math.sin(gait)
    return _turn(1, yaw) @ _turn(0, pitch) @ _turn(2, roll)


def _turn(axis: int, angle: float) -> NDArray[np.float64]:
    R = np.eye(3)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    R[i, i] = R[j, j] = math.cos(angle)
    R[j, i] = math.sin(angle)
    R[i, j] = -R[j, i]
    return R

"""Rendered frames with their truth: an approach with a turning head, at several exposures."""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import msgspec
import numpy as np
from numpy.typing import NDArray

from hal.backends import OpenOptions, open_studio
from hal.simulation import Studio
from naod.bench.eye import APPROACH, PERIOD_S, eye
from naod.bench.motion import smeared
from naod.bench.room import Room, Thing, object_of, scenario_of
from naod.geometry.camera import nominal_camera
from naod.perception.colour_model import Region
from naod.pose.objects import ObjectShape

SHOWN_SHARE = 0.6
"""Of the object's width and height, what a person marks: safely inside."""

MOMENTS = 5
SEEN_MIN_SHARE = 0.0005
"""Of the picture: less of the object than that does not count as being there."""

APPROACH_FRAMES = 20


Backdrop = Callable[[int], NDArray[np.float32]]
"""From a number, another for each frame, to a picture of linear light, (H, W, 3)."""

Poses = NDArray[np.float64]
Take = Callable[[Poses, Poses, int], NDArray[np.uint8]]
"""From where the camera is, where it is during the exposure, and a number for the noise."""


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
    exposure_s: float = 0.0


@dataclass(frozen=True, slots=True)
class Sequence:
    """Frames in the order in which they were taken, the first of them following `shown`.

    `shown` is sharp; `region` is what a person marked in it; `shape` is None where nobody knows.
    """

    name: str
    shown: NDArray[np.uint8]
    region: Region
    frames: tuple[Frame, ...]
    shape: ObjectShape | None = None


class WalkSettings(msgspec.Struct, frozen=True):
    """How much of it to render, of what, and where."""

    count: int = APPROACH_FRAMES
    size: tuple[int, int] = (640, 480)
    seed: int = 0
    thing: Thing = "can"
    room: Room = Room()


class Walk:
    """One approach, in one room, that can be taken again with another exposure."""

    def __init__(self, settings: WalkSettings) -> None:
        self.settings = settings
        self._studio = _studio(settings)
        self._camera = nominal_camera("v6", *settings.size)
        self._far_m, self._near_m = APPROACH[settings.thing]

    def taken(self, name: str, exposure_s: float) -> Sequence:
        """The whole of it. Raises BackendError where no simulation is installed."""
        return self._sequence(name, self._frames(exposure_s, self._studio.frame_at))

    def without(self, name: str, exposure_s: float) -> Sequence:
        """The same walk after the object was taken away."""
        return self._sequence(name, self._frames(exposure_s, self._empty.frame_at, absent=True))

    def before(
        self, exposure_s: float, backdrop: Backdrop, absent: bool = False
    ) -> tuple[Frame, ...]:
        """The object of the walk without its room, before pictures that move as it does.

        absent: the pictures alone. Raises ValueError for pictures of another size.
        """
        studio = self._empty if absent else self._studio

        def take(T: Poses, poses: Poses, noise: int) -> NDArray[np.uint8]:
            light = smeared(backdrop(noise), self._motion(poses))
            return studio.frame_before(light, T, poses, noise)

        return self._frames(exposure_s, take, absent)

    @cached_property
    def _empty(self) -> Studio:
        return _studio(self.settings, absent=True)

    def _sequence(self, name: str, frames: tuple[Frame, ...]) -> Sequence:
        return Sequence(name, *self.shown(), frames, object_of(self.settings.thing))

    def _frames(self, exposure_s: float, take: Take, absent: bool = False) -> tuple[Frame, ...]:
        frames = []
        for n in range(1, self.settings.count + 1):
            poses = self._poses(n, exposure_s)
            yuyv = take(poses[0], poses, self._noise(n))
            empty = Frame(yuyv, None, None, self._motion(poses), exposure_s)
            frames.append(empty if absent else self._frame(yuyv, poses, exposure_s))
        return tuple(frames)

    def shown(self) -> tuple[NDArray[np.uint8], Region]:
        """What a person is shown before it, and marks the object in."""
        before = eye(self._studio.T_world_object, self._far_m, 0.0)
        yuyv = self._studio.frame_at(before, noise_seed=self._noise(0))
        return yuyv, marked_region(self._studio.mask_at(before))

    def _frame(
        self, yuyv: NDArray[np.uint8], poses: NDArray[np.float64], exposure_s: float
    ) -> Frame:
        mask = self._studio.mask_at(poses[0], poses)
        T_world_camera = poses[MOMENTS // 2]
        T = np.linalg.inv(T_world_camera) @ self._studio.T_world_object
        seen = np.count_nonzero(mask) >= SEEN_MIN_SHARE * mask.size
        return Frame(yuyv, mask if seen else None, T, self._motion(poses), exposure_s)

    def _motion(self, poses: NDArray[np.float64]) -> tuple[float, float]:
        places = np.linalg.inv(poses[[0, -1]]) @ self._studio.T_world_object[:, 3]
        pixels = self._camera.project(places[:, :3])
        return float(pixels[1, 0] - pixels[0, 0]), float(pixels[1, 1] - pixels[0, 1])

    def _poses(self, n: int, exposure_s: float) -> NDArray[np.float64]:
        share = min(n / max(self.settings.count, APPROACH_FRAMES), 1.0)
        way_m = self._far_m + (self._near_m - self._far_m) * share
        moments = n * PERIOD_S + np.linspace(-0.5, 0.5, MOMENTS) * exposure_s
        return np.stack([eye(self._studio.T_world_object, way_m, float(t)) for t in moments])

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


def _studio(settings: WalkSettings, absent: bool = False) -> Studio:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        section: dict[str, object] = {
            "scenario": scenario_of(settings.thing, settings.room, settings.seed, folder, absent),
            "scenario_folder": folder,
            "seed": settings.seed,
        }
        width, height = settings.size
        return open_studio("sim", OpenOptions(width=width, height=height, section=section))

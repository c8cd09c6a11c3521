"""Walks up to an object, rendered: sway of the walk, sweeps of the head, exposure, true boxes."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import cv2
import msgspec
import numpy as np
from numpy.typing import NDArray

from hal.backends import OpenOptions, open_studio
from hal.scenario import Scenario, SceneSection, ThingSection
from hal.simulation import Studio
from naod.perception.blob import blob_of_mask
from naod.perception.colour_model import Region

Things = Literal["can", "board"]

FAR_M, NEAR_M = {"can": 1.3, "board": 1.8}, {"can": 0.5, "board": 0.8}
EYE_M = 0.47
SWAY_HZ, SWAY_M, ROLL_RAD, NOD_RAD = 1.0, 0.02, 0.05, 0.015
SWEEP_RAD, SWEEP_HZ = math.radians(14.0), 0.7
"""The head's sweep: 62 degrees per second where it is fastest."""
EXPOSURE_PARTS = 5
SEEN_PIXELS_MIN = 40
SHOWN_SHARE = 0.6
"""Of the object's width and height, what a person marks: safely inside."""


class RoomLook(msgspec.Struct, frozen=True):
    """What a room looks like; `picture` on its walls instead of clutter, `absent`: no object."""

    seed: int = 0
    light: float = 1.0
    picture: bool = False
    absent: bool = False


@dataclass(frozen=True, slots=True)
class WalkFrame:
    """A picture (H, W, 2) YUYV and the object's true oriented box (4, 2), None when not there.

    `cut_off`: there is no box because the object is not wholly in the picture.
    """

    yuyv: NDArray[np.uint8]
    corners_px: NDArray[np.float64] | None
    cut_off: bool = False


class Walks:
    """One object in one room. `folder` is where a wall's picture is made."""

    def __init__(
        self, thing: Things, look: RoomLook, folder: Path, size: tuple[int, int] = (640, 480)
    ) -> None:
        self.thing, self.look, self.size = thing, look, size
        options = OpenOptions(
            width=size[0],
            height=size[1],
            section={
                "scenario": _scenario(thing, look, folder),
                "scenario_folder": folder,
                "seed": look.seed,
            },
        )
        self._studio: Studio = open_studio("sim", options)

    def shown(self, count: int) -> tuple[list[NDArray[np.uint8]], Region]:
        """Pictures of the object standing before the robot, and the region a person marks."""
        T = self._eye(0.5 * (FAR_M[self.thing] + NEAR_M[self.thing]), 0.0, False)
        seed = 1000 * self.look.seed + 500
        frames = [self._studio.frame_at(T, noise_seed=seed + n) for n in range(count)]
        rows, columns = np.nonzero(self._studio.mask_at(T))
        x, y = columns.min(), rows.min()
        width, height = columns.max() + 1 - x, rows.max() + 1 - y
        margin = 0.5 * (1.0 - SHOWN_SHARE)
        region = Region(
            int(x + margin * width),
            int(y + margin * height),
            int(SHOWN_SHARE * width),
            int(SHOWN_SHARE * height),
        )
        return frames, region

    def frames(self, count: int, exposure_s: float, sweep: bool = True) -> list[WalkFrame]:
        """Pictures at even distances of the way, at odd moments of the gait."""
        rng = np.random.default_rng([self.look.seed, count])
        begins = rng.uniform(0.0, 10.0, count)
        ways = np.linspace(FAR_M[self.thing], NEAR_M[self.thing], count)
        return [
            self._taken(float(way), float(begin), exposure_s, sweep, n)
            for n, (way, begin) in enumerate(zip(ways, begins, strict=True))
        ]

    def _taken(self, way: float, begin: float, exposure: float, sweep: bool, n: int) -> WalkFrame:
        moments = begin + np.linspace(0.0, exposure, EXPOSURE_PARTS)
        poses = np.stack([self._eye(way, float(t), sweep) for t in moments])
        frame = self._studio.frame_at(poses[0], poses, noise_seed=1000 * self.look.seed + n)
        if self.look.absent:
            return WalkFrame(frame, None)
        blob = blob_of_mask(self._studio.mask_at(poses[0], poses), SEEN_PIXELS_MIN)
        if blob is None or blob.clipped:
            return WalkFrame(frame, None, cut_off=True)
        return WalkFrame(frame, blob.corners_px)

    def _eye(self, way_m: float, t_s: float, sweep: bool) -> NDArray[np.float64]:
        """T_world_camera before the object, `way_m` away, at a moment of the gait."""
        gait = 2.0 * math.pi * SWAY_HZ * t_s if sweep else 0.0
        T_object = self._studio.T_world_object
        side, out = T_object[:3, 0], T_object[:3, 2]
        eye = T_object[:3, 3] + way_m * out + SWAY_M * math.sin(gait) * side
        eye[2] = EYE_M
        ahead = T_object[:3, 3] - eye
        z = ahead / np.linalg.norm(ahead)
        x = np.cross(z, (0.0, 0.0, 1.0))
        x /= np.linalg.norm(x)
        T = np.eye(4)
        T[:3, :3] = np.column_stack([x, np.cross(z, x), z])
        T[:3, 3] = eye
        if sweep:
            T[:3, :3] = T[:3, :3] @ _head(gait, t_s)
        return T


def _head(gait: float, t_s: float) -> NDArray[np.float64]:
    yaw = SWEEP_RAD * math.sin(2.0 * math.pi * SWEEP_HZ * t_s)
    turns = (
        (0.0, yaw, 0.0),
        (NOD_RAD * math.sin(2.0 * gait), 0.0, 0.0),
        (0.0, 0.0, ROLL_RAD * math.cos(gait)),
    )
    R = np.eye(3)
    for turn in turns:
        R = R @ np.asarray(cv2.Rodrigues(np.array(turn))[0])
    return R


def _scenario(thing: Things, look: RoomLook, folder: Path) -> Scenario:
    """A speck where the object would be, when there is to be none: the table stays."""
    speck = 1e-4 if look.absent else None
    if thing == "can":
        place = (1.2, 0.0, 0.40 + 0.5e-4) if look.absent else None
        shown = ThingSection(kind="cylinder", radius_m=speck, height_m=speck, position=place)
    else:
        shown = ThingSection(kind="rectangle", width_m=speck, height_m=speck)
    background = _wall_picture(folder, look.seed) if look.picture else "clutter"
    return Scenario(object=shown, scene=SceneSection(background=background, light=look.light))


def _wall_picture(folder: Path, seed: int) -> str:
    """Patches of many colours and sizes; the name of the file made in `folder`."""
    rng = np.random.default_rng([seed, 77])
    image = np.full((512, 512, 3), rng.uniform(90, 200, 3), dtype=np.uint8)
    for _ in range(150):
        centre = tuple(int(c) for c in rng.integers(0, 512, 2))
        axes = tuple(int(a) for a in rng.integers(6, 60, 2))
        grey = rng.uniform(20.0, 235.0)
        colour = np.clip(grey + rng.normal(0.0, 35.0, 3), 0, 255).tolist()
        cv2.ellipse(image, centre, axes, float(rng.uniform(0, 180)), 0, 360, colour, -1)
    name = f"wall_{seed}.png"
    cv2.imwrite(str(folder / name), image)
    return name

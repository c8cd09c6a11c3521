"""`naod bench poses`: against the truth on rendered frames, and whether the sigma is honest."""

from __future__ import annotations

import statistics
from collections.abc import Callable
from dataclasses import dataclass, field

import msgspec
import numpy as np
from numpy.typing import NDArray

from naod.bench.frames import Frame, Sequence, Walk, WalkSettings
from naod.bench.room import Thing
from naod.bench.score import width_px
from naod.bench.table import Report
from naod.config import SegmentationConfig
from naod.finding.find import find_object
from naod.finding.hue import Colours
from naod.geometry.camera import PinholeCamera, nominal_camera
from naod.perception.learning import learn_model
from naod.perception.segmenter import Segmenter
from naod.pose.contour import corners_px
from naod.pose.locate import locate
from naod.pose.objects import Cylinder, ObjectShape
from naod.pose.result import Estimator, ObjectPose

EXPOSURES_S = (0.0, 0.010, 0.020, 0.033)
THINGS: tuple[Thing, ...] = ("can", "board")
ESTIMATORS: tuple[Estimator, ...] = ("exact", "paper")
WALKS, FEW_WALKS = 25, 2
"""500 frames a row tell an honest sigma from one that is not; fewer go with other benchmarks."""

COLUMNS = (
    "object, estimator, exposure",
    "frames",
    "posed %",
    "distance % median",
    "90th",
    "width % median",
    "90th",
    "error²/sigma² of 3",
    "95 % band",
)
Progress = Callable[[str], None]


@dataclass(slots=True)
class Errors:
    """Of the poses found; `normalised` are squared position errors over their covariance."""

    frames: int = 0
    distance: list[float] = field(default_factory=list)
    width: list[float] = field(default_factory=list)
    normalised: list[float] = field(default_factory=list)


def run(
    progress: Progress,
    settings: WalkSettings | None = None,
    walks: int = WALKS,
    things: tuple[Thing, ...] = THINGS,
    exposures_s: tuple[float, ...] = EXPOSURES_S,
) -> Report:
    """Every estimator, from far to near at every exposure."""
    settings = settings or WalkSettings()
    rows = []
    for thing in things:
        for exposure in exposures_s:
            progress(f"poses of the {thing} at {1e3 * exposure:.0f} ms")
            errors = {estimator: Errors() for estimator in ESTIMATORS}
            for seed in range(settings.seed, settings.seed + walks):
                walk = Walk(msgspec.structs.replace(settings, seed=seed, thing=thing))
                measure(walk.taken(thing, exposure), errors)
            for estimator, found in errors.items():
                rows.append((f"{thing}, {estimator}, {1e3 * exposure:.0f} ms", *_figures(found)))
    notes = (
        "error²/sigma²: mean over the frames of the position's squared error over its stated "
        "covariance, 3 when sigma is honest; the band is where 95 % of such means would lie",
    )
    return Report("poses", COLUMNS, tuple(rows), notes)


def measure(sequence: Sequence, errors: dict[Estimator, Errors]) -> None:
    """Add a walk's; frames that cut the object off do not count."""
    height, width = sequence.shown.shape[:2]
    camera, shape = nominal_camera("v6", width, height), sequence.shape
    assert shape is not None
    model = learn_model([sequence.shown], sequence.region)
    segmenter = Segmenter(model, SegmentationConfig(), (width, height))
    for frame in sequence.frames:
        T = frame.T_camera_object
        if frame.mask is None or T is None or not whole(shape, T, camera):
            continue
        segmentation = segmenter.segment(frame.yuyv)
        colours = Colours(frame.yuyv, model)
        found = find_object(segmentation, shape, camera, None, segmenter.settings, colours=colours)
        for estimator, kept in errors.items():
            kept.frames += 1
            if found is None:
                continue
            pose = locate(
                frame.yuyv, found.blob, shape, camera, estimator, exposure_s=frame.exposure_s
            )
            if pose is not None:
                add(kept, pose, frame, shape, camera)


def whole(shape: ObjectShape, T: NDArray[np.float64], camera: PinholeCamera) -> bool:
    """Whether all of the object at T (4, 4) is in the picture."""
    corners = corners_px(shape, T, camera)
    inside = (corners > 1.0) & (corners < (camera.width - 2.0, camera.height - 2.0))
    return bool(inside.all())


def add(
    kept: Errors, pose: ObjectPose, frame: Frame, shape: ObjectShape, camera: PinholeCamera
) -> None:
    """Keep the errors of a pose found in a frame whose truth is known."""
    T = frame.T_camera_object
    assert T is not None
    error = pose.T_camera_object[:3, 3] - T[:3, 3]
    kept.distance.append(abs(_far(pose.T_camera_object) / _far(T) - 1.0))
    true_px = width_px(corners_px(shape, seen_truth(shape, T), camera))
    kept.width.append(abs(width_px(pose.corners_px) / true_px - 1.0))
    kept.normalised.append(float(error @ np.linalg.solve(pose.covariance[:3, :3], error)))


def seen_truth(shape: ObjectShape, T: NDArray[np.float64]) -> NDArray[np.float64]:
    """T_camera_object with the front that a cylinder's outline has: z towards the camera."""
    if not isinstance(shape, Cylinder):
        return T
    y = T[:3, 1]
    z = -T[:3, 3] + (T[:3, 3] @ y) * y
    z = z / np.linalg.norm(z)
    out = T.copy()
    out[:3, :3] = np.column_stack([np.cross(y, z), y, z])
    return out


def _far(T: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(T[:3, 3]))


def _figures(found: Errors) -> tuple[float | int | str | None, ...]:
    n = len(found.normalised)
    if n < 2:
        return (found.frames, 100.0 * n / max(found.frames, 1), *(None,) * 6)
    low, high = band(n)
    return (
        found.frames,
        100.0 * n / found.frames,
        100.0 * statistics.median(found.distance),
        100.0 * float(np.quantile(found.distance, 0.9)),
        100.0 * statistics.median(found.width),
        100.0 * float(np.quantile(found.width, 0.9)),
        statistics.fmean(found.normalised),
        f"{low:.2f} to {high:.2f}",
    )


def band(n: int, dof: int = 3) -> tuple[float, float]:
    """Where the mean of n squared normalised errors lies 95 times of 100.

    Chi-square with n times dof degrees of freedom, by Wilson and Hilferty's cube root.
    """
    k = n * dof
    low, high = ((1.0 - 2.0 / (9.0 * k) + z * (2.0 / (9.0 * k)) ** 0.5) ** 3 for z in (-1.96, 1.96))
    return dof * low, dof * high

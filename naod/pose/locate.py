"""The object's pose from a picture and a blob, or from a mask alone."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from naod.geometry.camera import PinholeCamera
from naod.perception.blob import Blob, blob_of_mask
from naod.pose.coarse import CoarseFit, coarse_fit, outline_points
from naod.pose.contour import corners_px
from naod.pose.guesses import tilted
from naod.pose.noise import EdgeNoise
from naod.pose.objects import Cylinder, ObjectShape
from naod.pose.paper import paper_pose
from naod.pose.picture import see
from naod.pose.prior import Prior
from naod.pose.reading import Reading, read_points
from naod.pose.result import EDGES, Estimator, ObjectPose
from naod.pose.rivals import LEVEL_RAD, misfit_gap
from naod.pose.uncertainty import covariance

CAN_NOISE = EdgeNoise(
    floor_px=0.03,
    common_px=0.014,
    edge_px=0.022,
    edge_per_blur=0.02,
    edge_per_rise=6.5,
    per_odd=1.35,
    per_point=1.2,
    fits_px=1.0,
)
BOARD_NOISE = EdgeNoise(
    floor_px=0.03,
    common_px=0.011,
    edge_px=0.018,
    edge_per_blur=0.0046,
    edge_per_rise=1.1,
    per_odd=0.16,
    per_point=0.9,
    fits_px=1.0,
    scatter_px=0.085,
)
"""Of edges in the picture. A can's shade off towards its sides, and hide what is beside them; a
board's are even all along. Both by rendered walks (`naod bench poses`) of seeds 100 to 124, the
scatter by photographs (`naod bench backdrops`)."""

MASK_NOISE = EdgeNoise(
    floor_px=0.3,
    common_px=0.5,
    edge_px=0.3,
    edge_per_blur=0.0,
    edge_per_rise=0.0,
    per_odd=0.0,
    per_point=3.0,
    fits_px=2.0,
)
"""Somebody else's mask: half a pixel to and fro is a matter of how it was drawn."""

SUPPORT_MIN = 0.7
"""Share of the outline that must be there: about three edges of four."""

UNSTEADY_RAD_S2 = 5.0
"""By how much the turn of a camera changes: that of a head that sweeps 14 degrees to either side,
seven times in ten seconds."""

MASK_POINTS = 1200
NO_DOUBT = 50.0


def locate(
    yuyv: NDArray[np.uint8],
    blob: Blob,
    shape: ObjectShape,
    camera: PinholeCamera,
    estimator: Estimator = "exact",
    near: Prior | None = None,
    noise: EdgeNoise | None = None,
    exposure_s: float = 0.0,
) -> ObjectPose | None:
    """The pose of the object that a blob shows, its edges found again at full resolution.

    yuyv: (H, W, 2) uint8, the whole picture, of the camera's size. near: where the object is
    expected, tried before anything else. exposure_s: of the picture, which shows the mean of a long
    one, in which the camera may have turned unevenly. noise: of its edges, else what is usual for
    the shape. None when the blob's outline is not that of the shape.
    """
    coarse = coarse_fit(blob, shape, camera, near)
    if coarse is None:
        return None
    if noise is None:
        noise = CAN_NOISE if isinstance(shape, Cylinder) else BOARD_NOISE
    unsteady = math.hypot(noise.unsteady_px, unsteady_px(camera, exposure_s))
    noise = replace(noise, unsteady_px=unsteady)
    seen = see(yuyv, coarse, blob.grain_px, shape, camera, noise)
    if seen is None or seen.reading.support < SUPPORT_MIN:
        return _on_outline(coarse, blob, _coarse_noise(blob), shape, camera, estimator)
    total = _with_doubt(seen.covariance, seen.reading, seen.other, seen.gap / noise.per_point)
    edges = tuple(edge for edge, is_seen in zip(EDGES, seen.edges_seen, strict=True) if is_seen)
    return _pose(
        seen.reading, total, seen.corners_px, shape, camera, estimator, blob.clipped, edges,
        seen.blur_px,
    )  # fmt: skip


def unsteady_px(camera: PinholeCamera, exposure_s: float) -> float:
    """How far the mean place of a thing during an exposure is from that in its middle, px."""
    return math.sqrt(camera.fx * camera.fy) * UNSTEADY_RAD_S2 * exposure_s**2 / 24.0


def locate_mask(
    mask: NDArray[np.uint8],
    shape: ObjectShape,
    camera: PinholeCamera,
    estimator: Estimator = "exact",
) -> ObjectPose | None:
    """The pose of the object that a mask (H, W), non-zero inside, shows; None if it is not one."""
    blob = blob_of_mask(mask)
    if blob is None:
        return None
    coarse = coarse_fit(blob, shape, camera)
    if coarse is None:
        return None
    return _on_outline(coarse, blob, MASK_NOISE, shape, camera, estimator)


def _coarse_noise(blob: Blob) -> EdgeNoise:
    grain = blob.grain_px
    return EdgeNoise(0.3 * grain, 0.25 * grain, 0.25 * grain, 0.0, 0.0, 0.0, 3.0, 0.75 * grain)


def _on_outline(
    coarse: CoarseFit,
    blob: Blob,
    noise: EdgeNoise,
    shape: ObjectShape,
    camera: PinholeCamera,
    estimator: Estimator,
) -> ObjectPose | None:
    """The pose by a blob's own outline."""
    points, floor = outline_points(blob, MASK_POINTS), 0.7 * blob.grain_px
    found = [
        reading
        for start in _starts(coarse, shape)
        if (reading := read_points(points, start, shape, camera, floor, noise, coarse.gaps))
        and reading.support >= SUPPORT_MIN
    ]
    if not found:
        return None
    best = found[0]
    for reading in found[1:]:
        if _gap(best, reading) < 0.0:
            best = reading
    total = covariance(best, shape, noise)
    for reading in found:
        if reading is not best:
            gap = _gap(best, reading) / noise.per_point
            total = _with_doubt(total, best, reading.fit.T_camera_object, gap)
    near = np.bincount(best.fit.edges[np.abs(best.fit.residuals) < noise.fits_px], minlength=4)
    edges = tuple(edge for edge, count in zip(EDGES, near, strict=True) if count > 0)
    corners = corners_px(shape, best.fit.T_camera_object, camera)
    return _pose(best, total, corners, shape, camera, estimator, blob.clipped, edges, 0.0)


def _starts(coarse: CoarseFit, shape: ObjectShape) -> list[NDArray[np.float64]]:
    """A coarse fit's readings, and a can seen level between two tilts that hardly differ."""
    starts = [coarse.T_camera_object]
    if coarse.other is not None:
        starts.append(coarse.other)
    if isinstance(shape, Cylinder):
        level = coarse.T_camera_object.copy()
        tilted(np.ascontiguousarray(coarse.T_camera_object[:3]), LEVEL_RAD, level[:3])
        starts.append(level)
    return starts


def _gap(best: Reading, other: Reading) -> float:
    first, second = best.fit, other.fit
    gap = misfit_gap(
        first.residuals, first.groups, first.offsets,
        second.residuals, second.groups, second.offsets, first.spreads, best.trust,
    )  # fmt: skip
    return float(gap)


def _pose(
    reading: Reading,
    total: NDArray[np.float64],
    corners: NDArray[np.float64],
    shape: ObjectShape,
    camera: PinholeCamera,
    estimator: Estimator,
    clipped: tuple[str, ...],
    edges_seen: tuple[str, ...],
    blur_px: float,
) -> ObjectPose | None:
    T = reading.fit.T_camera_object
    if estimator == "paper":
        printed = paper_pose(reading, shape, camera)
        if printed is None:
            return None
        # the printed formulas' own error counts as one standard deviation
        total = _with_difference(total, 1.0, printed[0], T)
        T, corners = printed
    return ObjectPose(T, total, corners, estimator, clipped, edges_seen, blur_px, reading.support)


def _with_doubt(
    total: NDArray[np.float64], best: Reading, other: NDArray[np.float64] | None, gap: float
) -> NDArray[np.float64]:
    """Covariance of a mixture: the other reading (4, 4) counts by how little worse it fits."""
    if other is None or gap > NO_DOUBT:
        return total
    share = 1.0 / (1.0 + math.exp(0.5 * gap))
    return _with_difference(total, share, other, best.fit.T_camera_object)


def _with_difference(
    total: NDArray[np.float64], share: float, T_other: NDArray[np.float64], T: NDArray[np.float64]
) -> NDArray[np.float64]:
    difference = np.append(T_other[:3, 3] - T[:3, 3], _rotation_vector(T_other, T))
    return total + share * np.outer(difference, difference)


def _rotation_vector(T_other: NDArray[np.float64], T: NDArray[np.float64]) -> NDArray[np.float64]:
    Q = T_other[:3, :3] @ T[:3, :3].T
    angle = math.acos(min(max((float(np.trace(Q)) - 1.0) / 2.0, -1.0), 1.0))
    vee = np.array([Q[2, 1] - Q[1, 2], Q[0, 2] - Q[2, 0], Q[1, 0] - Q[0, 1]])
    norm = np.linalg.norm(vee)
    return vee * (angle / norm) if norm > 1e-12 else np.zeros(3)

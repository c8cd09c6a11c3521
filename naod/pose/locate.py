"""The object's pose from a picture and a blob, or from a mask alone."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from naod.geometry.camera import PinholeCamera
from naod.perception.blob import Blob, blob_of_mask
from naod.pose.contour import corners_px
from naod.pose.objects import ObjectShape
from naod.pose.outline import outline_of
from naod.pose.paper import paper_pose
from naod.pose.result import Estimator, ObjectPose
from naod.pose.search import (
    Reading,
    first_readings,
    next_readings,
    on_picture,
    seen_on_picture,
)
from naod.pose.uncertainty import EdgeNoise, parts, point_sigma

PICTURE_NOISE = EdgeNoise(floor_px=0.05, common_px=0.1, edge_px=0.05, per_point=3.0, fits_px=1.0)
"""A camera whose levels follow another curve than sRGB's shows everything a tenth of a pixel wider
or narrower; rendered pictures do not."""

MASK_NOISE = EdgeNoise(floor_px=0.3, common_px=0.5, edge_px=0.3, per_point=3.0, fits_px=2.0)
"""Somebody else's mask: half a pixel to and fro is a matter of how it was drawn."""

WIDE = 0.2
"""How far from a blob's outline edges are looked for, of its width: shading hides as much of a can
from its colour."""

NEAR_PX = 4.0
"""How far from a good outline: the step and its plateaus."""

NEAR_RISES = 1.2
"""The same in widths of a blurred step."""

SHARP_RISE_PX = 2.5
"""Width of a step without motion, as bilinear samples of shared chroma show it."""

SUPPORT_MIN = 0.7
"""Share of the outline that must be there: about three edges of four."""

OUTLIER = 3.0
"""Standard deviations beyond which a residual says no more than that it does not fit."""


def locate(
    yuyv: NDArray[np.uint8],
    blob: Blob,
    shape: ObjectShape,
    camera: PinholeCamera,
    estimator: Estimator = "exact",
) -> ObjectPose | None:
    """The pose of the object that a blob shows, its edges found again at full resolution.

    yuyv: (H, W, 2) uint8, the whole picture, of the camera's size. None when the blob's outline is
    not that of the shape.
    """
    coarse = first_readings(outline_of(blob), shape, camera)
    seen = _refined(coarse, yuyv, shape, camera)
    on_edges = _result(seen, _picture_noise(seen), blob, shape, camera, estimator)
    if on_edges is not None:
        return on_edges
    return _result(coarse, _coarse_noise(blob), blob, shape, camera, estimator)


def _refined(
    coarse: list[Reading], yuyv: NDArray[np.uint8], shape: ObjectShape, camera: PinholeCamera
) -> list[Reading]:
    """Edges looked for widely, all readings of those, and each fitted to the edges close by."""
    if not coarse:
        return []
    wide = max(2.5 * coarse[0].outline.grain_px, NEAR_PX)
    outline = seen_on_picture(coarse[0], yuyv, shape, camera, wide, WIDE)
    if outline is None:
        return []
    found = next_readings(outline, shape, camera, coarse)
    near = max(NEAR_PX, NEAR_RISES * outline.rise_px)
    for exact in (False, True):
        closer = (on_picture(reading, yuyv, shape, camera, near, exact) for reading in found)
        found = [reading for reading in closer if reading is not None]
    return found


def _picture_noise(found: list[Reading]) -> EdgeNoise:
    blur = max((reading.outline.rise_px / SHARP_RISE_PX for reading in found), default=1.0)
    return PICTURE_NOISE.blurred(max(blur, 1.0))


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
    found = first_readings(outline_of(blob), shape, camera)
    return _result(found, MASK_NOISE, blob, shape, camera, estimator)


def _coarse_noise(blob: Blob) -> EdgeNoise:
    grain = blob.grain_px
    return EdgeNoise(0.3 * grain, 0.25 * grain, 0.25 * grain, 3.0, 0.75 * grain)


def _result(
    found: list[Reading],
    noise: EdgeNoise,
    blob: Blob,
    shape: ObjectShape,
    camera: PinholeCamera,
    estimator: Estimator,
) -> ObjectPose | None:
    found = [reading for reading in found if reading.support(noise.fits_px) >= SUPPORT_MIN]
    if not found:
        return None
    sigma_px = min(point_sigma(reading.fit, noise) for reading in found)
    found = sorted(found, key=lambda reading: misfit(reading, sigma_px))
    best = found[0]
    scattered, common = parts(best, shape, noise)
    total = scattered + common
    if estimator == "paper":
        return paper_pose(best, total, shape, camera, blob.clipped)
    for other in found[1:]:
        gap = (misfit(other, sigma_px) - misfit(best, sigma_px)) / noise.per_point
        total = _with_doubt(total, best, other, gap)
    T = best.fit.T_camera_object
    return ObjectPose(
        T, total, corners_px(shape, T, camera), "exact", blob.clipped, total - scattered
    )


def misfit(reading: Reading, sigma_px: float) -> float:
    """Squared residuals over their variance, an outlier or an edge not seen counting OUTLIER^2."""
    ratio = np.minimum(np.abs(reading.fit.residuals) / sigma_px, OUTLIER)
    seen = float((ratio**2).sum())
    return seen + OUTLIER**2 * reading.outline.missed


def _with_doubt(
    total: NDArray[np.float64], best: Reading, other: Reading, gap: float
) -> NDArray[np.float64]:
    """Covariance of a mixture: the other reading counts by how little worse it fits."""
    share = 1.0 / (1.0 + math.exp(min(0.5 * gap, 50.0)))
    T, T_other = best.fit.T_camera_object, other.fit.T_camera_object
    difference = np.append(T_other[:3, 3] - T[:3, 3], _rotation_vector(T_other, T))
    return total + share * np.outer(difference, difference)


def _rotation_vector(T_other: NDArray[np.float64], T: NDArray[np.float64]) -> NDArray[np.float64]:
    Q = T_other[:3, :3] @ T[:3, :3].T
    angle = math.acos(min(max((float(np.trace(Q)) - 1.0) / 2.0, -1.0), 1.0))
    vee = np.array([Q[2, 1] - Q[1, 2], Q[0, 2] - Q[2, 0], Q[1, 0] - Q[0, 1]])
    norm = np.linalg.norm(vee)
    return vee * (angle / norm) if norm > 1e-12 else np.zeros(3)

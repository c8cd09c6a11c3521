"""Boxes of regions against OpenCV's, and boundaries against every pixel looked at."""

from __future__ import annotations

import cv2
import numpy as np
import pytest
from numpy.typing import NDArray

from naod.perception.blob import Blob, blob_of
from naod.perception.components import components


def boundary_of(inside: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Half-way between pixels that differ, in any order."""
    i, j = np.nonzero(inside[:, 1:] != inside[:, :-1])
    across = np.column_stack([j + 0.5, i])
    i, j = np.nonzero(inside[1:] != inside[:-1])
    return np.concatenate([across, np.column_stack([j, i + 0.5])])


def in_order(points: NDArray[np.float64]) -> NDArray[np.float64]:
    return points[np.lexsort(points.T)]


def blobs(mask: NDArray[np.uint8]) -> list[tuple[NDArray[np.bool_], Blob]]:
    labels, table = components(mask)
    found = []
    for k in range(1, len(table) + 1):
        wanted = np.zeros(len(table) + 1, dtype=np.bool_)
        wanted[k] = True
        found.append((labels == k, blob_of(labels, table, wanted, 1.0)))
    return found


def area(corners: NDArray[np.float64]) -> float:
    sides = np.linalg.norm(np.diff(corners[:3], axis=0), axis=1)
    return float(sides.prod())


@pytest.mark.parametrize("seed", range(40))
def test_any_region_has_opencvs_area_and_every_point_inside(seed: int) -> None:
    rng = np.random.default_rng(seed)
    shape = rng.integers(2, 60, 2)
    smooth = cv2.GaussianBlur(rng.normal(0, 1, shape), (0, 0), float(rng.uniform(0.5, 4.0)))
    for inside, blob in blobs((smooth > 0).astype(np.uint8)):
        expected = boundary_of(inside)
        assert (in_order(blob.boundary_px) == in_order(expected)).all()
        if len(expected) < 3 or len(blob.clipped) == 4:
            continue
        theirs = cv2.minAreaRect(expected.astype(np.float32))[1]
        assert area(blob.corners_px) == pytest.approx(theirs[0] * theirs[1], rel=1e-4, abs=1e-3)
        along = np.diff(blob.corners_px[[0, 1, 2]], axis=0)
        assert abs(along[0] @ along[1]) < 1e-6
        for side, origin in zip(along, blob.corners_px[:2], strict=True):
            shares = (expected - origin) @ side
            assert shares.min() > -1e-6
            assert shares.max() < side @ side + 1e-6


@pytest.mark.parametrize("turn_deg", [3.0, 20.0, 40.0, 62.0, 85.0])
def test_a_turned_rectangle_has_opencvs_corners(turn_deg: float) -> None:
    mask = np.zeros((120, 160), dtype=np.uint8)
    drawn = cv2.boxPoints(((80.0, 60.0), (70.0, 38.0), turn_deg))
    cv2.fillConvexPoly(mask, np.rint(drawn).astype(np.int32), 1)
    ((inside, blob),) = blobs(mask)
    theirs = cv2.boxPoints(cv2.minAreaRect(boundary_of(inside).astype(np.float32)))
    gaps = np.linalg.norm(theirs[:, None] - blob.corners_px[None], axis=2)
    assert gaps.min(axis=0).max() < 0.01
    assert gaps.min(axis=1).max() < 0.01
    middles = (blob.corners_px + np.roll(blob.corners_px, -1, axis=0)) / 2.0
    assert middles[:, 1].argmin() == 0


@pytest.mark.parametrize("direction", [(1, 0), (0, 1), (1, 1), (1, -1)])
def test_a_line_one_pixel_wide(direction: tuple[int, int]) -> None:
    mask = np.zeros((30, 30), dtype=np.uint8)
    for k in range(9):
        mask[14 + direction[1] * (k - 4), 14 + direction[0] * (k - 4)] = 1
    ((inside, blob),) = blobs(mask)
    theirs = cv2.minAreaRect(boundary_of(inside).astype(np.float32))[1]
    assert area(blob.corners_px) == pytest.approx(theirs[0] * theirs[1], rel=1e-4)

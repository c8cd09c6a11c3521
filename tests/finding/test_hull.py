"""Hulls, boxes and quadrilaterals of regions against OpenCV's and against shapes drawn."""

import cv2
import numpy as np
import pytest

from naod.finding.hull import four_sides, hull_of_rows, polygon_area, row_ends, smallest_box

SHAPE = (120, 160)


def hull_of(mask):
    rows, columns = np.nonzero(mask)
    ends = np.empty((mask.shape[0], 2), dtype=np.int64)
    limits = int(rows.min()), int(rows.max()), int(columns.min()), int(columns.max())
    row_ends(mask.astype(np.int32), np.array([False, True]), *limits, ends)
    hull = np.empty((4 * mask.shape[0], 2))
    count = hull_of_rows(ends, limits[0], limits[1], hull)
    return hull[:count].copy()


def drawn(kind, rng):
    mask = np.zeros(SHAPE, np.uint8)
    if kind == "ellipse":
        axes = int(rng.integers(3, 60)), int(rng.integers(3, 50))
        cv2.ellipse(mask, (80, 60), axes, float(rng.uniform(0, 180)), 0, 360, 1, -1)
    elif kind == "star":
        cv2.fillPoly(mask, [rng.integers(10, 110, (6, 2)).astype(np.int32)], 1)
    else:
        sides = float(rng.uniform(15, 70)), float(rng.uniform(15, 70))
        box = cv2.boxPoints(((80, 60), sides, float(rng.uniform(0, 90))))
        cv2.fillConvexPoly(mask, np.rint(box).astype(np.int32), 1)
    return mask


@pytest.mark.parametrize("kind", ["ellipse", "star", "box"])
def test_hull_and_box_are_opencvs(kind):
    rng = np.random.default_rng(5)
    for _ in range(40):
        mask = drawn(kind, rng)
        rows, columns = np.nonzero(mask)
        corners = [(x, y) for x in (-0.5, 0.5) for y in (-0.5, 0.5)]
        points = np.concatenate([np.column_stack([columns, rows]) + corner for corner in corners])
        theirs = cv2.convexHull(points.astype(np.float32)).reshape(-1, 2)
        ours = hull_of(mask)
        assert np.isclose(polygon_area(ours, len(ours)), cv2.contourArea(theirs), rtol=1e-6)
        assert {tuple(p) for p in ours} == {tuple(p) for p in theirs.astype(float)}
        box = np.empty(6)
        smallest_box(ours, len(ours), box)
        _, (a, b), _ = cv2.minAreaRect(theirs)
        assert np.isclose(box[4] * box[5], a * b, rtol=1e-4)
        assert box[3] >= abs(box[2]) - 1e-9


def test_four_sides_of_a_board_are_its_own_and_those_of_a_can_are_not():
    rng = np.random.default_rng(6)
    for kind, least, most in (("box", 1.0, 1.1), ("ellipse", 1.12, 1.5)):
        for _ in range(20):
            mask = drawn(kind, rng)
            if mask.sum() < 400:
                continue
            hull = hull_of(mask)
            corners = np.empty_like(hull)
            count = four_sides(hull, len(hull), corners)
            assert count == 4
            excess = polygon_area(corners, 4) / polygon_area(hull, len(hull))
            assert least - 1e-9 <= excess < most
            around = cv2.convexHull(corners[:4].astype(np.float32))
            # nothing of the region lies outside
            for point in hull:
                at = (float(point[0]), float(point[1]))
                assert cv2.pointPolygonTest(around, at, True) > -1e-2


def test_one_pixel_is_a_square():
    mask = np.zeros(SHAPE, np.uint8)
    mask[7, 9] = 1
    hull, box = hull_of(mask), np.empty(6)
    smallest_box(hull, len(hull), box)
    assert polygon_area(hull, len(hull)) == 1.0
    assert np.allclose(box, (9.0, 7.0, 0.0, 1.0, 1.0, 1.0))

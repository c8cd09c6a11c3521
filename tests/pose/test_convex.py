"""The convex part of a boundary, against OpenCV's hull, and fewer of its points."""

import cv2
import numpy as np

from naod.perception.blob import blob_of_mask
from naod.pose.convex import convex_points, hull_of, thinned


def area(corners):
    return abs(cv2.contourArea(corners.astype(np.float32)))


def test_hulls_are_those_of_opencv():
    rng = np.random.default_rng(0)
    for count in (3, 5, 40, 300):
        for levels in (4, 400):
            points = np.round(rng.uniform(0, 1, (count, 2)) * levels) / 2.0
            theirs = cv2.convexHull(points.astype(np.float32)).reshape(-1, 2)
            ours = hull_of(points)
            assert {tuple(corner) for corner in ours} == {tuple(corner) for corner in theirs}
            assert area(ours) == area(theirs)


def test_one_place_and_a_line_are_their_own_hulls():
    assert np.unique(hull_of(np.full((5, 2), 3.0)), axis=0).tolist() == [[3.0, 3.0]]
    line = np.arange(7.0)[:, None] * (2.0, 1.0)
    assert np.unique(hull_of(line), axis=0).tolist() == [[0.0, 0.0], [12.0, 6.0]]


def test_dents_and_holes_are_left_out():
    angles = np.linspace(0.0, 2.0 * np.pi, 200, endpoint=False)
    rim = 50.0 * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    dented = rim.copy()
    dented[20:60] *= 0.7
    hole = 0.2 * rim
    kept = convex_points(np.concatenate([dented, hole]), 1, 1.5, 1000)
    assert len(kept) >= 160
    assert np.all(np.linalg.norm(kept, axis=1) > 40.0)
    few = convex_points(np.concatenate([dented, hole]), 1, 1.5, 40)
    assert 30 <= len(few) <= 50


def test_thinning_leaves_no_side_out():
    # as a mask's boundary comes: each row's ends in turn, or those of two parts of a row
    for period in (2, 3, 4):
        points = np.stack([np.arange(600) % period, np.arange(600)], axis=1).astype(float)
        for every in range(1, 7):
            kept = thinned(points, every)
            assert len(kept) == 600 // every
            shares = np.bincount(kept[:, 0].astype(int), minlength=period) / len(kept)
            assert shares.min() > 0.6 / period
            assert np.all(np.diff(kept[:, 1]) > 0)


def test_all_sides_of_a_box_are_among_its_points():
    mask = np.zeros((120, 160), dtype=np.uint8)
    mask[35:59, 66:101] = 1
    points = convex_points(blob_of_mask(mask).boundary_px, 1, 1.5, 48)
    left, right = (np.count_nonzero(points[:, 0] == x) for x in (65.5, 100.5))
    assert min(left, right) > 0.5 * max(left, right)

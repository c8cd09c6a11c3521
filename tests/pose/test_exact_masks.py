"""The exact estimators on perfect masks of true shapes (raster.py) and against OpenCV's PnP."""

import cv2
import numpy as np
import pytest
from raster import BOARD, CAMERA, CAN, board_pose, can_pose, mask_of

from naod.geometry.camera import PinholeCamera
from naod.pose.locate import locate_mask
from naod.pose.objects import Cylinder, Rectangle

DISTANCES = (0.3, 0.5, 0.8, 1.2, 2.0)


def angle_deg(a, b):
    return np.degrees(np.arccos(np.clip(a @ b, -1.0, 1.0)))


def random_place(rng, distance):
    return np.array([*rng.uniform(-0.15, 0.15, 2) * distance, distance])


def test_can_within_half_a_percent_from_near_to_far_tilted_up_to_45_degrees():
    rng = np.random.default_rng(1)
    errors, tilts = [], []
    for distance in DISTANCES:
        for _ in range(6):
            tilt, roll = np.radians(rng.uniform(-45, 45)), np.radians(rng.uniform(-40, 40))
            T = can_pose(random_place(rng, distance), tilt, roll)
            found = locate_mask(mask_of(CAN, T), CAN, CAMERA).T_camera_object
            errors.append(np.linalg.norm(found[:3, 3] - T[:3, 3]) / distance)
            tilts.append(angle_deg(found[:3, 1], T[:3, 1]))
    assert np.median(errors) < 0.001
    assert max(errors) < 0.005
    assert np.median(tilts) < 0.5
    assert max(tilts) < 5.0


def test_board_within_half_a_percent_and_as_good_as_pnp_on_true_corners():
    rng = np.random.default_rng(2)
    errors, turns, pnp_errors = [], [], []
    half = np.array([BOARD.width_m, BOARD.height_m]) / 2.0
    corners = np.array([(-1, 1, 0), (1, 1, 0), (1, -1, 0), (-1, -1, 0)]) * np.append(half, 0.0)
    for distance in DISTANCES[2:]:
        for _ in range(6):
            angles = np.radians(rng.uniform(-45, 45, 2)), np.radians(rng.uniform(-30, 30))
            T = board_pose(random_place(rng, distance), *angles[0], angles[1])
            pose = locate_mask(mask_of(BOARD, T), BOARD, CAMERA)
            found = pose.T_camera_object
            errors.append(np.linalg.norm(found[:3, 3] - T[:3, 3]) / distance)
            turns.append(max(angle_deg(found[:3, k], T[:3, k]) for k in range(3)))
            seen = pose.corners_px[:, None]
            _, _, t, _ = cv2.solvePnPGeneric(corners, seen, CAMERA.K, None, flags=cv2.SOLVEPNP_IPPE)
            gaps = [np.linalg.norm(found[:3, 3] - ti[:, 0]) / distance for ti in t]
            pnp_errors.append(min(gaps))
    assert np.median(errors) < 0.001
    assert max(errors) < 0.005
    assert max(turns) < 2.0
    # the corners it reports and the pose it reports are one and the same thing
    assert max(pnp_errors) < 1e-6


@pytest.mark.parametrize("turned", [0.0, np.pi / 2])
def test_the_longer_side_is_found_however_the_board_hangs(turned):
    T = board_pose((0.05, -0.02, 1.0), 0.2, 0.3, turned)
    found = locate_mask(mask_of(BOARD, T), BOARD, CAMERA).T_camera_object
    assert angle_deg(found[:3, 2], T[:3, 2]) < 1.0
    assert abs(abs(found[:3, 0] @ T[:3, 0]) - 1.0) < 1e-3
    assert found[1, 1] <= 0.0 or turned


def test_a_can_on_its_side_and_one_broader_than_high():
    lying = can_pose((0.0, 0.05, 0.7), 0.1, np.radians(80))
    found = locate_mask(mask_of(CAN, lying), CAN, CAMERA).T_camera_object
    assert np.linalg.norm(found[:3, 3] - lying[:3, 3]) < 0.0035
    assert angle_deg(found[:3, 1], lying[:3, 1]) < 3.0
    tin = Cylinder(radius_m=0.05, height_m=0.04)
    seen = can_pose((0.02, 0.0, 0.8), 0.5)
    found = locate_mask(mask_of(tin, seen), tin, CAMERA).T_camera_object
    assert np.linalg.norm(found[:3, 3] - seen[:3, 3]) < 0.004


def test_strong_distortion_is_undone():
    lens = PinholeCamera(
        width=640,
        height=480,
        fx=536.0,
        fy=536.0,
        cx=342.0,
        cy=235.0,
        distortion=(-0.27, -0.04, 0.0018, -0.0003, 0.24),
    )
    for shape, T in (
        (CAN, can_pose((0.2, -0.12, 0.6), 0.3)),
        (Rectangle(width_m=0.2, height_m=0.125), board_pose((-0.15, 0.1, 0.5), 0.4, -0.3, 0.1)),
    ):
        found = locate_mask(mask_of(shape, T, lens), shape, lens).T_camera_object
        assert np.linalg.norm(found[:3, 3] - T[:3, 3]) < 0.003 * np.linalg.norm(T[:3, 3])


def test_clipped_by_one_border_it_uses_the_other_edges_and_says_so():
    for shape, T, side in (
        (CAN, can_pose((0.0, 0.17, 0.5), 0.2), "bottom"),
        (CAN, can_pose((0.02, -0.16, 0.5), 0.3), "top"),
        (CAN, can_pose((0.245, 0.0, 0.5), 0.2), "right"),
        (BOARD, board_pose((-0.30, 0.0, 0.8), 0.2, 0.3), "left"),
        (BOARD, board_pose((0.0, 0.27, 0.8), 0.3, 0.1), "bottom"),
    ):
        pose = locate_mask(mask_of(shape, T), shape, CAMERA)
        distance = np.linalg.norm(T[:3, 3])
        assert pose.clipped == (side,)
        assert np.linalg.norm(pose.T_camera_object[:3, 3] - T[:3, 3]) < 0.02 * distance, side


def test_nothing_and_next_to_nothing_have_no_pose():
    empty = np.zeros((480, 640), np.uint8)
    assert locate_mask(empty, CAN, CAMERA) is None
    empty[10, 10:14] = 1
    assert locate_mask(empty, CAN, CAMERA) is None
    everything = np.ones((480, 640), np.uint8)
    assert locate_mask(everything, CAN, CAMERA) is None


def test_an_outline_of_something_else_has_no_pose():
    star = np.zeros((480, 640), np.uint8)
    angles = np.arange(10) * np.pi / 5
    radii = np.where(np.arange(10) % 2, 45.0, 130.0)
    points = np.column_stack([320 + radii * np.cos(angles), 240 + radii * np.sin(angles)])
    cv2.fillPoly(star, [points.astype(np.int32)], 1)
    assert locate_mask(star, BOARD, CAMERA) is None

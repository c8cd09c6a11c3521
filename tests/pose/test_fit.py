"""Outline, residuals, their derivatives and the closed forms, each by another way."""

import cv2
import msgspec
import numpy as np
import pytest
from closed_forms import cylinder_from_sides
from edge_places import edge_places
from hypothesis import given, settings
from hypothesis import strategies as st
from raster import BOARD, CAMERA, CAN, board_pose, can_pose, meets, towards_camera

from naod.geometry.linear import invert_symmetric, solve_symmetric
from naod.geometry.transforms import rot_x, rot_y, rot_z, transform
from naod.pose.contour import ARC, corners_px, figures, outline_in_camera, outline_px
from naod.pose.fit import compare, fit_outline
from naod.pose.guesses import mirror, rectangle_from_quadrilateral

LEVEL = can_pose((0.0, 0.0, 0.7), 0.0)
POSES = [
    (CAN, can_pose((0.02, 0.03, 0.6), 0.5, 0.2)),
    (CAN, can_pose((-0.05, 0.1, 0.5), -0.4)),
    (CAN, LEVEL),
    (CAN, can_pose((0.03, 0.02, 0.4), 1.3, 0.3)),
    (BOARD, board_pose((0.1, -0.05, 1.0), 0.3, -0.5, 0.2)),
]


@pytest.mark.parametrize(("shape", "T"), POSES)
def test_just_inside_the_outline_a_ray_meets_the_solid_and_just_outside_it_does_not(shape, T):
    corners = outline_px(shape, T, CAMERA)
    chords = np.diff(corners, axis=0)
    lengths = np.linalg.norm(chords, axis=1)
    long = lengths > 0.2
    middles = (corners[:-1] + chords / 2.0)[long]
    outwards = np.column_stack([chords[:, 1], -chords[:, 0]])[long] / lengths[long, None]
    # a chord lies inside its arc by no more than a hundredth of its length
    assert not meets(shape, T, CAMERA, middles + 0.3 * outwards).any()
    assert meets(shape, T, CAMERA, middles - 0.3 * outwards).all()


def test_looking_into_the_end_of_a_can_the_outline_is_its_rim():
    T = towards_camera(transform(rot_x(np.pi + 1.5), (0.0, 0.005, 0.5)))
    points, _ = outline_in_camera(CAN, T)
    on_can = (points - T[:3, 3]) @ T[:3, :3]
    assert np.allclose(np.hypot(on_can[:, 0], on_can[:, 2]), CAN.radius_m)
    assert np.allclose(on_can[:, 1], CAN.height_m / 2.0)


def residuals_at(shape, T, points):
    n = len(points)
    residuals, jacobian, edges = np.empty(n), np.empty((n, 6)), np.empty(n, dtype=np.int64)
    R, t = np.ascontiguousarray(T[:3, :3]), T[:3, 3].copy()
    corners = np.full(n, -1)
    compare(*figures(shape), R, t, points, corners, residuals, jacobian, edges)
    return residuals, jacobian


def moved(T, k, step):
    if k < 3:
        return transform(T[:3, :3], T[:3, 3] + step * np.eye(3)[k])
    turn = (rot_x, rot_y, rot_z)[k - 3](step)
    return transform(turn @ T[:3, :3], T[:3, 3])


@pytest.mark.parametrize(("shape", "T"), POSES)
def test_derivatives_equal_finite_differences(shape, T):
    rng = np.random.default_rng(0)
    corners = CAMERA.normalised(outline_px(shape, T, CAMERA))
    part = rng.uniform(0.2, 0.8, (len(corners) - 1, 1))
    points = corners[:-1] + part * np.diff(corners, axis=0)
    _, jacobian = residuals_at(shape, T, points)
    step = 1e-5
    for k in range(6):
        after = residuals_at(shape, moved(T, k, step), points)[0]
        before = residuals_at(shape, moved(T, k, -step), points)[0]
        numeric = (after - before) / (2.0 * step)
        assert (
            np.median(np.abs(numeric - jacobian[:, k])) < 0.01 * np.abs(jacobian[:, k]).max() + 1e-9
        )


@pytest.mark.parametrize(("shape", "T"), [pose for pose in POSES if pose[1] is not LEVEL])
def test_gauss_newton_comes_back_from_nearby(shape, T):
    # seen level, a can tilted to and one tilted fro meet: nothing to come back to
    points = CAMERA.normalised(edge_places(shape, T)[0])
    start = transform(rot_x(-0.1) @ rot_z(0.08) @ T[:3, :3], T[:3, 3] * (1.04, 1.0, 1.08))
    if shape is CAN and T[1, 1] * T[2, 1] > 0.0:
        start = transform(rot_x(0.2) @ start[:3, :3], start[:3, 3])
    found = fit_outline(shape, start, points, 600.0, 1.0, iterations=30).T_camera_object
    assert np.abs(found[:3, 3] - T[:3, 3]).max() < 2e-3 * T[2, 3]
    assert found[:3, 1] @ T[:3, 1] > 0.9995


@settings(max_examples=50, derandomize=True, deadline=None)
@given(
    tilt=st.floats(-0.8, 0.8),
    roll=st.floats(-0.5, 0.5),
    x=st.floats(-0.2, 0.2),
    y=st.floats(-0.2, 0.2),
    distance=st.floats(0.3, 2.0),
)
def test_closed_form_of_a_cylinder_from_its_sides(tilt, roll, x, y, distance):
    T = can_pose((x * distance, y * distance, distance), tilt, roll)
    centre, axis = T[:3, 3], T[:3, 1]
    # planes through the camera at distance r from the axis: their normals n with n.a = 0,
    # n.c = -r, found here in the plane across the axis by trigonometry
    across = centre - (centre @ axis) * axis
    away = np.linalg.norm(across)
    u = across / away
    v = np.cross(axis, u)
    beta = np.arccos(-CAN.radius_m / away)
    left, right = (np.cos(beta) * u + s * np.sin(beta) * v for s in (1.0, -1.0))
    ends = [centre + s * CAN.height_m / 2.0 * axis for s in (1.0, -1.0)]
    seen = tuple(end[:2] / end[2] for end in ends)
    found = cylinder_from_sides(left, right, seen, CAN)
    assert np.allclose(found, T, atol=1e-9 * max(1.0, 1.0 / distance))


@pytest.mark.parametrize(("shape", "T"), POSES[:2])
def test_the_fitted_can_is_the_closed_form_of_its_own_outline(shape, T):
    points, _ = outline_in_camera(shape, T)
    fit = fit_outline(shape, T, points[:, :2] / points[:, 2:], 600.0, 0.3)
    found, _ = outline_in_camera(shape, fit.T_camera_object)
    # the sides are the planes through the camera and the two straight pieces
    right = np.cross(found[ARC], found[ARC + 1])
    left = np.cross(found[2 * ARC + 1], found[0])
    centre, axis = fit.T_camera_object[:3, 3], fit.T_camera_object[:3, 1]
    ends = [centre + s * shape.height_m / 2.0 * axis for s in (1.0, -1.0)]
    sides = [side * -np.sign(side @ centre) for side in (left, right)]
    closed = cylinder_from_sides(*sides, tuple(end[:2] / end[2] for end in ends), shape)
    assert np.allclose(closed, fit.T_camera_object, atol=1e-6)


@pytest.mark.parametrize("turn", [0, 1, 2, 3])
def test_homography_of_a_rectangle_against_pnp(turn):
    T = board_pose((0.1, -0.05, 0.9), 0.4, 0.5, -0.2)
    points, _ = outline_in_camera(BOARD, T)
    corners = (points[:, :2] / points[:, 2:])[:4]
    found = np.empty((3, 4))
    half = BOARD.width_m / 2.0, BOARD.height_m / 2.0
    assert rectangle_from_quadrilateral(*half, np.roll(corners, turn, axis=0), turn, found)
    assert np.allclose(found, T[:3], atol=1e-9)
    on_board = np.array([(-1, 1, 0), (1, 1, 0), (1, -1, 0), (-1, -1, 0)]) * (*half, 0.0)
    _, turns, t = cv2.solvePnP(on_board, corners, np.eye(3), None, flags=cv2.SOLVEPNP_IPPE)
    assert np.allclose(found[:, 3], t[:, 0], atol=1e-6)
    assert np.allclose(found[:, :3], cv2.Rodrigues(turns)[0], atol=1e-5)
    assert not rectangle_from_quadrilateral(*half, corners[::-1].copy(), 0, found)


def test_the_mirror_reading_looks_the_same_from_afar():
    T = board_pose((2.0, -1.0, 200.0), 0.4, 0.5, -0.2)
    other = np.empty((3, 4))
    mirror(np.ascontiguousarray(T[:3]), other)
    assert np.allclose(other[:, :3] @ other[:, :3].T, np.eye(3))
    assert np.linalg.det(other[:, :3]) > 0.0
    assert other[:, 2] @ T[:3, 2] < 0.9
    outlines = [outline_in_camera(BOARD, np.vstack([P[:3], (0, 0, 0, 1)]))[0] for P in (T, other)]
    seen = [points[:, :2] / points[:, 2:] for points in outlines]
    assert np.abs(seen[0] - seen[1]).max() < 0.002 * np.ptp(seen[0], axis=0).max()


@pytest.mark.parametrize(("shape", "T"), POSES)
@pytest.mark.parametrize("distortion", [None, (-0.1, 0.05, 0.001, -0.002, 0.01)])
def test_an_outline_is_seen_where_opencv_projects_it(shape, T, distortion):
    camera = msgspec.structs.replace(CAMERA, distortion=distortion)
    points, _ = outline_in_camera(shape, T)
    assert np.allclose(outline_px(shape, T, camera), camera.project(points), atol=1e-6)
    ends = [0, ARC, ARC + 1, 2 * ARC + 1] if shape is CAN else [0, 1, 2, 3]
    assert np.allclose(corners_px(shape, T, camera), camera.project(points[ends]), atol=1e-6)


def test_small_symmetric_systems_equal_numpys():
    rng = np.random.default_rng(5)
    for n in (3, 6):
        root = rng.normal(size=(n, n))
        A, b, x = root @ root.T + 0.1 * np.eye(n), rng.normal(size=n), np.empty(n)
        expected = np.linalg.solve(A, b)
        assert solve_symmetric(A.copy(), b, x)
        assert np.allclose(x, expected)
        assert solve_symmetric(A.copy(), b, b)
        assert np.allclose(b, expected)
        inverse = np.empty((n, n))
        assert invert_symmetric(A.copy(), inverse)
        assert np.allclose(inverse, np.linalg.inv(A))
        assert (inverse == inverse.T).all()
    assert not solve_symmetric(-np.eye(3), np.ones(3), np.empty(3))
    assert not invert_symmetric(-np.eye(3), np.empty((3, 3)))

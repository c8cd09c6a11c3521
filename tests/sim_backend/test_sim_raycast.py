"""Pictures against the geometry they show, worked out another way."""

from __future__ import annotations

import math

import cv2
import msgspec
import numpy as np
import pytest

from hal.nao.cameras import nominal_pinhole
from hal.scenario import Scenario, SceneSection, ThingSection
from sim_backend.colour import linear_from_srgb
from sim_backend.poses import Matrix, inverse, rot_x, rot_y, rot_z, transform
from sim_backend.quiet import pybullet
from sim_backend.studio import Studio
from sim_backend.viewpoint import looking

BARE = SceneSection(table=False)
CAN = Scenario(scene=BARE)
BOARD = Scenario(object=ThingSection(kind="rectangle"), scene=BARE)
VIEWS = [
    ((0.75, 0.05, 0.50), 0.0),
    ((0.60, -0.35, 0.75), 0.2),
    ((0.90, 0.25, 0.30), -0.4),
]


def view(studio: Studio, eye: tuple[float, float, float], roll: float) -> Matrix:
    x, y, z = studio.T_world_object[:3, 3]
    T = looking(eye, (x + 0.02, y - 0.03, z + 0.01))
    return T @ transform(rot_z(roll), (0.0, 0.0, 0.0))


def projected(points_in_world: np.ndarray, T_world_camera: Matrix) -> np.ndarray:
    lens = nominal_pinhole("v6", 640, 480)
    points = (points_in_world - T_world_camera[:3, 3]) @ T_world_camera[:3, :3]
    scaled = points[:, :2] / points[:, 2:] * np.array([lens.fx, lens.fy])
    return scaled + np.array([lens.cx, lens.cy])


def hull_mask(points: np.ndarray) -> np.ndarray:
    """Convex hull filled at 8 times the resolution, then the share of each pixel."""
    fine = np.zeros((480 * 8, 640 * 8), dtype=np.uint8)
    hull = cv2.convexHull(((points + 0.5) * 8 - 0.5).astype(np.float32))
    cv2.fillConvexPoly(fine, np.rint(hull).astype(np.int32), 255)
    return cv2.resize(fine, (640, 480), interpolation=cv2.INTER_AREA) / 255.0


def outline_of_can(studio: Studio) -> np.ndarray:
    thing = studio.scenario.object
    angles = np.linspace(0.0, 2.0 * math.pi, 720, endpoint=False)
    ring = np.stack([np.cos(angles), np.sin(angles), np.zeros_like(angles)], 1) * thing.radius_m
    half = np.array([0.0, 0.0, thing.height_m / 2.0])
    return np.concatenate([ring - half, ring + half]) + thing.position


def outline_of_board(studio: Studio) -> np.ndarray:
    thing = studio.scenario.object
    a, b = thing.width_m / 2.0, thing.height_m / 2.0
    corners = np.array([[-a, b, 0, 1], [a, b, 0, 1], [a, -b, 0, 1], [-a, -b, 0, 1]])
    return (corners @ studio.T_world_object.T)[:, :3]


@pytest.mark.parametrize(("eye", "roll"), VIEWS)
@pytest.mark.parametrize("scenario", [CAN, BOARD], ids=["can", "board"])
def test_mask_is_the_projected_outline(
    scenario: Scenario, eye: tuple[float, float, float], roll: float
) -> None:
    studio = Studio(scenario)
    T = view(studio, eye, roll)
    points = outline_of_can(studio) if scenario is CAN else outline_of_board(studio)
    wanted, found = hull_mask(projected(points, T)), studio.coverage_at(T)
    assert np.abs(found - wanted).max() < 0.35
    assert abs(found.sum() / wanted.sum() - 1.0) < 0.005
    moments = [cv2.moments(mask.astype(np.float32)) for mask in (wanted, found)]
    centres = [(m["m10"] / m["m00"], m["m01"] / m["m00"]) for m in moments]
    assert centres[1] == pytest.approx(centres[0], abs=0.06)


@pytest.mark.parametrize("scenario", [CAN, BOARD], ids=["can", "board"])
def test_mask_agrees_with_pybullets_own_renderer(scenario: Scenario) -> None:
    studio = Studio(scenario)
    T = view(studio, (0.70, -0.12, 0.60), 0.1)
    ours, theirs = studio.mask_at(T) > 0, pybullet_mask(studio, T)
    assert (ours & theirs).sum() / (ours | theirs).sum() > 0.97


def pybullet_mask(studio: Studio, T_world_camera: Matrix) -> np.ndarray:
    thing, client = studio.scenario.object, pybullet.connect(pybullet.DIRECT)
    if thing.kind == "cylinder":
        shape = pybullet.createCollisionShape(
            pybullet.GEOM_CYLINDER, radius=thing.radius_m, height=thing.height_m,
            physicsClientId=client,
        )  # fmt: skip
    else:
        half = [0.0005, thing.width_m / 2.0, thing.height_m / 2.0]
        shape = pybullet.createCollisionShape(
            pybullet.GEOM_BOX, halfExtents=half, physicsClientId=client
        )
    pybullet.createMultiBody(0, shape, basePosition=thing.position, physicsClientId=client)
    lens, near, far = nominal_pinhole("v6", 640, 480), 0.05, 20.0
    a, b = near * 320.0 / lens.fx, near * 240.0 / lens.fy
    projection = pybullet.computeProjectionMatrix(-a, a, -b, b, near, far)
    eye, axes = T_world_camera[:3, 3], T_world_camera[:3, :3]
    looks = pybullet.computeViewMatrix(
        eye.tolist(), (eye + axes[:, 2]).tolist(), (-axes[:, 1]).tolist()
    )
    picture = pybullet.getCameraImage(640, 480, looks, projection, physicsClientId=client)
    pybullet.disconnect(physicsClientId=client)
    return np.reshape(picture[4], (480, 640)) >= 0


@pytest.mark.parametrize("scenario", [CAN, BOARD], ids=["can", "board"])
def test_before_its_own_room_an_object_is_as_in_it(scenario: Scenario) -> None:
    speck = {"radius_m": 1e-4, "height_m": 1e-4} if scenario is CAN else {"width_m": 1e-4}
    if scenario is BOARD:
        speck["height_m"] = 1e-4
    thing = msgspec.structs.replace(scenario.object, **speck)
    studio, empty = Studio(scenario), Studio(msgspec.structs.replace(scenario, object=thing))
    T = view(studio, (0.70, -0.12, 0.60), 0.1)
    poses = np.stack([T @ transform(rot_y(0.01 * n), (0.0, 0.0, 0.0)) for n in range(3)])
    whole = studio.frame_at(T, poses).astype(int)
    before = studio.frame_before(empty.light_at(T, poses), T, poses).astype(int)
    off = np.abs(whole - before).max(axis=-1)
    # a panel behind a board is seen by the speck's room alone
    near = cv2.dilate(studio.mask_at(T, poses), np.ones((9, 9), np.uint8)) > 0
    assert off[near].mean() < 0.2
    assert np.quantile(off[near], 0.99) <= 2


def test_a_backdrop_of_another_size_is_refused() -> None:
    studio = Studio(CAN)
    with pytest.raises(ValueError, match="size"):
        studio.frame_before(np.zeros((10, 10, 3), np.float32), studio.T_world_object)


def test_what_stands_before_the_object_hides_it() -> None:
    studio = Studio(CAN)
    T = view(studio, (0.60, 0.0, 0.4575), 0.0)
    screen = ThingSection(kind="rectangle", width_m=1.0, height_m=0.44, position=(0.9, 0.0, 0.22))
    hidden = Studio(msgspec.structs.replace(CAN, distractor=(screen,)))
    low, high = studio.coverage_at(T), hidden.coverage_at(T)
    assert 0.0 < high.sum() < low.sum()
    rows = np.nonzero(high.sum(axis=1))[0]
    assert rows.max() < np.nonzero(low.sum(axis=1))[0].max()


def test_blur_is_the_mean_of_sharp_pictures_in_linear_light() -> None:
    studio = Studio(Scenario(), width=160, height=120)
    T = view(studio, (0.75, 0.05, 0.50), 0.0)
    poses = np.stack([T @ transform(rot_y(0.02 * n), (0.001 * n, 0.0, 0.0)) for n in range(5)])
    blurred = studio.light_at(T, poses)
    shares = (np.arange(64) + 0.5) / 64 * 0.08
    sharp = [
        studio.light_at(T @ transform(rot_y(s), (0.05 * s, 0.0, 0.0))).astype(np.float64)
        for s in shares
    ]
    mean = np.mean(sharp, axis=0)
    assert np.abs(blurred - studio.light_at(poses[2])).max() > 0.2
    assert np.abs(blurred - mean).mean() < 0.004
    assert np.abs(blurred - mean).max() < 0.05


def test_a_still_exposure_is_the_sharp_picture() -> None:
    studio = Studio(Scenario(), width=160, height=120)
    T = view(studio, (0.75, 0.05, 0.50), 0.0)
    assert (studio.light_at(T, np.stack([T] * 3)) == studio.light_at(T)).all()


def test_colour_is_that_of_the_scenario_under_its_light() -> None:
    thing = ThingSection(kind="rectangle", colour=(200, 100, 50))
    levels = []
    for light in (0.5, 1.0):
        studio = Studio(Scenario(object=thing, scene=SceneSection(light=light)))
        T = view(studio, (1.0, 0.0, 0.5), 0.0)
        inside = studio.coverage_at(T) == 1.0
        levels.append(studio.light_at(T)[inside].astype(float).mean(axis=0))
    assert levels[1] == pytest.approx(2.0 * levels[0], rel=1e-5)
    ratio = levels[1] / linear_from_srgb(np.array([200.0, 100.0, 50.0]))
    assert ratio == pytest.approx(ratio[0], rel=1e-4)
    assert 0.5 < ratio[0] <= 1.0


def test_a_texture_stands_upright_and_is_not_mirrored(tmp_path) -> None:
    quarters = np.zeros((64, 64, 3), dtype=np.uint8)
    quarters[:32, :32], quarters[:32, 32:] = (255, 0, 0), (0, 255, 0)
    quarters[32:, :32], quarters[32:, 32:] = (0, 0, 255), (255, 255, 255)
    cv2.imwrite(str(tmp_path / "quarters.png"), quarters[..., ::-1])
    thing = ThingSection(kind="rectangle", texture="quarters.png")
    studio = Studio(Scenario(object=thing), folder=tmp_path)
    T = view(studio, (1.0, 0.0, 0.5), 0.0)
    x, y = projected(studio.T_world_object[None, :3, 3], T)[0]
    rgb = studio.rgb_at(T).astype(int)
    for dx, dy, channels in ((-20, -20, [0]), (20, -20, [1]), (-20, 20, [2]), (20, 20, [0, 1, 2])):
        pixel = rgb[round(y + dy), round(x + dx)]
        assert [n for n in range(3) if pixel[n] > 100] == channels


def test_a_can_shows_the_middle_of_its_texture_to_where_it_faces(tmp_path) -> None:
    halves = np.zeros((32, 128, 3), dtype=np.uint8)
    halves[:, 64:] = 255
    cv2.imwrite(str(tmp_path / "halves.png"), halves)
    studio = Studio(Scenario(object=ThingSection(texture="halves.png")), folder=tmp_path)
    T = looking((0.8, 0.0, 0.4575), (1.2, 0.0, 0.4575))
    rgb, mask = studio.rgb_at(T), studio.mask_at(T) > 0
    columns = np.nonzero(mask.any(axis=0))[0]
    middle = round(columns.mean())
    assert rgb[230, middle - 15].max() < 60
    assert rgb[230, middle + 15].min() > 120


def test_the_camera_may_be_anywhere_in_the_room() -> None:
    studio = Studio(Scenario(scene=SceneSection(background="clutter")), width=160, height=120)
    rng = np.random.default_rng(8)
    for _ in range(30):
        R = rot_z(rng.uniform(-3, 3)) @ rot_x(rng.uniform(-3, 3))
        eye = (rng.uniform(-1.0, 1.9), rng.uniform(-1.5, 1.5), rng.uniform(0.05, 2.5))
        light = studio.light_at(transform(R, eye))
        assert np.isfinite(light).all()
        # floor, walls and ceiling close the room: there is no ray without an end
        assert light.max(axis=2).min() > 0.0


def test_object_frame_is_right_handed_and_faces_the_robot() -> None:
    studio = Studio(BOARD)
    R = studio.T_world_object[:3, :3]
    assert np.linalg.det(R) == pytest.approx(1.0)
    assert R[:, 2] == pytest.approx((-1.0, 0.0, 0.0), abs=1e-9)
    assert R[:, 1] == pytest.approx((0.0, 0.0, 1.0), abs=1e-9)
    corner = (inverse(looking((1.0, 0, 0.5), (1.6, 0, 0.5))) @ studio.T_world_object)[:3, 0]
    assert corner == pytest.approx((1.0, 0.0, 0.0), abs=1e-9)

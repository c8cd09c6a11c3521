"""How the camera moves, against poses that were moved by hand."""

import math
from dataclasses import replace

import cv2
import numpy as np
import pytest

from hal.nao.joints import JOINT_INDEX
from hal.nao.postures import posture
from hal.types import BodyState, PlanarMotion
from naod.geometry.camera import nominal_camera
from naod.geometry.transforms import inverse, planar, transform
from naod.localisation.base_frame import T_base_camera
from naod.localisation.body_model import BodyModel
from naod.localisation.camera_motion import CameraMotion, camera_motion, motion_px, rotation_vector

MODEL = BodyModel("v6", "top")
CAMERA = nominal_camera("v6", 640, 480)
SPAN_S = 0.02


def body(stamp_ns=0, gyro=(0.0, 0.0, 0.0), **angles):
    measured = posture("StandInit").copy()
    for name, angle in angles.items():
        measured[JOINT_INDEX[name]] = angle
    return BodyState(
        stamp_ns=stamp_ns,
        angles_rad=measured,
        gyro_rad_s=np.array(gyro),
        accel_m_s2=np.array([0.0, 0.0, 9.81]),
        torso_roll_pitch_rad=np.zeros(2),
        fsr_kg=np.full(8, 0.65),
        battery=0.9,
        temperature_max_c=40.0,
    )


def in_base(state):
    return T_base_camera(MODEL.frames(state.angles_rad), state.foot_load_kg)


def seen_to_move(T_world_before, T_world_after, point_in_world):
    """Pixels by which a point moves from one camera to another."""
    ends = [inverse(T) @ np.append(point_in_world, 1.0) for T in (T_world_before, T_world_after)]
    before, after = CAMERA.project(np.array(ends)[:, :3])
    return after - before


def test_rotation_vector_is_that_of_opencv():
    rng = np.random.default_rng(0)
    for angle in (1e-12, 1e-6, 0.01, 0.5, 2.0, 3.0):
        axis = rng.normal(size=3)
        vector = angle * axis / np.linalg.norm(axis)
        assert rotation_vector(cv2.Rodrigues(vector)[0]) == pytest.approx(vector, abs=1e-9)


def test_a_head_that_turns_moves_the_picture_as_its_cameras_do():
    """Yaw at 2 rad/s and pitch at -1: an exposure of 20 ms, against the chain of joints itself."""
    half = 0.5 * SPAN_S
    before = body(0, HeadYaw=0.3 - 2.0 * half, HeadPitch=0.1 + half)
    after = body(round(SPAN_S * 1e9), HeadYaw=0.3 + 2.0 * half, HeadPitch=0.1 - half)
    now = in_base(body(0, HeadYaw=0.3, HeadPitch=0.1))
    point = now[:3, 3] + now[:3, :3] @ (0.05, -0.03, 0.8)
    motion = camera_motion(MODEL, before, after)
    moved = motion_px(motion, inverse(now)[:3, :3] @ (point - now[:3, 3]), CAMERA, SPAN_S)
    true = seen_to_move(in_base(before), in_base(after), point)
    assert np.hypot(*true) > 20.0
    assert moved == pytest.approx(true, abs=0.15)


def test_a_body_that_leans_and_walks_moves_the_picture_too():
    """The whole robot turned about its feet and carried along, the joints at rest."""
    lean, velocity = np.array([0.2, 0.3, -0.4]), (0.1, -0.05, 0.0)
    state = body()
    T_base = in_base(state)
    frames = MODEL.frames(state.angles_rad)
    R_torso_base = (frames.T_torso_camera @ inverse(T_base))[:3, :3]
    late = body(round(SPAN_S * 1e9), gyro=R_torso_base @ lean)
    motion = camera_motion(MODEL, replace(state, gyro_rad_s=late.gyro_rad_s), late,
                           PlanarMotion(*velocity))  # fmt: skip
    worlds = [
        transform(cv2.Rodrigues(lean * t)[0], np.array(velocity) * t) @ T_base
        for t in (-0.5 * SPAN_S, 0.5 * SPAN_S)
    ]
    point = T_base[:3, 3] + T_base[:3, :3] @ (0.1, 0.1, 0.6)
    moved = motion_px(motion, np.array([0.1, 0.1, 0.6]), CAMERA, SPAN_S)
    true = seen_to_move(*worlds, point)
    assert np.hypot(*true) > 4.0
    assert moved == pytest.approx(true, abs=0.05)


def test_a_turn_of_the_walk_is_not_counted_twice():
    """The gyroscope feels the walk turn; the walk's own figure of it is left out."""
    yaw = 0.5
    frames = MODEL.frames(posture("StandInit"))
    R_torso_base = (frames.T_torso_camera @ inverse(in_base(body())))[:3, :3]
    gyro = R_torso_base @ (0.0, 0.0, yaw)
    motion = camera_motion(
        MODEL, body(0, gyro), body(10_000_000, gyro), PlanarMotion(0.0, 0.0, yaw)
    )
    worlds = [planar(0.0, 0.0, yaw * t) @ in_base(body()) for t in (-0.01, 0.01)]
    point = in_base(body()) @ np.array([0.0, 0.0, 0.7, 1.0])
    moved = motion_px(motion, np.array([0.0, 0.0, 0.7]), CAMERA, 0.02)
    assert moved == pytest.approx(seen_to_move(*worlds, point[:3]), abs=0.05)


def test_states_of_one_moment_say_nothing():
    assert camera_motion(MODEL, body(), body()) is None


def test_nothing_behind_the_camera_moves_through_the_picture():
    still = CameraMotion(np.zeros(3), np.array([0.0, 1.0, 0.0]))
    assert motion_px(still, np.array([0.0, 0.0, -1.0]), CAMERA, 0.01) == (0.0, 0.0)
    assert motion_px(still, np.array([0.0, 0.0, 1.0]), CAMERA, 0.01)[0] == pytest.approx(
        -0.01 * CAMERA.fx, rel=1e-3
    )
    assert math.isfinite(motion_px(still, np.zeros(3), CAMERA, 0.01)[0])

"""The object in the base frame from one picture, and how sure of it one can be."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from naod.geometry.transforms import Matrix, Vector
from naod.localisation.camera_motion import CameraMotion
from naod.localisation.ego import cartesian_jacobian, ego_pose
from naod.localisation.looks import Look
from naod.pose.result import ObjectPose

COMMON_SHARE = 0.9
"""Of a pose's stated variance, what pictures from one place have in common: between such pictures
of a can, their noise alone differing, positions scattered by a tenth of it or less."""

JITTER_RAD = 0.001
"""How much the measured angles turn the camera to and fro from look to look: steps of encoders."""

LEANING_RAD = 0.003
"""How much sag of the joints, soles and the camera's mounting turn it, the same in every look."""

CLOCK_JITTER_S = 0.004
CLOCK_OFFSET_S = 0.004
"""How well the time of a picture is known in that of the angles, from look to look and at all."""

SHARP_PX = 2.5
"""Width of a step without motion: blur of less does not count."""


@dataclass(frozen=True, slots=True)
class Placement:
    """T_base_object (4, 4), and covariances (6, 6) of translation (m) and rotation (rad) about the
    object's origin along the base's axes: `own` is new in every picture, `shared` is the same in
    all from one stance. `blur_px`: how far the object moved through the picture meanwhile.
    """

    stamp_ns: int
    T_base_object: Matrix
    T_base_camera: Matrix
    own: NDArray[np.float64]
    shared: NDArray[np.float64]
    blur_px: float

    def look(self) -> Look | None:
        """On the ego-cylinder (equation 6); None when a number is not finite."""
        T = self.T_base_object
        J = cartesian_jacobian(T, np.eye(4))
        own, shared = J @ self.own @ J.T, J @ self.shared @ J.T
        if not (np.isfinite(T).all() and np.isfinite(own).all() and np.isfinite(shared).all()):
            return None
        return Look(self.stamp_ns, ego_pose(T), own, shared, self.blur_px)


def placed(
    stamp_ns: int,
    pose: ObjectPose,
    T_base_camera: Matrix,
    motion: CameraMotion | None = None,
    blur_px: float = 0.0,
    edges_blur_px: float = 0.0,
) -> Placement:
    """The pose carried into the base frame (equation 7), with what body and clock add.

    `blur_px` is predicted from the body's motion; of it, `edges_blur_px` is in the pose's
    covariance already.
    """
    T = T_base_camera @ pose.T_camera_object
    R = both(T_base_camera[:3, :3])
    common = COMMON_SHARE * pose.covariance
    scattered = blurred(pose.covariance, blur_px, edges_blur_px) - common
    at = T[:3, 3]
    neck, feet = turned(at - T_base_camera[:3, 3]), turned(at)
    body = neck @ neck.T + feet @ feet.T
    late = np.zeros(6) if motion is None else lateness(at, T_base_camera, motion)
    delay = np.outer(late, late)
    own = R @ scattered @ R.T + JITTER_RAD**2 * body + CLOCK_JITTER_S**2 * delay
    shared = R @ common @ R.T + LEANING_RAD**2 * body + CLOCK_OFFSET_S**2 * delay
    return Placement(stamp_ns, T, T_base_camera, own, shared, max(blur_px, edges_blur_px))


def blurred(
    covariance: NDArray[np.float64], blur_px: float, edges_blur_px: float
) -> NDArray[np.float64]:
    """Widened by as much of the predicted blur as the edges themselves did not show."""
    unseen = max(blur_px**2 - edges_blur_px**2, 0.0)
    return np.asarray(covariance * (1.0 + unseen / SHARP_PX**2), dtype=np.float64)


def both(R: Matrix) -> Matrix:
    """(6, 6): translation and rotation turned alike."""
    return np.asarray(np.kron(np.eye(2), R), dtype=np.float64)


def turned(arm: Vector) -> Matrix:
    """(6, 3): what a small rotation about a place does to an object at the end of an arm."""
    x, y, z = (float(v) for v in arm)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.vstack([-cross, np.eye(3)])


def lateness(at: Vector, T_base_camera: Matrix, motion: CameraMotion) -> Vector:
    """(6,): what a second between picture and angles would do to the object in the base frame."""
    R = T_base_camera[:3, :3]
    turn = R @ motion.turn_rad_s
    late = turned(at - T_base_camera[:3, 3]) @ turn
    late[:3] += R @ motion.velocity_m_s
    return np.asarray(late, dtype=np.float64)

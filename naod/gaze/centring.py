"""objectIsCentered: where the head has to point so that the object is in the middle (Alg. 1)."""

from __future__ import annotations

import math

from hal.nao.cameras import MOUNTS
from hal.nao.head_limits import clip_head
from hal.types import CameraName, HeadAngles
from naod.geometry.transforms import Matrix, Vector, wrap

# the neck's range ends here or there; closer than this to the best it can do is centred
_STOP_RAD = math.radians(1.0)


def offset_rad(ray_in_camera: Vector) -> float:
    """Angle between the camera's optical axis and a ray (3,) in its frame."""
    x, y, z = (float(v) for v in ray_in_camera)
    return math.atan2(math.hypot(x, y), z)


def head_towards(
    ray_in_camera: Vector, T_torso_camera: Matrix, now: HeadAngles, camera: CameraName, gain: float
) -> HeadAngles:
    """Head angles, within their limits, that turn the optical axis towards a seen ray.

    `now` are the angles at the time of the picture, so that a late picture does not make the head
    swing: what is sent is a place, not a push. `gain` 1 turns all the way.
    """
    x, y, z = (float(v) for v in T_torso_camera[:3, :3] @ ray_in_camera)
    yaw = math.atan2(y, x)
    pitch = -math.atan2(z, math.hypot(x, y)) - MOUNTS[camera].pitch_down_rad
    return clip_head(
        HeadAngles(
            now.yaw_rad + gain * wrap(yaw - now.yaw_rad),
            now.pitch_rad + gain * (pitch - now.pitch_rad),
        )
    )


def is_centred(
    ray_in_camera: Vector, now: HeadAngles, wanted: HeadAngles, tolerance_rad: float
) -> bool:
    """Whether the object is in the middle, or as near to it as the neck allows."""
    if offset_rad(ray_in_camera) <= tolerance_rad:
        return True
    left = max(abs(wanted.yaw_rad - now.yaw_rad), abs(wanted.pitch_rad - now.pitch_rad))
    return left <= _STOP_RAD

"""NAOqi's numbers and names. Sources: `nao_cameras.yaml`, naoqi_ids; `naoqi_api.yaml`."""

from __future__ import annotations

from hal.nao.cameras import READOUT_S
from hal.types import CameraName

CAMERA_IDS: dict[CameraName, int] = {"top": 0, "bottom": 1}
RESOLUTION_NAMES: dict[tuple[int, int], str] = {
    (160, 120): "kQQVGA",
    (320, 240): "kQVGA",
    (640, 480): "kVGA",
    (1280, 960): "k4VGA",
}
RESOLUTIONS: dict[str, int] = {"kQQVGA": 0, "kQVGA": 1, "kVGA": 2, "k4VGA": 3}
COLOUR_SPACES: dict[str, int] = {"kYuvColorSpace": 0, "kYUV422ColorSpace": 9, "kYUVColorSpace": 10}
YUV422 = COLOUR_SPACES["kYUV422ColorSpace"]
BYTES_PER_PIXEL = 2

PARAMETERS: dict[str, int] = {
    "kCameraGainID": 6,
    "kCameraAutoExpositionID": 11,
    "kCameraAutoWhiteBalanceID": 12,
    "kCameraExposureID": 17,
    "kCameraWhiteBalanceID": 33,
    "kCameraAutoFocusID": 40,
    "kCameraFocusID": 43,
}
NO_PARAMETER = 0xDEAD404
"""What getParameter returns for one that the camera has not."""

_END_OF_FRAME_S: dict[CameraName, float] = {"top": 0.039, "bottom": 0.036}
"""How long after the first row's exposure a V6 picture is stamped (B-Human, timing_v6)."""

STAMP_AFTER_MIDDLE_S: dict[CameraName, float] = {
    name: _END_OF_FRAME_S[name] - READOUT_S[name] / 2.0 for name in CAMERA_IDS
}
"""From the middle row's exposure to the picture's stamp. Nothing is published for V4 and V5, whose
cameras are read out in the same way; V6's figures are taken."""

CYCLE_S = 0.020
"""ALMotion measures the joints this often."""

STIFFNESS_MIN = 0.6
"""NAOqi walks only when every joint of the legs is stiffer than this."""
LEG_JOINTS: tuple[str, ...] = tuple(
    side + joint
    for side in "LR"
    for joint in ("HipYawPitch", "HipRoll", "HipPitch", "KneePitch", "AnklePitch", "AnkleRoll")
)

SPEED_MAX = (0.095, 0.062, 0.83)
"""m/s, m/s, rad/s with the default step lengths (`walk_facts.yaml`, naoqi_derived)."""
TRAVEL_MAX_M = 2.0
"""More than this is no step; `moveTo` itself knows no limit."""

UPRIGHT_FAMILIES = ("Standing", "Unknown", "")
"""Posture families a walk may begin in; while it settles NAOqi may not know the family."""

"""The head by setAngles: the newest call wins, nothing waits for its end."""

from __future__ import annotations

import math
import threading

from hal.errors import HalError, MotionRefusedError
from hal.nao.head_limits import clip_head
from hal.nao.joints import JOINT_INDEX, JOINTS
from hal.naoqi.channel import Channel
from hal.naoqi.session import Call
from hal.naoqi.walk import NaoqiWalk
from hal.types import HeadAngles

NAMES = ["HeadYaw", "HeadPitch"]
_FASTEST_RAD_S = max(JOINTS[JOINT_INDEX[name]].speed_max_rad_s for name in NAMES)
EARLY_S = 0.02
"""A refusal that comes within this time is told at once, a later one by the next call."""
SILENT_S = 1.0
STIFFEN_S = 1.0
LIMP = 0.1


class NaoqiHead:
    """`hal.protocols.Head`."""

    def __init__(self, channel: Channel, walk: NaoqiWalk) -> None:
        self._channel, self._walk = channel, walk
        self._lock = threading.Lock()
        self._last: Call | None = None
        self._stiffening: Call | None = None
        self._was_limp = False

    def look(self, target: HeadAngles, speed_rad_s: float) -> HeadAngles:
        """Turn towards `target`; the newest call wins. Returns the target after clipping.

        A limp head is stiffened first, gently. Raises MotionRefusedError.
        """
        if not (math.isfinite(speed_rad_s) and speed_rad_s > 0.0):
            raise MotionRefusedError(f"head speed is not a positive number: {speed_rad_s}")
        sent = clip_head(target)
        objection = self._walk.head_objection()
        if objection is not None:
            raise MotionRefusedError(objection)
        fraction = min(1.0, speed_rad_s / _FASTEST_RAD_S)
        with self._lock:
            try:
                self._send(sent, fraction)
            except MotionRefusedError:
                raise
            except HalError as error:
                raise MotionRefusedError(str(error)) from None
        return sent

    def _send(self, sent: HeadAngles, fraction: float) -> None:
        last, self._last = self._last, None
        if last is not None:
            if not last.done and last.age_s < SILENT_S:
                self._last = last
                raise MotionRefusedError("NAOqi has not taken the head's last target yet")
            last.result(0.0)
        session = self._channel.session
        self._stiffen()
        angles = [sent.yaw_rad, sent.pitch_rad]
        call = session.post("ALMotion", "setAngles", NAMES, angles, fraction)
        self._last = call
        if call.wait(EARLY_S):
            self._last = None
            call.result(0.0)

    def _stiffen(self) -> None:
        """See to it that the motors are on; a jump of the torque would jerk the head."""
        stiffness = self._walk.stance.readiness.head_stiffness
        limp = stiffness is not None and stiffness < LIMP
        if not limp or (self._stiffening is not None and not self._stiffening.done):
            return
        self._was_limp = True
        self._stiffening = self._channel.session.post(
            "ALMotion", "stiffnessInterpolation", "Head", 1.0, STIFFEN_S
        )

    def relax(self) -> None:
        """Let go of a head that was limp before us. Raises HalError."""
        if self._was_limp and self._walk.stance.readiness.awake is False:
            self._channel.session.call("ALMotion", "setStiffnesses", "Head", 0.0)
        self._was_limp = False

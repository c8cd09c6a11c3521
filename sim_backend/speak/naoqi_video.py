"""ALVideoDevice on the simulated head. Sources: `naoqi_api.yaml`, `nao_cameras.yaml`."""

from __future__ import annotations

import threading
from dataclasses import dataclass

import qi

from hal.nao.cameras import READOUT_S
from hal.types import CameraName, NaoVersion
from sim_backend.camera import SimCamera
from sim_backend.speak.naoqi_robot import PeerRobot

CAMERAS: dict[int, CameraName] = {0: "top", 1: "bottom"}
SIZES = {0: (160, 120), 1: (320, 240), 2: (640, 480), 3: (1280, 960)}
YUV422 = 9
SAME_NAME_MAX = 6
NO_PARAMETER = 0xDEAD404
AUTO_EXPOSITION, EXPOSURE, GAIN = 11, 17, 6

# a stamp is taken when the last row has been read out (V6, timing_v6)
_DELAY_S: dict[CameraName, float] = {"top": 0.039, "bottom": 0.036}

# number: value at first, smallest, greatest; what automatic exposure has found counts as the value
_V6 = {
    0: (0, -255, 255),
    1: (32, 0, 255),
    2: (64, 0, 255),
    3: (0, -180, 180),
    6: (52, 0, 1023),
    11: (1, 0, 1),
    12: (1, 0, 1),
    17: (310, 0, 65535),
    24: (4, 0, 9),
    40: (1, 0, 1),
    43: (75, 0, 250),
}
_V5 = {
    0: (55, 0, 255),
    1: (32, 16, 64),
    6: (64, 32, 255),
    11: (1, 0, 1),
    12: (1, 0, 1),
    17: (120, 0, 333),
    33: (4100, 2700, 6500),
}


@dataclass(frozen=True, slots=True)
class Subscription:
    """Somebody who gets pictures."""

    camera: SimCamera
    index: int
    lock: threading.Lock


class Video:
    """What ALVideoDevice does; `video_service` gives it the form in which pictures cross."""

    def __init__(self, robot: PeerRobot) -> None:
        self._robot = robot
        self._subscriptions: dict[str, Subscription] = {}
        self._values = {index: _values(robot.version) for index in CAMERAS}

    def subscribeCamera(self, name: str, index: int, size: int, space: int, fps: int) -> str:
        """A handle, or nothing if that cannot be."""
        self._robot.enter("ALVideoDevice.subscribeCamera")
        possible = index in CAMERAS and size in SIZES and space == YUV422 and 1 <= fps <= 30
        handles = [f"{name}_{n}" for n in range(SAME_NAME_MAX)]
        with self._robot.lock:
            free = [handle for handle in handles if handle not in self._subscriptions]
            if not possible or not free:
                return ""
            camera = self._robot.sim.open_camera(CAMERAS[index], SIZES[size], fps)
            self._subscriptions[free[0]] = Subscription(camera, index, threading.Lock())
        return free[0]

    def unsubscribe(self, handle: str) -> bool:
        """End a subscription."""
        self._robot.enter("ALVideoDevice.unsubscribe")
        with self._robot.lock:
            return self._subscriptions.pop(handle, None) is not None

    def getSubscribers(self) -> list[str]:
        """All handles."""
        self._robot.enter("ALVideoDevice.getSubscribers")
        with self._robot.lock:
            return sorted(self._subscriptions)

    def releaseImage(self, handle: str) -> bool:
        """Nothing to do; whether there is such a subscription."""
        self._robot.enter("ALVideoDevice.releaseImage")
        return handle in self._subscriptions

    def picture(self, handle: str) -> tuple[object, ...]:
        """The newest picture's twelve values; empty if there is none."""
        self._robot.enter("ALVideoDevice.getImageRemote")
        subscription = self._subscriptions.get(handle)
        if subscription is None:
            return ()
        with subscription.lock:
            frame = subscription.camera.latest(1.0)
        if frame is None:
            return ()
        self._robot.picture_ns = frame.stamp_ns
        after_s = _DELAY_S[frame.camera] - READOUT_S[frame.camera] / 2.0
        told = self._robot.told
        offset_s = told.clock_offset_s + told.picture_offset_s + after_s
        stamp_us = (frame.stamp_ns + round(offset_s * 1e9)) // 1000
        return (
            frame.width, frame.height, 2, YUV422, stamp_us // 1_000_000, stamp_us % 1_000_000,
            frame.yuyv.tobytes(), subscription.index, 0.49, 0.38, -0.49, -0.38,
        )  # fmt: skip

    def getParameter(self, index: int, number: int) -> int:
        """A control's value."""
        self._robot.enter("ALVideoDevice.getParameter")
        found = self._values.get(index, {}).get(number)
        return NO_PARAMETER if found is None else found

    def getParameterRange(self, index: int, number: int) -> list[int]:
        """Smallest and greatest."""
        del index
        found = _ranges(self._robot.version).get(number)
        return [] if found is None else [found[1], found[2]]

    def setParameter(self, index: int, number: int, value: int) -> bool:
        """Whether it took: exposure and gain cannot be set while they are automatic."""
        self._robot.enter("ALVideoDevice.setParameter")
        values, ranges = self._values.get(index, {}), _ranges(self._robot.version)
        if number not in values or not ranges[number][1] <= value <= ranges[number][2]:
            return False
        if number in (EXPOSURE, GAIN) and values[AUTO_EXPOSITION]:
            return False
        values[number] = int(value)
        return True


def _ranges(version: NaoVersion) -> dict[int, tuple[int, int, int]]:
    return _V6 if version == "v6" else _V5


def _values(version: NaoVersion) -> dict[int, int]:
    return {number: row[0] for number, row in _ranges(version).items()}


@qi.multiThreaded()
class RawVideo(Video):
    """Pixels declared as raw bytes, as the real ALVideoDevice has them."""

    @qi.bind("(iiiiiiriffff)", ("s",))
    def getImageRemote(self, handle: str) -> tuple[object, ...]:
        """The newest picture; an empty one if there is none, as this signature knows no other."""
        return self.picture(handle) or (0, 0, 0, 0, 0, 0, b"", 0, 0.0, 0.0, 0.0, 0.0)


@qi.multiThreaded()
class ListVideo(Video):
    """An undeclared list: the pixels arrive as a text."""

    def getImageRemote(self, handle: str) -> list[object]:
        """The newest picture."""
        return list(self.picture(handle))


@qi.multiThreaded()
class TupleVideo(Video):
    """An undeclared tuple."""

    def getImageRemote(self, handle: str) -> tuple[object, ...]:
        """The newest picture."""
        return self.picture(handle)


def video_service(robot: PeerRobot) -> Video:
    """ALVideoDevice in the form that was asked for."""
    kinds = {"raw": RawVideo, "list": ListVideo, "tuple": TupleVideo}
    return kinds[robot.told.image](robot)

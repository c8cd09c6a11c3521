"""Going through the head poses, or waiting for a person to, and recording what is seen."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from hal.errors import CameraTimeoutError
from hal.protocols import Robot
from hal.types import BodyState, HeadAngles
from naod.calibration.eyes import Eyes, Glimpse
from naod.calibration.plan import apart_rad
from naod.calibration.view import View, averaged
from naod.errors import InputError
from naod.loop.equipment import head_angles

SPEED_RAD_S = 0.8
POLL_S = 0.05
STILL_RAD = math.radians(0.25)
STILL_POLLS = 6
SETTLE_S = 0.3
GIVE_UP_S = 4.0
PICTURE_S = 2.0
PICTURES = 4
BY_HAND_APART_RAD = math.radians(4.0)
BY_HAND_S = 300.0
STOOD_RAD = 0.03
"""Legs that moved by more than this between views mean that the robot did not stand still."""

_LEGS = slice(8, 20)

Tell = Callable[[str], None]


@dataclass(frozen=True, slots=True)
class Recorded:
    """Views, and the body as it stood in each."""

    views: list[View]
    bodies: list[BodyState]

    def standing(self) -> NDArray[np.float64]:
        """(26,) median joint angles. Raises InputError when the legs moved between views."""
        angles = np.array([body.angles_rad for body in self.bodies])
        if float(np.ptp(angles[:, _LEGS], axis=0).max()) > STOOD_RAD:
            raise InputError("the robot did not stand still: its legs moved between the views")
        return np.asarray(np.median(angles, axis=0), dtype=np.float64)


class Recorder:
    """Records views with one robot; `tell` is told, a line each, how it goes."""

    def __init__(self, robot: Robot, eyes: Eyes, tell: Tell) -> None:
        self._robot, self._eyes, self._tell = robot, eyes, tell

    def here(self) -> tuple[View, BodyState] | str:
        """A view from where the head is; the reason if there is none."""
        glimpses: list[Glimpse] = []
        bodies: list[BodyState] = []
        why = "no picture came"
        for _ in range(PICTURES):
            try:
                frame = self._robot.camera.next(PICTURE_S)
            except CameraTimeoutError as error:
                return str(error)
            body = self._robot.body.at(frame.stamp_ns)
            glimpse, why_not = self._eyes.glimpse(frame)
            if body is None or glimpse is None:
                why = why_not or "the body's angles at the time of the picture are not known"
                continue
            glimpses.append(glimpse)
            bodies.append(body)
        if len(glimpses) * 2 < PICTURES:
            return why
        heads = [head_angles(body) for body in bodies]
        if max(apart_rad(heads[0], head) for head in heads) > 2.0 * STILL_RAD:
            return "the head did not stand still"
        yaw = float(np.mean([head.yaw_rad for head in heads]))
        pitch = float(np.mean([head.pitch_rad for head in heads]))
        edges = averaged([glimpse.edges for glimpse in glimpses])
        view = View(HeadAngles(yaw, pitch), edges, glimpses[0].T_camera_object)
        return view, bodies[len(bodies) // 2]

    def through(self, poses: Sequence[HeadAngles]) -> Recorded:
        """Turn the head through poses and record each."""
        done = Recorded([], [])
        for number, pose in enumerate(poses, start=1):
            self.turn(pose)
            found = self.here()
            self._note(f"view {number} of {len(poses)}", pose, found, done)
        return done

    def turn(self, pose: HeadAngles) -> None:
        """Turn the head and wait until it is still."""
        clock = self._robot.clock
        self._robot.head.look(pose, SPEED_RAD_S)
        give_up_ns = clock.now_ns() + round(GIVE_UP_S * 1e9)
        before, still = head_angles(self._robot.body.latest()), 0
        while still < STILL_POLLS and clock.now_ns() < give_up_ns:
            clock.sleep_until(clock.now_ns() + round(POLL_S * 1e9))
            now = head_angles(self._robot.body.latest())
            still = still + 1 if apart_rad(now, before) < STILL_RAD else 0
            before = now
        clock.sleep_until(clock.now_ns() + round(SETTLE_S * 1e9))

    def by_hand(self, count: int) -> Recorded:
        """Record whenever a person holds the head still somewhere else, until there are enough."""
        clock, done = self._robot.clock, Recorded([], [])
        give_up_ns = clock.now_ns() + round(BY_HAND_S * 1e9)
        before, still = head_angles(self._robot.body.latest()), 0
        while len(done.views) < count and clock.now_ns() < give_up_ns:
            clock.sleep_until(clock.now_ns() + round(POLL_S * 1e9))
            now = head_angles(self._robot.body.latest())
            still = still + 1 if apart_rad(now, before) < STILL_RAD else 0
            before = now
            known = [view.head for view in done.views]
            is_other = all(apart_rad(now, head) > BY_HAND_APART_RAD for head in known)
            if still >= STILL_POLLS and is_other:
                found = self.here()
                self._note(f"view {len(known) + 1} of {count}", now, found, done)
                still = 0
        return done

    def _note(
        self, label: str, pose: HeadAngles, found: tuple[View, BodyState] | str, done: Recorded
    ) -> None:
        place = f"yaw {math.degrees(pose.yaw_rad):+.0f}, pitch {math.degrees(pose.pitch_rad):+.0f}"
        if isinstance(found, str):
            self._tell(f"{label} ({place}): left out, {found}")
            return
        done.views.append(found[0])
        done.bodies.append(found[1])
        self._tell(f"{label} ({place}): seen")

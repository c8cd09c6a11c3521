"""The walk by moveTo and move, polled by a thread of its own; every motion under the watchdog."""

from __future__ import annotations

import logging
import threading
import time
from contextlib import suppress

from hal.errors import HalError, MotionRefusedError
from hal.naoqi.channel import Channel
from hal.naoqi.guard import Guard
from hal.naoqi.lead import Lead
from hal.naoqi.life import Household
from hal.naoqi.limits import (
    STILL,
    check,
    check_validity,
    clipped_travel,
    clipped_velocity,
    nominal_velocity,
)
from hal.naoqi.motion import Motion
from hal.naoqi.odometry import Odometry
from hal.naoqi.session import Call, Session
from hal.naoqi.stance import Stance
from hal.types import PlanarMotion, WalkStatus

log = logging.getLogger(__name__)

PERIOD_S = 0.04
EARLY_S = 0.05
"""A walk that is refused is refused at once."""
STOP_S = 3.0
STANDS_S = 1.5
"""A robot told to stop stands after about 0.8 s; if not by then, the watchdog tells it again."""


class NaoqiWalk:
    """`hal.protocols.Walk`. Owns the connection that moves the robot."""

    def __init__(
        self,
        channel: Channel,
        guard: Guard,
        household: Household,
        stance: Stance,
        velocity_by_leads: bool,
    ) -> None:
        self._channel, self._guard, self._household = channel, guard, household
        self.stance, self._by_leads = stance, velocity_by_leads
        self._lock = threading.RLock()
        self._motion: Motion | None = None
        self._stopping: Call | None = None
        self._active = self._taken_over = self._closed = False
        self._odometry = Odometry()
        self.error: str | None = "not connected yet"
        self.refusal: str | None = None
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._run, name="naoqi-walk", daemon=True)

    def start(self) -> None:
        """Stop whatever moves, take the robot over, begin to poll. Raises HalError."""
        self._poll()
        self.error = None
        self._thread.start()

    def move_to(self, step: PlanarMotion, valid_for_s: float) -> PlanarMotion:
        """Walk by a displacement; see `hal.protocols.Walk`. Raises MotionRefusedError."""
        check(step, valid_for_s)
        sent = clipped_travel(step)
        self._begin("moveTo", sent, nominal_velocity(sent), valid_for_s)
        return sent

    def set_velocity(self, velocity: PlanarMotion, valid_for_s: float) -> PlanarMotion:
        """Walk at a velocity; see `hal.protocols.Walk`. Raises MotionRefusedError."""
        check(velocity, valid_for_s)
        sent = clipped_velocity(velocity)
        if sent == STILL:
            self.stop()
        elif self._by_leads:
            now_s = time.monotonic()
            lead = Lead(sent, self._odometry.pose, now_s)
            way = lead.displacement(self._odometry.pose, now_s)
            self._begin("moveTo", way, sent, valid_for_s, lead)
        else:
            self._begin("move", sent, sent, valid_for_s)
        return sent

    def renew(self, valid_for_s: float) -> None:
        """Let the present motion go on; see `hal.protocols.Walk`. Raises MotionRefusedError."""
        check_validity(valid_for_s)
        with self._lock:
            if self._motion is not None:
                self._guard.arm(_deadline_ns(valid_for_s))
                self._lead_on(self._motion)

    def stop(self) -> None:
        """End on both feet as soon as is safe. Raises HalError when NAOqi cannot be told.

        The watchdog then tells it, at the latest when the motion's time is over.
        """
        with self._lock:
            self._motion = None
            self.stance.cancel()
            self._stopping = self._channel.session.post("ALMotion", "stopMove")
            with suppress(MotionRefusedError):
                self._guard.arm(_deadline_ns(STANDS_S))

    def status(self) -> WalkStatus:
        """What the walk does now; while the connection is cut, what was known last."""
        with self._lock:
            motion = self._motion
            under_way = motion is not None or self._stopping is not None
            return WalkStatus(
                stamp_ns=time.monotonic_ns(),
                moving=self._active or under_way or self.stance.is_rising,
                fallen=self.stance.fallen,
                velocity=STILL if motion is None else motion.told,
                odometry=self._odometry.pose,
            )

    def head_objection(self) -> str | None:
        """Why the head may not be turned now."""
        if self.error is not None:
            return self.error
        return "the robot has fallen" if self.stance.lies else None

    def halt(self) -> None:
        """Stop if anything moves, or may. Raises HalError."""
        if self._active or self._motion is not None or self.stance.is_rising:
            self.stop()

    def close(self) -> None:
        """Stop, wait until the robot stands, give it back. May be called twice."""
        self._closing.set()
        if self._thread.ident is not None:
            self._thread.join(timeout=5.0)
        if self._closed:
            return
        self._closed = True
        try:
            session = self._channel.session
            if self._active or self._motion is not None:
                session.call("ALMotion", "stopMove", timeout_s=STOP_S)
            self._motion = None
            self._household.give_back(session)
        except HalError as error:
            if self.error is None:
                log.warning("the robot could not be given back: %s", error)
        self._channel.close()

    def _begin(
        self,
        method: str,
        sent: PlanarMotion,
        told: PlanarMotion,
        valid_for_s: float,
        lead: Lead | None = None,
    ) -> None:
        try:
            with self._lock:
                self._refuse_if_unready()
                self._guard.arm(_deadline_ns(valid_for_s))
                call = self._walk(method, sent)
                self._stopping = None
                self._motion = Motion(told, call, method == "moveTo", self._guard.fired, lead)
        except MotionRefusedError as error:
            self.refusal = str(error)
            raise
        self.refusal = None

    def _refuse_if_unready(self) -> None:
        reason = self.error
        if reason is None:
            walks = self._active or self._motion is not None
            reason = self.stance.refusal(walks=walks)
        if reason is not None:
            raise MotionRefusedError(reason)

    def _walk(self, method: str, sent: PlanarMotion) -> Call:
        try:
            call = self._channel.session.post("ALMotion", method, sent.x, sent.y, sent.yaw)
            refused = call.wait(EARLY_S) and call.result(0.0) is False
        except HalError as error:
            raise MotionRefusedError(str(error)) from None
        if refused:
            raise MotionRefusedError(f"ALMotion.{method} refused to walk")
        return call

    def _lead_on(self, motion: Motion) -> None:
        """Send the next displacement of a velocity, if it is due."""
        now_s = time.monotonic()
        if motion.lead is None or not motion.lead.is_due(now_s):
            return
        way = motion.lead.displacement(self._odometry.pose, now_s)
        motion.call = self._walk("moveTo", way)

    def _run(self) -> None:
        due_s = time.monotonic()
        while not self._closing.wait(max(0.0, due_s - time.monotonic())):
            try:
                self._poll()
                self.error = None
            except HalError as error:
                if self.error is None:
                    log.warning("the walk: %s", error)
                self.error = str(error)
                self._channel.note(error)
            due_s = max(due_s + PERIOD_S, time.monotonic())

    def _poll(self) -> None:
        self._guard.start()
        if self._channel.ensure():
            self._taken_over = False
        session = self._channel.session
        if not self._taken_over:
            self._take_over(session)
            self._taken_over = True
        asked = session.post("ALMotion", "moveIsActive")
        where = session.post("ALMotion", "getRobotPosition", True)
        active = bool(asked.result())
        pose = where.result()
        self.stance.read(session)
        with self._lock:
            self._active = active
            self._odometry.take(pose)
            self._follow(session, active)
        self._channel.answered()

    def _take_over(self, session: Session) -> None:
        """A robot that was left walking stands first of all (S8), whoever left it so."""
        with self._lock:
            self._motion = self._stopping = None
            self.stance.forget()
        self._odometry.restart()
        session.call("ALMotion", "stopMove", timeout_s=STOP_S)
        self._household.take_over(session)

    def _follow(self, session: Session, active: bool) -> None:
        """See what has become of the motion, of the stop and of standing up."""
        self.stance.rise(session)
        motion = self._motion
        if motion is not None:
            motion.note_active(active)
            if self._guard.fired != motion.fired:
                log.warning("the motion was not renewed in time")
                self._motion = None
            elif self._guard.objection is not None:
                log.error("the robot is stopped: %s", self._guard.objection)
                self.stop()
            elif motion.is_over(active):
                self._motion = None
                _log_failure(motion.call)
        if self._stopping is not None and self._stopping.done:
            call, self._stopping = self._stopping, None
            _log_failure(call)
        if self._motion is None and not active and self._stopping is None:
            self._guard.disarm()


def _deadline_ns(valid_for_s: float) -> int:
    return time.monotonic_ns() + round(valid_for_s * 1e9)


def _log_failure(call: Call) -> None:
    if not call.done:
        return
    try:
        call.result(0.0)
    except HalError as error:
        log.warning("the robot did not do as told: %s", error)

"""The queryables `rpc/<verb>`: what each call does."""

from __future__ import annotations

import logging

from naod import __version__
from naod.approach.goal import Goal, check_name
from naod.bus import keys
from naod.bus.bus import Answer, Bus
from naod.bus.wire import RefusedError
from naod.daemon.act import Actor
from naod.daemon.desk import Desk
from naod.daemon.loop import Loop
from naod.daemon.pictures import jpeg_of
from naod.errors import InputError
from naod.loop.types import Label, Start, Stop, Teach
from naod.messages import (
    GoalCall,
    HeadCommand,
    LabelCall,
    NoArguments,
    PictureReply,
    RobotMessage,
    StatusReply,
    WalkCommand,
)
from naod.walk_server.server import WalkServer

log = logging.getLogger(__name__)


class Verbs:
    """Answers calls; whatever moves the robot goes through the loop or the walk server."""

    def __init__(
        self,
        bus: Bus,
        robot: RobotMessage,
        server: WalkServer,
        loop: Loop,
        actor: Actor,
        desk: Desk,
    ) -> None:
        self._bus = bus
        self._robot = robot
        self._server = server
        self._loop = loop
        self._actor = actor
        self._desk = desk

    def declare(self) -> None:
        """Begin to answer, and say that the robot is there."""
        refuse = self._server.refuse
        answer = self._bus.answer
        answer("status", NoArguments, self._status, refuse)
        answer("watch", NoArguments, self._watch, refuse)
        answer("goals", NoArguments, self._goals, refuse)
        answer("picture", NoArguments, self._picture, refuse)
        answer("start", GoalCall, self._start, refuse)
        answer("teach", GoalCall, self._teach, refuse)
        answer("label", LabelCall, self._label, refuse)
        answer("stop", NoArguments, self._stop, refuse)
        answer("estop", NoArguments, self._estop, refuse)
        answer("release", NoArguments, self._release, refuse)
        answer("walk", WalkCommand, self._walk, refuse)
        answer("head", HeadCommand, self._head, refuse)
        self._bus.announce()

    def _status(self, _call: NoArguments, answer: Answer) -> None:
        state = self._loop.state
        answer.done(
            StatusReply(
                version=__version__,
                robot=self._robot,
                estopped=self._server.estopped,
                labelled=state.model is not None,
                goals=tuple(sorted(state.goals)),
                state=self._actor.last,
                walk=self._server.latest(),
                diagnostics=self._loop.diagnostics,
            )
        )

    def _watch(self, _call: NoArguments, answer: Answer) -> None:
        names = (keys.STATE, keys.WALK_STATE, keys.EVENT, keys.DIAGNOSTICS)
        answer.ok(keys=[self._bus.key(name) for name in names])

    def _goals(self, _call: NoArguments, answer: Answer) -> None:
        goals = self._loop.state.goals
        answer.ok(goals=[_goal(name, goals[name]) for name in sorted(goals)])

    def _picture(self, _call: NoArguments, answer: Answer) -> None:
        frame = self._loop.frame
        jpeg = jpeg_of(frame) if frame is not None else None
        if frame is None or jpeg is None:
            answer.error("no_picture", "the camera has given no picture yet")
            return
        answer.done(
            PictureReply(
                stamp_ns=frame.stamp_ns,
                width=frame.width,
                height=frame.height,
                jpeg=jpeg,
            )
        )

    def _start(self, call: GoalCall, answer: Answer) -> None:
        if self._server.estopped:
            answer.error("estopped", "estop is latched; release it first")
            return
        self._ask(Start(call.goal), answer)

    def _teach(self, call: GoalCall, answer: Answer) -> None:
        try:
            name = check_name(call.goal)
        except InputError as error:
            answer.error("bad_name", str(error))
            return
        self._ask(Teach(name), answer)

    def _label(self, call: LabelCall, answer: Answer) -> None:
        self._ask(Label(call.x, call.y, call.width, call.height), answer)

    def _stop(self, _call: NoArguments, answer: Answer) -> None:
        # whoever walks is stopped at once; the loop learns of it at its next tick
        self._server.end()
        self._ask(Stop(), answer)

    def _estop(self, _call: NoArguments, answer: Answer) -> None:
        log.warning("estop")
        # the approach is over as well: after the release nothing goes on by itself
        self._ask(Stop(), None)
        try:
            self._server.estop()
        except InputError as error:
            answer.ok(warning=f"stopped, but a restart will not know of it: {error}")
            return
        answer.ok()

    def _release(self, _call: NoArguments, answer: Answer) -> None:
        try:
            self._server.release()
        except InputError as error:
            answer.error("not_released", str(error))
            return
        log.warning("estop released")
        answer.ok()

    def _walk(self, call: WalkCommand, answer: Answer) -> None:
        reason = self._server.command(call)
        if reason is not None:
            answer.error("refused", reason)
            return
        answer.ok()

    def _head(self, call: HeadCommand, answer: Answer) -> None:
        try:
            sent = self._server.head.operate(call)
        except RefusedError as error:
            self._server.refuse(str(error))
            answer.error("refused", str(error))
            return
        answer.ok(yaw=sent.yaw_rad, pitch=sent.pitch_rad)

    def _ask(self, verb: Start | Stop | Label | Teach, answer: Answer | None) -> None:
        self._desk.ask(verb, answer, self._loop.now_ns())


def _goal(name: str, goal: Goal) -> dict[str, object]:
    return {
        "name": name,
        "kind": goal.kind,
        "rho_m": goal.rho_m,
        "theta_rad": goal.theta_rad,
        "z_m": goal.z_m,
        "phi_rad": goal.phi_rad,
        "sigma_m": goal.sigma_m,
    }

"""The loop, the walk server's core and a simulated robot, tick by tick on one virtual clock.

The same step function and the same arbitration as in the daemon; only the bus between them is
left out, messages are handed over as they are.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from hal.errors import MotionRefusedError
from hal.simulation import SimulatedRobot, Truth
from hal.types import Frame, HeadAngles, WalkStatus
from naod.loop.around import around
from naod.loop.core import decide, look_at
from naod.loop.equipment import Equipment, Sighting
from naod.loop.state import LoopState
from naod.loop.types import Commands, Label, Observation, Reply, Request, Start, Stop, Teach
from naod.messages import EventMessage, WalkState
from naod.walk_server.actuate import carry_out
from naod.walk_server.arbiter import (
    ArbiterState,
    Heartbeat,
    Received,
    receive,
    refused_by_robot,
    report,
    tick,
)
from naod.walk_server.rules import Rules

FRAME_AGE_S = 0.5


@dataclass(frozen=True, slots=True)
class Tick:
    """Everything of one tick, for whoever records or draws it."""

    now_ns: int
    seen: Observation
    sighting: Sighting | None
    state: LoopState
    commands: Commands
    truth: Truth


class LockStep:
    """Drives a simulated robot with the loop's step."""

    def __init__(self, robot: SimulatedRobot, equipment: Equipment) -> None:
        self.robot = robot
        self.equipment = equipment
        self.state = LoopState.initial({}, None)
        self.listeners: list[Callable[[Tick], None]] = []
        self.rules = Rules.from_config(equipment.config.walk)
        self.arbiter = ArbiterState()
        self.events: list[EventMessage] = []
        self._period_ns = round(1e9 / equipment.config.camera.fps)
        self._next_ns = robot.clock.now_ns()
        self._sequence = -1
        self._walk_seq = 0
        self._ticket = 0

    def tick(self, requests: Sequence[Request] = ()) -> Tick:
        """Let one period pass, then one step of the loop."""
        self._next_ns += self._period_ns
        self.robot.advance(self._next_ns)
        now_ns = self.robot.clock.now_ns()
        seen = self._observe(tuple(requests))
        sighting = look_at(self.equipment, self.state, seen)
        self.state, commands = decide(self.equipment, self.state, seen, sighting, now_ns)
        self._carry_out(commands, now_ns)
        self.events += commands.events
        done = Tick(now_ns, seen, sighting, self.state, commands, self.robot.truth())
        for listener in self.listeners:
            listener(done)
        return done

    def ask(self, verb: Start | Stop | Label | Teach, patience_s: float = 30.0) -> Reply:
        """Ask for something and tick until it is answered."""
        self._ticket += 1
        requests: tuple[Request, ...] = (Request(self._ticket, verb),)
        deadline_ns = self._next_ns + int(patience_s * 1e9)
        while self._next_ns < deadline_ns:
            for reply in self.tick(requests).commands.replies:
                if reply.ticket == self._ticket:
                    return reply
            requests = ()
        return Reply(self._ticket, "timeout", f"no answer within {patience_s:g} s")

    def look(self, target: HeadAngles, wait_s: float = 1.0) -> None:
        """Turn the head as a person with a remote control would, and wait."""
        self.robot.head.look(target, 2.0)
        for _ in range(round(wait_s * 1e9 / self._period_ns)):
            self.tick()

    def settle(self) -> None:
        """After the robot was put somewhere by hand: forget what was seen, wait for the time."""
        self._next_ns = self.robot.clock.now_ns()
        self.state = replace(self.state, target=None, looks=())

    def _observe(self, requests: tuple[Request, ...]) -> Observation:
        frame = self._fresh_frame()
        body = self.robot.body.at(frame.stamp_ns) if frame else None
        if body is None:
            frame, body = None, self.robot.body.latest()
        beside = around(self.robot.body, frame) if frame else None
        walk = self._walk_state(self.robot.walk.status())
        return Observation(frame, body, walk, requests, beside)

    def _fresh_frame(self) -> Frame | None:
        frame = self.robot.camera.latest(FRAME_AGE_S)
        if frame is None or frame.sequence == self._sequence:
            return None
        self._sequence = frame.sequence
        return frame

    def _walk_state(self, status: WalkStatus) -> WalkState:
        self._walk_seq += 1
        return report(self.arbiter, status, self._walk_seq)

    def _carry_out(self, commands: Commands, now_ns: int) -> None:
        robot, status = self.robot, self.robot.walk.status()
        if commands.head is not None:
            robot.head.look(commands.head, commands.head_speed_rad_s)
        self.arbiter = receive(self.arbiter, Heartbeat(now_ns), status, self.rules)
        if commands.walk is not None:
            item = Received(commands.walk, now_ns)
            self.arbiter = receive(self.arbiter, item, status, self.rules)
        self.arbiter, action = tick(self.arbiter, status, now_ns, self.rules)
        if action is None:
            return
        try:
            carry_out(robot.walk, action)
        except MotionRefusedError as error:
            self.arbiter = refused_by_robot(self.arbiter, str(error))

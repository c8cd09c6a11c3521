"""The loop's thread: sense, step, act, at absolute deadlines."""

from __future__ import annotations

import gc
import logging
import threading
from collections.abc import Callable
from dataclasses import replace

from hal.errors import HalError
from hal.protocols import Robot
from hal.types import Frame
from naod.bus import keys
from naod.bus.bus import Bus
from naod.daemon.act import Actor
from naod.daemon.desk import Desk
from naod.daemon.gauges import Gauges
from naod.daemon.senses import Senses
from naod.loop.core import step
from naod.loop.equipment import Equipment
from naod.loop.looking import FRESH_NS
from naod.loop.state import LoopState
from naod.loop.types import Observation
from naod.messages import (
    TRACKER,
    DiagnosticsMessage,
    StateMessage,
    TargetMessage,
    WalkCommand,
    WalkState,
)
from naod.pace import Pace
from naod.walk_server.server import WalkServer

log = logging.getLogger(__name__)

RATE_MIN_HZ = 10
"""`state` is also the tracker's heartbeat, and the walk server waits 0.5 s for it."""

WALK_SILENT_NS = 1_000_000_000
COLLECT_NS = 10_000_000_000


class Loop:
    """Owns the loop's state; everything else it is given."""

    def __init__(
        self,
        robot: Robot,
        bus: Bus,
        server: WalkServer,
        actor: Actor,
        desk: Desk,
        equipment: Equipment,
        state: LoopState,
    ) -> None:
        self._clock = robot.clock
        self._bus = bus
        self._server = server
        self._actor = actor
        self._desk = desk
        self._equipment = equipment
        self._senses = Senses(robot)
        self._body = robot.body
        self._state = state
        self._closing = threading.Event()
        self._thread = threading.Thread(target=self._run, name="loop", daemon=True)
        self._collected_ns = 0
        self._frame: Frame | None = None
        self.diagnostics: DiagnosticsMessage | None = None
        self.before_first: Callable[[], None] = lambda: None
        self.after_tick: Callable[[], None] = lambda: None
        self.on_end: Callable[[], None] = lambda: None

    @property
    def state(self) -> LoopState:
        """The loop's memory; immutable."""
        return self._state

    @property
    def frame(self) -> Frame | None:
        """The newest picture that was looked at."""
        return self._frame

    def now_ns(self) -> int:
        """The loop's clock."""
        return self._clock.now_ns()

    def start(self) -> None:
        """Begin."""
        self._thread.start()

    def close(self) -> None:
        """End after the present tick. May be called twice."""
        self._closing.set()
        if self._thread.ident is not None:
            self._thread.join(timeout=1.0)

    def _run(self) -> None:
        try:
            self.before_first()
            _freeze_garbage()
            fps = max(self._equipment.config.camera.fps, RATE_MIN_HZ)
            now_ns = self._clock.now_ns()
            pace, gauges = Pace(now_ns, round(1e9 / fps)), Gauges(now_ns)
            while not self._closing.is_set():
                self._clock.sleep_until(pace.deadline_ns)
                self._tick(pace, gauges)
                pace.advance(self._clock.now_ns())
        finally:
            self.on_end()

    def _tick(self, pace: Pace, gauges: Gauges) -> None:
        now_ns = self._clock.now_ns()
        gauges.tick(now_ns)
        walk = self._server.latest()
        if walk is None or now_ns - walk.stamp_ns > WALK_SILENT_NS:
            # the watchdog is not fed: a daemon that cannot walk is to be started anew
            self._actor.fault("walk_silent", "the walk server does not answer", now_ns)
            return
        try:
            frame_ns = self._step(walk, now_ns)
        except Exception as error:
            text = f"{type(error).__name__}: {error}"
            if self._actor.fault("step_failed", text, now_ns):
                log.exception("the step failed")
            self._give_up(now_ns)
            frame_ns = None
        done_ns = self._clock.now_ns()
        if frame_ns is not None:
            gauges.frame(frame_ns, done_ns)
        self._desk.expire(done_ns)
        if gauges.due(done_ns):
            self._report(pace, gauges, done_ns)
        self.after_tick()
        self._collect(pace)

    def _step(self, walk: WalkState, now_ns: int) -> int | None:
        seen: Observation = self._senses.observe(walk, self._desk.take())
        if self._senses.camera_error is not None:
            self._actor.fault("camera_failed", self._senses.camera_error, now_ns)
        self._state, commands = step(self._equipment, self._state, seen, now_ns)
        self._actor.carry_out(commands, now_ns)
        if seen.frame is None:
            return None
        self._frame = seen.frame
        return seen.frame.stamp_ns

    def _give_up(self, now_ns: int) -> None:
        """A tick failed: stand still, forget what was under way, stay in service."""
        old = self._state
        seq = max(old.walk_seq + 1, now_ns // 1_000_000)
        fresh = LoopState.initial(old.goals, old.model)
        self._state = replace(fresh, seq=old.seq + 1, walk_seq=seq, frame_ns=old.frame_ns)
        if old.mode != "idle":
            stop = WalkCommand(source=TRACKER, seq=seq, kind="stop", ttl_ms=300)
            self._bus.publish(keys.WALK_COMMAND, stop)
        self._desk.fail_all("internal", "the loop's step failed; see the daemon's log")
        nothing = TargetMessage(found=False, age_s=None, ego=None, sigma_m=None)
        self._actor.tell(
            StateMessage(
                seq=self._state.seq,
                stamp_ns=now_ns,
                mode="idle",
                phase="idle",
                goal=None,
                target=nothing,
                error=None,
                faults=(),
            ),
            now_ns,
        )

    def _report(self, pace: Pace, gauges: Gauges, now_ns: int) -> None:
        try:
            body = self._body.latest()
        except HalError as error:
            self._actor.fault("body_silent", str(error), now_ns)
            return
        target = self._state.target
        in_view = target is not None and now_ns - target.seen_ns <= FRESH_NS
        blur_px = target.blur_px if target is not None and in_view else None
        refusals, warm = self._server.refusals, body.temperature_max_c
        self.diagnostics = gauges.report(
            now_ns, pace.overruns, refusals, warm, body.battery, blur_px
        )
        self._bus.publish(keys.DIAGNOSTICS, self.diagnostics)

    def _collect(self, pace: Pace) -> None:
        """Garbage is collected by us, between ticks, when there is time left for it."""
        now_ns = self._clock.now_ns()
        late = pace.deadline_ns + pace.period_ns // 2 < now_ns
        if now_ns - self._collected_ns > COLLECT_NS and not late:
            self._collected_ns = now_ns
            gc.collect()


def _freeze_garbage() -> None:
    """What is there now stays; the collector no longer runs when it likes."""
    gc.collect()
    gc.freeze()
    gc.disable()

"""One tick: a pure function of state, measurement, what is wanted, and the time since the last.

It holds no clock and does no input or output. What is wanted has had its deadlines applied.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Generic, TypeVar

import numpy as np
from numpy.typing import NDArray

from hal.lola import balance, button, guard
from hal.lola.actuators import Actuators
from hal.lola.engine import Aim, Engine, EngineCommand, EngineReport, Motion
from hal.lola.lights import lights
from hal.lola.modes import Mode, after_press
from hal.lola.poses import ARMS, HEAD, LEGS, is_on_the_way, is_seated
from hal.lola.sensors import Sensors
from hal.nao.head_limits import clip_head
from hal.types import HeadAngles

Array = NDArray[np.float64]
S = TypeVar("S")

STIFF_LEGS, STIFF_ARMS, STIFF_HEAD = 0.6, 0.3, 0.6
"""Legs: `walk_facts.yaml`, hulks_2024 leg_stiffness_stand. Arms and head are assumptions."""

_AIMS: dict[Mode, Aim] = {"hold": "hold", "stand": "stand", "rest": "sit", "fallen": "hold"}


def _stiff() -> Array:
    out = np.zeros(26)
    out[LEGS], out[ARMS], out[HEAD] = STIFF_LEGS, STIFF_ARMS, STIFF_HEAD
    return out


_STIFF, _LIMP = _stiff(), np.zeros(26)


@dataclass(frozen=True, slots=True)
class HeadWish:
    """Where the head is to look, and how fast it turns there."""

    target: HeadAngles
    speed_rad_s: float


@dataclass(frozen=True, slots=True)
class Wanted:
    """What is wanted at this tick; what has expired is None.

    `alone`: nobody is there who could want something. `leave`: sit down and let go, for good.
    `stand`: stand up if it holds a pose.
    """

    head: HeadWish | None = None
    motion: Motion | None = None
    alone: bool = False
    leave: bool = False
    stand: bool = False


@dataclass(frozen=True, slots=True)
class CoreState(Generic[S]):
    """Everything the tick remembers. `head`: where the head's way has come to."""

    mode: Mode
    engine: S
    guard: guard.GuardState
    balance: balance.Balance
    button: button.Button
    head: HeadAngles
    leaving: bool = False

    @property
    def limp(self) -> bool:
        """No joint is stiff."""
        return not bool(self.guard.stiffness.any())


class Core(Generic[S]):
    """The tick around an engine. Holds nothing that changes."""

    def __init__(self, engine: Engine[S], limp_when_fallen: bool = True) -> None:
        self.engine = engine
        self._limp_when_fallen = limp_when_fallen

    def begin(self, sensors: Sensors, resting: bool = False) -> CoreState[S]:
        """Hold what is measured; stay limp if it has fallen, or was `resting` before."""
        upright = balance.begin(sensors)
        mode: Mode = "fallen" if upright.fallen else ("rest" if resting else "hold")
        held = guard.begin(sensors)
        if mode == "rest":
            held = guard.GuardState(held.angles_rad, _LIMP)
        return CoreState(
            mode,
            self.engine.begin(sensors),
            held,
            upright,
            button.begin(sensors.chest_button),
            _head_of(sensors.angles_rad),
        )

    def step(
        self, state: CoreState[S], sensors: Sensors, wanted: Wanted, dt_s: float
    ) -> tuple[CoreState[S], Actuators]:
        """One tick: what to remember, what to send."""
        upright = balance.step(state.balance, sensors, dt_s)
        state = replace(state, balance=upright, leaving=state.leaving or wanted.leave)
        state = self._change_mode(state, sensors, wanted, dt_s)
        command = EngineCommand(_AIMS[state.mode])
        if self.refusal(state) is None:
            command = replace(command, motion=wanted.motion)
        moved, angles = self.engine.step(state.engine, sensors, command, dt_s)
        state = replace(state, engine=moved)
        head = self._turned_head(state, sensors, wanted, dt_s)
        angles = angles.copy()
        angles[HEAD] = (head.yaw_rad, head.pitch_rad)
        limp = self._lets_go(state, sensors)
        fast = guard.LET_GO_PER_S if state.mode == "fallen" else guard.SOFTEN_PER_S
        stiffness = _LIMP if limp else _STIFF
        held = guard.step(state.guard, sensors, angles, stiffness, dt_s, fast)
        state = replace(state, head=head, guard=held)
        return state, self.actuators(state, wanted.alone)

    def actuators(self, state: CoreState[S], alone: bool) -> Actuators:
        """What a state sends."""
        held = state.guard
        return Actuators(held.angles_rad, held.stiffness, lights(state.mode, alone))

    def report(self, state: CoreState[S]) -> EngineReport:
        """What the engine is at."""
        return self.engine.report(state.engine)

    def refusal(self, state: CoreState[S]) -> str | None:
        """Why a walk is refused now; None if it is not."""
        if state.balance.fallen or state.mode == "fallen":
            return _FALLEN
        if state.leaving:
            return "the connection to LoLA is closing down"
        if state.mode == "rest":
            return _RESTING
        if state.balance.lifted:
            return "the feet feel no ground"
        return self.report(state).refusal

    def head_refusal(self, state: CoreState[S]) -> str | None:
        """Why the head is not turned now; None if it is."""
        if state.balance.fallen or state.mode == "fallen":
            return _FALLEN
        return _RESTING if state.mode == "rest" else None

    def done(self, state: CoreState[S], sensors: Sensors) -> bool:
        """Whether a robot that is to be left can be left.

        It can when it is limp, having sat down or fallen; and as it is, stiff, when it is in a pose
        from which it cannot sit down slowly: letting go would be a fall.
        """
        return state.leaving and (
            state.limp or (state.mode == "hold" and not is_on_the_way(sensors.angles_rad))
        )

    def _change_mode(
        self, state: CoreState[S], sensors: Sensors, wanted: Wanted, dt_s: float
    ) -> CoreState[S]:
        pressed, press = button.step(state.button, sensors.chest_button, dt_s)
        state = replace(state, button=pressed)
        on_the_way = is_on_the_way(sensors.angles_rad)
        mode = state.mode
        if state.balance.fallen:
            mode = "fallen"
        elif state.leaving:
            mode = "rest" if on_the_way and mode in ("hold", "stand") else mode
        elif press is not None:
            seated = is_seated(sensors.angles_rad)
            mode = after_press(mode, press, seated=seated, on_the_way=on_the_way)
        elif wanted.stand and mode == "hold" and on_the_way:
            mode = "stand"
        if mode == state.mode:
            return state
        stiffened = state.mode == "fallen" or state.limp
        if not stiffened:
            return replace(state, mode=mode)
        # what it lay or sat like before is not where it is now
        fresh = self.engine.begin(sensors)
        return replace(state, mode=mode, engine=fresh, head=_head_of(sensors.angles_rad))

    def _turned_head(
        self, state: CoreState[S], sensors: Sensors, wanted: Wanted, dt_s: float
    ) -> HeadAngles:
        """A limp head is where it is measured, a stiff one a little nearer to what is wanted."""
        if state.limp:
            return _head_of(sensors.angles_rad)
        wish = wanted.head
        if wish is None or self.head_refusal(state) is not None:
            return state.head
        most = wish.speed_rad_s * dt_s
        target = clip_head(wish.target)
        return HeadAngles(
            state.head.yaw_rad + _within(target.yaw_rad - state.head.yaw_rad, most),
            state.head.pitch_rad + _within(target.pitch_rad - state.head.pitch_rad, most),
        )

    def _lets_go(self, state: CoreState[S], sensors: Sensors) -> bool:
        """Fallen, or seated with nothing left to do; once limp in a mode, it stays so."""
        if state.mode == "fallen":
            return self._limp_when_fallen or state.leaving
        if state.mode != "rest":
            return False
        seated = self.report(state).phase == "seated" and is_seated(sensors.angles_rad)
        return seated or state.limp


_FALLEN = "the robot has fallen: set it upright, then press the chest button"
_RESTING = "the robot rests: a press of the chest button makes it stand up"


def _head_of(angles: Array) -> HeadAngles:
    return HeadAngles(float(angles[HEAD[0]]), float(angles[HEAD[1]]))


def _within(change: float, most: float) -> float:
    return min(max(change, -most), most)

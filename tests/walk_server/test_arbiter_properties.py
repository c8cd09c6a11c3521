"""Whatever comes, in whatever order: what must hold of what the robot is told."""

from __future__ import annotations

import math

from hypothesis import given, settings
from hypothesis import strategies as st

from hal.types import PlanarMotion, WalkStatus
from naod.messages import WalkCommand
from naod.walk_server import arbiter
from naod.walk_server.rules import Rules
from naod.walk_server.types import (
    ArbiterState,
    End,
    Estop,
    Halt,
    Heartbeat,
    Input,
    MoveTo,
    Received,
    Release,
    Renew,
    SetVelocity,
    Unreadable,
)

RULES = Rules()
PERIOD_NS = 40_000_000
ZERO = PlanarMotion(0.0, 0.0, 0.0)

numbers = st.floats(allow_nan=True, allow_infinity=True) | st.floats(-1.0, 1.0)
commands = st.builds(
    WalkCommand,
    source=st.sampled_from(["tracker", "anna", "bert"]),
    seq=st.integers(0, 40),
    kind=st.sampled_from(["velocity", "step", "stop"]),
    x=numbers,
    y=numbers,
    yaw=numbers,
    ttl_ms=st.integers(1, 1000),
)
# what comes at one tick: inputs, whether the robot has fallen, how late the tick is
rounds = st.tuples(
    st.lists(
        commands
        | st.sampled_from([Estop(), Release(), End(), Unreadable("junk")])
        | st.just("heartbeat"),
        max_size=3,
    ),
    st.booleans() | st.just(False),
    st.integers(1, 5),
)


class Robot:
    """The least that a robot does: what it was told last, until its deadline."""

    def __init__(self) -> None:
        self.told = ZERO
        self.ends_ns = 0

    def obey(self, action: object, now_ns: int) -> None:
        if isinstance(action, SetVelocity):
            self.told, self.ends_ns = action.velocity, now_ns + int(action.valid_for_s * 1e9)
        elif isinstance(action, MoveTo):
            # any velocity stands for a step
            self.told = PlanarMotion(0.01, 0.0, 0.0)
            self.ends_ns = now_ns + int(action.valid_for_s * 1e9)
        elif isinstance(action, Renew):
            self.ends_ns = now_ns + int(action.valid_for_s * 1e9)
        elif isinstance(action, Halt):
            self.told = ZERO

    def status(self, now_ns: int, fallen: bool) -> WalkStatus:
        if now_ns >= self.ends_ns:
            self.told = ZERO
        return WalkStatus(now_ns, self.told != ZERO, fallen, self.told, ZERO)


def _input(item: WalkCommand | Input | str, now_ns: int) -> Input:
    if isinstance(item, WalkCommand):
        return Received(item, now_ns)
    return Heartbeat(now_ns) if isinstance(item, str) else item


@settings(max_examples=300, deadline=None)
@given(st.lists(rounds, max_size=25))
def test_any_sequence_of_messages_keeps_the_promises(play) -> None:
    state, robot, now_ns = ArbiterState(), Robot(), 0
    alive_until_ns = -1
    for items, fallen, late in play:
        now_ns += PERIOD_NS * late
        status = robot.status(now_ns, fallen)
        given_now = [_input(item, now_ns) for item in items]
        for item in given_now:
            before = state.refusals
            state = arbiter.receive(state, item, status, RULES)
            taken = isinstance(item, Received) and state.refusals == before
            if taken and item.command.kind == "velocity":
                alive_until_ns = now_ns + item.command.ttl_ms * 1_000_000
            if taken and item.command.kind == "step":
                alive_until_ns = 2**62
        estopped = state.estopped
        state, action = arbiter.tick(state, status, now_ns, RULES)
        robot.obey(action, now_ns)
        _check_limits(action)
        if estopped or fallen:
            assert robot.told == ZERO
        if now_ns >= alive_until_ns:
            assert robot.told == ZERO


def _check_limits(action: object) -> None:
    if isinstance(action, SetVelocity):
        v = action.velocity
        assert math.hypot(v.x, v.y) <= RULES.speed_max_m_s
        assert abs(v.yaw) <= RULES.turn_max_rad_s
    if isinstance(action, MoveTo):
        assert math.hypot(action.step.x, action.step.y) <= RULES.step_max_m
        assert abs(action.step.yaw) <= RULES.step_turn_max_rad
    if isinstance(action, (SetVelocity, MoveTo, Renew)):
        assert 0.0 < action.valid_for_s <= RULES.valid_for_s


@settings(max_examples=100, deadline=None)
@given(
    st.sampled_from(["velocity", "step"]),
    st.permutations([0, 1, 2]),
    st.sampled_from([math.nan, math.inf, -math.inf]),
    numbers,
    numbers,
)
def test_a_number_that_is_not_finite_never_moves(kind, order, bad, one, other) -> None:
    values = (bad, one, other)
    x, y, yaw = (values[i] for i in order)
    command = WalkCommand(source="op", seq=0, kind=kind, x=x, y=y, yaw=yaw)
    status = WalkStatus(0, False, False, ZERO, ZERO)
    state = arbiter.receive(ArbiterState(halt=False), Received(command, 0), status, RULES)
    state, action = arbiter.tick(state, status, 0, RULES)
    assert state.refusals == 1
    assert state.motion is None
    assert action is None


@settings(max_examples=100, deadline=None)
@given(st.lists(commands, max_size=30))
def test_after_an_estop_nothing_moves_until_release(play: list[WalkCommand]) -> None:
    status = WalkStatus(0, False, False, ZERO, ZERO)
    state = arbiter.receive(ArbiterState(), Estop(), status, RULES)
    for i, command in enumerate(play):
        now_ns = i * PERIOD_NS
        state = arbiter.receive(state, Received(command, now_ns), status, RULES)
        state, action = arbiter.tick(state, status, now_ns, RULES)
        assert action in (None, Halt())

"""Smooth motions of the body while it walks. Pure functions of the time in a phase.

The sway is that of the linear inverted pendulum (`walk_facts.yaml`, lateral_sway: 24 mm at a step
of 0.42 s); roll, pitch and bob are of the size measured there and in real walks.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from sim_backend.poses import ORIGIN, Pose
from sim_backend.steps import DOUBLE_SUPPORT_SHARE, FOOT_SEPARATION_M, STEP_PERIOD_S

GRAVITY_M_S2 = 9.81
COM_HEIGHT_M = 0.26
OMEGA = math.sqrt(GRAVITY_M_S2 / COM_HEIGHT_M)
STEP_HEIGHT_M = 0.020
ROLL_RAD = 0.017
PITCH_RAD = 0.007
BOB_M = 0.0015

_HALF = FOOT_SEPARATION_M / 2.0
SWAY_M = _HALF * (1.0 - 1.0 / math.cosh(OMEGA * STEP_PERIOD_S / 2.0))
SWAY_RATE_M_S = _HALF * OMEGA * math.tanh(OMEGA * STEP_PERIOD_S / 2.0)


def hermite(p0: float, p1: float, v0: float, v1: float, duration: float, t: float) -> float:
    """Cubic from (p0, v0) at 0 to (p1, v1) at `duration`, at time t."""
    s = min(max(t / duration, 0.0), 1.0) if duration > 0.0 else 1.0
    h10, h11 = s * (1.0 - s) ** 2, s * s * (s - 1.0)
    h01 = s * s * (3.0 - 2.0 * s)
    return (1.0 - h01) * p0 + h10 * duration * v0 + h01 * p1 + h11 * duration * v1


def hermite_rate(p0: float, p1: float, v0: float, v1: float, duration: float, t: float) -> float:
    """Time derivative of `hermite`."""
    s = min(max(t / duration, 0.0), 1.0)
    slope = 6.0 * s * (1.0 - s) * (p1 - p0) / duration
    return slope + (1.0 - s) * (1.0 - 3.0 * s) * v0 + s * (3.0 * s - 2.0) * v1


def pose_rates(start: Pose, end: Pose, duration: float) -> Pose:
    """Mean rates from one pose to another, in the frame both are given in."""
    return (
        (end[0] - start[0]) / duration,
        (end[1] - start[1]) / duration,
        (end[2] - start[2]) / duration,
    )


@dataclass(frozen=True, slots=True)
class Glide:
    """The body's reference going smoothly from one pose to another."""

    start: Pose
    end: Pose
    start_rates: Pose
    end_rates: Pose
    duration_s: float

    @classmethod
    def resting(cls, pose: Pose) -> Glide:
        """Staying where it is."""
        return cls(pose, pose, ORIGIN, ORIGIN, 1.0)

    def pose(self, t: float) -> Pose:
        """The reference at a time of the phase."""
        x, y, yaw = (
            hermite(*ends, self.duration_s, t)
            for ends in zip(self.start, self.end, self.start_rates, self.end_rates, strict=True)
        )
        return (x, y, yaw)


@dataclass(frozen=True, slots=True)
class Sway:
    """Sideways motion of the body in a phase, left positive, in m.

    `support` 1 or -1: over that foot in a step; 0: a cubic from `start` to `end`, each a place and
    a rate, after a wait.
    """

    support: int
    start: tuple[float, float]
    end: tuple[float, float]
    wait_s: float
    duration_s: float

    @classmethod
    def resting(cls) -> Sway:
        """No sway."""
        return cls(0, (0.0, 0.0), (0.0, 0.0), 0.0, 1.0)

    @classmethod
    def shift(cls, support: int, wait_s: float, duration_s: float) -> Sway:
        """Swing up to the rate a step over `support` begins with."""
        return cls(0, (0.0, 0.0), (0.0, support * SWAY_RATE_M_S), wait_s, duration_s)

    @classmethod
    def over(cls, support: int) -> Sway:
        """The pendulum's arc over one foot during a step."""
        return cls(support, (0.0, 0.0), (0.0, -support * SWAY_RATE_M_S), 0.0, STEP_PERIOD_S)

    @classmethod
    def settle(cls, place: float, rate: float, duration_s: float) -> Sway:
        """Back to the middle and to rest."""
        return cls(0, (place, rate), (0.0, 0.0), 0.0, duration_s)

    @property
    def ends_towards(self) -> int:
        """Which way the body goes at the end; 0 if it rests."""
        return (self.end[1] > 0.0) - (self.end[1] < 0.0)

    def at(self, t: float) -> tuple[float, float]:
        """Place in m and rate in m/s at a time of the phase."""
        if self.support:
            tau = OMEGA * (min(t, self.duration_s) - STEP_PERIOD_S / 2.0)
            top = math.cosh(OMEGA * STEP_PERIOD_S / 2.0)
            place = self.support * _HALF * (1.0 - math.cosh(tau) / top)
            return place, -self.support * _HALF * OMEGA * math.sinh(tau) / top
        after = t - self.wait_s
        if after <= 0.0:
            return self.start
        ends = (self.start[0], self.end[0], self.start[1], self.end[1], self.duration_s, after)
        return hermite(*ends), hermite_rate(*ends)


def nod(t: float) -> float:
    """0 at both ends of a step, 1 in its middle, smooth."""
    return 0.5 * (1.0 - math.cos(2.0 * math.pi * min(max(t / STEP_PERIOD_S, 0.0), 1.0)))


def swing(t: float) -> tuple[float, float]:
    """Share of the swing foot's way gone, and of its height, at a time of the step.

    The foot leaves the floor after a half of the double support and lands before the other half.
    """
    rest = 0.5 * DOUBLE_SUPPORT_SHARE * STEP_PERIOD_S
    s = min(max((t - rest) / (STEP_PERIOD_S - 2.0 * rest), 0.0), 1.0)
    turn = 2.0 * math.pi * s
    return s - math.sin(turn) / (2.0 * math.pi), 0.5 * (1.0 - math.cos(turn))


def support_share(t: float) -> float:
    """Share of the weight on the supporting foot at a time of the step."""
    half = 0.5 * DOUBLE_SUPPORT_SHARE * STEP_PERIOD_S
    edge = min(t, STEP_PERIOD_S - t)
    return 0.5 + 0.5 * min(max(edge / half, 0.0), 1.0)

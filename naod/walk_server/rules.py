"""What the walk server holds every command to: ranges, limits, times."""

from __future__ import annotations

import math
from dataclasses import dataclass

from hal.types import PlanarMotion
from naod.config import WalkConfig
from naod.messages import WalkCommand

PLACE_RANGE = 10.0
"""m and m/s: more than this is a mistake, not a wish."""

TURN_RANGE = 2.0 * math.pi
"""rad and rad/s."""


@dataclass(frozen=True, slots=True)
class Rules:
    """Limits in m, rad, m/s, rad/s; times in s.

    `valid_for_s` is the deadline given to the robot itself with every motion; `slack_s` is how
    long past a command's ttl that deadline may reach, should this process hang.
    """

    speed_max_m_s: float = 0.12
    turn_max_rad_s: float = 0.6
    step_max_m: float = 0.40
    step_turn_max_rad: float = 1.6
    valid_for_s: float = 0.4
    slack_s: float = 0.1
    tracker_silence_s: float = 0.5
    step_start_s: float = 2.0
    sources_max: int = 64
    source_kept_s: float = 60.0

    @classmethod
    def from_config(cls, walk: WalkConfig) -> Rules:
        """The limits of the configuration file."""
        return cls(
            speed_max_m_s=walk.speed_max_m_s,
            turn_max_rad_s=walk.turn_max_rad_s,
            step_max_m=walk.step_max_m,
            step_turn_max_rad=walk.step_turn_max_rad,
        )

    def longest_step_s(self, step: PlanarMotion) -> float:
        """A step that takes longer than this has gone wrong: twice its way, and time to start."""
        way_s = math.hypot(step.x, step.y) / self.speed_max_m_s
        return 4.0 + 2.0 * (way_s + abs(step.yaw) / self.turn_max_rad_s)


def fault_in(command: WalkCommand) -> str | None:
    """Why the numbers of a command cannot be meant; None if they can."""
    for name, value, bound in (
        ("x", command.x, PLACE_RANGE),
        ("y", command.y, PLACE_RANGE),
        ("yaw", command.yaw, TURN_RANGE),
    ):
        if not math.isfinite(value):
            return f"{name} is not a finite number"
        if abs(value) > bound:
            return f"{name} = {value:g} is out of range (at most {bound:g})"
    return None


def saturate(command: WalkCommand, rules: Rules) -> PlanarMotion:
    """The motion within the limits; the direction in the plane is kept."""
    step = command.kind == "step"
    reach = rules.step_max_m if step else rules.speed_max_m_s
    turn = rules.step_turn_max_rad if step else rules.turn_max_rad_s
    length = math.hypot(command.x, command.y)
    # rounding must not bring the length back over the limit
    scale = 1.0 if length <= reach else reach / length * (1.0 - 1e-12)
    return PlanarMotion(command.x * scale, command.y * scale, min(max(command.yaw, -turn), turn))

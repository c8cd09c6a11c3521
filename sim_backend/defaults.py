"""What a scenario leaves out, filled in; what is impossible in it, refused by key."""

from __future__ import annotations

import math
from typing import Any

import msgspec

from hal.errors import ScenarioError
from hal.scenario import GoalSection, Scenario, ThingSection

CAN = {"radius_m": 0.033, "height_m": 0.115}
BOARD = {"width_m": 0.30, "height_m": 0.20}
CAN_COLOUR = (200, 20, 30)
BOARD_COLOUR = (235, 200, 20)
TABLE_TOP_M = 0.40
CAN_PLACE = (1.2, 0.0, TABLE_TOP_M + CAN["height_m"] / 2.0)
BOARD_PLACE = (1.6, 0.0, 0.50)
CAN_GOAL_M, BOARD_GOAL_M = 0.45, 0.60
DISTRACTOR_COLOURS = ((30, 90, 190), (40, 150, 70), (225, 130, 25), (120, 50, 140))
DISTRACTOR_ASIDE_M = 0.16
LATENCY_MAX_S = 2.0
ROOM_MAX_M = 20.0
ANGLE_MAX_DEG = 3600.0

_SIZES = {"cylinder": ("radius_m", "height_m"), "rectangle": ("width_m", "height_m")}


def resolved(scenario: Scenario) -> Scenario:
    """The scenario with nothing left open. Raises ScenarioError that names the key."""
    _angle("object.yaw_deg", scenario.object.yaw_deg)
    thing = _thing(scenario.object, "object", None, 0)
    others = tuple(
        _thing(other, f"distractor[{n}]", thing, n) for n, other in enumerate(scenario.distractor)
    )
    goal = GoalSection(demonstrate_at=_goal(scenario.goal, thing))
    filled = msgspec.structs.replace(scenario, object=thing, distractor=others, goal=goal)
    _check(filled)
    return filled


def _thing(given: ThingSection, key: str, beside: ThingSection | None, n: int) -> ThingSection:
    sizes = CAN if given.kind == "cylinder" else BOARD
    for name in ("radius_m", "width_m", "height_m"):
        if name not in _SIZES[given.kind] and getattr(given, name) is not None:
            raise ScenarioError(f"{key}.{name}: a {given.kind} has none")
    known: dict[str, Any] = {
        name: getattr(given, name) if getattr(given, name) is not None else sizes[name]
        for name in _SIZES[given.kind]
    }
    colour = CAN_COLOUR if given.kind == "cylinder" else BOARD_COLOUR
    if beside is not None:
        colour = DISTRACTOR_COLOURS[n % len(DISTRACTOR_COLOURS)]
    known["colour"] = colour if given.colour is None else given.colour
    known["position"] = given.position or _place(given.kind, known["height_m"], beside, n)
    return msgspec.structs.replace(given, **known)


def _place(
    kind: str, height: float, beside: ThingSection | None, n: int
) -> tuple[float, float, float]:
    """The object in its place; distractors in turn left and right of it."""
    if beside is None:
        x, y, z = CAN_PLACE if kind == "cylinder" else BOARD_PLACE
        return (x, y, TABLE_TOP_M + height / 2.0) if kind == "cylinder" else (x, y, z)
    assert beside.position is not None
    assert beside.height_m is not None
    x, y, z = beside.position
    aside = DISTRACTOR_ASIDE_M * (n // 2 + 1) * (1.0 if n % 2 == 0 else -1.0)
    if beside.width_m is not None:
        aside *= 1.0 + beside.width_m / DISTRACTOR_ASIDE_M
    yaw = math.radians(beside.yaw_deg)
    if kind == beside.kind == "cylinder":
        z += (height - beside.height_m) / 2.0
    return (x - math.sin(yaw) * aside, y + math.cos(yaw) * aside, z)


def _goal(given: GoalSection, thing: ThingSection) -> tuple[float, float, float]:
    if given.demonstrate_at is not None:
        return given.demonstrate_at
    assert thing.position is not None
    away = CAN_GOAL_M if thing.kind == "cylinder" else BOARD_GOAL_M
    yaw = math.radians(thing.yaw_deg)
    x, y = thing.position[0] + away * math.cos(yaw), thing.position[1] + away * math.sin(yaw)
    facing = math.remainder(thing.yaw_deg + 180.0, 360.0)
    return (round(x, 9), round(y, 9), 180.0 if facing == -180.0 else facing)


def _check(scenario: Scenario) -> None:
    """Figures that are allowed by their type, and still describe no possible world."""
    things = [("object", scenario.object)]
    things += [(f"distractor[{n}]", other) for n, other in enumerate(scenario.distractor)]
    for key, thing in things:
        assert thing.position is not None
        assert thing.height_m is not None
        _near(f"{key}.position", thing.position)
        _angle(f"{key}.yaw_deg", thing.yaw_deg)
        if thing.position[2] - thing.height_m / 2.0 < -1e-6:
            raise ScenarioError(f"{key}.position: its lower edge is below the floor")
    assert scenario.goal.demonstrate_at is not None
    _near("robot.start", scenario.robot.start[:2])
    _angle("robot.start", scenario.robot.start[2])
    _near("goal.demonstrate_at", scenario.goal.demonstrate_at[:2])
    _angle("goal.demonstrate_at", scenario.goal.demonstrate_at[2])
    if scenario.walk.model != "kinematic":
        raise ScenarioError(f'walk.model: "{scenario.walk.model}" is not available yet')
    if not scenario.camera.latency_s <= LATENCY_MAX_S:
        raise ScenarioError(f"camera.latency_s: at most {LATENCY_MAX_S:g}")
    for angle in scenario.camera.mount_error_deg:
        _angle("camera.mount_error_deg", angle)
    for key, value in _amounts(scenario).items():
        if not math.isfinite(value):
            raise ScenarioError(f"{key}: not a finite number")


def _amounts(scenario: Scenario) -> dict[str, float]:
    return {
        "scene.light": scenario.scene.light,
        "scene.light_drift": scenario.scene.light_drift,
        "camera.noise_std": scenario.camera.noise_std,
        "walk.slip_std": scenario.walk.slip_std,
        "walk.yaw_drift": scenario.walk.yaw_drift,
        "walk.push": scenario.walk.push,
        "limits.time_s": scenario.limits.time_s,
    }


def _near(key: str, values: tuple[float, ...]) -> None:
    if not all(math.isfinite(value) and abs(value) <= ROOM_MAX_M for value in values):
        raise ScenarioError(f"{key}: not a place within {ROOM_MAX_M:g} m")


def _angle(key: str, degrees: float) -> None:
    if not (math.isfinite(degrees) and abs(degrees) <= ANGLE_MAX_DEG):
        raise ScenarioError(f"{key}: not an angle within {ANGLE_MAX_DEG:g} degrees")

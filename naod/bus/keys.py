"""The keys under `nao/<robot>/`."""

from __future__ import annotations

WALK_COMMAND = "walk/command"
WALK_STATE = "walk/state"
HEAD_COMMAND = "head/command"
STATE = "state"
EVENT = "event"
DIAGNOSTICS = "diagnostics"
ALIVE = "alive"
TRUTH = "sim/truth"

VERBS = (
    "status",
    "watch",
    "start",
    "stop",
    "estop",
    "release",
    "label",
    "teach",
    "goals",
    "picture",
    "walk",
    "head",
)


def key(robot: str, name: str) -> str:
    """The whole key of a name."""
    return f"nao/{robot}/{name}"


def rpc(verb: str) -> str:
    """The name of a verb's queryable."""
    return f"rpc/{verb}"

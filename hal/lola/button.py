"""The chest button: a press counts when it is let go, a long one as soon as it is long."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

Press = Literal["short", "long"]

DEBOUNCE_S = 0.03
LONG_S = 3.0
"""`lola_protocol.yaml`, chest_button."""


@dataclass(frozen=True, slots=True)
class Button:
    """How long it has been down; `spent` when this press is not to count (any more)."""

    down: bool
    down_s: float
    spent: bool


def begin(down: bool) -> Button:
    """A press that began before us does not count."""
    return Button(down, 0.0, down)


def step(state: Button, down: bool, dt_s: float) -> tuple[Button, Press | None]:
    """Move on by `dt_s`: what was pressed, if anything."""
    if not down:
        counts = state.down and not state.spent and state.down_s >= DEBOUNCE_S
        return Button(False, 0.0, False), "short" if counts else None
    down_s = state.down_s + dt_s if state.down else 0.0
    is_long = down_s >= LONG_S and not state.spent
    return Button(True, down_s, state.spent or is_long), "long" if is_long else None

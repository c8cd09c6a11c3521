"""What the robot as a whole is about, and what makes it change that."""

from __future__ import annotations

from typing import Literal

from hal.lola.button import Press

Mode = Literal["hold", "stand", "rest", "fallen"]
"""hold: as it was found; stand; rest: sit down, then let go; fallen: let go, until a press."""


def after_press(mode: Mode, press: Press, *, seated: bool, on_the_way: bool) -> Mode:
    """A short press sits a robot down or stands it up, a long one always sits it down.

    A robot in a pose from which neither can be reached slowly keeps its mode; one that had fallen
    and was set upright is held as it is.
    """
    if mode == "fallen":
        return "hold"
    if not on_the_way:
        return mode
    if press == "long":
        return "rest"
    is_up = mode == "stand" or (mode == "hold" and not seated)
    return "rest" if is_up else "stand"

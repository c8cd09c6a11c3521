"""What the process of LoLA is told when it is started."""

from __future__ import annotations

from typing import Literal

import msgspec


class Told(msgspec.Struct, frozen=True, kw_only=True):
    """`socket`: LoLA's. `sit_after_s`: a robot whose client has been gone for so long sits down.

    `stand_up`: "button" to hold the pose it is found in until the chest button is pressed, "start"
    to stand up at once. `when_fallen`: "limp" lets go of a robot that has fallen, "stiff" holds its
    joints as they are; either way nothing moves until the chest button is pressed. `slots`:
    measurements kept. `real_time`: ask the kernel for it. `quiet`: say nothing on standard error.
    """

    socket: str
    sit_after_s: float = 10.0
    stand_up: Literal["button", "start"] = "button"
    when_fallen: Literal["limp", "stiff"] = "limp"
    slots: int = 512
    real_time: bool = True
    quiet: bool = False

"""A camera's automatic controls, held still for colour work, read back, and put back at the end.

The order is that of `nao_cameras.yaml`: an automatic is switched off before its value is set.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

from hal.errors import BackendError
from hal.video import v4l2_abi as abi
from hal.video.v4l2_device import Control, V4l2Device

ControlName = Literal["exposure", "gain", "white_balance", "focus"]

_ORDER: tuple[tuple[int, int | ControlName], ...] = (
    (abi.EXPOSURE_AUTO, abi.EXPOSURE_MANUAL),
    (abi.EXPOSURE_AUTO_PRIORITY, 0),
    (abi.EXPOSURE_ABSOLUTE, "exposure"),
    (abi.EXPOSURE, "exposure"),
    (abi.AUTO_GAIN, 0),
    (abi.GAIN, "gain"),
    (abi.AUTO_WHITE_BALANCE, 0),
    (abi.WHITE_BALANCE, "white_balance"),
    (abi.FOCUS_AUTO, 0),
    (abi.FOCUS_ABSOLUTE, "focus"),
    (abi.HUE_AUTO, 0),
)
"""Each control with its value, or with the name under which a value may be given."""

_NAMES: dict[int, str] = {
    abi.EXPOSURE_AUTO: "automatic exposure",
    abi.EXPOSURE_AUTO_PRIORITY: "exposure before frame rate",
    abi.AUTO_GAIN: "automatic gain",
    abi.AUTO_WHITE_BALANCE: "automatic white balance",
    abi.FOCUS_AUTO: "automatic focus",
    abi.HUE_AUTO: "automatic hue",
}


@dataclass(frozen=True, slots=True)
class Setting:
    """One control after it was set. `wanted` None: left as it was found. `trouble` "": it took."""

    number: int
    name: str
    before: int | None
    wanted: int | None
    now: int | None
    trouble: str = ""


def lock(device: V4l2Device, given: Mapping[ControlName, int]) -> list[Setting]:
    """Switch the automatics off and set what is given; the rest stays as the automatics left it.

    Controls that the driver lacks are passed over, unless a value was given for one.
    """
    done: list[Setting] = []
    for number, what in _ORDER:
        wanted = given.get(what) if isinstance(what, str) else what
        setting = _set(device, number, _NAMES.get(number, str(what)), wanted)
        if setting is not None:
            done.append(setting)
    there = {setting.name for setting in done}
    for name, value in given.items():
        if name not in there:
            done.append(Setting(0, name, None, value, None, "the driver has no such control"))
    return done


def put_back(device: V4l2Device, settings: list[Setting]) -> None:
    """Undo, last first: a value while its automatic is still off. Raises OSError."""
    for setting in reversed(settings):
        if setting.before is not None and setting.before != setting.now:
            device.set_value(setting.number, setting.before)


def flip(device: V4l2Device) -> list[Setting] | None:
    """Let the driver turn the picture by 180 degrees; None, and nothing changed, if it cannot."""
    if device.control(abi.H_FLIP) is None or device.control(abi.V_FLIP) is None:
        return None
    done = []
    for number, name in ((abi.H_FLIP, "horizontal flip"), (abi.V_FLIP, "vertical flip")):
        setting = _set(device, number, name, 1)
        if setting is not None:
            done.append(setting)
    if len(done) == 2 and not any(setting.trouble for setting in done):
        return done
    put_back(device, done)
    return None


def check_given(given: Mapping[ControlName, int]) -> None:
    """Raises BackendError for a name that is none."""
    known = {what for _, what in _ORDER if isinstance(what, str)}
    for name in given:
        if name not in known:
            raise BackendError(f"there is no camera control {name!r}; there are: {sorted(known)}")


def _set(device: V4l2Device, number: int, name: str, wanted: int | None) -> Setting | None:
    """Set one control and read it back; None if the driver lacks it."""
    control = device.control(number)
    if control is None:
        return None
    before: int | None = None
    now: int | None = None
    try:
        before = now = device.value(number)
        trouble = "" if wanted is None or wanted == before else _obstacle(control, wanted)
        if wanted is not None and wanted != before and not trouble:
            device.set_value(number, wanted)
            now = device.value(number)
            trouble = "" if now == wanted else f"stayed at {now}, not {wanted}"
    except OSError as error:
        trouble = f"refused: {error.strerror}"
    return Setting(number, name, before, wanted, now, trouble)


def _obstacle(control: Control, wanted: int) -> str:
    if not control.writable:
        return "cannot be set"
    inside = control.low <= wanted <= control.high
    return "" if inside else f"{wanted} is outside {control.low} to {control.high}"

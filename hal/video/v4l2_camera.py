"""A head camera by V4L2: YUYV, the newest picture only, automatics held still, top one upright."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Mapping

from hal.errors import BackendError
from hal.health import Finding
from hal.nao.cameras import READOUT_S, STAMP_DELAY_S
from hal.protocols import Clock
from hal.types import CameraName, Frame
from hal.video.rotation import upright
from hal.video.slot import SlotCamera
from hal.video.v4l2_controls import ControlName, Setting, check_given, flip, lock, put_back
from hal.video.v4l2_device import Shot, V4l2Device
from hal.video.v4l2_kernel import Kernel, Linux

SETTLE_S = 1.0
"""For so long the automatics may look for exposure and white balance, before they are held."""

WAIT_S = 0.2
HUNG_S = 2.0
"""A camera that gives nothing for so long is opened anew."""


class V4l2Camera(SlotCamera):
    """`VideoCamera` on a V4L2 device.

    A frame's stamp is the driver's, moved to the middle of the picture's read-out by the published
    figures of the V6. `exposure_s` is 0: the unit of the sensor's exposure is not published.
    """

    def __init__(
        self,
        path: str,
        name: CameraName,
        size: tuple[int, int],
        fps: int,
        clock: Clock,
        upside_down: bool,
        controls: Mapping[ControlName, int],
        kernel: Kernel,
        settle_s: float = SETTLE_S,
    ) -> None:
        super().__init__(name, size, clock)
        check_given(controls)
        self._path, self._fps, self._kernel = path, fps, kernel
        self._upside_down, self._controls, self._settle_s = upside_down, controls, settle_s
        self._stamp_offset_ns = round(1e9 * (STAMP_DELAY_S[name] + 0.5 * READOUT_S[name]))
        self._closed = threading.Event()
        self.settled = threading.Event()
        """Set when pictures come and the controls are held."""
        self.settings: list[Setting] = []
        self.trouble = "nothing has come yet"
        self._rate: float | None = None
        self._monotonic = True
        self._flips: list[Setting] | None = []
        """What the driver was told to turn; None where it cannot and we do."""
        self._card = ""
        self._thread = threading.Thread(target=self._run, name="v4l2", daemon=True)

    def start(self) -> None:
        """Open the device and read it in a thread. Raises OSError, BackendError."""
        self._device = self._opened()
        self._thread.start()

    def close(self) -> None:
        """Stop, and put the controls back. May be called twice."""
        self._closed.set()
        self.slot.close()
        if self._thread.is_alive():
            self._thread.join(timeout=HUNG_S + 1.0)

    def examine(self) -> list[Finding]:
        """Format, rate, controls; see `hal.health.Examined`."""
        what = f"{self._path} ({self._card}), YUYV {self.size[0]}x{self.size[1]}"
        if self.trouble:
            found = [Finding("camera", "fail", f"{what}: {self.trouble}", "look at its cable")]
        else:
            rate = "" if self._rate is None else f", {self._rate:g} a second"
            found = [Finding("camera", "ok", what + rate + self._turned())]
        if self._rate is not None and abs(self._rate - self._fps) > 0.5:
            text = f"{self._rate:g} pictures a second where {self._fps} were asked for"
            found.append(Finding("camera rate", "warn", text, "set camera.fps to what it gives"))
        if not self._monotonic:
            text = "the driver's time stamps are of another clock; arrival times are used"
            found.append(Finding("camera clock", "warn", text, "walk and look slowly"))
        return found + self._control_findings()

    def _turned(self) -> str:
        if not self._upside_down:
            return ""
        return f", turned by 180 degrees {'here' if self._flips is None else 'by the driver'}"

    def _control_findings(self) -> list[Finding]:
        failed = [setting for setting in self.settings if setting.trouble]
        if not failed:
            held = ", ".join(f"{s.name} {s.now}" for s in self.settings)
            return [Finding("camera controls", "ok", f"held: {held}" if held else "it has none")]
        text = "; ".join(f"{setting.name}: {setting.trouble}" for setting in failed)
        advice = "colours drift with the light: learn them again often, or give a value it takes"
        return [Finding("camera controls", "warn", text, advice)]

    def _opened(self) -> V4l2Device:
        device = V4l2Device(self._path, self._kernel)
        try:
            device.set_format(self.size)
            self._rate = device.set_rate(self._fps)
            self._card = device.card
            self._flips = flip(device) if self._upside_down else []
            device.start()
        except BaseException:
            device.close()
            raise
        return device

    def _run(self) -> None:
        while True:
            device = self._device
            try:
                self._read(device)
            except OSError as error:
                self.trouble = error.strerror or str(error)
            finally:
                with contextlib.suppress(OSError):
                    put_back(device, self.settings + (self._flips or []))
                device.close()
            if not self._reopened():
                return

    def _reopened(self) -> bool:
        """Try until it opens; False when all is over."""
        while not self._closed.wait(WAIT_S):
            try:
                self._device = self._opened()
            except (OSError, BackendError) as error:
                self.trouble = str(error)
                continue
            return True
        return False

    def _read(self, device: V4l2Device) -> None:
        """Hand out pictures until closed. Raises OSError when none comes any more."""
        begun, came, held = time.monotonic(), time.monotonic(), False
        self.settings = []
        while not self._closed.is_set():
            shot, now = device.read(WAIT_S), time.monotonic()
            if shot is None:
                if now - came > HUNG_S:
                    raise TimeoutError(f"no picture for {HUNG_S:g} s")
                continue
            came, self.trouble = now, ""
            self.slot.put(self._frame(shot))
            if not held and now - begun >= self._settle_s:
                self.settings = lock(device, self._controls)
                held = True
                self.settled.set()

    def _frame(self, shot: Shot) -> Frame:
        self._monotonic = shot.monotonic
        time_ns = shot.time_ns if shot.monotonic else time.monotonic_ns()
        yuyv = upright(shot.yuyv) if self._upside_down and self._flips is None else shot.yuyv
        yuyv.flags.writeable = False
        return Frame(time_ns + self._stamp_offset_ns, yuyv, self.name, 0.0, shot.sequence)


def open_v4l2(
    path: str,
    which: CameraName,
    size: tuple[int, int],
    fps: int,
    clock: Clock,
    upside_down: bool,
    controls: Mapping[ControlName, int],
    patience_s: float,
    kernel: Kernel | None = None,
    settle_s: float = SETTLE_S,
) -> V4l2Camera:
    """Open it, wait until pictures come and its controls are held. Raises BackendError."""
    camera = V4l2Camera(
        path, which, size, fps, clock, upside_down, controls, kernel or Linux(), settle_s
    )
    try:
        camera.start()
    except OSError as error:
        raise BackendError(f"camera {path}: {error.strerror or error}") from None
    if patience_s > 0.0 and not camera.settled.wait(patience_s + settle_s):
        camera.close()
        raise BackendError(f"camera {path}: {camera.trouble}")
    return camera

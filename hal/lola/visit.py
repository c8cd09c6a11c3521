"""Looking at a robot on LoLA without taking it over: it is listened to, and told nothing.

Nobody publishes what LoLA does with a client that does not answer; with no client at all it moves
no joint, and so it is taken to do as little with one that is silent. See `lola_protocol.yaml`.
"""

from __future__ import annotations

import time

import numpy as np

from hal.backends import OpenOptions
from hal.clock import MonotonicClock
from hal.errors import HalError
from hal.health import Finding
from hal.lola.client import is_served
from hal.lola.link import connect
from hal.lola.options import checked
from hal.lola.sensors import Sensors, decode_sensors
from hal.nao.joints import JOINT_NAMES
from hal.video.source import open_camera

CONNECT_S, LISTEN_S, PATIENCE_S = 2.0, 1.0, 3.0
PICTURES = 8
_TAKEN = Finding(
    "lola", "warn", "a daemon has this robot, and it is left alone", "ask it: naod ctl status"
)
BATTERY_LOW = 0.2
AGE_MAX_S = 0.25
NOT_THERE = "is LoLA running, with /home/nao/robocup.conf, and no other program on it?"


def examine(options: OpenOptions) -> list[Finding]:
    """LoLA, joints, battery, camera and its clock. Raises BackendError for odd options."""
    told, device, controls = checked(options)
    found: list[Finding] = []
    try:
        # nobody knows what LoLA does with a second client
        found += [_TAKEN] if is_served(told.socket) else _body(_heard(told.socket))
    except HalError as error:
        found.append(Finding("lola", "fail", str(error), NOT_THERE))
    try:
        camera = open_camera(
            device,
            options.camera,
            (options.width, options.height),
            options.fps,
            MonotonicClock(),
            patience_s=PATIENCE_S,
            controls=controls,
        )
    except HalError as error:
        return [*found, Finding("camera", "fail", str(error), "is it plugged in, and free?")]
    try:
        ages_s, last = [], None
        for _ in range(PICTURES):
            frame = camera.next(PATIENCE_S)
            ages_s.append((time.monotonic_ns() - frame.stamp_ns) / 1e9)
            last = frame
        found += [*camera.examine(), _clock(ages_s)]
        if last is not None:
            found.append(_light(float(np.mean(last.yuyv[..., 0]))))
    except HalError as error:
        found.append(Finding("camera", "fail", str(error), "is it plugged in, and free?"))
    finally:
        camera.close()
    return found


def _heard(path: str) -> Sensors:
    """The first message that comes. Raises HalError."""
    link = connect(path, CONNECT_S)
    try:
        deadline = time.monotonic() + LISTEN_S
        while (left := deadline - time.monotonic()) > 0.0:
            message = link.receive(left)
            if message is not None:
                return decode_sensors(message)
    finally:
        link.close()
    raise HalError(f"{path}: connected, and nothing comes within {LISTEN_S:g} s")


def _body(seen: Sensors) -> list[Finding]:
    found = [Finding("lola", "ok", f"robot {seen.body_id}, body version {seen.version}")]
    warmest = f"warmest {seen.temperature_c.max():.0f} C"
    hot = [
        f"{name} {status:.0f}"
        for name, status in zip(JOINT_NAMES, seen.status, strict=True)
        if status > 0.0
    ]
    if hot:
        text = f"status other than 0: {', '.join(hot)}; {warmest}"
        found.append(Finding("joints", "warn", text, "let them cool"))
    else:
        found.append(Finding("joints", "ok", f"all regular, {warmest}"))
    low = seen.battery < BATTERY_LOW
    found.append(
        Finding(
            "battery", "warn" if low else "ok", f"{seen.battery:.0%}", "charge it" if low else ""
        )
    )
    return found


def _clock(ages_s: list[float]) -> Finding:
    """Pictures and joints are both stamped on this machine: what is left is how old they come."""
    middle, worst = float(np.median(ages_s)), max(ages_s)
    text = f"pictures come {1e3 * middle:.0f} ms after their exposure, {1e3 * worst:.0f} at worst"
    if not min(ages_s) >= -0.001 or worst > AGE_MAX_S:
        advice = "its time stamps are not of this machine's clock, or the machine is too busy"
        return Finding("camera clock", "warn", text, advice)
    return Finding("camera clock", "ok", text)


def _light(level: float) -> Finding:
    text = f"mean brightness {level:.0f} of 255"
    if 40.0 <= level <= 215.0:
        return Finding("camera light", "ok", text)
    return Finding("camera light", "warn", text, "set camera.exposure, or mend the light")

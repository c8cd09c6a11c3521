"""Looking at a robot with its stock system without taking it over: joints and pictures are read.

It goes by a name of its own, so that what a daemon holds on the robot stays held. One value that
nobody else reads stays in ALMemory, by which the clocks were compared.
"""

from __future__ import annotations

import contextlib
import time

from hal.backends import OpenOptions
from hal.errors import HalError
from hal.health import Finding
from hal.naoqi.body import Body
from hal.naoqi.camera import NaoqiCamera
from hal.naoqi.channel import Channel
from hal.naoqi.examination import looked_at
from hal.naoqi.options import checked

PICTURE_S = 6.0
NOT_THERE = "does NAOqi run there, and is the network well?"


def examine(options: OpenOptions) -> list[Finding]:
    """System, joints, battery, clocks, camera. Raises BackendError for odd options."""
    told = checked(options)
    name = f"{options.name}-doctor"
    body = Body(Channel(told.url, told.login, "body"), name)
    camera = NaoqiCamera(
        Channel(told.url, told.login, "camera"),
        name,
        options.camera,
        (options.width, options.height),
        options.fps,
        body.clock_offset,
        body.await_at,
        told.controls,
    )
    try:
        body.start()
        found = [_version(body)]
        with contextlib.suppress(HalError):
            camera.start()
            camera.unseen(PICTURE_S)
        found += looked_at(body.session, body, camera)
    except HalError as error:
        return [Finding("naoqi", "fail", str(error), NOT_THERE)]
    finally:
        camera.close()
        body.close()
    return found


def _version(body: Body) -> Finding:
    begun = time.monotonic()
    try:
        version = str(body.session.call("ALSystem", "systemVersion"))
    except HalError as error:
        return Finding("naoqi", "ok", f"answers; its version is not told: {error}")
    took_ms = 1e3 * (time.monotonic() - begun)
    return Finding("naoqi", "ok", f"version {version}, answers in {took_ms:.1f} ms")

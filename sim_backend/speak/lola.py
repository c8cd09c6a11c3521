"""The simulated robot as a NAO V6 with a RoboCup image: LoLA's socket, and the head's camera."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from contextlib import ExitStack

from hal.backends import OpenOptions, Ready
from hal.errors import BackendError
from hal.nao.postures import posture
from hal.video.server import FrameServer
from sim_backend.backend import warm_up
from sim_backend.body import Body
from sim_backend.camera import SimCamera
from sim_backend.clocks import RealClock
from sim_backend.eye import Eye
from sim_backend.options import SimOptions, checked
from sim_backend.room import furnished
from sim_backend.scene import Scene, build_scene
from sim_backend.speak.lola_body import JointWorld
from sim_backend.speak.lola_server import LolaServer

POSTURE = "StandInit"
"""It stands as the simulation's own robot does, its joints free, as if held by somebody."""


def serve(
    options: OpenOptions, address: str, camera: str | None, stop: threading.Event, ready: Ready
) -> None:
    """See `hal.backends.speak`.

    `camera`: a port of this machine's loopback (0 for a free one), else as `FrameServer` has it.
    """
    told = checked(options)
    if told.version != "v6":
        raise BackendError(f"LoLA is of the V6, not of the {told.version}")
    with ExitStack() as stack:
        scene = None
        if camera is not None:
            scene = build_scene(furnished(told.scenario, told.folder, told.seed), True)
            warm_up(scene)
        world = JointWorld(
            told.scenario, told.version, told.seed, time.monotonic_ns, posture(POSTURE)
        )
        clock = RealClock(world)
        stack.callback(clock.close)
        served: dict[str, object] = {"speaks": "lola", "socket": address}
        if camera is not None and scene is not None:
            frames = FrameServer(
                _frame_address(camera), _eye(world, clock, scene, options, told, stack)
            )
            stack.callback(frames.close)
            frames.start()
            served |= {
                "camera": frames.address,
                "which": options.camera,
                "width": options.width,
                "height": options.height,
                "fps": options.fps,
            }
        server = LolaServer(address, world, _say)
        if threading.current_thread() is threading.main_thread():
            signal.signal(signal.SIGUSR1, lambda _number, _frame: server.press())
            served["chest_button"] = f"kill -USR1 {os.getpid()}"
        ready(served)
        server.run(stop)


def _eye(
    world: JointWorld,
    clock: RealClock,
    scene: Scene,
    options: OpenOptions,
    told: SimOptions,
    stack: ExitStack,
) -> SimCamera:
    body = Body(told.version)
    stack.callback(body.close)
    size = (options.width, options.height)
    eye = Eye(
        world, scene, body, told.scenario, told.version,
        options.camera, size, options.fps, told.seed,
    )  # fmt: skip
    return SimCamera(eye, world, clock, told.scenario.camera, options.fps, told.seed)


def _frame_address(camera: str) -> str:
    if not camera.isdecimal():
        return camera
    if int(camera) > 65535:
        raise BackendError(f"camera: no port {camera}")
    return f"tcp://127.0.0.1:{camera}"


def _say(text: str) -> None:
    print(f"naod robot: {text}", file=sys.stderr, flush=True)

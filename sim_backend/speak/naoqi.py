"""A simulated robot that speaks NAOqi: a standalone `qi` session with the services of a NAO.

What it offers, and how it behaves, is that of `naoqi_api.yaml`, by methods that programs use; a
method that is not there raises as on a robot. Differences: only the head turns by setAngles, it
does not crouch, nobody can subscribe to events, pictures are YUV422 only. One service no robot has:
SimWorld, with the truth and with faults.
"""

from __future__ import annotations

import gc
import threading
from collections.abc import Callable
from typing import Any

from hal.backends import OpenOptions
from hal.errors import BackendError
from sim_backend.speak.naoqi_options import PeerOptions, split

DEFAULT_URL = "tcp://127.0.0.1:9559"
PAUSE_S = 0.5
"""How long a restart takes."""
SHORT_S = 0.2


def serve(
    options: OpenOptions,
    address: str,
    camera: str | None,
    stop: threading.Event,
    ready: Callable[[dict[str, object]], None],
) -> None:
    """Serve until told to stop; `ready` is told `{"url": ..., "services": [...]}`.

    `address`: a URL or HOST:PORT, port 0 for any; "" for NAOqi's own. Raises BackendError.
    """
    try:
        import qi
    except ImportError as error:
        raise BackendError(f"the NAOqi peer needs the package qi: {error}") from None
    from sim_backend.speak.naoqi_robot import PeerRobot

    qi.logging.setLevel(qi.logging.FATAL)
    if camera:
        raise BackendError("a NAOqi robot gives its pictures by ALVideoDevice, not elsewhere")
    told, simulation = split(options)
    robot = PeerRobot(simulation, told)
    try:
        _serve(robot, _url(address), stop, ready)
    finally:
        _settle()
        robot.close()


def _serve(
    robot: Any, url: str, stop: threading.Event, ready: Callable[[dict[str, object]], None]
) -> None:
    from sim_backend.speak.naoqi_gate import Gate

    restart = threading.Event()
    told: PeerOptions = robot.told
    # with a login the services are behind a gate
    session, names = _listen(robot, "tcp://127.0.0.1:0" if told.password else url, restart)
    inner = str(session.endpoints()[0])
    gate = Gate(url, inner, told) if told.password else None
    ready({"url": gate.url if gate else inner, "services": names})
    while not stop.wait(0.05):
        if restart.is_set():
            session.close()
            robot.sim.walk.stop()
            stop.wait(PAUSE_S)
            restart.clear()
            session, _ = _listen(robot, inner, restart)
    robot.dismiss()
    if gate is not None:
        gate.close()
    session.close()


def _settle() -> None:
    """Let qi's threads drop what they hold of ours: an interpreter must not end under them."""
    gc.collect()
    threading.Event().wait(SHORT_S)


def _listen(robot: Any, url: str, restart: threading.Event) -> tuple[Any, list[str]]:
    import qi

    session = qi.Session()
    try:
        session.listenStandalone(url)
    except RuntimeError as error:
        why = " ".join(str(error).split()).partition(" [")[0].rpartition(": ")[2]
        raise BackendError(f"cannot listen on {url}: {why or error}") from None
    services = _services(robot, restart)
    for name, service in services.items():
        session.registerService(name, service)
    return session, sorted(services)


def _services(robot: Any, restart: threading.Event) -> dict[str, Any]:
    from sim_backend.speak.naoqi_life import Life, Posture, Switch, System
    from sim_backend.speak.naoqi_memory import Memory
    from sim_backend.speak.naoqi_motion import Motion
    from sim_backend.speak.naoqi_video import video_service
    from sim_backend.speak.naoqi_world import SimWorld

    switches = ("ALBasicAwareness", "ALBackgroundMovement", "ALAutonomousBlinking")
    offered: dict[str, Any] = {
        "ALMotion": Motion(robot),
        "ALVideoDevice": video_service(robot),
        "ALMemory": Memory(robot),
        "ALRobotPosture": Posture(robot),
        "ALAutonomousLife": Life(robot),
        "ALSystem": System(),
        **{name: Switch(robot, name) for name in switches},
        "SimWorld": SimWorld(robot, restart),
    }
    return {name: one for name, one in offered.items() if name not in robot.told.missing}


def _url(address: str) -> str:
    if not address:
        return DEFAULT_URL
    return address if "://" in address else f"tcp://{address}"

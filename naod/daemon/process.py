"""The daemon: everything opened in order, watched, and closed in order."""

from __future__ import annotations

import logging
import queue
import signal
import sys
from contextlib import ExitStack
from functools import partial
from pathlib import Path
from types import FrameType
from typing import Literal

from hal.protocols import Robot
from hal.simulation import SimulatedRobot
from naod.bus.bus import Bus
from naod.config import DaemonConfig, state_folder
from naod.daemon.act import Actor
from naod.daemon.desk import Desk
from naod.daemon.faults import Faults
from naod.daemon.loop import Loop
from naod.daemon.notify import Notifier
from naod.daemon.opening import open_configured, shape_for
from naod.daemon.store import Store
from naod.daemon.truth import TruthTeller
from naod.daemon.verbs import Verbs
from naod.daemon.warm_up import warm_up
from naod.loop.equipment import Equipment
from naod.loop.state import LoopState
from naod.messages import RobotMessage
from naod.walk_server.rules import Rules
from naod.walk_server.server import WalkServer

log = logging.getLogger("naod")

News = queue.SimpleQueue[Literal["warm", "ended", "stop"]]
"""What the main thread waits for: the kernels are compiled, a thread has ended, a signal came."""

WAKE_S = 0.25


def run_daemon(config: DaemonConfig, beside: Path) -> int:
    """Run until told to stop: 0 after a signal, 1 when a part of us ended by itself.

    Raises InputError and HalError for whatever cannot be opened.
    """
    logging.basicConfig(
        level=config.log.level.upper(), stream=sys.stderr, format="naod: %(levelname)s: %(message)s"
    )
    news: News = queue.SimpleQueue()

    def stop(_number: int, _frame: FrameType | None) -> None:
        news.put("stop")

    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, stop)
    with ExitStack() as stack:
        notifier = Notifier.from_environment()
        stack.callback(notifier.close)
        verbs = _open(config, beside, stack, notifier, news)
        told = _next(news)
        if told == "warm":
            verbs.declare()
            notifier.ready()
            log.info("ready")
            told = _next(news)
        notifier.stopping()
        log.info("stopping")
    return 0 if told == "stop" else 1


def _next(news: News) -> str:
    """What has come; waits for it.

    The kernel may hand a signal to any thread, and Python runs its handler in this one once it
    wakes up: so it does, now and then.
    """
    while True:
        try:
            return news.get(timeout=WAKE_S)
        except queue.Empty:
            continue


def _open(
    config: DaemonConfig, beside: Path, stack: ExitStack, notifier: Notifier, news: News
) -> Verbs:
    """Open every part; the stack closes them the other way round."""
    store = Store(state_folder(config))
    state = LoopState.initial(store.goals(), store.model())
    bus = Bus.open(config.bus, config.robot.name)
    stack.callback(bus.close)
    robot = open_configured(config, beside)
    stack.callback(robot.close)
    equipment = Equipment.from_config(config, robot.info, shape_for(config, robot))

    server = WalkServer(robot, bus, Rules.from_config(config.walk), store.latch)
    stack.callback(server.close)
    server.on_end = partial(news.put, "ended")
    server.start()
    if isinstance(robot, SimulatedRobot):
        teller = TruthTeller(robot, bus)
        stack.callback(teller.close)
        teller.start()

    desk = Desk()
    stack.callback(desk.fail_all, "stopping", "the daemon is closing down")
    actor = Actor(bus, server.head, store, desk, Faults())
    loop = Loop(robot, bus, server, actor, desk, equipment, state)
    stack.callback(loop.close)
    # once more, to be the first thing closed: the walk stops before anything else
    stack.callback(server.close)
    verbs = Verbs(bus, _robot_message(robot), server, loop, actor, desk)
    loop.after_tick = notifier.alive
    loop.on_end = partial(news.put, "ended")
    loop.before_first = partial(_begin, equipment, robot, news)
    endpoints = ", ".join(config.bus.listen) or "no endpoint"
    log.info("robot %s (%s), listening on %s", robot.info.name, robot.info.backend, endpoints)
    log.info("state folder %s", store.folder)
    loop.start()
    return verbs


def _begin(equipment: Equipment, robot: Robot, news: News) -> None:
    """In the loop's own thread, before its first tick."""
    warm_up(equipment, robot)
    news.put("warm")


def _robot_message(robot: Robot) -> RobotMessage:
    info = robot.info
    return RobotMessage(
        name=info.name, version=info.version, backend=info.backend, simulated=info.simulated
    )

"""What the services of the NAOqi peer share: the simulated body, its motors, its clock."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from hal.backends import OpenOptions
from hal.nao.joints import JOINT_INDEX, JOINT_NAMES
from hal.types import BodyState
from sim_backend.backend import SimRobot
from sim_backend.options import checked
from sim_backend.speak.naoqi_options import PeerOptions

CYCLE_NS = 20_000_000
STIFFNESS_MIN = 0.6
DISMISS_S = 3.0
_LEGS = [n for n, name in enumerate(JOINT_NAMES) if "Hip" in name or "Knee" in name]
_LEGS += [n for n, name in enumerate(JOINT_NAMES) if "Ankle" in name]

GROUPS: dict[str, tuple[str, ...]] = {
    "Body": JOINT_NAMES,
    "Head": ("HeadYaw", "HeadPitch"),
    "LLeg": tuple(JOINT_NAMES[8:14]),
    "RLeg": tuple(JOINT_NAMES[14:20]),
    "Legs": tuple(JOINT_NAMES[8:20]),
}


def joint_indices(names: object) -> list[int]:
    """Indices of a joint, a chain or a list of them. Raises ValueError."""
    listed = names if isinstance(names, list | tuple) else [names]
    found: list[int] = []
    for name in listed:
        for joint in GROUPS.get(str(name), (str(name),)):
            if joint not in JOINT_INDEX:
                raise ValueError(f"{joint} is not a valid joint or chain name")
            found.append(JOINT_INDEX[joint])
    return found


class PeerRobot:
    """The simulated robot as NAOqi's services see it. Safe to use from any thread."""

    def __init__(self, options: OpenOptions, told: PeerOptions) -> None:
        self.options, self.told = options, told
        sim = checked(options)
        self.version = sim.version
        self.sim = SimRobot(replace(options, version=sim.version), sim)
        self.closing = threading.Event()
        self.lock = threading.RLock()
        self._idle = threading.Condition(self.lock)
        self._waiting = 0
        self.awake = not told.resting
        self.stiffness: NDArray[np.float64] = np.full(len(JOINT_NAMES), float(self.awake))
        self.life = told.life
        self.lifted = False
        self.picture_ns = 0
        self.refusals: dict[str, str] = {}
        self.calls: dict[str, int] = {}

    def now_ns(self) -> int:
        """The robot's clock."""
        return time.monotonic_ns() + round(self.told.clock_offset_s * 1e9)

    def enter(self, name: str) -> None:
        """A method is called. Raises RuntimeError if it is to refuse."""
        with self.lock:
            self.calls[name] = self.calls.get(name, 0) + 1
            text = self.refusals.get(name)
        if text is not None:
            raise RuntimeError(text)

    @contextmanager
    def blocking(self) -> Iterator[None]:
        """Around a method that waits: the services are closed only after it."""
        with self.lock:
            self._waiting += 1
        try:
            yield
        finally:
            with self._idle:
                self._waiting -= 1
                self._idle.notify_all()

    def dismiss(self) -> None:
        """Let every method that waits return: an interpreter must not end under one."""
        self.closing.set()
        with self._idle:
            self._idle.wait_for(lambda: self._waiting == 0, DISMISS_S)

    def measured(self) -> BodyState:
        """The body as ALMotion's last cycle measured it."""
        now_ns = time.monotonic_ns()
        state = self.sim.body.at(now_ns - now_ns % CYCLE_NS)
        return self.sim.body.latest() if state is None else state

    @property
    def fallen(self) -> bool:
        """Whether it lies."""
        return self.sim.walk.status().fallen

    @property
    def has_contact(self) -> bool:
        """Whether a foot touches the floor."""
        return not self.lifted and not self.fallen

    def objection(self) -> str | None:
        """Why NAOqi would not walk: `naoqi_api.yaml`, walk_refused_when."""
        if float(self.stiffness[_LEGS].min()) <= STIFFNESS_MIN:
            return "stiffness of the legs"
        return None if self.has_contact else "no ground contact"

    def set_motors(self, awake: bool) -> None:
        """Motors on or off, all of them."""
        with self.lock:
            self.awake = awake
            self.stiffness[:] = float(awake)
        if not awake:
            self.sim.walk.stop()

    def close(self) -> None:
        """Let go of the simulation."""
        self.closing.set()
        self.sim.close()

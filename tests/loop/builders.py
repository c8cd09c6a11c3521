"""Hand-made observations for the loop's step: no pictures, no robot."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from hal.nao.postures import posture
from hal.types import BodyState, Frame, HeadAngles, RobotInfo
from naod.approach.displacement import goal_from
from naod.config import DaemonConfig
from naod.localisation.ego import EgoPose
from naod.localisation.looks import Look
from naod.loop.core import decide
from naod.loop.equipment import Equipment, Sighting
from naod.loop.state import LoopState
from naod.loop.types import Observation, Request
from naod.messages import WalkState
from naod.perception.blob import Blob
from naod.perception.colour_model import ColourModel
from naod.pose.objects import Rectangle
from naod.pose.result import ObjectPose

MODEL = ColourModel(mean=(100.0, 90.0, 200.0), covariance=((9.0, 0, 0), (0, 9.0, 0), (0, 0, 9.0)))
PERIOD_NS = 1_000_000_000 // 15
INFO = RobotInfo("nao", "v6", "sim", True)


def equipment():
    return Equipment.from_config(DaemonConfig(), INFO, Rectangle())


def body():
    return BodyState(
        stamp_ns=0,
        angles_rad=posture("StandInit"),
        gyro_rad_s=np.zeros(3),
        accel_m_s2=np.array([0.0, 0.0, 9.81]),
        torso_roll_pitch_rad=np.zeros(2),
        fsr_kg=np.full(8, 0.65),
        battery=0.9,
        temperature_max_c=40.0,
    )


def walk(moving=False, fallen=False, held_by=None, refused=None):
    return WalkState(
        seq=1,
        stamp_ns=0,
        moving=moving,
        fallen=fallen,
        held_by=held_by,
        velocity=(0.0, 0.0, 0.0),
        last_source="tracker",
        refused=refused,
        odometry=(0.0, 0.0, 0.0),
    )


def ego(x, y, phi=math.pi):
    return EgoPose(math.hypot(x, y), math.atan2(y, x), 0.45, phi)


class Bench:
    """Runs `decide` tick by tick on a virtual clock."""

    def __init__(self, **state):
        self.equipment = equipment()
        goals = {"desk": goal_from("rectangle", ego(0.5, 0.0), 0.001)}
        self.state = replace(LoopState.initial(goals, MODEL), **state)
        self.now_ns = 1_000_000_000
        self.walk = walk()
        self.sees: EgoPose | None = ego(1.0, 0.0)
        self.ray = np.array([0.0, 0.0, 1.0])
        self.camera_on = True
        self.with_pose = True
        self.events = []

    def tick(self, *verbs, ticks=1):
        """Let some periods pass; the verbs come with the first one. The last commands."""
        requests = tuple(Request(i, verb) for i, verb in enumerate(verbs, start=1))
        for _ in range(ticks):
            self.now_ns += PERIOD_NS
            seen = Observation(self._frame(), body(), self.walk, requests)
            self.state, commands = decide(
                self.equipment, self.state, seen, self._sighting(), self.now_ns
            )
            self.events += [event.kind for event in commands.events]
            requests = ()
        return commands

    def until(self, condition, limit=600):
        """Tick until a condition on the commands holds; fails the test if it never does."""
        for _ in range(limit):
            commands = self.tick()
            if condition(commands):
                return commands
        raise AssertionError(f"did not come about in {limit} ticks; state {self.state}")

    def walk_a_step(self):
        """The robot begins to walk, walks for a second, and stands."""
        self.walk = walk(moving=True)
        self.tick(ticks=15)
        self.walk = walk()

    def _frame(self):
        if not self.camera_on:
            return None
        return Frame(self.now_ns, np.zeros((480, 640, 2), np.uint8), "top", 0.01, 0)

    def _sighting(self):
        if self.sees is None or not self.camera_on or self.state.mode == "idle":
            return None
        pose = ObjectPose(np.eye(4), np.eye(6) * 1e-6, np.zeros((4, 2)), "exact")
        return Sighting(
            stamp_ns=self.now_ns,
            blob=BLOB,
            segmentation=None,
            ray_in_camera=self.ray,
            head=HeadAngles(0.0, 0.0),
            T_torso_camera=self.equipment.body.frames(posture("StandInit")).T_torso_camera,
            pose=pose if self.with_pose else None,
            look=Look(self.now_ns, self.sees, np.eye(4) * 1e-6) if self.with_pose else None,
            paper=None,
        )


BLOB: Blob | None = None

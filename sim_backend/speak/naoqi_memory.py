"""ALMemory: what the body reports, twice a second as on NAOqi 2.8, and what is written into it."""

from __future__ import annotations

import threading

import qi

from hal.nao.joints import JOINT_NAMES
from hal.types import BodyState
from sim_backend.speak.naoqi_robot import PeerRobot

REFRESH_NS = 500_000_000
_DEVICE = "Device/SubDeviceList"
_CELLS = ("FrontLeft", "FrontRight", "RearLeft", "RearRight")


def device_values(state: BodyState, *, lifted: bool) -> dict[str, float]:
    """The device keys of a measurement (`naoqi_api.yaml`, ALMemory keys)."""
    found: dict[str, float] = {}
    inertial = f"{_DEVICE}/InertialSensor"
    for n, axis in enumerate("XYZ"):
        found[f"{inertial}/Gyroscope{axis}/Sensor/Value"] = float(state.gyro_rad_s[n])
        found[f"{inertial}/Accelerometer{axis}/Sensor/Value"] = float(state.accel_m_s2[n])
    for n, axis in enumerate("XY"):
        found[f"{inertial}/Angle{axis}/Sensor/Value"] = float(state.torso_roll_pitch_rad[n])
    for n, (side, cell) in enumerate((side, cell) for side in "LR" for cell in _CELLS):
        load = 0.0 if lifted else float(state.fsr_kg[n])
        found[f"{_DEVICE}/{side}Foot/FSR/{cell}/Sensor/Value"] = load
    found[f"{_DEVICE}/Battery/Charge/Sensor/Value"] = state.battery
    for n, name in enumerate(JOINT_NAMES):
        found[f"{_DEVICE}/{name}/Temperature/Sensor/Value"] = state.temperature_max_c
        found[f"{_DEVICE}/{name}/Temperature/Sensor/Status"] = 0.0
        found[f"{_DEVICE}/{name}/Position/Sensor/Value"] = float(state.angles_rad[n])
    return found


@qi.multiThreaded()
class Memory:
    """ALMemory."""

    def __init__(self, robot: PeerRobot) -> None:
        self._robot = robot
        self._lock = threading.Lock()
        self._written: dict[str, tuple[object, int]] = {}
        self._device: dict[str, float] = {}
        self._device_ns = -REFRESH_NS

    def getData(self, name: str) -> object:
        """A value. Raises RuntimeError for a name it does not know."""
        self._robot.enter("ALMemory.getData")
        found = self._all()
        if name not in found:
            raise RuntimeError(f"ALMemory: the data {name} does not exist")
        return found[name]

    def getListData(self, names: list[str]) -> list[object]:
        """Many values in one round trip; None for names it does not know."""
        self._robot.enter("ALMemory.getListData")
        found = self._all()
        return [found.get(str(name)) for name in names]

    def insertData(self, name: str, value: object) -> None:
        """Write a value, stamped with the robot's clock."""
        self._robot.enter("ALMemory.insertData")
        with self._lock:
            self._written[str(name)] = (value, self._robot.now_ns())

    def raiseEvent(self, name: str, value: object) -> None:
        """As `insertData`: nobody subscribes here."""
        self.insertData(name, value)

    def getTimestamp(self, name: str) -> list[object]:
        """Value, seconds, microseconds."""
        self._robot.enter("ALMemory.getTimestamp")
        with self._lock:
            if name not in self._written:
                raise RuntimeError(f"ALMemory: the data {name} does not exist")
            value, stamp_ns = self._written[name]
        return [value, stamp_ns // 1_000_000_000, stamp_ns % 1_000_000_000 // 1000]

    def getDataListName(self) -> list[str]:
        """All names."""
        return sorted(self._all())

    def _all(self) -> dict[str, object]:
        now_ns = self._robot.now_ns()
        with self._lock:
            if now_ns - self._device_ns >= REFRESH_NS:
                self._device_ns = now_ns
                state = self._robot.sim.body.latest()
                self._device = device_values(state, lifted=self._robot.lifted)
            written = {name: value for name, (value, _) in self._written.items()}
            device = dict(self._device)
        events: dict[str, object] = {"footContactChanged": self._robot.has_contact}
        if self._robot.fallen:
            events["robotHasFallen"] = True
        return {**device, **events, **written}

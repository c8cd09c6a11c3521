"""What the backend says of itself, well and unwell."""

from __future__ import annotations

import pytest
from naoqi_peer import until

from hal.errors import MotionRefusedError
from hal.health import Examined
from hal.types import PlanarMotion


def by_check(robot):
    found = {finding.check: finding for finding in robot.examine()}
    assert all(finding.status == "ok" or finding.text for finding in found.values())
    return found


def test_well(robot):
    assert isinstance(robot, Examined)
    found = by_check(robot)
    assert [f for f in found.values() if f.status != "ok"] == []
    assert "8 there" in found["naoqi services"].text
    assert "+4321.500 s from ours" in found["clock"].text
    assert "160x120" in found["camera"].text
    assert "held" in found["camera controls"].text


@pytest.mark.slow
def test_unwell(peer, robot):
    hot = "Device/SubDeviceList/LKneePitch/Temperature/Sensor/Status"
    peer.ask.call("ALMemory", "insertData", hot, 2.0)
    peer.world("lift", True)
    until(lambda: robot.walk.status().fallen)
    found = by_check(robot)
    assert "hot: LKneePitch" in found["joints"].text
    assert "lifted" in found["walk"].text
    peer.world("lift", False)
    peer.ask.call("ALMemory", "insertData", hot, 0.0)
    until(lambda: not robot.walk.status().fallen)
    peer.world("refuse", "ALMotion.moveTo", "not today")
    with pytest.raises(MotionRefusedError):
        robot.walk.move_to(PlanarMotion(0.1, 0.0, 0.0), 1.0)
    assert "not today" in by_check(robot)["walk"].text


@pytest.mark.slow
def test_closed(robot):
    robot.close()
    (only,) = robot.examine()
    assert only.status == "fail"

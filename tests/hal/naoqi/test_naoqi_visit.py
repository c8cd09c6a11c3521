"""Looking at a robot with its stock system: what was held stays held, nothing is left behind."""

from __future__ import annotations

from hal.backends import OpenOptions, examine
from hal.naoqi.ids import PARAMETERS


def controls(peer):
    asked = [PARAMETERS[f"kCamera{name}ID"] for name in ("AutoExposition", "AutoWhiteBalance")]
    return [peer.ask.call("ALVideoDevice", "getParameter", 0, number) for number in asked]


def test_a_visit_leaves_everything_as_it_was(peer):
    before = controls(peer), peer.world("truth")
    options = OpenOptions(name="test", width=160, height=120, section={"url": peer.url})
    found = {finding.check: finding for finding in examine("naoqi", options)}
    assert [f for f in found.values() if f.status == "fail"] == []
    assert found["camera controls"].status == "ok"
    assert "+4321.500 s from ours" in found["clock"].text
    truth = peer.world("truth")
    assert controls(peer) == before[0]
    assert (truth["moving"], truth["base"]) == (False, before[1]["base"])
    assert peer.ask.call("ALVideoDevice", "getSubscribers") == []


def test_a_robot_that_is_not_there_is_a_finding():
    options = OpenOptions(section={"url": "tcp://127.0.0.1:1"})
    (found,) = examine("naoqi", options)
    assert (found.status, found.check) == ("fail", "naoqi")
    assert found.advice

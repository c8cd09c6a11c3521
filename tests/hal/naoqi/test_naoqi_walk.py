"""Walking by NAOqi, on the simulated robot in another process; measured at the robot."""

from __future__ import annotations

import math
import time

import numpy as np
import pytest
from naoqi_peer import until
from naoqi_proxy import Network

from hal.errors import MotionRefusedError
from hal.types import HeadAngles, PlanarMotion

AHEAD = PlanarMotion(0.08, 0.0, 0.0)


def walked(peer):
    return math.hypot(*peer.world("truth")["base"][:2])


def finish(walker):
    """Renew until it stands."""

    def stands():
        walker.walk.renew(0.5)
        return not walker.walk.status().moving

    until(stands)


def test_displacement_is_walked_and_ends_by_itself(peer, walker):
    assert not walker.walk.status().moving
    assert walker.walk.move_to(AHEAD, 0.5) == AHEAD
    status = walker.walk.status()
    assert status.moving
    assert status.velocity.x > 0.05
    finish(walker)
    assert walked(peer) == pytest.approx(0.08, rel=0.2)
    status = walker.walk.status()
    assert status.velocity == PlanarMotion(0.0, 0.0, 0.0)
    assert status.odometry.x == pytest.approx(0.08, abs=1e-3)
    assert walker.guard.fired == 0


def test_blocking_move_delays_neither_angles_nor_head(peer, walker):
    """moveTo returns only when the robot stands; all else goes on meanwhile."""
    walker.walk.move_to(PlanarMotion(0.12, 0.0, 0.0), 0.5)
    until(peer.is_moving)
    stamps, looks = [], []
    while len(stamps) < 40:
        stamp_ns = walker.body.latest().stamp_ns
        assert walker.body.await_at(stamp_ns + 1, 2.0)
        stamps.append(stamp_ns)
        walker.walk.renew(0.5)
        begin_s = time.monotonic()
        walker.head.look(HeadAngles(0.01 * len(looks), 0.0), 1.0)
        looks.append(time.monotonic() - begin_s)
    assert peer.is_moving()
    # a moveTo in the way would have held them up for the whole of its second and more
    assert np.median(np.diff(stamps)) / 1e9 < 0.1
    assert np.median(looks) < 0.03
    walker.walk.stop()
    until(lambda: not peer.is_moving())


@pytest.mark.slow
def test_velocity_is_walked_while_it_is_renewed(peer, walker):
    sent = walker.walk.set_velocity(PlanarMotion(1.0, 0.0, 0.0), 0.5)
    assert sent.x == pytest.approx(0.095)

    def is_under_way():
        walker.walk.renew(0.5)
        return walked(peer) > 0.06

    until(is_under_way)
    assert walker.walk.status().velocity == sent
    walker.walk.set_velocity(PlanarMotion(0.0, 0.0, 0.0), 0.5)
    assert walker.walk.status().velocity == PlanarMotion(0.0, 0.0, 0.0)
    until(lambda: not walker.walk.status().moving)
    assert walker.guard.fired == 0


@pytest.mark.parametrize("kind", ["velocity", pytest.param("displacement", marks=pytest.mark.slow)])
def test_motion_that_is_not_renewed_is_ended_by_the_watchdog(peer, walker, kind):
    """S1, for a walk server that hangs: told to stop within 0.3 s of its time, standing in 1.2."""
    begin_s = time.monotonic()
    if kind == "velocity":
        walker.walk.set_velocity(PlanarMotion(0.09, 0.0, 0.0), 0.6)
    else:
        walker.walk.move_to(PlanarMotion(0.5, 0.0, 0.0), 0.6)
    until(peer.is_moving)
    until(lambda: peer.world("truth")["velocity"] == [0.0, 0.0, 0.0])
    assert 0.5 < time.monotonic() - begin_s < 0.6 + 0.3
    until(lambda: not peer.is_moving())
    assert time.monotonic() - begin_s < 0.6 + 1.2
    until(lambda: not walker.walk.status().moving)
    assert walker.guard.fired >= 1


def test_stop_ends_on_both_feet(peer, walker):
    walker.walk.move_to(PlanarMotion(0.4, 0.0, 0.0), 1.0)
    until(peer.is_moving)
    walker.walk.stop()
    assert walker.walk.status().velocity == PlanarMotion(0.0, 0.0, 0.0)
    until(lambda: not walker.walk.status().moving)
    assert not peer.is_moving()
    assert walked(peer) < 0.3


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_not_finite_never_reaches_the_robot(peer, walker, bad):
    calls = peer.world("calls", "ALMotion.moveTo")
    with pytest.raises(MotionRefusedError, match="not finite"):
        walker.walk.move_to(PlanarMotion(bad, 0.0, 0.0), 0.5)
    with pytest.raises(MotionRefusedError, match="not finite"):
        walker.head.look(HeadAngles(bad, 0.0), 1.0)
    assert peer.world("calls", "ALMotion.moveTo") == calls


def refused(walker):
    with pytest.raises(MotionRefusedError) as caught:
        walker.walk.move_to(AHEAD, 0.5)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_low_stiffness_is_told_and_stood_up_from(peer, walker):
    peer.motion("setStiffnesses", "LKneePitch", 0.4)
    until(lambda: (walker.walk.stance.readiness.leg_stiffness or 1.0) < 0.5)
    assert "stiffness of the legs is 0.4, NAOqi walks only above 0.6" in refused(walker)
    assert not peer.is_moving()
    until(lambda: not walker.walk.status().moving)
    until(lambda: (walker.walk.stance.readiness.leg_stiffness or 0.0) > 0.9)
    walker.walk.move_to(AHEAD, 0.5)


@pytest.mark.slow
def test_resting_robot_moves_nothing_until_a_walk_is_asked_for(peer):
    """S8: opening stiffens nothing; the first walk makes it stand up, the next one walks."""
    peer.motion("rest")
    walker = peer.robot()
    try:
        wakes = peer.world("calls", "ALMotion.wakeUp")
        walker.head.look(HeadAngles(0.2, 0.0), 1.0)
        until(lambda: peer.motion("getStiffnesses", "Head") == [1.0, 1.0])
        assert max(peer.motion("getStiffnesses", "Legs")) == 0.0
        assert peer.world("calls", "ALMotion.wakeUp") == wakes
        inits = peer.world("calls", "ALMotion.moveInit")
        assert "resting: it stands up now" in refused(walker)
        # as the walk server does after every refusal
        walker.walk.stop()
        assert "standing up" in refused(walker)
        until(lambda: not walker.walk.status().moving)
        assert peer.motion("robotIsWakeUp")
        assert peer.world("calls", "ALMotion.wakeUp") == wakes + 1
        assert peer.world("calls", "ALMotion.moveInit") == inits + 1
        walker.walk.move_to(AHEAD, 0.5)
        finish(walker)
    finally:
        walker.close()


@pytest.mark.slow
def test_standing_up_goes_no_further_when_stopped(peer):
    peer.motion("rest")
    walker = peer.robot()
    try:
        inits = peer.world("calls", "ALMotion.moveInit")
        assert "stands up now" in refused(walker)
        begin_s = time.monotonic()
        until(lambda: time.monotonic() - begin_s > 0.4)
        assert walker.walk.status().moving
        walker.walk.stop()
        until(lambda: not walker.walk.status().moving)
        assert peer.motion("robotIsWakeUp")
        assert peer.world("calls", "ALMotion.moveInit") == inits
    finally:
        walker.close()


@pytest.mark.slow
def test_resting_robot_stays_so_if_told(peer):
    peer.motion("rest")
    walker = peer.robot(wake_up=False)
    try:
        walker.head.look(HeadAngles(0.2, 0.0), 1.0)
        until(lambda: peer.motion("getStiffnesses", "Head") == [1.0, 1.0])
        assert refused(walker) == "the robot is resting"
    finally:
        walker.close()
    assert not peer.motion("robotIsWakeUp")
    assert peer.motion("getStiffnesses", "Head") == [0.0, 0.0]


def test_fallen_robot_neither_walks_nor_turns_its_head(peer, walker):
    walker.walk.move_to(PlanarMotion(0.3, 0.0, 0.0), 1.0)
    peer.world("knockOver")
    until(lambda: walker.walk.status().fallen)
    assert "fallen" in refused(walker)
    with pytest.raises(MotionRefusedError, match="fallen"):
        walker.head.look(HeadAngles(0.1, 0.0), 1.0)


def test_lifted_robot_does_not_walk(peer, walker):
    peer.world("lift", True)
    until(lambda: walker.walk.status().fallen)
    assert "lifted" in refused(walker)
    peer.world("lift", False)
    until(lambda: not walker.walk.status().fallen)


def test_move_that_refuses_is_refused_with_its_reason(peer, walker):
    peer.world("refuse", "ALMotion.moveTo", "the owner has not agreed")
    assert "the owner has not agreed" in refused(walker)
    peer.world("refuse", "ALMotion.moveTo", "")
    # stiffness that the backend has not seen yet: moveTo returns False
    peer.motion("setStiffnesses", "Legs", 0.5)
    assert "refused to walk" in refused(walker) or "stiffness" in refused(walker)


@pytest.mark.slow
def test_velocity_over_a_network_ends_by_itself(peer):
    """Cable out: neither daemon nor watchdog reaches a robot that has only a little way left."""
    network = Network(peer.url)
    walker = peer.robot(url=network.url, velocity_by_leads=True)
    try:
        sent = walker.walk.set_velocity(PlanarMotion(0.06, 0.0, 0.15), 1.0)
        begin_s = time.monotonic()

        def is_under_way():
            walker.walk.renew(1.0)
            assert walker.walk.status().velocity == sent
            return time.monotonic() - begin_s > 2.5

        until(is_under_way)
        assert peer.is_moving()
        # it keeps to the velocity, ahead by no more than it leads
        assert 0.04 * 2.5 < walked(peer) < 0.06 * (2.5 + 0.8) + 0.02
        network.cut()
        cut_s = time.monotonic()
        until(lambda: not peer.is_moving())
        assert time.monotonic() - cut_s < 2.5
    finally:
        walker.close()
        network.close()

"""The parts that need no robot: memory, limits, odometry, login, readiness."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hal.backends import OpenOptions
from hal.errors import BackendError, HalError, MotionRefusedError
from hal.naoqi.lead import AHEAD_S, Lead, along
from hal.naoqi.limits import check, clipped_travel, clipped_velocity, nominal_velocity
from hal.naoqi.login import find_login
from hal.naoqi.memory import CONTACT_KEY, FALLEN_KEY, FSR_KEYS, INERTIAL_KEYS, KEYS, sensed
from hal.naoqi.odometry import Odometry
from hal.naoqi.options import checked
from hal.naoqi.readiness import Readiness, needs_rising, objection
from hal.types import PlanarMotion


def memory(**changed):
    values = dict.fromkeys(KEYS, 1.0) | {FALLEN_KEY: None, CONTACT_KEY: True}
    values |= {key: float(n) / 10 for n, key in enumerate(INERTIAL_KEYS)}
    return sensed([{**values, **changed}[key] for key in KEYS])


def test_memory_is_read_by_name():
    found = memory(**{key: float(n) for n, key in enumerate(FSR_KEYS)})
    np.testing.assert_allclose(found.gyro_rad_s, [0.0, 0.1, 0.2])
    np.testing.assert_allclose(found.accel_m_s2, [0.3, 0.4, 0.5])
    np.testing.assert_allclose(found.tilt_rad, [0.6, 0.7])
    np.testing.assert_allclose(found.fsr_kg, np.arange(8.0))
    assert not found.lies
    assert not found.hangs


def test_what_a_robot_does_not_offer_is_zero():
    found = sensed([None] * len(KEYS))
    assert found.battery == 0.0
    assert found.has_contact is None
    assert not found.lies
    assert not found.hangs


@pytest.mark.parametrize(
    "values",
    [{FALLEN_KEY: True}, {FALLEN_KEY: 1.0}, {INERTIAL_KEYS[6]: 1.4}, {INERTIAL_KEYS[7]: -1.2}],
)
def test_fallen_by_event_or_by_tilt(values):
    assert memory(**values).lies


def test_lifted_by_event_or_by_the_soles():
    assert memory(**{CONTACT_KEY: False}).hangs
    assert memory(**{CONTACT_KEY: None}, **dict.fromkeys(FSR_KEYS, 0.01)).hangs
    assert not memory(**{CONTACT_KEY: None}, **dict.fromkeys(FSR_KEYS, 0.5)).hangs


def test_memory_of_another_length_is_an_error():
    with pytest.raises(ValueError, match="gave 3 values"):
        sensed([1, 2, 3])


@pytest.mark.parametrize(
    ("ready", "told"),
    [
        (Readiness(awake=False), "resting"),
        (Readiness(awake=True, leg_stiffness=0.6), "stiffness of the legs is 0.6"),
        (Readiness(awake=True, leg_stiffness=1.0, family="Sitting"), "posture: Sitting"),
        (Readiness(awake=True, leg_stiffness=1.0, family="Standing"), None),
        (Readiness(), None),
    ],
)
def test_why_it_would_have_to_stand_up(ready, told):
    reason = needs_rising(ready)
    assert (reason is None) if told is None else told in reason


def test_objections_name_their_cause():
    assert "fallen" in objection(memory(**{FALLEN_KEY: True}))
    assert "lifted" in objection(memory(**{CONTACT_KEY: False}))
    assert objection(memory()) is None


@pytest.mark.parametrize("bad", [math.nan, math.inf])
def test_numbers_that_are_not_finite_are_refused(bad):
    with pytest.raises(MotionRefusedError, match="not finite"):
        check(PlanarMotion(0.0, bad, 0.0), 1.0)
    with pytest.raises(MotionRefusedError, match="not positive"):
        check(PlanarMotion(0.0, 0.0, 0.0), bad)


def test_clipping_keeps_the_direction():
    far = clipped_travel(PlanarMotion(30.0, 40.0, 9.0))
    assert (far.x, far.y, far.yaw) == pytest.approx((1.2, 1.6, math.pi))
    near = PlanarMotion(0.1, -0.1, 0.5)
    assert clipped_travel(near) == near
    fast = clipped_velocity(PlanarMotion(1.0, 0.1, 0.0))
    assert fast.y / fast.x == pytest.approx(0.1)
    assert fast.x < 0.095
    slow = PlanarMotion(0.05, 0.0, 0.1)
    assert clipped_velocity(slow) == slow
    nominal = nominal_velocity(PlanarMotion(0.5, 0.0, 0.0))
    assert (nominal.x, nominal.y, nominal.yaw) == pytest.approx((0.095, 0.0, 0.0))
    assert nominal_velocity(PlanarMotion(0.0, 0.0, 0.0)) == PlanarMotion(0.0, 0.0, 0.0)


def test_odometry_begins_at_zero_and_goes_on_after_a_restart():
    odometry = Odometry()
    odometry.take([1.0, 2.0, math.pi / 2])
    assert odometry.pose == PlanarMotion(0.0, 0.0, 0.0)
    odometry.take([1.0, 2.5, math.pi])
    assert (odometry.pose.x, odometry.pose.y) == pytest.approx((0.5, 0.0))
    assert odometry.pose.yaw == pytest.approx(math.pi / 2)
    odometry.restart()
    odometry.take([7.0, 7.0, 0.0])
    odometry.take([7.1, 7.0, 0.0])
    # a step ahead, which is to the left of where it first looked
    assert (odometry.pose.x, odometry.pose.y) == pytest.approx((0.5, 0.1))
    with pytest.raises(HalError, match="no position"):
        odometry.take([1.0])
    with pytest.raises(HalError, match="not finite"):
        odometry.take([1.0, math.nan, 0.0])


def test_password_from_file_or_environment_and_in_no_text(tmp_path, monkeypatch):
    monkeypatch.delenv("NAOQI_PASSWORD", raising=False)
    assert find_login("nao", "") is None
    monkeypatch.setenv("NAOQI_PASSWORD", "hush")
    assert find_login("nao", "").password == "hush"
    path = tmp_path / "password"
    path.write_text("  secret\n")
    login = find_login("nao", str(path))
    assert login.password == "secret"
    assert "secret" not in repr(login)
    path.write_text("\n")
    with pytest.raises(BackendError, match="empty"):
        find_login("nao", str(path))
    with pytest.raises(BackendError, match="cannot be read"):
        find_login("nao", str(tmp_path / "none"))


@pytest.mark.parametrize(
    ("section", "told"),
    [
        ({"urll": "x"}, "unknown NAOqi option 'urll'"),
        ({"url": 3}, "url: not a str"),
        ({"url": "127.0.0.1:9559"}, "neither tcp"),
        ({"url": "tcps://127.0.0.1:9503"}, "needs a password"),
        ({"controls": {"hue": 3}}, "hue"),
    ],
)
def test_options_are_checked(section, told, monkeypatch):
    monkeypatch.delenv("NAOQI_PASSWORD", raising=False)
    with pytest.raises(BackendError, match=told):
        checked(OpenOptions(section=section))


@pytest.mark.parametrize("velocity", [(0.09, 0.0, 0.0), (0.05, -0.02, 0.4), (0.0, 0.0, -0.5)])
def test_displacements_lead_along_the_velocity(velocity):
    """Small steps put together, which need no formula of an arc, come to the same place."""
    x = y = yaw = 0.0
    steps = 20_000
    for _ in range(steps):
        dx, dy = velocity[0] / steps, velocity[1] / steps
        x += math.cos(yaw) * dx - math.sin(yaw) * dy
        y += math.sin(yaw) * dx + math.cos(yaw) * dy
        yaw += velocity[2] / steps
    assert along(PlanarMotion(*velocity), 1.0) == pytest.approx((x, y, yaw), abs=1e-5)


def test_lead_is_a_little_ahead_and_waits_for_who_stays_behind():
    still = PlanarMotion(0.0, 0.0, 0.0)
    lead = Lead(PlanarMotion(0.1, 0.0, 0.0), still, 10.0)
    assert lead.is_due(10.0)
    assert lead.displacement(still, 10.0).x == pytest.approx(0.1 * AHEAD_S)
    assert not lead.is_due(10.1)
    assert lead.is_due(10.5)
    ahead = lead.displacement(PlanarMotion(0.05, 0.0, 0.0), 10.5)
    assert ahead.x == pytest.approx(0.1 * (0.5 + AHEAD_S) - 0.05)
    # a robot that is held back is not asked to catch up
    held = lead.displacement(PlanarMotion(0.06, 0.0, 0.0), 20.0)
    assert held.x == pytest.approx(0.1 * AHEAD_S)


@pytest.mark.parametrize(
    ("url", "by_leads"),
    [("tcp://127.0.0.1:9559", False), ("tcp://localhost:9559", False), ("tcp://nao.local:1", True)],
)
def test_velocity_is_led_where_a_network_lies_between(url, by_leads):
    assert checked(OpenOptions(section={"url": url})).velocity_by_leads is by_leads

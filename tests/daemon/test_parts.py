"""The daemon's small parts, each by itself."""

from __future__ import annotations

import socket
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hal.simulation import Truth
from hal.types import PlanarMotion
from naod.approach.goal import Goal
from naod.daemon.desk import OPEN_MAX, PATIENCE_NS, Desk
from naod.daemon.faults import SHOWN_NS, Faults
from naod.daemon.gauges import Gauges
from naod.daemon.notify import Notifier
from naod.daemon.store import Store
from naod.daemon.truth import truth_message
from naod.errors import InputError
from naod.geometry.transforms import rot_z, transform
from naod.loop.types import Reply, Start, Stop
from naod.pace import Pace
from naod.perception.colour_model import ColourModel

MS = 1_000_000


class Heard:
    """Stands where a caller waits."""

    def __init__(self) -> None:
        self.answers: list[tuple[str, str]] = []

    def ok(self, **fields: object) -> None:
        self.answers.append(("ok", str(fields.get("message", ""))))

    def error(self, code: str, message: str) -> None:
        self.answers.append((code, message))


@given(st.lists(st.integers(0, 300 * MS), min_size=1, max_size=50))
def test_pace_stays_on_its_grid_whatever_the_delays(delays: list[int]) -> None:
    period, now = 40 * MS, 1_000
    pace = Pace(now, period)
    missed = ticks = 0
    for delay in delays:
        now = max(now, pace.deadline_ns) + delay
        missed += pace.advance(now)
        ticks += 1
        assert (pace.deadline_ns - 1_000) % period == 0
        assert now < pace.deadline_ns <= now + period
    assert pace.overruns == missed
    assert ticks + missed == (pace.deadline_ns - 1_000) // period - 1


def test_pace_woken_early_keeps_its_deadline() -> None:
    pace = Pace(0, 40 * MS)
    assert pace.advance(10 * MS) == 0
    assert pace.deadline_ns == 40 * MS
    assert pace.left_s(10 * MS) == pytest.approx(0.03)


@pytest.mark.parametrize("abstract", [False, True])
def test_systemd_hears_ready_watchdog_and_stopping(tmp_path: Path, abstract: bool) -> None:
    name = f"@naod-test-{tmp_path.name}" if abstract else str(tmp_path / "notify")
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as systemd:
        systemd.bind("\0" + name[1:] if abstract else name)
        systemd.settimeout(2.0)
        notifier = Notifier(name)
        notifier.ready()
        notifier.alive()
        notifier.stopping()
        heard = [systemd.recv(100) for _ in range(3)]
        notifier.close()
    assert heard == [b"READY=1", b"WATCHDOG=1", b"STOPPING=1"]


def test_without_systemd_nothing_happens(tmp_path: Path) -> None:
    Notifier(None).ready()
    Notifier(str(tmp_path / "nobody")).ready()


def test_request_is_taken_once_and_answered_once() -> None:
    desk, heard = Desk(), Heard()
    desk.ask(Start("cup"), heard, 0)
    (request,) = desk.take()
    assert request.verb == Start("cup")
    assert desk.take() == ()
    desk.settle([Reply(request.ticket), Reply(request.ticket, "late", "again")])
    assert heard.answers == [("ok", "")]


def test_request_nobody_answers_runs_out() -> None:
    desk, heard = Desk(), Heard()
    desk.ask(Stop(), heard, 0)
    desk.expire(PATIENCE_NS)
    assert heard.answers == []
    desk.expire(PATIENCE_NS + 1)
    assert heard.answers[0][0] == "timeout"


def test_requests_do_not_pile_up() -> None:
    desk, heard = Desk(), Heard()
    for _ in range(OPEN_MAX):
        desk.ask(Stop(), Heard(), 0)
    desk.ask(Stop(), heard, 0)
    assert heard.answers[0][0] == "busy"
    assert len(desk.take()) == OPEN_MAX


def test_failing_all_refuses_what_is_open_and_what_is_new() -> None:
    desk, one, two = Desk(), Heard(), Heard()
    desk.ask(Stop(), one, 0)
    desk.take()
    desk.ask(Stop(), two, 0)
    desk.fail_all("internal", "failed")
    assert one.answers == two.answers == [("internal", "failed")]
    assert desk.take() == ()


def test_fault_is_news_once_and_shown_for_a_while() -> None:
    faults = Faults()
    assert faults.add("camera_failed", 0)
    assert not faults.add("camera_failed", 10)
    assert faults.present(10 + SHOWN_NS) == ("camera_failed",)
    assert faults.present(11 + SHOWN_NS) == ()
    assert faults.add("camera_failed", 2 * SHOWN_NS)
    assert faults.counts == {"camera_failed": 3}


def test_gauges_sum_up_a_second() -> None:
    gauges = Gauges(0)
    for at_ms in (0, 60, 120, 240):
        gauges.tick(at_ms * MS)
    gauges.frame(100 * MS, 180 * MS)
    assert not gauges.due(999 * MS)
    assert gauges.due(1000 * MS)
    told = gauges.report(1000 * MS, overruns=2, refused=3, temperature_max_c=40.0, battery=0.5)
    assert told.period_ms == pytest.approx(80.0)
    assert told.period_max_ms == pytest.approx(120.0)
    assert told.jitter_ms == pytest.approx(np.std([60.0, 60.0, 120.0]))
    assert told.latency_ms == pytest.approx(80.0)
    assert (told.frames, told.overruns, told.refused) == (1, 2, 3)
    assert not gauges.due(1999 * MS)


GROWS = """
import numpy as np
from naod.daemon.gauges import memory_mb
before = memory_mb()
block = np.ones(50_000_000, dtype=np.uint8)
print(memory_mb() - before)
"""


def test_memory_is_that_of_this_process() -> None:
    # one of its own: here other tests' memory is given back at any time
    told = subprocess.run([sys.executable, "-c", GROWS], capture_output=True, check=True)
    assert float(told.stdout) == pytest.approx(50.0, abs=10.0)


def test_yaw_of_the_truth_is_the_azimuth_of_the_objects_face() -> None:
    facing = 2.5
    # x to the right, y up, z out of the face
    upright = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    T = transform(rot_z(facing) @ upright, (1.0, 2.0, 0.5))
    told = truth_message(Truth(7, PlanarMotion(0.1, 0.2, 0.3), T, np.eye(4)))
    assert told.base == (0.1, 0.2, 0.3)
    assert told.object == pytest.approx((1.0, 2.0, 0.5, facing))


def test_store_keeps_goals_and_model(tmp_path: Path) -> None:
    folder = tmp_path / "state"
    goal = Goal(kind="cylinder", rho_m=0.4, theta_rad=0.1, z_m=0.45, phi_rad=3.1)
    row = (9.0, 0.0, 0.0)
    model = ColourModel(
        mean=(90.0, 100.0, 210.0), covariance=(row, (0.0, 9.0, 0.0), (0.0, 0.0, 9.0))
    )
    store = Store(folder)
    assert store.model() is None
    store.keep_goal("cup", goal)
    store.keep_model(model)
    again = Store(folder)
    assert again.goals() == {"cup": goal}
    assert again.model() == model


def test_state_folder_that_cannot_be_is_one_line(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot make the state folder"):
        Store(tmp_path / "file" / "state")


def test_damaged_goal_is_named(tmp_path: Path) -> None:
    (tmp_path / "goals").mkdir()
    (tmp_path / "goals" / "cup.toml").write_text("kind = 'cylinder'\nrho = 1\n")
    with pytest.raises(InputError, match=r"cup\.toml"):
        Store(tmp_path).goals()

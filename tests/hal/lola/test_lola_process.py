"""The process of LoLA against a server whose every byte is decided here."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from lola_script import PATIENCE_S, Reply, ScriptedLola, frame, hire, wait_for

from hal.errors import BackendError, MotionRefusedError
from hal.lola.channel import LeaveWish, LookWish
from hal.lola.line import Line
from hal.nao.joints import JOINT_INDEX, UPPER_RAD

CYCLE_S = 0.012
FASTEST_RAD_S = 7.46


@pytest.fixture(scope="module")
def script(tmp_path_factory: pytest.TempPathFactory) -> Iterator[ScriptedLola]:
    made = ScriptedLola(tmp_path_factory.mktemp("lola"))
    yield made
    made.close()


@pytest.fixture(scope="module")
def line(script: ScriptedLola) -> Iterator[Line]:
    """One process for all tests; it ends when there is no LoLA for it any more."""
    made = hire(script.path, sit_after_s=60.0)
    yield made
    script.close()
    made.send(LeaveWish())
    assert made.close(5.0)


@pytest.fixture
def lola(script: ScriptedLola, line: Line) -> ScriptedLola:
    """A fresh connection, on which nothing has been sent."""
    line.status()
    script.accept()
    return script


class Cycles:
    """LoLA's cycles in a thread: a robot that does what it is told."""

    def __init__(self, lola: ScriptedLola) -> None:
        self._lola = lola
        self._stop = threading.Event()
        self.replies: list[Reply] = []
        self._thread = threading.Thread(target=self._run)
        self._thread.start()

    def _run(self) -> None:
        deadline = time.monotonic()
        head, stiffness = {"HeadYaw": 0.0, "HeadPitch": 0.0}, 0.0
        while not self._stop.wait(max(0.0, deadline - time.monotonic())):
            reply = self._lola.exchange(frame(head, stiffness))
            self.replies.append(reply)
            stiffness = float(reply.stiffness[0])
            if stiffness > 0.0:
                head = {name: reply.angle(name) for name in head}
            deadline += CYCLE_S

    def wait_for(self, count: int) -> None:
        """Until there have been so many."""
        limit = time.monotonic() + PATIENCE_S
        while len(self.replies) < count:
            assert time.monotonic() < limit
            assert self._thread.is_alive()
            self._stop.wait(CYCLE_S)

    def stop(self) -> Reply:
        self._stop.set()
        self._thread.join()
        return self.replies[-1]


def look(line: Line, yaw: float, speed: float = 1.0) -> None:
    line.send(LookWish(yaw, 0.0, speed, time.monotonic_ns() + 5_000_000_000))


def test_first_answer_is_the_measured_pose_at_the_measured_stiffness(
    lola: ScriptedLola, line: Line
) -> None:
    odd = {"LShoulderPitch": 0.25, "HeadYaw": -0.75, "RElbowRoll": 1.125, "LKneePitch": 1.0}
    first = lola.exchange(frame(odd, stiffness=0.25))
    for name, value in odd.items():
        assert first.angle(name) == value
    assert (first.stiffness == 0.25).all()
    body = line.shared.newest()
    assert body is not None
    assert body.angles_rad[JOINT_INDEX["HeadYaw"]] == -0.75
    for _ in range(20):
        later = lola.exchange(frame(odd, stiffness=0.25))
    assert (later.position == first.position).all()


def test_nothing_is_sent_that_answers_nothing(lola: ScriptedLola, line: Line) -> None:
    assert lola.silent_for(0.1)
    lola.exchange(frame())
    look(line, 0.5)
    assert lola.silent_for(0.1)


@pytest.mark.parametrize("stall_s", [0.05, 0.5])
def test_head_goes_on_without_a_jump_after_a_stall(
    lola: ScriptedLola, line: Line, stall_s: float
) -> None:
    cycles = Cycles(lola)
    cycles.wait_for(60)
    look(line, 1.5)
    cycles.wait_for(90)
    before = cycles.stop()
    assert 0.05 < before.angle("HeadYaw") < 1.5
    assert lola.silent_for(stall_s)
    line.status()
    look(line, 1.5)
    first = lola.exchange(frame({"HeadYaw": before.angle("HeadYaw"), "HeadPitch": 0.0}, 0.6))
    assert 0.0 <= first.angle("HeadYaw") - before.angle("HeadYaw") <= 1.0 * 3 * CYCLE_S + 1e-6
    body = line.shared.newest()
    assert body is not None
    assert time.monotonic_ns() - body.stamp_ns < 1e9
    assert lola.silent_for(0.02), "and it is still connected"


def test_backlog_after_a_stall_is_answered_once_for_its_newest(
    lola: ScriptedLola, line: Line
) -> None:
    lola.exchange(frame())
    lola.send(frame({"HeadYaw": 0.25}) + frame({"HeadYaw": 0.5}) + frame({"HeadYaw": 0.75}))
    lola.reply()
    body = line.shared.newest()
    assert body is not None
    assert body.angles_rad[0] == 0.75
    assert lola.silent_for(0.05)


def test_silence_for_ever_refuses_and_calls_anew_and_starts_from_the_measured_pose(
    lola: ScriptedLola, line: Line
) -> None:
    lola.exchange(frame())
    connections = wait_for(line, lambda s: s.connected).connections
    status = wait_for(line, lambda s: not s.connected)
    assert "silent" in (status.refusal or "")
    assert "silent" in (status.head_refusal or "")
    assert lola.wait_for_end() == b"", "it hangs up by itself"
    lola.accept()
    first = lola.exchange(frame({"HeadYaw": -0.5, "LKneePitch": 1.25}, stiffness=0.5))
    assert (first.angle("HeadYaw"), first.angle("LKneePitch")) == (-0.5, 1.25)
    assert wait_for(line, lambda s: s.connected).connections == connections + 1


def test_lola_that_restarts_is_found_again(lola: ScriptedLola, line: Line) -> None:
    lola.exchange(frame())
    connections = wait_for(line, lambda s: s.connected).connections
    lola.hang_up()
    status = wait_for(line, lambda s: not s.connected)
    assert "hung up" in (status.refusal or "")
    lola.accept()
    lola.exchange(frame())
    assert wait_for(line, lambda s: s.connected).connections == connections + 1


@pytest.mark.parametrize(
    "spoilt",
    [
        b"\xc1" * 896,
        frame()[1:] + frame()[:1],
        frame()[:500] + b"\xff" * 396,
        frame({"HeadPitch": float("nan")}),
    ],
    ids=["noise", "shifted", "torn", "nan"],
)
def test_unreadable_message_repeats_the_last_answer_and_begins_anew(
    lola: ScriptedLola, line: Line, spoilt: bytes
) -> None:
    bad = line.status().bad
    for _ in range(5):
        before = lola.exchange(frame({"HeadYaw": 0.5}))
    repeated = lola.exchange(spoilt)
    assert (repeated.position == before.position).all()
    assert lola.wait_for_end() == b""
    lola.accept()
    assert lola.exchange(frame({"HeadYaw": 0.25})).angle("HeadYaw") == 0.25
    assert wait_for(line, lambda s: s.connected).bad == bad + 1


def test_message_in_pieces_is_one_message(lola: ScriptedLola, line: Line) -> None:
    lola.exchange(frame())
    bad = line.status().bad
    whole = frame({"HeadYaw": 0.5})
    for at in range(0, 896, 128):
        assert lola.silent_for(0.002)
        lola.send(whole[at : at + 128])
    lola.reply()
    body = line.shared.newest()
    assert body is not None
    assert body.angles_rad[0] == 0.5
    assert line.status().bad == bad


def test_targets_hold_ranges_and_speeds_whatever_is_wished(lola: ScriptedLola, line: Line) -> None:
    cycles = Cycles(lola)
    cycles.wait_for(60)
    line.send(LookWish(50.0, -9.0, 1e6, time.monotonic_ns() + 5_000_000_000))
    cycles.wait_for(140)
    cycles.stop()
    yaw = np.array([reply.angle("HeadYaw") for reply in cycles.replies])
    assert yaw.max() == pytest.approx(UPPER_RAD[0], abs=1e-6)
    assert np.abs(np.diff(yaw)).max() <= FASTEST_RAD_S * 3 * CYCLE_S
    pitch = cycles.replies[-1].angle("HeadPitch")
    assert pitch == pytest.approx(-0.449, abs=1e-3), "the shell's limit at this yaw"


def test_second_daemon_is_told_that_the_robot_is_taken(lola: ScriptedLola, line: Line) -> None:
    lola.exchange(frame())
    line.status()
    with pytest.raises(BackendError, match="another daemon has this robot"):
        hire(lola.path)
    assert lola.silent_for(0.02)


def test_lola_that_is_not_there_is_said_and_awaited(tmp_path: Path) -> None:
    path = tmp_path / "robocup"
    line = hire(str(path), sit_after_s=0.2)
    status = wait_for(line, lambda s: s.trouble != "")
    assert "No such file" in (status.refusal or "")
    script = ScriptedLola(tmp_path)
    script.accept()
    script.exchange(frame())
    wait_for(line, lambda s: s.connected)
    script.close()
    line.send(LeaveWish())
    assert line.close(5.0), "without LoLA there is nothing to sit down"
    with pytest.raises(MotionRefusedError):
        look(line, 0.0)

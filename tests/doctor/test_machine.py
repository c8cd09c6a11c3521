"""What is said of the machine and of what is kept on it."""

import os
import resource
from pathlib import Path

import pytest

from hal.health import Finding
from naod.config import CameraConfig, DaemonConfig, RobotConfig
from naod.doctor.keeping import examine_configuration, examine_state
from naod.doctor.machine import examine_machine
from naod.files import write_toml, write_whole
from naod.perception.colour_model import ColourModel


def one(findings: list[Finding], check: str) -> Finding:
    (found,) = [finding for finding in findings if finding.check == check]
    return found


def machine(tmp_path: Path, governor: str = "", capabilities: str = "0", needs: bool = True):
    folder = tmp_path / "cpu0" / "cpufreq"
    folder.mkdir(parents=True)
    if governor:
        (folder / "scaling_governor").write_text(f"{governor}\n")
    status = tmp_path / "status"
    status.write_text(f"Name:\tnaod\nCapEff:\t{capabilities}\n")
    return examine_machine(needs, tmp_path, status)


def test_a_lazy_governor_is_told(tmp_path):
    found = one(machine(tmp_path, "powersave"), "processor clock")
    assert (found.status, "powersave" in found.text) == ("warn", True)
    assert found.advice


def test_a_brisk_governor_is_well(tmp_path):
    assert one(machine(tmp_path, "performance"), "processor clock").status == "ok"


def test_a_machine_that_does_not_tell_is_well(tmp_path):
    assert one(machine(tmp_path), "processor clock").status == "ok"


@pytest.mark.parametrize(
    ("limit", "capabilities", "needs", "status"),
    [
        (0, "0", True, "warn"),
        (0, "0", False, "ok"),
        (20, "0", True, "ok"),
        (resource.RLIM_INFINITY, "0", True, "ok"),
        (0, "0000000000800000", True, "ok"),
        (0, "00000000007fffff", True, "warn"),
        (0, "no number", True, "warn"),
    ],
)
def test_real_time_rights(tmp_path, monkeypatch, limit, capabilities, needs, status):
    monkeypatch.setattr(resource, "getrlimit", lambda _: (0, limit))
    found = one(machine(tmp_path, capabilities=capabilities, needs=needs), "real-time rights")
    assert found.status == status
    assert bool(found.advice) == (status == "warn")


def test_kernels_are_counted_where_numba_keeps_them(tmp_path, monkeypatch):
    cache = tmp_path / "cache"
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(cache))
    assert one(machine(tmp_path / "a"), "kernels").status == "warn"
    assert not cache.exists()
    (cache / "perception").mkdir(parents=True)
    (cache / "perception" / "energy.nbi").touch()
    assert one(machine(tmp_path / "b"), "kernels").text == "1 compiled"


def kept(folder: Path) -> list[Finding]:
    return examine_state(DaemonConfig(robot=RobotConfig(state_folder=str(folder))))


def test_a_state_folder_is_looked_at_and_not_made(tmp_path):
    folder = tmp_path / "a" / "b"
    assert "can be made" in one(kept(folder), "state folder").text
    assert os.listdir(tmp_path) == []
    folder.mkdir(parents=True)
    write_toml(folder / "model.toml", ColourModel(mean=(1.0, 2.0, 3.0), covariance=((9.0, 0.0, 0.0), (0.0, 9.0, 0.0), (0.0, 0.0, 9.0))))  # noqa: E501  # fmt: skip
    assert "a colour, 0 goals" in one(kept(folder), "state folder").text
    assert os.listdir(folder) == ["model.toml"]


def test_a_state_folder_that_is_a_file_or_holds_rubbish_fails(tmp_path):
    (tmp_path / "file").write_text("")
    assert one(kept(tmp_path / "file" / "b"), "state folder").status == "fail"
    write_whole(tmp_path / "model.toml", "mean = 3\n")
    found = one(kept(tmp_path), "state folder")
    assert found.status == "fail"
    assert "model.toml:1: mean" in found.text


def test_a_latched_estop_is_told(tmp_path):
    assert [finding.check for finding in kept(tmp_path)] == ["state folder"]
    write_whole(tmp_path / "estop", "")
    assert one(kept(tmp_path), "estop").advice == "`naod ctl release`"


def test_a_real_head_that_was_never_calibrated_is_told():
    real = DaemonConfig(robot=RobotConfig(backend="naoqi"))
    assert one(examine_configuration(real, "x"), "calibration").status == "warn"
    done = DaemonConfig(
        robot=RobotConfig(backend="naoqi"), camera=CameraConfig(correction_deg=(0.0, 1.0, 0.0))
    )
    assert [finding.check for finding in examine_configuration(done, "x")] == ["configuration"]
    assert len(examine_configuration(DaemonConfig(), "x")) == 1

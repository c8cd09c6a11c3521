"""The whole experiment in lock-step: shown once, started elsewhere, reached by sight."""

from functools import cache
from pathlib import Path

import pytest

from naod.config import DaemonConfig
from naod.experiment.approach_run import Experiment
from naod.experiment.opening import open_lockstep
from naod.experiment.scenarios import demo_scenario


def run_demo(name, seed):
    lockstep = open_lockstep(DaemonConfig(), demo_scenario(name, seed), Path(), seed, True)
    try:
        experiment = Experiment(lockstep, seed)
        shown = experiment.demonstrate()
        experiment.carry_to_start()
        return experiment.approach(shown), lockstep
    finally:
        lockstep.robot.close()


@cache
def outcome_of(name, seed):
    return run_demo(name, seed)[0]


def check(name, seed):
    outcome = outcome_of(name, seed)
    summary = outcome.summary
    assert summary.converged
    assert summary.final_error.reached, summary.final_error
    assert not summary.fell
    return outcome


@pytest.mark.parametrize("name", ["can", "board"])
def test_the_shown_pose_is_reached(name):
    outcome = check(name, 1)
    summary = outcome.summary
    assert summary.moves >= 3
    assert len(summary.localisation) >= summary.moves
    assert summary.time_s < 180.0
    errors = [abs(row.estimated.rho_m - row.true.rho_m) for row in summary.localisation]
    assert sorted(errors)[len(errors) // 2] < 0.01


def test_the_same_seed_gives_the_same_approach():
    first = outcome_of("can", 1)
    second, _ = run_demo("can", 1)
    assert first.summary.localisation == second.summary.localisation
    assert first.summary.final_error == second.summary.final_error


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("name", ["can", "board"])
def test_every_seed_reaches_the_shown_pose(name, seed):
    check(name, seed)

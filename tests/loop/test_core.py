"""The loop's decisions, from hand-made observations."""

import math

import numpy as np
import pytest
from builders import MODEL, Bench, ego, walk

from naod.approach.displacement import goal_from
from naod.loop.types import Label, Start, Stop, Teach


def is_step(commands):
    return commands.walk is not None and commands.walk.kind == "step"


def is_stop(commands):
    return commands.walk is not None and commands.walk.kind == "stop"


def test_starts_idle_and_does_nothing():
    """S8: a restart never moves the robot, even with a model and goals on disk."""
    bench = Bench()
    for _ in range(50):
        commands = bench.tick()
        assert commands.head is None
        assert commands.walk is None
    assert commands.state.mode == "idle"


def test_an_approach_steps_towards_the_goal_and_says_when_it_is_there():
    bench = Bench()
    assert bench.tick(Start("desk")).replies[0].error_code is None
    first = bench.until(is_step).walk
    assert (first.x, first.y, first.yaw) == pytest.approx((0.25, 0.0, 0.0))
    bench.walk_a_step()
    bench.sees = ego(0.5 + 0.15, 0.0)
    second = bench.until(is_step).walk
    assert second.x == pytest.approx(0.15)
    assert second.seq > first.seq
    bench.walk_a_step()
    bench.sees = ego(0.505, 0.001)
    bench.until(lambda commands: commands.state.phase == "reached")
    assert bench.state.mode == "track"
    assert bench.state.moves == 2
    assert bench.events == ["started", "move", "move", "reached"]


def test_the_turn_is_saturated_too():
    bench = Bench()
    bench.sees = ego(0.5, 0.0, phi=math.pi - 1.0)
    bench.tick(Start("desk"))
    step = bench.until(is_step).walk
    assert abs(step.yaw) == pytest.approx(math.radians(30.0))


def test_no_walk_on_a_picture_older_than_the_last_step():
    """S3: looks are taken anew after each step and after settling."""
    bench = Bench()
    bench.tick(Start("desk"))
    bench.until(is_step)
    bench.walk_a_step()
    stood_ns = bench.now_ns
    bench.until(is_step)
    settle_ns = int(bench.equipment.config.approach.settle_s * 1e9)
    looks = bench.equipment.config.approach.looks
    assert bench.now_ns - stood_ns >= settle_ns + (looks - 1) * 1e9 / 15


def test_no_picture_for_a_second_while_walking_stops_the_walk():
    """S3."""
    bench = Bench()
    bench.tick(Start("desk"))
    bench.until(is_step)
    bench.walk = walk(moving=True)
    bench.tick(ticks=3)
    bench.camera_on = False
    before_ns = bench.now_ns
    bench.until(is_stop)
    assert 1.0 <= (bench.now_ns - before_ns) / 1e9 <= 1.2
    assert bench.state.phase == "failed"
    assert "no_picture" in bench.tick().state.faults


def test_without_pictures_it_never_sets_out():
    bench = Bench()
    bench.camera_on = False
    bench.tick(Start("desk"))
    for _ in range(300):
        assert not is_step(bench.tick())
    assert bench.state.phase == "failed"


def test_what_has_the_colour_but_not_the_outline_is_not_stared_at_for_ever():
    bench = Bench()
    bench.with_pose = False
    bench.tick(Start("desk"))
    for _ in range(300):
        assert not is_step(bench.tick())
    assert bench.state.phase == "failed"
    assert bench.state.mode == "track"


def test_an_object_off_centre_turns_the_head_before_anything_walks():
    bench = Bench()
    bench.ray = np.array([0.3, 0.0, 1.0])
    bench.tick(Start("desk"))
    commands = bench.tick(ticks=60)
    assert commands.head is not None
    assert commands.head.yaw_rad < -0.1
    assert bench.state.moves == 0


def test_lost_it_searches_and_gives_up_standing():
    bench = Bench()
    bench.tick(Start("desk"))
    bench.tick(ticks=3)
    bench.sees = None
    heads = set()
    for _ in range(900):
        commands = bench.tick()
        assert not is_step(commands)
        if commands.head is not None:
            heads.add(round(commands.head.yaw_rad, 2))
        if commands.state.phase == "failed":
            break
    assert commands.state.phase == "failed"
    assert min(heads) < -1.0
    assert max(heads) > 1.0
    assert bench.state.lost_count == 1
    assert bench.events == ["started", "lost", "failed"]


def test_found_again_it_goes_on():
    bench = Bench()
    bench.tick(Start("desk"))
    bench.tick(ticks=3)
    bench.sees = None
    bench.tick(ticks=30)
    bench.sees = ego(1.0, 0.0)
    assert is_step(bench.until(is_step))
    assert bench.events == ["started", "lost", "found", "move"]


def test_an_operator_who_holds_the_walk_is_waited_for():
    bench = Bench()
    bench.walk = walk(held_by="laptop")
    bench.tick(Start("desk"))
    for _ in range(100):
        commands = bench.tick()
        assert commands.walk is None
    assert commands.state.phase == "held"
    bench.walk = walk()
    bench.until(is_step)


def test_a_fall_ends_the_approach():
    bench = Bench()
    bench.tick(Start("desk"))
    bench.until(is_step)
    bench.walk = walk(fallen=True)
    assert is_stop(bench.tick())
    assert bench.state.phase == "failed"


def test_a_refused_step_ends_the_approach_with_its_reason():
    bench = Bench()
    bench.tick(Start("desk"))
    bench.until(is_step)
    bench.walk = walk(refused="tracker: estop is latched")
    bench.until(lambda commands: commands.state.phase == "failed")
    assert bench.events[-1] == "failed"


def test_a_walk_that_never_begins_is_not_waited_for_for_ever():
    bench = Bench()
    bench.tick(Start("desk"))
    bench.until(is_step)
    bench.until(lambda commands: commands.state.phase == "failed", limit=60)


def test_stop_stands_and_keeps_looking():
    bench = Bench()
    bench.tick(Start("desk"))
    bench.until(is_step)
    bench.walk = walk(moving=True)
    bench.tick(ticks=2)
    commands = bench.tick(Stop())
    assert is_stop(commands)
    assert commands.state.mode == "track"
    assert commands.state.goal is None


def test_teaching_remembers_where_the_object_stands():
    bench = Bench()
    bench.sees = ego(0.62, -0.1, phi=3.0)
    assert bench.tick(Teach("shelf")).replies == ()
    commands = bench.until(lambda c: c.replies)
    assert commands.replies[0].error_code is None
    name, goal = commands.keep_goal
    assert name == "shelf"
    assert goal.kind == "rectangle"
    place = (goal.rho_m, goal.theta_rad, goal.z_m, goal.phi_rad)
    assert place == pytest.approx((bench.sees.rho_m, bench.sees.theta_rad, 0.45, 3.0))
    assert "shelf" in bench.state.goals


def test_teaching_what_is_not_seen_is_refused_in_time():
    bench = Bench()
    bench.sees = None
    bench.tick(Teach("shelf"))
    commands = bench.until(lambda c: c.replies)
    assert commands.replies[0].error_code == "not_found"
    assert commands.keep_goal is None


@pytest.mark.parametrize(
    ("verb", "code"),
    [
        (Start("nowhere"), "unknown_goal"),
        (Label(-1, 0, 5, 5), "bad_region"),
        (Label(630, 470, 20, 20), "bad_region"),
        (Label(0, 0, 0, 5), "bad_region"),
    ],
)
def test_what_cannot_be_done_is_refused_with_a_reason(verb, code):
    commands = Bench().tick(verb)
    assert commands.replies[0].error_code == code
    assert commands.replies[0].message


def test_a_region_of_one_colour_teaches_nothing():
    """The frames of the bench are all zero: nothing to learn from."""
    bench = Bench()
    bench.tick(Label(100, 100, 50, 50))
    commands = bench.until(lambda c: c.replies)
    assert commands.replies[0].error_code == "bad_region"
    assert commands.keep_model is None


def test_without_a_colour_nothing_starts():
    bench = Bench(model=None)
    for verb in (Start("desk"), Teach("desk")):
        assert bench.tick(verb).replies[0].error_code == "no_model"
    assert MODEL is not bench.state.model


def test_a_goal_of_another_kind_is_refused():
    bench = Bench(goals={"can": goal_from("cylinder", ego(0.5, 0), 0.001)})
    assert bench.tick(Start("can")).replies[0].error_code == "wrong_object"


def test_the_step_is_a_function_of_its_arguments():
    """Two runs from the same start say the same, message for message."""
    traces = []
    for _ in range(2):
        bench = Bench()
        bench.tick(Start("desk"))
        traces.append([bench.tick() for _ in range(100)])
    assert traces[0] == traces[1]


def test_a_colour_that_cannot_be_learnt_leaves_the_one_before():
    """A rejected label used to erase the colour that was known."""
    bench = Bench()
    bench.tick(Label(100, 100, 50, 50))
    bench.until(lambda c: c.replies)
    assert bench.state.model is MODEL
    assert bench.state.mode == "idle"

"""More looks while a step is less certain than it is long; blurred ones count for nothing."""

import math
from dataclasses import replace

import numpy as np
import pytest
from builders import Bench, ego

from naod.localisation.looks import Look
from naod.loop.types import Start


class UnsureBench(Bench):
    """A bench whose looks are as unsure, and as blurred, as it is told."""

    own_m, shared_m, blur_px, clipped = 1e-3, 0.0, 0.0, ()

    def _sighting(self):
        sighting = super()._sighting()
        if sighting is None or sighting.look is None:
            return sighting
        place = np.diag([1.0, 1.0, 1.0, 1e-4])
        own, shared = place * self.own_m**2, place * self.shared_m**2
        look = Look(self.now_ns, sighting.look.ego, own, shared, self.blur_px)
        pose = replace(sighting.pose, clipped=self.clipped)
        return replace(sighting, look=look, pose=pose, blur_px=self.blur_px)

    def until_step(self):
        """The step, and how many looks there were before it."""
        looks = 0

        def stepped(commands):
            nonlocal looks
            if commands.walk is not None and commands.walk.kind == "step":
                return True
            looks = len(self.state.looks)
            return False

        return self.until(stepped).walk, looks + 1


def begun(**unsure):
    bench = UnsureBench()
    for name, value in unsure.items():
        setattr(bench, name, value)
    bench.tick(Start("desk"))
    return bench


def test_sure_of_the_way_it_takes_the_looks_it_was_told_to():
    step, looks = begun().until_step()
    assert looks == 5
    assert step.x == pytest.approx(0.25)


def test_unsure_of_a_short_way_it_looks_until_it_is_sure():
    """30 mm to go, looks of 90 mm each: sure enough of it after nine."""
    bench = begun(own_m=0.09)
    bench.sees = ego(0.5 + 0.03, 0.0)
    step, looks = bench.until_step()
    assert looks in (9, 10)
    assert step.x == pytest.approx(0.03, abs=1e-6)


def test_what_does_not_average_out_is_not_looked_away():
    """20 mm to go, 40 mm of doubt in common: all looks taken, and then a fifth of the way."""
    bench = begun(shared_m=0.04)
    bench.sees = ego(0.5 + 0.02, 0.0)
    step, looks = bench.until_step()
    assert looks == bench.equipment.config.approach.looks_max
    assert step.x == pytest.approx(0.02 / 5.0, rel=0.01)


def test_it_looks_no_longer_than_it_may():
    bench = begun(shared_m=0.04)
    bench.sees = ego(0.5 + 0.02, 0.0)
    limit_ns = int(bench.equipment.config.approach.looking_max_s * 1e9)
    bench.until(lambda _c: len(bench.state.looks) == 6)
    first_ns = bench.state.looks[0].stamp_ns
    bench.blur_px = 100.0
    bench.until(lambda c: c.walk is not None)
    assert limit_ns <= bench.now_ns - first_ns <= limit_ns + 2e8


def test_at_the_goal_it_says_how_sure_it_can_be():
    bench = begun(shared_m=0.04)
    bench.sees = ego(0.5, 0.0)
    told = []
    bench.until(lambda c: told.extend(c.events) or c.state.phase == "reached")
    assert bench.state.moves == 0
    assert "as far as can be seen" in told[-1].message


def test_blurred_looks_are_none():
    bench = begun(blur_px=10.5)
    for _ in range(60):
        commands = bench.tick()
        assert commands.walk is None
        assert bench.state.looks == ()
    assert commands.state.target.found
    bench.blur_px = 9.5
    assert math.hypot(bench.until_step()[0].x) == pytest.approx(0.25)


@pytest.mark.parametrize("clipped", [("left",), ("right",), ("top", "right")])
def test_an_object_cut_aside_is_waited_for(clipped):
    bench = begun(clipped=clipped)
    bench.tick(ticks=60)
    assert bench.state.looks == ()
    assert bench.state.moves == 0


@pytest.mark.parametrize("clipped", [("top",), ("bottom",)])
def test_an_object_whose_end_is_out_of_the_picture_will_do(clipped):
    assert begun(clipped=clipped).until_step()[0].x == pytest.approx(0.25)

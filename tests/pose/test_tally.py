"""Which edges of a look are unlike the others, and what that makes of sigma."""

import numpy as np

from naod.perception.alike import COLUMNS, GOES, OFFSET, SIGMA, WIDTH
from naod.pose.tally import (
    BLUR,
    MOVED,
    ODD_SIDES,
    RISE,
    RISE_ASIDE,
    SHARP_RISE_PX,
    TALLY,
    doubt,
    mixed_px,
    tell,
)

EDGES = np.arange(40) % 4


def look(width_across, width_aside, rng):
    found = np.zeros((40, COLUMNS))
    found[:, SIGMA] = 0.1
    found[:, OFFSET] = rng.normal(0.0, 0.2, 40)
    found[:, WIDTH] = np.where(EDGES % 2 == 0, width_across, width_aside)
    found[:, WIDTH] *= rng.uniform(0.95, 1.05, 40)
    found[:, GOES] = rng.uniform(0.95, 1.05, 40)
    return found


def told(found):
    tally, doubts = np.zeros(TALLY), np.empty(40)
    tell(found, EDGES, 40, SHARP_RISE_PX, tally)
    doubt(found, EDGES, 40, tally, doubts)
    return tally, doubts


def test_both_directions_are_told_apart():
    tally, doubts = told(look(4.0, 20.0, np.random.default_rng(0)))
    assert abs(mixed_px(tally[RISE], SHARP_RISE_PX) - np.sqrt(4.0**2 - SHARP_RISE_PX**2)) < 0.3
    assert abs(tally[RISE_ASIDE] - 20.0) < 0.8
    assert tally[BLUR] > 15.0
    assert tally[MOVED] < 0.5
    assert not doubts.any()


def test_a_step_of_another_width_is_doubted_and_its_edge_a_little():
    found = look(4.0, 20.0, np.random.default_rng(1))
    found[5, WIDTH] = 10.0
    tally, doubts = told(found)
    # half as wide as the others: up to half of what is missing
    assert 3.0 < doubts[5] < 6.0
    assert np.count_nonzero(doubts) == 1
    odd = tally[ODD_SIDES : ODD_SIDES + 4]
    assert 0.25 < odd[EDGES[5]] < 0.6
    assert np.count_nonzero(odd) == 1


def test_a_step_that_goes_elsewhere_in_its_pace_is_doubted():
    found = look(4.0, 20.0, np.random.default_rng(2))
    found[7, GOES] = 1.6
    assert 2.0 < told(found)[1][7] < 6.0


def test_sharp_steps_are_not_compared():
    found = look(3.2, 3.2, np.random.default_rng(3))
    found[3, WIDTH] = 4.8
    assert not told(found)[1].any()


def test_nothing_found_tells_of_nothing():
    found = look(4.0, 4.0, np.random.default_rng(4))
    found[:, SIGMA] = np.inf
    tally, doubts = told(found)
    assert np.isfinite(tally).all()
    assert not doubts.any()

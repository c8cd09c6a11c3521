"""What the exact optimum keeps, costs and turns away."""

from __future__ import annotations

import tracemalloc
from collections.abc import Iterator

import numpy as np
import pytest
from numba.core.runtime import _nrt_python, rtsys
from numpy.typing import NDArray
from random_fields import STATISTICS, random_field

from naod.perception.optimum import BETA_MAX, Optimum
from naod.perception.optimum_field import CANDIDATES, LIFTS, UNDECIDED, VISITS, WAVES

FULL = (120, 160)


def labels_of(differences: NDArray[np.int32], beta: int) -> NDArray[np.uint8]:
    labels = np.zeros(differences.shape, dtype=np.uint8)
    Optimum(*differences.shape).minimise(np.ascontiguousarray(differences), beta, labels)
    return labels


@pytest.mark.parametrize("statistics", STATISTICS)
@pytest.mark.parametrize("beta", [30, 300])
def test_turned_field_gives_turned_labels(statistics: str, beta: int) -> None:
    differences = random_field(statistics, (21, 34), 3)
    labels = labels_of(differences, beta)
    for turn in (np.flipud, np.fliplr, np.transpose, np.rot90):
        assert (labels_of(turn(differences), beta) == turn(labels)).all()


@pytest.mark.parametrize("statistics", STATISTICS)
@pytest.mark.parametrize("beta", [30, 300])
def test_exchanged_labels_give_the_same_minimum(statistics: str, beta: int) -> None:
    differences = random_field(statistics, (21, 34), 4)
    optimum, labels = Optimum(21, 34), np.zeros((21, 34), dtype=np.uint8)
    others = labels.copy()
    energy = optimum.minimise(differences, beta, labels)
    exchanged = optimum.minimise(-differences, beta, others)
    assert energy == exchanged + int(differences.sum())
    assert (labels <= 1 - others).all()


@pytest.mark.parametrize("statistics", STATISTICS)
def test_likelier_object_never_shrinks(statistics: str) -> None:
    differences = random_field(statistics, (21, 34), 5)
    rng = np.random.default_rng(5)
    likelier = (differences - rng.integers(0, 40, differences.shape)).astype(np.int32)
    assert (labels_of(differences, 100) <= labels_of(likelier, 100)).all()


@pytest.mark.parametrize("beta", [0, 100, 1000])
def test_result_depends_on_nothing_that_was_there_before(beta: int) -> None:
    optimum = Optimum(*FULL)
    for statistics in STATISTICS:
        differences = random_field(statistics, FULL, 6)
        first, second = np.zeros(FULL, dtype=np.uint8), np.ones(FULL, dtype=np.uint8)
        before = differences.copy()
        energy = optimum.minimise(differences, beta, first)
        counts = optimum.counts.copy()
        assert optimum.minimise(differences, beta, second) == energy
        assert (first == second).all()
        assert (optimum.counts == counts).all()
        assert (differences == before).all()
        assert (first == labels_of(differences, beta)).all()


def test_clear_pictures_need_no_cut() -> None:
    optimum, labels = Optimum(*FULL), np.zeros(FULL, dtype=np.uint8)
    differences = np.full(FULL, 5000, dtype=np.int32)
    differences[30:70, 50:90] = -5000
    optimum.minimise(differences, 256, labels)
    assert not optimum.counts.any()
    assert (labels == (differences < 0)).all()


def test_bounds_meet_on_most_of_a_noisy_object() -> None:
    optimum, labels = Optimum(*FULL), np.zeros(FULL, dtype=np.uint8)
    differences = random_field("object", FULL, 0)
    optimum.minimise(differences, 256, labels)
    undecided_alone = np.count_nonzero((differences >= -1024) & (differences < 1024))
    assert optimum.counts[UNDECIDED] < 0.1 * undecided_alone


@pytest.mark.parametrize("statistics", STATISTICS)
def test_hardest_fields_take_a_bounded_amount_of_work(statistics: str) -> None:
    """Counted, not timed: at most sixty looks at every pixel, whatever beta."""
    optimum, labels = Optimum(*FULL), np.zeros(FULL, dtype=np.uint8)
    for beta in (10, 50, 100, 150, 256, 500, 1000, 3000, 20000, BETA_MAX):
        optimum.minimise(random_field(statistics, FULL, 7), beta, labels)
        counts = optimum.counts
        assert counts[UNDECIDED] <= counts[CANDIDATES] <= labels.size
        assert counts[VISITS] + counts[LIFTS] <= 60 * labels.size
        assert optimum.waves == counts[WAVES] <= counts[UNDECIDED]


@pytest.fixture
def counted_allocations() -> Iterator[None]:
    _nrt_python.memsys_enable_stats()
    yield
    _nrt_python.memsys_disable_stats()


def allocations(optimum: Optimum, differences: NDArray[np.int32]) -> int:
    """Memory blocks that compiled code asks for during one call."""
    labels = np.zeros(differences.shape, dtype=np.uint8)
    before = rtsys.get_allocation_stats()
    optimum.minimise(differences, 256, labels)
    after = rtsys.get_allocation_stats()
    assert after.alloc - before.alloc == after.free - before.free
    return after.alloc - before.alloc


@pytest.mark.usefixtures("counted_allocations")
def test_allocates_nothing_for_a_picture() -> None:
    """Compiled code asks for handles of its arguments only, as many as for one pixel."""
    large = Optimum(*FULL)
    hard = random_field("noise", FULL, 8)
    of_one = allocations(Optimum(1, 1), np.zeros((1, 1), dtype=np.int32))
    assert allocations(large, hard) == of_one
    assert large.counts[UNDECIDED] > 1000
    labels = np.zeros(FULL, dtype=np.uint8)
    tracemalloc.start()
    for _ in range(10):
        large.minimise(hard, 256, labels)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 4096


def test_turns_away_what_it_cannot_minimise() -> None:
    optimum = Optimum(4, 5)
    good, labels = np.zeros((4, 5), dtype=np.int32), np.zeros((4, 5), dtype=np.uint8)
    with pytest.raises(ValueError, match="expected fields"):
        optimum.minimise(good.T, 1, labels)
    with pytest.raises(ValueError, match="expected int32"):
        optimum.minimise(good.astype(np.int64), 1, labels)  # type: ignore[arg-type]
    for beta in (-1, BETA_MAX + 1):
        with pytest.raises(ValueError, match="beta"):
            optimum.minimise(good, beta, labels)
    with pytest.raises(ValueError, match="contiguous"):
        optimum.minimise(np.zeros((5, 4), dtype=np.int32).T, 1, labels)

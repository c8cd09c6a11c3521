"""The table against the paper's Gaussian on rendered walks: the small form of `bench colours`."""

import pytest

from naod.bench.colours import finders_of, tally
from naod.bench.rendered_walks import RoomLook, Walks

SIZE, COUNT = (320, 240), 8
UNSEEN_ROOMS = (RoomLook(seed=8, light=1.3), RoomLook(seed=9, light=0.7, picture=True))


@pytest.fixture(scope="module", params=["can", "board"])
def walks(request, tmp_path_factory):
    folder = tmp_path_factory.mktemp("walls")
    home = Walks(request.param, RoomLook(), folder, SIZE)
    away = [Walks(request.param, look, folder, SIZE) for look in UNSEEN_ROOMS]
    return home, away, finders_of(*home.shown(3))


def both(finders, frames):
    return tally(finders["table"], frames), tally(finders["gaussian"], frames)


def test_the_table_survives_the_blur_of_a_walk(walks):
    home, _, finders = walks
    table, gaussian = both(finders, home.frames(COUNT, 0.033))
    assert table.lost == 0.0
    assert table.box_iou > gaussian.box_iou + 0.04


def test_it_is_no_worse_when_sharp(walks):
    home, _, finders = walks
    table, gaussian = both(finders, home.frames(COUNT, 0.0))
    assert table.lost == 0.0
    assert table.box_iou >= gaussian.box_iou - 0.01


def test_it_is_never_much_worse_in_a_room_it_never_saw(walks):
    _, away, finders = walks
    for other in away:
        table, gaussian = both(finders, other.frames(COUNT, 0.033))
        assert table.lost <= gaussian.lost
        assert table.box_iou > gaussian.box_iou - 0.03

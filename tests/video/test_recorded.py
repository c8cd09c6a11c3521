"""Recordings as cameras."""

import cv2
import numpy as np
import pytest
from video_clocks import VirtualClock

from hal.errors import BackendError, CameraTimeoutError
from hal.video.source import open_camera
from hal.yuyv import rgb_from_yuyv

SIZE = (32, 24)
LEVELS = (40, 90, 140, 190)


@pytest.fixture
def folder(tmp_path):
    for number, level in enumerate(LEVELS):
        image = np.full((SIZE[1], SIZE[0], 3), level, dtype=np.uint8)
        image[:4, :4] = (0, 0, 200)
        cv2.imwrite(str(tmp_path / f"{number:03d}.png"), image)
    (tmp_path / "notes.txt").write_text("not a picture")
    return tmp_path


def levels(frame):
    return int(frame.yuyv[12, 16, 0])


def test_a_folder_gives_its_pictures_in_order_at_its_rate(folder):
    clock = VirtualClock()
    camera = open_camera(str(folder), "top", SIZE, 10, clock)
    begun = clock.now
    frames = [camera.unseen(1.0) for _ in range(4)]
    assert [levels(frame) for frame in frames] == list(LEVELS)
    assert [(frame.stamp_ns - begun) / 1e6 for frame in frames] == [0.0, 100.0, 200.0, 300.0]
    assert [frame.sequence for frame in frames] == [0, 1, 2, 3]
    assert clock.now == frames[-1].stamp_ns
    assert frames[0].camera == "top"


def test_colours_survive_and_the_picture_is_not_swapped(folder):
    camera = open_camera(str(folder), "top", SIZE, 10, VirtualClock())
    red = rgb_from_yuyv(camera.unseen(1.0).yuyv)[1, 1]
    assert red[0] > 190
    assert red[2] < 10


def test_what_nobody_read_is_gone(folder):
    clock = VirtualClock()
    camera = open_camera(str(folder), "top", SIZE, 10, clock)
    camera.unseen(1.0)
    clock.now += 250_000_000
    assert levels(camera.unseen(1.0)) == LEVELS[2]
    assert camera.latest(0.01) is None
    assert levels(camera.latest(0.06)) == LEVELS[2]
    assert levels(camera.next(1.0)) == LEVELS[3]


def test_it_begins_anew_or_ends(folder):
    clock = VirtualClock()
    again = open_camera(str(folder), "top", SIZE, 10, clock)
    clock.now += 400_000_000
    frame = again.unseen(1.0)
    assert (levels(frame), frame.sequence) == (LEVELS[0], 4)
    once = open_camera(str(folder), "top", SIZE, 10, clock, loop=False)
    clock.now += 10**9
    assert levels(once.unseen(1.0)) == LEVELS[3]
    assert once.latest(0.5) is None
    with pytest.raises(CameraTimeoutError, match="over"):
        once.unseen(0.5)


def test_a_video_is_decoded_forwards_and_from_the_beginning_again(tmp_path):
    path = tmp_path / "walk.avi"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter_fourcc(*"MJPG"), 10, SIZE)
    for level in LEVELS:
        writer.write(np.full((SIZE[1], SIZE[0], 3), level, dtype=np.uint8))
    writer.release()
    clock = VirtualClock()
    camera = open_camera(str(path), "bottom", SIZE, 20, clock)
    seen = [levels(camera.unseen(1.0)) for _ in range(5)]
    assert np.abs(np.array(seen) - [*LEVELS, LEVELS[0]]).max() <= 3
    clock.now += 100_000_000
    assert abs(levels(camera.unseen(1.0)) - LEVELS[2]) <= 3


def test_a_spoilt_picture_is_a_lost_one(folder):
    (folder / "001.png").write_bytes(b"not a picture")
    clock = VirtualClock()
    camera = open_camera(str(folder), "top", SIZE, 10, clock)
    camera.unseen(1.0)
    clock.now += 100_000_000
    with pytest.raises(CameraTimeoutError, match=r"001\.png"):
        camera.unseen(0.5)
    assert camera.latest(0.5) is None
    clock.now += 100_000_000
    assert levels(camera.unseen(0.5)) == LEVELS[2]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("", "No such file"),
        ("empty", "without pictures"),
        ("odd.mp4", "neither a video"),
        ("a\0b", "not a path"),
    ],
)
def test_what_cannot_be_opened_is_told_in_one_line(tmp_path, name, words):
    (tmp_path / "empty").mkdir()
    (tmp_path / "odd.mp4").write_bytes(b"no video at all")
    device = str(tmp_path / name) if name else "missing.png"
    with pytest.raises(BackendError, match=words) as caught:
        open_camera(device, "top", SIZE, 10, VirtualClock())
    assert "\n" not in str(caught.value)


def test_a_picture_of_another_size_is_refused(folder):
    with pytest.raises(BackendError, match="is 32x24, the camera is configured for 64x48"):
        open_camera(str(folder), "top", (64, 48), 10, VirtualClock())


def test_a_closed_recording_gives_nothing(folder):
    camera = open_camera(str(folder), "top", SIZE, 10, VirtualClock())
    camera.close()
    assert camera.latest(9.0) is None
    with pytest.raises(CameraTimeoutError):
        camera.unseen(0.1)

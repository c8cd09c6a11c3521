"""The V4L2 camera against a driver that sees bytes, and a real one where there is v4l2loopback."""

import time

import numpy as np
import pytest
from sham_driver import (
    AUTO_WB,
    EXPOSURE_ABSOLUTE,
    EXPOSURE_AUTO,
    FOCUS,
    FOCUS_AUTO,
    GAIN,
    H_FLIP,
    MJPG,
    V_FLIP,
    WB,
    Driver,
)

from hal.clock import MonotonicClock
from hal.errors import BackendError, CameraTimeoutError
from hal.video.rotation import upright
from hal.video.v4l2_camera import open_v4l2

SIZE = (8, 4)
PICTURE = np.random.default_rng(5).integers(0, 256, (4, 8, 2), dtype=np.uint8)
AUTOMATIC = {
    EXPOSURE_AUTO: (0, 3, 3),
    EXPOSURE_ABSOLUTE: (0, 1000, 300),
    GAIN: (0, 1023, 16),
    AUTO_WB: (0, 1, 1),
    WB: (2000, 7000, 4100),
    FOCUS_AUTO: (0, 1, 0),
    FOCUS: (0, 250, 75),
}


@pytest.fixture
def cameras():
    opened = []
    yield opened
    for camera in opened:
        camera.close()


def opened(cameras, driver, which="bottom", upside_down=False, controls=None, **more):
    camera = open_v4l2(
        "/dev/sham", which, SIZE, 30, MonotonicClock(), upside_down, controls or {}, 0.0, driver,
        settle_s=0.0, **more,
    )  # fmt: skip
    cameras.append(camera)
    return camera


def first(camera, driver, picture=PICTURE, **more):
    driver.fill(picture, **more)
    frame = camera.unseen(5.0)
    assert camera.settled.wait(5.0)
    return frame


def test_a_picture_comes_as_the_driver_gave_it(cameras):
    driver = Driver()
    camera = opened(cameras, driver)
    frame = first(camera, driver, time_ns=7_000_123_000, sequence=41)
    assert np.array_equal(frame.yuyv, PICTURE)
    assert (frame.sequence, frame.camera) == (41, "bottom")
    # the middle of the read-out, by B-Human's figures for the lower camera
    assert frame.stamp_ns == 7_000_123_000 - 36_000_000 + 22_500_000
    driver.fill(PICTURE // 2)
    assert np.array_equal(camera.unseen(5.0).yuyv, PICTURE // 2)
    assert np.array_equal(frame.yuyv, PICTURE)


def test_rows_with_a_rest_are_cut(cameras):
    driver = Driver(stride=24)
    assert np.array_equal(first(opened(cameras, driver), driver).yuyv, PICTURE)


def test_only_the_newest_is_handed_out_and_all_buffers_go_back(cameras):
    driver = Driver()
    camera = opened(cameras, driver)
    first(camera, driver)
    for number in range(1, 20):
        driver.fill(PICTURE, sequence=number)
    while camera.unseen(5.0).sequence != 19:
        pass
    with pytest.raises(CameraTimeoutError):
        camera.unseen(0.01)


def test_a_spoilt_or_short_buffer_is_no_picture(cameras):
    driver = Driver()
    camera = opened(cameras, driver)
    first(camera, driver)
    driver.fill(PICTURE, flags=0x2040, sequence=1)
    driver.fill(PICTURE[:3], sequence=2)
    driver.fill(PICTURE, sequence=3)
    assert camera.unseen(5.0).sequence == 3


@pytest.mark.parametrize("by_driver", [True, False])
def test_the_upside_down_sensor_is_turned_once(cameras, by_driver):
    flips = {H_FLIP: (0, 1, 0), V_FLIP: (0, 1, 0)} if by_driver else {H_FLIP: (0, 1, 0)}
    driver = Driver(flips)
    camera = opened(cameras, driver, "top", upside_down=True)
    frame = first(camera, driver)
    assert np.array_equal(frame.yuyv, PICTURE if by_driver else upright(PICTURE))
    assert driver.controls[H_FLIP][2] == by_driver
    assert ("by the driver" if by_driver else "here") in camera.examine()[0].text
    camera.close()
    assert driver.controls[H_FLIP][2] == 0


def test_a_flip_that_does_not_take_is_done_here(cameras):
    driver = Driver({H_FLIP: (0, 1, 0), V_FLIP: (0, 1, 0)})
    driver.stubborn.add(V_FLIP)
    camera = opened(cameras, driver, "top", upside_down=True)
    assert np.array_equal(first(camera, driver).yuyv, upright(PICTURE))
    assert driver.controls[H_FLIP][2] == 0


def test_automatics_are_off_while_open_and_on_again_afterwards(cameras):
    driver = Driver(AUTOMATIC)
    camera = opened(cameras, driver, controls={"exposure": 512, "focus": 0})
    first(camera, driver)
    held = {number: row[2] for number, row in driver.controls.items()}
    assert held == {
        EXPOSURE_AUTO: 1, EXPOSURE_ABSOLUTE: 512, GAIN: 16, AUTO_WB: 0, WB: 4100, FOCUS_AUTO: 0,
        FOCUS: 0,
    }  # fmt: skip
    assert all(finding.status == "ok" for finding in camera.examine())
    camera.close()
    assert {number: tuple(row) for number, row in driver.controls.items()} == AUTOMATIC
    assert driver.written.index((EXPOSURE_AUTO, 1)) < driver.written.index((EXPOSURE_ABSOLUTE, 512))
    assert driver.written[-1] == (EXPOSURE_AUTO, 3)
    assert (driver.opened, driver.closed) == (1, 1)


def test_controls_that_did_not_take_are_told(cameras):
    driver = Driver(AUTOMATIC)
    driver.stubborn.add(AUTO_WB)
    driver.dead.add(GAIN)
    del driver.controls[FOCUS]
    given = {"exposure": 5000, "gain": 20, "focus": 25}
    camera = opened(cameras, driver, controls=given)
    first(camera, driver)
    told = next(f for f in camera.examine() if f.check == "camera controls")
    assert told.status == "warn"
    for words in (
        "exposure: 5000 is outside 0 to 1000",
        "gain: refused: Input/output error",
        "automatic white balance: stayed at 1, not 0",
        "focus: the driver has no such control",
    ):
        assert words in told.text
    assert told.advice


def test_an_unplugged_camera_is_opened_again_and_held_again(cameras):
    driver = Driver(AUTOMATIC)
    camera = opened(cameras, driver)
    first(camera, driver)
    driver.unplug()
    with pytest.raises(CameraTimeoutError):
        camera.unseen(0.3)
    assert camera.examine()[0].status == "fail"
    driver.controls[AUTO_WB][2] = 1
    driver.plug_in()
    driver.fill(PICTURE, sequence=9)
    assert camera.unseen(5.0).sequence == 9
    driver.fill(PICTURE, sequence=10)
    assert camera.unseen(5.0).sequence == 10
    assert driver.controls[AUTO_WB][2] == 0
    assert driver.opened == driver.closed + 1


def test_stamps_of_an_unknown_clock_are_replaced_and_told(cameras):
    driver = Driver()
    camera = opened(cameras, driver)
    before = time.monotonic_ns()
    frame = first(camera, driver, time_ns=1_700_000_000 * 10**9, flags=0)
    assert before - 10**8 < frame.stamp_ns < time.monotonic_ns()
    assert "camera clock" in {finding.check for finding in camera.examine()}


@pytest.mark.parametrize(
    ("driver", "words"),
    [
        (Driver(pixels=MJPG), "gives MJPG 8x4 where YUYV 8x4 was asked for; it offers YUYV, MJPG"),
        (Driver(sizes=((640, 480),)), "gives YUYV 640x480 where YUYV 8x4"),
    ],
)
def test_a_format_that_is_not_ours_is_refused_with_what_there_is(cameras, driver, words):
    with pytest.raises(BackendError, match=words):
        opened(cameras, driver)
    assert driver.opened == driver.closed


def test_a_control_of_no_name_is_refused(cameras):
    with pytest.raises(BackendError, match="no camera control 'zoom'"):
        opened(cameras, Driver(), controls={"zoom": 1})

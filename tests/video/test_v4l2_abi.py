"""Our numbers against the C compiler's, and a real device where there is one."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from hal.clock import MonotonicClock
from hal.video import v4l2_abi as abi
from hal.video.source import open_camera

HEADER = Path("/usr/include/linux/videodev2.h")
CALLS = {
    "VIDIOC_QUERYCAP": abi.QUERYCAP, "VIDIOC_ENUM_FMT": abi.ENUM_FMT, "VIDIOC_S_FMT": abi.S_FMT,
    "VIDIOC_G_FMT": abi.G_FMT, "VIDIOC_REQBUFS": abi.REQBUFS, "VIDIOC_QUERYBUF": abi.QUERYBUF,
    "VIDIOC_QBUF": abi.QBUF, "VIDIOC_DQBUF": abi.DQBUF, "VIDIOC_STREAMON": abi.STREAMON,
    "VIDIOC_STREAMOFF": abi.STREAMOFF, "VIDIOC_S_PARM": abi.S_PARM, "VIDIOC_G_CTRL": abi.G_CTRL,
    "VIDIOC_G_PARM": abi.G_PARM, "VIDIOC_S_CTRL": abi.S_CTRL, "VIDIOC_QUERYCTRL": abi.QUERYCTRL,
    "VIDIOC_ENUM_FRAMESIZES": abi.ENUM_FRAMESIZES, "V4L2_PIX_FMT_YUYV": abi.YUYV,
    "V4L2_CID_AUTO_WHITE_BALANCE": abi.AUTO_WHITE_BALANCE, "V4L2_CID_EXPOSURE": abi.EXPOSURE,
    "V4L2_CID_AUTOGAIN": abi.AUTO_GAIN, "V4L2_CID_GAIN": abi.GAIN, "V4L2_CID_HFLIP": abi.H_FLIP,
    "V4L2_CID_VFLIP": abi.V_FLIP, "V4L2_CID_HUE_AUTO": abi.HUE_AUTO,
    "V4L2_CID_WHITE_BALANCE_TEMPERATURE": abi.WHITE_BALANCE,
    "V4L2_CID_EXPOSURE_AUTO": abi.EXPOSURE_AUTO, "V4L2_EXPOSURE_MANUAL": abi.EXPOSURE_MANUAL,
    "V4L2_CID_EXPOSURE_ABSOLUTE": abi.EXPOSURE_ABSOLUTE,
    "V4L2_CID_EXPOSURE_AUTO_PRIORITY": abi.EXPOSURE_AUTO_PRIORITY,
    "V4L2_CID_FOCUS_ABSOLUTE": abi.FOCUS_ABSOLUTE, "V4L2_CID_FOCUS_AUTO": abi.FOCUS_AUTO,
    "V4L2_CAP_VIDEO_CAPTURE": abi.CAP_CAPTURE, "V4L2_CAP_STREAMING": abi.CAP_STREAMING,
    "V4L2_CAP_DEVICE_CAPS": abi.CAP_DEVICE_CAPS, "V4L2_BUF_FLAG_ERROR": abi.BUFFER_ERROR,
    "V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC": abi.BUFFER_MONOTONIC,
    "V4L2_BUF_FLAG_TIMESTAMP_MASK": abi.BUFFER_CLOCKS,
    "V4L2_CTRL_FLAG_DISABLED": abi.CONTROL_DISABLED,
    "V4L2_CTRL_FLAG_READ_ONLY": abi.CONTROL_READ_ONLY,
}  # fmt: skip
OFFSETS = {
    ("v4l2_format", "fmt.pix.width"): (abi.FORMAT, 1),
    ("v4l2_format", "fmt.pix.bytesperline"): (abi.FORMAT, 5),
    ("v4l2_buffer", "timestamp"): (abi.BUFFER, 5),
    ("v4l2_buffer", "sequence"): (abi.BUFFER, 7),
    ("v4l2_buffer", "m.offset"): (abi.BUFFER, 9),
    ("v4l2_buffer", "length"): (abi.BUFFER, 11),
    ("v4l2_queryctrl", "minimum"): (abi.QUERY, 3),
    ("v4l2_queryctrl", "flags"): (abi.QUERY, 7),
    ("v4l2_streamparm", "parm.capture.timeperframe"): (abi.PARM, 3),
    ("v4l2_capability", "device_caps"): (abi.CAPABILITY, 5),
    ("v4l2_fmtdesc", "pixelformat"): (abi.DESCRIPTION, 4),
    ("v4l2_frmsizeenum", "discrete.width"): (abi.SIZES, 3),
}


def offset_of(layout, field):
    """Where a field lies: the first byte that changes it."""
    for offset in range(layout.size):
        probe = bytearray(layout.size)
        probe[offset] = 1
        if layout.unpack(bytes(probe))[field] not in (0, bytes(32), bytes(16)):
            return offset
    raise AssertionError(field)


def test_numbers_and_places_are_the_compilers(tmp_path):
    compiler = shutil.which("cc")
    if compiler is None or not HEADER.exists():
        pytest.skip("no C compiler or no linux/videodev2.h")
    lines = [f'printf("%lu\\n", (unsigned long)({name}) & 0xffffffff);' for name in CALLS]
    lines += [f'printf("%zu\\n", offsetof(struct {kind}, {field}));' for kind, field in OFFSETS]
    source = tmp_path / "numbers.c"
    source.write_text(
        "#include <stdio.h>\n#include <stddef.h>\n#include <linux/videodev2.h>\n"
        "int main(void) {\n" + "\n".join(lines) + "\nreturn 0; }\n"
    )
    subprocess.run([compiler, "-o", tmp_path / "numbers", source], check=True)
    done = subprocess.run([tmp_path / "numbers"], capture_output=True, text=True, check=True)
    theirs = [int(word) for word in done.stdout.split()]
    ours = [*CALLS.values(), *(offset_of(*place) for place in OFFSETS.values())]
    assert dict(zip([*CALLS, *OFFSETS], ours, strict=True)) == dict(
        zip([*CALLS, *OFFSETS], theirs, strict=True)
    )


def test_a_loopback_device_gives_what_is_written_to_it():
    loopback = [
        Path("/dev") / path.parent.name
        for path in Path("/sys/class/video4linux").glob("*/name")
        if (path.parent / "max_openers").exists()
    ]
    if not loopback:
        pytest.skip("no v4l2loopback device")
    device, rng = loopback[0], np.random.default_rng(0)
    picture = rng.integers(0, 256, (480, 640, 2), dtype=np.uint8)
    writer = shutil.which("ffmpeg")
    if writer is None:
        pytest.skip("no ffmpeg to feed v4l2loopback")
    feed = subprocess.Popen(
        [writer, "-loglevel", "quiet", "-stream_loop", "-1", "-f", "rawvideo", "-pix_fmt",
         "yuyv422", "-s", "640x480", "-r", "15", "-i", "-", "-f", "v4l2", str(device)],
        stdin=subprocess.PIPE,
    )  # fmt: skip
    try:
        assert feed.stdin is not None
        feed.stdin.write(picture.tobytes() * 60)
        camera = open_camera(str(device), "bottom", (640, 480), 15, MonotonicClock())
        assert np.array_equal(camera.unseen(5.0).yuyv, picture)
        camera.close()
    finally:
        feed.kill()
        feed.wait()

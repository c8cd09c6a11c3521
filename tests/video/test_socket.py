"""The frame socket: real sockets, and servers that are broken in every way."""

import contextlib
import socket
import threading
import time

import numpy as np
import pytest

from hal.clock import MonotonicClock
from hal.errors import BackendError, CameraTimeoutError
from hal.types import Frame
from hal.video.address import connected, parse_address
from hal.video.client import SenderClock
from hal.video.server import FrameServer
from hal.video.slot import SlotCamera
from hal.video.source import open_camera
from hal.video.wire import REQUEST, packed, this_clock, unpacked

SIZE = (8, 4)
CLOCK = MonotonicClock()


def frame(number, size=SIZE, camera="top", stamp_ns=None):
    yuyv = np.full((size[1], size[0], 2), number % 256, dtype=np.uint8)
    stamp = time.monotonic_ns() if stamp_ns is None else stamp_ns
    return Frame(stamp, yuyv, camera, 0.0, number)


@pytest.fixture(params=["tcp", "unix"])
def served(request, tmp_path):
    """A camera whose pictures the test takes, and the address where it is served."""
    camera = SlotCamera("top", SIZE, CLOCK)
    where = "tcp://127.0.0.1:0" if request.param == "tcp" else f"unix:{tmp_path}/frames"
    server = FrameServer(where, camera)
    server.start()
    yield camera.slot, server
    server.close()


def opened(address, size=SIZE, which="top", patience_s=0.0):
    return open_camera(address, which, size, 10, CLOCK, patience_s=patience_s)


def test_pictures_arrive_as_they_were_taken(served):
    slot, server = served
    camera = opened(server.address)
    for number in range(5):
        sent = frame(number)
        slot.put(sent)
        got = camera.unseen(5.0)
        assert np.array_equal(got.yuyv, sent.yuyv)
        assert (got.stamp_ns, got.sequence, got.camera) == (sent.stamp_ns, number, "top")
    assert camera.latest(60.0) is got
    assert camera.latest(0.0) is None
    with pytest.raises(CameraTimeoutError):
        camera.unseen(0.01)
    camera.close()


def test_who_comes_late_finds_the_newest_only(served):
    slot, server = served
    camera = opened(server.address)
    slot.put(frame(0))
    camera.unseen(5.0)
    for number in range(1, 50):
        slot.put(frame(number))
    seen = [camera.unseen(5.0).sequence]
    while seen[-1] < 49:
        seen.append(camera.unseen(5.0).sequence)
    # one that was under way already, and the newest
    assert len(seen) <= 3
    with pytest.raises(CameraTimeoutError):
        camera.unseen(0.05)
    camera.close()


def test_next_waits_for_a_picture_of_later(served):
    slot, server = served
    camera = opened(server.address)
    slot.put(frame(0))
    camera.unseen(5.0)
    early = frame(1, stamp_ns=time.monotonic_ns())
    asked, got = threading.Event(), []

    class Clock(MonotonicClock):
        def now_ns(self):
            now = super().now_ns()
            asked.set()
            return now

    camera._clock = Clock()
    reader = threading.Thread(target=lambda: got.append(camera.next(5.0)))
    reader.start()
    assert asked.wait(5.0)
    slot.put(early)
    slot.put(frame(2))
    reader.join(5.0)
    assert [f.sequence for f in got] == [2]
    camera.close()


def test_several_clients_see_the_same(served):
    slot, server = served
    cameras = [opened(server.address) for _ in range(3)]
    slot.put(frame(7))
    assert [camera.unseen(5.0).sequence for camera in cameras] == [7, 7, 7]
    for camera in cameras:
        camera.close()


def test_a_server_that_comes_back_is_found_again(tmp_path):
    where = f"unix:{tmp_path}/frames"
    camera = opened(where)
    for number in range(2):
        source = SlotCamera("top", SIZE, CLOCK)
        server = FrameServer(where, source)
        server.start()
        source.slot.put(frame(number))
        assert camera.unseen(5.0).sequence == number
        server.close()
    assert camera.connections >= 2
    camera.close()
    assert camera.examine()[0].status == "warn"


def test_what_is_at_the_other_end_must_fit(served):
    slot, server = served
    slot.put(frame(0))
    with pytest.raises(BackendError, match="its pictures are 8x4, not 16x8"):
        opened(server.address, size=(16, 8), patience_s=1.0)
    with pytest.raises(BackendError, match="it is the top camera, not the bottom one"):
        opened(server.address, which="bottom", patience_s=1.0)


def test_nobody_there(tmp_path):
    with pytest.raises(BackendError, match="No such file"):
        opened(f"unix:{tmp_path}/nobody", patience_s=0.3)
    with pytest.raises(BackendError, match="tcp://HOST:PORT"):
        opened("tcp://nobody")


def test_two_servers_cannot_share_a_path(served):
    _, server = served
    with pytest.raises(BackendError, match="in use"):
        FrameServer(server.address, SlotCamera("top", SIZE, CLOCK))


def test_a_file_is_not_taken_for_an_orphaned_socket(tmp_path):
    path = tmp_path / "precious"
    path.write_text("keep")
    with pytest.raises(BackendError):
        FrameServer(f"unix:{path}", SlotCamera("top", SIZE, CLOCK))
    assert path.read_text() == "keep"


def good_bytes(number):
    sent = frame(number)
    return packed(sent, time.monotonic_ns(), this_clock()) + sent.yuyv.tobytes()


def _future(number):
    data = bytearray(good_bytes(number))
    at = time.monotonic_ns() + 60 * 10**9
    data[16:32] = at.to_bytes(8, "little") * 2
    return bytes(data)


BROKEN = {
    "cut in the header": lambda: good_bytes(1)[:40],
    "cut in the picture": lambda: good_bytes(1)[:-5],
    "oversized": lambda: good_bytes(1)[:12] + b"\xff\xff\xff\xff" + good_bytes(1)[16:],
    "another protocol": lambda: b"HTTP/1.1 400 Bad Request\r\n" * 4,
    "sent in the future": lambda: _future(1),
    "nothing": lambda: b"",
}


@pytest.mark.parametrize("name", sorted(BROKEN))
def test_a_broken_server_gives_no_picture_and_is_called_again(name):
    listener = socket.create_server(("127.0.0.1", 0))
    calls = []

    def serve():
        for answer in (BROKEN[name], lambda: good_bytes(2)):
            link, _ = listener.accept()
            with link, contextlib.suppress(OSError):
                calls.append(link.recv(1))
                link.sendall(answer())
                link.shutdown(socket.SHUT_WR)
                link.recv(1)

    thread = threading.Thread(target=serve, daemon=True)
    thread.start()
    camera = opened(f"tcp://127.0.0.1:{listener.getsockname()[1]}")
    assert camera.unseen(5.0).sequence == 2
    camera.close()
    thread.join(5.0)
    listener.close()
    assert calls == [b"\x01", b"\x01"]


def test_clocks_of_two_machines_are_aligned_by_the_quickest_picture():
    behind_ns, other = 7_000_000_000, bytes(range(1, 17))
    sender, rng = SenderClock(), np.random.default_rng(3)
    ways_ns = rng.integers(300_000, 20_000_000, 40)
    for number, way_ns in enumerate(ways_ns):
        sent_ns = 10**9 * (number + 1)
        header = unpacked(packed(frame(number, stamp_ns=sent_ns - 50), sent_ns, other))
        offset = sender.offset_ns(header, sent_ns + behind_ns + int(way_ns))
        assert offset == behind_ns + ways_ns[: number + 1].min()


def test_a_client_that_does_not_read_does_not_hold_up_the_others(served):
    slot, server = served
    large = (1280, 960)
    with connected(parse_address(server.address), 1.0) as idle:
        idle.sendall(REQUEST)
        camera = opened(server.address, size=large)
        for number in range(3):
            slot.put(frame(number, large))
            assert camera.unseen(5.0).sequence == number
        camera.close()

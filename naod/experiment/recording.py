"""A recording of an experiment as MCAP: the bus' JSON messages and, now and then, a picture.

Pictures are `foxglove.CompressedImage`, so that Foxglove shows them.
"""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import BinaryIO

import cv2
import msgspec
from foxglove_schemas_protobuf.CompressedImage_pb2 import CompressedImage
from mcap.writer import CompressionType, Writer
from mcap_protobuf.schema import build_file_descriptor_set

from hal.types import Frame
from hal.yuyv import rgb_from_yuyv
from naod.experiment.lockstep import Tick
from naod.experiment.summary import true_object_yaw
from naod.messages import EventMessage, StateMessage, TruthMessage, WalkCommand, WalkState

_JSON_TOPICS: dict[str, type[msgspec.Struct]] = {
    "state": StateMessage,
    "event": EventMessage,
    "walk/command": WalkCommand,
    "walk/state": WalkState,
    "sim/truth": TruthMessage,
}
PICTURE_PERIOD_NS = 500_000_000


class Recorder:
    """Listens to ticks and writes them; the file gets its name when it is whole (S10)."""

    def __init__(self, path: Path, robot_name: str) -> None:
        self._path = path
        self._partial = path.with_name(f".{path.name}.partial")
        self._file: BinaryIO = self._partial.open("wb")
        self._writer = Writer(self._file, compression=CompressionType.ZSTD)
        self._writer.start(library="naod")
        self._channels = {
            topic: self._json_channel(f"nao/{robot_name}/{topic}", kind)
            for topic, kind in _JSON_TOPICS.items()
        }
        self._picture_channel = self._image_channel(f"nao/{robot_name}/camera")
        self._next_picture_ns = 0

    def __enter__(self) -> Recorder:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._writer.finish()
        self._file.close()
        if kind is None:
            self._partial.replace(self._path)
        else:
            self._partial.unlink(missing_ok=True)

    def note(self, tick: Tick) -> None:
        """Write what happened in a tick."""
        now = tick.now_ns
        self._json("state", tick.commands.state, now)
        self._json("walk/state", tick.seen.walk, now)
        self._json("sim/truth", _truth(tick), now)
        if tick.commands.walk is not None:
            self._json("walk/command", tick.commands.walk, now)
        for event in tick.commands.events:
            self._json("event", event, now)
        if tick.seen.frame is not None and now >= self._next_picture_ns:
            self._next_picture_ns = now + PICTURE_PERIOD_NS
            self._picture(tick.seen.frame, now)

    def _json(self, topic: str, message: msgspec.Struct, now_ns: int) -> None:
        data = msgspec.json.encode(message)
        self._writer.add_message(self._channels[topic], now_ns, data, now_ns)

    def _picture(self, frame: Frame, now_ns: int) -> None:
        bgr = cv2.cvtColor(rgb_from_yuyv(frame.yuyv), cv2.COLOR_RGB2BGR)
        done, jpeg = cv2.imencode(".jpg", bgr, [cv2.IMWRITE_JPEG_QUALITY, 85])
        if not done:
            return
        image = CompressedImage(frame_id="camera", format="jpeg", data=jpeg.tobytes())
        image.timestamp.FromNanoseconds(frame.stamp_ns)
        data = image.SerializeToString()
        self._writer.add_message(self._picture_channel, now_ns, data, frame.stamp_ns)

    def _json_channel(self, topic: str, kind: type[msgspec.Struct]) -> int:
        schema = msgspec.json.encode(msgspec.json.schema(kind))
        number = self._writer.register_schema(kind.__name__, "jsonschema", schema)
        return int(self._writer.register_channel(topic, "json", number))

    def _image_channel(self, topic: str) -> int:
        schema = build_file_descriptor_set(CompressedImage).SerializeToString()
        name = CompressedImage.DESCRIPTOR.full_name
        number = self._writer.register_schema(name, "protobuf", schema)
        return int(self._writer.register_channel(topic, "protobuf", number))


def _truth(tick: Tick) -> TruthMessage:
    truth = tick.truth
    x, y, z = (float(v) for v in truth.T_world_object[:3, 3])
    return TruthMessage(
        stamp_ns=truth.stamp_ns,
        base=(truth.base.x, truth.base.y, truth.base.yaw),
        object=(x, y, z, true_object_yaw(truth)),
    )

"""What a demo leaves in its folder: summary, figures, annotated frames, an animation."""

from __future__ import annotations

from pathlib import Path

import cv2
import msgspec
import numpy as np
from numpy.typing import NDArray
from PIL import Image

from naod.experiment.annotate import annotated
from naod.experiment.approach_run import Outcome
from naod.experiment.lockstep import LockStep, Tick
from naod.experiment.plots import figure_10, figure_11, figure_12
from naod.files import write_whole

ROOM_SIZE = (640, 480)
FILM_SIZE = (400, 300)
FILM_PERIOD_NS = 700_000_000


class Film:
    """The room and the robot's own view side by side, a picture now and then."""

    def __init__(self, run: LockStep) -> None:
        self._run = run
        self._next_ns = 0
        self._pictures: list[Image.Image] = []

    def note(self, tick: Tick) -> None:
        """Take a picture if it is time."""
        if tick.seen.frame is None or tick.now_ns < self._next_ns:
            return
        self._next_ns = tick.now_ns + FILM_PERIOD_NS
        width, height = FILM_SIZE
        room = self._run.robot.room_view(width, height)
        view = annotated(
            tick.seen.frame, tick.sighting, self._run.equipment.camera, self._run.equipment.shape
        )
        own = cv2.resize(view, FILM_SIZE, interpolation=cv2.INTER_AREA)
        self._pictures.append(Image.fromarray(np.hstack([room, own])))

    def save(self, path: Path) -> None:
        """Write it as an animated GIF, with one palette so that colours do not flicker."""
        if not self._pictures:
            return
        few = self._pictures[:: max(1, len(self._pictures) // 6)]
        palette = Image.fromarray(np.vstack([np.asarray(p) for p in few])).quantize(
            255, method=Image.Quantize.MEDIANCUT, kmeans=2
        )
        reduced = [p.quantize(palette=palette, dither=Image.Dither.NONE) for p in self._pictures]
        first, *others = reduced
        times = [150] * len(others) + [2500]
        first.save(path, save_all=True, append_images=others, duration=times, loop=0, optimize=True)


def write_report(
    folder: Path, run: LockStep, outcome: Outcome, room_start: NDArray[np.uint8]
) -> None:
    """Write summary.json, the three figures and the frames into a folder."""
    summary = msgspec.json.format(msgspec.json.encode(outcome.summary), indent=1)
    room_end = run.robot.room_view(*ROOM_SIZE)
    way, shown = outcome.journal.way, outcome.shown
    shape = run.equipment.shape
    figure_10(folder / "figure_10.png", room_start, room_end, way, shown, shape)
    figure_11(folder / "figure_11.png", outcome.summary.localisation)
    figure_12(folder / "figure_12.png", outcome.summary.localisation)
    frames = folder / "frames"
    frames.mkdir(exist_ok=True)
    for old in frames.glob("look_*.png"):
        old.unlink()
    for number, (frame, sighting) in enumerate(outcome.journal.sights):
        drawn = annotated(frame, sighting, run.equipment.camera, run.equipment.shape)
        Image.fromarray(drawn).save(frames / f"look_{number:02d}.png")
    write_whole(folder / "summary.json", summary + b"\n")

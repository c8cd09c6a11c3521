"""The exact minimum beside PyMaxflow's and the paper's ICM, on the energies of every frame."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

from naod.bench.frames import Sequence as Taken
from naod.bench.table import Report
from naod.bench.timing import interleaved
from naod.config import SegmentationConfig, Width
from naod.perception.energy import field_energy
from naod.perception.icm import descend, label_by_singletons
from naod.perception.learning import KINDS, ModelKind, learn_model
from naod.perception.optimum import Optimum
from naod.perception.segmenter import Segmenter

WIDTHS: tuple[Width, ...] = (160, 320)
SWEEPS_MAX = 20
OURS, ICM, REFEREE = "exact minimum", "raster ICM", "PyMaxflow"
SLOW_FRAMES = 12
"""Frames of each size above the smallest."""

Progress = Callable[[str], None]
Field = NDArray[np.int32]
Row = tuple[str, int | None, str | None, float, float, float]


def run(sequences: Sequence[Taken], progress: Progress) -> Report:
    """Energies and times for each kind of model and each reduced width."""
    try:
        from naod.bench.peers.pymaxflow import minimum
    except ImportError:
        return Report("optima", ("no PyMaxflow: it is not installed",), ())
    rows = []
    for width in WIDTHS:
        progress(f"optima at {width}")
        for kind in KINDS:
            fields, beta = _fields(sequences, kind, width)
            chosen = fields if width == WIDTHS[0] else fields[:: max(len(fields) // SLOW_FRAMES, 1)]
            rows += _compared(f"{kind}, {width} wide", chosen, beta, minimum)
    columns = (
        "solver, model, size",
        "frames",
        "equal to PyMaxflow",
        "ms",
        "times ICM",
        "of PyMaxflow",
    )
    notes = ("ICM from the singletons' minimum until nothing changes; differences given to all",)
    return Report("optima", columns, tuple(rows), notes)


def _fields(sequences: Sequence[Taken], kind: ModelKind, width: Width) -> tuple[list[Field], int]:
    settings = SegmentationConfig(width=width)
    fields, beta = [], 0
    for sequence in sequences:
        height, full = sequence.shown.shape[:2]
        model = learn_model([sequence.shown], sequence.region, kind)
        segmenter = Segmenter(model, settings, (full, height))
        beta = segmenter.beta_steps
        for frame in sequence.frames:
            differences = segmenter.segment(frame.yuyv).differences
            assert differences is not None
            fields.append(differences.astype(np.int32))
    return fields, beta


def _compared(
    name: str,
    fields: list[Field],
    beta: int,
    minimum: Callable[[Field, int], NDArray[np.uint8]],
) -> list[Row]:
    """Solvers on the same fields in turns; fields of several sizes are all right."""
    optima = {shape: Optimum(*shape) for shape in {field.shape for field in fields}}
    labels = {shape: np.zeros(shape, dtype=np.uint8) for shape in optima}
    ours, theirs, icm = [0] * len(fields), [0] * len(fields), [0] * len(fields)
    history = np.zeros(SWEEPS_MAX + 1, dtype=np.int64)

    def exact(n: int) -> None:
        ours[n] = optima[fields[n].shape].minimise(fields[n], beta, labels[fields[n].shape])

    def referee(n: int) -> None:
        theirs[n] = int(field_energy(fields[n], minimum(fields[n], beta), beta))

    def raster(n: int) -> None:
        out = labels[fields[n].shape]
        label_by_singletons(fields[n], out)
        sweeps = descend(fields[n], out, beta, 1, history)
        icm[n] = int(history[sweeps])

    work = {OURS: exact, ICM: raster, REFEREE: referee}
    times = {t.name: t.median_ms for t in interleaved(work, OURS, len(fields))}
    energies = {OURS: ours, ICM: icm}
    rows: list[Row] = []
    for solver, ms in times.items():
        equal = None
        if solver in energies:
            hits = sum(a == b for a, b in zip(energies[solver], theirs, strict=True))
            equal = f"{hits} of {len(fields)}"
        row_name = f"{solver}, {name}"
        rows.append((row_name, len(fields), equal, ms, ms / times[ICM], ms / times[REFEREE]))
    return rows

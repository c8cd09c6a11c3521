"""Fit the weights of `naod.finding.presence`: `python -m naod.finding.calibration`, by hand.

Rooms are rendered, some without the object, some with other things of its colour. Every group of
regions in a picture is a sample: it is the object, or it is not. Two rounds: the second one counts
most what the first would have chosen. The rooms of `UNSEEN` are only to tell how well it went.
What counts where no shape is known is kept: rooms full of things of nearly the object's colour are
not like the pictures that people choose.
"""

from __future__ import annotations

import argparse
import tempfile
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from naod.files import write_whole
from naod.finding.find import Expected, Scored, scored_groups
from naod.finding.hue import Colours
from naod.finding.learnt import THINGS, Learnt
from naod.finding.presence import CASES, TERMS, WEIGHTS, fitted_weights, terms
from naod.finding.regions import cores_of, regions_of
from naod.finding.regression import fit_logistic, sigmoid
from naod.finding.rooms import Room, RoomSpec, View
from naod.perception.learning import DEFAULT_KIND, ModelKind
from naod.perception.segmenter import Segmentation

Floats = NDArray[np.float64]

LEARN, UNSEEN = range(100, 190), range(300, 336)
VIEWS = 10
SHOWN_SEEDS = (0, 1)
"""Rooms in which the colours are learnt, in turn."""

LIGHTS = (0.6, 0.8, 1.0, 1.3, 1.5)
OTHERS = (0, 0, 0, 1, 2, 3)
NEAR = (0, 1, 2, 3)
WALLS = ("clutter", "clutter", "picture", "plain")
TINT_STD = 0.05
"""Of the logarithm of red and blue light against green."""

CONTRAST_STD = 0.05
"""Of the logarithm of a camera's exponent: exposure and gain bend its curve."""

IS_IT, IS_NOT = 0.6, 0.4
"""Overlap of hulls above which a group is the object, and below which it is not."""

MIDDLE, GLIMPSE, WITHIN = 0.3, 0.05, 0.9
"""So much overlap is enough of a group that lies within the object, as blur leaves its middle; with
less, or in pieces beside a ribbon, it is a matter of taste, down to a glimpse."""

AGAINST = 0.3
"""How much a group counts that would not have been chosen."""

HEADER = """# Log-odds that a group of regions is the object; see naod/finding/presence.py.
# Made by `python -m naod.finding.calibration`.
"""

ALIKE = 0.5
"""How much a whole region counts in a room with other things of the object's very colour: many of
them say nothing of colours."""

MISTAKEN = 2.0
"""How much a thing of another colour counts whose shape is known not to be the object's."""

CUT_ALIKE = 1.5
"""How much one of its very colour counts on the picture's border: the object is there less often
than here, for the head is turned towards it."""

DEFAULT_COUNT = 3.0
"""How much the kind of model counts that is learnt unless another is asked for."""

AGAINST_IT = ("ring", "lack", "gap", "aspect", "turn", "pale", "hue", "tone", "washed")
SIGNS = {"colour": 1} | dict.fromkeys(AGAINST_IT, -1)
KNOWN = ("whole", "cut")
"""Cases that are fitted: those of an object whose shape is known."""


@dataclass(frozen=True, slots=True)
class Sample:
    """A group of regions. `picture` tells those of one picture; `overlap` is that of hulls.

    `within`: share of the group's hull that is in the object's. `alike`: other things of the
    object's colour stand in the room. `banded`: a ribbon parts the object's colour. `default`: the
    model is of the kind that is learnt unless another is asked for.
    """

    picture: int
    case: str
    row: Floats
    offset: float
    overlap: float
    within: float
    alike: bool
    banded: bool
    default: bool

    @property
    def told(self) -> bool | None:
        """Whether it is the object; None if that is a matter of taste."""
        inside = self.within > WITHIN
        if self.overlap > (MIDDLE if inside and not self.banded else IS_IT):
            return True
        return False if self.overlap < (GLIMPSE if inside else IS_NOT) else None


def specs(seeds: Sequence[int]) -> list[RoomSpec]:
    """One room for each seed: things in turn, every other three of them without the object."""
    made = []
    for n, seed in enumerate(seeds):
        rng = np.random.default_rng([seed, 3])
        thing = THINGS[n % len(THINGS)]
        made.append(
            RoomSpec(
                seed=seed,
                thing=thing,
                present=n // len(THINGS) % 2 == 0,
                others=int(rng.choice(OTHERS)),
                floor=thing != "board" and bool(rng.random() < 0.4),
                light=float(rng.choice(LIGHTS)),
                near=int(rng.choice(NEAR)),
                walls=str(rng.choice(WALLS)),
                tint=(TINT_STD * float(rng.normal()), TINT_STD * float(rng.normal())),
                contrast=CONTRAST_STD * float(rng.normal()),
            )
        )
    return made


def samples_of(room: Room, views: Sequence[View], learnt: Learnt, first: int) -> Iterator[Sample]:
    """Every group in every view, with and without its hue and tone; pictures count from `first`."""
    for number, view in enumerate(views):
        for eye in learnt.eyes[room.spec.thing]:
            segmentation = eye.segmenter.segment(view.yuyv)
            truth = None if view.mask is None else _hull(_reduced(view.mask, segmentation.scale))
            # the loop knows the blur while it turns its head, not always
            blur_px = view.blur_px if number % 2 else 0.0
            colours = Colours(view.yuyv, eye.model)
            known = Expected(room.shape, room.camera, None, blur_px, colours)
            blind = Expected(room.shape, room.camera, None, blur_px)
            for expected in (known, blind):
                first += 1
                for found in _scored(segmentation, expected, learnt.settings.pixels_min):
                    yield from _samples(found, truth, first, room.spec, eye.kind)


def _scored(segmentation: Segmentation, expected: Expected, pixels_min: int) -> Iterator[Scored]:
    regions = regions_of(segmentation)
    for looked_at in (regions, cores_of(regions)) if expected.shape else (regions,):
        found = scored_groups(segmentation, looked_at, expected, pixels_min)
        if found is not None:
            yield found


def _samples(
    found: Scored, truth: NDArray[np.bool_] | None, picture: int, spec: RoomSpec, kind: ModelKind
) -> Iterator[Sample]:
    rows = terms(found.measures)
    for k in range(len(rows)):
        overlap = within = 0.0
        if truth is not None:
            own = _hull(found.wanted(k)[found.regions.labels])
            shared = np.count_nonzero(own & truth)
            overlap = shared / np.count_nonzero(own | truth)
            within = shared / np.count_nonzero(own)
        case = "cut" if found.cuts[k] else "whole"
        offset = float(found.offsets[k])
        kinds = (spec.others > 0, spec.thing == "ribbon", kind == DEFAULT_KIND)
        yield Sample(picture, case, rows[k], offset, overlap, within, *kinds)


def fitted(samples: Sequence[Sample]) -> dict[str, Floats]:
    """Weights (len(TERMS),) of each case; those of `KNOWN` are fitted."""
    first = {case: _fit(samples, case, None) for case in KNOWN}
    chosen = {id(sample) for sample in chosen_of(samples, first)}
    return fitted_weights() | {case: _fit(samples, case, chosen) for case in KNOWN}


def chosen_of(samples: Sequence[Sample], weights: dict[str, Floats]) -> list[Sample]:
    """The likeliest group of each picture."""
    best: dict[int, tuple[float, Sample]] = {}
    for sample in samples:
        odds = float(sample.row @ weights[sample.case]) + sample.offset
        if sample.picture not in best or odds > best[sample.picture][0]:
            best[sample.picture] = (odds, sample)
    return [sample for _, sample in best.values()]


def _fit(samples: Sequence[Sample], case: str, chosen: set[int] | None) -> Floats:
    """Weights of a case; before anything was chosen, objects and the rest count alike."""
    kept = [s for s in samples if s.case == case and s.told is not None]
    told = np.array([float(bool(s.told)) for s in kept])
    if chosen is None:
        counts = np.where(told > 0.0, 0.5 / max(told.sum(), 1.0), 0.5 / max((1 - told).sum(), 1.0))
        counts *= len(kept)
    else:
        counts = np.array([1.0 if s.told or id(s) in chosen else AGAINST for s in kept])
    counts *= [_importance(s) for s in kept]
    signs = np.array([SIGNS.get(name, 0) for name in TERMS], dtype=np.float64)
    rows = np.array([s.row for s in kept])
    return fit_logistic(rows, told, counts, signs)


def _importance(sample: Sample) -> float:
    count = DEFAULT_COUNT if sample.default else 1.0
    if sample.alike and sample.case == "whole":
        return ALIKE * count
    if sample.told:
        return count
    return count * (CUT_ALIKE if sample.alike else MISTAKEN)


def reliability(samples: Sequence[Sample], weights: dict[str, Floats]) -> tuple[float, Floats]:
    """Brier score of what is chosen, and a table (5, 3): said, true, and how many, by fifths."""
    chosen = [s for s in chosen_of(samples, weights) if s.told is not None]
    odds = np.array([float(s.row @ weights[s.case]) + s.offset for s in chosen])
    said, true = sigmoid(odds), np.array([float(bool(s.told)) for s in chosen])
    table = np.zeros((5, 3))
    for n in range(5):
        inside = np.minimum((said * 5).astype(np.int64), 4) == n
        if inside.any():
            table[n] = said[inside].mean(), true[inside].mean(), np.count_nonzero(inside)
    return float(np.mean((said - true) ** 2)), table


def _reduced(mask: NDArray[np.uint8], scale: float) -> NDArray[np.bool_]:
    block = round(scale)
    height, width = mask.shape[0] // block, mask.shape[1] // block
    blocks = mask[: height * block, : width * block].reshape(height, block, width, block)
    return np.asarray(blocks.mean(axis=(1, 3)) > 127.0)


def _hull(inside: NDArray[np.bool_]) -> NDArray[np.bool_]:
    filled = np.zeros(inside.shape, dtype=np.uint8)
    points = np.argwhere(inside)[:, ::-1].astype(np.int32)
    if len(points):
        cv2.fillConvexPoly(filled, cv2.convexHull(points), 1)
    return filled > 0


def gathered(seeds: Sequence[int], views: int, folder: Path) -> list[Sample]:
    """Samples of the rooms of these seeds, all colours learnt in one other room."""
    learnt = [Learnt(folder, seed) for seed in SHOWN_SEEDS]
    samples: list[Sample] = []
    for n, spec in enumerate(specs(seeds)):
        room = Room(spec, folder)
        shown = learnt[n // 2 % len(learnt)]
        samples += samples_of(room, list(room.views(views)), shown, 1000 * n)
    return samples


def main() -> None:
    """Fit, write the weights, tell how well they do in rooms not used."""
    argparse.ArgumentParser(description=__doc__).parse_args()
    with tempfile.TemporaryDirectory() as folder:
        weights = fitted(gathered(LEARN, VIEWS, Path(folder)))
        unseen = gathered(UNSEEN, VIEWS, Path(folder))
    rounded = {case: np.round(weights[case], 3) for case in CASES}
    write_whole(WEIGHTS, HEADER + text_of(rounded))
    brier, table = reliability(unseen, rounded)
    print(f"Brier score in unseen rooms: {brier:.3f}")
    for said, true, count in table:
        print(f"said {said:.2f}, true {true:.2f}, {count:.0f} pictures")


def text_of(weights: dict[str, Floats]) -> str:
    """`weights.toml` without its heading."""
    lines = []
    for case, values in weights.items():
        named = zip(TERMS, values.tolist(), strict=True)
        lines += ["", f"[{case}]", *(f"{name} = {value}" for name, value in named)]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()

"""Segmentation without a learnt colour: classes and labels estimated together (P6).

Each class is a Gaussian, in equation 3 with as many labels as classes; parameters are estimated
again from the labels after every round, and beta grows over the rounds from nothing to its value
(Deng and Clausi 2004), so that colours decide first and neighbours tidy up later.
"""

from __future__ import annotations

from dataclasses import dataclass

import msgspec
import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.colour_model import STD_FLOOR, ColourModel, Component, model_of
from naod.perception.mixture import fit, log_density

Floats = NDArray[np.float64]


class UnsupervisedSettings(msgspec.Struct, frozen=True):
    """`beta` in nat, reached after `rounds`; `halved_after`: rounds until it is at a half.

    `samples_max`: pixels that the classes are begun from. `sweeps`: of iterated conditional modes
    in each round.
    """

    beta: float = 2.0
    rounds: int = 12
    halved_after: float = 3.0
    sweeps: int = 4
    samples_max: int = 1500


@dataclass(frozen=True, slots=True)
class Classes:
    """What a picture falls into: `labels` (h, w) uint8, the class of each pixel, largest first.

    `models`: the colour of each. `energy`: equation 3's with the final beta, in nat. `betas`:
    of each round. `changed`: share of pixels that changed their class in each round.
    """

    labels: NDArray[np.uint8]
    models: tuple[ColourModel, ...]
    energy: float
    betas: tuple[float, ...]
    changed: tuple[float, ...]


def classes_of(
    picture: NDArray[np.float32], count: int, settings: UnsupervisedSettings | None = None
) -> Classes:
    """At most `count` classes of a picture (h, w, 3) Y U V, 8-bit levels. ValueError below 1.

    A class that no pixel wants any more is left out.
    """
    if not 1 <= count <= 255:
        raise ValueError(f"{count} classes: want 1 to 255")
    settings = settings or UnsupervisedSettings()
    shape = picture.shape[:2]
    pixels = picture.reshape(-1, 3).astype(np.float64)
    classes = fit(pixels[:: max(1, len(pixels) // settings.samples_max)], count)[0]
    labels = np.argmin(_energies(pixels, classes), axis=1).astype(np.uint8).reshape(shape)
    betas, changed = [], []
    for n in range(settings.rounds):
        beta = _grown(settings, n)
        classes, labels = _estimated(pixels, labels)
        before = labels.copy()
        energies = _energies(pixels, classes).astype(np.float32).reshape(*shape, len(classes))
        _descend(energies, labels, np.float32(beta), settings.sweeps)
        betas.append(beta)
        changed.append(float(np.mean(labels != before)))
    classes, labels = _estimated(pixels, labels)
    singles = np.take_along_axis(_energies(pixels, classes), labels.reshape(-1, 1), axis=1)
    broken = np.count_nonzero(labels[1:] != labels[:-1])
    broken += np.count_nonzero(labels[:, 1:] != labels[:, :-1])
    models = tuple(model_of(np.array(one.mean), np.array(one.covariance)) for one in classes)
    energy = float(singles.sum()) + settings.beta * broken
    return Classes(labels, models, energy, tuple(betas), tuple(changed))


def _grown(settings: UnsupervisedSettings, n: int) -> float:
    """Beta of round n: from 0 at the first to its value at the last."""
    last = settings.rounds - 1
    if n == last:
        return settings.beta
    scale = 1.0 - 0.5 ** (last / settings.halved_after)
    return float(settings.beta * (1.0 - 0.5 ** (n / settings.halved_after)) / scale)


def _energies(pixels: Floats, classes: tuple[Component, ...]) -> Floats:
    """(n, classes) ln g + k / 2 of each pixel (n, 3) in each class: equation 3, no weights."""
    flat = [Component(1.0, one.mean, one.covariance) for one in classes]
    return np.stack([-log_density(pixels, one) for one in flat], axis=1)


def _estimated(
    pixels: Floats, labels: NDArray[np.uint8]
) -> tuple[tuple[Component, ...], NDArray[np.uint8]]:
    """Mean and covariance of what carries each label, and the labels named anew, largest first."""
    counts = np.bincount(labels.ravel())
    order = [int(k) for k in np.argsort(-counts, kind="stable") if counts[k] > 0]
    names = np.zeros(len(counts), dtype=np.uint8)
    classes = []
    for name, k in enumerate(order):
        names[k] = name
        own = pixels[labels.ravel() == k]
        offsets = own - own.mean(axis=0)
        values, vectors = np.linalg.eigh(offsets.T @ offsets / len(own))
        floored = (vectors * np.maximum(values, STD_FLOOR**2)) @ vectors.T
        model = model_of(own.mean(axis=0), floored)
        classes.append(Component(len(own) / len(pixels), model.mean, model.covariance))
    return tuple(classes), names[labels]


@njit(cache=True, nogil=True)
def _descend(
    energies: NDArray[np.float32], labels: NDArray[np.uint8], beta: np.float32, sweeps: int
) -> None:
    """Iterated conditional modes: each pixel the class of least energy given its neighbours."""
    height, width, count = energies.shape
    for _ in range(sweeps):
        changed = False
        for i in range(height):
            for j in range(width):
                best, least = labels[i, j], np.float32(np.inf)
                for k in range(count):
                    energy = energies[i, j, k]
                    if i > 0 and labels[i - 1, j] != k:
                        energy += beta
                    if i + 1 < height and labels[i + 1, j] != k:
                        energy += beta
                    if j > 0 and labels[i, j - 1] != k:
                        energy += beta
                    if j + 1 < width and labels[i, j + 1] != k:
                        energy += beta
                    if energy < least:
                        best, least = np.uint8(k), energy
                changed |= best != labels[i, j]
                labels[i, j] = best
        if not changed:
            return

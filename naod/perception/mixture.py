"""The object's colours as a mixture of Gaussians in YUV, as many as the data ask for."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numba import njit
from numpy.typing import NDArray

from naod.perception.colour_model import (
    STD_FLOOR,
    ColourMixture,
    ColourModel,
    Component,
    Region,
    learn,
    model_of,
    region_pixels,
)

Floats = NDArray[np.float64]

COMPONENTS_MAX = 6
SAMPLES_MAX = 1500
"""Pixels that a mixture is fitted to, evenly spread over the frames' regions."""
PIXELS_PER_SAMPLE = 4.0
"""Neighbouring pixels say the same (chroma is shared by two, demosaicing spreads three): so many
count as one when components are weighed against data."""
ROUNDS, SETTLED = 40, 1e-4
NEGLIGIBLE = -40.0
"""Logarithm of a share of the density that no float of it would show."""
PARAMETERS = 10
"""Of one component: weight, mean, covariance."""


def learn_mixture(frames: Sequence[NDArray[np.uint8]], region: Region) -> ColourMixture:
    """The colours inside `region` of every frame, YUYV (H, W, 2) uint8.

    The number of components is the one of least Bayesian information criterion (Schwarz 1978).
    Raises InputError as `naod.perception.colour_model.learn` does.
    """
    whole = learn(frames, region)
    pixels = np.concatenate([region_pixels(frame, region) for frame in frames])
    pixels = pixels[:: max(1, len(pixels) // SAMPLES_MAX)].astype(np.float64)
    best, best_score = None, math.inf
    for count in range(1, COMPONENTS_MAX + 1):
        fitted, likelihood = fit(pixels, count)
        samples = len(pixels) / PIXELS_PER_SAMPLE
        score = -2.0 * likelihood * samples + PARAMETERS * count * math.log(samples)
        if score >= best_score:
            break
        best, best_score = fitted, score
    assert best is not None
    return ColourMixture(mean=whole.mean, covariance=whole.covariance, components=best)


def fit(pixels: Floats, count: int) -> tuple[tuple[Component, ...], float]:
    """`count` components of pixels (n, 3) by expectation maximisation, and nat per pixel.

    Begins from pixels each as far as can be from those before it. Components that die out are
    left out. Covariances have eigenvalues of at least STD_FLOOR squared.
    """
    far = ((pixels - pixels.mean(axis=0)) ** 2).sum(axis=1)
    distances = np.full(len(pixels), np.inf)
    seeds = []
    place = int(np.argmin(far))
    for _ in range(count):
        seeds.append(pixels[place])
        distances = np.minimum(distances, ((pixels - pixels[place]) ** 2).sum(axis=1))
        place = int(np.argmax(distances))
    nearest = np.argmin([((pixels - seed) ** 2).sum(axis=1) for seed in seeds], axis=0)
    shares = np.eye(count)[nearest]
    before = -math.inf
    for _ in range(ROUNDS):
        components = _estimated(pixels, shares)
        logs = np.stack([log_density(pixels, one) for one in components], axis=1)
        total = np.logaddexp.reduce(logs, axis=1)
        shares = np.exp(logs - total[:, None])
        now = float(total.mean())
        if now - before < SETTLED:
            break
        before = now
    return components, now


def log_density(colours: Floats, component: Component, light_std: float = 0.0) -> Floats:
    """ln of weight times density at colours (..., 3); widened along its line of shades."""
    mean, precision, log_peak = _widened(component, light_std)
    offsets = colours - mean
    k = np.einsum("...i,ij,...j->...", offsets, precision, offsets)
    return np.asarray(log_peak - 0.5 * k)


def energies(mixture: ColourMixture, colours: Floats, light_std: float) -> Floats:
    """-ln p of colours (..., 3), in nat: what equation 3's ln g + k / 2 is for one Gaussian."""
    rows = np.array([_coefficients(one, light_std) for one in mixture.components])
    flat = np.ascontiguousarray(colours, dtype=np.float64).reshape(-1, 3)
    out = np.empty(len(flat))
    _energies(flat, rows, np.empty(len(rows)), out)
    return out.reshape(colours.shape[:-1])


def _widened(component: Component, light_std: float) -> tuple[Floats, Floats, float]:
    """Mean (3,), precision (3, 3), and ln of weight times density at the mean."""
    mean = np.array(component.mean)
    shades = light_std * (mean - (0.0, 128.0, 128.0))
    covariance = np.array(component.covariance) + np.outer(shades, shades)
    log_g = 0.5 * (3.0 * math.log(2.0 * math.pi) + float(np.linalg.slogdet(covariance)[1]))
    return mean, np.linalg.inv(covariance), math.log(component.weight) - log_g


def _coefficients(component: Component, light_std: float) -> Floats:
    """(10,) of the polynomial in Y, U, V that `log_density` is: squares, products, Y, U, V, 1."""
    mean, P, log_peak = _widened(component, light_std)
    slope = P @ mean
    squares, products = -0.5 * np.diag(P), -np.array([P[0, 1], P[0, 2], P[1, 2]])
    return np.concatenate([squares, products, slope, [log_peak - 0.5 * mean @ slope]])


@njit(cache=True, nogil=True)
def _energies(colours: Floats, rows: Floats, logs: Floats, out: Floats) -> None:
    """-ln p of colours (n, 3) from coefficients (m, 10); `logs` (m,) is scratch."""
    for i in range(len(colours)):
        y, u, v = colours[i]
        best = -np.inf
        for k in range(len(rows)):
            a = rows[k]
            in_y = y * (a[0] * y + a[3] * u + a[4] * v + a[6])
            in_u = u * (a[1] * u + a[5] * v + a[7])
            logs[k] = in_y + in_u + v * (a[2] * v + a[8]) + a[9]
            best = max(best, logs[k])
        total = 0.0
        for k in range(len(rows)):
            if logs[k] - best > NEGLIGIBLE:
                total += math.exp(logs[k] - best)
        out[i] = -best - math.log(total)


def _estimated(pixels: Floats, shares: Floats) -> tuple[Component, ...]:
    """Components from how much of each pixel (n, 3) belongs to each, (n, count)."""
    found = []
    for belonging in shares.T:
        weight = float(belonging.mean())
        if weight * len(pixels) < 1.0:
            continue
        mean = belonging @ pixels / belonging.sum()
        offsets = pixels - mean
        covariance = (belonging[:, None] * offsets).T @ offsets / belonging.sum()
        values, vectors = np.linalg.eigh(covariance)
        floored = (vectors * np.maximum(values, STD_FLOOR**2)) @ vectors.T
        model: ColourModel = model_of(mean, floored)
        found.append(Component(weight, model.mean, model.covariance))
    whole = sum(one.weight for one in found)
    return tuple(Component(one.weight / whole, one.mean, one.covariance) for one in found)

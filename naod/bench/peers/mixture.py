"""Gaussian mixtures fitted by EM (scikit-learn), one for the object and one for all the rest."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from sklearn.mixture import GaussianMixture
from threadpoolctl import threadpool_limits

from naod.bench.peers.hsv import cut
from naod.bench.peers.peer import STILL, Motion, Seen
from naod.bench.peers.pictures import box_of
from naod.bench.peers.reduced import Reduced
from naod.perception.colour_model import Region

OBJECT_COMPONENTS, REST_COMPONENTS = 2, 3
RIDGE = 9.0
"""Added to variances, 8-bit levels squared: the sensor's noise."""

SEED = 1
CLEAR_SHARE = 0.5
"""Of the region's sides, left out around it when the rest is learnt."""


class Mixture:
    """A pixel is what its colour is likelier under, times how often each was seen."""

    def __init__(self, size: tuple[int, int]) -> None:
        self._reduced = Reduced(size)
        self._object, self._rest = _mixture(OBJECT_COMPONENTS), _mixture(REST_COMPONENTS)
        self._threshold = 0.0

    def learn(self, yuyv: NDArray[np.uint8], region: Region) -> None:
        """EM on the region's pixels and on those well outside."""
        picture, small = self._reduced(yuyv), self._reduced.region(region)
        inside = cut(picture, small).reshape(-1, 3)
        clear = np.ones(picture.shape[:2], dtype=np.bool_)
        dx, dy = round(CLEAR_SHARE * small.width), round(CLEAR_SHARE * small.height)
        top, left = max(small.y - dy, 0), max(small.x - dx, 0)
        clear[top : small.y + small.height + dy, left : small.x + small.width + dx] = False
        outside = picture[clear]
        with threadpool_limits(1):
            self._object.fit(inside)
            self._rest.fit(outside)
        self._threshold = float(np.log(len(outside) / len(inside)))

    def segment(self, yuyv: NDArray[np.uint8], _motion_px: Motion = STILL) -> Seen:
        """Likelihoods of every pixel, box."""
        picture = self._reduced(yuyv)
        pixels = picture.reshape(-1, 3)
        with threadpool_limits(1):
            ratio = self._object.score_samples(pixels) - self._rest.score_samples(pixels)
        mask = (ratio > self._threshold).reshape(picture.shape[:2]).astype(np.uint8)
        return box_of(mask, float(self._reduced.block))


def _mixture(components: int) -> GaussianMixture:
    return GaussianMixture(components, reg_covar=RIDGE, random_state=SEED)


def make(size: tuple[int, int]) -> Mixture:
    """For pictures of that size."""
    return Mixture(size)

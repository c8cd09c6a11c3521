"""Textures in linear light with their pyramids; floor tiles and wood are drawn here."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from hal.errors import ScenarioError
from sim_backend.colour import linear_from_srgb

SIDE_MAX = 1024
Picture = NDArray[np.float32]


def load_texture(path: Path, key: str) -> Picture:
    """A picture file in linear light, (h, w, 3) float32. Raises ScenarioError that names `key`."""
    if not path.is_file():
        raise ScenarioError(f"{key}: no such picture: {path}")
    bgr = cv2.imread(str(path), cv2.IMREAD_COLOR)
    if bgr is None:
        raise ScenarioError(f"{key}: not a readable picture: {path}")
    scale = SIDE_MAX / max(bgr.shape[:2])
    if scale < 1.0:
        size = (max(1, round(bgr.shape[1] * scale)), max(1, round(bgr.shape[0] * scale)))
        bgr = cv2.resize(bgr, size, interpolation=cv2.INTER_AREA)
    rgb = np.asarray(bgr[..., ::-1], dtype=np.uint8)
    return linear_from_srgb(rgb).astype(np.float32)


@cache
def floor_tiles() -> Picture:
    """Four by four grey tiles with joints, a little different from each other, (512, 512, 3)."""
    rng = np.random.default_rng(11)
    picture = np.empty((512, 512, 3))
    for row in range(4):
        for column in range(4):
            level = 158.0 + rng.uniform(-6.0, 6.0)
            tone = level + rng.uniform(-2.0, 2.0, 3) + (3.0, 0.0, -5.0)
            tile = (
                tone
                + cv2.GaussianBlur(rng.normal(0.0, 12.0, (128, 128, 1)), (0, 0), 3.0)[..., None]
            )
            tile[:2], tile[-2:], tile[:, :2], tile[:, -2:] = (118.0,) * 4
            picture[row * 128 : row * 128 + 128, column * 128 : column * 128 + 128] = tile
    return linear_from_srgb(np.clip(picture, 0, 255)).astype(np.float32)


@cache
def wood() -> Picture:
    """Boards with a grain along u, (512, 512, 3)."""
    rng = np.random.default_rng(12)
    grain = cv2.GaussianBlur(rng.normal(0.0, 1.0, (512, 512)), (0, 0), sigmaX=40.0, sigmaY=1.2)
    broad = cv2.GaussianBlur(rng.normal(0.0, 1.0, (512, 512)), (0, 0), sigmaX=90.0, sigmaY=8.0)
    tone = grain / grain.std() * 7.0 + broad / broad.std() * 6.0
    picture = np.array([176.0, 138.0, 96.0]) + tone[..., None] * (1.0, 0.9, 0.75)
    for board in range(4):
        rows = slice(board * 128, board * 128 + 128)
        picture[rows] += rng.uniform(-7.0, 7.0)
        picture[board * 128 : board * 128 + 2] *= 0.72
    return linear_from_srgb(np.clip(picture, 0, 255)).astype(np.float32)


def pyramid(picture: Picture) -> list[Picture]:
    """The picture and its halves, down to a few texels."""
    levels = [picture]
    while min(levels[-1].shape[:2]) > 4:
        h, w = levels[-1].shape[:2]
        half = cv2.resize(
            levels[-1], (max(1, w // 2), max(1, h // 2)), interpolation=cv2.INTER_AREA
        )
        levels.append(np.asarray(half, dtype=np.float32))
    return levels


@dataclass(slots=True)
class TextureStore:
    """All textures of a scene in one array of texels."""

    _levels: list[Picture] = field(default_factory=list)
    _first: list[int] = field(default_factory=list)
    _known: dict[int, int] = field(default_factory=dict)
    _kept: list[Picture] = field(default_factory=list)

    def add(self, picture: Picture) -> int:
        """Number of a texture, added once however often it is used."""
        key = id(picture)
        if key not in self._known:
            self._known[key] = len(self._first)
            self._kept.append(picture)
            self._first.append(len(self._levels))
            self._levels.extend(pyramid(picture))
        return self._known[key]

    def width_of(self, texture: int) -> int:
        """Texels across the finest level."""
        return int(self._levels[self._first[texture]].shape[1])

    def pyramids(self) -> NDArray[np.int64]:
        """First level and number of levels of each texture, (n, 2)."""
        ends = [*self._first, len(self._levels)][1:]
        pairs = [(a, b - a) for a, b in zip(self._first, ends, strict=True)]
        return np.array(pairs, dtype=np.int64).reshape(-1, 2)

    def levels(self) -> NDArray[np.int64]:
        """First texel, width and height of every level, (n, 3)."""
        sizes = [level.shape[:2] for level in self._levels]
        starts = np.cumsum([0] + [h * w for h, w in sizes])
        rows = [(start, w, h) for start, (h, w) in zip(starts[:-1], sizes, strict=True)]
        return np.array(rows, dtype=np.int64).reshape(-1, 3)

    def texels(self) -> Picture:
        """All levels in a row, (n, 3) float32."""
        rows = [level.reshape(-1, 3) for level in self._levels]
        return np.concatenate(rows) if rows else np.zeros((0, 3), dtype=np.float32)

"""The arrays the ray caster's kernels read, and its fixed sampling pattern.

The kernels take plain arrays: tuples of many arrays are copied at every call inside a kernel.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

TILE = 16
SAMPLES = 16
"""Samples of a pixel at most: a 4 x 4 grid in space, 16 equal parts of the exposure in time."""

RECTANGLE, BOX, CYLINDER, SPHERE, CAPSULE = range(5)

F64 = NDArray[np.float64]
I64 = NDArray[np.int64]

# columns of the table of primitives; a, b, c are sizes as in raycast_shapes, u and v how often a
# texture is repeated, the light is the direction to it in the primitive's own frame
KIND, A, B, C, RED, GREEN, BLUE, TEXTURE, U, V, TEXELS_PER_M, CASTS = range(12)
NEAR, LIGHT_X, LIGHT_Y, LIGHT_Z, BRIGHT, AMBIENT_SHARE = range(12, 18)
COLUMNS = 18


@dataclass(frozen=True, slots=True, eq=False)
class SceneArrays:
    """What there is. Colours in linear light, 0 to 1.

    `table` (P, 18): a row for each primitive; the columns from `NEAR` on are filled for a view.
    Texture n has its pyramid in the rows `pyramids[n, 0]` on (`pyramids[n, 1]` of them) of `levels`
    (first texel, width, height); `texels` (N, 3) float32.
    """

    table: F64
    texels: NDArray[np.float32]
    pyramids: I64
    levels: I64


@dataclass(frozen=True, slots=True, eq=False)
class ViewArrays:
    """How a camera sees it. K moments of the exposure.

    `rays` (K, P, 12): in primitive p's frame the ray through pixel (x, y) is o + t d with
    d = rays[:9] (3, 3) @ (x, y, 1), o = rays[9:]; t is the depth in the camera. `table` as in the
    scene, complete. Tile n's primitives, nearest first, are `items[starts[n]:starts[n + 1]]`.
    """

    rays: F64
    table: F64
    items: I64
    starts: I64


# multiplication by 2 and by 3 in the field of four elements, whose addition is exclusive or
_TWICE, _THRICE = (0, 2, 3, 1), (0, 3, 1, 2)


def _pattern() -> tuple[F64, I64]:
    """Places in the pixel (16, 2) and parts of the exposure (16,) of the samples.

    A pair of orthogonal Latin squares: every row, and every column, of the pixel is looked at once
    in every quarter of the exposure, so that an edge along the motion is covered as well as one
    across it. The first four hit every row, column and quarter, and the first and the last part.
    """
    places, parts = np.empty((SAMPLES, 2)), np.empty(SAMPLES, dtype=np.int64)
    for sample in range(SAMPLES):
        turn, row = divmod(sample, 4)
        column, fine = _TWICE[row] ^ turn, _THRICE[row]
        places[sample] = ((column - 1.5) / 4.0, (row - 1.5) / 4.0)
        parts[sample] = 4 * (fine ^ turn) + fine
    return places, parts


PLACES, PARTS = _pattern()

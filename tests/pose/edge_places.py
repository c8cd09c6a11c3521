"""Places evenly along a true outline."""

import numpy as np
from raster import CAMERA

from naod.pose.contour import outline_px


def edge_places(shape, T, count=240):
    """Places evenly along the outline in pixels, and the normals outwards."""
    corners = outline_px(shape, T, CAMERA)
    chords = np.diff(corners, axis=0)
    lengths = np.linalg.norm(chords, axis=1)
    ends = np.cumsum(lengths)
    at = (np.arange(count) + 0.5) * ends[-1] / count
    piece = np.searchsorted(ends, at)
    along = chords[piece] / lengths[piece, None]
    places = corners[piece] + (at - ends[piece] + lengths[piece])[:, None] * along
    return places, np.column_stack([along[:, 1], -along[:, 0]])

"""Where the outer side of an edge is when something narrow stands before what is beyond."""

import numpy as np
import pytest
from test_edges import encoded

from naod.perception.profile import outer_side
from naod.perception.profile import profile as sampled

RED, ORANGE, GREY = (0.45, 0.01, 0.02), (0.85, 0.10, 0.01), (0.46, 0.46, 0.43)
STEP_PX, INSIDE_PX, FEW = 0.6, 12.0, 6


def yuv(light):
    r, g, b = np.moveaxis(encoded(light), -1, 0)
    y = 0.299 * r + 0.587 * g + 0.114 * b
    return np.stack([y, 128.0 + 0.564 * (b - y), 128.0 + 0.713 * (r - y)], axis=-1)


def profile(strip_px, blur_px, beyond=GREY, strip=ORANGE):
    """Red for INSIDE_PX, a strip for strip_px, then another, smeared, (n, 3); and places in px."""
    fine = np.arange(-INSIDE_PX, 24.0, 0.05)
    light = np.where(
        (fine < 0.0)[:, None], RED, np.where((fine < strip_px)[:, None], strip, beyond)
    )
    kernel = np.ones(round(blur_px / 0.05)) / round(blur_px / 0.05)
    padded = np.pad(light, ((kernel.size, kernel.size), (0, 0)), mode="edge")
    mixed = np.stack([np.convolve(padded[:, c], kernel, "same") for c in range(3)], axis=1)
    mixed = mixed[kernel.size : -kernel.size]
    at = np.arange(-INSIDE_PX, INSIDE_PX + 1e-9, STEP_PX)
    return np.stack([np.interp(at, fine, yuv(mixed)[:, c]) for c in range(3)], axis=1), at


@pytest.mark.parametrize("strip_px", [4.0, 6.0, 8.0])
@pytest.mark.parametrize("blur_px", [6.0, 8.0])
def test_a_strip_that_blur_leaves_no_plateau_of_is_the_outer_side(strip_px, blur_px):
    colours, at = profile(strip_px, blur_px)
    first = outer_side(colours, len(colours), FEW, colours[0])
    # all red is gone half a blur beyond the edge, all orange half a blur beyond the strip
    assert -0.1 < at[first] < strip_px + 0.5 * blur_px - 1.0


@pytest.mark.parametrize("beyond", [ORANGE, GREY])
def test_a_mixture_of_two_is_no_strip(beyond):
    colours, at = profile(0.0, 8.0, beyond)
    first = outer_side(colours, len(colours), FEW, colours[0])
    assert at[first] > 3.0


def bilinear(plane, x, y):
    """numpy's own, along one axis and then the other; beyond the plane its border goes on."""
    rows = [np.interp(x, np.arange(plane.shape[1]), row) for row in plane]
    return np.interp(y, np.arange(plane.shape[0]), rows)


@pytest.mark.parametrize("place", [(20.3, 15.7), (3.1, 2.2), (36.6, 27.9), (1.0, 15.0)])
def test_colours_along_a_normal_are_bilinear_inside_and_at_the_border(place):
    rng = np.random.default_rng(1)
    yuyv = rng.integers(0, 256, (30, 40, 2), dtype=np.uint8)
    luma, chroma = yuyv[..., 0].astype(float), yuyv[..., 1].astype(float)
    for angle in np.linspace(0.1, 6.2, 9):
        normal = np.array([np.cos(angle), np.sin(angle)])
        colours = np.empty((64, 3))
        count = sampled(yuyv, np.array(place), normal, 3.0, 0.5, 2.0, colours)
        assert count == 13
        for k in range(count):
            x, y = np.array(place) + max((k - 6) * 0.5, -2.0) * normal
            x, y = min(max(x, 0.0), 39.0), min(max(y, 0.0), 29.0)
            pair = 0.5 * (x - 0.5)
            expected = (
                bilinear(luma, x, y),
                bilinear(chroma[:, 0::2], pair, y),
                bilinear(chroma[:, 1::2], pair, y),
            )
            assert np.allclose(colours[k], expected)

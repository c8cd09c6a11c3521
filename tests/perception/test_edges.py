"""Edges of known place in pictures made as a camera makes them: light mixes, then is encoded."""

import numpy as np
import pytest

from hal.yuyv import yuyv_from_rgb
from naod.perception.edges import measure_edges
from naod.perception.encoding import LIGHT, level_of, light_of

YELLOW, WALL = (0.62, 0.43, 0.01), (0.46, 0.46, 0.43)
RED, WOOD, BLACK = (0.45, 0.01, 0.02), (0.38, 0.22, 0.10), (0.02, 0.02, 0.02)
SIZE, FINE = 48, 12


def encoded(light):
    low = 12.92 * light
    return 255.0 * np.where(
        light <= 0.0031308, low, 1.055 * np.maximum(light, 1e-9) ** (1 / 2.4) - 0.055
    )


def edge_picture(inside, outside, place, angle, mixing_px, noise, rng):
    """Object where x cos + y sin < place; light mixes over `mixing_px` and over each pixel."""
    at = (np.arange(SIZE * FINE) + 0.5) / FINE - 0.5
    x, y = np.meshgrid(at, at)
    gap = np.cos(angle) * x + np.sin(angle) * y - place
    share = np.clip(0.5 - gap / mixing_px, 0.0, 1.0)
    share = share.reshape(SIZE, FINE, SIZE, FINE).mean(axis=(1, 3))[..., None]
    light = share * np.array(inside) + (1.0 - share) * np.array(outside)
    yuyv = yuyv_from_rgb(np.clip(encoded(light), 0.0, 255.0)).astype(float)
    return np.clip(np.rint(yuyv + rng.normal(0.0, noise, yuyv.shape)), 0, 255).astype(np.uint8)


def errors(inside, outside, angle, mixing_px=0.7, noise=0.0, reach=5.0, seed=0):
    """Of edges measured from places up to a pixel off, in pixels, positive outwards."""
    rng = np.random.default_rng(seed)
    normal = np.array([np.cos(angle), np.sin(angle)])
    out = []
    for _ in range(12):
        place = 23.5 * normal.sum() + rng.uniform(-1.0, 1.0)
        picture = edge_picture(inside, outside, place, angle, mixing_px, noise, rng)
        places = 23.5 + np.outer(rng.uniform(-8.0, 8.0, 8), (-normal[1], normal[0]))
        edges = measure_edges(picture, places, np.tile(normal, (8, 1)), reach, 20.0)
        assert edges.seen.all()
        out.append(edges.offset_px - (place - places @ normal))
    return np.concatenate(out)


@pytest.mark.parametrize("angle", [0.0, 0.6, np.pi / 2, np.pi, 4.0])
@pytest.mark.parametrize(
    ("inside", "outside"), [(RED, WALL), (RED, WOOD), (BLACK, WALL), (WALL, BLACK), (YELLOW, WALL)]
)
def test_a_sharp_edge_is_placed_without_bias(inside, outside, angle):
    found = errors(inside, outside, angle)
    assert abs(found.mean()) < 0.06
    assert found.std() < 0.12


@pytest.mark.parametrize("mixing_px", [4.0, 8.0])
def test_blur_widens_an_edge_without_moving_it(mixing_px):
    found = errors(RED, WALL, 0.3, mixing_px, reach=10.0)
    assert abs(found.mean()) < 0.06


@pytest.mark.parametrize("mixing_px", [0.05, 0.4])
def test_a_long_sharp_edge_that_leans_a_little_is_not_taken_for_a_wide_one(mixing_px):
    """Few of its pixels tell how wide it is, and those that it seems wide to tell more."""
    means = []
    for seed in range(12):
        rng = np.random.default_rng(seed)
        angle = 0.02 + np.pi * (seed % 2)
        normal = np.array([np.cos(angle), np.sin(angle)])
        place = 23.5 * normal.sum() + rng.uniform(-1.0, 1.0)
        picture = edge_picture(RED, WALL, place, angle, mixing_px, 1.5, rng)
        places = 23.5 + np.outer(np.arange(-18.0, 19.0, 3.0), (-normal[1], normal[0]))
        edges = measure_edges(picture, places, np.tile(normal, (len(places), 1)), 5.0, 20.0)
        means.append((edges.offset_px - (place - places @ normal)).mean())
    assert np.abs(means).max() < 0.06


def test_noise_is_stated():
    found = errors(RED, WALL, 0.6, 2.0, noise=4.0)
    assert abs(found.mean()) < 0.06
    assert found.std() < 0.2


def test_no_contrast_no_edge_and_no_edge_beyond_the_picture():
    flat = np.full((SIZE, SIZE, 2), 128, np.uint8)
    places, normals = np.array([[20.0, 20.0]]), np.array([[1.0, 0.0]])
    assert not measure_edges(flat, places, normals, 5.0, 20.0).seen.any()
    at_border = measure_edges(flat, np.array([[45.0, 20.0]]), normals, 5.0, 20.0)
    assert not at_border.within.any()


def test_encoding_is_the_srgb_curve_both_ways():
    levels = np.arange(0.0, 255.0, 7.0)
    light = np.array([light_of(level) for level in levels])
    assert np.allclose(encoded(light), levels, atol=0.05)
    assert np.allclose([level_of(value) for value in LIGHT[:255]], np.arange(255), atol=0.3)


def test_where_an_edge_crosses_the_pixels_does_not_matter_to_its_place():
    rng, angle = np.random.default_rng(3), 0.06
    normal = np.array([np.cos(angle), np.sin(angle)])
    at = 23.5 * normal.sum()
    found = []
    for _ in range(6):
        place = at + rng.uniform(-1.0, 1.0)
        picture = edge_picture(YELLOW, WALL, place, angle, 0.3, 2.0, rng)
        places = 23.5 + np.outer(np.arange(-18.0, 19.0, 2.0), (-normal[1], normal[0]))
        edges = measure_edges(picture, places, np.tile(normal, (len(places), 1)), 5.0, 20.0)
        found.append(edges.offset_px - (place - places @ normal))
    # each by itself, those on the border of two pixels seem wider and a third of a pixel out
    assert np.abs(found).mean() < 0.06
    assert np.abs(np.mean(found)) < 0.03
    assert np.abs(found).max() < 0.25

"""Masks at full size."""

import numpy as np

from hal.yuyv import yuyv_from_rgb
from naod.config import SegmentationConfig
from naod.perception.colour_model import Region, learn
from naod.perception.fullsize import full_mask
from naod.perception.segmenter import Segmenter


def overlap(a, b):
    return np.logical_and(a, b).sum() / np.logical_or(a, b).sum()


def test_the_boundary_is_found_again_at_full_resolution():
    rng = np.random.default_rng(0)
    x, y = np.meshgrid(np.arange(640), np.arange(480))
    disc = np.hypot(x - 300.3, y - 220.7) < 61.0
    rgb = np.where(disc[..., None], (190.0, 30.0, 40.0), (150.0, 150.0, 140.0))
    yuyv = yuyv_from_rgb(np.clip(rgb + rng.normal(0, 4, rgb.shape), 0, 255))
    segmenter = Segmenter(learn([yuyv], Region(270, 190, 60, 60)), SegmentationConfig(), (640, 480))
    found = segmenter.segment(yuyv)
    coarse = np.kron(found.mask, np.ones((4, 4), np.uint8))
    fine = full_mask(segmenter, found, yuyv)
    assert fine.shape == (480, 640)
    assert overlap(fine, disc) > 0.98
    assert overlap(fine, disc) > overlap(coarse, disc)


def test_sizes_that_blocks_do_not_fill():
    rng = np.random.default_rng(1)
    yuyv = rng.integers(0, 256, (101, 334, 2), dtype=np.uint8)
    yuyv[20:80, 100:200] = (90, 140)
    model = learn([yuyv], Region(90, 10, 120, 80))
    segmenter = Segmenter(model, SegmentationConfig(), (334, 101))
    found = segmenter.segment(yuyv)
    assert found.mask.shape == (34, 112)
    assert full_mask(segmenter, found, yuyv).shape == (101, 334)

import base64
import subprocess
import sys
import zlib

import numpy as np
import pytest

from naod.config import SegmentationConfig
from naod.errors import InputError
from naod.perception.blob import find_blob
from naod.perception.blurring import cut_out, light_from_yuv, line_kernel, smeared, yuv_from_light
from naod.perception.colour_model import ColourTable, Region, learn, load_model, save_model
from naod.perception.colour_table import BINS, CELLS, UNSEEN, cells_of, packed, smoothed, unpacked
from naod.perception.colour_table_learning import learn_table, table_model
from naod.perception.energy import STEPS, Singletons
from naod.perception.fullsize import full_mask
from naod.perception.growing import grown, region_mask
from naod.perception.reduction import Reduction
from naod.perception.segmenter import Segmentation, Segmenter

SIZE = (320, 240)
OBJECT = Region(140, 90, 60, 80)
MARKED = Region(156, 110, 28, 40)
GREY, RED = (150, 128, 128), (80, 105, 205)


def painted(seed, patches=((OBJECT, RED),)):
    rng = np.random.default_rng(seed)
    yuv = np.full((SIZE[1], SIZE[0], 3), GREY, dtype=np.float64)
    for region, colour in patches:
        yuv[region.y : region.y + region.height, region.x : region.x + region.width] = colour
    yuv += rng.normal(0.0, 2.0, yuv.shape)
    yuyv = np.empty((SIZE[1], SIZE[0], 2), dtype=np.uint8)
    levels = np.clip(np.rint(yuv), 0, 255).astype(np.uint8)
    yuyv[..., 0] = levels[..., 0]
    yuyv[:, 0::2, 1], yuyv[:, 1::2, 1] = levels[:, 0::2, 1], levels[:, 0::2, 2]
    return yuyv


@pytest.fixture(scope="module")
def model():
    return learn_table([painted(n) for n in range(3)], MARKED)


def test_what_was_shown_is_sure_and_what_was_not_is_less_so(model):
    table = unpacked(model.table)
    red, grey, green = cells_of(np.array((RED, GREY, (140, 40, 40)), np.float32))
    assert table[red] < -3 * STEPS
    assert table[grey] > 3 * STEPS
    assert 2 * STEPS < table[green] < table[grey]


def test_a_motion_over_the_surroundings_is_split_where_half_is_object(model):
    light = light_from_yuv(np.array((RED, GREY), np.float32))
    shares = np.array([0.75, 0.25], np.float32)[:, None]
    mixed = cells_of(yuv_from_light(shares * light[0] + (1 - shares) * light[1]))
    mostly, hardly = unpacked(model.table)[mixed]
    assert mostly < 0 < hardly
    printed = np.empty((1, 2), dtype=np.int32)
    picture = yuv_from_light(shares * light[0] + (1 - shares) * light[1])[None]
    Singletons(learn([painted(0)], MARKED), 16.6, 0.12).differences(picture, printed)
    assert printed[0, 0] > 0, "the Gaussian takes what is mostly object for background"


def test_a_cell_never_seen_has_the_energy_of_the_paper():
    gaussian = learn([painted(0)], MARKED)
    table = np.full(CELLS, UNSEEN, dtype=np.int16)
    kept = (100.0, 130.0, 60.0)
    table[cells_of(np.array(kept, np.float32))] = -77
    both = Singletons(table_model(gaussian, table), 16.6, 0.12)
    # colours in the middle of their cells, where both must say the same
    picture = np.array([[kept, (84, 108, 204), (156, 132, 132)]], dtype=np.float32)
    mine, printed = (np.empty((1, 3), dtype=np.int32) for _ in range(2))
    both.differences(picture, mine)
    Singletons(gaussian, 16.6, 0.12).differences(picture, printed)
    assert mine[0, 0] == -77
    assert mine[0, 1:].tolist() == np.clip(printed[0, 1:], -32767, 32767).tolist()


def test_the_file_gives_back_the_same_model_and_old_files_still_load(tmp_path, model):
    path = tmp_path / "model.toml"
    save_model(path, model)
    loaded = load_model(path)
    assert isinstance(loaded, ColourTable)
    assert loaded == model
    gaussian = learn([painted(0)], MARKED)
    save_model(path, gaussian)
    path.write_text("".join(line for line in path.open() if not line.startswith("kind")))
    assert load_model(path) == gaussian


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("???", "not a compressed table"),
        (base64.b64encode(b"no zlib here").decode(), "not a compressed table"),
        (packed(np.zeros(CELLS - 1, np.int16)), "bytes"),
        (base64.b64encode(zlib.compress(bytes(50_000_000))).decode(), "bytes"),
    ],
)
def test_a_damaged_table_is_one_line_that_names_the_file(tmp_path, model, text, reason):
    path = tmp_path / "model.toml"
    save_model(path, ColourTable(mean=model.mean, covariance=model.covariance, table=text))
    with pytest.raises(InputError, match=reason) as error:
        load_model(path)
    assert str(path) in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    "region", [Region(310, 10, 40, 40), Region(10, 10, 3, 3), Region(-1, 0, 20, 20)]
)
def test_a_region_that_cannot_be_learnt_is_refused_as_for_the_gaussian(region):
    with pytest.raises(InputError):
        learn_table([painted(0)], region)


def test_a_flat_region_is_refused():
    with pytest.raises(InputError, match="every pixel is the same"):
        learn_table([np.full((240, 320, 2), 128, dtype=np.uint8)], MARKED)


@pytest.mark.parametrize("region", [Region(0, 0, 320, 240), Region(0, 0, 40, 30), OBJECT])
def test_regions_at_the_borders_and_of_the_whole_picture_are_learnt(region):
    assert unpacked(learn_table([painted(1)], region).table).shape == (CELLS,)


def test_learning_again_gives_the_same_table(model):
    assert learn_table([painted(n) for n in range(3)], MARKED) == model


def test_the_region_grows_to_the_object_and_not_to_another_one_alike():
    other = Region(20, 20, 40, 40)
    frame = painted(2, ((OBJECT, RED), (other, RED)))
    picture = Reduction(SIZE, 160)(frame)
    inside = grown(picture, region_mask(MARKED, 2, picture.shape[:2]))
    assert inside[45:85, 70:100].all()
    assert np.count_nonzero(inside) == 30 * 40


def test_a_patch_of_one_colour_grows_to_the_object_with_its_holes_and_shades():
    dark = Region(OBJECT.x + 40, OBJECT.y, 20, 80)
    window = Region(150, 140, 16, 16)
    shade = (64, 109.6, 189.6)
    frame = painted(3, ((OBJECT, RED), (dark, shade), (window, (40, 128, 128))))
    picture = Reduction(SIZE, 160)(frame)
    small = Region(148, 100, 20, 24)
    inside = grown(picture, region_mask(small, 2, picture.shape[:2]))
    truth = np.zeros_like(inside)
    truth[45:85, 70:100] = True
    assert np.count_nonzero(inside != truth) <= 0.02 * np.count_nonzero(truth)


def test_light_and_levels_are_inverse():
    rng = np.random.default_rng(5)
    yuv = np.column_stack([rng.uniform(60, 180, 500), rng.uniform(100, 156, (500, 2))])
    back = yuv_from_light(light_from_yuv(yuv.astype(np.float32)))
    assert np.abs(back - yuv).max() < 1.5


@pytest.mark.parametrize(("length", "angle"), [(0.0, 0.0), (7.0, 0.0), (5.5, 0.7), (12.0, 2.1)])
def test_a_kernel_has_the_spread_of_a_straight_motion(length, angle):
    kernel = line_kernel(length, angle).astype(np.float64)
    half = kernel.shape[0] // 2
    offsets = np.arange(-half, half + 1)
    along = offsets[None, :] * np.cos(angle) + offsets[:, None] * np.sin(angle)
    assert kernel.sum() == pytest.approx(1.0, abs=1e-6)
    assert (kernel * along).sum() == pytest.approx(0.0, abs=1e-6)
    # a uniform motion's variance, and up to a quarter of a pixel's square from the raster
    assert -0.02 < (kernel * along**2).sum() - length**2 / 12.0 < 0.27


def test_smearing_loses_no_light():
    rng = np.random.default_rng(1)
    inside = np.zeros((40, 60), dtype=bool)
    inside[15:25, 20:40] = True
    light = rng.uniform(0.0, 1.0, (40, 60, 3)).astype(np.float32)
    layers = smeared(cut_out(light, inside, np.zeros_like(inside)), 6.0, 0.5)
    assert layers.share.sum() == pytest.approx(200.0, rel=1e-4)
    assert layers.object.sum() == pytest.approx(light[inside].sum(), rel=1e-4)


def gaussian_filter(counts, std):
    """Sums over the whole cube, cell by cell: slow and plain."""
    places = np.stack(np.unravel_index(np.arange(CELLS), (BINS,) * 3), axis=1)
    after = np.zeros(CELLS)
    for k in np.flatnonzero(counts):
        shares = np.ones(CELLS)
        for axis in range(3):
            line = np.exp(-0.5 * ((np.arange(BINS) - places[k, axis]) / std) ** 2)
            shares *= (line / line.sum())[places[:, axis]]
        after += counts[k] * shares
    return after


def test_smoothing_keeps_what_it_shares_out():
    counts = np.zeros(CELLS)
    counts[cells_of(np.array([(80, 90, 200), (255, 0, 128)], np.float32))] = 64.0, 8.0
    after = smoothed(counts, 0.9)
    assert after.sum() == pytest.approx(72.0)
    by_axes = gaussian_filter(counts, 0.9)
    assert after == pytest.approx(by_axes, abs=1e-9)


def test_a_mask_at_full_size_takes_the_table_too(model):
    frame = painted(9)
    segmenter = Segmenter(model, SegmentationConfig(width=80), SIZE)
    mask = full_mask(segmenter, segmenter.segment(frame), frame)
    truth = np.zeros_like(mask)
    truth[90:170, 140:200] = 1
    assert np.count_nonzero(mask != truth) < 0.02 * truth.sum()


def test_more_evidence_wins_over_more_pixels():
    mask = np.zeros((40, 40), dtype=np.uint8)
    differences = np.full((40, 40), 500, dtype=np.int32)
    mask[2:12, 2:22] = mask[20:28, 20:30] = 1
    differences[2:12, 2:22], differences[20:28, 20:30] = -20, -900
    blob = find_blob(Segmentation(mask, 0.0, 1, 1.0, (40, 40), True, differences))
    assert blob is not None
    assert blob.centre_px.tolist() == [24.5, 23.5]


@pytest.mark.parametrize("kind", ["gaussian", "table"])
def test_the_command_learns_either_kind(tmp_path, kind):
    import cv2

    from hal.yuyv import rgb_from_yuyv

    picture, out = tmp_path / "shown.png", tmp_path / "model.toml"
    cv2.imwrite(str(picture), rgb_from_yuyv(painted(0))[..., ::-1])
    region = f"{MARKED.x},{MARKED.y},{MARKED.width},{MARKED.height}"
    arguments = ["learn", str(picture), "--region", region, "--out", str(out)]
    subprocess.run(
        [sys.executable, "-m", "naod", *arguments, "--model-kind", kind], check=True, timeout=120
    )
    assert isinstance(load_model(out), ColourTable) == (kind == "table")

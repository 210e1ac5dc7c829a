"""Cuts of a scan: what lies at a side of the patient is drawn at the edge that bears its letter."""

import numpy as np
import pytest

from cranio_nb.drawing import figures, palette
from cranio_nb.drawing.figures.cuts import _BONE_GREY, _CLEAR
from cranio_nb.volume import Volume

CORNERS = np.array([[-30.0, -40.0, -20.0], [30.0, 40.0, 20.0]])
WHERE = {"L": (0, 1), "R": (0, -1), "P": (1, 1), "A": (1, -1), "S": (2, 1), "I": (2, -1)}
LETTERS = {"axial": "LRAP", "coronal": "LRSI", "sagittal": "PASI"}


def head(kind=np.int16, spot=(15, -20, 10)):
    """Air, with a spot of bone around a place of the world; planes 2 mm, rows 1 mm apart, columns counted to the right.

    The canonical axes are not those of the grid, so that only the affine says where the spot is.
    """
    affine = np.array([[0, 0, -1.0, 40], [0, 1.0, 0, -50], [2.0, 0, 0, -30], [0, 0, 0, 1]])
    world = np.moveaxis(np.indices((31, 101, 81)), 0, -1) @ affine[:3, :3].T + affine[:3, 3]
    bone = np.abs(world - spot).max(axis=-1) <= 6
    return Volume(bone if kind is bool else np.where(bone, 1500, -1000).astype(kind), affine)


def pixels(figure):
    return np.asarray(figure.axes[0].images[0].get_array())


@pytest.mark.parametrize("kind", [np.int16, np.float32, bool])
@pytest.mark.parametrize("name", figures.CUTS)
def test_each_letter_stands_at_its_side(name, kind):
    spot = np.array([15.0, -20.0, 10.0])
    figure = figures.cut_figure(head(kind, spot), None, name, spot, CORNERS)
    rgb, texts = pixels(figure), {t.get_text(): np.array(t.get_position()) for t in figure.axes[0].texts}
    assert set(texts) == {*LETTERS[name], "50 mm"}
    rows, cols = np.nonzero(rgb[..., 0] > 0.5)
    seen = np.array([cols.mean() / rgb.shape[1], 1 - rows.mean() / rgb.shape[0]]) - 0.5
    for letter in LETTERS[name]:
        axis, sign = WHERE[letter]
        assert np.sign(seen @ (texts[letter] - 0.5)) == np.sign(spot[axis] * sign), letter


@pytest.mark.parametrize(("name", "size_mm"), [("axial", (80, 60)), ("coronal", (40, 60)), ("sagittal", (40, 80))])
def test_a_cut_is_at_its_scale(name, size_mm):
    figure = figures.cut_figure(head(), None, name, (15, -20, 10), CORNERS, px_mm=0.5)
    assert pixels(figure).shape == (2 * size_mm[0], 2 * size_mm[1], 3)
    bar = figure.axes[0].lines[-1].get_xdata()
    assert np.ptp(bar) * 0.5 == pytest.approx(50)
    # bone of 12 mm and half a voxel on both sides, give or take the slope between two voxels
    width = (pixels(figure)[..., 0] > 0.5).any(axis=0).sum() * 0.5
    assert width == pytest.approx(13, abs=1)


@pytest.mark.parametrize("name", figures.CUTS)
def test_the_other_cuts_meet_in_the_place(name):
    place = np.array([15.0, -20.0, 10.0])
    figure = figures.cut_figure(head(), None, name, place, CORNERS)
    across, upright = (np.concatenate(one.get_segments()) for one in figure.axes[0].collections)
    right, down = np.array(figures.CUTS[name])
    low = [min(CORNERS @ way) for way in (right, down)]
    x, y = ((place @ way - start) / 0.5 - 0.5 for way, start in zip((right, down), low, strict=True))
    np.testing.assert_allclose(across[:, 1], y)
    np.testing.assert_allclose(upright[:, 0], x)


def test_the_patch_is_painted_over_the_bone():
    bone = head(bool)
    figure = figures.cut_figure(bone, bone, "axial", (15, -20, 10), CORNERS)
    inside = _CLEAR * _BONE_GREY + (1 - _CLEAR) * palette.rgb_shares(palette.PATCH)
    colours = np.unique(pixels(figure).reshape(-1, 3).round(6), axis=0)
    expected = np.stack([np.zeros(3), palette.rgb_shares(palette.PROSTHESIS), inside])
    np.testing.assert_allclose(colours, expected[np.lexsort(expected.T[::-1])], atol=1e-6)


def test_outside_of_the_scan_it_is_black():
    low, high = CORNERS
    figure = figures.cut_figure(head(), None, "axial", (0, 0, 0), np.stack([low - 100, high + 100]))
    assert not pixels(figure)[:50].any()

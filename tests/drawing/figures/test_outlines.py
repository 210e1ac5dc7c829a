"""Outlines over each other are told apart, and lie where the masks end."""

import numpy as np
import pytest

from cranio_nb.drawing import figures, palette
from cranio_nb.volume import Volume


def test_lines_over_each_other_are_told_apart():
    styles = [figures.line_style(i) for i in range(49)]
    assert len(set(styles)) == 49
    assert len({dashes for _, dashes in styles[:7]}) == len({colour for colour, _ in styles[:7]}) == 7


@pytest.fixture
def block() -> Volume:
    """A block of 20 x 20 x 20 mm about the origin."""
    voxels = np.zeros((60, 60, 60), bool)
    voxels[20:40, 20:40, 20:40] = True
    affine = np.array([[0, 0, 1.0, -29.5], [0, 1.0, 0, -29.5], [1.0, 0, 0, -29.5], [0, 0, 0, 1]])
    return Volume(voxels, affine)


def cut(block, patches, truth=None):
    return figures.outlines_figure(
        block.with_voxels(~block.voxels), truth, patches, centre=(0, 0, 0), axes=((1, 0, 0), (0, 0, -1)), reach_mm=25.0
    )


def test_each_patch_is_a_line_around_it(block):
    ax = cut(block, [block, block]).axes[0]
    lines = ax.collections
    assert [tuple(line.get_edgecolor()[0][:3]) for line in lines] == [
        tuple(palette.rgb_shares(figures.line_style(i)[0])) for i in range(2)
    ]
    for line in lines:
        points = line.get_paths()[0].vertices
        sides = np.abs(points).max(axis=1)  # of a square whose corners are a little round
        assert np.median(sides) == pytest.approx(10, abs=0.4) and sides.max() < 10.4


def test_the_cut_is_at_its_scale_with_the_sides_named(block):
    ax = cut(block, [block], block).axes[0]
    (x0, x1), (y0, y1) = ax.get_xlim(), ax.get_ylim()
    width, height = ax.figure.get_size_inches()
    assert (x1 - x0) / width == pytest.approx((y0 - y1) / height, rel=0.02)
    assert {"L", "R", "S", "20 mm"} <= {text.get_text() for text in ax.texts}
    assert len(ax.images) == 2


def test_an_empty_patch_has_no_line(block):
    empty = block.with_voxels(np.zeros(block.shape, bool))
    assert not cut(block, [empty]).axes[0].collections

"""A round skull with a gap at the patient's left, and the gap bridged by its true circles."""

from dataclasses import dataclass

import numpy as np
import pytest

from cranio_nb.curves import GapEnds
from cranio_nb.methods.slicewise.slices import SlicedDesign, SliceResult
from cranio_nb.opening import Opening
from cranio_nb.vault import slicing
from cranio_nb.volume import Volume

CENTRE, OUTER_PX, INNER_PX, HALF_GAP = 45.0, 38.0, 32.0, 0.5
PLANE = 1


@dataclass(frozen=True, eq=False)
class RoundHead:
    """Masks on one grid, and the middle slice as a design of it."""

    ct: Volume
    bone: Volume
    lost: Volume
    sliced: SlicedDesign
    result: SliceResult


def arc(radius):
    """Points over the gap, from its front to its back, (row, col) px."""
    angle = np.linspace(-HALF_GAP - 0.1, HALF_GAP + 0.1, 41)
    return CENTRE + radius * np.column_stack([np.sin(angle), np.cos(angle)])


def ends_of(curve):
    """Ends of a curve with tangents that point into the gap."""
    tangents = np.array([curve[1] - curve[0], curve[-2] - curve[-1]])
    return GapEnds(curve[[0, -1]], tangents / np.linalg.norm(tangents, axis=1, keepdims=True))


@pytest.fixture(scope="session")
def round_head() -> RoundHead:
    row, col = np.mgrid[:91, :91] - CENTRE
    radius, angle = np.hypot(row, col), np.arctan2(row, col)
    ring = (radius <= OUTER_PX) & (radius >= INNER_PX)
    gap = ring & (np.abs(angle) < HALF_GAP)
    affine = np.array([[0, 0, 1.5, -11.0], [0, 1.5, 0, 7.0], [2.0, 0, 0, 50.0], [0, 0, 0, 1]])
    bone, lost = (Volume(np.repeat(mask[None], 3, axis=0), affine) for mask in (ring & ~gap, gap))
    curves = np.stack([arc(OUTER_PX), arc(INNER_PX)])
    result = SliceResult(PLANE, "balloon", "", tuple(map(ends_of, curves)), curves - 1.0, curves)
    opening = Opening(lost, bone.to_world([PLANE, CENTRE, CENTRE]))
    sliced = SlicedDesign(opening, slicing.axial_frames(bone, range(3)), 1.5, (result,))
    ct = bone.with_voxels(np.where(bone.voxels, 1000, 0).astype(np.int16))
    return RoundHead(ct, bone, lost, sliced, result)


@pytest.fixture
def letters():
    """The letters "(a)", "(b)", ... of a figure, each once, in the order of its panels."""

    def read(figure):
        titles = [ax.get_title(loc="left") for ax in figure.axes]
        return list(dict.fromkeys(title[:3] for title in titles if title.startswith("(")))

    return read

"""Slices as the paper takes them: a balloon that runs out of the image bridges nothing, and its slice says so."""

import numpy as np
import pytest

from cranio_nb.methods.catalogue import COMMON, default_options, preset_options
from cranio_nb.methods.slicewise.axial import by_skeleton, within_image
from cranio_nb.methods.slicewise.inflate import carry
from cranio_nb.methods.slicewise.method import pieces
from cranio_nb.methods.slicewise.slices import SliceResult


def curve(top):
    """Outer and inner curve of a slice over columns 10 to 20, with an apex at row `top`."""
    t = np.linspace(0, 1, 11)
    line = np.column_stack([30 + (top - 30) * 4 * t * (1 - t), 10 + 10 * t])
    return np.stack([line, line + np.array([5.0, 0.0])])


@pytest.mark.parametrize(("top", "inside"), [(20.0, True), (0.0, True), (-0.6, False), (90.0, False)])
def test_a_balloon_bridges_only_inside_the_image(top, inside):
    (kept,) = within_image([SliceResult(4, "balloon", curves=curve(top))], (60, 40))
    assert (kept.plane, kept.status) == (4, "balloon" if inside else "skipped")
    assert bool(kept.curves.size) == inside == (kept.reason == "")


def test_its_neighbours_carry_such_a_slice():
    slices = [SliceResult(i, "balloon", curves=curve(top)) for i, top in enumerate((20.0, -400.0, 24.0))]
    _, carried, _ = carry(within_image(slices, (60, 40)))
    assert carried.status == "carried" and "out of the image" in carried.reason
    np.testing.assert_allclose(carried.curves, curve(22.0))


@pytest.mark.parametrize("pressure_mm", [5.0, 200.0])
def test_a_design_holds_no_balloon_that_ran_away(pressure_mm, skull, openings):
    """Far too strong a pressure blows balloons out of the image; the patch stays in it, and the record says why.

    A design refuses such a pressure; other inputs may drive a balloon as far.
    """
    bone = skull("unilateral")
    options = default_options("slicewise") | preset_options("slicewise", "paper", bone) | {"pressure_mm": pressure_mm}
    (made,) = pieces(bone, openings("unilateral"), **{k: v for k, v in options.items() if k not in COMMON})
    told = made.record["slices"]
    assert any("out of the image" in s["reason"] for s in told)
    assert all(("balloon ran" in s["reason"]) <= (s["status"] in ("skipped", "carried")) for s in told)
    (part,) = made.working
    shape = np.array(skull("unilateral").shape[1:])
    for s in part.slices:
        assert (s.curves > -0.6).all() and (s.curves < shape - 0.4).all()


def test_gap_ends_of_an_open_and_a_closed_ring(ring):
    bone = np.stack([ring(60, 68, half_gap=15.0), ring(60, 68), np.zeros((201, 201), bool)])
    opening = np.stack([ring(62, 66) & ~bone[0], *np.zeros((2, 201, 201), bool)])
    open_ring, closed, empty = by_skeleton(bone, opening, skip_px=10.0, reach_px=10.0)
    assert (open_ring.status, closed.status, empty.status) == ("balloon", "hull", "skipped")
    gap = 2 * 68 * np.sin(np.radians(15))
    outer = open_ring.ends[0].points
    assert gap < np.linalg.norm(outer[1] - outer[0]) < gap + 2 * 20

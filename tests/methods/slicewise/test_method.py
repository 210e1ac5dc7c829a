"""The paper's preset in its own units, and the record of every slice."""

import numpy as np
import pytest

import cranio_nb as cn
from cranio_nb.evaluation import scores
from cranio_nb.methods.catalogue import preset_options
from cranio_nb.vault.opening_search import find_openings
from data_synth import phantom_case


@pytest.mark.parametrize("px", [0.45, 0.9, 1.75])
def test_the_papers_preset_is_in_mm_on_every_grid(px):
    """The 10 points it leaves out are 4.5 mm at pixels of 0.45 mm; its k is 0.062 of the scan's own pixels."""
    bone = cn.Volume(np.zeros((2, 2, 2), bool), np.diag([1.3, px, px, 1.0]))
    options = preset_options("slicewise", "paper", bone)
    assert options["skip_mm"] == 4.5 and options["reach_mm"] == pytest.approx(10 * px)
    assert options["pressure_mm"] / px == pytest.approx(0.062, rel=1e-12)
    assert (options["n_snaxels"], options["coupling_mm"], options["axial"], options["smooth"]) == (21, 0.0, True, False)


def test_the_papers_preset_on_the_class_phantom():
    """4.5 mm are half of 10 pixels here: the tangents lie nearer to the rim."""
    case = phantom_case("class", "unilateral", 0)
    bone, truth = cn.Volume(case.bone, case.affine), cn.Volume(case.implant, case.affine)
    openings = find_openings(bone)
    now = scores.dice(cn.design(bone, openings, preset="paper").patch, truth)
    in_pixels = scores.dice(cn.design(bone, openings, preset="paper", skip_mm=9.0).patch, truth)
    assert now == pytest.approx(0.71, abs=0.02) and now > in_pixels + 0.1


@pytest.mark.parametrize("directions", [1, 3])
def test_every_slice_is_told_by_opening_direction_and_plane(directions, skull, openings):
    made = cn.design(skull("burr_hole"), openings("burr_hole"), directions=directions)
    told = [(s["opening"], s["direction"], s["plane"]) for s in made.record["slices"]]
    assert len(set(told)) == len(told) == sum(len(part.slices) for part in made.working)
    assert {opening for opening, _, _ in told} == {0} and {d for _, d, _ in told} == set(range(directions))


def test_a_pressure_in_mm_means_the_same_in_both_ways_of_slicing(skull, openings):
    """In axial slices it is that many mm / px pixels: the apex of a balloon follows it, whatever the unit."""
    px = float(skull("burr_hole").spacing[1:].mean())
    made = cn.design(skull("burr_hole"), openings("burr_hole"), axial=True, pressure_mm=0.062 * px, reach_mm=17.5)
    (part,) = made.working
    assert part.unit == px and made.parameters["pressure_mm"] == 0.062 * px

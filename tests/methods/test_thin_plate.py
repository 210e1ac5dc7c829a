"""The plate on closed forms: what it reproduces, what it weighs, what it leaves alone; and the design around it."""

import json
from dataclasses import replace

import numpy as np
import pytest
from scipy import ndimage

from cranio_nb.errors import InputRefused
from cranio_nb.methods.design import design
from cranio_nb.methods.thin_plate import bend
from cranio_nb.vault import radius_measurement, symmetry
from cranio_nb.volume import Volume

N, MM = 41, 2.0
V, U = np.mgrid[:N, :N] * MM - (N - 1) / 2 * MM  # mm from the middle
AWAY = np.hypot(V, U)
HOLE = AWAY < 22.0
BESIDE = ~HOLE & (AWAY < 30.0)
POLYNOMIALS = {
    0: np.full((N, N), 74.0),
    1: 74 + 0.02 * V - 0.05 * U,
    2: 74 + 0.02 * V - 0.05 * U - 0.004 * V**2 + 0.002 * V * U - 0.006 * U**2,
}
WAVE = 75 + 1.5 * np.cos(V / 16) * np.sin(U / 14 + 0.4)


def only(**lengths):
    """Options with every term off but those given."""
    return {"second_mm": 0.0, "third_mm": 0.0, "mirror_mm": 0.0} | lengths


def known(values):
    return np.where(HOLE, np.nan, values)


@pytest.mark.parametrize("degree", [0, 1, 2])
@pytest.mark.parametrize("length", [1.0, 4.0, 12.0])
def test_the_third_order_continues_quadratics_exactly(degree, length):
    plate = bend(known(POLYNOMIALS[degree]), HOLE, MM, **only(third_mm=length))
    np.testing.assert_allclose(plate[HOLE | BESIDE], POLYNOMIALS[degree][HOLE | BESIDE], atol=2e-3)


@pytest.mark.parametrize("degree", [0, 1])
def test_the_second_order_continues_planes_exactly(degree):
    plate = bend(known(POLYNOMIALS[degree]), HOLE, MM, **only(second_mm=3.0))
    np.testing.assert_allclose(plate[HOLE], POLYNOMIALS[degree][HOLE], atol=1e-3)


def test_without_stiffness_the_plate_lies_on_the_bone():
    soft = bend(known(WAVE), HOLE, MM, **only(third_mm=0.1))
    np.testing.assert_allclose(soft[BESIDE], WAVE[BESIDE], atol=1e-4)
    stiff = bend(known(WAVE), HOLE, MM, **only(third_mm=8.0))
    assert np.abs(stiff - WAVE)[BESIDE].mean() > 10 * np.abs(soft - WAVE)[BESIDE].mean()


@pytest.mark.parametrize("firmness", [1 / 16, 16.0])
def test_data_half_as_firm_are_smoothed_over_a_length_that_is_longer_by_a_fourth_root(firmness):
    bumps = known(WAVE + np.random.default_rng(0).normal(0, 0.5, WAVE.shape))
    weighted = bend(bumps, HOLE, MM, firmness=np.full(WAVE.shape, firmness), **only(second_mm=3.0))
    longer = bend(bumps, HOLE, MM, **only(second_mm=3.0 * firmness**-0.25))
    np.testing.assert_allclose(weighted[HOLE | BESIDE], longer[HOLE | BESIDE], atol=1e-3)


def test_what_is_known_less_firmly_bends_the_plate_less():
    tilted = WAVE + np.where(V > 0, 0.03 * V, 0)  # one side is off
    off = [
        np.abs(bend(known(tilted), HOLE, MM, firmness=np.where(V > 0, low, 1.0)) - bend(known(WAVE), HOLE, MM))
        for low in (1e-4, 0.1, 1.0)
    ]
    sums = [one[HOLE & (V < 0)].sum() for one in off]
    assert sums[0] < sums[1] < sums[2]


@pytest.mark.parametrize("turn", [lambda a: a[::-1], lambda a: a[:, ::-1], lambda a: a.T, np.rot90])
def test_a_turned_or_mirrored_map_gets_the_turned_or_mirrored_plate(turn):
    like = WAVE + 0.3 * np.sin(U / 9)
    plate = bend(known(WAVE), HOLE, MM, like=like)
    turned = bend(turn(known(WAVE)).copy(), turn(HOLE), MM, like=turn(like).copy())
    np.testing.assert_allclose(turned, turn(plate), atol=1e-6)


def test_the_level_of_the_map_goes_through():
    np.testing.assert_allclose(bend(known(WAVE) + 500, HOLE, MM), bend(known(WAVE), HOLE, MM) + 500, atol=1e-6)


def test_a_finer_map_gets_the_same_plate():
    v, u = np.mgrid[: 2 * N - 1, : 2 * N - 1] * MM / 2 - (N - 1) / 2 * MM
    hole = np.hypot(v, u) < 22.0
    fine = np.where(hole, np.nan, 75 + 1.5 * np.cos(v / 16) * np.sin(u / 14 + 0.4))
    apart = bend(fine, hole, MM / 2)[::2, ::2] - bend(known(WAVE), HOLE, MM)
    assert np.abs(apart[HOLE]).max() < 0.1


def test_what_is_known_in_the_hole_counts_for_nothing():
    np.testing.assert_array_equal(bend(WAVE + np.where(HOLE, 9.0, 0.0), HOLE, MM), bend(known(WAVE), HOLE, MM))


def test_stray_bone_is_left_out():
    bumpy = known(POLYNOMIALS[2])
    bumpy[(np.abs(V - 26) < 5) & (np.abs(U) < 5)] += 6.0
    clean, robust = (bend(values, HOLE, MM)[HOLE] for values in (known(POLYNOMIALS[2]), bumpy))
    assert np.abs(robust - clean).max() < 0.1


def test_the_other_sides_curvature_is_taken_over_but_not_where_it_lies():
    like = WAVE + 3.0 + 0.05 * V - 0.02 * U
    alone, copied = (bend(known(WAVE), HOLE, MM, like=other) - WAVE for other in (None, like))
    assert np.abs(copied[HOLE]).max() < 0.5 * np.abs(alone[HOLE]).max()
    stiff = bend(known(WAVE), HOLE, MM, like=like, **only(mirror_mm=2.0))
    np.testing.assert_allclose(stiff[HOLE], WAVE[HOLE], atol=0.1)


def test_an_unknown_other_side_changes_nothing():
    blank = np.full((N, N), np.nan)
    np.testing.assert_array_equal(bend(known(WAVE), HOLE, MM, like=blank), bend(known(WAVE), HOLE, MM))


def test_the_plate_lies_on_what_is_expected_if_the_bone_does():
    alone, told = (bend(known(WAVE), HOLE, MM, expected=e) - WAVE for e in (None, WAVE))
    assert np.abs(alone[HOLE]).max() > 0.1
    np.testing.assert_allclose(told[HOLE | BESIDE], 0.0, atol=1e-9)


@pytest.mark.parametrize(("mm", "least", "most"), [(0.5, 0.0, 0.02), (2.0, 0.2, 0.8), (5.0, 3.0, 4.8)])
def test_what_is_expected_counts_the_more_the_wider_the_hole_and_nothing_at_the_rim(mm, least, most):
    plate = bend(known(POLYNOMIALS[0]), HOLE, mm, expected=np.full((N, N), 78.0)) - 74  # the bone lies at 74
    middle, rim = AWAY < 4.0, HOLE & (AWAY > 20.0)  # of holes of 11, 44, 110 mm
    assert least <= plate[middle].min() and plate[middle].max() <= most
    assert np.abs(plate[rim]).max() < 0.5


def test_too_little_bone_gives_no_plate():
    values = np.full((N, N), np.nan)
    values[0, :5] = 75.0
    assert np.isnan(bend(values, HOLE, MM)).all()


def test_bone_on_one_side_only_still_gives_a_plate():
    plate = bend(np.where(V > -10, np.nan, known(WAVE)), HOLE, MM)
    assert np.isfinite(plate[HOLE]).all() and np.abs(plate[HOLE] - 75).max() < 40


@pytest.fixture(scope="module")
def made(skull):
    return design(skull("unilateral"), method="thin-plate")


def test_the_prosthesis_is_nowhere_thinner_than_sound_bone(made):
    (plate,) = made.working
    assert np.nanmin(plate.radius_map.outer - plate.radius_map.inner) < 3  # the bevelled rim is
    radii = [np.array(r)[plate.radius_map.hole] for r in (plate.outer, plate.inner)]
    assert (radii[0] - radii[1]).min() > 3


def test_the_plane_of_symmetry_is_told(made):
    assert made.record["symmetry"]["residual_mm"] < 1.0
    assert json.dumps(made.record)


def test_without_a_plane_of_symmetry_the_plate_is_bent_all_the_same(skull, made, monkeypatch):
    def refuse(*_):
        raise InputRefused("NoSymmetry", "Too little of the vault has a counterpart.")

    monkeypatch.setattr(symmetry, "find_symmetry_plane", refuse)
    alone = design(skull("unilateral"), method="thin-plate")
    assert alone.record["symmetry"] == {"unused": "Too little of the vault has a counterpart."}
    assert alone.working[0].mirrored is None
    asked = design(skull("unilateral"), mirror_mm=0.0, method="thin-plate")
    np.testing.assert_array_equal(asked.patch.voxels, alone.patch.voxels)
    assert made.working[0].mirrored is not None


def test_the_working_holds_a_plate_for_each_opening(made, skull):
    assert len(made.working) == 1 and isinstance(made.patch, Volume)
    plate = made.working[0]
    np.testing.assert_array_equal(np.isfinite(plate.outer), plate.radius_map.hole)


def test_a_plane_that_is_none_is_not_used(skull, made, monkeypatch):
    found = symmetry.find_symmetry_plane(skull("unilateral"), made.working[0].radius_map.grid.centre)
    for residual, used in ((1.2, True), (1.4, False)):
        monkeypatch.setattr(symmetry, "find_symmetry_plane", lambda *_, r=residual: replace(found, residual_mm=r))
        plate = design(skull("unilateral"), method="thin-plate")
        assert (plate.working[0].mirrored is not None) is used
        assert ("unused" in plate.record["symmetry"]) is not used


def test_a_blurred_rim_does_not_pull_the_plate_down(skull, made):
    (plate,) = made.working
    beside = ndimage.distance_transform_edt(~plate.radius_map.hole) * plate.radius_map.step_mm
    grazed = (beside > 0) & (beside <= 0.8)
    assert grazed.any()
    low = replace(plate.radius_map, outer=np.where(grazed, plate.radius_map.outer - 5.0, plate.radius_map.outer))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(radius_measurement, "measure_around", lambda bone, one: low)
        again = design(skull("unilateral"), method="thin-plate")
    np.testing.assert_allclose(again.working[0].outer, plate.outer, atol=1e-6)

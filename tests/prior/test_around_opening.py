"""What is predicted around an opening, against the bone that was cut out."""

import numpy as np
import pytest

from cranio_nb.prior.around_opening import predict_around
from cranio_nb.vault import radius_measurement
from cranio_nb.vault.opening_search import find_openings
from cranio_nb.vault.ray_casting import surface_radii
from cranio_nb.volume import Volume


def mirror_image(bone):
    affine = np.diag([-1.0, 1.0, 1.0, 1.0]) @ bone.affine
    return Volume(bone.voxels, affine).canonical()


def test_a_hole_in_a_head_is_predicted_on_its_map(learned, phantom, skull):
    case, bone = phantom("round", 0), skull("round", 0)
    radius_map = radius_measurement.measure_around(bone, find_openings(bone)[0])
    found = predict_around(learned, bone, radius_map)
    whole = Volume(case.bone | case.implant, case.affine)
    expected = np.nan_to_num(found.outer, nan=80.0)
    outer, inner = surface_radii(whole, radius_map.grid.centre, radius_map.grid.directions, expected)
    assert np.isfinite(found.outer[radius_map.hole]).all()
    assert np.abs(found.outer - outer)[radius_map.hole].mean() < 0.8
    assert np.abs(found.inner - inner)[radius_map.hole].mean() < 0.8
    sound = ~radius_map.hole & np.isfinite(found.outer) & np.isfinite(radius_map.outer)
    assert np.median(np.abs(found.outer - radius_map.outer)[sound]) < 0.5


def test_the_mirrored_head_is_predicted_mirrored(learned, skull):
    bone = skull("round", 0)
    twin = mirror_image(bone)
    charts = [radius_measurement.measure_around(one, find_openings(one)[0]) for one in (bone, twin)]
    found = [predict_around(learned, one, radius_map) for one, radius_map in zip((bone, twin), charts, strict=True)]
    middles = [np.nanmean(one.outer[radius_map.hole]) for one, radius_map in zip(found, charts, strict=True)]
    assert middles[0] == pytest.approx(middles[1], abs=0.3)
    assert np.linalg.norm(found[0].frame.origin * [-1, 1, 1] - found[1].frame.origin) < 1.0

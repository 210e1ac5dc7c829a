"""The plate that a prior holds."""

import numpy as np
from scipy import ndimage

from cranio_nb.methods import thin_plate
from cranio_nb.methods.design import design
from cranio_nb.prior.around_opening import Prediction
from cranio_nb.prior.file import pack_prior


def test_a_prior_draws_the_plate_towards_what_skulls_predict_but_not_off_the_rim(learned, skull, tmp_path):
    bone = skull("unilateral")
    (tmp_path / "prior.npz").write_bytes(pack_prior(learned))
    (alone,) = design(bone, method="thin-plate").working
    made = design(bone, method="thin-plate", prior=str(tmp_path / "prior.npz"))
    (plate,) = made.working
    inside = ndimage.distance_transform_edt(plate.radius_map.hole) * plate.radius_map.step_mm
    rim, middle = (inside > 0) & (inside < 3), inside > 15
    for bent, held, expected in zip(
        (alone.outer, alone.inner), (plate.outer, plate.inner), plate.expected, strict=True
    ):
        assert np.abs(held - expected)[middle].mean() < np.abs(bent - expected)[middle].mean()
        assert np.abs(held - bent)[rim].mean() < np.abs(held - bent)[middle].mean()
    assert made.record["prior_skulls"] == len(learned.radii)
    assert made.patch.voxels.any() and not (made.patch.voxels & bone.voxels).any()


def test_a_prior_that_does_not_reach_the_hole_changes_nothing(learned, skull, tmp_path, monkeypatch):
    bone = skull("burr_hole")
    (tmp_path / "prior.npz").write_bytes(pack_prior(learned))

    def nowhere(prior, bone, radius_map, *_):
        nothing = np.full(radius_map.hole.shape, np.nan)
        return Prediction(outer=nothing, inner=nothing, frame=None)

    monkeypatch.setattr(thin_plate, "predict_around", nowhere)
    made = design(bone, method="thin-plate", prior=str(tmp_path / "prior.npz"))
    np.testing.assert_array_equal(made.patch.voxels, design(bone, method="thin-plate").patch.voxels)
    assert made.working[0].expected is None

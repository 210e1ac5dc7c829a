"""A scan on disk to a measured prosthesis: who is to blame where a patch reaches the edge of the image."""

import numpy as np
import pytest

import cranio_nb as cn
from cranio_nb.errors import InputRefused
from cranio_nb.methods import catalogue
from cranio_nb.methods.piece import Piece
from cranio_nb.output.nifti_files import write_nifti
from cranio_nb.pipeline.preparation import prepare
from cranio_nb.pipeline.run import check_patch, run_design
from cranio_nb.pipeline.trial import Contender, attempt


def runaway(bone, openings, *, planes=3):
    """Closes the opening, but in some planes its patch goes on from there to the last row, as a bad balloon does."""
    for opening in openings:
        voxels = opening.sheet.voxels.copy()
        plane, row, col = np.argwhere(voxels)[len(np.argwhere(voxels)) // 2]
        voxels[plane : plane + planes, row:, col : col + 2] = True
        yield Piece(voxels)


@pytest.fixture
def scan(skull, tmp_path):
    path = tmp_path / "skull.nii.gz"
    write_nifti(skull("burr_hole"), path)
    return path


def test_a_patch_that_runs_away_is_the_methods_fault_everywhere_alike(scan):
    cn.add_method("runaway", runaway)
    try:
        case = prepare(scan)
        assert case.openings[0].sheet.voxels[:, -1].sum() == 0
        with pytest.raises(InputRefused) as refused:
            run_design(case, method="runaway")
        tried = attempt(case.bone, case.openings, Contender("runaway"))
    finally:
        catalogue.remove_method("runaway")
    assert refused.value.code == tried.code == "PatchLeavesOpening" and tried.status == "no patch"
    assert "runaway" in refused.value.message and "method or preset" in refused.value.remedy
    assert "scan" not in refused.value.remedy


def test_beside_the_edge_it_is_the_images(skull, openings):
    """The image ends a voxel beside the opening: any patch would be cut off there."""
    (opening,) = openings("burr_hole")
    low, high = (f(np.argwhere(opening.sheet.voxels), axis=0) for f in (np.min, np.max))
    box = tuple(slice(max(a - 1, 0), b + 2) for a, b in zip(low, high, strict=True))
    near = type(opening)(opening.sheet.crop(box), opening.head_centre)
    cn.add_method("full", lambda bone, openings: (Piece(np.ones(bone.shape, bool)) for _ in openings))
    try:
        with pytest.raises(InputRefused) as refused:
            check_patch(cn.design(skull("burr_hole").crop(box), (near,), method="full"), (near,))
    finally:
        catalogue.remove_method("full")
    assert refused.value.code == "OpeningLeavesImage" and "scan" in refused.value.remedy

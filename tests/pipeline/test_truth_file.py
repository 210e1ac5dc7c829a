"""The mask of the missing bone is taken only where it belongs to the scan."""

import gzip

import numpy as np
import pytest

import cranio_nb as cn
from cranio_nb.errors import InputRefused
from cranio_nb.output.nifti_files import write_nifti
from cranio_nb.pipeline.truth_file import read_truth


@pytest.fixture
def truth(phantom, skull, tmp_path):
    """The missing bone, and the file that holds it."""
    mask = cn.Volume(phantom("burr_hole").implant, skull("burr_hole").affine)
    write_nifti(mask, tmp_path / "truth.nii.gz")
    return mask, tmp_path / "truth.nii.gz"


def test_is_read_as_it_was_written_and_what_the_file_warns_of_is_said(truth, skull):
    mask, path = truth
    read, said = read_truth(path, skull("burr_hole"))
    np.testing.assert_array_equal(read.voxels, mask.voxels)
    assert said == ()
    path.write_bytes(path.read_bytes() + gzip.compress(bytes(9)))
    (one,) = read_truth(path, skull("burr_hole"))[1]
    assert one.code == "BytesLeft" and one.message.startswith("The truth: ")


def test_on_another_grid_or_empty_it_is_refused(truth, skull):
    mask, path = truth
    bone = skull("burr_hole")
    with pytest.raises(InputRefused) as refused:
        read_truth(path, bone.crop((slice(1, None), slice(None), slice(None))))
    assert refused.value.code == "GridMismatch"
    write_nifti(mask.with_voxels(np.zeros(mask.shape, bool)), path)
    with pytest.raises(InputRefused) as refused:
        read_truth(path, bone)
    assert refused.value.code == "EmptyMask"

"""Digests of what was read: equal for equal scans, another for any other."""

import numpy as np
import pytest

from cranio_nb.output.nifti_files import write_nifti
from cranio_nb.pipeline.input_digest import case_label, digest_volume
from cranio_nb.readers import read_ct
from cranio_nb.volume import Volume
from data_synth import phantom_case
from data_synth.files import write_case

VOLUME = Volume(np.arange(24, dtype=np.int16).reshape(2, 3, 4), np.eye(4))


def test_one_scan_in_two_formats_has_one_digest(tmp_path):
    write_case(tmp_path, phantom_case("tiny", "burr_hole", 0))
    ct, _ = read_ct(tmp_path / "ct")
    write_nifti(ct, tmp_path / "ct.nii.gz")
    assert digest_volume(read_ct(tmp_path / "ct.nii.gz")[0]) == digest_volume(ct)


@pytest.mark.parametrize(
    "other",
    [
        VOLUME.with_voxels(VOLUME.voxels[::-1].copy()),
        VOLUME.with_voxels(VOLUME.voxels.astype(np.uint16)),
        Volume(VOLUME.voxels, np.diag([1.0, 1.0, 2.0, 1.0])),
        Volume(VOLUME.voxels.reshape(3, 2, 4), np.eye(4)),
    ],
    ids=["voxels", "kind", "place", "shape"],
)
def test_what_differs_has_another_digest(other):
    assert digest_volume(other) != digest_volume(VOLUME)


def test_a_view_has_the_digest_of_its_copy():
    turned = VOLUME.voxels[:, ::-1, ::2]
    assert digest_volume(Volume(turned, np.eye(4))) == digest_volume(Volume(turned.copy(), np.eye(4)))


def test_a_label_is_the_start_of_the_digest():
    digest = digest_volume(VOLUME)
    assert digest.startswith(case_label(digest).replace("-", "")) and len(case_label(digest)) == 9

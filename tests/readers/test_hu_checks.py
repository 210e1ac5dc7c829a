"""Values that are HU, a mask, or neither."""

from pathlib import Path

import numpy as np
import pytest
from dicom_series import as_unsigned_without_rescale, codes, head, save, series, shift_hu
from image_files import SMALL, file_refusal, stored_head, write_nifti, write_nrrd

from cranio_nb.errors import InputRefused
from cranio_nb.readers import read_ct
from cranio_nb.readers.hu_checks import AIR_HU, check_hu, clear_padding, is_mask
from data_synth.fault_edits import set_elements


@pytest.mark.parametrize("dtype", ["u1", "i2", "u2", "i4", "f4", "f8"])
def test_zeros_and_ones_are_a_mask(dtype: str, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    bone = (voxels > 300).astype(dtype)
    for path in (write_nifti(tmp_path / "a.nii.gz", bone, lps), write_nrrd(tmp_path / "a.nrrd", bone, lps)):
        volume, report = read_ct(path)
        assert volume.voxels.dtype == bool and report.kind == "mask"
        np.testing.assert_array_equal(volume.voxels, head(SMALL) > 300)


def test_mask_can_be_forced_either_way(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    labels = write_nrrd(tmp_path / "a.nrrd", ((voxels > 300) * 255).astype("u1"), lps)
    volume, report = read_ct(labels, mask=True)
    assert report.kind == "mask" and volume.voxels.sum() == (voxels > 300).sum()
    assert file_refusal(labels).code == "LabelMap"
    zeros_and_ones = write_nrrd(tmp_path / "b.nrrd", (voxels > 300).astype("u1"), lps)
    assert file_refusal(zeros_and_ones, mask=False).code == "ImplausibleHU"


@pytest.mark.parametrize("kind", ["brain and skull", "skull and piece", "a CT", "probabilities"])
def test_more_values_than_two_are_no_mask(kind: str, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    bone, brain = voxels > 300, (voxels > 0) & (voxels <= 300)
    piece = bone & (np.arange(voxels.shape[2]) > 8)
    wrong = {
        "brain and skull": (brain + 2 * bone).astype("u1"),
        "skull and piece": (bone.astype("u1") + piece).astype("u1"),
        "a CT": voxels,
        "probabilities": np.linspace(0, 1, voxels.size, dtype="f4").reshape(voxels.shape),
    }[kind]
    path = write_nifti(tmp_path / "a.nii", wrong, lps)
    assert file_refusal(path, mask=True).code == "NotAMask"
    if wrong.dtype == np.uint8:
        error = file_refusal(path)
        assert error.code == "LabelMap" and "--label" in error.remedy


@pytest.mark.parametrize("label", [1, 2])
def test_a_label_chooses_its_voxels(label: int, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    labels = np.where(voxels > 300, 2, voxels > 0).astype("u1")
    volume, report = read_ct(write_nifti(tmp_path / "a.nii", labels, lps), label=label)
    assert report.kind == "mask" and volume.voxels.sum() == (labels == label).sum()
    assert file_refusal(tmp_path / "a.nii", label=7).code == "NoSuchLabel"


def test_a_ct_in_dicom_is_no_mask(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head()))
    with pytest.raises(InputRefused) as caught:
        read_ct(folder, mask=True)
    assert caught.value.code == "NotAMask"


@pytest.mark.parametrize(("shift", "code"), [(0, ""), (50, ""), (75, "AirLevel"), (-75, "AirLevel"), (100, "refused")])
def test_air_tells_of_a_shifted_scale(shift: int, code: str, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    air = np.where(voxels < -900, -1000, voxels).astype(np.int16)
    path = write_nifti(tmp_path / "a.nii", air + np.int16(shift), lps)
    if code == "refused":
        assert file_refusal(path).code == "ImplausibleHU"
    else:
        assert {f.code for f in read_ct(path)[1].findings} == ({code} if code else set())


@pytest.mark.parametrize("value", [3e38, -3e38, 1e6])
def test_one_impossible_voxel_is_refused(value: float, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    broken = voxels.astype(np.float32)
    broken[3, 4, 5] = value
    assert file_refusal(write_nifti(tmp_path / "a.nii", broken, lps)).code == "ImpossibleHU"


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_voxels_that_are_no_numbers_are_refused(bad: float, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    broken = voxels.astype(np.float32)
    broken[3, 4, 5] = bad
    assert file_refusal(write_nifti(tmp_path / "a.nii", broken, lps)).code == "NonFinite"
    assert file_refusal(write_nrrd(tmp_path / "a.nrrd", np.full_like(broken, bad), lps)).code == "NonFinite"


def test_unscaled_hu_are_refused_unless_allowed(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = write_nifti(tmp_path / "a.nii", voxels + 1024, lps)
    assert file_refusal(path).code == "ImplausibleHU"
    _, report = read_ct(path, allow=("implausible_hu",))
    assert report.findings[-1].severity == "warning"


EVERY = slice(None)


def test_allowances_turn_refusals_into_warnings(tmp_path: Path) -> None:
    for name, change, allow, code in (
        ("a", shift_hu(1000), "implausible_hu", "ImplausibleHU"),
        ("b", set_elements(EVERY, Modality="OT"), "wrong_modality", "WrongModality"),
    ):
        datasets = series(head())
        change(datasets)
        _, report = read_ct(save(tmp_path / name, datasets), allow=(allow,))
        assert next(f for f in report.findings if f.code == code).severity == "warning"
    datasets = series(head())
    as_unsigned_without_rescale(datasets)
    volume, report = read_ct(save(tmp_path / "c", datasets), allow=("no_rescale", "implausible_hu"))
    np.testing.assert_array_equal(volume.voxels, head() + 1024)
    assert "MissingRescale" in codes(report)


def plain_head() -> np.ndarray:
    """Air around a box of bone around brain, HU."""
    hu = np.full((6, 30, 30), -1000, np.int16)
    hu[:, 5:25, 5:25] = 900
    hu[:, 7:23, 7:23] = 40
    return hu


def test_a_head_in_hu_has_nothing_odd_about_it() -> None:
    assert check_hu(plain_head()) == []


def test_metal_and_missing_bone_are_remarked_upon() -> None:
    metal, soft = plain_head(), plain_head()
    metal[:, 10:12, 10:12] = 8000
    soft[soft > 300] = 100
    assert [finding.code for finding in check_hu(metal)] == ["HighHU"]
    assert [finding.code for finding in check_hu(soft)] == ["LittleBone"]


def test_padding_is_cleared_only_where_a_head_remains() -> None:
    padded = plain_head()
    padded[:, :3, :3] = -3024
    before = padded.copy()
    cleared, (finding,) = clear_padding(padded)
    np.testing.assert_array_equal(padded, before)
    np.testing.assert_array_equal(cleared, np.where(before == -3024, AIR_HU, before))
    assert finding.values["value"] == -3024
    shifted = plain_head() - 2000  # the whole scale is off
    kept, findings = clear_padding(shifted)
    assert kept is shifted and not findings


def test_a_mask_holds_zeros_and_ones_and_nothing_else() -> None:
    assert is_mask(np.array([True, True]))
    assert is_mask(np.array([0.0, 1.0])) and not is_mask(np.array([0.0, 0.5, 1.0]))
    assert not is_mask(np.zeros(4)) and not is_mask(np.ones(4))

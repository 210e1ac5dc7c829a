"""The command line: cases on disk, read back by nibabel and by `read_scan`."""

import json

import nibabel
import numpy as np
import pytest

from data_synth import cut_case, phantom_case, write_dicom
from data_synth.__main__ import main
from data_synth.files import read_scan


def read_nifti(path):
    image = nibabel.load(path)
    affine = np.diag([-1.0, -1, 1, 1]) @ image.affine  # RAS to LPS
    return np.asarray(image.dataobj).transpose(2, 1, 0), affine[:, [2, 1, 0, 3]]


def test_command_line_writes_a_phantom(tmp_path):
    assert main([str(tmp_path / "out"), "--defect", "frontal", "--seed", "3"]) == 0
    case = phantom_case("tiny", "frontal", 3)
    voxels, affine, is_mask = read_scan(tmp_path / "out" / "ct")
    np.testing.assert_array_equal(voxels, case.hu)
    np.testing.assert_allclose(affine, case.affine, atol=1e-9)
    assert not is_mask
    truth, grid = read_nifti(tmp_path / "out" / "truth.nii.gz")
    np.testing.assert_array_equal(truth, case.implant)
    np.testing.assert_allclose(grid, case.affine, atol=1e-4)
    record = json.loads((tmp_path / "out" / "truth.json").read_text())
    assert record["implant_mm3"] == pytest.approx(case.implant.sum() * 3 * 1.75**2)
    middle = record["slices"][len(record["slices"]) // 2]
    (gap,) = case.slice_truth(middle["plane"])
    np.testing.assert_allclose(middle["outer"]["ends"], gap.outer.ends)
    assert [path.name for path in tmp_path.iterdir()] == ["out"]


def test_command_line_cuts_a_scan_and_a_mask(tmp_path):
    case = phantom_case("tiny", "burr_hole", 1)
    write_dicom(tmp_path / "scan", case.hu, case.affine, orientation="sagittal")
    assert main([str(tmp_path / "a"), "--from", str(tmp_path / "scan"), "--defect", "occipital"]) == 0
    cut = cut_case(case.hu, case.affine, "occipital", is_mask=False)
    np.testing.assert_array_equal(read_scan(tmp_path / "a" / "ct")[0], cut.hu)
    np.testing.assert_array_equal(read_nifti(tmp_path / "a" / "truth.nii.gz")[0], cut.implant)

    mask = nibabel.Nifti1Image(case.complete.transpose(2, 1, 0).astype(np.uint8), _ras(case.affine))
    nibabel.save(mask, tmp_path / "mask.nii.gz")
    assert main([str(tmp_path / "b"), "--from", str(tmp_path / "mask.nii.gz"), "--defect", "occipital"]) == 0
    left, truth = (read_nifti(tmp_path / "b" / name)[0] for name in ("mask.nii.gz", "truth.nii.gz"))
    np.testing.assert_array_equal(left + truth, case.complete)
    assert truth.any()


def _ras(affine):
    return np.diag([-1.0, -1, 1, 1]) @ affine[:, [2, 1, 0, 3]]


def test_command_line_refuses_a_folder_with_files(tmp_path, capsys):
    (tmp_path / "mine.txt").write_text("keep")
    with pytest.raises(SystemExit) as stop:
        main([str(tmp_path)])
    assert stop.value.code == 2
    assert "not empty" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["mine.txt"]


def test_command_line_refuses_what_is_no_scan(tmp_path, capsys):
    (tmp_path / "notes.txt").write_text("no scan")
    for source in ("notes.txt", "."):
        with pytest.raises(SystemExit):
            main([str(tmp_path / "out"), "--from", str(tmp_path / source)])
    assert "no folder and no .nii" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()

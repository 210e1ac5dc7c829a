"""The command `design`: what it writes, what it refuses, what it leaves alone."""

import json
from dataclasses import replace
from pathlib import Path

import nibabel
import nrrd
import numpy as np
import pydicom
import pytest
import trimesh
from cli_runs import OUTPUTS, assert_refused, cranio, digest, run_is

from cranio_nb.output import design_folder
from cranio_nb.output.nifti_files import write_nifti
from cranio_nb.pipeline import preparation
from cranio_nb.pipeline import survey as pipeline_survey
from cranio_nb.readers import read_ct
from cranio_nb.vault import opening_search
from cranio_nb.vault.verdict import Verdict, rule_rows
from cranio_nb.volume import Volume
from data_synth import Case, phantom_case, write_dicom

FLIP = np.diag([-1.0, -1.0, 1.0, 1.0])


def test_design_writes_its_files_and_nothing_else(done):
    assert {p.name for p in done.iterdir()} == OUTPUTS
    assert [p.name for p in done.parent.iterdir()] == ["b"]


def test_stl_is_the_patch_in_world_lps(done, case):
    mesh = trimesh.load_mesh(done / "prosthesis.stl")
    patch, _ = read_ct(done / "patch.nii.gz", mask=True)
    assert mesh.is_volume
    assert mesh.volume == pytest.approx(patch.voxels.sum() * patch.voxel_volume, rel=0.02)
    corners = patch.to_world(np.argwhere(patch.voxels))
    assert np.abs(mesh.bounds - [corners.min(0), corners.max(0)]).max() < patch.spacing.max()
    truth = Volume(case.implant, case.affine).to_world(np.argwhere(case.implant)).mean(axis=0)
    assert np.linalg.norm(mesh.center_mass - truth) < 2.0


def test_design_json_is_closed_strict_and_true(done, case):
    text = (done / "design.json").read_text()
    record = json.loads(text, parse_constant=lambda name: pytest.fail(f"{name} is not JSON"))
    assert set(record) == {
        *("cranio_nb", "not_for_clinical_use", "world", "load", "bone_threshold_hu", "openings", "method", "preset"),
        *("parameters", "slices", "slice_counts", "balloons", "findings", "measures", "mesh", "implant", "seconds"),
        *("left_open", "versions", "case", "finished", "input_sha256"),
    }
    assert record["world"] == "DICOM LPS, mm" and record["not_for_clinical_use"] is True
    assert record["load"]["source"] == "DICOM" and record["load"]["shape"] == list(case.bone.shape)
    assert record["load"]["spacing_mm"] == pytest.approx([3.0, 1.75, 1.75])
    assert (record["method"], record["preset"], record["bone_threshold_hu"]) == ("slicewise", "default", 400)
    own = [s for s in record["slices"] if s["status"] == "balloon"]
    assert own and all(len(s[k]) == 2 for s in own for k in ("theta0", "theta1", "length", "n_iter", "converged"))
    assert sum(record["slice_counts"].values()) == len(record["slices"])
    assert record["balloons"]["outer"]["theta0"] == [
        min(s["theta0"][0] for s in own),
        max(s["theta0"][0] for s in own),
    ]
    assert record["measures"]["score"]["dice"] > 0.85 and record["measures"]["score"]["overlap"] == 0
    assert set(record["measures"]["table3_voxels"]) == {"outer", "inner"}
    assert record["mesh"]["n_open_edges"] == 0
    assert record["implant"]["volume_cm3"] == pytest.approx(record["mesh"]["volume"] / 1000)
    assert record["implant"]["mass_g"]["PEEK"] == pytest.approx(record["implant"]["volume_cm3"] * 1.31)
    assert record["versions"]["numpy"] == np.__version__


def test_no_patient_text_and_no_path_leaves(done, home):
    headers = pydicom.dcmread(next((home / "ct").iterdir()), stop_before_pixels=True)
    secrets = [str(headers.PatientName), headers.PatientID, headers.StudyDate, headers.SeriesInstanceUID, str(home)]
    for name in ("design.json", "report.html"):
        text = (done / name).read_text()
        assert not [s for s in secrets if s in text]


def stored_as(kind: str, case: Case, folder: Path) -> tuple[Path, tuple[int, ...], np.ndarray]:
    """The case in one format with odd axes: path, stored shape, stored index -> RAS."""
    volume = Volume(case.hu, case.affine)
    if kind == "dicom":
        write_dicom(folder / "scan", case.hu, case.affine, orientation="sagittal", shuffle_names=True)
        load = read_ct(folder / "scan")[1]
        return folder / "scan", (44, 128, 128), FLIP @ load.stored_affine
    odd = volume.voxels.transpose(1, 0, 2)[:, ::-1]
    columns = volume.affine[:3, [1, 0, 2]] * [1, -1, 1]
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = columns, volume.affine[:3, 3] + volume.affine[:3, 0] * (odd.shape[1] - 1)
    if kind == "nifti":
        nibabel.save(nibabel.Nifti1Image(odd, FLIP @ affine), folder / "scan.nii.gz")
        return folder / "scan.nii.gz", odd.shape, FLIP @ affine
    header = {"space": "left-posterior-superior", "space directions": affine[:3, :3].T, "space origin": affine[:3, 3]}
    nrrd.write(str(folder / "scan.nrrd"), odd, header)
    return folder / "scan.nrrd", odd.shape, FLIP @ affine


@pytest.mark.parametrize("kind", ["dicom", "nifti", "nrrd"])
def test_patch_stands_on_the_inputs_own_grid(kind, case, paper, tmp_path):
    scan, shape, affine = stored_as(kind, case, tmp_path)
    result = cranio("design", scan, "--preset", "paper", "--out", tmp_path / "out")
    assert result.exit_code == 0, result.output
    image = nibabel.load(tmp_path / "out" / "patch.nii.gz")
    assert sorted(image.shape) == sorted(shape) and (kind == "dicom" or image.shape == shape)
    np.testing.assert_allclose(image.affine, affine, atol=1e-3)
    patch, _ = read_ct(tmp_path / "out" / "patch.nii.gz", mask=True)
    np.testing.assert_array_equal(patch.voxels, paper.prosthesis.patch.voxels)
    np.testing.assert_allclose(patch.affine, case.affine, atol=1e-3)


def test_paper_preset_params_and_planes(home, tmp_path):
    params = tmp_path / "params.json"
    params.write_text('{"n_snaxels": 31, "tol": 0.002}')
    arguments = ("--preset", "paper", "--params", params, "--planes", "10:20", "--out", tmp_path / "out")
    result = cranio("design", home / "ct", *arguments)
    assert result.exit_code == 0, result.output
    record = json.loads((tmp_path / "out" / "design.json").read_text())
    assert record["parameters"]["n_snaxels"] == 31 and record["parameters"]["tol"] == 0.002
    assert record["parameters"]["axial"] is True and record["preset"] == "paper"
    assert [o["planes"] for o in record["openings"]] == [[10, 20]]
    assert record["measures"]["score"] is None


@pytest.mark.parametrize(
    "content", ['{"snaxels": 3}', '{"n_snaxels": "many"}', '{"axial": 1}', "[1]", "{", None], ids=str
)
def test_bad_params_are_a_usage_error(content, home, tmp_path):
    params = tmp_path / "params.json"
    if content is not None:
        params.write_text(content)
    result = cranio("design", home / "ct", "--params", params, "--out", tmp_path / "out")
    assert result.exit_code == 2 and "--params" in result.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    "arguments", [(), ("--method", "magic"), ("--planes", "x"), ("--planes", "3"), ("--preset", "best")], ids=str
)
def test_usage_errors(arguments, home, tmp_path):
    out = ("--out", tmp_path / "out") if arguments else ()
    assert cranio("design", home / "ct", *arguments, *out).exit_code == 2
    assert cranio("design", home / "ct", "--out", home / "ct").exit_code == 2


def bad_folder(kind: str, case: Case, home: Path, folder: Path) -> Path:
    """An input that must be refused."""
    scan = folder / "scan"
    if kind in ("empty folder", "no CT", "MR"):
        scan.mkdir()
    if kind == "no CT":
        (scan / "notes.txt").write_text("nothing here")
    if kind == "MR":
        for path in sorted((home / "ct").iterdir()):
            ds = pydicom.dcmread(path)
            ds.Modality = "MR"
            ds.SOPClassUID = ds.file_meta.MediaStorageSOPClassUID = pydicom.uid.MRImageStorage
            ds.save_as(scan / path.name)
    if kind == "NaN":
        voxels = case.hu.astype(np.float32)
        voxels[20, 60, 60] = np.nan
        nibabel.save(nibabel.Nifti1Image(voxels, FLIP @ case.affine), folder / "scan.nii.gz")
        return folder / "scan.nii.gz"
    if kind == "hole leaves the image":
        middle = int(np.flatnonzero(case.implant.any(axis=(0, 2))).mean())
        part = Volume(case.hu, case.affine).crop(np.s_[:, middle:, :])
        write_nifti(part, folder / "scan.nii.gz")
        return folder / "scan.nii.gz"
    return scan


@pytest.mark.parametrize("kind", ["missing", "empty folder", "no CT", "MR", "NaN", "hole leaves the image"])
def test_refused_inputs_leave_no_trace(kind, case, home, tmp_path):
    scan = bad_folder(kind, case, home, tmp_path)
    before = digest(tmp_path)
    assert_refused(cranio("design", scan, "--preset", "paper", "--out", tmp_path / "new" / "out"), 3)
    assert digest(tmp_path) == before and not (tmp_path / "new").exists()


def test_skull_without_a_hole(closed_skull, tmp_path):
    assert_refused(cranio("design", closed_skull, "--out", tmp_path / "out"), 4, "no opening")
    assert list(tmp_path.iterdir()) == []
    result = cranio("inspect", closed_skull)
    assert result.exit_code == 4 and "bone mask" in result.stdout


def test_planes_without_an_opening(home, tmp_path):
    assert_refused(cranio("design", home / "ct", "--planes", "0:1", "--out", tmp_path / "out"), 4, "planes")
    assert_refused(cranio("design", home / "ct", "--planes", "5:500", "--out", tmp_path / "out"), 3)
    assert list(tmp_path.iterdir()) == []


def test_truth_on_another_grid_is_refused_before_any_work(case, home, tmp_path, monkeypatch):
    write_nifti(Volume(case.implant[:-1], case.affine), tmp_path / "truth.nii.gz")
    monkeypatch.setattr(preparation, "survey_scan", lambda *a: pytest.fail("work was done"))
    arguments = ("--truth", tmp_path / "truth.nii.gz", "--out", tmp_path / "out")
    assert_refused(cranio("design", home / "ct", *arguments), 3, "truth")
    assert not (tmp_path / "out").exists()


def test_prosthesis_that_the_image_would_cut_off_is_refused(case, tmp_path):
    apex = np.flatnonzero(case.implant.any(axis=(0, 1)))[-1]
    part = Volume(case.hu, case.affine).crop(np.s_[:, :, : apex - 1])
    write_nifti(part, tmp_path / "scan.nii.gz")
    arguments = ("--preset", "paper", "--out", tmp_path / "out")
    assert_refused(cranio("design", tmp_path / "scan.nii.gz", *arguments), 3, "edge of the image")
    assert not (tmp_path / "out").exists()


def test_threshold_of_a_mask_is_refused(closed_skull, tmp_path):
    assert_refused(cranio("design", closed_skull, "--threshold", "300", "--out", tmp_path / "out"), 3, "threshold")


@pytest.mark.parametrize("kind", ["a file", "below a file", "folder of that name"])
def test_unwritable_output_is_refused_before_any_work(kind, home, tmp_path, monkeypatch):
    monkeypatch.setattr(preparation, "read_ct", lambda *a, **k: pytest.fail("work was done"))
    blocker = tmp_path / "out"
    if kind == "folder of that name":
        (blocker / "design.json").mkdir(parents=True)
    else:
        blocker.write_text("mine")
    before = digest(tmp_path)
    assert_refused(cranio("design", home / "ct", "--out", blocker / "x" if kind == "below a file" else blocker), 5)
    assert digest(tmp_path) == before


def test_a_failure_while_writing_leaves_nothing(home, paper, tmp_path, monkeypatch):
    def full_disk(*_: object) -> None:
        raise OSError(28, "No space left on device")

    run_is(paper, monkeypatch)
    monkeypatch.setattr(design_folder.files, "write_text", full_disk)
    assert_refused(cranio("design", home / "ct", "--out", tmp_path / "new" / "out"), 5, "No space left")
    assert list(tmp_path.iterdir()) == []
    monkeypatch.undo()
    run_is(paper, monkeypatch)
    assert cranio("design", home / "ct", "--out", tmp_path / "old").exit_code == 0
    before = digest(tmp_path)
    monkeypatch.setattr(design_folder.files, "write_text", full_disk)
    assert cranio("design", home / "ct", "--out", tmp_path / "old").exit_code == 5
    assert digest(tmp_path) == before and {p.name for p in (tmp_path / "old").iterdir()} == OUTPUTS


def test_an_existing_folder_keeps_what_is_not_ours(home, paper, tmp_path, monkeypatch):
    run_is(paper, monkeypatch)
    (tmp_path / "notes.txt").write_text("mine")
    for _ in range(2):
        assert cranio("design", home / "ct", "--out", tmp_path).exit_code == 0
        assert {p.name for p in tmp_path.iterdir()} == OUTPUTS | {"notes.txt"}
        assert (tmp_path / "notes.txt").read_text() == "mine"
    (tmp_path / "design.json").write_text("mine, too")
    before = digest(tmp_path)
    assert_refused(cranio("design", home / "ct", "--out", tmp_path), 5, "design.json")
    assert digest(tmp_path) == before


@pytest.mark.real
def test_dry_skull_with_a_hole(real_data, tmp_path):
    source = real_data / "dicom" / "dryskull_multiseries"
    assert cranio("phantom", tmp_path / "case", "--from", source, "--defect", "parietal", "--seed", 1).exit_code == 0
    arguments = ("--truth", tmp_path / "case" / "truth.nii.gz", "--out", tmp_path / "out")
    result = cranio("design", tmp_path / "case" / "ct", *arguments)
    assert result.exit_code == 0, result.output
    measures = json.loads((tmp_path / "out" / "design.json").read_text())["measures"]
    assert measures["score"]["dice"] > 0.8 and measures["score"]["overlap"] == 0


@pytest.fixture(scope="module")
def doubted(tmp_path_factory):
    """A head with a hole at each side, and one more that a trace of bone makes doubtful."""
    case, folder = phantom_case("tiny", "multiple", 0), tmp_path_factory.mktemp("doubted")
    write_nifti(Volume(case.bone, case.affine), folder / "skull.nii.gz")
    return folder / "skull.nii.gz"


def doubt_the_smallest(monkeypatch):
    """Every opening but the two largest is in doubt."""

    def survey(*args, real=opening_search.survey_openings, **options):
        found = real(*args, **options)
        doubt = Verdict(False, 0.4, "It is in doubt.")
        return (*found[:2], *(replace(one, verdict=doubt) for one in found[2:]))

    monkeypatch.setattr(pipeline_survey, "survey_openings", survey)


def test_a_doubtful_opening_is_left_open_and_listed_everywhere(doubted, tmp_path, monkeypatch):
    doubt_the_smallest(monkeypatch)
    looked = json.loads(cranio("inspect", doubted, "--json").stdout)
    assert [one["number"] for one in looked["openings"]] == [1, 2]
    (listed,) = looked["left_open"]
    assert listed["number"] == 3 and listed["kind"] == "doubtful" and listed["confidence"] == 0.4
    table = cranio("inspect", doubted).stdout
    assert "doubtful (0.40)" in table and "cut (" in table
    result = cranio("design", doubted, "--method", "hull", "--out", tmp_path / "out")
    assert result.exit_code == 0, result.output
    record = json.loads((tmp_path / "out" / "design.json").read_text())
    assert record["openings"] == looked["openings"] and record["left_open"] == [listed]
    (finding,) = [one for one in record["findings"] if one["code"] == "DoubtfulOpening"]
    page = (tmp_path / "out" / "report.html").read_text()
    for text in (finding["message"], result.stdout, page):
        for part in ("pening 3", listed["place"], "confidence 0.40", "It is in doubt.", "--opening 3"):
            assert part in text
    assert "How openings are judged" in page and all(row[0].split(",")[0] in page for row in rule_rows())


def test_a_doubtful_opening_is_closed_when_it_is_chosen(doubted, tmp_path, monkeypatch):
    doubt_the_smallest(monkeypatch)
    result = cranio("design", doubted, "--method", "hull", "--opening", 3, "--out", tmp_path / "out")
    assert result.exit_code == 0, result.output
    record = json.loads((tmp_path / "out" / "design.json").read_text())
    assert [one["number"] for one in record["openings"]] == [3]
    assert [one["number"] for one in record["left_open"]] == [1, 2]
    assert {"ChosenOpening", "CutLeftOpen"} <= {one["code"] for one in record["findings"]}
    # where it is, and nowhere else
    closed = read_ct(tmp_path / "out" / "patch.nii.gz", mask=True)[0]
    middle = closed.to_world(np.argwhere(closed.voxels).mean(axis=0))
    assert np.linalg.norm(middle - record["openings"][0]["centre"]) < 5.0
    both = cranio("design", doubted, "--method", "hull", "--opening", 3, "--opening", 1, "--out", tmp_path / "two")
    assert both.exit_code == 0
    record = json.loads((tmp_path / "two" / "design.json").read_text())
    assert [one["number"] for one in record["openings"]] == [1, 3]


@pytest.mark.parametrize("command", [("design", "--method", "hull", "--out", "OUT"), ("compare", "--method", "hull")])
def test_a_number_that_no_opening_has_is_refused_with_the_list(command, doubted, tmp_path):
    name, *rest = [tmp_path / "out" if word == "OUT" else word for word in command]
    result = cranio(name, doubted, *rest, "--opening", 4)
    assert result.exit_code == 2 and not (tmp_path / "out").exists()
    for part in ("--opening", "no opening 4", "Opening 1 (", "Opening 2 (", "Opening 3 ("):
        assert part in result.stderr
    assert cranio(name, doubted, *rest, "--opening", 0).exit_code == 2


def test_only_doubtful_openings_are_listed_in_the_refusal(doubted, tmp_path, monkeypatch):
    doubt = Verdict(False, 0.4, "It is in doubt.")
    real = opening_search.survey_openings
    monkeypatch.setattr(
        pipeline_survey, "survey_openings", lambda *a, **o: tuple(replace(one, verdict=doubt) for one in real(*a, **o))
    )
    for command in (("inspect", doubted), ("design", doubted, "--out", tmp_path / "out")):
        result = cranio(*command)
        assert result.exit_code == 4 and "--opening 1" in result.stderr
        assert all(f"pening {n} (" in result.stderr for n in (1, 2, 3))

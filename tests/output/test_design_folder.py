"""A design saved is the design again, on the scan's own grid; all of its files or none."""

import json
import threading

import nibabel
import numpy as np
import pytest
import trimesh
from cli_runs import digest

from cranio_nb.errors import CannotWrite, InputRefused
from cranio_nb.methods.design import design
from cranio_nb.output import design_folder, design_pictures, files, painter
from cranio_nb.output.design_folder import made_record, run_and_draw, save
from cranio_nb.output.painter import Painter
from cranio_nb.output.staging import staged
from cranio_nb.pipeline.preparation import prepare
from cranio_nb.prosthesis import Prosthesis
from cranio_nb.readers import read_ct
from cranio_nb.volume import Volume
from data_synth.files import write_case

FLIP = np.diag([-1.0, -1.0, 1.0, 1.0])


@pytest.fixture(scope="module")
def made(skull, openings) -> Prosthesis:
    return design(skull(), openings(), method="hull")


@pytest.fixture(scope="module")
def without_patch(made) -> Prosthesis:
    return Prosthesis(made.mesh, made.sides, None, made.method, made.parameters, made.record)


def test_the_patch_reads_back_as_it_was(made, tmp_path):
    save(made, tmp_path / "out")
    patch, _ = read_ct(tmp_path / "out" / "patch.nii.gz", mask=True)
    np.testing.assert_array_equal(patch.voxels, made.patch.voxels)
    np.testing.assert_allclose(patch.affine, made.patch.affine, atol=1e-4)
    mesh = trimesh.load_mesh(tmp_path / "out" / "prosthesis.stl")
    assert mesh.is_volume and mesh.volume == pytest.approx(made.mesh.volume, rel=1e-5)


def test_the_paths_are_those_of_the_files(made, without_patch, tmp_path):
    paths = save(made, str(tmp_path / "a" / "b"))
    assert paths == [tmp_path / "a" / "b" / name for name in ("prosthesis.stl", "patch.nii.gz", "design.json")]
    assert {*paths, tmp_path / "a" / "b" / "manifest.json"} == set((tmp_path / "a" / "b").iterdir())
    assert [p.name for p in save(without_patch, tmp_path / "c")] == ["prosthesis.stl", "design.json"]
    assert {p.name for p in (tmp_path / "c").iterdir()} == {"prosthesis.stl", "design.json", "manifest.json"}


def test_with_the_report_the_voxels_are_on_the_scans_own_grid(phantom, tmp_path):
    case = phantom()
    stored = Volume(case.bone, case.affine).voxels.transpose(2, 0, 1)[:, ::-1]
    affine = np.eye(4)
    affine[:3, :3] = case.affine[:3, [2, 0, 1]] * [1, -1, 1]
    affine[:3, 3] = case.affine[:3, 3] + case.affine[:3, 0] * (case.bone.shape[0] - 1)
    nibabel.save(nibabel.Nifti1Image(stored.astype(np.uint8), FLIP @ affine), tmp_path / "skull.nii.gz")
    bone, report = read_ct(tmp_path / "skull.nii.gz")
    made = design(bone, method="hull")
    save(made, tmp_path / "out", report)
    image = nibabel.load(tmp_path / "out" / "patch.nii.gz")
    assert image.shape == stored.shape
    np.testing.assert_allclose(image.affine, FLIP @ affine, atol=1e-4)
    np.testing.assert_array_equal(read_ct(tmp_path / "out" / "patch.nii.gz", mask=True)[0].voxels, made.patch.voxels)
    record = json.loads((tmp_path / "out" / "design.json").read_text())
    assert record["load"]["shape"] == list(case.bone.shape) and record["load"]["source"] == "NIfTI"


def test_the_record_says_how_it_was_made(made, tmp_path):
    save(made, tmp_path)
    record = json.loads((tmp_path / "design.json").read_text(), parse_constant=pytest.fail)
    assert record["method"] == "hull" and record["load"] is None
    assert made.parameters.items() <= record["parameters"].items()
    assert record["mesh"]["volume"] == pytest.approx(made.mesh.volume) and record["mesh"]["n_open_edges"] == 0
    assert record["implant"]["volume_cm3"] == pytest.approx(made.mesh.volume / 1000)
    assert record["not_for_clinical_use"] is True and record["world"] == "DICOM LPS, mm"


def test_a_shape_of_no_method_of_ours_can_be_saved(made, tmp_path):
    own = Prosthesis(made.mesh, made.sides, made.patch, "by hand", {"thickness_mm": 4.0})
    save(own, tmp_path)
    record = json.loads((tmp_path / "design.json").read_text())
    assert (record["method"], record["parameters"]) == ("by hand", {"thickness_mm": 4.0})


@pytest.mark.parametrize("step", ["write_json", "write_text"])
def test_a_failure_leaves_an_older_design_as_it_was(step, made, without_patch, tmp_path, monkeypatch):
    save(without_patch, tmp_path / "old")
    before = digest(tmp_path)

    def full_disk(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(files, step, full_disk)
    for folder in ("old", "new"):
        with pytest.raises(CannotWrite, match="No space left"):
            save(made, tmp_path / folder)
    assert digest(tmp_path) == before and [p.name for p in tmp_path.iterdir()] == ["old"]


def test_a_mesh_that_is_no_solid_is_refused_and_leaves_nothing(made, tmp_path):
    torn = Prosthesis(type(made.mesh)(made.mesh.vertices, made.mesh.faces[1:]), made.sides[1:], made.patch, "hull")
    with pytest.raises(CannotWrite, match="not a solid"):
        save(torn, tmp_path / "out")
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_is_in_the_way_is_refused_before_the_mesh_is_checked(made, tmp_path, monkeypatch):
    monkeypatch.setattr(design_folder, "check_mesh", lambda mesh: pytest.fail("work was done"))
    (tmp_path / "design.json").mkdir()
    with pytest.raises(CannotWrite, match="in the way"):
        save(made, tmp_path)


def test_a_run_saved_by_name_is_what_the_run_writes(phantom, tmp_path):
    write_case(tmp_path, phantom())
    (tmp_path / "run").mkdir()
    with Painter() as painter:
        result, page = run_and_draw(painter, prepare(tmp_path / "ct"), method="hull")
        design_folder.write_outputs(result, tmp_path / "run", page)
    save(result.prosthesis, tmp_path / "saved", result.case.load)
    run, saved = digest(tmp_path / "run"), digest(tmp_path / "saved")
    assert set(run) ^ set(saved) == {"report.html", "manifest.json"}
    assert all(run[name] == saved[name] for name in ("prosthesis.stl", "patch.nii.gz"))
    records = [json.loads((tmp_path / name / "design.json").read_text()) for name in ("run", "saved")]
    assert all(records[0][key] == records[1][key] for key in made_record(result.prosthesis))


def test_pictures_that_cannot_be_drawn_leave_nothing_behind(phantom, tmp_path, monkeypatch):
    def fail(*_):
        raise MemoryError("no room for pictures")

    monkeypatch.setattr(design_pictures, "patch_shots", fail)
    monkeypatch.setattr(painter, "_PROGRAM", "raise SystemExit")
    write_case(tmp_path, phantom())
    with Painter() as one, pytest.raises(MemoryError, match="no room"), staged(tmp_path / "out") as part:
        result, page = run_and_draw(one, prepare(tmp_path / "ct"), method="hull")
        design_folder.write_outputs(result, part, page)
    assert not (tmp_path / "out").exists()


def test_a_refused_design_leaves_no_thread_behind(phantom, tmp_path):
    write_case(tmp_path, phantom())
    before = threading.active_count()
    with pytest.raises(InputRefused, match="sheet"), Painter() as painter:
        run_and_draw(painter, prepare(tmp_path / "ct"), method="sheet")
    assert threading.active_count() <= before

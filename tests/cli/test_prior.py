"""The command that learns a prior, and the one that takes it."""

import json

from cli_runs import assert_refused, cranio
from click.testing import CliRunner

from cranio_nb.cli.main import main
from cranio_nb.output.nifti_files import write_nifti
from cranio_nb.prior.file import load_prior, pack_prior


def test_a_folder_without_skulls_is_refused_and_nothing_is_written(tmp_path):
    (tmp_path / "notes.txt").write_text("about")
    assert_refused(cranio("prior", "learn", tmp_path, "--out", tmp_path / "prior.npz"), 3)
    assert [p.name for p in tmp_path.iterdir()] == ["notes.txt"]


def test_a_file_that_cannot_be_written_is_refused_before_any_work(tmp_path):
    (tmp_path / "prior.npz").mkdir()
    assert_refused(cranio("prior", "learn", tmp_path, "--out", tmp_path / "prior.npz"), 5)


def test_the_command_learns_from_a_folder(intact, skull, tmp_path):
    scans = tmp_path / "scans"
    scans.mkdir()
    for seed in (0, 1, 2):
        write_nifti(intact(seed), scans / f"head{seed}.nii.gz")
    write_nifti(skull("large", 3), scans / "open.nii.gz")
    (scans / "notes.txt").write_text("about")
    result = CliRunner().invoke(main, ["prior", "learn", str(scans), "--out", str(tmp_path / "prior.npz")])
    assert result.exit_code == 0, result.output
    assert "3 of 4 scans learned" in result.stdout and "Outer (mm)" in result.stdout
    assert result.stderr.startswith("skipped open.nii.gz: ") and result.stderr.count("\n") == 1
    assert len(load_prior(tmp_path / "prior.npz").radii) == 3


def test_the_command_takes_a_prior_for_the_plate_only(learned, skull, tmp_path):
    (tmp_path / "prior.npz").write_bytes(pack_prior(learned))
    write_nifti(skull("burr_hole"), tmp_path / "skull.nii.gz")
    wanted = ["design", str(tmp_path / "skull.nii.gz"), "--mask", "--prior", str(tmp_path / "prior.npz")]
    made = CliRunner().invoke(main, [*wanted, "--method", "thin-plate", "--out", str(tmp_path / "out")])
    assert made.exit_code == 0, made.output
    assert json.loads((tmp_path / "out" / "design.json").read_text())["parameters"]["prior"]
    refused = CliRunner().invoke(main, [*wanted, "--out", str(tmp_path / "other")])
    assert refused.exit_code != 0 and not (tmp_path / "other").exists()

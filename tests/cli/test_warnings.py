"""What a file warns of is said by every command that reads it, and names the file."""

import gzip
import json
import shutil

import pytest
from cli_runs import cranio

from cranio_nb.output.nifti_files import write_nifti
from cranio_nb.volume import Volume

LEFT = "The file holds more bytes than its header declares voxels"


@pytest.fixture(scope="module")
def padded(case, tmp_path_factory):
    """Masks of a skull with a hole, of what is missing and of the whole skull, each in a file with bytes left."""
    folder = tmp_path_factory.mktemp("padded")
    for name, voxels in (("skull", case.bone), ("truth", case.implant), ("whole", case.complete)):
        path = folder / f"{name}.nii.gz"
        write_nifti(Volume(voxels, case.affine), path)
        path.write_bytes(path.read_bytes() + gzip.compress(bytes(9)))
    return folder


def test_design_says_what_scan_and_truth_warn_of(padded, tmp_path):
    asked = ("--truth", padded / "truth.nii.gz", "--method", "hull", "--out", tmp_path / "out")
    said = cranio("design", padded / "skull.nii.gz", *asked).stdout
    assert f"warning: {LEFT}" in said and f"warning: The truth: {LEFT}" in said
    written = (tmp_path / "out" / "design.json").read_text(), (tmp_path / "out" / "report.html").read_text()
    assert all(text.count(LEFT) == 2 for text in written)


def test_compare_says_what_scan_and_truth_warn_of(padded, tmp_path):
    asked = ("--truth", padded / "truth.nii.gz", "--method", "hull", "--out", tmp_path / "out")
    said = cranio("compare", padded / "skull.nii.gz", *asked).stdout
    assert f"warning: {LEFT}" in said and f"warning: The truth: {LEFT}" in said
    assert (tmp_path / "out" / "comparison.html").read_text().count(LEFT) == 2


def test_score_says_what_each_file_warns_of_beside_the_numbers(padded):
    truth = padded / "truth.nii.gz"
    result = cranio("score", truth, truth, "--skull", padded / "skull.nii.gz", "--json")
    assert json.loads(result.stdout)["dice"] == 1
    assert [line.split(" The file")[0] for line in result.stderr.splitlines()] == [
        f"warning: The {what}:" for what in ("patch", "truth", "skull")
    ]


def test_what_is_cut_or_learned_from_says_what_it_warns_of(padded, tmp_path):
    whole = padded / "whole.nii.gz"
    made = cranio("phantom", tmp_path / "cut", "--from", whole, "--defect", "round")
    assert made.exit_code == 0 and made.stderr.startswith(f"warning: {LEFT}")
    (tmp_path / "scans").mkdir()
    shutil.copy(whole, tmp_path / "scans")
    learned = cranio("prior", "learn", tmp_path / "scans", "--out", tmp_path / "prior.npz")
    assert f"warning: whole.nii.gz: {LEFT}" in learned.stderr

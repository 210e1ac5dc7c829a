"""A case on disk, and runs of it that several commands' tests look at."""

from pathlib import Path

import pytest
from cli_runs import cranio, digest
from stand_ins import blind, compared_case, compared_home, found  # noqa: F401  (fixtures)

from cranio_nb.output.nifti_files import write_nifti
from cranio_nb.pipeline import preparation, run
from cranio_nb.volume import Volume
from data_synth import Case, phantom_case
from data_synth.files import write_case


@pytest.fixture(scope="session")
def case() -> Case:
    return phantom_case("tiny", "unilateral", 0)


@pytest.fixture(scope="session")
def home(tmp_path_factory, case) -> Path:
    folder = tmp_path_factory.mktemp("case")
    write_case(folder, case)
    return folder


@pytest.fixture(scope="session")
def done(home, tmp_path_factory) -> Path:
    """Folder of one run on DICOM with a truth; its inputs must be as before."""
    out = tmp_path_factory.mktemp("out") / "a" / "b"
    before = digest(home)
    result = cranio("design", home / "ct", "--truth", home / "truth.nii.gz", "--out", out)
    assert result.exit_code == 0, result.output
    assert "Dice" in result.stdout and str(out / "report.html") in result.stdout
    assert result.stderr == ""
    assert digest(home) == before
    return out


@pytest.fixture(scope="session")
def paper(home) -> run.RunResult:
    """The fast preset's result, also to stand in where only the writing is looked at."""
    return run.run_design(preparation.prepare(home / "ct"), preset="paper")


@pytest.fixture(scope="session")
def closed_skull(case, tmp_path_factory) -> Path:
    path = tmp_path_factory.mktemp("closed") / "skull.nii.gz"
    write_nifti(Volume(case.complete, case.affine), path)
    return path

"""Methods that stand in for the real ones: two that know the truth, and three that fail, each in its own way.

The fixtures are a case that they have closed, compared once; a conftest imports them.
"""

import types
from contextlib import contextmanager

import numpy as np
import pytest

from cranio_nb.errors import InputRefused, NoOpening
from cranio_nb.geometry.face_sides import label_faces
from cranio_nb.methods import catalogue
from cranio_nb.output.nifti_files import write_nifti
from cranio_nb.pipeline import compare, trial
from cranio_nb.pipeline.run import prepare
from cranio_nb.pipeline.trial import attempt, contenders
from cranio_nb.prosthesis import Prosthesis
from cranio_nb.stages.surface_reconstruction import extract_surface
from cranio_nb.volume import Volume
from data_synth import phantom_case


def from_truth(grow):
    """A method that knows the answer, and moves it `grow` planes up the head."""

    def design(bone, openings=None, *, progress=None):
        case = phantom_case("tiny", "round", 0)
        patch = np.roll(case.implant, grow, axis=0) & ~bone.voxels
        mesh = extract_surface(bone.with_voxels(patch))
        sides = label_faces(mesh, bone, openings[0].head_centre)
        return Prosthesis(mesh, sides, bone.with_voxels(patch), "stand-in", {}, {"version": "0", "seconds": 1.0})

    return design


def refusing(bone, openings=None, *, progress=None):
    raise InputRefused("CrossesMiddle", "The other side <is> open, too.", "Try another.")


def finding_nothing(bone, openings=None, *, progress=None):
    raise NoOpening("NothingBridged", "Nothing was bridged.")


def faulty(bone, openings=None, *, progress=None):
    raise IndexError("a secret")


STAND_INS = {
    "perfect": from_truth(0),
    "moved": from_truth(1),
    "refusing": refusing,
    "finding_nothing": finding_nothing,
    "faulty": faulty,
}


@contextmanager
def only_stand_ins():
    """Stand-ins in the catalogue, as if they were all the methods there are."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(catalogue, "import_module", lambda name: types.SimpleNamespace(design=STAND_INS[name]))
        patch.setattr(catalogue, "METHODS", names := {name: name for name in STAND_INS})
        patch.setattr(trial, "METHODS", names)
        yield


@pytest.fixture(scope="session")
def compared_home(tmp_path_factory):
    folder = tmp_path_factory.mktemp("case")
    case = phantom_case("tiny", "round", 0)
    write_nifti(Volume(case.bone, case.affine), folder / "skull.nii.gz")
    write_nifti(Volume(case.implant, case.affine), folder / "truth.nii.gz")
    return folder


@pytest.fixture(scope="session")
def compared_case(compared_home):
    return prepare(compared_home / "skull.nii.gz", truth=compared_home / "truth.nii.gz")


@pytest.fixture(scope="session")
def found(compared_case):
    with only_stand_ins():
        return compare.compare(compared_case, contenders(), attempt=attempt)


@pytest.fixture(scope="session")
def blind(compared_home):
    """Without a truth."""
    with only_stand_ins():
        asked = contenders(["moved", "refusing", "perfect"])
        return compare.compare(prepare(compared_home / "skull.nii.gz"), asked, attempt=attempt)

"""The tuner hands its parameters to the design, and starts at the defaults."""

import json

import cranio_nb as cn
from cranio_nb.methods.catalogue import check_options, default_options
from cranio_nb.teaching import widgets
from cranio_nb.teaching.widgets import tuning


def tuner_of(case):
    """The tuner of a phantom's bone mask."""
    return widgets.tuner(cn.Volume(case.bone, case.affine), cn.Volume(case.implant, case.affine))


def test_the_tuner_hands_its_parameters_to_the_design_command(static, phantom, tmp_path):
    panel = tuner_of(phantom()).set(slices=tuning.SLICES[0], reach_mm=20.0, own=True, pressure_mm=0.5)
    check_options("slicewise", panel.parameters)
    assert json.loads(panel.save(tmp_path / "p.json").read_text()) == panel.parameters
    assert panel.parameters["axial"] and panel.parameters["pressure_mm"] == 0.5
    case = phantom()
    bone = cn.Volume(case.bone, case.affine)
    made = cn.design(bone, **panel.parameters)
    dice = cn.score(made.patch, bone.with_voxels(case.implant), bone).dice
    assert panel.view.line.startswith(f"DSC {dice:.3f}")


def test_the_tuner_starts_at_the_defaults(static, phantom):
    wanted = default_options("slicewise")
    assert all(wanted[name] == value for name, value in tuner_of(phantom()).parameters.items())


def test_a_threshold_moves_the_bone_that_is_designed_on_and_is_no_option(static, phantom, ct):
    truth = cn.Volume(phantom().implant, ct.affine)
    panel = widgets.tuner(ct, truth).set(threshold_hu=700)
    assert set(panel.parameters) == set(tuner_of(phantom()).parameters)
    bone = cn.segment(ct, threshold=700)
    made = cn.design(bone, cn.find_openings(bone, scan=ct), **panel.parameters)
    assert panel.view.line.startswith(f"DSC {cn.score(made.patch, truth, bone).dice:.3f}")


def test_what_a_setting_makes_does_not_depend_on_what_was_shown_before(static, phantom):
    moved = tuner_of(phantom())
    for reach_mm in (6.0, 20.0, 10.0):
        moved.set(reach_mm=reach_mm)
    assert moved.view.line == tuner_of(phantom()).view.line

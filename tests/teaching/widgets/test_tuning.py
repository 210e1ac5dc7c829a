"""The tuner hands its parameters to the design, and starts at the defaults."""

import json

import cranio_nb as cn
from cranio_nb.methods.catalogue import check_options, default_options
from cranio_nb.teaching import widgets
from cranio_nb.teaching.widgets import tuning


def test_the_tuner_hands_its_parameters_to_the_design_command(static, phantom, tmp_path):
    panel = widgets.tuner(phantom()).set(slices=tuning.SLICES[0], reach=20.0, own=True, pressure=0.5)
    check_options("slicewise", panel.parameters)
    assert json.loads(panel.save(tmp_path / "p.json").read_text()) == panel.parameters
    assert panel.parameters["axial"] and panel.parameters["pressure"] == 0.5
    case = phantom()
    bone = cn.Volume(case.bone, case.affine)
    made = cn.design(bone, **panel.parameters)
    dice = cn.score(made.patch, bone.with_voxels(case.implant), bone).dice
    assert panel.view.line.startswith(f"DSC {dice:.3f}")


def test_the_tuner_starts_at_the_defaults(static, phantom):
    wanted = default_options("slicewise")
    assert all(wanted[name] == value for name, value in widgets.tuner(phantom()).parameters.items())

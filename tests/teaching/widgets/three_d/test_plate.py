"""The panel of the thin plate: held by nothing it errs most."""

from cranio_nb.teaching import widgets


def error_of(line):
    return float(line.split("rms ")[1].split(" mm")[0])


def test_a_plate_that_is_held_by_nothing_errs_most(static, skull, openings, true):
    panel = widgets.bent_plate(skull(), openings()[0], true)
    bent = error_of(panel.view.line)
    assert bent < 1.0 < error_of(panel.set(second_mm=0.0, third_mm=0.0, mirror_mm=0.0).view.line)

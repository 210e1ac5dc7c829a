"""All steps of a balloon, as the stage takes them."""

import numpy as np

from cranio_nb.teaching.widgets.inflation import PRESETS, record_inflation


def test_all_steps_are_kept_and_the_last_is_at_rest(arch):
    run = record_inflation(100.0, (0.5, 2.6), PRESETS[0], 0.062, 21, 1.0, 1.0, 1.0, 1e-3)
    assert run.converged and len(run.curves) == len(run.change) + 1
    np.testing.assert_allclose(np.linalg.norm(np.diff(run.curves, axis=0), axis=(1, 2)), run.change, rtol=1e-9)
    assert run.change[-1] <= 1e-3 < run.change[-2]


def test_a_spiral_between_equal_angles_is_an_arc_from_the_start():
    run = record_inflation(100.0, (0.5, np.pi - 0.5), PRESETS[2], 0.0, 41, 1.0, 1.0, 1.0, 1e-3)
    radius = 50 / np.sin(0.5)
    off = np.hypot(*(run.curves[0] - [50, -radius * np.cos(0.5)]).T) - radius
    assert np.abs(off).max() < 1e-6

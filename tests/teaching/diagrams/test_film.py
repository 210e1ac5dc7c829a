"""The film: it begins as the chord, shows the fast part in full, and ends where the balloon rests from any start."""

import numpy as np
import pytest

from cranio_nb.curves import cubic
from cranio_nb.stages.deformable_model import inflate, tangent_pressure
from cranio_nb.teaching.diagrams.film import caption, inflate_from_chord

LENGTH, ANGLES = 80.0, (0.25, np.pi - 0.35)


@pytest.fixture(scope="module")
def made():
    return inflate_from_chord(LENGTH, ANGLES)


def test_it_ends_where_the_balloon_rests_from_the_papers_start(made):
    slopes = LENGTH / 20 * np.array([[1.0, np.tan(t)] for t in ANGLES])
    k = tangent_pressure(LENGTH, *ANGLES, 21)
    rest = inflate(cubic(LENGTH, *ANGLES, 21), slopes, pressure=k, tol=1e-6).curve
    assert made.curves[-1] == pytest.approx(rest, abs=0.05)
    assert not made.curves[0, :, 1].any()


def test_the_first_steps_are_all_shown_and_the_last_is(made):
    assert made.shown[:6] == [0, 1, 2, 3, 4, 5] and made.shown[-1] == len(made.curves) - 1
    gaps = np.diff(made.shown)[:-1]
    assert (np.diff(gaps) >= 0).all() and gaps[-1] > 10


def test_the_caption_gives_step_and_energy(made):
    last = len(made.curves) - 1
    stretched, bent = ((np.diff(made.curves[-1], order, axis=0) ** 2).sum() / 2 for order in (1, 2))
    assert caption(made, last).startswith(f"step {last} of {last}: at rest")
    assert f"energy {stretched + bent:.1f} px" in caption(made, last)

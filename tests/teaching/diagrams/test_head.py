"""A drawn skull: what lies to the patient's left, front or top is drawn where the letters say."""

import numpy as np
import pytest
from hollow_ball import CENTRE, OUTER, ball

from cranio_nb.teaching.diagrams import marks
from cranio_nb.teaching.diagrams.head import draw_head


def test_places_are_drawn_to_scale_and_on_their_side():
    bone, _ = ball(np.array([1.0, 0.0, 0.0]))
    head = draw_head(marks.sheet(3.0), (0, 0, 0.5, 1), bone, (0.0, -1.0, 0.0))  # from the front
    middle, left, top = head.place(CENTRE + OUTER * np.array([[0, 0, 0], [1, 0, 0], [0, 0, 1]]))
    radius = OUTER / head.picture.frame.px_mm
    assert left - middle == pytest.approx([radius, 0.0], abs=1e-6) and top - middle == pytest.approx(
        [0.0, -radius], abs=1e-6
    )
    assert [text.get_text() for text in head.ax.texts] == ["L", "R", "S", "I"]

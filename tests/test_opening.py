"""Where an opening lies, from its sheet."""

import numpy as np

from cranio_nb.opening import Opening
from cranio_nb.volume import Volume


def test_planes_centre_and_direction_are_those_of_the_sheet():
    sheet = np.zeros((9, 8, 7), bool)
    sheet[3:6, 2:5, 4] = True
    affine = np.array([[0, 0, 0.5, -20], [0, 0.7, 0, 9], [3.0, 0, 0, 100], [0, 0, 0, 1]])
    head_centre = np.array([-18.0, 11.1, 60.0])
    opening = Opening(Volume(sheet, affine), head_centre)
    assert opening.planes == (3, 6)
    np.testing.assert_allclose(opening.centre, affine[:3] @ [4, 3, 4, 1])
    np.testing.assert_allclose(opening.direction, [0, 0, 1], atol=1e-12)

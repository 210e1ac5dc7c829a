"""The head's centre and axes, against the phantom's own."""

import numpy as np
import pytest

from cranio_nb.vault.orientation import head_axes, head_centre
from cranio_nb.volume import Volume
from data_synth.phantom import leaning


def test_the_centre_lies_on_the_heads_axis_85_mm_under_the_vertex(phantom, skull):
    case, centre = phantom("unilateral"), head_centre(skull("unilateral"))
    top = case.head.centre[2] + float(case.head.outer_radius([0.0, 0.0, 1.0]))
    assert centre[2] == pytest.approx(top - 85, abs=4.0)  # planes are 3 mm apart
    np.testing.assert_allclose(centre[:2], case.head.centre[:2], atol=5.0)


@pytest.mark.parametrize("tilt", [-25.0, 0.0, 20.0])
def test_the_axes_are_orthonormal_and_a_tilted_gantry_leans_only_the_planes(tilt, skull):
    upright = skull("unilateral")
    axes = head_axes(Volume(upright.voxels, leaning(upright.affine, tilt)))
    np.testing.assert_allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    turned = Volume(upright.voxels, leaning(upright.affine, tilt)).axes
    np.testing.assert_allclose(axes[:2], turned[[2, 1]], atol=1e-12)
    assert axes[2] @ turned[0] > np.cos(np.radians(abs(tilt) + 0.1))

"""Points of a hollow ball along rays from its centre, and how much of a vault they cover."""

import numpy as np

from cranio_nb.prior.mean_frame import MeanFrame, even_directions
from cranio_nb.prior.skull_points import measure_outline, sample_surface, vault_in_image
from cranio_nb.vault.orientation import head_axes
from cranio_nb.volume import Volume


def test_the_outline_of_a_hollow_ball_is_its_two_radii():
    n, step, centre = 101, 2.0, np.array([30.0, -40.0, 800.0])
    affine = np.array([[0, 0, step, 0], [0, step, 0, 0], [step, 0, 0, 0], [0, 0, 0, 1.0]])
    affine[:3, 3] = centre - step * (n - 1) / 2
    radius = step * np.linalg.norm(np.indices((n, n, n)) - (n - 1) / 2, axis=0)
    ball = Volume((radius > 70) & (radius < 80), affine)
    directions = even_directions(3)
    outer, inner = measure_outline(ball, MeanFrame(np.eye(3), centre), directions)
    assert np.isfinite(outer[directions[:, 2] > 0]).all() and np.isnan(outer[directions[:, 2] < -0.5]).all()
    assert np.nanmax(np.abs(outer - 80)) < step and np.nanmax(np.abs(inner - 70)) < step
    # in a frame twice as large the same ball has half the radius
    larger, _ = measure_outline(ball, MeanFrame(2 * np.eye(3), centre), directions)
    assert np.nanmax(np.abs(larger - 40)) < step


def test_points_lie_on_the_phantom(phantom, intact):
    head, points = phantom("round", 1).head, sample_surface(intact(1), head_axes(intact(1)))
    p = points.centre + points.outer @ points.axes.T - head.centre
    away = np.linalg.norm(p, axis=1)
    assert np.median(np.abs(away - head.outer_radius(p / away[:, None]))) < 1.5


def test_a_head_in_the_image_is_all_there_open_or_closed_and_a_cropped_one_is_not(intact, skull):
    assert vault_in_image(intact(0)) == vault_in_image(skull("large", 0)) == 1.0
    whole = intact(0)
    middle = whole.shape[2] // 2
    # the head reaches over the middle by far: the image holds about half of it
    assert 0.3 < vault_in_image(whole.crop((slice(None), slice(None), slice(middle)))) < 0.8

"""The flat fill between guiding points, and the membranes it is made of."""

import json

import numpy as np
import pytest

from cranio_nb.errors import InputRefused
from cranio_nb.evaluation import scores
from cranio_nb.geometry.mesh_check import check_mesh
from cranio_nb.mesh import Mesh
from cranio_nb.methods.design import assemble, design
from cranio_nb.methods.you import method as you
from cranio_nb.methods.you.method import membrane
from cranio_nb.opening import Opening
from cranio_nb.vault import radius_measurement
from cranio_nb.volume import Volume

UP = np.array([0.0, 0.0, 1.0])


def circle(radius, n, height=0.0, start=0.0):
    turn = np.linspace(0, 2 * np.pi, n, endpoint=False) + start
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.full(n, height)])


def rim(points):
    return membrane.Loop(points, np.arange(len(points)) * 12 / len(points), 12.0)


@pytest.fixture(scope="module")
def dome():
    """A spherical shell, radii 54 and 60 mm, with a round hole at its top whose rim stands 8 mm below the apex."""
    voxels = np.indices((64, 132, 132)) - np.array([0.0, 66, 66])[:, None, None, None]
    radius = np.sqrt((voxels**2).sum(axis=0))
    across = np.hypot(voxels[1], voxels[2])
    shell = (radius <= 60) & (radius >= 54)
    hole = across < np.sqrt(60**2 - 52**2) * radius / 60
    affine = np.array([[0, 0, 1.0, -66], [0, 1.0, 0, -66], [1.0, 0, 0, 0], [0, 0, 0, 1]])
    bone = Volume(shell & ~hole, affine)
    return bone, Opening(Volume(shell & hole & (radius > 56) & (radius < 58), affine), np.zeros(3))


@pytest.fixture(scope="module")
def filling(dome):
    bone, one = dome
    guides = circle(np.sqrt(60**2 - 51.5**2), 12, height=51.5)
    return you.fill_between(bone, one, guides)


def test_the_fill_of_a_plane_rim_is_plane():
    made = membrane.span(circle(10, 60, height=3.0), UP, 1.0)
    np.testing.assert_allclose(made.mesh.vertices[:, 2], 3.0, atol=1e-9)
    assert made.converged and made.areas[-1] == pytest.approx(30 * 100 * np.sin(np.pi / 30))  # of the 60-gon
    assert made.mesh.normals[:, 2] == pytest.approx(1.0)


def test_the_fill_has_a_triangle_edge_on_every_edge_of_the_rim_and_no_others():
    made = membrane.span(circle(10, 60), UP, 1.0)
    edges = made.mesh.faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    keys, count = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    assert len(keys[count == 1]) == 60 and count.max() == 2


def test_the_area_never_rises_and_ends_at_scherks_surface():
    """cos(x) e^z = cos(y) is minimal (Scherk 1834)."""
    side = np.linspace(-1.2, 1.2, 49)[:-1]
    square = np.concatenate(
        [
            np.column_stack(p)
            for p in (
                (side, np.full(48, -1.2)),
                (np.full(48, 1.2), side),
                (-side, np.full(48, 1.2)),
                (np.full(48, -1.2), -side),
            )
        ]
    )
    loop = np.column_stack([square, np.log(np.cos(square[:, 1]) / np.cos(square[:, 0]))])
    made = membrane.span(loop, UP, 0.05, tol=1e-5, max_iter=100)
    x, y, z = made.mesh.vertices.T
    assert made.converged and (np.diff(made.areas) <= 1e-9).all() and made.areas[-1] < made.areas[0] - 1e-3
    np.testing.assert_allclose(z, np.log(np.cos(y) / np.cos(x)), atol=5e-3)


def test_two_fills_and_their_wall_are_a_solid():
    for n, m in ((60, 60), (60, 41), (37, 52)):
        rims = [rim(circle(10, n, height=4.0)), rim(circle(8, m, start=0.02))]
        fills = [membrane.span(r.points, UP, 1.0) for r in rims]
        mesh = membrane.stitched(*fills, *rims)
        report = check_mesh(mesh)
        assert report.sound and report.n_parts == 1
        assert mesh.volume == pytest.approx(np.pi * 4 / 3 * (100 + 80 + 64), rel=0.02)  # a frustum


def test_even_steps_keep_a_circle_and_its_stations():
    loop = membrane.even(rim(circle(20, 500)), 1.0, 0.5)
    np.testing.assert_allclose(np.linalg.norm(loop.points, axis=1), 20, atol=0.02)
    turn = np.arctan2(loop.points[:, 1], loop.points[:, 0]) % (2 * np.pi)
    ahead = (loop.stations - turn * 12 / (2 * np.pi) + 6) % 12 - 6
    np.testing.assert_allclose(ahead, 0, atol=0.03)
    assert (np.diff(loop.stations) > 0).all()


def test_a_rim_that_crosses_itself_is_refused():
    turn = np.linspace(0, 2 * np.pi, 80, endpoint=False)
    eight = np.column_stack([10 * np.sin(turn), 5 * np.sin(2 * turn), 0 * turn])
    with pytest.raises(InputRefused) as refused:
        membrane.span(eight, UP, 0.5)
    assert refused.value.code == "TangledRim"


def test_detours_are_left_out_of_a_way():
    assert you._without_detours([0, 1, 2, 3, 2, 4, 5]).tolist() == [0, 1, 2, 5, 6]
    assert you._without_detours([0, 1, 2, 3, 4, 5, 1]).tolist() == [1, 2, 3, 4, 5]  # a spur at the start


def test_over_a_cap_the_fill_lies_half_the_caps_height_too_deep(filling):
    """The planar bias: a flat fill over a cap of height h is off by h / 2 in the mean and h at most."""
    fill = filling.outer.mesh
    height = 60 - filling.outer_rim.points[:, 2].mean()
    areas = fill.areas
    depth = 60 - np.linalg.norm(fill.centres, axis=1)
    assert height == pytest.approx(8.5, abs=1.0)
    assert (areas @ depth) / areas.sum() == pytest.approx(height / 2, rel=0.08)
    assert depth.max() == pytest.approx(height, rel=0.08)


def test_the_solid_is_sound_and_its_rims_lie_on_the_bones_edge(filling):
    assert check_mesh(filling.solid).sound
    outer, inner = (np.linalg.norm(r.points, axis=1) for r in (filling.outer_rim, filling.inner_rim))
    assert np.abs(outer - 60).max() < 1.5 and np.abs(inner - 54).max() < 1.5
    assert len(filling.guides) == len(filling.partners) == 12


def test_guides_in_either_sense_give_the_same_rim(dome, filling):
    bone, one = dome
    turned = you.fill_between(bone, one, filling.guides[::-1])
    assert turned.solid.volume == pytest.approx(filling.solid.volume, rel=0.02)


def test_picked_guides_make_a_prosthesis(skull, openings, phantom):
    bone, found = skull("round"), openings("round")
    guides = [you.find_guides(radius_measurement.measure_around(bone, one), 9) for one in found]
    made = assemble(bone, found, you.between_guides(bone, found, guides), method="you", parameters={"smooth": True})
    json.dumps(made.record, allow_nan=False)
    same = design(bone, found, n_guides=9, method="you")
    np.testing.assert_array_equal(made.patch.voxels, same.patch.voxels)
    assert scores.dice(made.patch, Volume(phantom("round").implant, bone.affine)) > 0.5


def test_too_few_guides_are_refused(dome):
    bone, one = dome
    with pytest.raises(InputRefused) as refused:
        you.fill_between(bone, one, np.zeros((2, 3)))
    assert refused.value.code == "TooFewGuides"


def test_a_membrane_needs_no_points_inside():
    made = membrane.span(circle(1.0, 8), UP, 5.0)
    assert isinstance(made.mesh, Mesh) and len(made.mesh.vertices) == 8 and made.converged

"""Scenes: a picture everywhere, a live scene or a page where there is a front end; sizes and refusals."""

import io
import os
import subprocess
import sys

import numpy as np
import pytest
from PIL import Image
from shapes import cube

from cranio_nb.drawing import scene3d
from cranio_nb.drawing.palette import BLUE, rgb_of
from cranio_nb.errors import InputRefused
from cranio_nb.mesh import Mesh

ALT = "A cube before a larger one."


@pytest.fixture
def static(monkeypatch):
    monkeypatch.setenv("CRANIO_NB_MODE", "static")


def test_a_static_scene_is_a_picture_with_words(static):
    scene = scene3d.show_meshes(cube(40), cube(10, (30, 0, 0)), labels=["large", "small"], alt=ALT)
    data, metadata = scene._repr_mimebundle_()
    assert set(data) == {"image/png", "text/plain"} and metadata["image/png"]["alt"] == ALT
    assert data["text/plain"] == "3-D scene: large, small (24 triangles)."
    assert Image.open(io.BytesIO(data["image/png"])).size == scene.picture.shape[1::-1]


def test_a_face_covers_as_many_pixels_as_its_size_says(static):
    scene = scene3d.show_meshes(cube(40), alt=ALT, towards=(0, -1, 0))
    blue = np.array(rgb_of(BLUE), float)
    share = scene.picture @ blue / np.linalg.norm(scene.picture, axis=2).clip(1) / np.linalg.norm(blue)
    rows, cols = np.nonzero(share > 0.995)
    assert np.ptp(rows) == pytest.approx(400, abs=3) and np.ptp(cols) == pytest.approx(400, abs=3)


def test_the_last_mesh_is_seen_in_front(static):
    scene = scene3d.show_meshes(cube(40), cube(10, (30, 0, 0)), alt=ALT)
    assert scene.towards @ [1, 0, 0] > 0.9


def test_scalars_run_from_dark_to_yellow(static):
    mesh = cube(40)
    scene = scene3d.show_meshes(mesh, alt=ALT, scalars=[mesh.vertices[:, 0] + 20], towards=(0, -1, 0))
    body = scene.picture[150:350]
    left, right = body[:, 140].mean(axis=0), body[:, 500].mean(axis=0)
    assert left[2] > left[0] and right[0] > right[2] + 60


@pytest.mark.parametrize("wrong", [{"colours": [BLUE]}, {"labels": ["a"]}, {"scalars": [np.zeros(3), None]}])
def test_lists_that_do_not_fit_are_refused(wrong):
    with pytest.raises(InputRefused):
        scene3d.show_meshes(cube(40), cube(10), alt=ALT, **wrong)


def test_nothing_to_show_is_refused():
    with pytest.raises(InputRefused, match="no mesh"):
        scene3d.show_meshes(Mesh(np.zeros((0, 3)), np.zeros((0, 3), int)), alt=ALT)


def test_without_pyvista_there_is_a_picture_and_a_sentence(monkeypatch):
    monkeypatch.setenv("CRANIO_NB_MODE", "widget")
    monkeypatch.setattr(scene3d, "find_spec", lambda name: None)
    data, _ = scene3d.show_meshes(cube(40), alt=ALT)._repr_mimebundle_()
    assert set(data) == {"image/png", "text/plain"} and "cranio-nb[view]" in data["text/plain"]


REMOTE = """
import numpy as np, sys
from cranio_nb.drawing import scene3d
from cranio_nb.mesh import Mesh
n = 400
r, c = np.mgrid[0:n, 0:n]
points = np.column_stack([r.ravel(), c.ravel(), 20 * np.sin(r.ravel() / 30)]).astype(float)
at = (r[:-1, :-1] * n + c[:-1, :-1]).ravel()
faces = np.concatenate([np.column_stack([at, at + 1, at + n]), np.column_stack([at + 1, at + n + 1, at + n])])
scene = scene3d.show_meshes(Mesh(points, faces), alt="Waves <&>.")
assert scene3d.plotter(scene).meshes[0].n_cells <= scene3d.MAX_FACES
data, _ = scene._repr_mimebundle_()
assert '<iframe title="Waves &lt;&amp;&gt;."' in data["text/html"] and "image/png" in data
print(len(data["text/html"]))
"""


def test_behind_a_proxy_the_scene_is_a_page_of_its_own_and_needs_no_opengl():
    pytest.importorskip("trame_pyvista")
    place = os.environ | {"CRANIO_NB_MODE": "widget", "JUPYTERHUB_USER": "student"}
    done = subprocess.run([sys.executable, "-c", REMOTE], env=place, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr[-2000:]
    assert 5e5 < int(done.stdout.split()[-1]) < 5e6


def test_faces_that_thinning_folded_are_turned_outwards():
    mesh = cube(40)
    folded = Mesh(mesh.vertices, np.concatenate([mesh.faces[:2, ::-1], mesh.faces[2:]]))
    assert (scene3d._turned_outwards(folded, mesh.vertex_normals) == mesh.faces).all()


MARKS = """
import numpy as np
from cranio_nb.drawing import scene3d
from cranio_nb.mesh import Mesh
corners = np.array([[-45.0, 0, 0], [45, 0, 0], [0, 60, 0], [0, 0, 60]])
scene = scene3d.show_meshes(Mesh(corners, np.array([[0, 1, 2], [0, 1, 3]])), alt="Two faces.", towards=(1, 0, 0))
bar, *letters = (np.asarray(mark.points) for mark in scene3d._marks(scene))
print(np.ptp(bar, axis=0).argmax(), round(float(np.ptp(bar, axis=0).max())), len(letters))
print(*(round(float(letter[:, 0].mean())) for letter in letters))
"""


def test_a_bar_and_the_letters_beside_the_line_of_sight_lie_in_the_scene():
    pytest.importorskip("pyvista")
    done = subprocess.run([sys.executable, "-c", MARKS], capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr[-2000:]
    # seen from the left: the bar runs along y, 20 mm; A, P, S and I stand in the plane of the middle
    assert done.stdout.split() == ["1", "20", "4", "0", "0", "0", "0"]

"""Meshes -> a scene to turn in a notebook, or a picture of it. The only importer of pyvista.

Frame: world mm (LPS). Where the browser runs on this machine the scene is live and drawn by the browser; behind a
proxy or a remote front end it is a page of its own inside the notebook; in static mode, and without pyvista, it is a
picture by the package's own renderer. None of them needs OpenGL on the kernel's side, whose absence would end the
kernel without a word.
"""

from __future__ import annotations

import html
import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from importlib.util import find_spec
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import InputRefused
from ..mesh import Mesh
from ..prosthesis import Prosthesis
from ..volume import Volume
from .canvas import BLUE, GREEN, GREY, ORANGE, PURPLE, RGB, SKY, Canvas, rgb_of, round_length
from .described import Bundle, bundle, encoded_png
from .figures import colour_scale
from .front_end import is_local, mode
from .shading import Solid, render, skull_surface, view_axes

MAX_FACES = 150_000
"""Most faces that a browser is given live; a page of its own holds fewer."""
_PAGE_FACES = 60_000
COLOURS = ("#EDE7D8", BLUE, ORANGE, GREEN, SKY, PURPLE)
_WIDTH, _HEIGHT, _BAR = 640, 480, 56  # px of a picture, and of the scale below it
_NO_PYVISTA = 'Install "cranio-nb[view]" to turn the scene; this is a picture of it.'


def show(bone: Volume, made: Prosthesis) -> Scene:
    """Show a skull with what closes its openings.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    made : Prosthesis

    Returns
    -------
    Scene
        Displays itself: a scene to turn where the notebook allows it, else a picture.

    Examples
    --------
    >>> from cranio_nb.stages.surface_reconstruction import extract_surface
    >>> cube = np.zeros((12, 12, 12), bool)
    >>> cube[4:8, 4:8, 4:8] = True
    >>> skull, patch = Volume(~cube, np.eye(4)), Volume(cube, np.eye(4))
    >>> made = Prosthesis(extract_surface(patch), np.zeros(0, np.uint8), patch, "by hand")
    >>> show(skull, made).line  # doctest: +ELLIPSIS
    '3-D scene: skull, prosthesis (by hand) (...'
    """
    alt = f"The skull in ivory and the prosthesis of the method {made.method} in blue, seen from outside the opening."
    return show_meshes(skull_surface(bone), made.mesh, alt=alt, labels=("skull", f"prosthesis ({made.method})"))


def show_meshes(
    *meshes: Mesh,
    alt: str,
    colours: Sequence[str] | None = None,
    labels: Sequence[str] | None = None,
    scalars: Sequence[NDArray | None] | None = None,
    unit: str = "mm",
    towards: ArrayLike | None = None,
) -> Scene:
    """Show meshes in one scene.

    Parameters
    ----------
    *meshes : Mesh
        The skull first, then what stands in it.
    alt : str
        What is to be seen, for those who cannot see it.
    colours : sequence of str, optional
        "#RRGGBB" for each mesh.
    labels : sequence of str, optional
        Name of each mesh.
    scalars : sequence of ndarray, shape (V,), or None, optional
        For each mesh a number at each vertex that gives its colour instead, or None.
    unit : str
        Of the scalars.
    towards : array_like, shape (3,), optional
        From the scene to the viewer, LPS; by default from the middle of the first mesh past the last one.

    Returns
    -------
    Scene
        Displays itself.

    Raises
    ------
    InputRefused
        ``EmptyMesh`` when there is nothing to show, ``BadScene`` when a list does not fit the meshes.
    """
    drawn = [mesh for mesh in meshes if len(mesh.faces)]
    if not drawn:
        raise InputRefused("EmptyMesh", "There is no mesh with faces to show.")
    n = len(meshes)
    palette = tuple(COLOURS[i % len(COLOURS)] for i in range(n)) if n > 1 else (COLOURS[1],)
    parts = []
    for name, given in (("colours", colours), ("labels", labels), ("scalars", scalars)):
        if given is not None and len(given) != n:
            raise InputRefused("BadScene", f"{n} meshes were given {len(given)} {name}.", "Give one for each mesh.")
    for i, mesh in enumerate(meshes):
        values = None if scalars is None else scalars[i]
        if values is not None and np.shape(values) != (len(mesh.vertices),):
            raise InputRefused("BadScene", f"Scalars of shape {np.shape(values)} for {len(mesh.vertices)} vertices.")
        parts.append(Part(mesh, (colours or palette)[i], labels[i] if labels else "", values))
    return Scene(tuple(p for p in parts if len(p.mesh.faces)), alt, unit, _towards(drawn, towards))


@dataclass(frozen=True, eq=False)
class Part:
    """A mesh of a scene, its colour and name, and numbers at its vertices or None."""

    mesh: Mesh
    colour: str
    label: str
    values: NDArray | None


@dataclass(frozen=True, eq=False)
class Scene:
    """Meshes to look at; displays itself as fits where it runs.

    Parameters
    ----------
    parts : tuple of Part
    alt : str
    unit : str
        Of the parts' values.
    towards : ndarray, shape (3,)
        From the scene to the viewer.
    """

    parts: tuple[Part, ...]
    alt: str
    unit: str
    towards: NDArray[np.float64]

    @property
    def top(self) -> float | None:
        """Upper end of the colour scale: the 99th percentile, rounded; None without values."""
        values = [part.values for part in self.parts if part.values is not None]
        return max(float(np.percentile(np.concatenate(values), 99)), 1e-3) if values else None

    @cached_property
    def picture(self) -> RGB:
        """The scene as pixels, shape (H, W, 3)."""
        return picture(self)

    @cached_property
    def line(self) -> str:
        """One line for where there is only text."""
        faces = sum(len(part.mesh.faces) for part in self.parts)
        names = ", ".join(part.label for part in self.parts if part.label)
        return f"3-D scene{': ' + names if names else ''} ({faces} triangles)."

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> Bundle:
        data, metadata = bundle(encoded_png(self.picture), self.alt, self.line)
        if mode() == "static":
            return data, metadata
        if not (find_spec("pyvista") and find_spec("trame_pyvista")):
            return data | {"text/plain": f"{self.line} {_NO_PYVISTA}"}, metadata
        live = self.viewer._repr_mimebundle_() if is_local() else {"text/html": self.page}
        return data | live | {"text/plain": self.line}, metadata

    @cached_property
    def viewer(self) -> Any:
        """A live scene, drawn by the browser and fed by this kernel."""
        return plotter(self).show(jupyter_backend="client", return_viewer=True)

    @cached_property
    def page(self) -> str:
        """The scene as HTML that needs no kernel and no network."""
        inner = html.escape(plotter(self, _PAGE_FACES).trame.export_html(None).getvalue(), quote=True)
        title = html.escape(self.alt, quote=True)
        return f'<iframe title="{title}" srcdoc="{inner}" style="width:100%;height:{_HEIGHT}px;border:0"></iframe>'


def plotter(scene: Scene, max_faces: int = MAX_FACES) -> Any:
    """The scene in pyvista, its large meshes thinned out; nothing is rendered on this side."""
    os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkOSOpenGLRenderWindow")
    sys.modules.setdefault("trame.widgets.vtklocal", None)  # type: ignore[arg-type]  # or it looks for a download
    import pyvista as pv  # noqa: TID251  (this is the module that may)
    import trame_pyvista  # noqa: F401  (else "client" means another mode)

    made = pv.Plotter(notebook=True, window_size=[_WIDTH, _HEIGHT])
    made.suppress_rendering = True
    budget = max_faces // len(scene.parts)  # faces of each part
    for part in scene.parts:
        values = np.zeros(len(part.mesh.vertices)) if part.values is None else part.values
        mesh, carried = thinned(part.mesh, np.column_stack([part.mesh.vertex_normals, values]), budget)
        surface = pv.PolyData.from_regular_faces(mesh.vertices, mesh.faces.astype(int))
        # the normals of the full mesh: those of the thinned one turn black where two of its faces fold together
        surface.point_data.active_normals = carried[:, :3]
        if part.values is not None:
            surface["values"] = carried[:, 3]
        made.add_mesh(surface, name=part.label or None, smooth_shading=True, **_look(part, scene))
    made.camera_position = _camera(scene)
    return made


def thinned(mesh: Mesh, carried: NDArray, max_faces: int) -> tuple[Mesh, NDArray[np.float64]]:
    """A mesh with at most so many faces, for the eye only: the vertices of each cell of a grid become one.

    Parameters
    ----------
    mesh : Mesh
    carried : ndarray, shape (V, K)
        Numbers at its vertices, averaged with them.
    max_faces : int

    Notes
    -----
    Vertex clustering after Rossignac and Borrel 1993. Quadric decimation keeps shapes better, but can take a minute.
    """
    cell = np.sqrt(2 * mesh.areas.sum() / max_faces)
    points, faces = np.column_stack([mesh.vertices, carried]), mesh.faces
    while len(faces) > max_faces:
        _, group, sizes = np.unique(np.floor(points[:, :3] / cell), axis=0, return_inverse=True, return_counts=True)
        points = np.column_stack([np.bincount(group.ravel(), column) / sizes for column in points.T])
        faces = group.ravel()[faces]
        faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
        cell *= 1.15
    return Mesh(points[:, :3], faces), points[:, 3:]


def _look(part: Part, scene: Scene) -> dict[str, Any]:
    """How pyvista colours a part. Colours are floats: whole numbers come out dark."""
    if part.values is None:
        return {"color": tuple(v / 255.0 for v in rgb_of(part.colour))}
    bar = {"title": scene.unit}
    return {"scalars": "values", "cmap": "cividis", "clim": (0.0, scene.top), "scalar_bar_args": bar}


def _camera(scene: Scene) -> list[tuple[float, ...]]:
    """Position, focal point and up for a view of the whole scene."""
    low, high = _bounds([part.mesh for part in scene.parts])
    middle = (low + high) / 2
    up = (0.0, 0.0, 1.0) if abs(scene.towards[2]) < 0.95 else (0.0, -1.0, 0.0)
    place = middle + 1.6 * np.linalg.norm(high - low) * scene.towards
    return [tuple(place.tolist()), tuple(middle.tolist()), up]


def picture(scene: Scene) -> RGB:
    """Draw a scene without OpenGL, shape (H, W, 3): names of the parts, a length, a colour scale."""
    px = _pixel(scene)
    solids = [Solid(part.mesh, _vertex_colours(part, scene.top)) for part in scene.parts]
    seen = (255 * render(solids, scene.towards, px=px).rgb).astype(np.uint8)
    tall, wide = seen.shape[:2]
    named = [(part.colour, "area", part.label) for part in scene.parts if part.label and part.values is None]
    width = max(_WIDTH, wide + 20)
    canvas = Canvas(width, tall + 40 + (_BAR if scene.top else 0))
    canvas.place(seen, (width - wide) / 2, 10)
    if named:
        canvas.legend(6, 6, named)
    length = round_length(0.2 * wide * px)
    canvas.scale_bar(14, tall + 28, length / px, f"{length:g} mm")
    if scene.top:
        _colour_bar(canvas, (width / 2 - 140, tall + 44), scene)
    return canvas.array()


def _pixel(scene: Scene) -> float:
    """Mm per px at which the scene just fits its picture."""
    flat = np.concatenate([part.mesh.vertices for part in scene.parts]) @ view_axes(scene.towards)[:2].T
    return float((np.ptp(flat, axis=0) / (_WIDTH - 40, _HEIGHT - 80)).max())


def _colour_bar(canvas: Canvas, at: tuple[float, float], scene: Scene) -> None:
    top = scene.top or 1.0
    ramp = colour_scale(top).to_rgba(np.linspace(0, top, 280), bytes=True)[:, :3]
    canvas.place(np.broadcast_to(ramp, (14, 280, 3)).copy(), *at)
    for share, sign, anchor in ((0.0, "", "la"), (0.5, "", "ma"), (1.0, "\N{GREATER-THAN OR EQUAL TO} ", "ra")):
        text = f"{sign}{share * top:.2g} {scene.unit}"
        canvas.text(at[0] + 280 * share, at[1] + 19, text, size=12, colour=GREY, anchor=anchor)


def _vertex_colours(part: Part, top: float | None) -> NDArray[np.float64]:
    """RGB, 0 to 1, shape (3,) or (V, 3)."""
    if part.values is None or top is None:
        return np.array(rgb_of(part.colour)) / 255
    return colour_scale(top).to_rgba(np.asarray(part.values, float))[:, :3]


def _bounds(meshes: Sequence[Mesh]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    points = np.concatenate([mesh.vertices[np.unique(mesh.faces)] for mesh in meshes])
    return points.min(axis=0), points.max(axis=0)


def _towards(meshes: Sequence[Mesh], asked: ArrayLike | None) -> NDArray[np.float64]:
    """Unit vector to the viewer, by default so that the last mesh is seen in front of the first, a little turned."""
    if asked is None:
        (low, high), (low2, high2) = _bounds(meshes[:1]), _bounds(meshes[-1:])
        ahead = (low2 + high2 - low - high) / 2
        lone = len(meshes) == 1 or np.linalg.norm(ahead) < 1e-6
        asked = (0.6, -0.7, 0.4) if lone else ahead / np.linalg.norm(ahead) + (0.0, -0.25, 0.2)
    direction = np.asarray(asked, float)
    return direction / np.linalg.norm(direction)

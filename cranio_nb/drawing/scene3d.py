"""Meshes -> a scene to turn in a notebook, or a picture of it. The only importer of pyvista.

Frame: world mm (LPS). Where the browser runs on this machine, the scene is live and drawn by the browser. Behind a
proxy or a remote front end it is a page of its own inside the notebook. In static mode, and without pyvista, it is a
picture by the package's own renderer. None of them needs OpenGL in the kernel, which would crash where it is missing.
"""

from __future__ import annotations

import html
import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, partial
from importlib.util import find_spec
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import InputRefused
from ..mesh import Mesh
from ..prosthesis import Prosthesis
from ..volume import Volume
from .coarse_skull import skull_surface
from .described import Bundle, bundle, encoded_png
from .front_end import is_local, mode
from .local_server import NAME, running_server
from .palette import BLACK, BLUE, GREEN, ORANGE, PURPLE, SKULL, SKY, rgb_shares, side_letter
from .pixels import RGB
from .scene_legend import bar_length, bounds, legend
from .scene_picture import HEIGHT, WIDTH, Part, draw_parts, top_of_scale
from .shading import up_in_view, view_axes
from .thinning import thin_mesh

MAX_FACES = 150_000
"""Most faces that a browser is given live; a page of its own holds fewer."""
COLOURS = (SKULL, BLUE, ORANGE, GREEN, SKY, PURPLE)
"""Of the meshes of a scene in their order; a mesh alone takes the second."""
_PAGE_FACES = 60_000
_SOCKET = "ws://use_host/ws"  # told, so that the page need not ask a launcher that is not there
_SIDEWAYS = 0.8  # cosine with the line of sight from which on a letter would hide the scene or lie behind it
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
    >>> show(skull, made).line
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
        World mm; the skull first, then what lies in it.
    alt : str
        What is to be seen, for those who cannot see it.
    colours : sequence of str, optional
        "#RRGGBB" for each mesh; by default `COLOURS`.
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

    Examples
    --------
    >>> square = Mesh(np.array([[0.0, 0, 0], [9, 0, 0], [0, 0, 9], [9, 0, 9]]), np.array([[0, 1, 2], [1, 3, 2]]))
    >>> show_meshes(square, alt="A square.", labels=["square"]).line
    '3-D scene: square (2 triangles).'
    """
    drawn = [mesh for mesh in meshes if len(mesh.faces)]
    if not drawn:
        raise InputRefused("EmptyMesh", "There is no mesh with faces to show.")
    for name, given in (("colours", colours), ("labels", labels), ("scalars", scalars)):
        if given is not None and len(given) != len(meshes):
            message = f"{len(meshes)} meshes were given {len(given)} {name}."
            raise InputRefused("BadScene", message, "Give one for each mesh.")
    return Scene(_parts(meshes, colours, labels, scalars), alt, unit, _towards(drawn, towards))


def _parts(
    meshes: Sequence[Mesh],
    colours: Sequence[str] | None,
    labels: Sequence[str] | None,
    scalars: Sequence[NDArray | None] | None,
) -> tuple[Part, ...]:
    """The meshes that have faces, each with its colour, name and numbers."""
    n = len(meshes)
    colours = colours or ([COLOURS[i % len(COLOURS)] for i in range(n)] if n > 1 else [COLOURS[1]])
    labels, scalars = labels or [""] * n, scalars or [None] * n
    for mesh, values in zip(meshes, scalars, strict=True):
        if values is not None and np.shape(values) != (len(mesh.vertices),):
            raise InputRefused("BadScene", f"Scalars of shape {np.shape(values)} for {len(mesh.vertices)} vertices.")
    parts = map(Part, meshes, colours, labels, scalars)
    return tuple(part for part in parts if len(part.mesh.faces))


@dataclass(frozen=True, eq=False)
class Scene:
    """Meshes to look at; displays itself as fits where it runs.

    Parameters
    ----------
    parts : tuple of Part
    alt : str
        What is to be seen, for those who cannot see it.
    unit : str
        Of the parts' values.
    towards : ndarray, shape (3,)
        Unit vector from the scene to the viewer, LPS.
    """

    parts: tuple[Part, ...]
    alt: str
    unit: str
    towards: NDArray[np.float64]

    @property
    def top(self) -> float | None:
        """Number at the upper end of the colour scale.

        Returns
        -------
        float or None
            In `unit`; None without values.
        """
        return top_of_scale(self.parts)

    @cached_property
    def picture(self) -> RGB:
        """The scene as pixels.

        Returns
        -------
        ndarray of uint8, shape (H, W, 3)
        """
        return draw_parts(self.parts, self.towards, unit=self.unit)

    @cached_property
    def line(self) -> str:
        """One line for where there is only text.

        Returns
        -------
        str
        """
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
        """A live scene, drawn by the browser and fed by this kernel.

        Returns
        -------
        pyvista's viewer
        """
        made = plotter(self)  # before the server, whose parts must not search for more
        server = running_server()
        asked = {"name": NAME, "handler": partial(_frame, self, server.options["key"])}
        asked |= {"jupyter_extension_enabled": False, "server_proxy_enabled": False, "add_menu": False}
        return made.show(jupyter_backend="client", jupyter_kwargs=asked, return_viewer=True)

    @cached_property
    def page(self) -> str:
        """The scene as HTML that needs no kernel and no network.

        Returns
        -------
        str
        """
        inner = html.escape(plotter(self, _PAGE_FACES).trame.export_html(None).getvalue(), quote=True)
        title = html.escape(self.alt, quote=True)
        frame = f'<iframe title="{title}" srcdoc="{inner}" style="width:100%;height:{HEIGHT}px;border:0"></iframe>'
        return legend(self.parts, self.unit) + frame


def plotter(scene: Scene, max_faces: int = MAX_FACES) -> Any:
    """The scene in pyvista, its large meshes thinned; nothing is rendered by this process.

    Parameters
    ----------
    scene : Scene
    max_faces : int
        Of all parts together.

    Returns
    -------
    pyvista.Plotter
    """
    os.environ.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkOSOpenGLRenderWindow")
    sys.modules.setdefault("trame.widgets.vtklocal", None)  # type: ignore[arg-type]  # or it looks for a download
    import pyvista as pv  # noqa: TID251  (this is the module that may)
    import trame_pyvista  # noqa: F401  (else "client" means another mode)

    made = pv.Plotter(notebook=True, window_size=[WIDTH, HEIGHT])
    made.suppress_rendering = True
    budget = max_faces // len(scene.parts)  # faces of each part
    for part in scene.parts:
        values = np.zeros(len(part.mesh.vertices)) if part.values is None else part.values
        mesh, carried = thin_mesh(part.mesh, np.column_stack([part.mesh.vertex_normals, values]), budget)
        faces = _turned_outwards(mesh, carried[:, :3]).astype(int)
        surface = pv.PolyData.from_regular_faces(mesh.vertices, faces)
        # the normals of the full mesh: those of the thinned one turn black where two of its faces fold together
        surface.point_data.active_normals = carried[:, :3]
        if part.values is not None:
            surface["values"] = carried[:, 3]
        made.add_mesh(surface, name=part.label or None, smooth_shading=True, **_colouring(part, scene))
    for mark in _marks(scene):
        made.add_mesh(mark, color=tuple(rgb_shares(BLACK).tolist()), lighting=False)
    made.camera_position = _camera(scene)
    return made


def _turned_outwards(mesh: Mesh, normals: NDArray) -> NDArray[np.intp]:
    """The faces, those turned round that were folded by thinning and would be drawn black, as if from inside."""
    folded = np.einsum("fd,fd->f", mesh.area_vectors, normals[mesh.faces].sum(axis=1)) < 0
    return np.where(folded[:, None], mesh.faces[:, ::-1], mesh.faces)


def _marks(scene: Scene) -> list[Any]:
    """A bar below the scene and the letters of the patient's sides around it, as meshes of pyvista."""
    import pyvista as pv  # noqa: TID251  (this is the module that may)

    low, high = bounds([part.mesh for part in scene.parts])
    middle, half = (low + high) / 2, (high - low) / 2
    right, down, towards = view_axes(scene.towards)
    size = 0.07 * float(half.max() * 2)
    # the bar: below all corners of the box, across the view
    below = middle + (np.abs(down) @ half + 1.2 * size) * down
    reach = bar_length([part.mesh for part in scene.parts]) / 2 * right
    marks = [pv.Line(below - reach, below + reach).tube(radius=size / 15)]
    # letters upright as they are first seen; those before and behind the scene are left out
    for way in (*np.eye(3), *-np.eye(3)):
        if abs(way @ towards) < _SIDEWAYS:
            letter = pv.Text3D(side_letter(way), height=size, depth=size / 10, center=(0, 0, 0))
            away = 1.0 if way @ towards > -0.1 else 2.2  # out of the shadow of the scene
            at = middle + (np.abs(way) @ half + away * size) * way
            marks.append(_placed(letter, np.array([right, -down, towards]), at))
    return marks


def _placed(letter: Any, axes: NDArray, at: NDArray) -> Any:
    """A letter with its own axes along others, moved to a place."""
    letter.points = np.asarray(letter.points) @ axes + at
    return letter


def _frame(scene: Scene, key: str, viewer: Any, address: str, *, iframe_attrs: Any = None, **more: Any) -> Any:
    """The legend and the frame of a live scene, whose address holds the key of its server and its socket."""
    from trame_pyvista.jupyter import Widget

    titled = {**(iframe_attrs or {}), "title": html.escape(scene.alt, quote=True)}
    widget = Widget(viewer, f"{address}&sessionURL={_SOCKET}&secret={key}", iframe_attrs=titled, **more)
    widget.value = legend(scene.parts, scene.unit) + widget.value
    return widget


def _colouring(part: Part, scene: Scene) -> dict[str, Any]:
    """How pyvista colours a part. Colours are floats: whole numbers come out dark."""
    if part.values is None:
        return {"color": tuple(rgb_shares(part.colour).tolist())}
    bar = {"title": scene.unit}
    return {"scalars": "values", "cmap": "cividis", "clim": (0.0, scene.top), "scalar_bar_args": bar}


def _camera(scene: Scene) -> list[tuple[float, ...]]:
    """Position, focal point and up for a view of the whole scene."""
    low, high = bounds([part.mesh for part in scene.parts])
    middle = (low + high) / 2
    place = middle + 1.6 * np.linalg.norm(high - low) * scene.towards
    return [tuple(place.tolist()), tuple(middle.tolist()), tuple(up_in_view(scene.towards).tolist())]


def _towards(meshes: Sequence[Mesh], asked: ArrayLike | None) -> NDArray[np.float64]:
    """Unit vector to the viewer, by default so that the last mesh is seen in front of the first, a little turned."""
    if asked is None:
        (low, high), (low2, high2) = bounds(meshes[:1]), bounds(meshes[-1:])
        ahead = (low2 + high2 - low - high) / 2
        lone = len(meshes) == 1 or np.linalg.norm(ahead) < 1e-6
        asked = (0.6, -0.7, 0.4) if lone else ahead / np.linalg.norm(ahead) + (0.0, -0.25, 0.2)
    direction = np.asarray(asked, float)
    return direction / np.linalg.norm(direction)

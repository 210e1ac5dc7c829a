"""What stands above a live scene: what its colours mean, and how long the bar is that lies in it.

Frame: world mm (LPS).
"""

from __future__ import annotations

import html
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from ..mesh import Mesh
from .canvas import round_length
from .palette import BLACK
from .scene_picture import Part, named_colours, top_of_scale

_SWATCH = '<span style="background:{};display:inline-block;width:{}px;height:10px;margin-right:6px"></span>{}'
_SWATCH_PX, _SCALE_PX = 20, 120


def legend(parts: Sequence[Part], unit: str) -> str:
    """The names of the parts beside their colours, and the length of the bar.

    Parameters
    ----------
    parts : sequence of Part
    unit : str
        Of their values.

    Returns
    -------
    str
        HTML.

    Examples
    --------
    >>> corner = Mesh(np.array([[0.0, 0, 0], [90, 0, 0], [0, 90, 0]]), np.array([[0, 1, 2]]))
    >>> shown = legend([Part(corner, "#0072B2", "a & b", None)], "mm")
    >>> "background:#0072B2" in shown, "a &amp; b" in shown, "20 mm" in shown
    (True, True, True)
    """
    top = top_of_scale(parts)
    words = []
    for tones, name in named_colours(parts):
        if len(tones) == 1:
            words.append(_SWATCH.format(tones[0], _SWATCH_PX, html.escape(name)))
        else:  # a scale between its two ends
            bar = _SWATCH.format(f"linear-gradient(to right,{','.join(tones)})", _SCALE_PX, "")
            words.append(f"{html.escape(name)}: 0 {bar}&ge; {top:.2g} {html.escape(unit)}")
    words.append(_SWATCH.format(BLACK, _SWATCH_PX, f"{bar_length([part.mesh for part in parts]):g} mm"))
    return f'<div style="line-height:1.6">{"&emsp;".join(words)}</div>'


def bar_length(meshes: Sequence[Mesh]) -> float:
    """Length of the bar that lies in a scene: round, and at most a third of its longest side.

    Parameters
    ----------
    meshes : sequence of Mesh

    Returns
    -------
    float
        mm.
    """
    low, high = bounds(meshes)
    return round_length(float((high - low).max()) / 3)


def bounds(meshes: Sequence[Mesh]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Lowest and highest x, y, z of the vertices that faces use.

    Parameters
    ----------
    meshes : sequence of Mesh

    Returns
    -------
    low, high : ndarray, shape (3,)
        mm.
    """
    points = np.concatenate([mesh.vertices[np.unique(mesh.faces)] for mesh in meshes])
    return points.min(axis=0), points.max(axis=0)

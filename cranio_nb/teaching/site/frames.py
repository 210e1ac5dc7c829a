"""A panel and its axes -> every picture of it, drawn by the panel's own function and stored as WebP."""

from __future__ import annotations

import hashlib
import io
from bisect import bisect_left
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from itertools import product
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ..widgets import Panel, View
from .axes import Axis

_LOSSY: dict[str, Any] = {"quality": 88, "method": 4}
_LOSSLESS: dict[str, Any] = {
    "lossless": True,
    "quality": 50,
    "method": 4,
}  # smaller than the other where a picture is drawn


@dataclass(frozen=True, eq=False)
class Frames:
    """The pictures of a panel over its axes.

    Parameters
    ----------
    axes : tuple of Axis
    names : tuple of str
        The file of each setting, the last axis fastest; some are the same.
    lines : tuple of str
        The caption of each setting.
    off : tuple of tuple of str
        Controls without effect at each setting.
    tops : tuple of dict of str to tuple of (int, float)
        By name of the axis, the last place worth going to at each setting and the value there, where a picture moves
        the end of a slider.
    files : dict of str to bytes
        WebP by name, in the order of their first use.
    """

    axes: tuple[Axis, ...]
    names: tuple[str, ...]
    lines: tuple[str, ...]
    off: tuple[tuple[str, ...], ...]
    tops: tuple[dict[str, tuple[int, float]], ...]
    files: dict[str, bytes]

    @property
    def start(self) -> int:
        """Place of the setting that is shown first.

        Returns
        -------
        int
        """
        shape = [len(axis.stops) for axis in self.axes]
        return int(np.ravel_multi_index([axis.start for axis in self.axes], shape))


def draw_frames(panel: Panel, axes: Sequence[Axis]) -> Frames:
    """Draw every setting of the axes; all other controls stay as they are.

    Parameters
    ----------
    panel : Panel
    axes : sequence of Axis
        Of its controls.

    Returns
    -------
    Frames
    """
    encode = encoding(panel)
    names, lines, off, tops, files = [], [], [], [], {}
    for view in _views(panel, axes):
        data = encode(view.rgb)
        name = f"{hashlib.sha256(data).hexdigest()[:12]}.webp"
        files[name] = data
        names.append(name)
        lines.append(view.line)
        off.append(tuple(view.off))
        tops.append(_tops(view, axes))
    return Frames(tuple(axes), tuple(names), tuple(lines), tuple(off), tuple(tops), files)


def _tops(view: View, axes: Sequence[Axis]) -> dict[str, tuple[int, float]]:
    """The first place at or beyond each end that a view sets, and the end: what lies beyond it is drawn as the end."""
    ends = view.limits or {}
    found = {}
    for axis in axes:
        if (end := ends.get(axis.control.name)) is not None:
            found[axis.control.name] = min(bisect_left(axis.stops, end), len(axis.stops) - 1), end
    return found


def _views(panel: Panel, axes: Sequence[Axis]) -> Iterator[View]:
    """The view of each setting, the last axis fastest."""
    drawn: dict[tuple[Any, ...], View] = {}
    patterns: set[tuple[str, ...]] = {()}  # of controls that had no effect

    def key(values: dict[str, Any], off: tuple[str, ...]) -> tuple[Any, ...]:
        return (off, *(value for name, value in values.items() if name not in off))

    for stops in product(*(axis.stops for axis in axes)):
        values = dict(panel.values)
        for axis, stop in zip(axes, stops, strict=True):
            values |= axis.values(stop)
        # what was drawn for another value of a control without effect is not drawn again
        known = (drawn[key(values, off)] for off in patterns if key(values, off) in drawn)
        view = next(known, None) or panel.picture(**values)
        patterns.add(tuple(view.off))
        drawn[key(values, tuple(view.off))] = view
        yield view


def encoding(panel: Panel) -> Callable[[NDArray[np.uint8]], bytes]:
    """The way to store the pictures of a panel in fewer bytes: with small losses, or drawn ones without any.

    Parameters
    ----------
    panel : Panel
        Its picture of now is tried.

    Returns
    -------
    callable
        Pixels, shape (H, W, 3) -> WebP.
    """
    rgb = panel.view.rgb
    smaller = min((_LOSSY, _LOSSLESS), key=lambda options: len(encoded_webp(rgb, **options)))
    return partial(encoded_webp, **smaller)


def encoded_webp(rgb: NDArray[np.uint8], **options: Any) -> bytes:
    """Pixels as WebP.

    Parameters
    ----------
    rgb : ndarray of uint8, shape (H, W, 3)
    **options
        Of Pillow.

    Returns
    -------
    bytes

    Examples
    --------
    >>> encoded_webp(np.zeros((4, 6, 3), np.uint8), lossless=True)[8:12]
    b'WEBP'
    """
    stream = io.BytesIO()
    Image.fromarray(rgb).save(stream, format="WEBP", **options)
    return stream.getvalue()

"""Controls as plain values and a function from them to a picture -> something a notebook shows.

A panel is the same in both modes up to its front: `live` puts real controls before it, here it is one picture.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ...drawing.front_end import mode
from ...errors import CranioError, InputRefused

Bundle = tuple[dict[str, Any], dict[str, Any]]


@dataclass(frozen=True)
class Slider:
    """A number to choose. `label` names it with its unit; `log` spaces the values evenly in their logarithm."""

    name: str
    label: str
    low: float
    high: float
    value: float
    step: float = 1.0
    log: bool = False
    player: bool = False


@dataclass(frozen=True)
class Choice:
    """One of a few words to choose."""

    name: str
    label: str
    options: tuple[str, ...]
    value: str


@dataclass(frozen=True)
class Switch:
    """Something to turn on and off."""

    name: str
    label: str
    value: bool


Control = Slider | Choice | Switch


@dataclass(frozen=True, eq=False)
class View:
    """What a panel shows for one setting of its controls.

    Parameters
    ----------
    rgb : ndarray of uint8, shape (H, W, 3)
    line : str
        One line in words and numbers, the same on every run.
    limits : dict of str to float
        New upper ends of sliders, by name.
    off : tuple of str
        Controls without effect at this setting.
    """

    rgb: NDArray[np.uint8]
    line: str
    limits: dict[str, float] | None = None
    off: tuple[str, ...] = ()


class Panel:
    """Controls and the picture they lead to; displays itself.

    Parameters
    ----------
    controls : sequence of Control
    picture : callable
        Values by name -> `View`; a pure function.
    alt : str
        What the picture shows, for those who cannot see it.
    actions : dict of str to callable, optional
        Buttons: label -> what to do with the panel, returning a line to show.
    slow : bool
        Whether a picture takes long: controls then speak when they are let go.
    """

    def __init__(
        self,
        controls: tuple[Control, ...],
        picture: Callable[..., View],
        *,
        alt: str,
        actions: dict[str, Callable[[Any], str]] | None = None,
        slow: bool = False,
    ) -> None:
        self.controls = {control.name: control for control in controls}
        self.values: dict[str, Any] = {control.name: control.value for control in controls}
        self.alt = alt
        self.actions = dict(actions or {})
        self.slow = slow
        self._picture = picture
        self.view = picture(**self.values)

    def set(self, **values: Any) -> Panel:
        """Move controls and draw at once.

        Raises
        ------
        InputRefused
            ``UnknownControl``.
        """
        for name in values:
            if name not in self.controls:
                known = ", ".join(self.controls)
                raise InputRefused("UnknownControl", f"This panel has no control {name!r}.", f"It has: {known}.")
        if mode() == "widget":
            self.front.set(values)
        else:
            self.update(values)
        return self

    def update(self, values: dict[str, Any]) -> View:
        """Take new values and draw; a setting that cannot be drawn keeps the picture and says why."""
        self.values = self.values | values
        try:
            self.view = self._picture(**self.values)
        except CranioError as problem:
            self.view = View(self.view.rgb // 2 + 127, str(problem))
        return self.view

    @cached_property
    def front(self) -> Any:
        """The controls as widgets (`live.Front`)."""
        from .live import Front

        return Front(self)

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> Bundle:
        data, metadata = bundle(png(self.view.rgb), self.alt, self.view.line)
        if mode() == "widget":
            data |= self.front.box._repr_mimebundle_()
        return data, metadata


@dataclass(frozen=True, eq=False)
class StaticPicture:
    """A picture with alternative text and one line; displays itself."""

    png: bytes
    alt: str
    line: str

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> Bundle:
        return bundle(self.png, self.alt, self.line)


def static_twin(picture: Any, alt: str, line: str) -> StaticPicture:
    """A picture that says in words what it shows.

    Parameters
    ----------
    picture : Figure, bytes or ndarray of uint8, shape (H, W, 3)
        Matplotlib figure, PNG, or pixels.
    alt : str
        What is to be seen, for those who cannot see it.
    line : str
        One line that stands for the picture where there is only text; the same on every run.

    Raises
    ------
    InputRefused
        ``NoAlt`` when alt or line is empty.
    """
    if not alt.strip() or not line.strip():
        raise InputRefused("NoAlt", "A picture without alternative text or without a line.", "Say what it shows.")
    if isinstance(picture, np.ndarray):
        picture = png(picture)
    elif not isinstance(picture, bytes):
        from ...drawing.figures import png as figure_png

        picture = figure_png(picture)
    return StaticPicture(picture, alt, line)


def bundle(picture: bytes, alt: str, line: str) -> Bundle:
    """Data and metadata of one output: the picture, its alternative text, and the line."""
    width, height = Image.open(io.BytesIO(picture)).size
    return {"image/png": picture, "text/plain": line}, {"image/png": {"alt": alt, "width": width, "height": height}}


def png(rgb: NDArray[np.uint8]) -> bytes:
    """Pixels as PNG, small."""
    return _encoded(rgb, format="PNG", optimize=True)


def jpeg(rgb: NDArray[np.uint8]) -> bytes:
    """Pixels as JPEG, fast, with sharp colours."""
    return _encoded(rgb, format="JPEG", quality=90, subsampling=0)


def _encoded(rgb: NDArray[np.uint8], **options: Any) -> bytes:
    stream = io.BytesIO()
    Image.fromarray(rgb).save(stream, **options)
    return stream.getvalue()

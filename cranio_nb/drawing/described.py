"""A picture with its description for those who cannot see it, and one line that stands for it in plain text."""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ..errors import InputRefused

Bundle = tuple[dict[str, Any], dict[str, Any]]
"""Data and metadata of one output of a notebook's cell, by media type."""


@dataclass(frozen=True, eq=False)
class Described:
    """A picture that says in words what it shows; displays itself in a notebook.

    Parameters
    ----------
    png : bytes
        The encoded picture.
    alt : str
        What is to be seen.
    line : str
        The numbers of the picture; the same whenever the picture is.
    """

    png: bytes
    alt: str
    line: str

    def __repr__(self) -> str:
        return self.line

    def _repr_mimebundle_(self, include: Any = None, exclude: Any = None) -> Bundle:
        return bundle(self.png, self.alt, self.line)


def described(picture: Any, alt: str, line: str) -> Described:
    """Give a picture its description and its line.

    Parameters
    ----------
    picture : Figure, bytes or ndarray of uint8, shape (H, W, 3)
        Matplotlib figure, PNG, or pixels.
    alt : str
        What is to be seen, for those who cannot see it.
    line : str
        One line that stands for the picture where there is only text; the same on every run.

    Returns
    -------
    Described

    Raises
    ------
    InputRefused
        ``NoAlt`` when alt or line is empty.

    Examples
    --------
    >>> described(np.zeros((4, 6, 3), np.uint8), "A black box.", "black, 6 x 4 px")
    black, 6 x 4 px
    """
    if not alt.strip() or not line.strip():
        raise InputRefused("NoAlt", "A picture without alternative text or without a line.", "Say what it shows.")
    if isinstance(picture, np.ndarray):
        picture = encoded_png(picture)
    elif not isinstance(picture, bytes):
        from .figures import png

        picture = png(picture)
    return Described(picture, alt, line)


def bundle(picture: bytes, alt: str, line: str) -> Bundle:
    """A picture as one output of a notebook's cell.

    Parameters
    ----------
    picture : bytes
        PNG.
    alt : str
        What is to be seen, for those who cannot see it.
    line : str
        What stands for the picture where there is only text.

    Returns
    -------
    dict
        Data by media type.
    dict
        Metadata by media type: alternative text, and the size in px.

    Examples
    --------
    >>> data, metadata = bundle(encoded_png(np.zeros((4, 6, 3), np.uint8)), "A black box.", "black")
    >>> data["text/plain"], metadata["image/png"]
    ('black', {'alt': 'A black box.', 'width': 6, 'height': 4})
    """
    width, height = Image.open(io.BytesIO(picture)).size
    return {"image/png": picture, "text/plain": line}, {"image/png": {"alt": alt, "width": width, "height": height}}


def encoded_png(rgb: NDArray[np.uint8]) -> bytes:
    """Pixels as PNG, small.

    Parameters
    ----------
    rgb : ndarray of uint8, shape (H, W, 3)

    Returns
    -------
    bytes

    Examples
    --------
    >>> encoded_png(np.zeros((4, 6, 3), np.uint8))[1:4]
    b'PNG'
    """
    return _encoded(rgb, format="PNG", optimize=True)


def encoded_jpeg(rgb: NDArray[np.uint8]) -> bytes:
    """Pixels as JPEG, fast, with sharp colours.

    Parameters
    ----------
    rgb : ndarray of uint8, shape (H, W, 3)

    Returns
    -------
    bytes

    Examples
    --------
    >>> encoded_jpeg(np.zeros((4, 6, 3), np.uint8))[:2].hex()
    'ffd8'
    """
    return _encoded(rgb, format="JPEG", quality=90, subsampling=0)


def _encoded(rgb: NDArray[np.uint8], **options: Any) -> bytes:
    """Pixels in a format of Pillow."""
    stream = io.BytesIO()
    Image.fromarray(rgb).save(stream, **options)
    return stream.getvalue()

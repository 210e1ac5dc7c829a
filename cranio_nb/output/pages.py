"""What the pages share: their templates, their pictures as text, numbers for reading."""

from __future__ import annotations

import base64
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined, Template

from ..drawing import figures
from ..opening import Opening
from ..vault.opening_size import OpeningSize

_BELOW_CENTRE_MM, _BELOW_OPENING_MM = 10.0, 15.0  # bone shown below the head's centre, below the lowest opening


@dataclass(frozen=True)
class Shot:
    """A picture of a page.

    Parameters
    ----------
    data : str
        PNG in base64.
    alt : str
        What it shows, for those who do not see it.
    caption : str
        Line below it.
    width : int
        Width in px, so that pictures of one row keep one scale.
    """

    data: str
    alt: str
    caption: str
    width: int


def shot(figure: figures.Figure, *, alt: str, caption: str) -> Shot:
    """A figure as a picture of a page.

    Parameters
    ----------
    figure : Figure
    alt : str
        What it shows, for those who do not see it.
    caption : str
        Line below it.

    Returns
    -------
    Shot

    Examples
    --------
    >>> figure, _ = figures.new_figure(2.0, 1.0)
    >>> shot(figure, alt="An empty picture.", caption="Nothing").width
    220
    """
    data = base64.b64encode(figures.png(figure)).decode("ascii")
    return Shot(data, alt, caption, round(float(figure.get_figwidth() * figure.dpi)))


@lru_cache
def page_template(name: str) -> Template:
    """A template of the package; everything that is put into it is escaped.

    Parameters
    ----------
    name : str
        File in `templates`.

    Returns
    -------
    jinja2.Template
        With the filter `num` (see `number`); a name that it is not given is an error.
    """
    # a forgotten value is an error, and markup in a file's name stays text
    environment = Environment(
        loader=PackageLoader("cranio_nb.output"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters["num"] = number
    return environment.get_template(name)


def number(value: Any, digits: int = 2) -> str:
    """A number for reading.

    Parameters
    ----------
    value : Any
    digits : int
        Digits after the point of a number that is not whole by its type.

    Returns
    -------
    str
        A dash for None; text and truth values as they are.

    Examples
    --------
    >>> number(2.5), number(3), number(None)
    ('2.50', '3', '-')
    """
    if value is None:
        return "-"
    if isinstance(value, bool | np.bool_ | str):
        return str(value)
    return str(int(value)) if isinstance(value, int | np.integer) else f"{float(value):.{digits}f}"


def lowest_shown(openings: Sequence[OpeningSize], largest: Opening) -> float:
    """Height down to which views show the skull: below the openings, and above the face if they allow it.

    Parameters
    ----------
    openings : sequence of OpeningSize
    largest : Opening
        Knows the head's centre.

    Returns
    -------
    float
        World z, mm.
    """
    # the lower of the two: an opening below the face line is still shown
    lowest = min(one.lowest for one in openings)
    return min(float(largest.head_centre[2]) - _BELOW_CENTRE_MM, lowest - _BELOW_OPENING_MM)

"""A film of a balloon that rises from the chord to its rest: step and energy in its caption.

Frame: chord (along, out) px.
"""

from __future__ import annotations

import io
import json
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from PIL import Image

from ...curves import Points
from ...drawing import figures
from ...drawing.palette import LABEL_PT
from ...stages import deformable_model
from ..widgets.inflation import elastic_energy
from . import chord, marks

_HEIGHT_IN = 3.4
_GROWS = 1.22  # from the step of a frame to that of the next: what changes fast is shown in full
_MS, _FIRST_MS, _LAST_MS = 140, 900, 2800  # how long a frame stays
_COLOURS = 64


@dataclass(frozen=True, eq=False)
class Inflating:
    """All steps of a balloon that begins as the chord itself.

    Parameters
    ----------
    curves : ndarray, shape (T + 1, n, 2)
        Chord px.
    energy : ndarray, shape (T + 1,)
        Elastic energy, px^2.
    """

    curves: NDArray[np.float64]
    energy: NDArray[np.float64]

    @property
    def shown(self) -> list[int]:
        """The steps that are frames of the film: all at first, then ever fewer, and the last.

        Returns
        -------
        list of int
        """
        last = len(self.curves) - 1
        steps = [0]
        while steps[-1] < last:
            steps.append(min(max(steps[-1] + 1, round(_GROWS * steps[-1])), last))
        return steps


def inflate_from_chord(length: float, angles: tuple[float, float], n: int = 21) -> Inflating:
    """Inflate a balloon by the pressure of its tangents, from the straight chord.

    Parameters
    ----------
    length : float
        Of the gap, px.
    angles : tuple of float
        theta0 and theta1, radians.
    n : int
        Snaxels.

    Returns
    -------
    Inflating

    Examples
    --------
    >>> made = inflate_from_chord(80.0, (0.25, np.pi - 0.25))
    >>> float(made.curves[0, :, 1].max()), float(made.energy[0])
    (0.0, 160.0)
    """
    start = np.column_stack([np.linspace(0, length, n), np.zeros(n)])
    slopes = np.array([[1.0, np.tan(t)] for t in angles]) * length / (n - 1)
    k = deformable_model.tangent_pressure(length, *angles, n)
    curves = [start]
    deformable_model.inflate(start, slopes, pressure=k, iter_callback=lambda step, curve, change: curves.append(curve))
    return Inflating(np.array(curves), elastic_energy(np.array(curves)))


def balloon_film(gap: chord.Gap, *, drawn_by: str) -> bytes:
    """The film of a gap, as a GIF that loops.

    Parameters
    ----------
    gap : Gap
    drawn_by : str
        What tells the code that drew it from another one.

    Returns
    -------
    bytes
        Its comment holds, as JSON, what the balloon is made from, the steps that are shown, and `drawn_by`.
    """
    length, angles = gap.frame.length, gap.angles
    made = inflate_from_chord(length, angles)
    frames = [_frame(gap, made.curves[step], caption(made, step)) for step in made.shown]
    # one table of colours for all, from the picture that has the most
    table = marks.few_colours(frames[-1], _COLOURS)
    first, *others = (frame.quantize(palette=table, dither=Image.Dither.NONE) for frame in frames)
    stay = [_FIRST_MS, *[_MS] * (len(others) - 1), _LAST_MS]
    facts = {"length_px": length, "theta_rad": angles, "steps": made.shown, "drawn_by": drawn_by}
    stream = io.BytesIO()
    first.save(
        stream,
        format="GIF",
        save_all=True,
        append_images=others,
        duration=stay,
        loop=0,
        optimize=True,
        comment=json.dumps(facts).encode(),
    )
    return stream.getvalue()


def caption(made: Inflating, step: int) -> str:
    """What stands above a frame.

    Parameters
    ----------
    made : Inflating
    step : int

    Returns
    -------
    str
    """
    last = len(made.curves) - 1
    moved = "" if not step else f", moved by {np.linalg.norm(made.curves[step] - made.curves[step - 1]):.3f} px"
    rest = ": at rest" if step == last else ""
    return f"step {step} of {last}{rest}{moved}, energy {made.energy[step]:.1f} px\N{SUPERSCRIPT TWO}"


def _frame(gap: chord.Gap, curve: Points, text: str) -> Image.Image:
    """One picture of the film."""
    figure = marks.sheet(_HEIGHT_IN)
    ax = chord.draw_gap(figure, gap)
    chord.draw_balloon(ax, curve)
    figure.text(0.5, 0.9, text, fontsize=LABEL_PT, ha="center", va="center", family="monospace")
    return Image.open(io.BytesIO(figures.png(figure))).convert("RGB")

"""The whole pipeline under sliders: parameters of a design -> how near it comes to the known truth.

Frame: world mm (LPS).
"""

from __future__ import annotations

import json
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from ...drawing.canvas import Canvas
from ...drawing.palette import BLACK, BLUE, GREY, PALE, WHITE
from ...evaluation import scores
from ...evaluation.against_truth import SIDES, side_distances, true_prosthesis
from ...mesh import OUTER
from ...methods.catalogue import options_of as options_declared
from ...methods.design import design
from ...opening import Opening
from ...options import THRESHOLD
from ...output.files import json_text
from ...output.guard import check_writes
from ...output.staging import replace_file
from ...prosthesis import Prosthesis
from ...stages.segmentation import bone_of
from ...vault import opening_search
from ...volume import Volume
from .controls import Choice, Slider, Switch, View
from .evaluation import DistanceMap, draw_distances, map_distances
from .panel import Panel
from .parts import HEIGHT, WIDTH, draw_colour_scale

FILE = "cranio_nb_parameters.json"
SLICES = ("axial, as in the paper", "fans from inside the head")
_WORSE = "#B34E00"  # vermillion, dark enough for letters
_MAP = 345  # px: width of the map
THRESHOLD_HU = "threshold_hu"
_TOP = 1.5  # mm at the upper end of the colour scale
_PRESETS: dict[str, dict[str, Any]] = {
    "axial slices": {"slices": SLICES[0]},
    "k by hand": {"own": True},
    "tension 2": {"tension": 2.0},
}
_ALT = "The designed prosthesis coloured by its distance from the true one, and its scores beside those at the start."
_MEASURES = (
    ("DSC", "", 3, True),
    ("border DSC", "", 3, True),
    ("HD95", "mm", 2, False),
    ("mean distance", "mm", 2, False),
    ("outer side, mean", "mm", 2, False),
    ("inner side, mean", "mm", 2, False),
    ("volume / true volume", "", 3, None),
)


class Tuner(Panel):
    """A panel over the options of the method `slicewise`."""

    @property
    def parameters(self) -> dict[str, Any]:
        """The options that the controls mean.

        Returns
        -------
        dict
            As `cranio-nb design --params` and `cn.design` take them; the threshold is no option of a design.
        """
        return options_of(**{name: value for name, value in self.values.items() if name != THRESHOLD_HU})

    def save(self, path: str | Path = FILE) -> Path:
        """Write the parameters as JSON.

        Parameters
        ----------
        path : path

        Returns
        -------
        Path
            The file.

        Raises
        ------
        CannotWrite
            Where the file holds something else than such parameters, or cannot be written.
        """
        path = Path(path)
        check_writes(path.parent, (path.name,), own=lambda folder, name: self._is_own(folder / name))
        replace_file(path, (json_text(self.parameters) + "\n").encode())
        return path

    def _is_own(self, path: Path) -> bool:
        """Whether a file holds parameters of the same names, as an earlier `save` wrote them."""
        try:
            return not path.is_symlink() and set(json.loads(path.read_text("utf-8"))) == set(self.parameters)
        except (OSError, ValueError, TypeError, RecursionError):
            return False


def tuner(scan: Volume, truth: Volume) -> Tuner:
    """Design and score again with every move.

    Parameters
    ----------
    scan : Volume
        HU, or a bool mask of the bone.
    truth : Volume
        Bool mask of the missing bone on the same grid.

    Returns
    -------
    Tuner
        Its controls are the options of the method and ``own``: whether ``pressure_mm`` is set by hand. With HU there
        is ``threshold_hu`` besides.
    """
    skull = lru_cache(maxsize=8)(lambda threshold: _skull(scan, truth, threshold))
    made = lru_cache(maxsize=32)(lambda threshold, *values: _measured(skull(threshold), options_of(*values)))
    controls = _controls()
    if scan.voxels.dtype != bool:
        assert THRESHOLD.default is not None
        label = "threshold: least HU of bone"
        controls = (Slider(THRESHOLD_HU, label, *THRESHOLD.span, float(THRESHOLD.default), 25, unit="HU"), *controls)

    def draw(**values: Any) -> View:
        now = made(values.get(THRESHOLD_HU), *(value for name, value in values.items() if name != THRESHOLD_HU))
        return _view(now, first, values)

    # the scores at the start, to compare with
    start = {control.name: control.value for control in controls}
    first = made(start.pop(THRESHOLD_HU, None), *start.values())
    actions = {"save the parameters": lambda panel: f"Written: {panel.save()}"}
    return Tuner(controls, draw, alt=_ALT, presets=_PRESETS, actions=actions, slow=True)


def _controls() -> tuple[Slider | Choice | Switch, ...]:
    """What the options of the method are set by."""
    return (
        Choice("slices", "slices", SLICES, SLICES[1]),
        _slider("directions", "directions of the fans"),
        _slider("skip_mm", "skip: left out at the cut", 0.5),
        _slider("reach_mm", "reach: fitted after that", 0.5),
        _slider("coupling_mm", "tangents shared over", 0.5, expert=True),
        Switch("own", "set k by hand (else from the end tangents)", False, expert=True),
        _slider("pressure_mm", "k: pressure", 0.002, value=0.062, expert=True),
        _slider("n_snaxels", "snaxels, N + 1", 2, expert=True),
        _slider("tension", "w\N{SUBSCRIPT ONE}: tension", 0.1, expert=True),
        _slider("rigidity", "w\N{SUBSCRIPT TWO}: rigidity", 0.1, expert=True),
        Switch("smooth", "surface without stairs", True, expert=True),
    )


def options_of(
    slices: str,
    directions: int,
    skip_mm: float,
    reach_mm: float,
    coupling_mm: float,
    own: bool,
    pressure_mm: float,
    n_snaxels: int,
    tension: float,
    rigidity: float,
    smooth: bool,
) -> dict[str, Any]:
    """Options of the method `slicewise` for the values of the controls.

    Parameters
    ----------
    slices : str
        One of `SLICES`.
    own : bool
        Whether `pressure_mm` is heeded; else it follows from the end tangents.
    directions, skip_mm, reach_mm, coupling_mm, pressure_mm, n_snaxels, tension, rigidity, smooth
        As for the method.

    Returns
    -------
    dict
    """
    return {
        # the names of the method's own options
        "axial": slices == SLICES[0],
        "directions": directions,
        "skip_mm": skip_mm,
        "reach_mm": reach_mm,
        "coupling_mm": coupling_mm,
        "pressure_mm": pressure_mm if own else None,
        "n_snaxels": n_snaxels,
        "tension": tension,
        "rigidity": rigidity,
        "smooth": smooth,
    }


def _slider(name: str, label: str, step: float = 1.0, *, value: float | None = None, **more: Any) -> Slider:
    """A slider over the usual part of an option's range, from its default, or a value where that is none."""
    option = options_declared("slicewise")[name]
    return Slider(name, label, *option.span, option.default if value is None else value, step, unit=option.unit, **more)


Measured = tuple[tuple[float, ...], DistanceMap]


class _Skull(NamedTuple):
    """What does not depend on the options: found once for each threshold."""

    bone: Volume
    openings: tuple[Opening, ...]
    true: Prosthesis


def _skull(scan: Volume, truth: Volume, threshold: float | None) -> _Skull:
    """The bone of a scan, its openings, and the missing bone as a prosthesis."""
    bone = bone_of(scan, threshold)
    openings = opening_search.find_openings(bone, scan=scan)
    return _Skull(bone, openings, true_prosthesis(truth, bone, openings[0].head_centre))


def _measured(skull: _Skull, options: dict[str, Any]) -> Measured:
    """Measures of one design in the order of `_MEASURES`, and its map of distances."""
    made = design(skull.bone, skull.openings, method="slicewise", **options)
    assert made.patch is not None and skull.true.patch is not None
    score = scores.score(made.patch, skull.true.patch, skull.bone)
    off = side_distances(made, skull.true)
    sides = (float(np.mean(off.get(side, np.nan))) for side in SIDES)
    numbers = score.dice, score.border_dice, score.hd95, score.assd, *sides, score.volume_ratio
    return numbers, map_distances(made, skull.true, OUTER)


def _view(now: Measured, first: Measured, values: dict[str, Any]) -> View:
    """Map and table of a design, beside the numbers of the first one."""
    canvas = Canvas(WIDTH, HEIGHT)
    # the map of distances
    canvas.text(14, 22, "distance of the outer side from the truth")
    draw_distances(canvas, now[1], _TOP, (0, 30, _MAP, 420))
    draw_colour_scale(canvas, (40, 470), _MAP - 80, _TOP)
    canvas.legend(32, 506, [(WHITE, "dot", "largest distance seen")])
    _draw_table(canvas, now, first)
    dice, _, hd95, *_ = now[0]
    line = f"DSC {dice:.3f}, HD95 {hd95:.2f} mm, outer side {now[0][4]:.2f} mm and inner side {now[0][5]:.2f} mm off, "
    line += f"outer side {now[1].distances.max():.2f} mm at most."
    off = ("directions", "coupling_mm") if values["slices"] == SLICES[0] else ()
    return View(canvas.array(), line, off=off if values["own"] else (*off, "pressure_mm"))


def _draw_table(canvas: Canvas, now: Measured, first: Measured) -> None:
    """Each measure of a design beside that of the first one, and which of them is better."""
    # the table: each measure at the start and now
    left, before_x, now_x = _MAP + 10, WIDTH - 92, WIDTH - 4
    for x, name in ((before_x, "at the start"), (now_x, "now")):
        canvas.text(x, 50, name, size=12, colour=GREY, anchor="rs")
    for i, (name, unit, digits, more) in enumerate(_MEASURES):
        y, before, value = 86 + 40 * i, first[0][i], now[0][i]
        canvas.line([(left, y + 12), (WIDTH, y + 12)], PALE, width=1)
        canvas.text(left, y, name, size=12)
        canvas.text(before_x, y, f"{before:.{digits}f} {unit}".strip(), size=12, colour=GREY, anchor="rs")
        mark, colour = _verdict(value, before, more, digits)
        canvas.text(now_x, y, f"{mark} {value:.{digits}f} {unit}".strip(), size=13, colour=colour, anchor="rs")
    better, worse = "\N{BLACK UP-POINTING TRIANGLE} better", "\N{BLACK DOWN-POINTING TRIANGLE} worse than at the start"
    canvas.text(left, 86 + 40 * len(_MEASURES), better, size=12, colour=BLUE)
    canvas.text(left + 80, 86 + 40 * len(_MEASURES), worse, size=12, colour=_WORSE)


def _verdict(value: float, before: float, more: bool | None, digits: int) -> tuple[str, str]:
    """Arrow and colour that say whether a value is better than before."""
    # for a ratio, nearer to 1 is better; a change that the digits do not show counts for none
    gain = (value - before) * (1 if more else -1) if more is not None else abs(before - 1) - abs(value - 1)
    if abs(gain) < 0.5 * 10**-digits:
        return "", BLACK
    return ("\N{BLACK UP-POINTING TRIANGLE}", BLUE) if gain > 0 else ("\N{BLACK DOWN-POINTING TRIANGLE}", _WORSE)

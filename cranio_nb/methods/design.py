"""One way to run any method: a bone mask and its openings come in -> a `Prosthesis` goes out.

Frames: voxel (plane, row, col) in, world mm (LPS) out.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from ..errors import InputRefused
from ..opening import Opening
from ..prosthesis import Prosthesis
from ..vault.opening_search import find_openings
from ..volume import Volume
from .catalogue import PRESETS, check_options, method_module


def design(
    bone: Volume,
    openings: Sequence[Opening] | None = None,
    *,
    method: str = "slicewise",
    preset: str = "default",
    progress: Callable[[str, float], None] | None = None,
    **options: Any,
) -> Prosthesis:
    """Design what closes the openings of a skull.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull, planes rising to the top of the head.
    openings : sequence of Opening, optional
        Openings to close; found automatically when not given.
    method : str
        A name of the catalogue.
    preset : {"default", "paper"}
        Options to start from.
    progress : callable, optional
        Called with (stage, fraction done).
    **options
        Options of the method that differ from the preset.

    Returns
    -------
    Prosthesis

    Raises
    ------
    InputRefused
        Where the request is not known, or the method cannot serve this input.
    NoOpening
        When the vault is closed, or nothing could be bridged.
    """
    check_request(method, preset, options)
    openings = find_openings(bone) if openings is None else openings
    module = method_module(method)
    start = module.paper_options(bone) if preset == "paper" else {}
    made: Prosthesis = module.design(bone, openings, progress=progress, **(start | options))
    return made


def check_request(method: str, preset: str, options: dict[str, Any]) -> None:
    """Refuse a request that no input could serve, before anything is read.

    Raises
    ------
    InputRefused
        ``UnknownMethod``, ``UnknownPreset`` or ``BadOption``.
    """
    if preset not in PRESETS:
        raise InputRefused("UnknownPreset", f"There is no preset named {preset!r}.", f"Known are {', '.join(PRESETS)}.")
    if preset == "paper" and not hasattr(method_module(method), "paper_options"):
        raise InputRefused("UnknownPreset", f"The method {method} has no preset of the paper.", "Use the default.")
    check_options(method, options)

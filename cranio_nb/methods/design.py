"""One way to run any method: a bone mask and its openings come in -> a `Prosthesis` goes out.

Frames: voxel (plane, row, col) in, world mm (LPS) out.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from importlib.metadata import version
from typing import Any

import numpy as np

from ..errors import InputRefused, NoOpening
from ..geometry import face_sides
from ..grid import true_indices
from ..mesh import Mesh
from ..opening import Opening
from ..prosthesis import Prosthesis
from ..stages import surface_reconstruction
from ..vault.opening_search import find_openings
from ..vault.ray_casting import FAR_MM
from ..volume import Volume, same_grid
from .catalogue import COMMON, check_options, check_preset, default_options, find_method, preset_options
from .piece import Piece

Progress = Callable[[str, float], None]
Shaped = Callable[[Prosthesis], None]
_SURFACE = 0.9  # part of the work that is done when all pieces are made


def design(
    bone: Volume,
    openings: Sequence[Opening] | None = None,
    *,
    scan: Volume | None = None,
    method: str = "slicewise",
    preset: str = "default",
    progress: Progress | None = None,
    shaped: Shaped | None = None,
    **options: Any,
) -> Prosthesis:
    """Design what closes the openings of a skull.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull, planes rising to the top of the head.
    openings : sequence of Opening, optional
        Openings to close; found automatically when not given.
    scan : Volume, optional
        HU on the same grid, by which openings that are not given are found; see `find_openings`.
    method : str
        A name of the catalogue.
    preset : str
        Options to start from: "default", or a preset of the method such as "paper".
    progress : callable, optional
        Called with (stage, fraction done).
    shaped : callable, optional
        Called with the prosthesis before it has a surface and a record: pictures of its voxels may begin.
    **options
        Options of the method that differ from the preset. Every method has `smooth`: a surface without stairs (see
        `surface_reconstruction.extract_surface`).

    Returns
    -------
    Prosthesis
        `parameters` holds every option, `working` what the method kept of each opening.

    Raises
    ------
    InputRefused
        Where the request is not known, or the method cannot serve this input.
    NoOpening
        When the vault is closed, the list of openings is empty, or nothing could be bridged.

    Examples
    --------
    >>> import cranio_nb as cn
    >>> from data_synth import phantom_case
    >>> case = phantom_case("tiny", "burr_hole", 0)
    >>> made = cn.design(cn.Volume(case.bone, case.affine), method="hull")
    >>> made.method, made.parameters
    ('hull', {'axial': False, 'smooth': True})
    """
    check_request(method, preset, options)
    _check_bone(bone)
    openings = find_openings(bone, scan=scan) if openings is None else openings
    _check_openings(bone, openings)
    # what is asked for goes before the preset, and the preset before the defaults
    parameters = default_options(method) | preset_options(method, preset, bone) | options
    check_options(method, parameters)  # a preset may add to what was asked for
    own = {name: value for name, value in parameters.items() if name not in COMMON}
    pieces = find_method(method).pieces(bone, openings, **own)
    return assemble(bone, openings, pieces, method=method, parameters=parameters, progress=progress, shaped=shaped)


def assemble(
    bone: Volume,
    openings: Sequence[Opening],
    pieces: Iterable[Piece],
    *,
    method: str,
    parameters: dict[str, Any],
    progress: Progress | None = None,
    shaped: Shaped | None = None,
) -> Prosthesis:
    """Join the pieces of a method, give them a surface and a record.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    openings : sequence of Opening
        At least one; the outer side of the mesh is seen from its head centre.
    pieces : iterable of Piece
        One for each opening. Voxels of bone are taken off them.
    method : str
        Name of the method.
    parameters : dict
        Every option of the method; `smooth` is heeded here.
    progress : callable, optional
        Called with (stage, fraction done).
    shaped : callable, optional
        As for `design`.

    Returns
    -------
    Prosthesis

    Raises
    ------
    NoOpening
        ``NoOpening`` without an opening, ``NothingBridged`` where the pieces are empty.
    InputRefused
        ``BadPiece`` where a method does not yield a piece on the bone's grid for each opening.
    """
    _check_openings(bone, openings)
    report = progress or (lambda stage, done: None)
    began = time.perf_counter()
    report("design", 0.0)
    # methods are iterators: each opening is reported as it is done
    patch = np.zeros(bone.shape, bool)
    working: list[Any] = []
    records: list[dict[str, Any]] = []
    for piece in pieces:
        _check_piece(piece, bone, method)
        # bone is taken off a piece whose method does not do so itself
        where = tuple(true_indices(piece.voxels).T)
        patch[where] = ~bone.voxels[where]
        working += piece.working
        records.append(piece.record)
        report("design", min(_SURFACE * len(records) / len(openings), _SURFACE))
    _check_all(method, len(records), len(openings))
    if not patch.any():
        message = f"The method {method} could not bridge any part of the opening."
        raise NoOpening("NothingBridged", message, "Try another method or preset.")
    solid, no_mesh = bone.with_voxels(patch), Mesh(np.zeros((0, 3)), np.zeros((0, 3), int))
    shape = Prosthesis(no_mesh, np.zeros(0, np.uint8), solid, method, parameters, {}, tuple(working))
    if shaped is not None:
        shaped(shape)
    report("surface", _SURFACE)
    # stage 5 and the sides, from the joined voxels: openings may touch
    mesh = surface_reconstruction.extract_surface(solid, smooth=parameters["smooth"])
    sides = face_sides.label_faces(mesh, bone, openings[0].head_centre)
    record = {"version": version("cranio-nb"), "seconds": time.perf_counter() - began, **join_records(records)}
    return replace(shape, mesh=mesh, sides=sides, record=record)


def join_records(records: Sequence[dict[str, Any]]) -> dict[str, Any]:
    """The record of a design from those of its pieces.

    Parameters
    ----------
    records : sequence of dict
        In the order of the openings.

    Returns
    -------
    dict
        Lists are joined, each entry with the index of its opening; of anything else the last value is kept.

    Examples
    --------
    >>> from cranio_nb.methods.design import join_records
    >>> join_records([{"slices": [{"plane": 3}], "n": 1}, {"slices": [{"plane": 8}], "n": 1}])
    {'slices': [{'opening': 0, 'plane': 3}, {'opening': 1, 'plane': 8}], 'n': 1}
    """
    joined: dict[str, Any] = {}
    for index, record in enumerate(records):
        for key, value in record.items():
            if isinstance(value, list):
                joined.setdefault(key, []).extend({"opening": index, **entry} for entry in value)
            else:
                joined[key] = value
    return joined


def check_request(method: str, preset: str, options: dict[str, Any]) -> None:
    """Refuse a request that no input could serve, before anything is read.

    Parameters
    ----------
    method, preset : str
        Names.
    options : dict
        Options of the method that differ from the preset.

    Raises
    ------
    InputRefused
        ``UnknownMethod``, ``UnknownPreset``, ``UnknownOption``, ``BadOption`` or ``TooMuchWork``.
    """
    check_preset(method, preset)
    check_options(method, options)


def _check_bone(bone: Volume) -> None:
    """Refuse what is no mask of a skull."""
    if bone.voxels.dtype != bool:
        message = f"The bone is given as {bone.voxels.dtype}; a bool mask is wanted."
        raise InputRefused("NotAMask", message, "Make one with `cn.segment`.")
    if min(bone.shape) < 2 or not bone.voxels.any():
        message = f"The mask of the bone, shape {bone.shape}, holds no skull."
        raise InputRefused("NoBone", message, "Give the mask of a whole vault.")


def _check_openings(bone: Volume, openings: Sequence[Opening]) -> None:
    """Refuse openings that are none, or that belong to another skull."""
    if not len(openings):
        raise NoOpening("NoOpening", "The list of openings is empty.", "Give one opening at least.")
    for i, one in enumerate(openings, 1):
        if not same_grid(bone, one.sheet):
            message = f"Opening {i} has the shape {one.sheet.shape}, the bone {bone.shape}, or they lie apart."
            raise InputRefused("GridMismatch", message, "Give openings on the bone's own grid.")
        if not one.sheet.voxels.any() or not np.isfinite(one.head_centre).all():
            raise InputRefused("NoHole", f"Opening {i} holds no voxel, or has no centre to be seen from.")
        away = float(np.linalg.norm(one.centre - one.head_centre))
        if away > FAR_MM:
            message = f"The head's centre lies {away:.0f} mm from opening {i}; rays from it reach {FAR_MM:.0f} mm."
            raise InputRefused("NoHole", message, "Give the middle of this head, world mm.")


def _check_piece(piece: Any, bone: Volume, method: str) -> None:
    """Refuse what is no piece on the grid of the bone."""
    if isinstance(piece, Piece) and piece.voxels.shape == bone.shape and piece.voxels.dtype == bool:
        return
    found = f"{piece.voxels.dtype} {piece.voxels.shape}" if isinstance(piece, Piece) else type(piece).__name__
    message = f"The method {method} made a piece of {found}; wanted is a Piece with bool voxels {bone.shape}."
    raise InputRefused("BadPiece", message, "Yield Piece(voxels) on the bone's own grid.")


def _check_all(method: str, n_pieces: int, n_openings: int) -> None:
    """Refuse a method that left out an opening, or made more of them."""
    if n_pieces != n_openings:
        message = f"The method {method} made {n_pieces} pieces for {n_openings} openings."
        raise InputRefused("BadPiece", message, "Yield one Piece for each opening, an empty one where nothing is done.")

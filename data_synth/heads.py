"""Which synthetic head, its size, defect and seed -> a case."""

from .case import Case
from .face import face_case
from .phantom import phantom_case

HEADS = ("face", "simple")
"""The synthetic heads: with a face, skull base and neck, or a dome with a closed form for everything."""


def head_case(head: str, size: str = "class", defect: str = "unilateral", seed: int = 0) -> Case:
    """One of the synthetic heads, with a hole.

    Parameters
    ----------
    head : {"face", "simple"}
        See `HEADS`.
    size : {"tiny", "class", "full"}
        Grid; see `SIZES`.
    defect : str
        A key of `DEFECTS`.
    seed : int
        Chooses head, place, size and rim of the hole.

    Returns
    -------
    Case

    Raises
    ------
    ValueError
        If a name is not one of these.

    Examples
    --------
    >>> [head_case(name, "tiny").bone.shape for name in HEADS]
    [(54, 128, 128), (44, 128, 128)]
    """
    if head not in HEADS:
        raise ValueError(f"There is no head named {head!r}; choose one of {', '.join(HEADS)}.")
    return face_case(size, seed, holes=defect) if head == "face" else phantom_case(size, defect, seed)

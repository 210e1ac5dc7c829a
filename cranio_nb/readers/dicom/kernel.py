"""The name of a reconstruction kernel -> whether it is sharp or soft."""

from __future__ import annotations

import re

_SOFT = ("SOFT", "SMOOTH", "STANDARD", "BRAIN", "STND")


def describe_kernel(kernel: str) -> str:
    """What may be said of a kernel: a maker's name for it is text of the header.

    Parameters
    ----------
    kernel : str

    Returns
    -------
    {"sharp", "soft", "unknown"}

    Examples
    --------
    >>> [describe_kernel(name) for name in ("BONE", "H31s", "DOE^JOHN", "")]
    ['sharp', 'soft', 'unknown', 'unknown']
    """
    name = kernel.upper()
    if is_sharp(name):
        return "sharp"
    coded = re.fullmatch(r"(H|B|J|U|HR|BR|HC|BL|FC)\d\d?.{0,3}(/\d)?", name)
    return "soft" if coded or name in _SOFT or name in ("UA", "UB", "UC") else "unknown"


def is_sharp(kernel: str) -> bool:
    """Whether a kernel's name is one of the makers' for edges: bone, lung, or a high number.

    Parameters
    ----------
    kernel : str
        Words and codes, in capitals or not.

    Returns
    -------
    bool

    Examples
    --------
    >>> [is_sharp(name) for name in ("Bone", "H70h", "H31s", "Hr64", "FC30", "YC", "YA", "")]
    [True, True, False, True, True, True, False, False]
    """
    kernel = kernel.upper()
    # by its own name
    if any(word in kernel for word in ("BONE", "SHARP", "EDGE", "LUNG", "DETAIL", "ULTRA")):
        return True
    # by the makers' codes: letters, and a number that rises with sharpness
    letters, digits = kernel[:2].rstrip("0123456789"), "".join(c for c in kernel.split("/")[0] if c.isdigit())
    if kernel.startswith(("YB", "YC", "YD")):
        return True
    return bool(digits) and (
        (letters in {"H", "B", "J", "U", "HR", "BR", "HC", "BL"} and int(digits[:2]) >= 55)
        or (letters == "FC" and int(digits[:2]) in (*range(30, 36), *range(50, 60), *range(80, 90)))
    )

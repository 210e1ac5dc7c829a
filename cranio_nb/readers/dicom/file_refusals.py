"""The refusals that name one file of a folder, by its index: it is damaged, or declares more than is read."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from contextlib import contextmanager

from ...errors import InputRefused


@contextmanager
def refusing(file: int) -> Iterator[None]:
    """Turn whatever the parsing of a file raises into one sentence that names the file by its index.

    Parameters
    ----------
    file : int
        Index among the folder's files.

    Returns
    -------
    context manager

    Raises
    ------
    InputRefused
        ``CorruptDicom``.

    Examples
    --------
    >>> with refusing(7):
    ...     int("no number")
    Traceback (most recent call last):
    cranio_nb.errors.InputRefused: DICOM file 7 of the folder cannot be parsed (ValueError). Copy the scan again ...
    """
    try:
        with warnings.catch_warnings():
            # odd values are judged later, when it is known whether they matter
            warnings.simplefilter("ignore")
            yield
    except InputRefused:
        raise
    except Exception as error:
        # a broken file may raise anything; its own words stay inside
        raise corrupt(file, f"cannot be parsed ({type(error).__name__})") from None


def corrupt(file: int, what: str, code: str = "CorruptDicom") -> InputRefused:
    """The refusal for a damaged file.

    Parameters
    ----------
    file : int
        Index among the folder's files.
    what : str
        What is wrong with it: the end of a sentence.
    code : str
        Code of the refusal.

    Returns
    -------
    InputRefused
    """
    return InputRefused(code, f"DICOM file {file} of the folder {what}.", "Copy the scan again from its source.")


def over_limit(file: int, what: str, declared: object, cap: int) -> InputRefused:
    """The refusal for a file that declares more than is read.

    Parameters
    ----------
    file : int
        Index among the folder's files.
    what : str
        What there is too much of, in the plural.
    declared : object
        How much the file declares.
    cap : int
        How much is read at most.

    Returns
    -------
    InputRefused
        ``LimitExceeded``.

    Examples
    --------
    >>> print(over_limit(7, "rows", 5000, 4096))
    DICOM file 7 of the folder declares 5000 rows; at most 4096 are read. ...
    """
    message = f"DICOM file {file} of the folder declares {declared} {what}; at most {cap} are read."
    return InputRefused("LimitExceeded", message, "Check where the file comes from.")

"""What went wrong, in one sentence, with what to do about it.

Every error of the package is a `CranioError`. It carries a stable `code`, a plain sentence and a remedy, never
patient text and never a full path. The subclass says what failed, reading, finding or writing, and fixes
the exit code of the command line.
"""


class CranioError(ValueError):
    """An input or a request that cannot be served.

    Parameters
    ----------
    code : str
        Stable name of the fault in CamelCase, e.g. ``"MissingSlices"``.
    message : str
        One sentence: what was found and what was wanted.
    remedy : str
        What to try next; may be empty.

    Examples
    --------
    >>> raise CranioError("NoHead", "The folder holds no head.", "Give another folder.")
    Traceback (most recent call last):
    cranio_nb.errors.CranioError: The folder holds no head. Give another folder.
    """

    exit_code = 3

    def __init__(self, code: str, message: str, remedy: str = "") -> None:
        super().__init__(f"{message} {remedy}".strip())
        self.code, self.message, self.remedy = code, message, remedy


class InputRefused(CranioError):
    """The input cannot be read safely, or is not what the step needs (exit code 3)."""


class NoOpening(CranioError):
    """The skull has no opening to close (exit code 4)."""

    exit_code = 4


class CannotWrite(CranioError):
    """An output could not be written; nothing was left behind (exit code 5)."""

    exit_code = 5

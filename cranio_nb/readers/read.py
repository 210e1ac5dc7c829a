"""Path -> volume and load report: finds out what the path is, and turns whatever goes wrong into one sentence."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path

from ..errors import CranioError, InputRefused
from ..volume import Volume
from .load_report import LoadReport

ALLOWANCES = ("gap_fill", "implausible_hu", "no_orientation", "no_rescale", "wrong_modality")
_ARCHIVES = (
    b"PK\x03\x04",
    b"PK\x05\x06",
    b"7z\xbc\xaf\x27\x1c",
    b"Rar!\x1a\x07",
    b"BZh",
    b"\xfd7zXZ\0",
    b"\x28\xb5\x2f\xfd",
)


def read_ct(
    path: str | PathLike[str],
    *,
    mask: bool | None = None,
    label: int | None = None,
    allow: Collection[str] = (),
    progress: Callable[[int, int], None] | None = None,
) -> tuple[Volume, LoadReport]:
    """Read a head CT, or a bone mask, with a report of what was found, chosen, left and corrected.

    Parameters
    ----------
    path : path
        A folder of DICOM files (any names, up to 8 levels of subfolders), a multi-frame DICOM file, a NIfTI file
        (``.nii``, ``.nii.gz``) or a NRRD file.
    mask : bool, optional
        True takes every nonzero voxel as bone, where there are 0 and one other value; False takes the values as HU.
        By default data of nothing but 0 and 1
        are a mask.
    label : int, optional
        Takes the voxels of this value as bone: the skull's label in a map of labels.
    allow : collection of str
        Relaxations, each by its name, each leaving a warning in the report:
        ``"gap_fill"`` interpolates missing slices; ``"implausible_hu"`` takes values that do not look like HU;
        ``"no_orientation"`` takes a NIfTI or NRRD file without orientation as it lies; ``"no_rescale"`` takes
        values without rescale slope and intercept as HU; ``"wrong_modality"`` takes images that are not CT.
    progress : callable, optional
        Called with (slices done, slices in all).

    Returns
    -------
    volume : Volume
        Planes rise to the top of the head, rows to the back, columns to the left (LPS mm; axes are only permuted and
        flipped). HU as int16 where they are whole numbers, else float32; bool for a mask.
    report : LoadReport

    Raises
    ------
    InputRefused
        Whatever cannot be read safely, with a stable code, one sentence and a remedy.

    Examples
    --------
    A synthetic head is written as a DICOM series and read again:

    >>> from data_synth import phantom_case, write_dicom
    >>> case = phantom_case("tiny", "unilateral", 0)
    >>> files = write_dicom("head_ct", case.hu, case.affine)
    >>> ct, report = read_ct("head_ct")
    >>> bool((ct.voxels == case.hu).all()), report.source, report.kind
    (True, 'DICOM', 'ct')
    >>> report.findings[0].message
    'Read series 2: 44 slices of 128 x 128, 3.00 mm apart, soft kernel.'
    """
    _check_allowances(allow)
    with _refusing():
        path = Path(path)
        if not path.exists():
            raise InputRefused("NotFound", "There is no such file or folder.", "Check the path.")
        if path.is_file():
            _check_not_packed(path)
        # each format's library is loaded only where it is needed
        if path.is_dir() or (path.is_file() and _looks_like_dicom(path)):
            from .dicom.read import read_dicom

            return read_dicom(path, mask=mask, label=label, allow=allow, progress=progress)
        if path.is_file():
            from .image_file import read_image

            return read_image(path, mask=mask, label=label, allow=allow)
        raise InputRefused("UnsupportedFile", "The path is neither a folder nor a regular file.")


def _check_allowances(allow: Collection[str]) -> None:
    """Refuse names that are not in `ALLOWANCES`."""
    unknown = sorted(set(allow) - set(ALLOWANCES))
    if unknown:
        known = ", ".join(ALLOWANCES)
        raise InputRefused("UnknownAllowance", f"There is no allowance named {unknown[0]!r}.", f"Known are: {known}.")


@contextmanager
def _refusing() -> Iterator[None]:
    """Turn whatever the reading raises into one sentence, without the input's own words."""
    try:
        yield
    except CranioError:
        raise
    except PermissionError:
        raise InputRefused("PermissionDenied", "The path may not be read.", "Check its permissions.") from None
    except MemoryError:
        raise InputRefused("LimitExceeded", "The scan does not fit into memory.", "Free memory, or crop it.") from None
    except Exception as error:
        # broken input may raise anything
        message = f"The input cannot be read ({type(error).__name__})."
        raise InputRefused("CorruptFile", message, "Export the scan again from its source.") from None


def _check_not_packed(path: Path) -> None:
    """Refuse an archive, and the index of a disc: what is wanted lies in or beside it."""
    with open(path, "rb") as stream:
        start = stream.read(264)
    if start[257:262] == b"ustar" or any(start.startswith(mark) for mark in _ARCHIVES):
        raise InputRefused("UnsupportedFile", "The file is an archive.", "Unpack it, and give the folder of the scan.")
    if path.name.lower() == "dicomdir":
        message = "The file is the index of a disc (DICOMDIR), which holds no images itself."
        raise InputRefused("UnsupportedFile", message, "Give the folder that it lies in.")


def _looks_like_dicom(path: Path) -> bool:
    """Whether a file begins as DICOM does."""
    from .dicom.file_list import looks_like_dicom

    with open(path, "rb") as stream:
        return looks_like_dicom(stream.read(136))

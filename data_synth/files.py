"""Files -> voxels and affine, for a virtual craniectomy; a case -> a folder of files.

Frames: voxel (plane, row, col), planes up, rows to the back, columns to the left; world mm, DICOM LPS. NIfTI keeps
the voxels as (col, row, plane) with an RAS affine; the conversion is made here.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import nibabel
import nrrd
import numpy as np
import pydicom
from numpy.typing import NDArray
from pydicom.errors import InvalidDicomError

from .case import Case
from .series import new_folder, write_dicom

Array = NDArray[np.float64]
_FLIP_XY = np.diag([-1.0, -1.0, 1.0, 1.0])  # RAS <-> LPS


def read_scan(path: str | Path) -> tuple[NDArray, Array, bool]:
    """Read an intact skull.

    Parameters
    ----------
    path : path
        Folder with one DICOM series (evenly spaced), or a .nii, .nii.gz or .nrrd file of HU or of a mask.

    Returns
    -------
    voxels : ndarray, shape (P, R, C)
        int16 HU, or bool for a mask.
    affine : ndarray, shape (4, 4)
        Voxel -> world mm (LPS).
    is_mask : bool
        Whether the file holds only two values, 0 and another.

    Raises
    ------
    ValueError
        If the input is none of these, or is not one even series.
    """
    path = Path(path)
    if path.is_dir():
        voxels, affine = _read_series(path)
    elif path.name.lower().endswith((".nii", ".nii.gz")):
        image = nibabel.nifti1.load(path)
        voxels, affine = np.asarray(image.dataobj), _FLIP_XY @ np.asarray(image.affine)
    elif path.name.lower().endswith(".nrrd"):
        voxels, affine = _read_nrrd(path)
    else:
        raise ValueError(f"{path.name!r} is no folder and no .nii, .nii.gz or .nrrd file.")
    if voxels.ndim != 3:
        raise ValueError(f"{path.name!r} has {voxels.ndim} dimensions; 3 are wanted.")
    voxels, affine = _canonical(voxels, affine)
    is_mask = voxels.min() == 0 and bool(np.isin(voxels, [0, voxels.max()]).all())
    return (voxels != 0) if is_mask else np.rint(voxels).astype(np.int16), affine, is_mask


def write_case(folder: str | Path, case: Case) -> None:
    """Write a case: `ct/` (DICOM) or `mask.nii.gz`, `truth.nii.gz` and `truth.json`; all of it or nothing.

    Parameters
    ----------
    folder : path
        A new or an empty folder.
    case : Case
        What to write.

    Raises
    ------
    FileExistsError
        If the folder holds files, or is a file.
    """
    with new_folder(folder) as part:
        _write_parts(part, case)


def _write_parts(folder: Path, case: Case) -> None:
    if case.hu is None:
        _save_nifti(folder / "mask.nii.gz", case.bone, case.affine)
    else:
        write_dicom(folder / "ct", case.hu, case.affine)
    _save_nifti(folder / "truth.nii.gz", case.implant, case.affine)
    (folder / "truth.json").write_text(json.dumps(_record(case), indent=1) + "\n", encoding="utf-8")


def _record(case: Case) -> dict[str, Any]:
    """What truth.json says."""
    planes = np.flatnonzero(case.implant.any(axis=(1, 2)))
    return {
        "defect": case.defect,
        "seed": case.seed,
        "parameters": case.parameters,
        "shape": case.bone.shape,
        "affine": case.affine.tolist(),
        "bone_mm3": float(case.bone.sum() * case.voxel_volume),
        "implant_mm3": float(case.implant.sum() * case.voxel_volume),
        "planes": [int(planes[0]), int(planes[-1]) + 1],
        "slices": [gap.as_dict() for plane in planes for gap in case.slice_truth(int(plane))],
    }


def _save_nifti(path: Path, mask: NDArray[np.bool_], affine: Array) -> None:
    steps = _FLIP_XY @ affine[:, [2, 1, 0, 3]]
    image = nibabel.Nifti1Image(mask.transpose(2, 1, 0).astype(np.uint8), steps)
    image.header.set_xyzt_units("mm")
    nibabel.save(image, path)


def _read_series(folder: Path) -> tuple[NDArray, Array]:
    slices = [ds for path in sorted(folder.rglob("*")) if (ds := _read_slice(path)) is not None]
    if len({ds.SeriesInstanceUID for ds in slices}) != 1 or len(slices) < 3:
        raise ValueError(f"{folder.name!r} holds {len(slices)} CT slices; one series of at least 3 is wanted.")
    across, down = np.array(slices[0].ImageOrientationPatient, float).reshape(2, 3)
    slices.sort(key=lambda ds: float(np.cross(across, down) @ np.array(ds.ImagePositionPatient, float)))
    starts = np.array([ds.ImagePositionPatient for ds in slices], float)
    step = (starts[-1] - starts[0]) / (len(starts) - 1)
    if np.abs(np.diff(starts, axis=0) - step).max() > 0.05:
        raise ValueError(f"The slices of {folder.name!r} are not evenly spaced.")
    rows, cols = (float(v) for v in slices[0].PixelSpacing)
    affine = np.eye(4)
    affine[:3] = np.column_stack([step, down * rows, across * cols, starts[0]])
    return np.stack([_hu(ds) for ds in slices]), affine


def _read_slice(path: Path) -> pydicom.Dataset | None:
    """A CT slice with pixels, or None for any other file."""
    try:
        ds = pydicom.dcmread(path)
    except (InvalidDicomError, IsADirectoryError, PermissionError):
        return None
    return ds if ds.get("Modality") == "CT" and "PixelData" in ds and "ImagePositionPatient" in ds else None


def _hu(ds: pydicom.Dataset) -> NDArray:
    return ds.pixel_array * float(ds.get("RescaleSlope", 1)) + float(ds.get("RescaleIntercept", 0))


def _read_nrrd(path: Path) -> tuple[NDArray, Array]:
    voxels, header = nrrd.read(str(path))
    space = str(header.get("space", "")).lower()
    signs = {"left-posterior-superior": [1, 1, 1], "right-anterior-superior": [-1, -1, 1]}
    signs |= {"lps": [1, 1, 1], "ras": [-1, -1, 1], "left-anterior-superior": [1, -1, 1], "las": [1, -1, 1]}
    if space not in signs:
        raise ValueError(f"{path.name!r} has the space {space!r}; LPS, RAS or LAS is wanted.")
    affine = np.eye(4)
    affine[:3, :3], affine[:3, 3] = np.transpose(header["space directions"]), header["space origin"]
    return voxels, np.diag([*signs[space], 1.0]) @ affine


def _canonical(voxels: NDArray, affine: Array) -> tuple[NDArray, Array]:
    """Axes permuted and flipped so that planes rise, rows go back and columns go left."""
    axes = nibabel.orientations.io_orientation(affine)
    order = [int(np.flatnonzero(axes[:, 0] == world)[0]) for world in (2, 1, 0)]
    signs = axes[order, 1].astype(int)
    turned = voxels.transpose(order)[tuple(slice(None, None, sign) for sign in signs)]
    steps, result = affine[:3, order], np.eye(4)
    last = np.where(signs < 0, np.array(turned.shape) - 1, 0)
    result[:3, :3], result[:3, 3] = steps * signs, affine[:3, 3] + steps @ last
    return np.ascontiguousarray(turned), result

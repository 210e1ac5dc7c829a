"""The small head as a NIfTI or NRRD file, so that the reader tests can write any file and break it in any way."""

from pathlib import Path

import nibabel as nib
import nrrd
import numpy as np
import pytest
from dicom_series import ORIGIN, SPACING, STEP, head

from cranio_nb.errors import InputRefused
from cranio_nb.readers import read_ct
from cranio_nb.volume import Volume

SMALL = (12, 26, 30)


LPS_TO_RAS = np.diag([-1.0, -1.0, 1.0, 1.0])


def stored_head() -> tuple[np.ndarray, np.ndarray]:
    """(col, row, plane) voxels of the head and their index -> LPS mm, as most files have them."""
    affine = np.diag([SPACING[1], SPACING[0], STEP, 1.0])
    affine[:3, 3] = ORIGIN
    return head(SMALL).transpose(2, 1, 0), affine


def write_nifti(path: Path, voxels: np.ndarray, lps: np.ndarray, **header: object) -> Path:
    image = nib.Nifti1Image(voxels, LPS_TO_RAS @ lps)
    image.header.set_xyzt_units("mm")
    for name, value in header.items():
        image.header[name] = value
    nib.save(image, path)
    return path


def write_nrrd(path: Path, voxels: np.ndarray, lps: np.ndarray, **header: object) -> Path:
    fields = {"space": "left-posterior-superior", "space directions": lps[:3, :3].T, "space origin": lps[:3, 3]}
    fields |= {name.replace("_", " "): value for name, value in header.items()}
    nrrd.write(str(path), voxels, {name: value for name, value in fields.items() if value is not None})
    return path


def file_refusal(path: Path, **options: object) -> InputRefused:
    with pytest.raises(InputRefused) as caught:
        read_ct(path, **options)
    assert str(path) not in str(caught.value) and path.name not in str(caught.value)
    assert caught.value.message.endswith(".")
    return caught.value


def assert_head(volume: Volume) -> None:
    np.testing.assert_array_equal(volume.voxels, head(SMALL))
    np.testing.assert_allclose(volume.affine[:3, 3], ORIGIN, atol=1e-4)
    np.testing.assert_allclose(volume.spacing, (STEP, *SPACING), atol=1e-6)


def patch_header(path: Path, **values: object) -> None:
    """Change fields of a written .nii without its writer's help."""
    content = bytearray(path.read_bytes())
    header = nib.Nifti1Header(bytes(content[:348]), check=False)
    for name, value in values.items():
        header[name] = value
    content[:348] = header.binaryblock
    path.write_bytes(content)


def rewrite_header(path: Path, field: str, value: str | None) -> None:
    """Change or drop one line of a NRRD header, or add it."""
    header, voxels = path.read_bytes().split(b"\n\n", 1)
    lines = [line for line in header.split(b"\n") if not line.startswith(field.encode() + b":")]
    lines += [] if value is None else [f"{field}: {value}".encode()]
    path.write_bytes(b"\n".join(lines) + b"\n\n" + voxels)

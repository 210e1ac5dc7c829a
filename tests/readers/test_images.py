"""NIfTI and NRRD files: the same world as the DICOM series, and no guess where the file does not say."""

import bz2
import gzip
import zlib
from collections.abc import Callable
from itertools import permutations, product
from pathlib import Path

import nibabel as nib
import nrrd
import numpy as np
import pytest
from dicom_series import ORIGIN, SPACING, STEP, head, save, series

from cranio_nb.errors import InputRefused
from cranio_nb.readers import read_ct
from cranio_nb.volume import Volume, same_grid

SMALL = (12, 26, 30)
LPS_TO_RAS = np.diag([-1.0, -1.0, 1.0, 1.0])
CENTRE = np.array(ORIGIN)


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


def refusal(path: Path, **options: object) -> InputRefused:
    with pytest.raises(InputRefused) as caught:
        read_ct(path, **options)
    assert str(path) not in str(caught.value) and path.name not in str(caught.value)
    assert caught.value.message.endswith(".")
    return caught.value


def assert_head(volume: Volume) -> None:
    np.testing.assert_array_equal(volume.voxels, head(SMALL))
    np.testing.assert_allclose(volume.affine[:3, 3], ORIGIN, atol=1e-4)
    np.testing.assert_allclose(volume.spacing, (STEP, *SPACING), atol=1e-6)


def test_dicom_nifti_and_nrrd_stand_at_the_same_place(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    dicom, _ = read_ct(save(tmp_path / "scan", series(head(SMALL))))
    others = [
        write_nifti(tmp_path / "a.nii", voxels, lps),
        write_nifti(tmp_path / "a.nii.gz", voxels, lps),
        write_nrrd(tmp_path / "a.nrrd", voxels, lps),
        write_nrrd(tmp_path / "b.nrrd", voxels, lps, encoding="raw"),
        write_nrrd(tmp_path / "c.nrrd", voxels, lps, encoding="bzip2"),
        write_nrrd(tmp_path / "d.nrrd", voxels.astype(">i2"), lps),
    ]
    for path in others:
        volume, report = read_ct(path)
        assert volume.voxels.dtype == np.int16 and report.kind == "ct"
        assert same_grid(dicom, volume, tol=1e-3)
        np.testing.assert_array_equal(dicom.voxels, volume.voxels)
        np.testing.assert_allclose(report.stored_affine, lps, atol=1e-4)
        np.testing.assert_array_equal(volume.reorder(report.order.inverse).voxels, voxels)


@pytest.mark.parametrize(
    ("space", "signs"),
    [("left-posterior-superior", (1, 1)), ("right-anterior-superior", (-1, -1)), ("LAS", (1, -1)), ("RAS", (-1, -1))],
)
def test_every_nrrd_space_gives_the_same_world(space: str, signs: tuple[int, int], tmp_path: Path) -> None:
    voxels, lps = stored_head()
    volume, _ = read_ct(write_nrrd(tmp_path / "a.nrrd", voxels, np.diag([*signs, 1, 1]) @ lps, space=space))
    assert_head(volume)


@pytest.mark.parametrize("kind", ["nifti", "nrrd"])
@pytest.mark.parametrize("axes", list(permutations(range(3))))
@pytest.mark.parametrize("flips", list(product((1, -1), repeat=3)))
def test_every_axis_order_keeps_every_place(
    kind: str, axes: tuple[int, ...], flips: tuple[int, ...], tmp_path: Path
) -> None:
    voxels, lps = stored_head()
    swapped = voxels.transpose(axes)[tuple(slice(None, None, f) for f in flips)]
    affine = np.eye(4)
    affine[:3, :3] = lps[:3, axes] * flips
    affine[:3, 3] = lps[:3, 3] + lps[:3, axes] @ np.where(np.array(flips) < 0, np.array(swapped.shape) - 1, 0)
    write = write_nifti if kind == "nifti" else write_nrrd
    path = tmp_path / ("a.nii" if kind == "nifti" else "a.nrrd")
    volume, report = read_ct(write(path, np.ascontiguousarray(swapped), affine))
    assert_head(volume)
    np.testing.assert_array_equal(volume.reorder(report.order.inverse).voxels, swapped)


@pytest.mark.parametrize("dtype", ["u1", "i2", "u2", "i4", "f4", "f8"])
def test_zeros_and_ones_are_a_mask(dtype: str, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    bone = (voxels > 300).astype(dtype)
    for path in (write_nifti(tmp_path / "a.nii.gz", bone, lps), write_nrrd(tmp_path / "a.nrrd", bone, lps)):
        volume, report = read_ct(path)
        assert volume.voxels.dtype == bool and report.kind == "mask"
        np.testing.assert_array_equal(volume.voxels, head(SMALL) > 300)


def test_mask_can_be_forced_either_way(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    labels = write_nrrd(tmp_path / "a.nrrd", ((voxels > 300) * 255).astype("u1"), lps)
    volume, report = read_ct(labels, mask=True)
    assert report.kind == "mask" and volume.voxels.sum() == (voxels > 300).sum()
    assert refusal(labels).code == "ImplausibleHU"
    zeros_and_ones = write_nrrd(tmp_path / "b.nrrd", (voxels > 300).astype("u1"), lps)
    assert refusal(zeros_and_ones, mask=False).code == "ImplausibleHU"


def test_scaling_is_applied_or_reported(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = write_nifti(tmp_path / "a.nii", (voxels + 1024).astype(np.uint16), lps)
    patch_header(path, scl_slope=1.0, scl_inter=-1024.0)
    assert_head(read_ct(path)[0])
    path = write_nifti(tmp_path / "b.nii", voxels, lps)
    patch_header(path, scl_slope=np.inf, scl_inter=0.0)
    volume, report = read_ct(path)
    assert_head(volume)
    assert "BadScaling" in {f.code for f in report.findings}


def patch_header(path: Path, **values: object) -> None:
    """Change fields of a written .nii without its writer's help."""
    content = bytearray(path.read_bytes())
    header = nib.Nifti1Header(bytes(content[:348]), check=False)
    for name, value in values.items():
        header[name] = value
    content[:348] = header.binaryblock
    path.write_bytes(content)


@pytest.mark.parametrize(("unit", "factor"), [(1, 1e-3), (3, 1e3)])
def test_units_are_honoured(unit: int, factor: float, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    scaled = np.diag([factor, factor, factor, 1]) @ lps
    assert_head(read_ct(write_nifti(tmp_path / "a.nii", voxels, scaled, xyzt_units=unit))[0])


def test_nrrd_units_are_honoured(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = write_nrrd(tmp_path / "a.nrrd", voxels, np.diag([0.1, 0.1, 0.1, 1]) @ lps, space_units=["cm"] * 3)
    assert_head(read_ct(path)[0])


def test_metres_taken_for_millimetres_are_refused(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    assert refusal(write_nifti(tmp_path / "a.nii", voxels, np.diag([1e-3, 1e-3, 1e-3, 1]) @ lps)).code == "BadGeometry"


def test_single_fourth_axis_is_dropped_and_others_are_refused(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    assert_head(read_ct(write_nifti(tmp_path / "a.nii", voxels[..., None], lps))[0])
    assert refusal(write_nifti(tmp_path / "b.nii", np.stack([voxels] * 2, axis=-1), lps)).code == "BadShape"
    assert refusal(write_nifti(tmp_path / "c.nii", voxels[..., 0], lps)).code == "BadShape"
    directions = np.vstack([np.full(3, np.nan), lps[:3, :3].T])
    path = write_nrrd(tmp_path / "a.nrrd", voxels[None], lps, space_directions=directions)
    assert_head(read_ct(path)[0])
    path = write_nrrd(tmp_path / "b.nrrd", np.stack([voxels] * 2), lps, space_directions=directions)
    assert refusal(path).code == "BadShape"


def test_other_kinds_of_voxels_are_refused(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    assert refusal(write_nifti(tmp_path / "a.nii", voxels.astype("c8"), lps)).code == "UnsupportedPixels"
    colours = np.zeros(voxels.shape, [("R", "u1"), ("G", "u1"), ("B", "u1")])
    assert refusal(write_nifti(tmp_path / "b.nii", colours, lps)).code == "UnsupportedPixels"


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf])
def test_voxels_that_are_no_numbers_are_refused(bad: float, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    broken = voxels.astype(np.float32)
    broken[3, 4, 5] = bad
    assert refusal(write_nifti(tmp_path / "a.nii", broken, lps)).code == "NonFinite"
    assert refusal(write_nrrd(tmp_path / "a.nrrd", np.full_like(broken, bad), lps)).code == "NonFinite"


AFFINE_FAULTS: dict[str, Callable[[np.ndarray], np.ndarray]] = {
    "nan": lambda a: np.where(np.eye(4) == 1, np.nan, a),
    "zero": lambda a: a * [0, 1, 1, 1],
    "flat": lambda a: a[:, [0, 0, 2, 3]],
    "giant": lambda a: a * [50, 1, 1, 1],
}


@pytest.mark.parametrize("name", AFFINE_FAULTS)
def test_broken_affines_are_refused(name: str, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    affine = AFFINE_FAULTS[name](lps)
    path = write_nifti(tmp_path / "a.nii", voxels, lps)
    patch_header(path, **dict(zip(("srow_x", "srow_y", "srow_z"), LPS_TO_RAS[:3, :3] @ affine[:3], strict=True)))
    assert refusal(path).code == "BadGeometry"
    path = write_nrrd(tmp_path / "a.nrrd", voxels, lps)
    rewrite_header(path, "space directions", " ".join(f"({x},{y},{z})" for x, y, z in affine[:3, :3].T))
    assert refusal(path).code in {"BadGeometry", "CorruptFile"}


def rewrite_header(path: Path, field: str, value: str | None) -> None:
    """Change or drop one line of a NRRD header, or add it."""
    header, voxels = path.read_bytes().split(b"\n\n", 1)
    lines = [line for line in header.split(b"\n") if not line.startswith(field.encode() + b":")]
    lines += [] if value is None else [f"{field}: {value}".encode()]
    path.write_bytes(b"\n".join(lines) + b"\n\n" + voxels)


def test_pixdim_of_zero_is_refused(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = write_nifti(tmp_path / "a.nii", voxels, lps)
    patch_header(path, pixdim=[1, 0, 0.9, 1.5, 1, 1, 1, 1])
    assert refusal(path).code == "BadGeometry"


def test_sheared_planes_are_shifted_back(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    sheared = lps.copy()
    sheared[:3, 2] += [0, SPACING[0], 0]
    for path in (write_nifti(tmp_path / "a.nii", voxels, sheared), write_nrrd(tmp_path / "a.nrrd", voxels, sheared)):
        volume, report = read_ct(path)
        assert "Sheared" in {f.code for f in report.findings}
        axes = volume.affine[:3, :3] / volume.spacing
        np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-6)
        np.testing.assert_allclose(volume.reorder(report.order.inverse).affine, report.stored_affine, atol=1e-6)
        # a shift by whole pixels leaves every value: find each by its place
        index = np.argwhere(np.ones(voxels.shape, bool))
        at = np.rint(volume.to_voxel(index @ sheared[:3, :3].T + sheared[:3, 3])).astype(int)
        np.testing.assert_array_equal(volume.voxels[tuple(at.T)], voxels.ravel())


def test_no_orientation_is_refused_unless_allowed(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    nifti = write_nifti(tmp_path / "a.nii", voxels, lps)
    patch_header(nifti, sform_code=0, qform_code=0)
    no_space = write_nrrd(tmp_path / "a.nrrd", voxels, lps, space=None)
    scanner = write_nrrd(tmp_path / "b.nrrd", voxels, lps, space="scanner-xyz")
    for path in (nifti, no_space, scanner):
        error = refusal(path)
        assert error.code == "NoOrientation" and "no_orientation" in error.remedy
        volume, report = read_ct(path, allow=("no_orientation",))
        np.testing.assert_allclose(sorted(volume.spacing), sorted((STEP, *SPACING)), atol=1e-6)
        assert next(f for f in report.findings if f.code == "NoOrientation").severity == "warning"


def test_disagreeing_forms_are_reported(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    image = nib.Nifti1Image(voxels, LPS_TO_RAS @ lps)
    moved = LPS_TO_RAS @ lps
    moved[0, 3] += 30
    image.set_qform(moved, code=1)
    image.set_sform(LPS_TO_RAS @ lps, code=1)
    nib.save(image, tmp_path / "a.nii")
    volume, report = read_ct(tmp_path / "a.nii")
    assert_head(volume)
    assert "TwoOrientations" in {f.code for f in report.findings}


@pytest.mark.parametrize("suffix", ["nii", "nii.gz", "nrrd", "raw.nrrd"])
@pytest.mark.parametrize("keep", [0.05, 0.3, 0.7, 0.98])
def test_truncated_files_are_refused(suffix: str, keep: float, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = tmp_path / f"a.{suffix}"
    if "nii" in suffix:
        write_nifti(path, voxels, lps)
    else:
        write_nrrd(path, voxels, lps, encoding="raw" if "raw" in suffix else "gzip")
    path.write_bytes(path.read_bytes()[: int(path.stat().st_size * keep)])
    assert refusal(path).code == "CorruptFile"


def test_header_alone_and_offset_past_the_end_are_refused(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = write_nifti(tmp_path / "a.nii", voxels, lps)
    patch_header(path, vox_offset=1e6)
    assert refusal(path).code == "CorruptFile"
    patch_header(path, vox_offset=-100)
    assert refusal(path).code == "CorruptFile"
    path.write_bytes(path.read_bytes()[:352])
    patch_header(path, vox_offset=352)
    assert refusal(path).code == "CorruptFile"


def test_giant_sizes_are_refused_before_they_are_allocated(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = write_nifti(tmp_path / "a.nii", voxels, lps)
    patch_header(path, dim=[3, 32767, 32767, 32767, 1, 1, 1, 1])
    assert refusal(path).code == "LimitExceeded"
    path = write_nrrd(tmp_path / "a.nrrd", voxels, lps)
    rewrite_header(path, "sizes", "32767 32767 32767")
    assert refusal(path).code == "LimitExceeded"


def test_only_the_declared_bytes_are_inflated(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = write_nifti(tmp_path / "a.nii", voxels, lps)
    packer = zlib.compressobj(9, zlib.DEFLATED, zlib.MAX_WBITS | 16)
    zeros = bytes(2**24)
    packed = packer.compress(path.read_bytes()) + b"".join(packer.compress(zeros) for _ in range(16)) + packer.flush()
    (tmp_path / "b.nii.gz").write_bytes(packed)
    nrrd_path = write_nrrd(tmp_path / "a.nrrd", voxels, lps)
    header, content = nrrd_path.read_bytes().split(b"\n\n", 1)
    nrrd_path.write_bytes(header + b"\n\n" + gzip.compress(gzip.decompress(content) + zeros[:1000]))
    for path in (tmp_path / "b.nii.gz", nrrd_path):
        volume, report = read_ct(path)
        assert_head(volume)
        assert next(f for f in report.findings if f.code == "BytesLeft").severity == "warning"


@pytest.mark.parametrize("suffix", ["nii.gz", "nrrd", "bz2.nrrd"])
def test_every_damage_to_packed_voxels_is_found(suffix: str, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = tmp_path / f"a.{suffix}"
    if "nii" in suffix:
        write_nifti(path, voxels, lps)
        start = 20
    else:
        write_nrrd(path, voxels, lps, encoding="bzip2" if "bz2" in suffix else "gzip")
        start = path.read_bytes().index(b"\n\n") + 20
    good, rng = path.read_bytes(), np.random.default_rng(2)
    for at in rng.integers(start, len(good) - 8, 40):
        bad = bytearray(good)
        bad[at] ^= 1 << rng.integers(8)
        path.write_bytes(bad)
        try:
            assert_head(read_ct(path)[0])  # a bit that packs nothing
        except InputRefused as error:
            assert error.code in {"CorruptFile", "UnsupportedFile"}


@pytest.mark.parametrize("name", ["../secret.raw", "/etc/passwd", "a.raw"])
@pytest.mark.parametrize("field", ["data file", "datafile"])
def test_detached_voxels_are_refused(field: str, name: str, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = write_nrrd(tmp_path / "a.nrrd", voxels, lps)
    rewrite_header(path, field, name)
    (tmp_path / "a.raw").write_bytes(voxels.tobytes())
    assert refusal(path).code == "UnsupportedFile"


def test_other_nrrd_ways_are_refused(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    for field, value, code in (
        ("encoding", "hex", "UnsupportedFile"),
        ("byte skip", "7", "UnsupportedFile"),
        ("type", "block", "UnsupportedPixels"),
        ("endian", None, "CorruptFile"),
        ("sizes", None, "CorruptFile"),
        ("sizes", "30 26 x", "CorruptFile"),
        ("space origin", "(\u00fc22,0,0)", "CorruptFile"),
        ("space units", '"furlong" "furlong" "furlong"', "BadGeometry"),
    ):
        path = write_nrrd(tmp_path / "a.nrrd", voxels, lps)
        rewrite_header(path, field, value)
        assert refusal(path).code == code, field


def test_files_of_other_kinds_are_refused(tmp_path: Path) -> None:
    for name, content in (
        ("a.nii", b"no scan"),
        ("a.nii.gz", gzip.compress(b"no scan at all" * 100)),
        ("a.nrrd", b"NRRD"),
        ("empty.nii", b""),
        ("a.bz2", bz2.compress(b"x")),
    ):
        (tmp_path / name).write_bytes(content)
        assert refusal(tmp_path / name).code == "UnsupportedFile"


def test_unscaled_hu_are_refused_unless_allowed(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = write_nifti(tmp_path / "a.nii", voxels + 1024, lps)
    assert refusal(path).code == "ImplausibleHU"
    _, report = read_ct(path, allow=("implausible_hu",))
    assert report.findings[-1].severity == "warning"

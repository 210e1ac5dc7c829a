"""Good DICOM folders: every voxel keeps its value and its place, however the series is written or taken."""

import random
from itertools import permutations, product
from pathlib import Path

import numpy as np
import pytest
from dicom_series import AXIAL, ORIGIN, SHAPE, SPACING, STEP, edit, head, save, series, set_pixels
from hypothesis import given, settings
from hypothesis import strategies as st
from pydicom.dataset import Dataset
from pydicom.encaps import encapsulate
from pydicom.sequence import Sequence
from pydicom.uid import (
    DeflatedExplicitVRLittleEndian,
    ExplicitVRBigEndian,
    ImplicitVRLittleEndian,
    JPEG2000Lossless,
    JPEGLSLossless,
    RLELossless,
    generate_uid,
)

from cranio_nb.errors import InputRefused
from cranio_nb.readers import read_ct
from cranio_nb.readers.dicom.rescale import check_rescale
from cranio_nb.volume import Volume, same_grid

SMALL = (9, 22, 26)


def truth(orientation: object = AXIAL) -> np.ndarray:
    """(plane, row, col) index -> LPS mm of `series(head())`."""
    iop = np.array(orientation, float)
    cols, rows = iop[:3], iop[3:]
    affine = np.eye(4)
    affine[:3] = np.stack([np.cross(cols, rows) * STEP, rows * SPACING[0], cols * SPACING[1], ORIGIN], axis=1)
    return affine


def assert_same_places(volume: Volume, hu: np.ndarray, affine: np.ndarray, tol: float = 1e-3) -> None:
    """Every voxel of (hu, affine) is in the volume, at its own place."""
    index = np.stack(np.meshgrid(*map(np.arange, hu.shape), indexing="ij"), axis=-1).reshape(-1, 3)
    at = volume.to_voxel(index @ affine[:3, :3].T + affine[:3, 3])
    assert np.abs(at - np.rint(at)).max() < tol
    np.testing.assert_array_equal(volume.voxels[tuple(np.rint(at).astype(int).T)], hu.ravel())


def test_series_is_read_exactly(tmp_path: Path) -> None:
    volume, report = read_ct(save(tmp_path / "scan", series(head())))
    np.testing.assert_array_equal(volume.voxels, head())
    np.testing.assert_allclose(volume.affine, truth(), atol=1e-9)
    assert volume.voxels.dtype == np.int16 and volume.voxels.flags.c_contiguous
    assert (report.source, report.kind, report.shape) == ("DICOM", "ct", SHAPE)
    np.testing.assert_allclose(report.spacing, (STEP, *SPACING))
    assert report.corner_error < 1e-6
    assert [f.severity for f in report.findings] == ["info"]


def test_bead_on_the_left_has_the_largest_x(tmp_path: Path) -> None:
    volume, _ = read_ct(save(tmp_path / "scan", series(head())))
    bead = volume.to_world(np.argwhere(volume.voxels > 1400))
    bone = volume.to_world(np.argwhere(volume.voxels > 300))
    assert bead[:, 0].min() > np.median(bone[:, 0]) + 10


def test_report_leads_back_to_the_stored_grid(tmp_path: Path) -> None:
    iop = (0.0, 1.0, 0.0, 0.0, 0.0, -1.0)
    volume, report = read_ct(save(tmp_path / "scan", series(head(), orientation=iop)))
    stored = volume.reorder(report.order.inverse)
    np.testing.assert_allclose(stored.affine, report.stored_affine, atol=1e-9)
    cols, rows, slices = stored.affine[:3, :3].T
    np.testing.assert_allclose(cols, np.array(iop[:3]) * SPACING[1], atol=1e-9)
    np.testing.assert_allclose(rows, np.array(iop[3:]) * SPACING[0], atol=1e-9)
    assert abs(np.linalg.norm(slices) - STEP) < 1e-9


def test_progress_counts_the_slices(tmp_path: Path) -> None:
    seen: list[tuple[int, int]] = []
    read_ct(save(tmp_path / "scan", series(head())), progress=lambda done, total: seen.append((done, total)))
    assert seen == [(k + 1, SHAPE[0]) for k in range(SHAPE[0])]


def all_orientations() -> list[tuple[float, ...]]:
    """The 48 ways in which slices can lie along the axes of the patient: 24 for each side of the stack."""
    axes = np.eye(3)
    made = [
        (*(s * axes[i]), *(t * axes[j])) for i, j in permutations(range(3), 2) for s, t in product((1, -1), (1, -1))
    ]
    return [tuple(float(v) for v in iop) for iop in made]


@pytest.mark.parametrize("upside_down", [False, True])
@pytest.mark.parametrize("orientation", all_orientations())
def test_every_orientation_keeps_every_place(orientation: tuple[float, ...], upside_down: bool, tmp_path: Path) -> None:
    hu, iop = head(SMALL), np.array(orientation)
    direction = np.cross(iop[:3], iop[3:]) * (-1 if upside_down else 1)
    datasets = series(hu, orientation=orientation, direction=direction)
    volume, _ = read_ct(save(tmp_path / "scan", datasets))
    affine = truth(orientation)
    affine[:3, 0] = direction * STEP
    assert_same_places(volume, hu, affine)
    largest = np.abs(volume.affine[:3, :3]).argmax(axis=0)
    assert list(largest) == [2, 1, 0] and all(volume.affine[w, a] > 0 for a, w in enumerate(largest))


def test_oblique_stack_keeps_every_place(tmp_path: Path) -> None:
    rotation = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0]
    iop = tuple(rotation[:, :2].T.ravel())
    volume, _ = read_ct(save(tmp_path / "scan", series(head(SMALL), orientation=iop)))
    assert_same_places(volume, head(SMALL), truth(iop))


def test_moving_the_patient_moves_the_volume_alone(tmp_path: Path) -> None:
    still, _ = read_ct(save(tmp_path / "a", series(head(SMALL))))
    shift = np.array([31.4, -15.9, 265.3])
    moved, _ = read_ct(save(tmp_path / "b", series(head(SMALL), origin=np.array(ORIGIN) + shift)))
    np.testing.assert_array_equal(still.voxels, moved.voxels)
    np.testing.assert_allclose(moved.affine[:3, 3] - still.affine[:3, 3], shift, atol=1e-9)


def test_names_numbers_and_subfolders_do_not_matter(tmp_path: Path) -> None:
    datasets = series(head())
    shuffled = datasets[:]
    random.Random(5).shuffle(shuffled)
    edit(slice(None), InstanceNumber=None)(shuffled)
    save(tmp_path / "Schädel 頭 череп" / ("deep" * 20) / "c", shuffled[:10])
    save(tmp_path / "Schädel 頭 череп", shuffled[10:])
    for path in list(tmp_path.rglob("*.dcm")):
        path.rename(path.with_suffix(""))
    volume, _ = read_ct(tmp_path)
    np.testing.assert_array_equal(volume.voxels, head())
    np.testing.assert_allclose(volume.affine, truth(), atol=1e-9)


def big_endian(ds: Dataset) -> None:
    ds.PixelData = np.frombuffer(ds.PixelData, "<u2").astype(">u2").tobytes()


def jpeg2000(ds: Dataset) -> None:
    import openjpeg

    stored = np.frombuffer(ds.PixelData, "<u2").reshape(ds.Rows, ds.Columns)
    ds.PixelData = encapsulate([bytes(openjpeg.encode(stored, bits_stored=16))])
    ds["PixelData"].is_undefined_length = True


ENCODINGS = {
    "implicit": (ImplicitVRLittleEndian, lambda ds: None),
    "big endian": (ExplicitVRBigEndian, big_endian),
    "deflated": (DeflatedExplicitVRLittleEndian, lambda ds: None),
    "run length": (
        RLELossless,
        lambda ds: ds.compress(RLELossless, encoding_plugin="pydicom", generate_instance_uid=False),
    ),
    "JPEG-LS": (JPEGLSLossless, lambda ds: ds.compress(JPEGLSLossless, encoding_plugin="pyjpegls")),
    "JPEG 2000": (JPEG2000Lossless, jpeg2000),
}


@pytest.mark.parametrize("name", ENCODINGS)
def test_encoding_does_not_matter(name: str, tmp_path: Path) -> None:
    syntax, encode = ENCODINGS[name]
    hu = head((9, 42, 48))
    datasets = series(hu)
    for ds in datasets:
        encode(ds)
    volume, report = read_ct(save(tmp_path / "scan", datasets, syntax=syntax))
    np.testing.assert_array_equal(volume.voxels, hu)
    assert [f.severity for f in report.findings] == ["info"]


@pytest.mark.parametrize(("bits", "signed"), [*product((12, 14, 16, 32), (False, True))])
def test_every_width_and_sign_is_read_exactly(bits: int, signed: bool, tmp_path: Path) -> None:
    hu = head(SMALL)
    datasets = series(hu, bits=bits, signed=signed, intercept=0 if signed else -1024)
    volume, _ = read_ct(save(tmp_path / "scan", datasets))
    np.testing.assert_array_equal(volume.voxels, hu)


@pytest.mark.parametrize("signed", [False, True])
def test_rubbish_above_the_stored_bits_is_ignored(signed: bool, tmp_path: Path) -> None:
    hu = head(SMALL)
    datasets = series(hu, bits=12, signed=signed, intercept=0 if signed else -1024)
    for ds in datasets:
        stored = np.frombuffer(ds.PixelData, "<u2").copy()
        stored ^= (np.arange(stored.size) % 16 << 12).astype("<u2")
        ds.PixelData = stored.tobytes()
    volume, _ = read_ct(save(tmp_path / "scan", datasets))
    np.testing.assert_array_equal(volume.voxels, hu)


def test_eight_bit_slices_have_their_own_rescale(tmp_path: Path) -> None:
    hu = np.rint(head(SMALL) / 10).astype(np.int16) * 10
    volume, _ = read_ct(save(tmp_path / "scan", series(hu, bits=8, slope=10, intercept=-1000)))
    np.testing.assert_array_equal(volume.voxels, hu)


def test_each_slice_is_rescaled_by_its_own_slope(tmp_path: Path) -> None:
    hu = head(SMALL)
    datasets = series(hu)
    for k, ds in enumerate(datasets):
        ds.RescaleIntercept = -1024 - k
        stored = np.frombuffer(ds.PixelData, "<u2").reshape(ds.Rows, ds.Columns)
        set_pixels(ds, stored.astype(int) + k)
    volume, report = read_ct(save(tmp_path / "scan", datasets))
    np.testing.assert_array_equal(volume.voxels, hu)
    assert "RescaleVaries" in {f.code for f in report.findings}


def test_broken_slopes_give_real_hu(tmp_path: Path) -> None:
    hu = head(SMALL)
    volume, _ = read_ct(save(tmp_path / "scan", series(hu, slope=0.25, intercept=-1024.5)))
    assert volume.voxels.dtype == np.float32
    np.testing.assert_allclose(volume.voxels, hu, atol=0.126)


class OneSlice:
    """What `check_rescale` looks at."""

    def __init__(self, slope: float, intercept: float) -> None:
        self.slope, self.intercept = slope, intercept


@settings(max_examples=300, deadline=None)
@given(slope=st.floats(width=64), intercept=st.floats(width=64))
def test_any_rescale_is_refused_or_gives_finite_hu(slope: float, intercept: float) -> None:
    try:
        pairs, unscaled = check_rescale([OneSlice(slope, intercept)] * 2)  # type: ignore[list-item]
    except InputRefused as error:
        assert error.code == "BadRescale"
        return
    assert not unscaled and 1e-3 <= slope <= 1e3
    assert np.isfinite(pairs @ [65535.0, 1.0]).all()


def test_mask_in_dicom_is_recognised(tmp_path: Path) -> None:
    bone = (head() > 300).astype(np.int16)
    folder = save(tmp_path / "scan", series(bone, intercept=0))
    volume, report = read_ct(folder)
    assert volume.voxels.dtype == bool and report.kind == "mask"
    np.testing.assert_array_equal(volume.voxels, bone == 1)


def test_the_thin_axial_series_is_chosen(tmp_path: Path) -> None:
    thick = series(head()[::3], step=3 * STEP)
    coronal = series(head().transpose(1, 0, 2)[:, ::-1], orientation=(1, 0, 0, 0, 0, -1), step=0.9)
    edit(slice(None), ImageType=["DERIVED", "SECONDARY", "MPR"], SeriesNumber=7)(coronal)
    thin = series(head())
    for k, group in enumerate((thick, coronal, thin)):
        edit(slice(None), StudyInstanceUID="1.2.3", SeriesNumber=k + 5)(group)
        save(tmp_path / "exam" / str(k), group)
    volume, report = read_ct(tmp_path / "exam")
    np.testing.assert_array_equal(volume.voxels, head())
    assert [f.code for f in report.findings] == ["SeriesChosen", "SeriesSkipped", "SeriesSkipped"]
    assert report.findings[0].values["series"] == 7


def test_the_soft_kernel_is_chosen_among_equals(tmp_path: Path) -> None:
    soft, sharp = series(head()), series(head() + 1)
    edit(slice(None), ConvolutionKernel="H70h")(sharp)
    for name, group in (("a", sharp), ("b", soft)):
        edit(slice(None), StudyInstanceUID="1.2.3")(group)
        save(tmp_path / "exam" / name, group)
    volume, _ = read_ct(tmp_path / "exam")
    np.testing.assert_array_equal(volume.voxels, head())


@pytest.mark.parametrize(
    ("change", "code"), [("series", "AmbiguousSeries"), ("study", "AmbiguousSeries"), ("patient", "MixedPatients")]
)
def test_two_equal_scans_are_not_chosen_from(change: str, code: str, tmp_path: Path) -> None:
    for name in ("a", "b"):
        group = series(head())
        study = "1.2.3" if change != "study" else generate_uid()
        edit(slice(None), StudyInstanceUID=study)(group)
        if change == "patient" and name == "b":
            edit(slice(None), PatientID="SECRET-2")(group)
        save(tmp_path / "exam" / name, group)
    with pytest.raises(InputRefused) as caught:
        read_ct(tmp_path / "exam")
    assert caught.value.code == code and "SECRET" not in str(caught.value)


def enhanced(hu: np.ndarray, order: list[int], shared_rescale: bool) -> Dataset:
    """All planes in one multi-frame file, its frames in any order."""
    slices = series(hu)
    ds = slices[0]
    ds.SOPClassUID = "1.2.840.10008.5.1.4.1.1.2.1"
    ds.NumberOfFrames = len(hu)
    ds.PixelData = b"".join(slices[k].PixelData for k in order)
    frames = []
    for k in order:
        place, item = Dataset(), Dataset()
        place.ImagePositionPatient = slices[k].ImagePositionPatient
        item.PlanePositionSequence = Sequence([place])
        if not shared_rescale:
            item.PixelValueTransformationSequence = Sequence([rescale()])
        frames.append(item)
    shared, turn, measures = Dataset(), Dataset(), Dataset()
    turn.ImageOrientationPatient, measures.PixelSpacing = list(AXIAL), list(SPACING)
    shared.PlaneOrientationSequence, shared.PixelMeasuresSequence = Sequence([turn]), Sequence([measures])
    if shared_rescale:
        shared.PixelValueTransformationSequence = Sequence([rescale()])
    ds.SharedFunctionalGroupsSequence = Sequence([shared])
    ds.PerFrameFunctionalGroupsSequence = Sequence(frames)
    for name in ("ImagePositionPatient", "ImageOrientationPatient", "PixelSpacing", "RescaleSlope", "RescaleIntercept"):
        del ds[name]
    return ds


def rescale() -> Dataset:
    ds = Dataset()
    ds.RescaleSlope, ds.RescaleIntercept, ds.RescaleType = 1, -1024, "HU"
    return ds


@pytest.mark.parametrize("shared_rescale", [False, True])
@pytest.mark.parametrize("compressed", [False, True])
def test_multi_frame_file_is_read_by_its_positions(shared_rescale: bool, compressed: bool, tmp_path: Path) -> None:
    hu = head(SMALL)
    ds = enhanced(hu, random.Random(2).sample(range(len(hu)), len(hu)), shared_rescale)
    if compressed:
        ds.compress(JPEGLSLossless, encoding_plugin="pyjpegls")
    folder = save(tmp_path / "scan", [ds])
    for path in (folder, folder / "image0000.dcm"):
        volume, _ = read_ct(path)
        np.testing.assert_array_equal(volume.voxels, hu)
        np.testing.assert_allclose(volume.affine, truth(), atol=1e-9)


def test_two_readings_are_the_same(tmp_path: Path) -> None:
    folder = save(tmp_path / "scan", series(head(SMALL)))
    (a, _), (b, _) = read_ct(folder), read_ct(folder)
    assert same_grid(a, b) and np.array_equal(a.voxels, b.voxels)

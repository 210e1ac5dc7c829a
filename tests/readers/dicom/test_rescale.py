"""Stored numbers to HU: by hand, slice by slice, and refused where slope or intercept cannot be true."""

from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from dicom_series import codes, head, save, save_changed, series, set_pixels
from hypothesis import given, settings
from hypothesis import strategies as st

from cranio_nb.errors import InputRefused
from cranio_nb.readers import read_ct
from cranio_nb.readers.dicom.rescale import apply_rescale, check_levels, check_rescale, check_unscaled
from data_synth.fault_edits import set_elements

SMALL = (9, 22, 26)


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


@pytest.mark.parametrize(("slope", "intercept"), [(1e-3, -32768.0), (1e3, 32768.0), (1, -1024)])
def test_rescale_up_to_the_limits_is_taken_as_it_is(slope: float, intercept: float) -> None:
    pairs, unscaled = check_rescale([OneSlice(slope, intercept)] * 3)  # type: ignore[list-item]
    assert pairs.tolist() == [[slope, intercept]] * 3 and pairs.dtype == np.float64 and unscaled is False


@pytest.mark.parametrize(
    ("slope", "intercept"), [(0.99e-3, 0), (1001, 0), (-1, 0), (1, 32769), (1, -32769), (np.nan, 0), (1, np.inf)]
)
def test_rescale_beyond_the_limits_is_refused_with_slice_and_values(slope: float, intercept: float) -> None:
    with pytest.raises(InputRefused) as caught:
        check_rescale([OneSlice(1, 0), OneSlice(slope, intercept)])  # type: ignore[list-item]
    assert caught.value.code == "BadRescale" and "Export" in caught.value.remedy
    for part in ("Slice 1 ", f"slope {slope:g}", f"intercept {intercept:g}"):
        assert part in caught.value.message


def test_without_any_rescale_numbers_stay_as_they_are() -> None:
    pairs, unscaled = check_rescale([OneSlice(None, None)] * 3)  # type: ignore[arg-type, list-item]
    assert pairs.tolist() == [[1, 0]] * 3 and unscaled is True


@pytest.mark.parametrize("lacking", [(None, None), (None, -1024.0), (1.0, None)])
def test_the_first_slice_that_lacks_its_rescale_is_named(lacking: tuple[float, float]) -> None:
    slices = [OneSlice(1.0, -1024.0), OneSlice(*lacking), OneSlice(1.0, -1024.0), OneSlice(*lacking)]
    with pytest.raises(InputRefused) as caught:
        check_rescale(slices)  # type: ignore[arg-type]
    assert caught.value.code == "InconsistentRescale" and "Export" in caught.value.remedy
    assert caught.value.message.startswith("Slice 1 has no rescale slope")


EVERY = slice(None)


def test_padding_becomes_air_with_its_tag_and_without(tmp_path: Path) -> None:
    hu = head()
    hu[:, :6, :6] = -2000
    named = series(hu, intercept=0, signed=True)
    set_elements(EVERY, PixelPaddingValue=-2000)(named)
    for folder, datasets, code in (("a", named, "Padding"), ("b", series(hu, intercept=-3000), "PaddingWithoutTag")):
        volume, report = read_ct(save(tmp_path / folder, datasets))
        assert code in codes(report)
        np.testing.assert_array_equal(volume.voxels, np.where(hu == -2000, -1024, hu))


def test_padding_value_within_the_head_is_ignored(tmp_path: Path) -> None:
    volume, _ = read_ct(save_changed(tmp_path, set_elements(EVERY, PixelPaddingValue=1024 + 900)))
    np.testing.assert_array_equal(volume.voxels, head())


def slice_of(bits: tuple[int, int, int] = (16, 16, 15), padding: tuple[float, float] | None = None) -> SimpleNamespace:
    """What `apply_rescale` needs of a header."""
    return SimpleNamespace(bits=bits, padding=padding, place=SimpleNamespace(syntax="1.2.840.10008.1.2.1"))


@pytest.mark.parametrize(
    ("slope", "intercept", "dtype"), [(1, -1024, "i2"), (2, -1024, "i2"), (0.5, -1024, "f4"), (1, -1000.5, "f4")]
)
def test_hu_is_stored_times_slope_plus_intercept(slope: float, intercept: float, dtype: str) -> None:
    stored = np.arange(4096, dtype=np.uint16).reshape(64, 64)
    hu, padding = apply_rescale(stored, slice_of(), slope, intercept)  # type: ignore[arg-type]
    np.testing.assert_array_equal(hu, stored * float(slope) + intercept)
    assert hu.dtype == np.dtype(dtype) and padding is None


def test_hu_beyond_sixteen_bits_are_kept_as_real_numbers() -> None:
    stored = np.array([[0, 65535]], np.uint16)
    hu, _ = apply_rescale(stored, slice_of(), 1.0, -1024.0)  # type: ignore[arg-type]
    assert hu.dtype == np.float32
    np.testing.assert_array_equal(hu, [[-1024, 64511]])


@pytest.mark.parametrize(
    ("stored", "slope", "intercept"),
    [
        ([0, 65535], 1, -32768),  # the whole range of int16
        ([0, 65535], 1, -32769),
        ([0, 65535], 1, -32767),
        ([-32768, 0], 1, -1),
        ([0, 32767], 1, 1),
        ([-16384, 0], 2, 0),
        ([-16385, 0], 2, 0),
        ([0, 16384], 2, 0),
    ],
)
def test_hu_are_sixteen_bits_where_all_fit_and_right_everywhere(
    stored: list[int], slope: float, intercept: float
) -> None:
    values = np.array([stored], np.uint16 if stored[1] > 32767 else np.int16)
    wanted = np.array([stored]) * slope + intercept
    hu, _ = apply_rescale(values, slice_of(), float(slope), float(intercept))  # type: ignore[arg-type]
    np.testing.assert_array_equal(hu, wanted)
    fits = wanted.min() >= -(2**15) and wanted.max() < 2**15
    assert hu.dtype == (np.int16 if fits else np.float32)


@pytest.mark.parametrize(
    ("stored", "slope", "intercept", "padded"),
    [
        ((124, 124), 1, -1024, True),  # -900 HU
        ((125, 125), 1, -1024, False),
        ((0, 125), 1, -1024, False),  # some of it in the head
        ((0, 0), 1, -1024, True),
        ((100, 100), 2, -1024, False),  # -824 HU
        ((5024, 5024), 1, -1024, False),  # 4000 HU
        ((5025, 5025), 1, -1024, True),
        ((5024, 9000), 1, -1024, False),
    ],
)
def test_padding_is_believed_at_minus_900_hu_or_less_and_above_4000(
    stored: tuple[int, int], slope: float, intercept: float, padded: bool
) -> None:
    values = np.array([[stored[0], 1024, stored[1]]], np.uint16)
    hu, found = apply_rescale(values, slice_of(padding=stored), float(slope), float(intercept))  # type: ignore[arg-type]
    assert (found is not None) == padded
    if found is not None:
        assert found.tolist() == [[True, False, True]]
    np.testing.assert_array_equal(hu, np.where([[padded, False, padded]], -1024, values * float(slope) + intercept))


@pytest.mark.parametrize("padding", [(63536, 63536), (63000, 64000)])
def test_padding_is_found_in_stored_numbers_before_bits_are_cleared(padding: tuple[float, float]) -> None:
    stored = np.array([[0, 1024, 63536]], np.uint16)  # the last has bits above the twelve that are image
    hu, found = apply_rescale(stored, slice_of((16, 12, 11), padding), 1.0, -1024.0)  # type: ignore[arg-type]
    np.testing.assert_array_equal(hu, [[-1024, 0, -1024]])
    assert found is not None and found.tolist() == [[False, False, True]]


def test_the_level_of_one_slice_is_held_against_the_others() -> None:
    levels, pairs = np.full(20, -1000.0), np.tile([1.0, -1024.0], (20, 1))
    assert check_levels(levels, pairs) == []
    levels[7] = 24.0
    (finding,) = check_levels(levels, pairs)  # its rescale is that of the others
    assert (finding.code, finding.severity, finding.values) == ("LevelJump", "warning", {"slices": [7]})
    assert "1 slices" in finding.message and "300 HU" in finding.message
    pairs[7, 1] = 0.0
    with pytest.raises(InputRefused) as caught:
        check_levels(levels, pairs)
    assert caught.value.code == "InconsistentRescale" and "Export" in caught.value.remedy
    for part in ("Slice 7", "slope 1 ", "intercept 0", "at 24 HU instead of -1000"):
        assert part in caught.value.message


@pytest.mark.parametrize(("off", "count", "named"), [(300, 1, 0), (301, 1, 1), (301, 2, 2), (301, 3, 0), (301, 0, 0)])
def test_up_to_a_fifth_of_the_slices_more_than_300_hu_away_are_named(off: float, count: int, named: int) -> None:
    levels = np.full(10, -1000.0)
    levels[:count] += off
    findings = check_levels(levels, np.tile([1.0, -1024.0], (10, 1)))
    assert [finding.values for finding in findings] == ([{"slices": list(range(named))}] if named else [])


@pytest.mark.parametrize("low", [-1200, -1000, -900])
def test_signed_numbers_from_the_level_of_air_are_hu(low: int) -> None:
    finding = check_unscaled(np.array([low, 40, 900]), True)
    assert (finding.code, finding.severity, finding.values) == ("MissingRescale", "warning", {"minimum": low})
    assert str(low) in finding.message


@pytest.mark.parametrize(("low", "signed"), [(-1000, False), (0, True), (-3000, True), (-1201, True), (-899, True)])
def test_numbers_without_rescale_are_hu_only_with_a_sign_and_air(low: int, signed: bool) -> None:
    hu = np.array([low, 40, 900])
    with pytest.raises(InputRefused) as caught:
        check_unscaled(hu, signed)
    assert caught.value.code == "MissingRescale"
    assert f"is {low}:" in caught.value.message and "Export" in caught.value.remedy
    assert check_unscaled(hu, signed, ("no_rescale",)).severity == "warning"

"""What both kinds of image file share: the declared bytes are read, no more and no fewer."""

import gzip
import io
import tracemalloc
import zlib
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from image_files import assert_head, file_refusal, patch_header, rewrite_header, stored_head, write_nifti, write_nrrd

from cranio_nb.errors import InputRefused
from cranio_nb.readers import read_ct
from cranio_nb.readers.stored_image import (
    GZIP_PACKING,
    MAX_VOXELS,
    check_promise,
    check_shape,
    read_voxels,
)


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
    assert file_refusal(path).code == "CorruptFile"


def test_giant_sizes_are_refused_before_they_are_allocated(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = write_nifti(tmp_path / "a.nii", voxels, lps)
    patch_header(path, dim=[3, 32767, 32767, 32767, 1, 1, 1, 1])
    assert file_refusal(path).code == "LimitExceeded"
    path = write_nrrd(tmp_path / "a.nrrd", voxels, lps)
    rewrite_header(path, "sizes", "32767 32767 32767")
    assert file_refusal(path).code == "LimitExceeded"


@pytest.mark.parametrize("suffix", ["nii", "nii.gz", "nrrd", "raw.nrrd"])
def test_a_promise_that_the_file_cannot_hold_costs_nothing(suffix: str, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = tmp_path / f"a.{suffix}"
    # 512 x 512 x 512 doubles: 1 GB, which is not more than is read
    if "nii" in suffix:
        plain = write_nifti(tmp_path / "plain.nii", voxels.astype(float), lps)
        patch_header(plain, dim=[3, 512, 512, 512, 1, 1, 1, 1])
        path.write_bytes(gzip.compress(plain.read_bytes()) if suffix.endswith("gz") else plain.read_bytes())
    else:
        write_nrrd(path, voxels.astype(float), lps, encoding="raw" if "raw" in suffix else "gzip")
        rewrite_header(path, "sizes", "512 512 512")
    tracemalloc.start()
    assert file_refusal(path).code == "CorruptFile"
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 2**25


def test_a_gigabyte_of_zeros_is_not_inflated(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    plain = write_nifti(tmp_path / "plain.nii", voxels, lps)
    patch_header(plain, dim=[3, 1024, 1024, 300, 1, 1, 1, 1])
    packer = zlib.compressobj(9, zlib.DEFLATED, zlib.MAX_WBITS | 16)
    packed = packer.compress(plain.read_bytes()[:352])
    packed += b"".join(packer.compress(bytes(2**24)) for _ in range(38)) + packer.flush()
    path = tmp_path / "a.nii.gz"
    path.write_bytes(packed)
    assert file_refusal(path).code == "LimitExceeded"


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


class Drops(io.BytesIO):
    """A stream that gives a few bytes at a time, as packed ones do."""

    def read(self, count: int | None = -1) -> bytes:
        return super().read(7 if count is None or count < 0 else min(count, 7))


def test_bytes_are_read_in_whatever_parts_they_come() -> None:
    content = bytes(range(256)) * 3
    voxels, findings = read_voxels(Drops(content), 700)
    assert voxels == content[:700] and findings[0].values == {"at_least": 68}
    with pytest.raises(InputRefused, match="it holds 768 of 769 bytes"):
        read_voxels(Drops(content), 769)


@pytest.mark.parametrize("sizes", [[4, 5], [4, 5, 0], [4, 5, 6, 2]])
def test_other_than_three_axes_are_refused(sizes: list[int]) -> None:
    with pytest.raises(InputRefused) as caught:
        check_shape(sizes)
    assert caught.value.code == "BadShape"


def test_the_limit_of_voxels_is_the_last_size_allowed() -> None:
    assert check_shape([MAX_VOXELS, 1, 1]) == (MAX_VOXELS, 1, 1)
    with pytest.raises(InputRefused) as caught:
        check_shape([MAX_VOXELS + 1, 1, 1])
    assert caught.value.code == "LimitExceeded"


def test_a_mask_may_be_packed_as_well_as_its_packing_allows() -> None:
    """Masks of real skulls, mostly 0, take a thousandth of their size."""
    check_promise(353_000_000, 400_000, packing=GZIP_PACKING)


@pytest.mark.parametrize("write", [write_nifti, write_nrrd], ids=["nii.gz", "nrrd"])
@pytest.mark.parametrize("damage", ["cut", "block", "checksum"])
def test_what_cannot_be_unpacked_is_said_to_be_so(damage: str, write: Callable[..., Path], tmp_path: Path) -> None:
    path = write(tmp_path / ("a.nii.gz" if write is write_nifti else "a.nrrd"), *stored_head())
    content = bytearray(path.read_bytes())
    start = content.index(b"\x1f\x8b")  # of what is packed; its first block begins after ten bytes and a name
    if damage == "cut":
        del content[-20:]
    elif damage == "block":
        middle = (start + len(content)) // 2
        content[middle : middle + 40] = bytes(b ^ 0xFF for b in content[middle : middle + 40])
    else:
        content[-8] ^= 1
    path.write_bytes(content)
    refused = file_refusal(path)
    assert refused.code == "CorruptFile" and "cannot be unpacked" in refused.message

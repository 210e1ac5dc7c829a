"""NRRD files: spaces and units as the format has them, or refused."""

from pathlib import Path

import numpy as np
import pytest
from image_files import assert_head, file_refusal, rewrite_header, stored_head, write_nrrd

from cranio_nb.readers import read_ct


@pytest.mark.parametrize(
    ("space", "signs"),
    [("left-posterior-superior", (1, 1)), ("right-anterior-superior", (-1, -1)), ("LAS", (1, -1)), ("RAS", (-1, -1))],
)
def test_every_nrrd_space_gives_the_same_world(space: str, signs: tuple[int, int], tmp_path: Path) -> None:
    voxels, lps = stored_head()
    volume, _ = read_ct(write_nrrd(tmp_path / "a.nrrd", voxels, np.diag([*signs, 1, 1]) @ lps, space=space))
    assert_head(volume)


def test_nrrd_units_are_honoured(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = write_nrrd(tmp_path / "a.nrrd", voxels, np.diag([0.1, 0.1, 0.1, 1]) @ lps, space_units=["cm"] * 3)
    assert_head(read_ct(path)[0])


@pytest.mark.parametrize("name", ["../secret.raw", "/etc/passwd", "a.raw"])
@pytest.mark.parametrize("field", ["data file", "datafile"])
def test_detached_voxels_are_refused(field: str, name: str, tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = write_nrrd(tmp_path / "a.nrrd", voxels, lps)
    rewrite_header(path, field, name)
    (tmp_path / "a.raw").write_bytes(voxels.tobytes())
    assert file_refusal(path).code == "UnsupportedFile"


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
        ("space origin", "(0,0)", "CorruptFile"),
        ("space units", '"furlong" "furlong" "furlong"', "BadGeometry"),
    ):
        path = write_nrrd(tmp_path / "a.nrrd", voxels, lps)
        rewrite_header(path, field, value)
        assert file_refusal(path).code == code, field


def test_two_spacings_of_three_are_damage(tmp_path: Path) -> None:
    voxels, lps = stored_head()
    path = write_nrrd(tmp_path / "a.nrrd", voxels, lps)
    for field, value in (("space directions", None), ("space", None), ("space origin", None)):
        rewrite_header(path, field, value)
    path.write_bytes(path.read_bytes().replace(b"\nencoding:", b"\nspacings: 1 1\nencoding:", 1))
    refused = file_refusal(path, allow=("no_orientation",))
    assert refused.code == "CorruptFile" and "spacings" in refused.message

"""A prior in its file: there and back, damaged, and larger than it looks."""

import tracemalloc
import zipfile

import numpy as np
import pytest

from cranio_nb.errors import InputRefused
from cranio_nb.prior.file import MAX_BYTES, VERSION, load_prior, pack_prior


def test_a_prior_survives_its_file(learned, tmp_path):
    (tmp_path / "prior.npz").write_bytes(pack_prior(learned))
    back = load_prior(tmp_path / "prior.npz")
    np.testing.assert_array_equal(back.radii, learned.radii)
    np.testing.assert_allclose(back.mean.outer, learned.mean.outer, atol=1e-4)
    np.testing.assert_allclose(back.mean.inner, learned.mean.inner, atol=1e-4)


@pytest.mark.parametrize("fault", ["missing", "text", "cut", "version", "pickle", "shape", "nan", "other"])
def test_what_is_no_prior_is_refused(fault, learned, tmp_path):
    path = tmp_path / "prior.npz"
    path.write_bytes(pack_prior(learned))
    parts = dict(np.load(path))
    if fault == "missing":
        path.unlink()
    elif fault == "text":
        path.write_text("not a prior")
    elif fault == "cut":
        path.write_bytes(path.read_bytes()[:-300])
    else:
        change = {
            "version": {"version": np.int64(VERSION + 1)},
            "pickle": {"radii": np.array([{}], dtype=object)},
            "shape": {"radii": parts["radii"][:, :, :-1]},
            "nan": {"radii": parts["radii"] * np.float32("nan")},
            "other": {},
        }[fault]
        np.savez(path, **({"x": np.zeros(3)} if fault == "other" else parts | change))
    with pytest.raises(InputRefused) as refused:
        load_prior(path)
    assert refused.value.code == "NoPrior" and str(tmp_path) not in str(refused.value)


HUGE = (10**9, 3)  # 12 GB of single precision


def array_header(shape, descr="<f4"):
    text = str({"descr": descr, "fortran_order": False, "shape": shape}).encode()
    text += b" " * (-(len(text) + 11) % 64) + b"\n"
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text


@pytest.fixture(scope="module")
def zeros():
    """Half as many more zeros as a prior may hold, as an array of single precision."""
    n = MAX_BYTES // 8 * 3 // 3 * 3
    return array_header((n // 3, 3)), n * 4


@pytest.mark.parametrize("bomb", ["one member", "many members", "header", "empty type", "repeated", "nested version"])
def test_what_would_inflate_is_refused_before_it_does(bomb, learned, zeros, tmp_path):
    path = tmp_path / "prior.npz"
    path.write_bytes(pack_prior(learned))
    members = {f"{name}.npy": [data] for name, data in _members(path).items()}
    header, n_bytes = zeros
    block = bytes(2**20)
    if bomb == "one member":
        members["outside.npy"] = [header, *[block] * (n_bytes // 2**20 + 1)]
    elif bomb == "many members":
        members |= {f"x{i}.npy": [block] * 32 for i in range(12)}
    elif bomb == "header":
        members["outside.npy"] = [array_header(HUGE), bytes(12)]
    elif bomb == "empty type":
        members["radii.npy"] = [array_header((10**15, 2, 1), "|V0")]
    elif bomb == "repeated":
        members["version.npy"] = [array_header(HUGE), block]
    else:
        members["version.npy"] = [array_header((10**9,), "<i8")]
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as packed:
        for name, parts in members.items():
            with packed.open(name, "w") as member:
                for part in parts:
                    member.write(part)
    assert path.stat().st_size < 3e6 + len(pack_prior(learned))
    tracemalloc.start()
    with pytest.raises(InputRefused) as refused:
        load_prior(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert refused.value.code == "NoPrior" and peak < 60e6
    assert ("at most 268 MB" in str(refused.value)) == (bomb in ("one member", "many members"))


def _members(path):
    """The bytes of each array's file in an archive."""
    with zipfile.ZipFile(path) as held:
        return {name.removesuffix(".npy"): held.read(name) for name in held.namelist()}

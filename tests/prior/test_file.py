"""A prior in its file: there and back, damaged, not written."""

import numpy as np
import pytest

from cranio_nb.errors import CannotWrite, InputRefused
from cranio_nb.prior.file import VERSION, load_prior, save_prior


def test_a_prior_survives_its_file(learned, tmp_path):
    save_prior(learned, tmp_path / "prior.npz")
    back = load_prior(tmp_path / "prior.npz")
    np.testing.assert_array_equal(back.radii, learned.radii)
    np.testing.assert_allclose(back.mean.outer, learned.mean.outer, atol=1e-4)
    np.testing.assert_allclose(back.mean.inner, learned.mean.inner, atol=1e-4)
    assert [p.name for p in tmp_path.iterdir()] == ["prior.npz"]


@pytest.mark.parametrize("fault", ["missing", "text", "cut", "version", "pickle", "shape", "nan", "other"])
def test_what_is_no_prior_is_refused(fault, learned, tmp_path):
    path = tmp_path / "prior.npz"
    save_prior(learned, path)
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


def test_a_file_that_cannot_be_written_leaves_nothing(learned, tmp_path):
    (tmp_path / "prior.npz").mkdir()
    with pytest.raises(CannotWrite):
        save_prior(learned, tmp_path / "prior.npz")
    with pytest.raises(CannotWrite):
        save_prior(learned, tmp_path / "nowhere" / "prior.npz")
    assert [p.name for p in tmp_path.iterdir()] == ["prior.npz"]

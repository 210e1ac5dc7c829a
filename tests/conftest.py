"""Where the tests find real scans, and how they say that there are none; phantoms and shapes that many tests share."""

import os

# before NumPy is loaded, for this process and those it starts: threads that wait for each other in many small products
# take a third more of the processors' time; benchmarks/kernels.py runs the numerics with one and with two
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from cranio_nb.opening import Opening
from cranio_nb.prior.learning import learn_prior
from cranio_nb.prior.shape_prior import Prior
from cranio_nb.vault.opening_search import find_openings
from cranio_nb.volume import Volume
from data_synth import Case, phantom_case

# the same few examples on every run; `--hypothesis-profile=long` draws new ones, many more, every time
settings.register_profile("few", max_examples=4, derandomize=True, deadline=None)
settings.register_profile("long", max_examples=200, deadline=None)
settings.load_profile("few")


@pytest.fixture(autouse=True)
def own_settings_stay():
    """What a test sets of the package's environment variables it takes back: the next tests are not to depend on it."""
    before = own_settings()
    yield
    assert own_settings() == before


def own_settings() -> dict[str, str]:
    return {name: value for name, value in os.environ.items() if name.startswith("CRANIO_NB_")}


@pytest.fixture(scope="session")
def real_data() -> Path:
    """Folder of real scans, from CRANIO_NB_DATA; the test is skipped where it is not set."""
    folder = os.environ.get("CRANIO_NB_DATA")
    if not folder:
        pytest.skip("CRANIO_NB_DATA names no folder of real scans")
    return Path(folder)


@pytest.fixture(scope="session")
def phantom() -> Callable[..., Case]:
    """`phantom(defect, seed)`: the tiny phantom, made once; its arrays are read-only."""

    @cache
    def make(defect: str = "unilateral", seed: int = 0) -> Case:
        case = phantom_case("tiny", defect, seed)
        for array in (case.hu, case.bone, case.implant, case.affine):
            array.setflags(write=False)
        return case

    return make


@pytest.fixture(scope="session")
def skull(phantom) -> Callable[..., Volume]:
    """`skull(defect, seed)`: the bone left in the tiny phantom, by voxel centres."""
    return lambda defect="unilateral", seed=0: Volume(phantom(defect, seed).bone, phantom(defect, seed).affine)


@pytest.fixture(scope="session")
def openings(skull) -> Callable[..., tuple[Opening, ...]]:
    """`openings(defect, seed)`: the openings found in `skull(defect, seed)`, once."""
    return cache(lambda defect="unilateral", seed=0: find_openings(skull(defect, seed)))


@pytest.fixture(scope="session")
def intact(phantom) -> Callable[[int], Volume]:
    """`intact(seed)`: a whole tiny head."""
    return lambda seed: Volume(phantom("round", seed).complete, phantom("round", seed).affine)


@pytest.fixture(scope="session")
def learned(intact) -> Prior:
    """A shape prior of four tiny heads, seeds 1 to 4."""
    return learn_prior(intact(seed) for seed in range(1, 5))


@pytest.fixture(scope="session")
def ring() -> Callable[..., np.ndarray]:
    """`ring(inner, outer, half_gap=..., towards=...)`: a slice with an annulus that lacks a sector.

    Radii in px about `centre` (row, col); angles in degrees, 0 up the slice (against the rows), growing towards the
    columns.
    """

    def draw(inner, outer, *, half_gap=0.0, towards=0.0, centre=(100.0, 100.0), shape=(201, 201)):
        row, col = np.indices(shape, dtype=float)
        row, col = row - centre[0], col - centre[1]
        radius = np.hypot(row, col)
        off = (np.degrees(np.arctan2(col, -row)) - towards + 180) % 360 - 180
        return (radius >= inner) & (radius <= outer) & ~(np.abs(off) < half_gap)

    return draw

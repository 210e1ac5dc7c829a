"""Images that agree make one group, in time that grows with their number and not with its square."""

import time
from types import SimpleNamespace
from typing import cast

import numpy as np

from cranio_nb.readers.dicom.series_groups import group_alike
from cranio_nb.readers.dicom.slice_header import SliceHeader


def images_turned_by(angles: np.ndarray) -> list[SliceHeader]:
    common = {"series": "1", "rows": 4, "cols": 4, "modality": "CT", "image_type": (), "spacing": np.ones(2)}
    turned = [np.array([np.cos(a), np.sin(a), 0, -np.sin(a), np.cos(a), 0]) for a in angles]
    return [cast(SliceHeader, SimpleNamespace(orientation=v, **common)) for v in turned]


def test_many_directions_take_linear_time() -> None:
    seconds = []
    for count in (2000, 16000):
        headers = images_turned_by(np.linspace(0, 6.28, count))
        start = time.perf_counter()
        groups = group_alike(headers)
        seconds.append(time.perf_counter() - start)
        assert sum(map(len, groups)) == count and len(groups) > 1000
    assert seconds[1] < 30 * seconds[0]  # the square of 8 is 64


def test_rounding_does_not_part_a_series() -> None:
    angles = 1.0 + 1e-6 * np.random.default_rng(0).normal(size=500)
    assert len(group_alike(images_turned_by(angles))) == 1
    assert len(group_alike(images_turned_by(np.repeat([1.0, 1.01], 50)))) == 2

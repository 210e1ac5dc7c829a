"""Images that agree make one group, in time that grows with their number and not with its square."""

from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest

from cranio_nb.readers.dicom import series_groups
from cranio_nb.readers.dicom.series_groups import group_alike
from cranio_nb.readers.dicom.slice_header import SliceHeader


def images_turned_by(angles: np.ndarray) -> list[SliceHeader]:
    common = {"series": "1", "rows": 4, "cols": 4, "modality": "CT", "image_type": (), "spacing": np.ones(2)}
    turned = [np.array([np.cos(a), np.sin(a), 0, -np.sin(a), np.cos(a), 0]) for a in angles]
    return [cast(SliceHeader, SimpleNamespace(orientation=v, **common)) for v in turned]


def test_each_of_many_directions_is_compared_with_a_few(monkeypatch: pytest.MonkeyPatch) -> None:
    compared = []
    monkeypatch.setattr(series_groups, "all", lambda close: compared.append(1) or all(close), raising=False)
    for count in (500, 4000):
        compared.clear()
        groups = group_alike(images_turned_by(np.linspace(0, 6.28, count)))
        assert sum(map(len, groups)) == count and len(groups) > count / 8
        assert len(compared) < 8 * count


def test_rounding_does_not_part_a_series() -> None:
    angles = 1.0 + 1e-6 * np.random.default_rng(0).normal(size=500)
    assert len(group_alike(images_turned_by(angles))) == 1
    assert len(group_alike(images_turned_by(np.repeat([1.0, 1.01], 50)))) == 2

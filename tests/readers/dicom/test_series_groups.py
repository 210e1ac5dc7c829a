"""Images that agree make one group, in time that grows with their number and not with its square."""

import dataclasses
from collections import Counter
from types import SimpleNamespace
from typing import cast

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from pydicom.uid import CTImageStorage, EnhancedCTImageStorage, MRImageStorage

from cranio_nb.readers.dicom import series_groups
from cranio_nb.readers.dicom.series_groups import group_alike, join_single_slices, nothing_usable, split_usable
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


def image(**changes: object) -> SliceHeader:
    """An axial CT image."""
    kind = {
        "modality": "CT",
        "sop_class": CTImageStorage,
        "image_type": ("ORIGINAL", "PRIMARY", "AXIAL"),
        "series": "1",
    }
    picture = {"samples": 1, "photometric": "MONOCHROME2", "frames": 1, "rows": 4, "cols": 4}
    place = {"position": np.zeros(3), "orientation": np.array([1.0, 0, 0, 0, 1, 0]), "spacing": np.ones(2)}
    fields = dict.fromkeys(field.name for field in dataclasses.fields(SliceHeader))
    return SliceHeader(**(fields | kind | picture | place | changes))  # type: ignore[arg-type]


SLICES = [
    {},
    {"modality": "", "sop_class": ""},
    {"sop_class": EnhancedCTImageStorage, "frames": 30},
    {"photometric": "MONOCHROME1"},
    {"photometric": ""},
    {"position": None},
]
OTHERS = [
    ({"samples": 3}, "colour picture"),
    ({"photometric": "RGB"}, "colour picture"),
    ({"image_type": ("ORIGINAL", "PRIMARY", "LOCALIZER")}, "scout view"),
    ({"frames": 2, "position": None}, "film without positions"),
]
NO_CT = [({"modality": "MR"}, "other modality"), ({"sop_class": MRImageStorage}, "not a CT image")]


def test_what_is_no_slice_of_a_ct_is_left_and_counted_by_reason() -> None:
    slices = [image(**fields) for fields in SLICES]
    others = [(image(**fields), reason) for fields, reason in 2 * OTHERS + NO_CT]
    usable, left, kept = split_usable([slices[0], *(one for one, _ in others), *slices[1:]], any_modality=False)
    assert usable == slices and kept == [one for one, _ in others]
    assert left == Counter(reason for _, reason in others) and left["colour picture"] == 4


def test_other_modalities_are_slices_where_any_is_allowed() -> None:
    allowed = [image(**fields) for fields, _ in NO_CT]
    usable, left, _ = split_usable([*allowed, *(image(**fields) for fields, _ in OTHERS)], any_modality=True)
    assert usable == allowed
    assert left == {"colour picture": 2, "scout view": 1, "film without positions": 1}


def singles(count: int, *together: int) -> list[SliceHeader]:
    """Images that are series of their own, then series of several."""
    names = [f"single {k}" for k in range(count)] + [f"series {k}" for k, n in enumerate(together) for _ in range(n)]
    return [image(series=name) for name in names]


@pytest.mark.parametrize("headers", [singles(7), singles(8, 8), singles(7, 2), singles(0, 20), singles(1)])
def test_images_stay_in_their_series_where_a_series_is_whole_or_few_are_single(headers: list[SliceHeader]) -> None:
    joined, findings = join_single_slices(headers)
    assert joined == headers and findings == []


@pytest.mark.parametrize(("count", "together"), [(8, ()), (9, (7, 2)), (30, (2,))])
def test_images_that_are_series_of_their_own_are_joined(count: int, together: tuple[int, ...]) -> None:
    headers = singles(count, *together)
    joined, (finding,) = join_single_slices(headers)
    assert [one.series for one in joined] == count * [""] + [one.series for one in headers[count:]]
    assert (finding.code, finding.severity, finding.values) == ("SeriesJoined", "warning", {"slices": count})
    assert f"Each of {count} slices" in finding.message


@pytest.mark.parametrize(
    ("modalities", "left", "code", "said"),
    [
        (["PT", "MR", "MR", "CT"], {"other modality": 3}, "WrongModality", "are MR, PT, not CT."),
        (["SECRET"], {"other modality": 1}, "WrongModality", "are another modality, not CT."),  # only known words leave
        (["CT"], {"scout view": 2, "colour picture": 1}, "NoImages", "(1 x colour picture, 2 x scout view)"),
        ([], {}, "NoImages", "no DICOM images"),
    ],
)
def test_a_folder_without_slices_is_told_by_what_is_in_it(
    modalities: list[str], left: dict[str, int], code: str, said: str
) -> None:
    refusal = nothing_usable([image(modality=name) for name in modalities], Counter(left))
    assert refusal.code == code and said in refusal.message
    assert "folder of a head CT" in refusal.remedy


SAME = [
    {"image_type": ("ORIGINAL", "PRIMARY", "AXIAL", "LATER")},
    {"orientation": np.array([1.0, 0.9e-4, 0, 0, 1, 0])},
    {"orientation": np.array([1 + 1.9e-4, 0, 0, 0, 1, 0])},  # relative to its own size
    {"spacing": np.array([1.0, 1 + 1.9e-4])},
    {"position": np.full(3, 99.0)},
    # every number off at once
    {"orientation": np.array([1 + 1.9e-4, 9e-5, 9e-5, 9e-5, 1 + 1.9e-4, 9e-5]), "spacing": np.ones(2) + 1.9e-4},
]
ELSE = [
    *({"series": "2"}, {"rows": 5}, {"cols": 5}, {"modality": ""}, {"image_type": ("DERIVED", "PRIMARY", "AXIAL")}),
    *({"image_type": ("ORIGINAL", "PRIMARY", "OTHER")}, {"orientation": None}, {"spacing": None}),
    {"orientation": np.array([1.0, 1.1e-4, 0, 0, 1, 0])},
    {"spacing": np.array([1.0, 1 + 2.1e-4])},
    {"spacing": np.array([1 - 2.1e-4, 1.0])},
    {"orientation": np.array([np.nan, 0, 0, 0, 1, 0])},
]


@pytest.mark.parametrize("fields", SAME)
def test_what_agrees_is_one_group_in_the_order_of_the_files(fields: dict[str, object]) -> None:
    headers = [image(), image(**fields), image()]
    (group,) = group_alike(headers)
    assert [id(one) for one in group] == [id(one) for one in headers]


@pytest.mark.parametrize("fields", ELSE)
def test_what_does_not_agree_is_another_group(fields: dict[str, object]) -> None:
    headers = [image(), image(**fields), image(), image(**fields)]
    groups = group_alike(headers)
    assert [[id(one) for one in group] for group in groups] == [[id(one) for one in headers[k::2]] for k in (0, 1)]


def test_images_without_any_geometry_are_one_group() -> None:
    assert [len(group) for group in group_alike([image(orientation=None, spacing=None)] * 3)] == [3]
    assert group_alike([]) == []


def test_the_first_image_of_a_group_is_what_others_are_compared_with() -> None:
    spacings = [np.array([1.0, 1 + shift]) for shift in (0, 1.5e-4, 3e-4)]  # each near the one before it
    assert [len(group) for group in group_alike([image(spacing=spacing) for spacing in spacings])] == [2, 1]


@given(st.lists(st.tuples(st.integers(0, 3), st.integers(0, 3)), min_size=1, max_size=30))
def test_groups_are_those_that_a_comparison_of_all_pairs_finds(shifts: list[tuple[int, int]]) -> None:
    spacings = [np.array([0.5 + 1e-2 * a, 2 - 1e-2 * b]) for a, b in shifts]
    groups = group_alike([image(spacing=spacing) for spacing in spacings])
    assert sorted(len(group) for group in groups) == sorted(Counter(shifts).values())

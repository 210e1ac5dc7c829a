"""What is said of a contender is what its rows say."""

import numpy as np
import pytest
from studies import columns, two_options

pytest.importorskip("pyarrow", reason="the extra `study` is not installed")

from cranio_nb.study.parts import by_contender, class_rows, contender_part, pair_table
from cranio_nb.study.sensitivity import parameters, usual_options
from cranio_nb.study.summaries import sizes


@pytest.fixture
def rows():
    return two_options()


def test_the_best_setting_stands_beside_the_defaults(rows):
    part = contender_part(rows, "dice")
    assert list(part.tables) == ["defaults", "best setting"]
    assert part.best.options == {"skip_mm": 3.0}
    assert part.tables["defaults"]["dice"].mean == pytest.approx(0.89 - 0.075 + 0.12)
    assert part.pairs[0][:2] == ("coupling_mm", "skip_mm") and set(part.effects) == {"coupling_mm", "skip_mm"}


def test_contenders_are_parted():
    found = by_contender(columns(3, contender=["b", "a", "b"], dice=[1.0, 2.0, 3.0]))
    assert [own["dice"].tolist() for own in found] == [[2.0], [1.0, 3.0]]


def test_classes_go_from_small_to_large(rows):
    assert [(name, n) for name, n, _ in class_rows(rows, sizes)] == [
        ("20 to 40 mm", 6),
        ("60 to 80 mm", 6),
        ("80 to 100 mm", 6),
        ("above 100 mm", 1),
    ]


def test_a_pair_is_a_table_of_means(rows):
    b, a = parameters(rows, usual_options(rows))
    assert (a.name, b.name) == ("skip_mm", "coupling_mm")
    found = pair_table(rows["dice"] + 0.01 * (rows["length_mm"] - 30) / 30, a, b)
    expected = [[0.9 - 0.05 * x + 0.02 * x * y for y in (2.0, 4.0)] for x in (0.0, 1.5, 3.0)]
    np.testing.assert_allclose(found, expected)

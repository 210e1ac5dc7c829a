import pytest

from cranio_nb.errors import InputRefused
from cranio_nb.options import Work

AREA = Work("The points", 100, lambda options: options["rows"] * options["columns"], "Give fewer rows.")


@pytest.mark.parametrize("rows", [1, 9, 10])
def test_up_to_the_limit_it_is_silent(rows):
    AREA.check({"rows": rows, "columns": 10})


def test_above_it_the_amount_the_limit_and_the_remedy_are_said():
    with pytest.raises(InputRefused, match=r"^The points would be 1,010; at most 100 are computed\. Give") as refused:
        AREA.check({"rows": 101, "columns": 10})
    assert (refused.value.code, refused.value.remedy) == ("TooMuchWork", AREA.remedy)

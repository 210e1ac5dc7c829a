"""Which openings are closed: those that were cut, or those that were chosen."""

import pytest
from judged_openings import opening

from cranio_nb.errors import InputRefused, NoOpening
from cranio_nb.readers import Finding
from cranio_nb.vault.opening_choice import check_intact, choose_openings, cut_openings

FOUND = (opening(1, "natural"), opening(2, "cut"), opening(3, "doubtful"), opening(4, "cut"))


def numbers(some):
    return [one.number for one in some]


@pytest.mark.parametrize(
    ("asked", "closed"), [((), [2, 4]), ((3,), [3]), ((1,), [1]), ((4, 3, 4), [3, 4]), ((1, 2, 3, 4), [1, 2, 3, 4])]
)
def test_what_was_cut_is_closed_unless_others_are_chosen(asked, closed):
    assert numbers(choose_openings(FOUND, asked)) == closed


def test_a_number_that_there_is_not_is_refused_with_the_list():
    with pytest.raises(InputRefused, match="no opening 7, 9") as refused:
        choose_openings(FOUND, (9, 2, 7))
    assert refused.value.code == "NoSuchOpening"
    assert refused.value.message.endswith(". " + " ".join("O" + str(one)[1:] for one in FOUND))
    assert "Give a number" in refused.value.remedy
    with pytest.raises(InputRefused, match="has no opening") as refused:
        choose_openings((), (1,))
    assert refused.value.code == "NoSuchOpening" and refused.value.remedy == ""  # there is no number to give


def test_without_any_that_was_cut_the_doubtful_ones_are_listed():
    with pytest.raises(NoOpening, match="nothing to close") as refused:
        choose_openings(FOUND[:1])
    assert refused.value.code == "NoOpening" and "orbit" not in str(refused.value)
    with pytest.raises(NoOpening, match="--opening 3") as refused:
        choose_openings((FOUND[0], FOUND[2]))
    assert refused.value.code == "NoOpening"
    for part in ("pening 3", "left", "planes 4 to 7", "doubtful", "confidence 0.40", "It is in doubt."):
        assert part in refused.value.message


@pytest.mark.parametrize("found", [(), FOUND[:1], (FOUND[0], FOUND[2])])
def test_that_there_is_no_opening_is_said_with_what_the_scan_cannot_show(found):
    said = (Finding("A", "warning", "The slices are thick."), Finding("B", "info", "The head is straight."))
    with pytest.raises(NoOpening) as refused:
        choose_openings(found, smallest_mm=16.0, said=said)
    message = refused.value.message
    assert "this scan can show for sure is 16 mm wide. The slices are thick." in message and "straight" not in message


def test_what_reaches_the_edge_of_the_image_is_refused_only_where_it_is_to_be_closed():
    found = (opening(1, "cut", room_mm=-1.0), opening(2, "cut"))
    for asked in ((), (1,), (1, 2)):
        with pytest.raises(InputRefused, match="outside the image") as refused:
            choose_openings(found, asked)
        assert refused.value.code == "OpeningLeavesImage" and "pening 1" in refused.value.message
        assert "pening 2" not in refused.value.message
        assert "covers the whole opening" in refused.value.remedy
    assert numbers(choose_openings(found, (2,))) == [2]


def test_the_line_ends_with_the_reason_and_with_the_edge_of_the_image_where_it_is_reached():
    assert str(opening(1, "cut")).endswith(" It is plain.")
    assert str(opening(1, "cut", room_mm=-1.0)).endswith(" It is plain. It reaches the edge of the image.")


def test_a_skull_is_intact_without_an_opening_that_was_cut():
    assert numbers(cut_openings(FOUND)) == [2, 4]
    check_intact((FOUND[0], FOUND[2]), "Give an intact one.")
    with pytest.raises(InputRefused, match=r"Opening 2 .*Opening 4 .*Give an intact one") as refused:
        check_intact(FOUND, "Give an intact one.")
    assert refused.value.code == "NotIntact"


def test_the_record_holds_number_verdict_place_and_size():
    record = FOUND[2].record()
    assert record["number"] == 3 and record["kind"] == "doubtful" and record["confidence"] == 0.4
    assert record["reason"] == "It is in doubt." and record["whole"] is True
    assert record["place"] == "left" and record["planes"] == (4, 7)


def test_missing_bone_near_the_edge_of_the_image_is_closed_and_said():
    near = opening(1, "cut", room_mm=1.25)
    assert choose_openings((near,)) == (near,)
    assert "1.2 mm from the edge" in str(near) and near.record()["whole"] is True
    assert not opening(1, "cut").edge

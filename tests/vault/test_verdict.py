"""Verdicts on openings: the rule's lines one by one."""

from dataclasses import replace

import pytest

from cranio_nb.vault.verdict import RULES, SURE, Signs, Verdict, judge, rule_rows

CUT = Signs(60.0, 0.0, on_vault=1.0, two_walls=0.0, rim_mm=6.0, frame=1.0)
BY_LINE = [  # signs for which each line of the rule is the first to hold, and what follows
    (replace(CUT, across_mm=0.3, diameter_mm=9.0), "doubtful"),
    (replace(CUT, across_mm=1.0, covered=0.6), "doubtful"),
    (replace(CUT, across_mm=1.0), "natural"),
    (replace(CUT, rim_mm=1.0, diameter_mm=12.0), "natural"),
    (replace(CUT, plain=False), "doubtful"),
    (replace(CUT, on_vault=0.0), "natural"),
    (replace(CUT, two_walls=0.9, on_vault=0.4), "natural"),
    (replace(CUT, two_walls=0.9), "doubtful"),
    (replace(CUT, on_vault=0.2), "doubtful"),
    (CUT, "cut"),
]


def first_line(signs):
    """The first line of the rule that holds, from 0."""
    return [rule.holds(signs) for rule in RULES].index(True)


@pytest.mark.parametrize(("line", "signs", "kind"), [(i, *one) for i, one in enumerate(BY_LINE)])
def test_the_first_line_that_holds_decides(line, signs, kind):
    assert first_line(signs) == line
    verdict = judge(signs)
    assert verdict.kind == kind and verdict == RULES[line].judge(signs)
    assert (verdict.confidence < SURE) == (kind == "doubtful")
    assert verdict.reason.endswith(".")


def test_the_table_names_every_line_with_its_kind_and_confidence():
    rows = rule_rows()
    assert len(BY_LINE) == len(RULES) == len(rows)
    for (signs, kind), (when, said, confidence) in zip(BY_LINE, rows, strict=True):
        low, *high = (float(text) for text in confidence.split(" to "))
        assert when and said == kind
        # the table gives two decimals
        assert low - 0.005 <= judge(signs).confidence <= max(high, default=low) + 0.005


def test_a_plain_craniectomy_is_sure():
    assert judge(CUT).confidence == 1 and not judge(CUT).natural


def test_without_hu_nothing_is_called_soft():
    masked = judge(replace(CUT, with_hu=False))
    assert "Soft all through" in judge(CUT).reason and "only HU can tell" in masked.reason
    assert replace(masked, reason="") == replace(judge(CUT), reason="")


def test_the_less_sure_the_frame_the_more_must_lie_on_the_vault():
    low = replace(CUT, on_vault=0.4)
    assert judge(low).kind == "cut" and judge(replace(low, frame=0.0)).kind == "doubtful"


def test_confidence_grows_with_the_vault_and_the_frame():
    values = [judge(replace(CUT, on_vault=v, frame=f)).confidence for v, f in [(0.5, 0.2), (0.5, 0.5), (0.9, 0.9)]]
    assert values == sorted(values) and values[0] < values[-1]


@pytest.mark.parametrize(
    ("signs", "name", "limit", "at", "below"),
    [
        (replace(CUT, diameter_mm=9.0), "across_mm", 0.1, 0, 9),
        (replace(CUT, diameter_mm=9.0), "across_mm", 3.0, 2, 0),
        (replace(CUT, diameter_mm=9.0, rim_mm=1.55), "across_mm", 0.8, 2, 0),
        (replace(CUT, across_mm=0.5), "diameter_mm", 15.0, 2, 0),
        (CUT, "across_mm", 0.1, 2, 9),
        (replace(CUT, covered=0.6), "across_mm", 0.1, 1, 9),
        (replace(CUT, across_mm=0.5), "covered", 0.9, 2, 1),
        (replace(CUT, across_mm=0.5, covered=0.6), "rim_mm", 4.0, 1, 2),
        (replace(CUT, across_mm=0.5, covered=0.6), "on_vault", 0.1, 1, 2),
        (replace(CUT, rim_mm=1.0), "diameter_mm", 30.0, 9, 3),
        (replace(CUT, diameter_mm=12.0), "rim_mm", 1.5, 9, 3),
        (CUT, "on_vault", 0.1, 8, 5),
        (replace(CUT, two_walls=0.9), "on_vault", 0.5, 7, 6),
        (CUT, "two_walls", 0.5 + 1e-9, 7, 9),
        (CUT, "on_vault", 0.3, 9, 8),
        (replace(CUT, frame=0.0), "on_vault", 0.45, 9, 8),
    ],
)
def test_another_line_decides_from_a_limit_on(signs, name, limit, at, below):
    assert first_line(replace(signs, **{name: limit})) == at
    assert first_line(replace(signs, **{name: limit - 1e-9})) == below


def test_the_table_gives_the_confidence_of_each_line_at_the_ends_of_the_signs():
    assert [row[2] for row in rule_rows()] == [
        *("0.40", "0.40", "0.90", "0.70", "0.40", "0.50 to 1.00", "0.80", "0.40", "0.45", "0.60 to 1.00")
    ]


def test_what_is_just_as_sure_as_wanted_is_no_doubt():
    assert Verdict(False, SURE, "").kind == "cut" and Verdict(True, SURE, "").kind == "natural"
    assert Verdict(True, SURE - 1e-9, "").kind == "doubtful"


def test_a_thin_rim_is_named_by_its_thickness():
    assert "1.2 mm" in judge(replace(CUT, diameter_mm=12.0, rim_mm=1.24)).reason


@pytest.mark.parametrize("signs", [CUT, replace(CUT, on_vault=0.0), replace(CUT, two_walls=0.9, on_vault=0.4)])
def test_what_is_no_more_than_a_hint_is_never_cut(signs):
    assert judge(replace(signs, plain=False)).kind == "doubtful"

"""Verdicts on openings."""

from dataclasses import replace

import pytest

from cranio_nb.vault.verdict import Signs, judge

CUT = Signs(60.0, 0.0, on_vault=1.0, two_walls=0.0, rim_mm=6.0, frame=1.0)


def test_a_plain_craniectomy_is_designed():
    verdict = judge(CUT)
    assert verdict.designed and not verdict.natural and not verdict.doubtful and verdict.confidence == 1


@pytest.mark.parametrize(
    "signs",
    [
        replace(CUT, across_mm=1.0),
        replace(CUT, across_mm=0.3, diameter_mm=9.0),
        replace(CUT, rim_mm=1.0, diameter_mm=12.0),
        replace(CUT, on_vault=0.0),
        replace(CUT, on_vault=0.2),
        replace(CUT, two_walls=0.9),
        replace(CUT, two_walls=0.9, on_vault=0.4),
    ],
)
def test_what_is_natural_or_doubtful_is_not_designed(signs):
    assert not judge(signs).designed
    assert judge(signs).reason.endswith(".")


def test_a_trace_of_bone_across_a_small_hole_is_a_doubt():
    assert judge(replace(CUT, across_mm=0.3, diameter_mm=9.0)).doubtful


def test_the_less_sure_the_frame_the_more_must_lie_on_the_vault():
    low = replace(CUT, on_vault=0.4)
    assert judge(low).designed and not judge(replace(low, frame=0.0)).designed


def test_confidence_grows_with_the_vault_and_the_frame():
    values = [judge(replace(CUT, on_vault=v, frame=f)).confidence for v, f in [(0.5, 0.2), (0.5, 0.5), (0.9, 0.9)]]
    assert values == sorted(values)

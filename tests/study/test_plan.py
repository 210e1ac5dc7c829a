"""Which runs a plan asks for: grids, random places, keys, batches."""

import json

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from studies import plan, version

from cranio_nb.errors import InputRefused
from cranio_nb.methods.catalogue import options_of
from cranio_nb.pipeline.trial import Contender
from cranio_nb.study.cases import Case, phantom_cases
from cranio_nb.study.plan import Plan, Setting, run_key, vary


def options(settings):
    return [setting.contender.options for setting in settings]


class TestGrid:
    def test_is_every_combination_once_after_the_defaults(self):
        found = vary("slicewise", {"skip_mm": [0, 1.5], "directions": [6, 8]}, [300, 400])
        said = {(json.dumps(s.contender.options), s.threshold_hu) for s in found}
        assert len(found) == len(said) == 8 and found[0] == Setting(Contender("slicewise"))
        assert {s.threshold_hu for s in found} == {None, 300.0}  # 400 is the default

    @pytest.mark.parametrize("name", ["slicewise", "thin-plate"])
    def test_an_empty_range_is_the_one_that_was_declared(self, name):
        known = {k: o for k, o in options_of(name).items() if o.kind == "number" and np.isfinite(o.span).all()}
        for option, what in known.items():
            values = [o[option] for o in options(vary(name, {option: {}})) if option in o]
            ends = {*what.span} - {what.default}
            assert ends <= set(values) and all(what.allows(value) for value in values)

    def test_whole_numbers_stay_whole_and_truth_values_are_both(self):
        assert options(vary("slicewise", {"directions": {"low": 1, "high": 3}})) == [
            {},
            *({"directions": n} for n in (1, 2, 3)),
        ]
        assert options(vary("hull", {"axial": {}})) == [{}, {"axial": True}]

    def test_a_preset_keeps_what_its_method_has_as_default(self):
        assert options(vary("slicewise:paper", {"skip_mm": [1.5]})) == [{}, {"skip_mm": 1.5}]

    def test_one_too_large_is_refused_before_it_is_made(self):
        with pytest.raises(InputRefused, match="1000000000 places"):
            vary("slicewise", {name: {"n": 1000} for name in ("skip_mm", "reach_mm", "tension")})


class TestRandom:
    @given(n=st.integers(2, 40), seed=st.integers(0, 2**31))
    def test_places_lie_evenly_over_each_range(self, n, seed):
        found = vary("slicewise", {"skip_mm": {}, "tension": {}}, {}, random=n, seed=seed)[1:]
        for name, (low, high) in (("skip_mm", (0, 15)), ("tension", (0.5, 5))):
            share = (np.array([o[name] for o in options(found)]) - low) / (high - low)
            assert np.unique(np.floor(share * n)).tolist() == list(range(n))

    def test_follow_their_seed(self):
        one, same, other = (vary("slicewise", {"skip_mm": {}}, random=3, seed=seed) for seed in (1, 1, 2))
        assert options(one) == options(same) != options(other)

    def test_lists_and_whole_numbers_are_drawn_from_their_values(self):
        found = vary("slicewise", {"directions": {"low": 2, "high": 4}, "axial": {}, "skip_mm": [1, 2]}, random=12)[1:]
        full = [{"directions": 6, "axial": False} | o for o in options(found)]
        assert {o["directions"] for o in full} == {2, 3, 4}
        assert {o["axial"] for o in full} == {True, False} and {o["skip_mm"] for o in full} == {1.0, 2.0}


@pytest.mark.parametrize(
    ("ranges", "words"),
    [
        ({"skip": [1]}, "no option 'skip'"),
        ({"skip_mm": [99]}, "0 to 20 mm"),
        ({"skip_mm": []}, "no values"),
        ({"skip_mm": {"from": 1}}, "'from'"),
        ({"skip_mm": {"low": 3, "high": 1}}, "no range"),
        ({"skip_mm": {"low": float("nan")}}, "no range"),
        ({"skip_mm": {"n": 0}}, "1 to 1000"),
    ],
)
def test_what_means_nothing_is_refused(ranges, words):
    with pytest.raises(InputRefused, match=words):
        vary("slicewise", ranges)


def test_thresholds_are_held_to_their_range():
    with pytest.raises(InputRefused, match="50 to 3000 HU"):
        vary("hull", thresholds_hu=[10])


class TestKeys:
    def test_tell_runs_apart(self):
        case = phantom_cases(["burr_hole"], [0])[0]
        setting = Setting(Contender("slicewise", "default", {"skip_mm": 1.0, "tension": 2.0}))
        others = [
            (phantom_cases(["burr_hole"], [1])[0], setting, "1"),
            (case, Setting(Contender("slicewise", "paper", setting.contender.options)), "1"),
            (case, Setting(Contender("slicewise", "default", {"skip_mm": 2.0, "tension": 2.0})), "1"),
            (case, Setting(setting.contender, 300.0), "1"),
            (case, setting, "2"),
        ]
        keys = {run_key(case, setting, "1"), *(run_key(*other) for other in others)}
        assert len(keys) == 1 + len(others)

    def test_do_not_hang_on_order_or_place(self):
        a, b = ({"skip_mm": 1.0, "tension": 2.0}, {"tension": 2.0, "skip_mm": 1.0})
        here, there = (Case("x", "scan", {"path": "x"}, folder) for folder in ("here", "there"))
        keys = [run_key(c, Setting(Contender("hull", "default", o)), "1") for c, o in ((here, a), (there, b))]
        assert keys[0] == keys[1]


class TestBatches:
    @given(done=st.sets(st.integers(0, 35)))
    def test_hold_what_is_left_once_and_in_the_order_of_the_cases(self, done):
        asked = plan(3, tuple(np.arange(12) / 10))
        keys = list(asked.keys(version))
        batches = list(asked.batches({keys[i] for i in done}, version))
        assert [k for batch in batches for k in batch.keys] == [k for i, k in enumerate(keys) if i not in done]
        assert all(1 <= len(batch.keys) <= 10 for batch in batches)

    def test_share_case_and_threshold(self):
        asked = Plan(plan(2).cases, tuple(vary("hull", {"axial": [True]}, [300, 500])))
        batches = list(asked.batches((), version))
        assert [(b.case.name, b.threshold_hu, len(b.keys)) for b in batches] == [
            (case.name, threshold, 1) for case in asked.cases for threshold in (None, 300.0, 500.0)
        ]

    def test_parts_are_the_whole(self):
        asked = plan(5)
        parts = [key for i in (1, 2, 3) for key in asked.part(i, 3).keys(version)]
        assert sorted(parts) == sorted(asked.keys(version))


def test_a_name_stands_for_one_case():
    with pytest.raises(InputRefused, match="two cases are named"):
        Plan((*plan(1).cases, *plan(1).cases))

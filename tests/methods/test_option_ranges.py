"""Every option of every method at the ends of its range and beyond; whatever JSON holds is run or refused."""

import json
from collections import Counter
from contextlib import suppress
from itertools import product

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import cranio_nb as cn
from cranio_nb.errors import CranioError, InputRefused
from cranio_nb.methods.catalogue import METHODS, check_options, default_options, find_method, options_of, preset_options
from cranio_nb.methods.slicewise import method as slicewise
from cranio_nb.stages import deformable_model
from data_synth import phantom_case

ENDS = [
    (method, name, end)
    for method in METHODS
    for name, option in options_of(method).items()
    for end in ((False, True) if option.kind == "true or false" else (option.low, option.high))
    if option.kind != "text"
]


def beyond(option):
    """Values just outside a range, and of every other kind."""
    ends = (option.low, option.high)
    if option.kind == "whole number":
        numbers = [ends[0] - 1, ends[1] + 1]
    elif option.kind == "number":
        gap = 1e-6 * (ends[1] - ends[0])
        numbers = [ends[0] - gap, ends[1] + gap]
    else:
        numbers = [0, 1]
    wrong = True if option.kind != "true or false" else "true"
    return [*numbers, float("nan"), float("inf"), -float("inf"), 10**5000, wrong, [1], {"a": 1}]


@pytest.mark.parametrize("method", METHODS)
def test_every_option_declares_what_it_is(method):
    for name, option in options_of(method).items():
        assert option.about.endswith("."), name
        assert option.limits or option.kind == "true or false", name
        assert option.allows(option.default), name
        low, high = option.span
        assert option.low <= low <= high <= option.high, name


@pytest.mark.parametrize(("method", "name", "end"), ENDS)
def test_an_option_at_an_end_of_its_range_runs(method, name, end, skull, openings):
    made = cn.design(skull("burr_hole"), openings("burr_hole"), method=method, **{name: end})
    assert made.parameters[name] == end and made.patch.voxels.any()


@pytest.mark.parametrize("method", METHODS)
def test_beyond_its_range_an_option_is_refused_with_the_range(method, skull):
    for name, option in options_of(method).items():
        for value in beyond(option):
            with pytest.raises(InputRefused) as refused:
                cn.design(skull("burr_hole"), (), method=method, **{name: value})
            assert refused.value.code == "BadOption" and name in refused.value.message
            assert option.wanted in refused.value.remedy


@pytest.mark.parametrize("method", METHODS)
def test_presets_lie_within_the_ranges(method, skull):
    preset = "paper" if method in ("slicewise", "hull", "reflection") else "default"
    check_options(method, preset_options(method, preset, skull()))


def ends_of(name, option):
    if option.kind == "true or false":
        return [False, True]
    return [option.low, option.default, option.high] if option.kind != "text" else [option.default]


@pytest.mark.parametrize(
    ("method", "costly"),
    [
        ("slicewise", ("axial", "directions", "n_snaxels", "max_iter")),
        ("dnurbs", ("free_weights", "span_mm", "max_iter")),
    ],
)
def test_options_at_their_ends_together_are_refused_where_their_work_is_beyond_what_one_alone_asks_for(method, costly):
    options, work, accepted, refused = options_of(method), find_method(method).work, [], []
    for values in product(*(ends_of(name, options[name]) for name in costly)):
        asked = dict(zip(costly, values, strict=True))
        amount = work.amount(default_options(method) | asked)
        try:
            check_options(method, asked)
            accepted.append(amount)
        except InputRefused as error:
            assert error.code == "TooMuchWork" and error.remedy
            refused.append(amount)
    assert max(accepted) <= work.most < min(refused)
    assert max(refused) > 3 * work.most  # what would be computed else


def counted_moves(monkeypatch):
    """Steps of single points that the balloons make from now on, and how many points each part of them has."""
    moves, points, relaxed = [], [], deformable_model._relaxed

    def counted(curves, *rest, **more):
        points.append(len(curves) * curves.shape[2])
        for taken in relaxed(curves, *rest, **more):
            moves.append(np.count_nonzero(taken[1]) * curves.shape[2])
            yield taken

    monkeypatch.setattr(deformable_model, "_relaxed", counted)
    return moves, points


@pytest.mark.parametrize("axial", [False, True])
@pytest.mark.parametrize(("directions", "n_snaxels", "max_iter"), [(1, 5, 9), (3, 21, 4)])
def test_no_slice_takes_more_steps_of_points_than_are_counted(axial, directions, n_snaxels, max_iter, monkeypatch):
    asked = {"axial": axial, "directions": directions, "n_snaxels": n_snaxels, "max_iter": max_iter}
    moves, _ = counted_moves(monkeypatch)
    case = phantom_case("tiny", "burr_hole", 0)
    made = cn.design(cn.Volume(case.bone, case.affine), method="slicewise", tol=1e-9, **asked)
    slices = [one for one in made.record["slices"] if one["status"] == "balloon"]
    per_direction = max(Counter(one.get("direction", 0) for one in slices).values())
    most = find_method("slicewise").work.amount(default_options("slicewise") | asked)
    assert 0 < sum(moves) <= 2 * per_direction * most  # an outer and an inner curve


def test_balloons_that_a_small_tol_keeps_moving_are_stopped_and_said_not_to_be_at_rest(skull, openings, monkeypatch):
    monkeypatch.setattr(slicewise, "MOST_MOVES", 500_000)
    moves, points = counted_moves(monkeypatch)
    made = cn.design(skull("burr_hole"), openings("burr_hole"), method="slicewise", n_snaxels=201, tol=1e-9)
    assert 500_000 <= sum(moves) < 500_000 + sum(points)  # at most a step too many of each part
    balloons = [one for one in made.record["slices"] if one["status"] == "balloon"]
    assert not any(all(one["converged"]) for one in balloons) and made.patch.voxels.any()


NUMBERS = st.floats() | st.integers() | st.integers(-5, 50) | st.floats(-1, 50)
VALUES = st.recursive(
    st.none() | st.booleans() | NUMBERS | st.text(max_size=8),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=4), inner, max_size=3),
    max_leaves=6,
)
COSTLY = {"dnurbs": {"free_weights", "max_iter"}, "slicewise": {"max_iter"}}


@st.composite
def requests(draw):
    """A method and what a file of options might hold for it."""
    method = draw(st.sampled_from(sorted(METHODS)))
    names = st.sampled_from(sorted(default_options(method))) | st.text(max_size=6)
    return method, draw(st.dictionaries(names, VALUES, min_size=1, max_size=3))


@settings(max_examples=150, deadline=None, database=None)
@given(requests())
def test_whatever_json_holds_is_allowed_or_refused(request_):
    method, options = request_
    try:
        options = json.loads(json.dumps(options))
        check_options(method, options)
    except InputRefused as refused:
        assert refused.code in ("BadOption", "UnknownOption") and refused.remedy
    else:
        assert all(options_of(method)[name].allows(value) for name, value in options.items())


@st.composite
def within(draw):
    """A method and options of it, each anywhere in its range."""
    method = draw(st.sampled_from(sorted(METHODS)))
    options = {}
    for name, option in options_of(method).items():
        if name in COSTLY.get(method, ()) or not draw(st.booleans()):
            continue
        if option.kind == "true or false":
            options[name] = draw(st.booleans())
        elif option.kind == "text":
            options[name] = draw(st.text(max_size=8).filter(option.allows))
        elif option.kind == "whole number":
            options[name] = draw(st.integers(int(option.low), int(option.high)))
        else:
            options[name] = draw(st.floats(option.low, option.high))
    return method, options


@settings(max_examples=4, deadline=None, database=None, suppress_health_check=list(HealthCheck))
@given(request_=within())
def test_any_options_within_their_ranges_end_in_a_design_or_a_named_refusal(request_, skull, openings):
    method, options = request_
    with suppress(CranioError):
        made = cn.design(
            skull("burr_hole"),
            openings("burr_hole"),
            method=method,
            **({"max_iter": 50} if method == "slicewise" else {}),
            **options,
        )
        assert made.patch.voxels.any()

"""Sums over places, span by span, are those over all places at once."""

import numpy as np
import pytest
from sheets import SPANS, dense

from cranio_nb.methods.dnurbs.sheet import BY_VU, VALUE, tensor
from cranio_nb.methods.dnurbs.span_sums import control_of, sorted_places, span_band, span_products


@pytest.fixture
def scattered(rng):
    """Many places in one corner, some on knots and on the ends, and spans without any."""
    v = np.concatenate([rng.uniform(0, 1.5, 50), [0, 1, 2, SPANS[0], SPANS[0]]])
    u = np.concatenate([rng.uniform(0, 2.5, 50), [SPANS[1], 0, 2, SPANS[1], 0.5]])
    return v, u


def test_places_are_sorted_by_the_span_that_holds_them(scattered):
    places = sorted_places(*scattered, SPANS)
    assert sorted(places.order) == list(range(len(scattered[0])))
    for d in (VALUE, BY_VU):
        part = tensor(*(x[places.order] for x in scattered), SPANS, d)
        for control, first, end in zip(control_of(SPANS), places.ends[:-1], places.ends[1:], strict=True):
            assert (part.indices.reshape(-1, 16)[first:end] == control).all()


def test_the_sums_of_all_spans_are_b_f_b(scattered, rng):
    places = sorted_places(*scattered, SPANS)
    fields = rng.normal(size=(len(scattered[0]), 2))
    splines = tensor(*(x[places.order] for x in scattered), SPANS, VALUE).toarray()
    for field, products in zip(fields.T, span_products(places, fields).swapaxes(0, 1), strict=True):
        # no product of two B-splines is above 1
        np.testing.assert_allclose(
            dense(span_band(products, SPANS)), splines.T @ (field[:, None] * splines), atol=1e-12
        )

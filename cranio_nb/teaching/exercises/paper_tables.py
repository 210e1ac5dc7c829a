"""Exercises of lesson 10: a row of Tables 1 and 2, angles from gaps."""

from __future__ import annotations

import numpy as np

from .task import Answer, Exercise


def _records():
    def entry(plane, status, theta0, theta1, off_mm):
        return {"plane": plane, "status": status, "theta0": theta0, "theta1": theta1, "off_mm": off_mm}

    slices = [
        entry(22, "balloon", [14.0, 28.7], [151.0, 167.2], [-2.1, -0.4]),
        entry(25, "carried", [6.2, 33.4], [144.0, 171.0], [0.3, 0.2]),
        entry(20, "hull", [0.0, 0.0], [0.0, 0.0], [-3.5, -3.1]),
        entry(23, "balloon", [36.3, 27.5], [138.0, 140.1], [-0.9, -1.3]),
        entry(21, "balloon", [8.5, -2.0], [155.5, 150.3], [-1.6, -2.4]),
        entry(24, "balloon", [7.0, 11.6], [166.1, 158.0], [-1.2, -0.2]),
        entry(19, "skipped", [3.4, 41.5], [170.4, 139.0], [-0.1, 0.5]),
        entry(18, "balloon", [12.0, 31.9], [145.0, 163.0], [-0.7, -0.6]),
    ]
    # an answer that ignores the key is right once at most; the smallest of the two sides are in different slices; the
    # last slice counts; some values are all above 100, some all below 0
    return [(slices, "theta0", 1), (slices, "theta1", 1), (slices, "off_mm", 0)]


def _has(entry):
    return entry["status"] == "balloon"


def _values(slices, key, side):
    return [s[key][side] for s in slices if _has(s)]


def _extremes(values):
    return min(values), max(values)


def _range(slices, key, side):
    return _extremes(_values(slices, key, side))


def _by_plane(slices, key, side):
    values = _values(sorted(slices, key=lambda entry: entry["plane"]), key, side)
    return values[0], values[-1]


def _arcs():
    return [(50.0, 75.0), (33.5, 75.0), (70.0, 80.0)]


EXERCISES: dict[str, Exercise] = {
    "10.1": Exercise(
        cases=_records,
        right=_range,
        answer=Answer("two numbers: smallest and largest", unit="", tolerance=1e-9),
        mistakes=(
            (
                lambda s, k, i: (min(x[k][i] for x in s), max(x[k][i] for x in s)),
                "Slices filled by the hull have no balloon: leave them out.",
            ),
            *(
                (
                    lambda s, k, i, out=out: _extremes([x[k][i] for x in s if x["status"] not in out]),
                    "Carried and skipped slices have no balloon of their own either: take those whose status says so.",
                )
                for out in (("hull",), ("hull", "skipped"), ("hull", "carried"))
            ),
            (
                lambda s, k, i: _extremes([x[k][i] for x in s if x[k][i] > 0]),
                "An angle below 0 is a value, and slices without a balloon may have some: ask for the status.",
            ),
            (lambda s, k, i: _range(s[:-1], k, i), "The last slice is left out."),
            (lambda s, k, i: _range(s[1:], k, i), "The first slice is left out."),
            (
                lambda s, k, i: (int(np.argmin(_values(s, k, i))), int(np.argmax(_values(s, k, i)))),
                "These are places in the list, not the values there: min and max, not argmin and argmax.",
            ),
            *(
                (
                    lambda s, k, i, low=low, high=high: (min([low, *_values(s, k, i)]), max([high, *_values(s, k, i)])),
                    "A search that starts from a number of your own may end there: start from the first value.",
                )
                for low, high in ((np.inf, 0), (1000, 0), (100, 0), (100, -np.inf), (0, 0), (0, -np.inf))
            ),
            (
                lambda s, k, i: tuple(pick([x[k] for x in s if _has(x)])[i] for pick in (min, max)),
                "min and max of pairs compare the outer side first: take s[key][side] before, not after.",
            ),
            (
                lambda s, k, i: tuple(int(value) for value in _range(s, k, i)),
                "Rounded down: return the values as they are.",
            ),
            (lambda s, k, i: np.round(_range(s, k, i)), "Rounded: return the values as they are."),
            (lambda s, k, i: _range(s, k, 1 - i), "Outer is side 0, inner is side 1."),
            (lambda s, k, i: _range(s, k, 0), "This is the outer side whatever `side` says: take s[key][side]."),
            (lambda s, k, i: _range(s, k, 1), "This is the inner side whatever `side` says: take s[key][side]."),
            (lambda s, k, i: _range(s, "theta0", i), "This is theta0 whatever `key` says: take s[key][side]."),
            (lambda s, k, i: _range(s, "theta1", i), "This is theta1 whatever `key` says: take s[key][side]."),
            (
                lambda s, k, i: (np.min([x[k] for x in s if _has(x)]), np.max([x[k] for x in s if _has(x)])),
                "Both sides are thrown together: take s[key][side].",
            ),
            (lambda s, k, i: _range(s, k, i)[::-1], "The smallest comes first."),
            (
                lambda s, k, i: (_values(s, k, i)[0], _values(s, k, i)[-1]),
                "These are the first and the last; slices come in any order, so take min and max.",
            ),
            (
                lambda s, k, i: (np.mean(_values(s, k, i)),) * 2,
                "This is the mean; the paper's tables give smallest and largest.",
            ),
            (
                lambda s, k, i: (np.mean(_values(s, k, i)), np.std(_values(s, k, i))),
                "These are mean and spread; the paper's tables give smallest and largest.",
            ),
            (
                lambda s, k, i: (np.median(_values(s, k, i)),) * 2,
                "This is the median; the paper's tables give smallest and largest.",
            ),
            *(
                (
                    lambda s, k, i, of=of: _extremes([x[k][i] for x in s if x["status"] in of]),
                    'These are the slices without a balloon: status == "balloon".',
                )
                for of in (("hull",), ("carried",), ("skipped",), ("hull", "carried", "skipped"))
            ),
            (
                lambda s, k, i: max(_values(s, k, i)) - min(_values(s, k, i)),
                "This is how far they spread: return the smallest and the largest.",
            ),
            (lambda s, k, i: sorted(_values(s, k, i)), "All values in order: return the first and the last of them."),
            (
                lambda s, k, i: (min(x[k] for x in s if _has(x)), max(x[k] for x in s if _has(x))),
                "`side` is not used: s[key] holds outer and inner, take s[key][side].",
            ),
            (lambda s, k, i: min(_values(s, k, i)), "Only the smallest: return both, smallest and largest."),
            (lambda s, k, i: max(_values(s, k, i)), "Only the largest: return both, smallest and largest."),
            (
                lambda s, k, i: (min(x["plane"] for x in s if _has(x)), max(x["plane"] for x in s if _has(x))),
                "These are numbers of planes: take s[key][side].",
            ),
            (_by_plane, "These are the values of the lowest and the highest slice: take min and max of the values."),
        ),
        hints=(
            "Which slices have a balloon? Look at their status.",
            "Take s[key][side] of those.",
            "min and max of these; give both back, the smaller first.",
        ),
        praise="a row of Tables 1 and 2.",
    ),
    "10.2": Exercise(
        cases=_arcs,
        right=lambda chord, radius: np.degrees(np.arcsin(chord / 2 / radius)),
        answer=Answer("one number", unit="degrees", tolerance=1e-6),
        mistakes=(
            (lambda c, r: np.arcsin(c / 2 / r), "This is in radians; the paper's tables are in degrees."),
            (
                lambda c, r: np.degrees(np.arcsin(c / r)),
                "Half the chord belongs to the right angle: chord / 2.",
            ),
            (
                lambda c, r: np.degrees(np.arctan(c / 2 / r)),
                "The radius is the long side of the right angle's triangle: a sine, not a tangent.",
            ),
            (
                lambda c, r: np.degrees(2 * np.arcsin(c / 2 / r)),
                "This is the angle at the centre; the tangent leans by half of it.",
            ),
            (
                lambda c, r: np.degrees(np.arccos(c / 2 / r)),
                "This is the angle to the radius; the tangent stands at a right angle to it: a sine.",
            ),
            (lambda c, r: 180 - np.degrees(np.arcsin(c / 2 / r)), "This is theta1, the obtuse angle at the other end."),
            (
                lambda c, r: np.degrees(c / 2 / r),
                "This takes the angle for its sine: right for small gaps only. Use np.arcsin.",
            ),
            (
                lambda c, r: np.degrees(c / r),
                "This takes the chord for the arc, and the whole for the half: sin theta = (chord / 2) / radius.",
            ),
            (lambda c, r: np.sin(c / 2 / r), "(chord / 2) / radius is the sine; the angle is its np.arcsin."),
            (
                lambda c, r: np.degrees(np.sin(c / 2 / r)),
                "(chord / 2) / radius is the sine; the angle is its np.arcsin.",
            ),
            (
                lambda c, r: np.degrees(np.arctan2(c, r)),
                "Half the chord over the radius is a sine: the radius is the long side of that triangle.",
            ),
            (lambda c, r: np.degrees(np.arcsin(c / 4 / r)), "Halved twice: half the chord over the radius."),
            (
                lambda c, r: np.degrees(np.arcsin(c / 2 / r)) / 2,
                "Halved twice: theta itself is the angle whose sine is half the chord over the radius.",
            ),
            (
                lambda c, r: np.radians(np.arcsin(c / 2 / r)),
                "np.radians goes from degrees to radians; the other way is np.degrees.",
            ),
            (lambda c, r: np.arctan(c / 2 / r), "A sine, not a tangent; and in degrees."),
            (lambda c, r: np.arcsin(c / r), "Half the chord belongs to the right angle: chord / 2; and in degrees."),
            (
                lambda c, r: 2 * np.arcsin(c / 2 / r),
                "This is the angle at the centre, and in radians: half, in degrees.",
            ),
            (lambda c, r: c / 2 / r, "This is the sine of the angle: np.arcsin, in degrees."),
            (
                lambda c, r: np.degrees(2 * np.arctan(c / 2 / r)),
                "A sine, not a tangent; and theta itself, not the angle at the centre.",
            ),
        ),
        hints=(
            "Draw the radius to one end and to the middle of the chord.",
            "sin theta = (chord / 2) / radius.",
            "Solve for theta: np.arcsin gives radians.",
        ),
        praise="with the radius, an angle says how wide a gap was.",
    ),
}
"""The exercises of lesson 10, by number."""

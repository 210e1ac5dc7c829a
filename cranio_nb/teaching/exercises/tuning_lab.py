"""Exercises of lesson 11: paired differences, k for a tension, an interaction, a setting judged elsewhere."""

from __future__ import annotations

import numpy as np

from .task import Answer, Exercise


def _tables():
    """Dice of heads (rows) with settings (columns): heads differ more than settings do."""
    rng = np.random.default_rng(3)
    cases = []
    for n_heads, n_settings, usual in ((4, 3, 0), (5, 4, 2), (3, 5, 4)):
        heads = 0.9 + 0.05 * rng.standard_normal((n_heads, 1))
        settings = 0.02 * rng.standard_normal(n_settings)
        cases.append((heads + settings + 0.01 * rng.standard_normal((n_heads, n_settings)), usual))
    return cases


def _gains(scores, usual):
    return scores - scores[:, [usual]]


def _rows(gains):
    return np.array([gains.mean(axis=0), gains.std(axis=0, ddof=1)])


def _paired(scores, usual):
    return _rows(_gains(scores, usual))


def _circles():
    return [(60.0, 80.0, 41, 1.0), (45.0, 75.0, 21, 2.0), (90.0, 70.0, 31, 0.5)]


def _pressure(length, radius, n, tension):
    return tension * (length / (n - 1)) ** 2 / radius


def _pairs():
    rng = np.random.default_rng(5)
    cases = []
    for shape in ((3, 4), (4, 2), (2, 5)):
        own = rng.normal(0, 0.1, (shape[0], 1)) + rng.normal(0, 0.1, shape[1])
        cases.append((0.8 + own + rng.normal(0, 0.05, shape),))
    return cases


def _of_rows(table):
    return table.mean(axis=1, keepdims=True)


def _of_columns(table):
    return table.mean(axis=0, keepdims=True)


def _together(table):
    return table - _of_rows(table) - _of_columns(table) + table.mean()


def _trials():
    """Dice of heads (rows) with settings (columns), in which the best setting hinges on single heads."""
    rng = np.random.default_rng(9)
    cases = [
        (0.9 + 0.05 * rng.standard_normal(shape),) for shape in ((4, 6), (9, 5), (3, 4))
    ]  # more heads than settings, too
    cases[2] = (np.array([[0.95, 0.80, 0.90, 0.70], [0.70, 0.94, 0.88, 0.60], [0.80, 0.70, 0.92, 0.96]]),)
    return cases


def _others(scores):
    """Mean of each setting over all heads but one, a row for each head left out."""
    return (scores.sum(axis=0) - scores) / (len(scores) - 1)


def _on_left_out(scores, chosen):
    return np.mean(scores[np.arange(len(scores)), chosen])


def _chosen_by(way, scores):
    return _on_left_out(scores, np.argmax([way(np.delete(scores, i, 0), 0) for i in range(len(scores))], axis=1))


def _all_held_out(scores):
    return scores[np.arange(len(scores)), _others(scores).argmax(axis=1)]


def _held_out(scores):
    return _all_held_out(scores).mean()


_OTHER_SPREADS = (
    (lambda s, u: _rows(s)[1], "The spread of the scores holds how heads differ: take that of the differences."),
    (lambda s, u: _gains(s, u).std(axis=0), "Divide by one head less, ddof=1: the mean is from the same few heads."),
    (lambda s, u: _paired(s, u)[1] ** 2, "This is the variance; the spread is its root, std."),
    (lambda s, u: _paired(s, u)[1] / np.sqrt(len(s)), "This is the error of the mean: leave out the root of heads."),
    (lambda s, u: np.ptp(_gains(s, u), axis=0), "This is the range; the standard deviation is wanted."),
    (lambda s, u: _rows(s)[1] - _rows(s)[1][u], "The difference of two spreads; take the spread of differences."),
    (lambda s, u: 0 * s[0] + _gains(s, u).std(ddof=1), "One spread over all settings: take axis=0."),
    (lambda s, u: np.hypot(_rows(s)[1], _rows(s)[1][u]), "Two spreads added as if apart: take the differences'."),
)
"""What is taken for the spread of the gains, and what to say of it."""


EXERCISES: dict[str, Exercise] = {
    "11.1": Exercise(
        cases=_tables,
        right=_paired,
        answer=Answer("two rows, mean and spread, with a column for each setting", unit="", tolerance=1e-9),
        mistakes=(
            *(
                (lambda s, u, spread=spread: np.array([_gains(s, u).mean(axis=0), spread(s, u)]), sentence)
                for spread, sentence in _OTHER_SPREADS
            ),
            (lambda s, u: _rows(s / s[:, [u]] - 1), "These are relative gains: take the usual score off, no division."),
            (
                lambda s, u: _rows(s),
                "These are the scores themselves: take off, head by head, that of the usual setting.",
            ),
            (
                lambda s, u: np.array([s.mean(axis=0), _gains(s, u).std(axis=0, ddof=1)]),
                "The mean is that of the scores: take that of the differences.",
            ),
            (
                lambda s, u: np.array([-1, 1])[:, None] * _paired(s, u),
                "The sign is turned: a gain is the setting's score less that of the usual setting.",
            ),
            (
                lambda s, u: np.array([np.abs(_gains(s, u)).mean(axis=0), _gains(s, u).std(axis=0, ddof=1)]),
                "Without their signs losses count as gains: no np.abs.",
            ),
            (lambda s, u: _paired(s, 0), "Always against the first setting: the usual one is the column `usual`."),
            (
                lambda s, u: np.array([np.median(_gains(s, u), axis=0), _gains(s, u).std(axis=0, ddof=1)]),
                "This is the median of the differences; their mean is wanted.",
            ),
            (
                lambda s, u: np.array([_gains(s, u).mean(axis=1), _gains(s, u).std(axis=1, ddof=1)]),
                "Heads are rows: mean and spread over heads go along axis 0.",
            ),
            (
                lambda s, u: _rows(s - s.mean()),
                "Differences from the mean of all: take off the score of the usual setting on the same head.",
            ),
            (
                lambda s, u: _rows(s - _of_rows(s)),
                "Differences from each head's mean: take off the score of the usual setting.",
            ),
            (lambda s, u: np.array([len(s), 1])[:, None] * _paired(s, u), "These are sums of gains, not means."),
            (lambda s, u: _gains(s, u).mean(axis=0), "Only the mean: return mean and spread, two rows."),
            (lambda s, u: _paired(s, u)[::-1], "The mean comes first, then the spread."),
            (lambda s, u: _paired(s, u).T, "A row for the mean and one for the spread: yours are columns."),
        ),
        hints=(
            "Compare on the same head: take off the usual setting's score before anything else.",
            "scores[:, [usual]] is a column, one score for each head; it can be taken off all settings at once.",
            "Then mean(axis=0) and std(axis=0, ddof=1) of the differences, as two rows.",
        ),
        praise="whatever is hard about a head drops out when settings are compared on the same head.",
    ),
    "11.2": Exercise(
        cases=_circles,
        right=_pressure,
        answer=Answer("one number", unit="mm per index squared", tolerance=1e-9),
        mistakes=(
            (lambda d, r, n, w: _pressure(d, r, n, 1.0), "The tension is not used: twice of it, twice the pressure."),
            (
                lambda d, r, n, w: _pressure(d, r, n, 1 / w),
                "Divided by the tension: a stronger one needs more pressure, not less.",
            ),
            *(
                (lambda d, r, n, w, k=k: w * (d / (n + k)) ** 2 / r, "n snaxels have n - 1 steps between them.")
                for k in (-2, 0, 1)
            ),
            (lambda d, r, n, w: w * (d / (n - 1)) ** 4 / r**3, "This is the rigidity's part: the tension's is wanted."),
            (lambda d, r, n, w: w * (d / n - 1) ** 2 / r, "length / n - 1 divides first: put n - 1 in brackets."),
            (lambda d, r, n, w: w * d / (n - 1) / r, "The step comes in squared: k is a length per index *squared*."),
            (
                lambda d, r, n, w: w * (d / (n - 1)) ** 2 * r,
                "Multiplied by the radius: a flat bow, of large radius, needs little pressure.",
            ),
            (
                lambda d, r, n, w: w * (d / (n - 1)) ** 2 / r**2,
                "The curvature of a circle is 1 / radius, not its square.",
            ),
            (
                lambda d, r, n, w: w * (d / (n - 1)) ** 2 / (2 * r),
                "The curvature of a circle is 1 / radius, not half of it.",
            ),
            (lambda d, r, n, w: w**2 * (d / (n - 1)) ** 2 / r, "The tension comes in once, not squared."),
            (lambda d, r, n, w: w * d**2 / r, "This is for one step over the whole length: divide it first."),
            (lambda d, r, n, w: w * (d / (n - 1)) ** 2, "The radius is not used: the curvature is 1 / radius."),
            (
                lambda d, r, n, w: w / r,
                "This is the pull per mm squared; per index squared it is the step squared times that.",
            ),
            *(
                (lambda d, r, n, w, h=h: 8 * w * h(d, r) / (n - 1) ** 2, "8 rise / N^2 is k for a shallow bow only.")
                for h in (lambda d, r: r - np.sqrt(r**2 - d**2 / 4), lambda d, r: r - r * np.cos(d / 2 / r))
            ),
            (
                lambda d, r, n, w: w * d**2 / (8 * r),
                "This is the height of the bow, k N^2 / 8 (lesson 04); the k itself is wanted.",
            ),
            *(
                (mistake, "The rigidity is still in it: the tension alone is asked about.")
                for mistake in (
                    lambda d, r, n, w: _pressure(d, r, n, w) + (d / (n - 1)) ** 4 / r**3,
                    lambda d, r, n, w: _pressure(d, r, n, w) + w * (d / (n - 1)) ** 4 / r**3,
                    lambda d, r, n, w: _pressure(d, r, n, w) - (d / (n - 1)) ** 4 / r**3,
                )
            ),
            (
                lambda d, r, n, w: _pressure(2 * r * np.sin(d / 2 / r), r, n, w),
                "This divides the chord from end to end: `length` lies along the balloon, and so do its steps.",
            ),
            (
                lambda d, r, n, w: _pressure(2 * r * np.arcsin(d / 2 / r), r, n, w),
                "This takes `length` for the chord from end to end: it is the length along the balloon already.",
            ),
            (
                lambda d, r, n, w: w * (2 * r * np.sin(d / (n - 1) / 2 / r)) ** 2 / r,
                "This takes a step straight, as a chord: here h is the step along the circle, length / (n - 1).",
            ),
            (
                lambda d, r, n, w: -_pressure(d, r, n, w),
                "Outward is positive: the pressure has the sign of the curvature it holds.",
            ),
        ),
        hints=(
            "At rest the pressure at a snaxel is as large as the pull of the tension there: w1 times the second "
            "difference.",
            "On a circle the second difference of points h apart is h^2 / radius.",
            "h is the length over the number of steps, n - 1.",
        ),
        praise="the automatic k is this with a tension of 1.",
    ),
    "11.3": Exercise(
        cases=_pairs,
        right=_together,
        answer=Answer("a table of the same shape", unit="", tolerance=1e-9),
        mistakes=(
            (
                lambda t: t - _of_rows(t) - _of_columns(t),
                "The mean of all was taken off twice, with the rows and with the columns: add it once.",
            ),
            (lambda t: t - _of_rows(t), "Only the rows' means are taken off: the columns' effect is still in it."),
            (lambda t: t - _of_columns(t), "Only the columns' means are taken off: the rows' effect is still in it."),
            (
                lambda t: t - t.mean(),
                "These are differences from the mean of all; what each parameter does alone is still in them.",
            ),
            (
                lambda t: _of_rows(t) + _of_columns(t) - t.mean(),
                "This is what the parameters make without an interaction: the table less this is wanted.",
            ),
            (lambda t: -_together(t), "The sign is turned: the table less what the parameters make alone."),
            (lambda t: t - _of_rows(t) - _of_columns(t) + 2 * t.mean(), "The mean of all is added once, not twice."),
            (
                lambda t: t - _of_rows(t) - _of_columns(t) - t.mean(),
                "The mean of all is added, not taken off a third time.",
            ),
            (lambda t: np.abs(_together(t)), "The signs say where the pair does better and where worse: keep them."),
            (lambda t: _together(t) ** 2, "These are squares; the parts themselves are wanted."),
            (lambda t: np.abs(_together(t)).max(), "This is the largest of them; a table is wanted."),
            (
                lambda t: t / _of_rows(t) / _of_columns(t) * t.mean(),
                "These are ratios; effects are added, so take means off.",
            ),
            (
                lambda t: t - np.median(t, 1, keepdims=True) - np.median(t, 0, keepdims=True) + np.median(t),
                "These are medians; the parts of a variance come from means.",
            ),
            (
                lambda t: t - t[:1] - t[:, :1] + t[0, 0],
                "These are differences from the first level: take off the means of rows and columns.",
            ),
            (lambda t: _together(t) / t.std(), "No need to scale: leave the parts in the unit of the table."),
        ),
        hints=(
            "Without an interaction each entry is the mean of all + what its row adds + what its column adds.",
            "A row adds its own mean less the mean of all; so does a column.",
            "keepdims=True keeps the means of rows a column and those of columns a row, so that they can be taken off.",
        ),
        praise="all its rows and columns sum to 0: nothing is left of either parameter alone.",
    ),
    "11.4": Exercise(
        cases=_trials,
        right=_held_out,
        answer=Answer("one number", unit="", tolerance=1e-9),
        mistakes=(
            (
                lambda s: s.mean(axis=0).max(),
                "This setting was chosen by the heads that it is judged by: choose it without the head in question.",
            ),
            (
                lambda s: s.max(axis=1).mean(),
                "Each head has the setting that is best for itself: choose by the other heads.",
            ),
            (lambda s: s.mean(), "This is the mean of all settings: choose one for each head."),
            (lambda s: s.max(), "This is the best score of all; a mean over heads is wanted."),
            (
                lambda s: _others(s).max(axis=1).mean(),
                "This is how the chosen settings did on the heads they were chosen by: look at the head left out.",
            ),
            (
                lambda s: _on_left_out(s, _others(s).argmin(axis=1)),
                "The worst setting on the others is chosen: the largest score is the best.",
            ),
            *(
                (
                    lambda s, by=by: _on_left_out(s, np.roll(s, by, axis=0).argmax(axis=1)),
                    f"Chosen by one other head, {which}: choose by the mean of all others.",
                )
                for by, which in ((1, "the one before"), (-1, "the next one"))
            ),
            *(
                (lambda s, way=way: way(_all_held_out(s)), f"This is the {word} of the heads left out, not their mean.")
                for way, word in ((np.median, "median"), (np.min, "worst"), (np.max, "best"))
            ),
            (lambda s: _all_held_out(s).sum(), "This is a sum; divide it by the number of heads."),
            (_all_held_out, "One score for each head left out, and right: return their mean."),
            (lambda s: _others(s).argmax(axis=1), "These are the settings chosen: return how they did."),
            *(
                (lambda s, i=i: s[i, _others(s)[i].argmax()], f"Only the {word} head is left out: each has its turn.")
                for i, word in ((0, "first"), (-1, "last"))
            ),
            (
                lambda s: s[:, _others(s).argmax(axis=1)].mean(),
                "scores[:, best] takes every head with every choice: each head goes with its own, one pair a head.",
            ),
            (
                lambda s: _others(s)[np.arange(len(s)), s.argmax(axis=1)].mean(),
                "Turned round: chosen by one head and judged on the others.",
            ),
            *(
                (lambda s, way=way: _chosen_by(way, s), f"Chosen by the {word} of the others: choose by their mean.")
                for way, word in ((np.median, "median"), (np.min, "worst case"), (np.max, "single best score"))
            ),
            (lambda s: _on_left_out(s, s.argmin(axis=1)), "The others are heads: sum and mean go along axis=0."),
            (lambda s: _held_out(s.T), "Rows are heads and columns settings: heads are left out."),
        ),
        hints=(
            "For each head: take its row out, and average each setting over the rows that are left.",
            "np.delete(scores, i, axis=0) is the table without head i; argmax of its mean(axis=0) is a setting.",
            "Look up scores[i, that setting], head by head, and return the mean.",
        ),
        praise="this is what the setting may be expected to do on the next head.",
    ),
}
"""The exercises of lesson 11, by number."""

"""The catalogue of wrong answers is large, covers every exercise, and nearly all of it is named by its cause.

That each answer is told what stands beside it is tested lesson by lesson in `exercises`.
"""

from wrong_answers import CATALOGUE

from cranio_nb.teaching.exercises import EXERCISES

LISTED = [(name, body, words) for name, answers in CATALOGUE.items() for body, words in answers]


def test_covers_every_exercise_with_different_answers():
    assert list(CATALOGUE) == list(EXERCISES)
    assert len({(name, body) for name, body, _ in LISTED}) == len(LISTED) >= 150


def test_nine_of_ten_causes_are_named():
    assert sum(words is not None for _, _, words in LISTED) >= 0.9 * len(LISTED)

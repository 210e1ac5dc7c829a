"""Wrong answers that students give, by exercise: the body of the function, and words of the sentence on its cause.

None in place of the words: the cause has no sentence, and the answer is shown beside the right one.
"""

from . import (
    ct,
    deformable_model,
    evaluation,
    feature_extraction,
    paper_tables,
    prosthesis_volume,
    rivals,
    segmentation,
    surface_reconstruction,
    three_d,
    tour,
    tuning_lab,
)

_LESSONS = (
    tour,
    ct,
    segmentation,
    feature_extraction,
    deformable_model,
    prosthesis_volume,
    surface_reconstruction,
    evaluation,
    rivals,
    three_d,
    paper_tables,
    tuning_lab,
)
CATALOGUE = {number: answers for lesson in _LESSONS for number, answers in lesson.WRONG.items()}

"""Three graded hand-ins, with names that a page or a table could take for code."""

from cranio_nb.teaching.grading.marks import HandIn
from cranio_nb.teaching.verdict import Verdict

OFF, SIGN = "N counts the steps between snaxels: N = n - 1.", "The sign is turned."


def hand_in(student, *messages, remark=""):
    verdicts = tuple(
        Verdict(f"4.{at}", 3 if words == "Right" else at, 3, words, "Case 1: yours 2, mine 3 px.")
        for at, words in enumerate(messages, start=1)
    )
    return HandIn(student, "04_deformable_model", verdicts, remark, tuple("<b>k</b>" for _ in messages))


CLASS = [
    hand_in("anna", OFF, "Right"),
    hand_in("=bo()", OFF, SIGN, remark="It died."),
    hand_in("<i>cy", "Right", SIGN),
]

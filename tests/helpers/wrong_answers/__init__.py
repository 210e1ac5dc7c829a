"""Wrong answers that students give, by exercise: the body of the function, and words of the sentence on its cause.

None in place of the words: the cause has no sentence, and the answer is shown beside the right one. Each lesson's are
in the module that is named as its exercises are.
"""

from importlib import import_module

from cranio_nb.teaching.exercises import LESSONS

_MODULES = [import_module(f"{__name__}.{name.partition('_')[2]}") for name in LESSONS]
CATALOGUE = {number: answers for module in _MODULES for number, answers in module.WRONG.items()}

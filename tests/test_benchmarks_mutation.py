"""Mutants of prose are told from those that change what a function does."""

from benchmark_scripts import FOLDER, script

MUTATED = """
def x_f__mutmut_orig(a):
    return "Give a number.", "code", ", ".join(a)
def x_f__mutmut_1(a):
    return "XXGive a number.XX", "code", ", ".join(a)
def x_f__mutmut_2(a):
    return "GIVE A NUMBER.", "code", ", ".join(a)
def x_f__mutmut_3(a):
    return None, "code", ", ".join(a)
def x_f__mutmut_4(a):
    return "Give a number.", "CODE", ", ".join(a)
def x_f__mutmut_5(a):
    return "Give a number.", "code", "XX, XX".join(a)
"""


mutation = script("mutation")


def test_a_mutant_of_prose_changes_a_string_with_a_space_between_words_and_nothing_else(mutation):
    assert mutation.prose_mutants(MUTATED) == {"x_f__mutmut_1", "x_f__mutmut_2"}


def test_the_share_counts_what_survived_among_the_mutants_asked_for(mutation):
    assert mutation.share({"a", "b", "c", "d"}, ["b", "e"]) == 0.75


def test_each_module_and_its_tests_are_there(mutation):
    root = FOLDER.parent
    for module, tests in mutation.MODULES.items():
        assert (root / f"cranio_nb/{module}.py").exists()
        assert all((root / f"tests/{test}.py").exists() for test in tests)

"""The benchmarks of damaged and oversized inputs: mutants are repeatable and judged rightly, bombs are measured."""

import numpy as np
from benchmark_scripts import script

from cranio_nb.errors import InputRefused

mutants = script("mutants")
bombs = script("bombs")


def test_the_same_number_is_the_same_mutant(mutants):
    good = bytes(range(256)) * 20
    made = [mutants._damaged(good, np.random.default_rng((0, i)), 128) for i in (5, 5, 6)]
    assert made[0] == made[1] != made[2]
    assert all(one[:128] == good[:128] for one in made if len(one) > 128)


def test_each_outcome_is_told_from_the_others(mutants, tmp_path):
    inputs = mutants._inputs(tmp_path)
    assert set(inputs) == {*mutants.SERIES, *mutants.FILES}
    sound = inputs["plain"][3]
    other = (sound[0].with_voxels(sound[0].voxels + 1), True)

    def refuse(message):
        raise InputRefused("CorruptFile", message)

    def stumble():
        raise KeyError

    assert mutants._kind(lambda: sound, sound) == "same"
    assert mutants._kind(lambda: other, sound) == "said"
    assert mutants._kind(lambda: (other[0], False), sound) == "different"
    assert mutants._kind(lambda: refuse("It is cut."), sound) == "refused"
    assert mutants._kind(lambda: refuse("The input cannot be read (KeyError)."), sound).startswith("foreign")
    assert mutants._kind(stumble, sound) == "foreign KeyError"


def test_a_few_mutants_of_every_input_are_read(mutants, capsys):
    lines, deaths = mutants._run(24, 0, None)
    assert [line["input"] for line in lines] == [*mutants.SERIES, *mutants.FILES] * 2 and deaths == 0
    mutants._print(lines, deaths)
    shown = capsys.readouterr().out
    assert "24 mutants read, 0 deaths" in shown and "foreign:" not in shown


def test_a_bomb_is_measured(bombs, tmp_path):
    _, mb, volume, outcome = bombs.measure(bombs.BOMBS["NIfTI, 8.6 GB in 352 bytes"](tmp_path / "bomb"))
    assert mb < 300 and volume == 0 and outcome.startswith("LimitExceeded")
    _, mb, volume, outcome = bombs.measure(bombs.BOMBS["3,000 slices at one place"](tmp_path / "place"))
    assert mb < 300 and volume == 0 and outcome.startswith("BadGeometry")

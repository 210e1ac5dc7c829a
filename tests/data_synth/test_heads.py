"""The synthetic heads by name: each is the case that its own function makes."""

import numpy as np
import pytest

from data_synth import HEADS, face_case, head_case, phantom_case


def test_each_name_gives_its_head():
    faced, dome = (head_case(name, "tiny", "frontal", 2) for name in HEADS)
    assert np.array_equal(faced.hu, face_case("tiny", 2, holes="frontal").hu) and faced.landmarks is not None
    assert np.array_equal(dome.hu, phantom_case("tiny", "frontal", 2).hu) and dome.landmarks is None


def test_an_unknown_head_is_named_with_those_there_are():
    with pytest.raises(ValueError, match="'skull'; choose one of face, simple"):
        head_case("skull")

"""Recipes of valid folders: their edits keep the true HU."""

import numpy as np

from data_synth.fault_free import valid_recipes
from data_synth.fault_series import head


def test_what_a_recipe_stores_is_near_the_head() -> None:
    for name, recipe in valid_recipes().items():
        hu = head() if recipe.hu is None else recipe.hu(head())
        assert hu.dtype == np.int16 and hu.ndim == 3, name
        assert recipe.heights is None, name

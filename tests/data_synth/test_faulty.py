"""Recipes of faulty folders: each changes something."""

from data_synth.fault_free import valid_recipes
from data_synth.fault_series import AXIAL
from data_synth.faulty import faulty_recipes


def test_every_recipe_holds_a_fault_and_no_name_is_used_twice() -> None:
    for name, recipe in faulty_recipes().items():
        changes = (recipe.edit, recipe.files, recipe.heights, recipe.hu)
        assert any(change is not None for change in changes) or recipe.orientation != AXIAL, name
    assert not set(faulty_recipes()) & set(valid_recipes())

"""Effects of parameters: what is drawn is what was given."""

import numpy as np

from cranio_nb.drawing.figures import Panel, effects_figure, pair_figure


def test_each_parameter_has_its_means_on_one_scale():
    panels = [Panel(f"p{i}", ("0", "1", "2"), np.arange(3.0) + i, np.ones(3)) for i in range(5)]
    axes = [ax for ax in effects_figure(panels, "DSC").axes if ax.get_visible()]
    assert [ax.get_xlabel() for ax in axes] == [f"p{i}" for i in range(5)]
    assert [ax.lines[0].get_ydata().tolist() for ax in axes] == [[i, i + 1.0, i + 2.0] for i in range(5)]
    assert len({ax.get_ylim() for ax in axes}) == 1 and axes[0].get_ylabel() == axes[4].get_ylabel() == "DSC"


def test_a_pair_is_a_table_with_its_numbers():
    table = np.array([[0.5, np.nan], [0.75, 1.0]])
    ax = pair_figure(table, ("a", ("0", "1")), ("b", ("x", "y")), "DSC", digits=2).axes[0]
    assert (ax.get_xlabel(), ax.get_ylabel()) == ("b", "a")
    assert {(t.get_position(), t.get_text()) for t in ax.texts} == {
        ((0, 0), "0.50"),
        ((0, 1), "0.75"),
        ((1, 1), "1.00"),
    }

"""The panel of distances counts and maps the distances of the nodes."""

import numpy as np
import pytest

from cranio_nb.evaluation import mesh_distances
from cranio_nb.mesh import INNER
from cranio_nb.teaching import widgets
from cranio_nb.teaching.widgets.evaluation import map_distances


def test_the_evaluation_line_counts_nodes(static, design, true):
    panel = widgets.distances(design, true).set(side="inner", limit_mm=0.4)
    distances = mesh_distances.surface_distance(design.surface(INNER).vertices, true.surface(INNER))
    assert f"{100 * (distances <= 0.4).mean():.0f} % of the nodes lie within 0.4 mm" in panel.view.line
    assert f"max {distances.max():.2f} mm" in panel.view.line


def test_the_map_of_distances_shows_the_distances_of_the_nodes(design, true):
    seen = map_distances(design, true, INNER)
    shown = seen.picture[np.isfinite(seen.picture)]
    assert 0 <= shown.min() and shown.max() <= seen.distances.max() + 1e-6
    assert np.median(shown) == pytest.approx(np.median(seen.distances), rel=0.3)

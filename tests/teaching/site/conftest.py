"""A small lesson, its panel and its page; a gap and a CT for panels of the course."""

import numpy as np
import pytest
from small_site import few_views, lesson

from cranio_nb.curves import GapEnds
from cranio_nb.teaching.site.lesson_page import lesson_page
from cranio_nb.teaching.site.needed_cells import shown_by
from cranio_nb.volume import Volume


@pytest.fixture(autouse=True)
def static(monkeypatch):
    monkeypatch.setenv("CRANIO_NB_MODE", "static")


@pytest.fixture(scope="session")
def small():
    """The lesson as it ran, without widgets; not to be changed."""
    with pytest.MonkeyPatch.context() as patched:
        patched.setenv("CRANIO_NB_MODE", "static")
        return lesson()


@pytest.fixture(scope="session")
def small_shown(small):
    """Its panel and its scene."""
    return tuple(shown_by(small.cells).values())


@pytest.fixture(scope="session")
def small_page(small):
    with pytest.MonkeyPatch.context() as patched:
        few_views(patched)
        return lesson_page(small, "../pictures/00_small")


@pytest.fixture(scope="session")
def ct(phantom):
    case = phantom()
    return Volume(case.hu, case.affine)


@pytest.fixture(scope="session")
def arch():
    """A gap of 100 px whose tangents rise by 30 degrees at both ends."""
    rise = np.radians(30)
    tangents = [[-np.sin(rise), np.cos(rise)], [-np.sin(rise), -np.cos(rise)]]
    return GapEnds(np.array([[120.0, 60.0], [120.0, 160.0]]), np.array(tangents))

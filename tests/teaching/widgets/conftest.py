"""Fixtures of the panels' tests: both modes, a case, a gap, a design and its truth."""

import numpy as np
import pytest

import cranio_nb as cn
from cranio_nb.curves import GapEnds
from cranio_nb.evaluation import against_truth


@pytest.fixture
def live(monkeypatch):
    monkeypatch.setenv("CRANIO_NB_MODE", "widget")
    return pytest.importorskip("anywidget")


@pytest.fixture
def static(monkeypatch):
    monkeypatch.setenv("CRANIO_NB_MODE", "static")


@pytest.fixture(scope="session")
def ct(phantom):
    case = phantom()
    return cn.Volume(case.hu, case.affine)


@pytest.fixture(scope="session")
def opening(openings):
    return openings()[0].sheet


@pytest.fixture(scope="session")
def arch():
    """A gap of 100 px whose tangents rise by 30 degrees at both ends."""
    rise = np.radians(30)
    tangents = [[-np.sin(rise), np.cos(rise)], [-np.sin(rise), -np.cos(rise)]]
    return GapEnds(np.array([[120.0, 60.0], [120.0, 160.0]]), np.array(tangents))


@pytest.fixture(scope="session")
def design(skull, openings):
    return cn.design(skull(), openings(), directions=1)


@pytest.fixture(scope="session")
def true(phantom, skull, openings):
    return against_truth.true_prosthesis(skull().with_voxels(phantom().implant), skull(), openings()[0].head_centre)

"""Where the tests find real scans, and how they say that there are none."""

import os
from pathlib import Path

import pytest


@pytest.fixture(scope="session")
def real_data() -> Path:
    """Folder of real scans, from CRANIO_NB_DATA; the test is skipped where it is not set."""
    folder = os.environ.get("CRANIO_NB_DATA")
    if not folder:
        pytest.skip("CRANIO_NB_DATA names no folder of real scans")
    return Path(folder)

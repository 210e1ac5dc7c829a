"""A picture with a description shows itself with it."""

import numpy as np
import pytest

from cranio_nb.drawing.described import described
from cranio_nb.errors import InputRefused


def test_a_described_picture_shows_its_words(monkeypatch):
    monkeypatch.setenv("CRANIO_NB_MODE", "static")
    twin = described(np.zeros((4, 6, 3), np.uint8), "A black box.", "black")
    data, metadata = twin._repr_mimebundle_()
    assert data["image/png"][:4] == b"\x89PNG" and metadata["image/png"]["alt"] == "A black box."
    with pytest.raises(InputRefused):
        described(b"", " ", "line")

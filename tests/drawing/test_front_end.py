"""The mode of pictures is what was asked for, and static without a front end."""

import pytest

from cranio_nb.drawing.front_end import mode
from cranio_nb.errors import InputRefused


@pytest.mark.parametrize(("asked", "found"), [("static", "static"), ("widget", "widget"), ("auto", "static")])
def test_the_mode_is_what_was_asked_and_static_without_a_front_end(monkeypatch, asked, found):
    monkeypatch.setenv("CRANIO_NB_MODE", asked)
    assert mode() == found


def test_an_unknown_mode_is_refused(monkeypatch):
    monkeypatch.setenv("CRANIO_NB_MODE", "movie")
    with pytest.raises(InputRefused, match="static, widget, auto"):
        mode()

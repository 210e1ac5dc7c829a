"""What the pages share: pictures as text, numbers for reading, templates that escape."""

import base64

import pytest
from jinja2 import UndefinedError

from cranio_nb.drawing import figures
from cranio_nb.output import pages
from cranio_nb.vault.opening_size import measure_opening


@pytest.mark.parametrize(("value", "text"), [(None, "-"), (3, "3"), (2.5, "2.50"), (True, "True"), ("x", "x")])
def test_numbers_read_well(value, text):
    assert pages.number(value) == text


def test_a_shot_is_the_figure_with_its_words():
    figure, _ = figures.new_figure(2.0, 1.0)
    made = pages.shot(figure, alt="Nothing.", caption="Empty")
    assert base64.b64decode(made.data) == figures.png(figure)
    assert (made.alt, made.caption, made.width) == ("Nothing.", "Empty", 2 * figures.DPI)


def test_a_template_that_lacks_a_value_fails():
    with pytest.raises(UndefinedError):
        pages.page_template("design_page.html").render()


def test_views_show_the_skull_below_its_openings(openings):
    found = openings()
    sizes = [measure_opening(one) for one in found]
    height = pages.lowest_shown(sizes, found[0])
    assert height < min(one.lowest for one in sizes) and height < found[0].head_centre[2]

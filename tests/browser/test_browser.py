"""What a student sees: JupyterLab with the lessons, sliders that move pictures, a balloon that plays, a live scene."""

import io
import json
import time

import numpy as np
import pytest
from PIL import Image


def shot(locator):
    return np.asarray(Image.open(io.BytesIO(locator.screenshot())).convert("RGB")).astype(int)


def until(condition, timeout=20.0):
    """Wait for a condition; how long it took, or None."""
    start = time.monotonic()
    while time.monotonic() - start < timeout:
        if condition():
            return time.monotonic() - start
        time.sleep(0.02)
    return None


def panel(page, slider):
    """The panel that holds a slider of this name."""
    return page.locator(".cranio-panel", has=page.get_by_role("slider", name=slider, exact=True)).first


ACTIVE = "document.activeElement.className"


def press(box, slider, key):
    handle = box.get_by_role("slider", name=slider, exact=True)
    before = handle.input_value()
    for _ in range(3):  # a scene that has just loaded may take the focus away once
        handle.focus()
        box.page.keyboard.press(key)
        if until(lambda: handle.input_value() != before, 2):
            return
    raise AssertionError(f"{slider} does not move; the focus is on {box.page.evaluate(ACTIVE)}")


def no_errors(page):
    return page.locator(".jp-RenderedText[data-mime-type='application/vnd.jupyter.error']").all_inner_texts()


def drag_by_finger(element, by):
    """Drag from the middle of an element by (right, down) px.

    A finger, for its drags turn a scene at any speed: vtk.js takes a move of the mouse more than 0.2 s after the last
    one for the first of a new movement, which turns nothing, and a picture of the scene without a graphics card takes
    longer than that.
    """
    page, place = element.page, element.bounding_box()
    start = {"x": place["x"] + place["width"] / 2, "y": place["y"] + place["height"] / 2}
    browser = page.context.new_cdp_session(page)
    end = {"x": start["x"] + by[0], "y": start["y"] + by[1]}
    for kind, points in (("touchStart", [start]), ("touchMove", [end]), ("touchEnd", [])):
        browser.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": points})
    browser.detach()


REACH, PRESSURE = "reach: fitted after that (mm)", "k: pressure outwards (px per index\N{SUPERSCRIPT TWO})"


def test_sliders_move_pictures_the_balloon_plays_and_the_scene_is_there(small):
    page = small
    assert no_errors(page) == []

    for slider in (REACH, PRESSURE):
        box = panel(page, slider)
        image, status = box.locator("img").first, box.locator("[role=status]").first
        source, words, before = image.get_attribute("src"), status.inner_text(), shot(image)
        press(box, slider, "PageUp")
        assert until(lambda i=image, s=source: i.get_attribute("src") != s), slider
        assert until(lambda t=status, w=words: t.inner_text() != w), slider
        assert np.abs(shot(image) - before).max() > 60, slider

    box = panel(page, PRESSURE)
    status = box.locator("[role=status]").first
    press(box, "step", "End")
    press(box, "step", "Home")
    assert until(lambda: status.inner_text().startswith("Step 0 of ")), status.inner_text()
    still = shot(box.locator("img").first)
    box.get_by_role("combobox", name="pace").select_option("20 steps a second")
    box.get_by_role("button", name="play", exact=True).click()
    assert until(lambda: int(status.inner_text().split()[1]) >= 12), status.inner_text()
    box.get_by_role("button", name="pause", exact=True).click()
    assert np.abs(shot(box.locator("img").first) - still).max() > 60

    frame = page.locator("iframe.pyvista, iframe[srcdoc]").first
    assert frame.get_attribute("title") == "A skull with a hole."
    frame.scroll_into_view_if_needed()
    assert until(lambda: bone_share(frame) > 0.1, 40), "the scene shows no skull"
    before = shot(frame)
    drag_by_finger(frame, (120, 20))
    assert until(lambda: (np.abs(shot(frame) - before).max(axis=2) > 20).mean() > 0.02), "the scene does not turn"
    assert no_errors(page) == [] and page.complaints == []


def test_a_panel_fits_a_laptop_and_obeys_mouse_keys_and_typing(small):
    page = small
    page.set_viewport_size({"width": 1366, "height": 768})
    box = panel(page, PRESSURE)
    box.evaluate("e => e.scrollIntoView({block: 'start'})")
    picture, place = box.locator("img").bounding_box(), box.bounding_box()
    view = page.locator(".jp-WindowedPanel-outer").first.bounding_box()
    assert (picture["width"], picture["height"]) == (660, 540) and place["height"] <= view["height"]
    assert box.locator(".controls").bounding_box()["x"] >= picture["x"] + picture["width"]

    # each control has a name, and shows that it has the focus
    named = "(a) => a.map((e) => e.ariaLabel || e.labels?.[0]?.innerText || e.innerText || '')"
    assert all(box.locator("input, select, button, summary").evaluate_all(named))
    handle, status = box.get_by_role("slider", name=PRESSURE, exact=True), box.locator("[role=status]")
    handle.focus()
    page.keyboard.press("End")
    assert handle.evaluate("e => getComputedStyle(e).outlineStyle") == "solid"
    assert until(lambda: "k = 0.4," in status.inner_text()), status.inner_text()
    for key in ("ArrowLeft", "ArrowDown", "ArrowLeft", "ArrowRight"):  # which move through the cells elsewhere
        page.keyboard.press(key)
    assert until(lambda: "k = 0.396," in status.inner_text()), status.inner_text()
    box.get_by_role("textbox", name=PRESSURE).fill("0.0999")
    page.keyboard.press("Enter")
    assert until(lambda: "k = 0.1," in status.inner_text()), status.inner_text()
    box.get_by_role("button", name="k = -0.062").click()
    assert until(lambda: "k = -0.062," in status.inner_text()), status.inner_text()
    place = handle.bounding_box()
    page.mouse.click(place["x"] + place["width"] - 8, place["y"] + place["height"] / 2)
    assert until(lambda: "k = 0.4," in status.inner_text()), status.inner_text()


def bone_share(frame):
    """Share of the pixels that have the colour of bone: warm, neither white nor grey."""
    red, _, blue = np.moveaxis(shot(frame), 2, 0)
    return float(((red - blue > 6) & (red > 60)).mean())


@pytest.mark.parametrize("lesson", ["00_tour", "03_feature_extraction", "04_deformable_model"])
def test_a_lesson_runs_from_top_to_bottom(open_notebook, lab_server, lesson):
    if not (lab_server[1] / f"{lesson}.ipynb").is_file():
        pytest.skip(f"{lesson} is not built")
    page = open_notebook(f"{lesson}.ipynb")
    declared = page.locator(".jp-RenderedText[data-mime-type='application/vnd.jupyter.error']").count()
    wanted = sum("raises-exception" in cell["metadata"].get("tags", []) for cell in cells_of(lab_server[1], lesson))
    assert declared <= wanted, no_errors(page)
    assert page.locator(".jp-OutputArea-output img").count() > 0 and page.locator(".cranio-panel").count() > 0
    assert page.complaints == []


def cells_of(folder, lesson):
    return json.loads((folder / f"{lesson}.ipynb").read_text())["cells"]


def test_a_students_copy_shows_its_expected_picture_and_complains_of_nothing(chromium, lab_server):
    address, folder = lab_server
    name = "exercises/02_segmentation.ipynb"
    if not (folder / name).is_file():
        pytest.skip(f"{name} is not built")
    page = chromium.new_page(viewport={"width": 1366, "height": 5000})
    complaints = []
    page.on("console", lambda said: complaints.append(said.text) if said.type == "error" else None)
    page.goto(f"{address}/lab/workspaces/copy/tree/{name}?reset")
    folded = page.locator("details", has_text="Expected picture")
    folded.locator("summary").click(timeout=60_000)
    assert folded.locator("img").evaluate("image => image.decode().then(() => image.naturalWidth)") > 100
    page.close()
    assert complaints == []

"""Fixtures: a browser, a lab with copies of the lessons, and notebooks open and run in it."""

import os
import shutil
from pathlib import Path

import pytest
from browser_lab import ARGS, browser_path, run_all, running_lab, write_notebook

LESSONS = Path(__file__).parents[2] / "notebooks"
CELLS = (
    """
import cranio_nb as cn
from cranio_nb.drawing import coarse_skull, scene3d
from cranio_nb.stages import feature_extraction
from cranio_nb.teaching import widgets
from data_synth import phantom_case
case = phantom_case("tiny")
bone = cn.Volume(case.bone, case.affine)
opening = cn.find_openings(bone)[0]
plane = sum(opening.planes) // 2
""",
    "widgets.features(bone, plane, opening=opening.sheet)",
    """
seen = feature_extraction.extract_features(bone.voxels[plane])
ends, _ = feature_extraction.find_gap_ends(seen, opening.sheet.voxels[plane], skip_px=3, reach_px=8)
widgets.balloon(ends, bone.to_voxel(opening.head_centre)[1:], background=bone.voxels[plane])
""",
    """
skull = coarse_skull.skull_surface(bone)
scene3d.show_meshes(skull, colours=["#EDE7D8"], alt="A skull with a hole.", towards=opening.direction)
""",
)


@pytest.fixture(scope="module")
def chromium():
    """A headless Chromium; the test is skipped where playwright or the browser is missing.

    Its driver keeps an event loop running in this thread, so it ends with the module: other tests run their own.
    """
    driver = pytest.importorskip("playwright.sync_api", reason="playwright drives the browser tests")
    pytest.importorskip("jupyterlab", reason="the browser tests open JupyterLab")
    if browser_path() is None:
        pytest.skip("no Chromium on this machine (Debian: apt install chromium)")
    with driver.sync_playwright() as play:
        browser = play.chromium.launch(executable_path=browser_path(), headless=True, args=list(ARGS))
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def lab_server(tmp_path_factory):
    """Address and folder of a lab whose lessons are copies, live."""
    folder = tmp_path_factory.mktemp("lab") / "notebooks"
    shutil.copytree(LESSONS, folder) if LESSONS.is_dir() else folder.mkdir()
    with running_lab(folder, tmp_path_factory.mktemp("home")) as address:
        yield address, folder


def opened(browser, address, name, timeout=240):
    """A page with the notebook open and all its cells run; `page.complaints` is what its console complained of."""
    page = browser.new_page(viewport={"width": 1500, "height": 5000})
    page.complaints = []
    page.on("console", lambda said: page.complaints.append(said.text) if said.type == "error" else None)
    page.on("pageerror", lambda error: page.complaints.append(str(error)))
    page.on("response", lambda got: page.complaints.append(f"{got.status} {got.url}") if got.status >= 400 else None)
    run_all(page, address, name, timeout)
    shots = os.environ.get("CRANIO_NB_SCREENSHOTS")
    if shots:
        Path(shots).mkdir(parents=True, exist_ok=True)
        page.screenshot(path=str(Path(shots) / f"{Path(name).stem}.png"))
    return page


@pytest.fixture
def open_notebook(chromium, lab_server):
    """`open_notebook(name)`: a page as `opened` makes it."""
    pages = []

    def open_one(name):
        pages.append(opened(chromium, lab_server[0], name))
        return pages[-1]

    yield open_one
    for page in pages:
        page.close()


@pytest.fixture(scope="module")
def small(chromium, lab_server):
    """A page with panels and a scene of a tiny head, run once for several tests."""
    write_notebook(lab_server[1] / "small.ipynb", CELLS)
    page = opened(chromium, lab_server[0], "small.ipynb")
    yield page
    page.close()

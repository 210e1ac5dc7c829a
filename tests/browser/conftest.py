"""Fixtures: a browser, a lab with copies of the lessons, and notebooks open and run in it."""

import os
import shutil
from pathlib import Path

import pytest
from browser_lab import ARGS, browser_path, run_all, running_lab

LESSONS = Path(__file__).parents[2] / "notebooks"


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


@pytest.fixture
def open_notebook(chromium, lab_server):
    """`open_notebook(name)`: a page with the notebook open and all its cells run, and what its console complains of."""
    pages = []

    def opened(name, timeout=240):
        page = chromium.new_page(viewport={"width": 1500, "height": 5000})
        pages.append(page)
        page.complaints = []
        page.on("console", lambda said: page.complaints.append(said.text) if said.type == "error" else None)
        page.on("pageerror", lambda error: page.complaints.append(str(error)))
        page.on(
            "response", lambda got: page.complaints.append(f"{got.status} {got.url}") if got.status >= 400 else None
        )
        run_all(page, lab_server[0], name, timeout)
        shots = os.environ.get("CRANIO_NB_SCREENSHOTS")
        if shots:
            Path(shots).mkdir(parents=True, exist_ok=True)
            page.screenshot(path=str(Path(shots) / f"{Path(name).stem}.png"))
        return page

    yield opened
    for page in pages:
        page.close()

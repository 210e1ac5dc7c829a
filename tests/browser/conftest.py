"""A JupyterLab as `cranio-nb lab` starts it, and a real browser before it."""

import contextlib
import os
import shutil
import socket
import subprocess
import time
import urllib.request
from pathlib import Path

import pytest

from cranio_nb import lab

ARGS = ("--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-sync")
ARGS += ("--disable-component-update", "--enable-unsafe-swiftshader")
LESSONS = Path(lab.__file__).parents[1] / "notebooks"


@pytest.fixture(scope="session")
def chromium():
    """A headless Chromium; the test is skipped where playwright or the browser is missing."""
    driver = pytest.importorskip("playwright.sync_api", reason="playwright drives the browser tests")
    pytest.importorskip("jupyterlab", reason="the browser tests open JupyterLab")
    found = [path for name in ("chromium", "chromium-browser", "google-chrome") if (path := shutil.which(name))]
    if not found:
        pytest.skip("no Chromium on this machine (Debian: apt install chromium)")
    with driver.sync_playwright() as play:
        browser = play.chromium.launch(executable_path=found[0], headless=True, args=list(ARGS))
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def lab_server(tmp_path_factory):
    """Address and folder of a lab whose lessons are copies, live."""
    folder = tmp_path_factory.mktemp("lab") / "notebooks"
    shutil.copytree(LESSONS, folder) if LESSONS.is_dir() else folder.mkdir()
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = lab.lab_command(folder, browser=False, port=port)
    command += ["--IdentityProvider.token=", "--ServerApp.ip=127.0.0.1", "--allow-root"]
    place = {k: v for k, v in lab.lab_environment().items() if k != "CRANIO_NB_MODE"}
    home = tmp_path_factory.mktemp("home")
    place |= {"JUPYTER_CONFIG_DIR": str(home / "config"), "JUPYTERLAB_WORKSPACES_DIR": str(home / "work")}
    place |= {"JUPYTERLAB_SETTINGS_DIR": str(home / "settings"), "JUPYTER_RUNTIME_DIR": str(home / "run")}
    with open(home / "log.txt", "w") as log, subprocess.Popen(command, env=place, stdout=log, stderr=log) as server:
        _wait_for(f"http://127.0.0.1:{port}/api", home / "log.txt")
        yield f"http://127.0.0.1:{port}", folder
        server.terminate()
        server.wait(20)


def _wait_for(address, log):
    end = time.monotonic() + 60
    while time.monotonic() < end:
        with contextlib.suppress(OSError), urllib.request.urlopen(address, timeout=2):
            return
        time.sleep(0.2)
    raise AssertionError(f"JupyterLab did not start:\n{log.read_text()[-2000:]}")


@pytest.fixture
def open_notebook(chromium, lab_server):
    """`open_notebook(name)`: a page with the notebook open and all its cells run."""
    pages = []

    def opened(name, timeout=240):
        page = chromium.new_page(viewport={"width": 1500, "height": 5000})
        pages.append(page)
        page.goto(f"{lab_server[0]}/lab/workspaces/{Path(name).stem}/tree/{name}?reset")
        page.wait_for_selector(".jp-Notebook .jp-Cell", timeout=60_000)
        page.wait_for_selector("#jp-bottom-panel :text('Idle')", timeout=60_000)  # else it asks which kernel to use
        page.get_by_role("menuitem", name="Run", exact=True).click()
        page.get_by_text("Run All Cells", exact=True).click()
        _wait_until_run(page, timeout)
        shots = os.environ.get("CRANIO_NB_SCREENSHOTS")
        if shots:
            Path(shots).mkdir(parents=True, exist_ok=True)
            page.screenshot(path=str(Path(shots) / f"{Path(name).stem}.png"))
        return page

    yield opened
    for page in pages:
        page.close()


def _wait_until_run(page, timeout):
    """Wait until no cell waits or runs any more."""
    end = time.monotonic() + timeout
    calm = 0
    while calm < 4:
        prompts = page.locator(".jp-CodeCell .jp-InputPrompt").all_inner_texts()
        busy = any("*" in prompt for prompt in prompts)
        idle = page.locator("#jp-bottom-panel :text('Idle')").count() > 0
        calm = calm + 1 if idle and not busy else 0
        assert time.monotonic() < end, f"still running after {timeout} s: {prompts}"
        time.sleep(0.3)

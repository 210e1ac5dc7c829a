"""A JupyterLab as `cranio-nb lab` starts it, and a real browser before it; for the browser tests and the benchmarks."""

import contextlib
import json
import shutil
import socket
import subprocess
import time
import urllib.request

from cranio_nb.teaching.lab import start

ARGS = ("--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-sync")
ARGS += ("--disable-component-update", "--enable-unsafe-swiftshader")
BROWSERS = ("chromium", "chromium-browser", "google-chrome")


def browser_path():
    """Where Chromium is on this machine, or None."""
    return next((path for name in BROWSERS if (path := shutil.which(name))), None)


@contextlib.contextmanager
def running_lab(folder, home):
    """Address of a lab that shows a folder, live; its own settings and log go into `home`."""
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    command = start.lab_command(folder, browser=False, port=port)
    command += ["--IdentityProvider.token=", "--ServerApp.ip=127.0.0.1", "--allow-root"]
    place = {k: v for k, v in start.lab_environment().items() if k != "CRANIO_NB_MODE"}
    place |= {"JUPYTER_CONFIG_DIR": str(home / "config"), "JUPYTERLAB_WORKSPACES_DIR": str(home / "work")}
    place |= {"JUPYTERLAB_SETTINGS_DIR": str(home / "settings"), "JUPYTER_RUNTIME_DIR": str(home / "run")}
    with open(home / "log.txt", "w") as log, subprocess.Popen(command, env=place, stdout=log, stderr=log) as server:
        try:
            _wait_for(f"http://127.0.0.1:{port}/api", home / "log.txt")
            yield f"http://127.0.0.1:{port}"
        finally:
            server.terminate()
            server.wait(20)


def run_all(page, address, name, timeout=240):
    """Open a notebook and run all its cells, as a student would from the menu."""
    page.goto(f"{address}/lab/workspaces/{name.removesuffix('.ipynb')}/tree/{name}?reset")
    page.wait_for_selector(".jp-Notebook .jp-Cell", timeout=60_000)
    page.wait_for_selector("#jp-bottom-panel :text('Idle')", timeout=60_000)  # else it asks which kernel to use
    page.get_by_role("menuitem", name="Run", exact=True).click()
    page.get_by_text("Run All Cells", exact=True).click()
    _wait_until_run(page, timeout)


def write_notebook(path, cells):
    """A notebook of code cells without outputs."""
    empty = {"cell_type": "code", "metadata": {}, "outputs": [], "execution_count": None}
    blocks = [empty | {"id": f"c{i}", "source": text.strip()} for i, text in enumerate(cells)]
    kernel = {"kernelspec": {"display_name": "Python 3 (ipykernel)", "language": "python", "name": "python3"}}
    path.write_text(json.dumps({"cells": blocks, "metadata": kernel, "nbformat": 4, "nbformat_minor": 5}))


def _wait_for(address, log):
    end = time.monotonic() + 60
    while time.monotonic() < end:
        with contextlib.suppress(OSError), urllib.request.urlopen(address, timeout=2):
            return
        time.sleep(0.2)
    raise AssertionError(f"JupyterLab did not start:\n{log.read_text()[-2000:]}")


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

"""A lab that runs: it answers to this machine's own pages and to those who hold its key, and leaves nothing behind."""

import json
import os
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request

import pytest

from cranio_nb.teaching.lab import start

pytest.importorskip("jupyterlab")
pytestmark = pytest.mark.skipif(sys.platform == "win32", reason="Windows has no SIGTERM to send")
RUN = "from cranio_nb.cli.main import main; main()"


def ask(url, *, data=None, **headers):
    """Status and body of an answer."""
    try:
        with urllib.request.urlopen(urllib.request.Request(url, data, headers), timeout=20) as answer:
            return answer.status, answer.read()
    except urllib.error.HTTPError as error:
        return error.code, error.read()


def wait_for(what, seconds=60):
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        found = what()
        if found:
            return found
        time.sleep(0.1)
    raise AssertionError(f"still waiting after {seconds} s")


def is_running(pid):
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rsplit(")", 1)[1].split()[0] != "Z"
    except OSError:
        return False


def of_server(home, port):
    """What the server wrote of itself, when it answers."""
    for path in (home / "run").glob("jpserver-*.json"):
        about = json.loads(path.read_text() or "{}")
        try:
            if about and ask(f"http://127.0.0.1:{port}/api")[0] == 200:
                return about
        except OSError:
            return None
    return None


@pytest.fixture
def lab(tmp_path):
    """A lab as a user starts it: process, port, and what its server says of itself."""
    (tmp_path / "notebooks").mkdir()
    (tmp_path / "notebooks" / start.TOUR).write_text("{}")
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    place = os.environ | {"JUPYTER_RUNTIME_DIR": str(tmp_path / "run"), "JUPYTER_CONFIG_DIR": str(tmp_path / "config")}
    place |= {
        "JUPYTERLAB_WORKSPACES_DIR": str(tmp_path / "work"),
        "JUPYTERLAB_SETTINGS_DIR": str(tmp_path / "settings"),
    }
    place.pop("JUPYTER_TOKEN", None)
    command = [sys.executable, "-c", RUN, "lab", str(tmp_path / "notebooks"), "--no-browser", "--allow-root"]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    with subprocess.Popen([*command, "--port", str(port)], env=place, **quiet) as process:
        try:
            yield process, port, wait_for(lambda: of_server(tmp_path, port))
        finally:
            process.terminate()
            process.wait(30)


def test_it_answers_to_its_own_pages_and_leaves_nothing_behind(lab):
    process, port, about = lab
    url, token = f"http://127.0.0.1:{port}", about["token"]
    key = {"Authorization": f"token {token}"}
    assert about["hostname"] == "127.0.0.1" and len(token) >= 32 and not token.isdigit()

    # no key, another host, another origin
    assert ask(f"{url}/api/contents")[0] == 403
    assert ask(f"{url}/api/contents", Authorization="token wslink-secret")[0] == 403
    assert ask(f"{url}/api/contents", Host="elsewhere.example", **key)[0] == 403
    assert ask(f"{url}/api/contents", **key)[0] == 200
    foreign = {"Origin": f"http:{chr(47) * 2}elsewhere.example"}
    assert ask(f"{url}/api/kernels", data=b"{}", **foreign)[0] in (403, 404)
    status, body = ask(f"{url}/api/kernels", data=b"{}", **key)
    assert status == 201
    socket_of = f"{url}/api/kernels/{json.loads(body)['id']}/channels"
    upgrade = {"Upgrade": "websocket", "Connection": "Upgrade", "Sec-WebSocket-Version": "13"}
    upgrade |= {"Sec-WebSocket-Key": "dGhlIHNhbXBsZSBub25jZQ=="}
    assert ask(socket_of, **upgrade, **foreign)[0] == 403
    assert ask(socket_of, **upgrade, Origin=url)[0] == 403

    # ended by a signal, with all that it started
    kernels = wait_for(lambda: children_of(about["pid"]))
    process.send_signal(signal.SIGTERM)
    assert process.wait(30) == 0
    wait_for(lambda: not any(map(is_running, [about["pid"], *kernels])), 15)


def children_of(pid):
    """Numbers of the processes that a process started."""
    done = subprocess.run(["ps", "-o", "pid=", "--ppid", str(pid)], capture_output=True, text=True)
    return [int(word) for word in done.stdout.split()]


def test_ctrl_c_ends_it_too(lab):
    process, _, about = lab
    process.send_signal(signal.SIGINT)
    assert process.wait(30) == 0
    wait_for(lambda: not is_running(about["pid"]), 15)

"""The live scene answers to its own page only: five probes of a running scene, and the headers of its answers."""

import asyncio
import os
import socket
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path
from types import SimpleNamespace

import pytest

from cranio_nb.drawing import local_server
from cranio_nb.drawing.local_server import HEADERS, MAX_MESSAGE, MAX_SOCKETS, is_local_request

SCENE = """
import asyncio, os, sys
os.environ["CRANIO_NB_MODE"] = "widget"
import numpy as np
from cranio_nb.drawing import local_server, scene3d
from cranio_nb.mesh import Mesh

square = Mesh(np.array([[0.0, 0, 0], [9, 0, 0], [0, 0, 9], [9, 0, 9]]), np.array([[0, 1, 2], [1, 3, 2]]))

async def kernel():
    scenes = [scene3d.show_meshes(square, alt="A square.") for _ in range(2)]
    print(*(scene.viewer.src for scene in scenes), flush=True)
    local_server.running_server().state.patient_name = "CANARY"
    await asyncio.get_running_loop().run_in_executor(None, sys.stdin.read)  # until the test ends
    print(local_server.running_server().state.patient_name, flush=True)
    os._exit(0)

asyncio.run(kernel())
"""


@pytest.fixture(scope="module")
def running():
    """Process, port and key of a scene in a process of its own, whose loop runs as a kernel's does."""
    pytest.importorskip("trame_pyvista")
    pytest.importorskip("ipywidgets")
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", SCENE], text=True, **pipes) as kernel:
        first, second = kernel.stdout.readline().split()
        address, _, key = first.partition("&secret=")
        assert second.endswith(f"&secret={key}") and address.startswith("http://localhost:")
        yield kernel.pid, int(address.split(":")[2].split("/")[0]), key
        kernel.stdin.close()
        assert kernel.stdout.readline().strip() == "CANARY", "the state was changed"


@pytest.fixture
def scene(running):
    """Port and key."""
    return running[1:]


async def call(socket, method, *arguments, number=1):
    """Call a method of the server, by its own protocol."""
    msgpack, chunking = pytest.importorskip("msgpack"), pytest.importorskip("wslink.chunking")
    name = "system:c0:0" if method == "wslink.hello" else f"rpc:c0:{number}"
    message = {"wslink": "1.0", "id": name, "method": method, "args": list(arguments), "kwargs": {}}
    for chunk in chunking.generate_chunks(msgpack.packb(message), 500):
        await socket.send_bytes(chunk)
    back = chunking.UnChunker()
    back.set_max_message_size(10**8)
    while True:
        found = back.process_chunk(await asyncio.wait_for(socket.receive_bytes(), 20))
        if found is not None and found.get("id") == name:
            return found


async def _login(port, host, origin, key):
    """Status of the page, and what a socket gets: a status, or the answers to hello and to a look at the state."""
    aiohttp = pytest.importorskip("aiohttp")
    headers = {"Host": host.format(port)} | ({"Origin": origin.format(port)} if origin else {})
    base = f"127.0.0.1:{port}"
    async with aiohttp.ClientSession() as session:
        async with session.get("http:" + f"//{base}/index.html", headers=headers) as page:
            status = page.status
        try:
            async with session.ws_connect(f"ws://{base}/ws", headers=headers) as socket:
                hello = await call(socket, "wslink.hello", {"secret": key})
                state = await call(socket, "trame.state.get")
                return status, hello, state
        except aiohttp.WSServerHandshakeError as error:
            return status, error.status, None


def login(*arguments):
    return asyncio.run(_login(*arguments))


HERE, LOCAL, FAR = "127.0.0.1:{}", "http://127.0.0.1:{}", f"http:{chr(47) * 2}elsewhere.example"
PROBES = {
    "foreign host, foreign origin, default key": ("elsewhere.example", FAR, False),
    "local host, foreign origin, default key": (HERE, FAR, False),
    "foreign host, foreign origin, right key": ("elsewhere.example", FAR, True),
    "local host, foreign origin, right key": (HERE, FAR, True),
    "host of another name for this machine, right key": ("elsewhere.example:{}", LOCAL, True),
    "origin of another port, right key": (HERE, "http://127.0.0.1:8888", True),
    "origin of a page without one, right key": (HERE, "null", True),
}


@pytest.mark.parametrize("probe", PROBES)
def test_another_page_gets_neither_page_nor_socket(probe, scene):
    port, key = scene
    host, origin, right = PROBES[probe]
    assert login(port, host, origin, key if right else "wslink-secret") == (403, 403, None)


def test_a_socket_without_an_origin_is_refused(scene):
    port, key = scene
    assert login(port, HERE, None, key) == (200, 403, None)


@pytest.mark.parametrize("wrong", ["wslink-secret", "", None, 1])
def test_the_own_page_without_the_key_reads_nothing(wrong, scene):
    status, hello, state = login(scene[0], HERE, LOCAL, wrong)
    assert status == 200 and hello["error"]["message"] == "Authentication failed"
    assert "Unauthorized" in state["error"]["message"] and "CANARY" not in str(state)


@pytest.mark.parametrize("name", ["127.0.0.1", "localhost"])
def test_the_own_page_with_the_key_works(name, scene):
    port, key = scene
    status, hello, state = login(port, f"{name}:{{}}", "http:" + f"//{name}:{{}}", key)
    assert status == 200 and "clientID" in hello["result"]
    assert "CANARY" in str(state["result"])


def test_the_key_is_random_and_no_number(scene):
    _, key = scene
    assert len(key) >= 43 and key != "wslink-secret" and key.startswith("k")


def test_it_listens_on_the_loopback_address_only(scene):
    text = subprocess.run(["cat", "/proc/net/tcp", "/proc/net/tcp6"], capture_output=True, text=True).stdout
    if not text:
        pytest.skip("the system does not list its sockets")
    port = f":{scene[0]:04X}"
    listening = [
        line.split()[1] for line in text.splitlines() if line.split()[1].endswith(port) and line.split()[3] == "0A"
    ]
    assert listening == [f"0100007F{port}"]


def test_every_answer_is_marked(scene):
    async def answers():
        aiohttp = pytest.importorskip("aiohttp")
        found = []
        async with aiohttp.ClientSession() as session:
            for path in ("/index.html", "/", "/none"):
                async with session.get(f"http://127.0.0.1:{scene[0]}{path}", allow_redirects=False) as answer:
                    found.append((answer.status, {name: answer.headers.get(name) for name in HEADERS}))
        return found

    assert asyncio.run(answers()) == [(200, HEADERS), (302, HEADERS), (404, HEADERS)]


@pytest.mark.parametrize(
    ("hosts", "origins", "socket"),
    [
        ([], [], False),
        (["localhost"], [], False),
        (["localhost:1", "localhost:1"], [], False),
        (["localhost:1.elsewhere.example"], [], False),
        (["localhost:1"], ["http://localhost:1"] * 2, False),
        (["localhost:1"], ["https://localhost:1"], True),
        (["localhost:1"], [""], True),
    ],
)
def test_odd_headers_are_refused(hosts, origins, socket):
    assert not is_local_request(hosts, origins, 1, socket=socket)
    assert is_local_request(["localhost:1"], [], 1, socket=False)


def works(port, key):
    """Whether the user's own page is answered."""
    status, hello, state = login(port, HERE, LOCAL, key)
    return status == 200 and "clientID" in hello["result"] and "CANARY" in str(state["result"])


def memory_mb(pid):
    """Resident memory of a process at its highest."""
    status = Path(f"/proc/{pid}/status")
    if not status.exists():
        pytest.skip("the system does not tell the memory of a process")
    return int(status.read_text().split("VmHWM:")[1].split()[0]) / 1000


def test_many_connections_neither_stop_it_nor_stay(running):
    """With CRANIO_NB_CONNECTIONS=5000 as many as the acceptance asks for."""
    pid, port, key = running
    before = memory_mb(pid)
    with ExitStack() as stack:
        for _ in range(int(os.environ.get("CRANIO_NB_CONNECTIONS", "200"))):
            stack.enter_context(socket.create_connection(("127.0.0.1", port)))
        assert works(port, key)
    assert works(port, key)
    assert memory_mb(pid) - before < 200


def ours(port):
    """Headers of the own page."""
    return {"Host": HERE.format(port), "Origin": LOCAL.format(port)}


def test_sockets_are_so_many_at_one_time(running):
    aiohttp = pytest.importorskip("aiohttp")
    _, port, key = running

    async def fill():
        url = f"ws://127.0.0.1:{port}/ws"
        async with aiohttp.ClientSession(connector=aiohttp.TCPConnector(limit=0)) as session:
            held = [await session.ws_connect(url, headers=ours(port)) for _ in range(MAX_SOCKETS)]
            with pytest.raises(aiohttp.WSServerHandshakeError) as refused:
                await session.ws_connect(url, headers=ours(port))
            assert refused.value.status == 503
            await held[0].close()
            await (await session.ws_connect(url, headers=ours(port))).close()
            await asyncio.gather(*(one.close() for one in held))

    asyncio.run(fill())
    assert works(port, key)


def begun(number, size):
    """The start of a message of so many bytes."""
    return number.to_bytes(4, "little") + bytes(4) + size.to_bytes(4, "little") + b"x"


FRAMES = {
    "10 MB of text": ("text", ["a" * 10_000_000]),
    "text": ("text", ["{}"]),
    "10 MB of bytes": ("bytes", [bytes(10_000_000)]),
    "a message of 1.6 GB, begun": ("bytes", [begun(1, 1_600_000_000)]),
    "a message over the limit, begun": ("bytes", [begun(1, MAX_MESSAGE + 1)]),
    "many messages, begun": ("bytes", [begun(i, 400) for i in range(5000)]),
}


@pytest.mark.parametrize("secret", [False, True], ids=["without the key", "with the key"])
@pytest.mark.parametrize("name", FRAMES)
def test_frames_that_are_too_large_close_their_socket(name, secret, running):
    aiohttp = pytest.importorskip("aiohttp")
    pid, port, key = running
    kind, frames = FRAMES[name]
    before = memory_mb(pid)

    async def send():
        async with aiohttp.ClientSession() as session:
            async with session.ws_connect(f"ws://127.0.0.1:{port}/ws", headers=ours(port)) as page:
                if secret:
                    assert "clientID" in (await call(page, "wslink.hello", {"secret": key}))["result"]
                try:
                    for frame in frames:
                        await (page.send_str(frame) if kind == "text" else page.send_bytes(frame))
                except ConnectionError:
                    return None  # closed while it was sent
                while (got := await asyncio.wait_for(page.receive(), 20)).type is aiohttp.WSMsgType.BINARY:
                    pass
                return got.data

    assert asyncio.run(send()) in (1008, 1009, None)
    assert works(port, key)
    assert memory_mb(pid) - before < 150


@pytest.mark.parametrize("known", [False, True])
def test_who_does_not_show_the_key_in_time_is_closed(known, monkeypatch):
    """A stand-in for the sockets of a server, and no time to wait."""
    monkeypatch.setattr(local_server, "_SECONDS_TO_LOGIN", 0.0)
    closed = []

    class Page:
        async def close(self, code):
            closed.append(code)

    async def connected():
        async def nothing(*_):
            return None

        sockets = SimpleNamespace(onConnect=nothing, onMessage=nothing, connections={"c": Page()})
        sockets.authentified_client_ids = {"c"} if known else set()
        local_server._bound_messages(sockets)
        await sockets.onConnect(None, "c")
        await asyncio.gather(*(asyncio.all_tasks() - {asyncio.current_task()}))

    asyncio.run(connected())
    assert closed == ([] if known else [1008])

"""The server of the live scenes: for this machine's own browser only, and for those who hold its key.

A server of trame as it comes answers any page that is open in the same browser, and its key is the same everywhere.
This one listens on the loopback address, has a random key, and refuses what names another host or comes from another
origin. The key reaches the scene in the address of its frame, which the kernel alone knows. What a stranger on this
machine can make it hold is bounded: sockets, messages that were begun, and the time until the key is shown.
"""

from __future__ import annotations

import asyncio
import secrets
from collections.abc import Callable
from typing import Any

NAME = "cranio-nb"
"""Of the server; each kernel has one."""
HOST = "127.0.0.1"
"""Address it listens on."""
MAX_SOCKETS = 64
"""Open at one time: each scene in a notebook has one."""
MAX_MESSAGE = 2**24
"""Bytes of a message that may be begun; what a scene sends is far smaller."""
_MAX_BEGUN = 8  # messages of a socket that wait for their rest
_SECONDS_TO_LOGIN = 20.0
_TOO_BIG, _NOT_ALLOWED = 1009, 1008  # codes with which a socket is closed
_LOCAL = ("127.0.0.1", "localhost")
_SOCKET = "/ws"
_FRAMES = " ".join(f"{scheme}://{host}:*" for host in _LOCAL for scheme in ("http", "https"))
HEADERS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Content-Security-Policy": f"frame-ancestors {_FRAMES}",
}
"""Of every answer."""


def running_server() -> Any:
    """The server of this kernel, started where it is not running yet.

    Returns
    -------
    trame_server.core.Server
        With its key as ``server.options["key"]``.
    """
    from trame_pyvista.jupyter import elegantly_launch
    from trame_pyvista.widgets import get_server

    server = get_server(NAME)
    if not server.running:
        # a key that starts with a letter: the page takes what looks like a number for one
        server.options["key"] = f"k{secrets.token_urlsafe(32)}"
        server.cli.set_defaults(authKey=server.options["key"], authKeyFile=None, host=HOST)
        server.controller.on_server_bind.add(guard)
        elegantly_launch(server, host=HOST, port=0, wslink_backend="aiohttp")
    return server


def guard(bound: Any) -> None:
    """Check every request to a server, mark every answer, and bound what its sockets may take.

    Parameters
    ----------
    bound : wslink.backends.aiohttp.WebAppServer
        Before it listens.
    """
    bound.app.middlewares.append(_checked())
    bound.app.on_response_prepare.append(_mark)
    for sockets in bound._ws_handlers:
        _bound_messages(sockets)


def is_local_request(hosts: list[str], origins: list[str], port: int, *, socket: bool) -> bool:
    """Whether a request comes from this machine's browser and from a page of this server.

    Parameters
    ----------
    hosts, origins : list of str
        Values of the headers Host and Origin.
    port : int
        Of the server.
    socket : bool
        Whether a socket is asked for, for which a browser always names the origin.

    Returns
    -------
    bool

    Examples
    --------
    >>> is_local_request(["localhost:8080"], ["http://localhost:8080"], 8080, socket=True)
    True
    >>> is_local_request(["localhost:8080"], ["null"], 8080, socket=True)
    False
    """
    known = {f"{name}:{port}" for name in _LOCAL}
    if len(hosts) != 1 or hosts[0] not in known or len(origins) > 1:
        return False
    scheme, _, page = origins[0].partition("://") if origins else ("", "", "")
    return (scheme == "http" and page in known) if origins else not socket


def _checked() -> Callable[..., Any]:
    """What refuses a request that is not local, before anything else sees it."""
    from aiohttp import web

    sockets: set[int] = set()

    @web.middleware
    async def check(request: web.Request, handler: Callable[..., Any]) -> web.StreamResponse:
        hosts, origins = request.headers.getall("Host", []), request.headers.getall("Origin", [])
        port = request.transport.get_extra_info("sockname")[1] if request.transport else 0
        is_socket = request.path == _SOCKET
        if not is_local_request(hosts, origins, port, socket=is_socket):
            return web.Response(status=403, text="This scene answers to the notebook that it belongs to.")
        if not is_socket:
            return await handler(request)
        if len(sockets) >= MAX_SOCKETS:
            return web.Response(status=503, text="Too many scenes are open; close some.")
        sockets.add(id(request))
        try:
            return await handler(request)  # until the socket is closed
        finally:
            sockets.discard(id(request))

    return check


def _bound_messages(sockets: Any) -> None:
    """Close a socket that sends text or too large a message, begins too many, or does not show the key in time."""
    connect, take = sockets.onConnect, sockets.onMessage

    async def close(client: str, code: int) -> None:
        if client in sockets.connections:
            await sockets.connections[client].close(code=code)

    async def close_strangers(client: str) -> None:
        await asyncio.sleep(_SECONDS_TO_LOGIN)
        if client not in sockets.authentified_client_ids:
            await close(client, _NOT_ALLOWED)

    async def on_connect(request: Any, client: str) -> None:
        watch = asyncio.ensure_future(close_strangers(client))
        watches.add(watch)  # a task that nobody holds may be dropped
        watch.add_done_callback(watches.discard)
        await connect(request, client)

    async def on_message(is_binary: bool, message: Any, client: str) -> None:
        # a part of a message begins with its number, the part's place, and the size of the whole
        size = int.from_bytes(message.data[8:12], "little") if is_binary else 0
        begun = len(sockets.unchunkers[client].pending_messages)
        if not is_binary or size > MAX_MESSAGE or begun > _MAX_BEGUN:
            await close(client, _TOO_BIG if is_binary else _NOT_ALLOWED)
            return
        await take(is_binary, message, client)

    watches: set[asyncio.Future[None]] = set()
    sockets.onConnect, sockets.onMessage = on_connect, on_message


async def _mark(_: Any, response: Any) -> None:
    """Give an answer the `HEADERS`."""
    response.headers.update(HEADERS)

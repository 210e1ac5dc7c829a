"""Who draws the pictures of a page while the rest of a run goes on: a thread, or a process of its own for large scans.

The process costs a second of another processor before it draws; the thread shares one with the design.
"""

from __future__ import annotations

import pickle
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from dataclasses import replace
from io import BytesIO
from typing import IO, Any

from ..drawing import figures
from ..opening import Opening
from ..pipeline.preparation import Prepared
from ..prosthesis import Prosthesis
from .design_pictures import cropped, shape_shots, vault_of
from .pages import Shot, shot

_LARGE = 2**24  # voxels from which a process pays
_CUT_SHORT = (EOFError, pickle.UnpicklingError)
_PROGRAM = "from cranio_nb.output.painter import draw_for_parent; draw_for_parent()"

Shots = dict[str, list[Shot]]


class Painter:
    """Draws the pictures of a run that need no measures.

    Parameters
    ----------
    case : Prepared
        What is drawn before there is a prosthesis is drawn at once.
    """

    def __init__(self, case: Prepared) -> None:
        self._case = case
        self._thread = ThreadPoolExecutor(1)
        self._process = _start() if case.scan.voxels.size >= _LARGE else None
        self._vault = self._thread.submit(self._begin)

    def draw(self, made: Prosthesis) -> Future[Shots]:
        """Ask for the pictures of a prosthesis, once.

        Parameters
        ----------
        made : Prosthesis

        Returns
        -------
        Future of dict of str to list of Shot
            As of `design_pictures.shape_shots`.
        """
        return self._thread.submit(self._drawn, made)

    def close(self) -> None:
        """Take no more orders; what was ordered is drawn to its end, and nothing else goes on."""
        if self._process is not None:
            self._thread.submit(self._end, self._process)
        self._thread.shutdown(wait=False)

    def _begin(self) -> Any:
        if self._process is None:
            figures.new_figure(1.0, 1.0)  # loads matplotlib
            return vault_of(self._case)
        # without what is not drawn: a sheet of each opening that stays open is as large as the scan
        return self._tell(replace(self._case, left_open=(), truth=None))

    def _drawn(self, made: Prosthesis) -> Shots:
        if self._process is None:
            return shape_shots(self._case, self._vault.result(), made)
        if self._vault.result() and self._tell(cropped(made), self._case.openings):
            assert self._process.stdout is not None
            with suppress(*_CUT_SHORT):
                shots: Shots = pickle.load(self._process.stdout)
                return shots
        # it died, or was killed for want of memory: here it takes longer
        return shape_shots(self._case, vault_of(self._case), made)

    def _tell(self, what: Prepared | Prosthesis, known: Sequence[Opening] = ()) -> bool:
        """Send to the process; whether it was there."""
        assert self._process is not None and self._process.stdin is not None
        try:
            _send(self._process.stdin, what, known)
        except OSError:
            return False
        return True

    @staticmethod
    def _end(process: subprocess.Popen[bytes]) -> None:
        process.kill()  # what was ordered has come
        for stream in (process.stdin, process.stdout):
            assert stream is not None
            with suppress(OSError):  # it died before it read all
                stream.close()
        process.wait()


def _send(stream: IO[bytes], what: Any, known: Sequence[Opening]) -> None:
    """Write an object: its large arrays first, from where they lie, without a copy of them."""
    large: list[pickle.PickleBuffer] = []
    rest = BytesIO()
    _Sender(rest, known, large).dump(what)
    pickle.dump([part.raw().nbytes for part in large], stream)
    for part in large:
        stream.write(part.raw())
    stream.write(rest.getbuffer())
    stream.flush()


def _received(stream: IO[bytes], known: Sequence[Opening] = ()) -> Any:
    """What `_send` wrote."""
    large = [bytearray(n_bytes) for n_bytes in pickle.load(stream)]
    for part in large:
        if stream.readinto(part) < len(part):  # type: ignore[attr-defined]
            raise EOFError
    return _Receiver(stream, known, large).load()


class _Sender(pickle.Pickler):
    """Openings that the other process has are named by their index, so that there too they are the same ones."""

    def __init__(self, stream: IO[bytes], known: Sequence[Opening], large: list[pickle.PickleBuffer]) -> None:
        super().__init__(stream, pickle.HIGHEST_PROTOCOL, buffer_callback=large.append)
        self._index = {id(opening): index for index, opening in enumerate(known)}

    def persistent_id(self, what: Any) -> int | None:
        return self._index.get(id(what))


class _Receiver(pickle.Unpickler):
    def __init__(self, stream: IO[bytes], known: Sequence[Opening], large: Sequence[bytearray]) -> None:
        super().__init__(stream, buffers=large)
        self._known = known

    def persistent_load(self, index: int) -> Opening:
        return self._known[index]


def draw_for_parent() -> None:
    """In the process that draws: take the case and the prosthesis from standard input, and answer on standard output.

    It ends with the process that started it, whose end closes both.
    """
    shot(figures.colour_bar_figure(1.0, ""), alt="", caption="")  # loads what draws and packs
    try:
        case: Prepared = _received(sys.stdin.buffer)
        vault = vault_of(case)
        made: Prosthesis = _received(sys.stdin.buffer, case.openings)
    except _CUT_SHORT:
        return  # there is nothing to draw
    pickle.dump(shape_shots(case, vault, made), sys.stdout.buffer, protocol=pickle.HIGHEST_PROTOCOL)


def _start() -> subprocess.Popen[bytes]:
    # an error in it is met again where it is drawn instead, and told there
    pipe = subprocess.PIPE
    return subprocess.Popen([sys.executable, "-c", _PROGRAM], stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL)

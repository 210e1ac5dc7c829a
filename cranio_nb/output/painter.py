"""Who makes the page of a run while the rest of it goes on: a process of its own, or a thread.

The process loads what it draws with while the scan is read; where there is one processor only, a thread shares it.
"""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from collections.abc import Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from io import BytesIO
from typing import IO, TYPE_CHECKING, Any

if TYPE_CHECKING:  # what draws is loaded where it draws, so that the process can be started before anything else
    from ..pipeline.preparation import Prepared
    from ..pipeline.run import RunResult
    from ..prosthesis import Prosthesis
    from .design_pictures import Views
    from .pages import Shot

    Shots = dict[str, list[Shot]]

_CUT_SHORT = (EOFError, pickle.UnpicklingError)
_NOT_SENT = (pickle.PicklingError, AttributeError, TypeError)  # what pickle raises for, say, a function in a function
_PROGRAM = "from cranio_nb.output.painter import paint_for_parent; paint_for_parent()"

Known = Mapping[str, Any]


class Painter:
    """Draws what a run shows as soon as it is there, and makes its page; a context, in which it works.

    Examples
    --------
    >>> from cranio_nb.pipeline.preparation import prepare
    >>> from cranio_nb.pipeline.run import run_design
    >>> from data_synth import phantom_case
    >>> from data_synth.files import write_case
    >>> write_case("head", phantom_case("tiny", "burr_hole", 0))
    >>> with Painter() as painter:
    ...     case = prepare("head/ct")
    ...     painter.look_at(case)
    ...     result = run_design(case, method="hull", shaped=painter.draw_patch, designed=painter.draw)
    ...     page = painter.page(result).result()
    >>> page[:15]
    '<!DOCTYPE html>'
    """

    def __init__(self) -> None:
        self._process = _start() if _n_processors() > 1 else None
        self._thread = ThreadPoolExecutor(1)  # all that follows is done here, one after the other
        self._working = True
        self._shape: Prosthesis | None = None

    def __enter__(self) -> Painter:
        return self

    def __exit__(self, *_: object) -> None:
        # what was ordered and not yet fetched is wanted no more
        self._working = False
        if self._process is not None:
            self._process.kill()
        self._thread.shutdown(cancel_futures=True)
        if self._process is not None:
            _end(self._process)

    def look_at(self, case: Prepared) -> None:
        """Begin with what can be drawn before there is a prosthesis.

        Parameters
        ----------
        case : Prepared
        """
        self._case = case
        self._seen = self._thread.submit(self._see, case)

    def draw_patch(self, shape: Prosthesis) -> None:
        """Draw the pictures that need no surface.

        Parameters
        ----------
        shape : Prosthesis
            Designed for the case that was looked at; its mesh may still be missing.
        """
        self._shape, self._patch_drawn = shape, self._thread.submit(self._draw_patch, shape)

    def draw(self, made: Prosthesis) -> None:
        """Draw all other pictures that need no measures.

        Parameters
        ----------
        made : Prosthesis
            The one whose patch is drawn; where none was, its patch is drawn first.
        """
        if self._shape is None:
            self.draw_patch(made)
        self._drawn = self._thread.submit(self._draw, made)

    def page(self, result: RunResult) -> Future[str]:
        """Make the page of a run.

        Parameters
        ----------
        result : RunResult
            Of the prosthesis that is drawn.

        Returns
        -------
        Future of str
            As `design_page.report_page` makes it.
        """
        return self._thread.submit(self._page, result)

    def _see(self, case: Prepared) -> Views | None:
        """Show the case to the process, or draw the skull here."""
        # of the openings that stay open the size is shown; a sheet of each is as large as the scan, and is not
        for one in case.left_open:
            _ = one.size  # measured while there is a sheet, and kept
        unseen = {f"left open {one.number}": one.opening for one in case.left_open}
        if self._process is not None and self._tell(case, unseen):
            _ = case.digests  # made now, beside the design
            return None
        from .design_pictures import skull_views

        return skull_views(case)

    def _draw_patch(self, shape: Prosthesis) -> Shots | None:
        """Show the patch to the process, or draw it here."""
        if self._seen.result() is None and self._tell(shape.cropped(), _known(self._case)):
            return None
        return self._patch_shots(shape)

    def _draw(self, made: Prosthesis) -> Shots | None:
        """Show the surface to the process, or draw it here."""
        if self._patch_drawn.result() is None and self._tell(made.cropped(), _known(self._case, self._shape)):
            return None
        return self._surface_shots(made)

    def _page(self, result: RunResult) -> str:
        """The page that the process makes of a run; where it died, or was never there, the page is made here."""
        patch, surface, made = self._patch_drawn.result(), self._drawn.result(), result.prosthesis
        if surface is None and self._tell(result, _known(self._case, self._shape, made)):
            assert self._process is not None and self._process.stdout is not None
            with suppress(*_CUT_SHORT):
                page: str = pickle.load(self._process.stdout)
                return page
        from .design_page import measure_shots, report_page

        if not self._working:
            return ""
        # what the process had begun when it was killed, perhaps for want of memory
        patch = self._patch_shots(made) if patch is None else patch
        surface = self._surface_shots(made) if surface is None else surface
        return report_page(result, patch | surface | measure_shots(result))

    def _patch_shots(self, made: Prosthesis) -> Shots:
        """The pictures without a surface, drawn here while they are wanted."""
        from .design_pictures import patch_shots

        return patch_shots(self._case, made) if self._working else {}

    def _surface_shots(self, made: Prosthesis) -> Shots:
        """The pictures of the surface, drawn here while they are wanted."""
        from .design_pictures import skull_views, surface_shots

        if not self._working:
            return {}
        return surface_shots(self._case, self._seen.result() or skull_views(self._case), made)

    def _tell(self, what: Prepared | Prosthesis | RunResult, known: Known | None = None) -> bool:
        """Send to the process; whether it was there, and this can be sent: a method from outside may keep anything."""
        assert self._process is not None and self._process.stdin is not None
        try:
            _send(self._process.stdin, what, known or {})
        except (OSError, *_NOT_SENT):
            return False
        return True


def paint_for_parent() -> None:
    """In the process that draws: take case, patch, surface and result from standard input, answer on standard output.

    It ends with the process that started it, whose end closes both.
    """
    from ..drawing import figures
    from .design_page import measure_shots, report_page
    from .design_pictures import patch_shots, skull_views, surface_shots
    from .pages import page_template, shot

    answer, sys.stdout = sys.stdout.buffer, sys.stderr  # what a library prints is no answer
    # what takes time to load, while the scan is read
    shot(figures.colour_bar_figure(1.0, ""), alt="", caption="")
    page_template("design_page.html")
    with suppress(*_CUT_SHORT):  # there is nothing more to draw
        case: Prepared = _received(sys.stdin.buffer)
        views, _ = skull_views(case), case.digests
        shape: Prosthesis = _received(sys.stdin.buffer, _known(case))
        patch = patch_shots(case, shape)
        made: Prosthesis = _received(sys.stdin.buffer, _known(case, shape))
        surface = surface_shots(case, views, made)
        result: RunResult = _received(sys.stdin.buffer, _known(case, shape, made))
        page = report_page(result, patch | surface | measure_shots(result))
        pickle.dump(page, answer, protocol=pickle.HIGHEST_PROTOCOL)
        answer.flush()


def _known(case: Prepared, shape: Prosthesis | None = None, made: Prosthesis | None = None) -> Known:
    """What both processes have, by names that both give it: there it stays the same thing."""
    known: dict[str, Any] = {f"opening {i}": one for i, one in enumerate(case.openings)}
    if shape is not None:
        known |= {f"working {i}": one for i, one in enumerate(shape.working)}
    return known if made is None else known | {"case": case, "made": made}


def _send(stream: IO[bytes], what: Any, known: Known) -> None:
    """Write an object: its large arrays first, from where they lie, without a copy of them."""
    large: list[pickle.PickleBuffer] = []
    rest = BytesIO()
    _Sender(rest, known, large).dump(what)
    pickle.dump([part.raw().nbytes for part in large], stream)
    for part in large:
        stream.write(part.raw())
    stream.write(rest.getbuffer())
    stream.flush()


def _received(stream: IO[bytes], known: Known | None = None) -> Any:
    """What `_send` wrote."""
    large = [bytearray(n_bytes) for n_bytes in pickle.load(stream)]
    for part in large:
        if stream.readinto(part) < len(part):  # type: ignore[attr-defined]
            raise EOFError
    return _Receiver(stream, known or {}, large).load()


class _Sender(pickle.Pickler):
    """What the other process has is named only, so that there too it is the same thing."""

    def __init__(self, stream: IO[bytes], known: Known, large: list[pickle.PickleBuffer]) -> None:
        super().__init__(stream, pickle.HIGHEST_PROTOCOL, buffer_callback=large.append)
        self._name = {id(one): name for name, one in known.items()}

    def persistent_id(self, what: Any) -> str | None:
        return self._name.get(id(what))


class _Receiver(pickle.Unpickler):
    def __init__(self, stream: IO[bytes], known: Known, large: list[bytearray]) -> None:
        super().__init__(stream, buffers=large)
        self._known = known

    def persistent_load(self, name: str) -> Any:
        return self._known.get(name)  # None for what is not shown


def _start() -> subprocess.Popen[bytes] | None:
    """A process that draws, with the modules that are found here; None where none can be started."""
    # an error in it is met again where it is drawn instead, and told there
    pipe, program = subprocess.PIPE, f"import sys; sys.path[:] = {sys.path!r}; {_PROGRAM}"
    try:
        return subprocess.Popen([sys.executable, "-c", program], stdin=pipe, stdout=pipe, stderr=subprocess.DEVNULL)
    except OSError:
        return None


def _end(process: subprocess.Popen[bytes]) -> None:
    """Close what leads to a process that was killed."""
    for stream in (process.stdin, process.stdout):
        assert stream is not None
        with suppress(OSError):  # it died before it read all
            stream.close()
    process.wait()


def _n_processors() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1

"""A method and a prepared skull -> what came of it: a prosthesis or a refusal in one sentence, time and peak memory.

Frames: those of the bone given. Memory is measured in a process of its own (`attempt_apart`), so that what other
methods or the pictures needed before is not counted.
"""

from __future__ import annotations

import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import dataclass, field, replace
from multiprocessing import get_context
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import CranioError, InputRefused, NoOpening
from ..methods.catalogue import find_method, method_names, preset_names
from ..methods.design import check_request, design
from ..methods.transfer import pack_methods, unpack_methods
from ..opening import Opening
from ..prosthesis import Prosthesis
from ..volume import Volume
from .run import check_patch

STATUSES = ("done", "refused", "no patch", "broken")
"""How a trial ended: with a prosthesis; with a refusal of the method to serve this input; without anything bridged,
or with a patch that runs out of the image; by a fault of the program or a lack of memory."""


@dataclass(frozen=True)
class Contender:
    """A method with a preset and options, as one line of a comparison.

    Parameters
    ----------
    method : str
        A name of the catalogue.
    preset : str
        "default", or a preset of the method.
    options : dict
        Options that differ from the preset.
    """

    method: str
    preset: str = "default"
    options: dict[str, Any] = field(default_factory=dict)

    @property
    def name(self) -> str:
        """The name in tables.

        Returns
        -------
        str
            ``method``, or ``method:preset``.
        """
        return self.method if self.preset == "default" else f"{self.method}:{self.preset}"


@dataclass(frozen=True, eq=False)
class Trial:
    """What came of one contender on one skull.

    Parameters
    ----------
    contender : Contender
    status : str
        One of `STATUSES`.
    prosthesis : Prosthesis or None
        Without the method's `working`; None unless the status is "done".
    code, message : str
        Name of the fault and the sentence for it; empty when done.
    seconds : float
        Wall time of the design alone; nan if it did not end by itself.
    cpu : float
        Time the processors worked for it, all threads, s: what to compare on a machine that does other things, too.
    memory : float
        MB (10^6 bytes), see `peak_memory`; nan where it cannot be known.
    """

    contender: Contender
    status: str
    prosthesis: Prosthesis | None
    code: str
    message: str
    seconds: float
    cpu: float
    memory: float


Attempt = Callable[[Volume, Sequence[Opening], Contender], Trial]


def contenders(names: Sequence[str] = ()) -> tuple[Contender, ...]:
    """Contenders by name, each once, in the order asked for.

    Parameters
    ----------
    names : sequence of str
        ``method`` or ``method:preset``. By default every method of the catalogue with each of its presets.

    Returns
    -------
    tuple of Contender

    Raises
    ------
    InputRefused
        ``UnknownMethod`` or ``UnknownPreset``.
    """
    if not names:
        return tuple(Contender(method, preset) for method in method_names() for preset in preset_names(method))
    found = []
    for name in dict.fromkeys(names):
        method, _, preset = name.partition(":")
        check_request(method, preset or "default", {})
        found.append(Contender(method, preset or "default"))
    return tuple(found)


def attempt(bone: Volume, openings: Sequence[Opening], contender: Contender) -> Trial:
    """Let a contender design in this process; never raises for what a method does.

    Parameters
    ----------
    bone : Volume
        Bool mask of the skull.
    openings : sequence of Opening
    contender : Contender

    Returns
    -------
    Trial
    """
    find_method(contender.method)  # loaded before the clock runs
    made, status, code, message = None, "done", "", ""
    began, cpu = time.perf_counter(), time.process_time()
    try:
        made = design(bone, openings, method=contender.method, preset=contender.preset, **contender.options)
        check_patch(made, openings)
    except CranioError as error:
        status, code, message = status_of(error), error.code, str(error)
    except Exception as error:  # a method's fault is a row of the table, not the end of it
        code = type(error).__name__
        status, message = "broken", f"Something unforeseen went wrong in the method ({code})."
    spent = time.perf_counter() - began, time.process_time() - cpu
    return Trial(contender, status, made and replace(made, working=()), code, message, *spent, peak_memory())


def status_of(error: CranioError) -> str:
    """How a trial ended by an error.

    Parameters
    ----------
    error : CranioError

    Returns
    -------
    str
        One of `STATUSES`.

    Examples
    --------
    >>> status_of(NoOpening("NoOpening", "There is nothing to close."))
    'no patch'
    """
    # the openings lie inside the image, as was checked before; a patch that does not is the method's failure
    if isinstance(error, NoOpening) or error.code in ("OpeningLeavesImage", "PatchLeavesOpening"):
        return "no patch"
    return "refused" if isinstance(error, InputRefused) else "broken"


def attempt_apart(bone: Volume, openings: Sequence[Opening], contender: Contender) -> Trial:
    """`attempt` in a new process, which gets the masks as memory-mapped files and gives back what it made.

    A process that dies, e.g. for lack of memory, is a trial with the status "broken".

    Parameters
    ----------
    bone, openings, contender
        As for `attempt`.

    Returns
    -------
    Trial
    """
    with tempfile.TemporaryDirectory(prefix="cranio-nb-") as folder:
        for name, volume in [("bone", bone), *((str(i), one.sheet) for i, one in enumerate(openings))]:
            np.save(Path(folder) / f"{name}.npy", volume.voxels)
        places = [(one.head_centre, one.head_axes) for one in openings]
        with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
            try:
                trial, patch = pool.submit(_child, folder, bone.affine, places, contender, pack_methods()).result()
            except BrokenProcessPool:
                message = "The process of the method ended before its time; it may have run out of memory."
                return Trial(contender, "broken", None, "ProcessEnded", message, *[float("nan")] * 3)
    if trial.prosthesis is None or patch is None:
        return trial
    voxels = np.zeros(bone.shape, bool)
    voxels.flat[patch] = True
    return replace(trial, prosthesis=replace(trial.prosthesis, patch=bone.with_voxels(voxels)))


def peak_memory() -> float:
    """Largest resident memory that this process ever had.

    That is Python with its libraries, the masks, and what the method needed on top of them: how much memory a machine
    must have free. A bare process with numpy, scipy and scikit-image holds about 100 MB.

    Returns
    -------
    float
        MB (10^6 bytes); nan where the system gives no number.

    Notes
    -----
    On Linux it is VmHWM of /proc/self/status: `resource.getrusage` there counts what the *parent* held when it
    started the process, too. Elsewhere it is ru_maxrss (bytes on macOS).
    """
    try:
        status = Path("/proc/self/status").read_text(encoding="ascii")
        return 1024e-6 * int(status.split("VmHWM:")[1].split()[0])
    except (OSError, IndexError):
        pass
    try:
        import resource
    except ImportError:
        return float("nan")
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1e-6 if sys.platform == "darwin" else 1024e-6)


def _child(folder: str, affine: Any, places: list[Any], contender: Contender, methods: bytes) -> tuple[Trial, Any]:
    """The trial without its patch, and the flat indices of the patch: they are small, the grid is not."""

    def load(name: str) -> Volume:
        return Volume(np.asarray(np.load(Path(folder) / f"{name}.npy", mmap_mode="r")), affine)

    unpack_methods(methods)
    openings = [Opening(load(str(i)), centre, axes) for i, (centre, axes) in enumerate(places)]
    trial = attempt(load("bone"), openings, contender)
    if trial.prosthesis is None or trial.prosthesis.patch is None:
        return trial, None
    patch = np.flatnonzero(trial.prosthesis.patch.voxels)
    return replace(trial, prosthesis=replace(trial.prosthesis, patch=None)), patch

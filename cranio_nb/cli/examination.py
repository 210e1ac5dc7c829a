"""What the package needs -> is it on this machine? One check for each thing, with its remedy.

Nothing is loaded into the running process that could end it: drawing is tried in a child process.
"""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version

from ..drawing.front_end import proxy
from ..teaching.shipped import install_command

_NEEDED = tuple(
    "numpy scipy threadpoolctl scikit-image pydicom pyjpegls pylibjpeg-openjpeg imagecodecs nibabel pynrrd zlib-ng "
    "trimesh networkx lxml manifold3d cloudpickle click rich matplotlib pillow jinja2".split()
)
_OPTIONAL = {
    "lab": ("jupyterlab", "anywidget", "jupyterlab-widgets", "ipykernel", "jupytext", "nbclient"),
    "study": ("distributed", "pyarrow", "bokeh"),
    "view": ("pyvista", "vtk", "trame-pyvista", "aiohttp"),
    "site": ("sphinx", "myst-nb", "numpydoc", "furo", "sphinx-revealjs"),
}
_MIN_MEMORY_GB = 2.0
_PLOT = "from matplotlib.backends.backend_agg import FigureCanvasAgg as C; from matplotlib.figure import Figure as F; "
_PLOT += "C(F()).draw()"
_SCENE = "import pyvista as pv; p = pv.Plotter(off_screen=True, window_size=(64, 64)); p.add_mesh(pv.Sphere()); "
_SCENE += "raise SystemExit(0 if p.screenshot(None, return_img=True).std() > 1 else 3)"
_TIMEOUT_S = 90


@dataclass(frozen=True)
class Check:
    """One thing that was examined.

    Parameters
    ----------
    name : str
    state : {"ok", "missing", "optional"}
        "optional": not there, and only part of the package misses it.
    found : str
    remedy : str
        What to do; empty where nothing needs doing.
    """

    name: str
    state: str
    found: str
    remedy: str = ""


def examine() -> Iterator[Check]:
    """Examine one thing after the other.

    Returns
    -------
    iterator of Check
        Versions and packages first, then memory, then drawing.

    Examples
    --------
    >>> first = next(examine())
    >>> first.name, first.state
    ('cranio-nb', 'ok')
    """
    yield Check("cranio-nb", "ok", version("cranio-nb"))
    yield _python()
    for name in _NEEDED:
        yield _package(name, "missing", f"pip install {name}")
    for extra, names in _OPTIONAL.items():
        for name in names:
            yield _package(name, "optional", install_command(extra))
    yield _front_end()
    yield _memory()
    yield _drawing("pictures", _PLOT, "missing", "Install matplotlib again.")
    if _installed("pyvista"):
        remedy = "Install libosmesa6 and set VTK_DEFAULT_OPENGL_WINDOW=vtkOSOpenGLRenderWindow."
        yield _drawing("3-D scenes", _SCENE, "optional", remedy)


def free_memory_gb() -> float | None:
    """Memory that a new process can have.

    Returns
    -------
    float or None
        GB; None where the system does not say.
    """
    try:
        with open("/proc/meminfo") as lines:
            fields = dict(line.split(":", 1) for line in lines)
        return int(fields["MemAvailable"].split()[0]) / 1e6
    except (OSError, KeyError, ValueError):
        return None


def _python() -> Check:
    """Whether this Python is new enough."""
    found = ".".join(map(str, sys.version_info[:3]))
    good = sys.version_info >= (3, 11)
    return Check("Python", "ok" if good else "missing", found, "" if good else "Use Python 3.11 or newer.")


def _package(name: str, absent: str, remedy: str) -> Check:
    """Whether a package is installed, and which version."""
    found = _installed(name)
    return Check(name, "ok", found) if found else Check(name, absent, "not installed", remedy)


def _installed(name: str) -> str:
    """Version of a package; empty where it is not installed."""
    try:
        return version(name)
    except PackageNotFoundError:
        return ""


def _front_end() -> Check:
    """Where lessons would be shown; slider callbacks and VTK agree only under the package's lab settings."""
    between = proxy()
    if between:
        return Check("front end", "ok", f"{between}: 3-D scenes are pages of their own")
    if not _installed("jupyterlab"):
        return Check("front end", "optional", "no JupyterLab", install_command("lab"))
    return Check(
        "front end", "ok", "JupyterLab on this machine; start it with `cranio-nb lab`, which brings its settings"
    )


def _memory() -> Check:
    """Whether there is memory enough for a scan."""
    free = free_memory_gb()
    if free is None:
        return Check("free memory", "ok", "unknown")
    good = free >= _MIN_MEMORY_GB
    remedy = "" if good else f"Close programs: {_MIN_MEMORY_GB:g} GB are wanted for a scan of 512 x 512 x 140."
    return Check("free memory", "ok" if good else "missing", f"{free:.1f} GB", remedy)


def _drawing(name: str, code: str, absent: str, remedy: str) -> Check:
    """Try to draw in a child process, which may crash without harm."""
    try:
        done = subprocess.run([sys.executable, "-c", code], timeout=_TIMEOUT_S, check=False, capture_output=True)
    except subprocess.TimeoutExpired:
        return Check(name, absent, f"no picture after {_TIMEOUT_S} s", remedy)
    if done.returncode:
        return Check(name, absent, "drawing fails", remedy)
    return Check(name, "ok", "drawing works")

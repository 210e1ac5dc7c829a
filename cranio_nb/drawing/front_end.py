"""Where a notebook runs -> whether sliders would do anything there."""

from __future__ import annotations

import os
import sys

from ..errors import InputRefused

MODES = ("static", "widget", "auto")
"""Values of ``CRANIO_NB_MODE``."""


def mode() -> str:
    """How panels show themselves.

    Returns
    -------
    {"widget", "static"}
        With controls, or as one picture.

    Raises
    ------
    InputRefused
        ``UnknownMode`` when ``CRANIO_NB_MODE`` is none of `MODES`.

    Notes
    -----
    ``CRANIO_NB_MODE`` is "static", "widget" or "auto" (the default). "auto" searches for a front end: a kernel that a
    Jupyter server, VS Code or Colab started. A notebook run by nbclient, nbconvert or nbval has none.

    Examples
    --------
    >>> mode() in ("static", "widget")
    True
    """
    asked = os.environ.get("CRANIO_NB_MODE", "auto")
    if asked not in MODES:
        raise InputRefused("UnknownMode", f"CRANIO_NB_MODE is {asked!r}.", f"Set it to one of {', '.join(MODES)}.")
    if asked != "auto":
        return asked
    return "widget" if _has_front_end() else "static"


def is_local() -> bool:
    """Whether the browser runs on the kernel's own machine, so that it can reach a port of the kernel.

    Returns
    -------
    bool
    """
    return proxy() is None


def proxy() -> str | None:
    """What lies between kernel and browser.

    Returns
    -------
    str or None
        Its name, e.g. "JupyterHub"; None where both are on one machine.
    """
    if "google.colab" in sys.modules or "COLAB_RELEASE_TAG" in os.environ:
        return "Colab"
    marks = {
        "JUPYTERHUB_USER": "JupyterHub",
        "BINDER_SERVICE_HOST": "Binder",
        "VSCODE_PID": "VS Code",
        "CODESPACES": "Codespaces",
        "KUBERNETES_SERVICE_HOST": "a cluster",
    }
    return next((name for mark, name in marks.items() if mark in os.environ), None)


def _has_front_end() -> bool:
    """Whether a server or an editor started this kernel."""
    if "ipykernel" not in sys.modules:
        return False
    started = ("JPY_SESSION_NAME", "VSCODE_PID", "COLAB_RELEASE_TAG")  # a server names the notebook; nbclient does not
    return any(name in os.environ for name in started)

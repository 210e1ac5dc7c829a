"""Names of methods and presets on the command line, those of other packages too."""

from __future__ import annotations

from typing import Any

import click

from ..errors import InputRefused
from ..methods.catalogue import METHODS, check_preset, method_names


class MethodName(click.ParamType):
    """A method of the catalogue; the entry points of other packages are read only for a name that is not built in."""

    name = "method"

    def get_metavar(self, param: click.Parameter, ctx: click.Context) -> str:
        """All names, for the help."""
        return f"[{'|'.join(method_names())}]"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """The name itself, refused where there is no such method."""
        if value not in METHODS and value not in method_names():
            self.fail(f"there is none named {value!r}; choose one of {', '.join(method_names())}.", param, ctx)
        return value


def check_asked(method: str, preset: str) -> None:
    """Refuse a preset that the method does not have.

    Parameters
    ----------
    method, preset : str

    Raises
    ------
    click.BadParameter
        Exit code 2.
    """
    try:
        check_preset(method, preset)
    except InputRefused as error:
        raise click.BadParameter(str(error), param_hint="--preset") from None

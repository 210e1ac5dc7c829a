"""The command `cranio-nb`: the group of all commands, and how an error ends.

Results go to stdout, all else to stderr. Exit codes: 0 done, 1 fault of the program, 2 usage, 3 input refused,
4 no opening, 5 could not write. A command loads what it works with only when it runs, so that `--help` answers at once.
"""

from __future__ import annotations

from typing import Any

import click

from ..errors import CranioError
from .compare import compare
from .demo import demo
from .design import design
from .doctor import doctor
from .inspect import inspect
from .lab import lab
from .lessons import lessons
from .methods import methods
from .options import debug
from .phantom import phantom
from .prior import prior
from .score import score
from .study import study


class ErrorGroup(click.Group):
    """A group of commands whose errors end as one sentence and an exit code."""

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command that was asked for.

        Parameters
        ----------
        ctx : click.Context
            With ``meta["debug"]``, errors pass as they are.

        Returns
        -------
        Any
            What the command gives back.
        """
        try:
            return super().invoke(ctx)
        except (click.ClickException, click.exceptions.Exit, click.Abort, BrokenPipeError):
            raise  # as click ends them; who reads the output, as `| head`, may have read enough
        except Exception as error:
            if ctx.meta.get("debug"):
                raise
            click.echo(f"cranio-nb: {_sentence(error)}", err=True)
            ctx.exit(error.exit_code if isinstance(error, CranioError) else 1)


def _sentence(error: Exception) -> str:
    """What went wrong; the words of an unforeseen error stay hidden, since they may hold a path or a name."""
    if isinstance(error, CranioError):
        return str(error)
    return f"something unforeseen went wrong ({type(error).__name__}); run again with --debug to see where."


@click.group(
    cls=ErrorGroup,
    commands=[demo, phantom, design, inspect, score, doctor, compare, methods, lab, lessons, prior, study],
    context_settings={"help_option_names": ["-h", "--help"]},
)
@click.version_option(package_name="cranio-nb", prog_name="cranio-nb")
@debug
def main() -> None:
    """From a head CT with a hole in the skull to the prosthesis that closes it.

    For teaching and research; not a medical device, not for clinical use.

    \b
    Examples:
      cranio-nb demo
      cranio-nb inspect scans/head_ct
      cranio-nb design scans/head_ct --out out
      cranio-nb doctor
    """

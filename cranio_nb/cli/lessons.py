"""The commands `cranio-nb lessons ...`: for authors and teachers."""

from __future__ import annotations

from pathlib import Path

import click

from ..errors import InputRefused
from .options import PATH, check_writes, debug


@click.group()
def lessons() -> None:
    """Make the lesson notebooks from their texts; grade what students hand in.

    \b
    Examples:
      cranio-nb lessons build
      cranio-nb lessons html pages
      cranio-nb lessons site pages
      cranio-nb lessons grade handed_in/*/04_deformable_model.ipynb
    """


@lessons.command()
@click.option("--folder", type=PATH, default=Path("notebooks"), show_default=True, help="Holds src/NN_topic.py.")
@click.option("--only", default="", metavar="NN", help="Only lessons whose name starts so, e.g. 04.")
@click.option("--check", is_flag=True, help="Write nothing; exit code 1 if the notebooks are out of step.")
@debug
def build(folder: Path, only: str, check: bool) -> None:
    """Run the lesson texts and write the notebooks and the copies with exercises.

    \b
    Examples:
      cranio-nb lessons build
      cranio-nb lessons build --check
    """
    from ..teaching.build import build as make
    from ..teaching.build import is_built, out_of_step

    if not check:
        sources = sorted((folder / "src").glob(f"{only}*.py"))
        names = [f"{home}{path.stem}.ipynb" for path in sources for home in ("", "exercises/")]
        reads = {f"src/{path.name}": path for path in sources}
        check_writes(folder, names, reads, own=lambda home, name: is_built(home / name))
        for path in make(folder, only):
            click.echo(path)
        return
    problems = out_of_step(folder, only)
    for problem in problems:
        click.echo(problem, err=True)
    if problems:
        raise click.exceptions.Exit(1)


@lessons.command()
@click.argument("out", type=PATH)
@click.option("--folder", type=PATH, default=Path("notebooks"), show_default=True, help="Holds NN_topic.ipynb.")
@debug
def html(out: Path, folder: Path) -> None:
    """Write the lessons as web pages, every picture with its description; nothing is run.

    \b
    Example:
      cranio-nb lessons html pages
    """
    from ..teaching.web_pages import write_pages

    notebooks = sorted(folder.glob("*.ipynb"))
    check_writes(out, [f"{path.stem}.html" for path in notebooks], {path.name: path for path in notebooks})
    for path in write_pages(folder, out):
        click.echo(path)


@lessons.command()
@click.argument("out", type=PATH)
@click.option("--folder", type=PATH, default=Path(), show_default=True, help="The project's folder, with its README.")
@click.option("--only", default="", metavar="NN", help="Only lessons whose name starts so, e.g. 04.")
@click.option("--repository", default="", metavar="OWNER/NAME", help="On GitHub: adds links to Binder and Colab.")
@debug
def site(out: Path, folder: Path, only: str, repository: str) -> None:
    """Build the lessons, the docs and the API reference as a web site that opens from disk.

    The lessons are shown as they ran; only what draws their panels is run again. Needs the extra "site".

    \b
    Examples:
      cranio-nb lessons site pages
      cranio-nb lessons site pages --only 04
    """
    from ..teaching.site.build import NAMES, build_site

    reads = {name: folder / name for name in ("README.md", "docs", "notebooks")}
    check_writes(out, NAMES, reads)
    click.echo(build_site(folder, out, only, repository, click.echo))


@lessons.command()
@click.argument("number", metavar="NN")
@click.argument("out", type=PATH)
@click.option("--folder", type=PATH, default=Path("notebooks"), show_default=True, help="Holds NN_topic.ipynb.")
@debug
def slides(number: str, out: Path, folder: Path) -> None:
    """Write a lesson as slides for a lecture: figures large, panels alive, answers left out.

    They open from disk in any browser. Needs the extra "site".

    \b
    Example:
      cranio-nb lessons slides 04 talk
    """
    from ..teaching.site.slides import write_slides

    found = sorted(folder.glob(f"{number}*.ipynb"))
    if len(found) != 1:
        names = ", ".join(path.name for path in found) or "none"
        raise InputRefused("NotFound", f"One lesson was wanted that begins with {number!r}; found: {names}.")
    (path,) = found
    check_writes(out, (f"{path.stem}.html", f"{path.stem}_pictures", "reveal"), {path.name: path})
    click.echo(write_slides(path, out))


@lessons.command()
@click.argument("notebooks", nargs=-1, required=True, type=PATH)
@debug
def grade(notebooks: tuple[Path, ...]) -> None:
    """Run notebooks that students hand in, and print the points of each exercise.

    They are run as programs on this machine, with your rights: use a machine that you can spare.

    \b
    Example:
      cranio-nb lessons grade handed_in/*/04_deformable_model.ipynb
    """
    from ..teaching.build import points

    for path in notebooks:
        found = points(path)
        total = sum(got for got, _ in found.values())
        each = "  ".join(f"{name}: {got}/{most}" for name, (got, most) in found.items())
        click.echo(f"{path}  {total}/{sum(most for _, most in found.values())}  {each}")

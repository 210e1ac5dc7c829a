"""The commands `cranio-nb lessons ...`: for authors and teachers."""

from __future__ import annotations

from pathlib import Path

import click

from ..errors import InputRefused
from .options import PATH, check_writes, debug

shipped = click.option(
    "--folder", type=PATH, show_default="those of the package", help="Holds executed lessons, NN_topic.ipynb."
)


@click.group()
def lessons() -> None:
    """Copy the lessons to work in, grade what is handed in, make the notebooks from their texts.

    \b
    Examples:
      cranio-nb lessons copy lessons
      cranio-nb lessons build
      cranio-nb lessons html pages
      cranio-nb lessons site pages
      cranio-nb lessons grade handed_in/*/04_deformable_model.ipynb
      cranio-nb lessons export course --for nbgrader
    """


@lessons.command()
@click.argument("out", type=PATH, metavar="DIR")
@debug
def copy(out: Path) -> None:
    """Copy the lessons that come with the package to DIR: solved ones, and those to fill in below DIR/exercises.

    \b
    Example:
      cranio-nb lessons copy lessons && cranio-nb lab lessons
    """
    from ..teaching.shipped import copy_lessons, lesson_names, shipped_lessons

    check_writes(out, {name.split("/")[0] for name in lesson_names()}, {"the lessons": shipped_lessons()})
    made = copy_lessons(out)
    click.echo(f"{len(made)} notebooks: those to work in are in {out / 'exercises'}, the solved ones in {out}.")
    click.echo(f"Open them: cranio-nb lab {out}")


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
@shipped
@debug
def html(out: Path, folder: Path | None) -> None:
    """Write the lessons as web pages, every picture with its description; nothing is run.

    \b
    Example:
      cranio-nb lessons html pages
    """
    from ..teaching.shipped import shipped_lessons
    from ..teaching.web_pages import write_pages

    folder = folder or shipped_lessons()
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
@click.option("--out", type=PATH, default=Path("grades"), show_default=True, help="Folder for table and pages.")
@debug
def grade(notebooks: tuple[Path, ...], out: Path) -> None:
    """Run notebooks that students hand in; write a table, a page for each and a page on the class.

    They are run as programs on this machine, with your rights: use a machine that you can spare. A student is called
    by the folder of the notebook, or by the file where its name is not just that of the lesson.

    \b
    Example:
      cranio-nb lessons grade handed_in/*/04_deformable_model.ipynb --out grades
    """
    from ..teaching.grading import grades_folder, marks

    paths = list(dict.fromkeys(notebooks))
    check_writes(out, grades_folder.FILES, {f"NOTEBOOKS ({path})": path for path in paths})
    graded = []
    for path, student in zip(paths, marks.students(paths), strict=True):
        one = marks.grade(path, student)
        each = "  ".join(f"{v.name}: {v.points}/{v.out_of}" for v in one.verdicts)
        click.echo("  ".join(filter(None, [str(path), f"{one.points}/{one.out_of}", each, one.remark])))
        graded.append(one)
    grades_folder.write_grades(graded, out)
    for name in grades_folder.FILES:
        click.echo(out / name)


@lessons.command()
@click.argument("out", type=PATH)
@click.option("--for", "tool", type=click.Choice(("nbgrader", "otter")), required=True, help="The tool.")
@shipped
@debug
def export(out: Path, tool: str, folder: Path | None) -> None:
    """Write the lessons as assignments of nbgrader or Otter-Grader, which give the same points as the checks.

    \b
    Examples:
      cranio-nb lessons export course --for nbgrader
      cranio-nb lessons export course --for otter
    """
    from ..teaching.export.assignment import write_assignments
    from ..teaching.export.nbgrader import NBGRADER
    from ..teaching.export.otter import OTTER
    from ..teaching.shipped import shipped_lessons

    folder = folder or shipped_lessons()
    chosen = {"nbgrader": NBGRADER, "otter": OTTER}[tool]
    reads = {path.name: path for path in sorted(folder.glob("*.ipynb"))}
    made = [chosen.place.format(lesson=path.stem) for path in reads.values()]
    check_writes(out, {name.split("/")[0] for name in (*made, *chosen.files)}, reads)
    for path in write_assignments(folder, out, chosen):
        click.echo(path)

"""The command line: parses what is asked, calls `run` and `outputs`, prints results on stdout and the rest on stderr.

Exit codes: 0 done, 1 fault of the program, 2 usage, 3 input refused, 4 no opening, 5 could not write.
"""

from __future__ import annotations

import dataclasses
import json
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from ..errors import CannotWrite, CranioError, InputRefused
from ..methods.catalogue import check_options
from ..readers import ALLOWANCES, read_ct
from .compare import compare
from .lab import lab
from .lessons import lessons
from .method_name import MethodName, check_asked
from .prior import prior

if TYPE_CHECKING:
    from data_synth import Case

    from ..evaluation.paper_tables import OpeningSize

# a command loads what it works with only when it runs, so that `--help` is there at once
_SIZES = ("tiny", "class", "full")
_PATH = click.Path(path_type=Path)


class _Doors(click.Group):
    """A group of commands whose errors end as one sentence and an exit code."""

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except (click.ClickException, click.exceptions.Exit, click.Abort):
            raise
        except Exception as error:
            if ctx.meta.get("debug"):
                raise
            _complain(error)
            ctx.exit(error.exit_code if isinstance(error, CranioError) else 1)


def _complain(error: Exception) -> None:
    if isinstance(error, CranioError):
        click.echo(f"cranio-nb: {error}", err=True)
    else:
        message = f"something unforeseen went wrong ({type(error).__name__}); run again with --debug to see where."
        click.echo(f"cranio-nb: {message}", err=True)


def _set_debug(ctx: click.Context, _: click.Parameter, value: bool) -> None:
    ctx.meta["debug"] = ctx.meta.get("debug", False) or value


_debug = click.option(
    "--debug", is_flag=True, expose_value=False, callback=_set_debug, help="Show where an error came from."
)
_allow = click.option(
    "--allow", multiple=True, type=click.Choice(ALLOWANCES), help="Relax one check of the reader; may be repeated."
)
_mask = click.option("--mask", is_flag=True, help="Take every nonzero voxel as bone. Data of 0 and 1 need no telling.")
_threshold = click.option("--threshold", type=float, metavar="HU", help="Lowest HU of bone.  [default: 400]")
_json = click.option("--json", "as_json", is_flag=True, help="Print JSON instead of a table.")


@click.group(
    cls=_Doors, commands=[compare, lab, lessons, prior], context_settings={"help_option_names": ["-h", "--help"]}
)
@click.version_option(package_name="cranio-nb", prog_name="cranio-nb")
@_debug
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


@main.command()
@click.option("--out", type=_PATH, default=Path("cranio_nb_out/demo"), show_default=True, help="Folder to write to.")
@click.option("--size", type=click.Choice(_SIZES), default="full", show_default=True, help="Grid of the synthetic CT.")
@_debug
def demo(out: Path, size: str) -> None:
    """Design and score a prosthesis for a synthetic head CT.

    The CT is written as a DICOM series into OUT/ct and read back like any other scan. "full" is the size of the
    paper's scan, 512 x 512 x 68.

    \b
    Examples:
      cranio-nb demo
      cranio-nb demo --size tiny --out demo_tiny
    """
    from data_synth import phantom_case
    from data_synth.files import write_case

    from ..output.design_folder import FILES, write_outputs
    from ..output.staging import check_folder, staged
    from ..pipeline.run import run_design
    from .console import print_result, progress_bar

    check_folder(out, FILES)
    _check_case_folder(out)
    with progress_bar() as tell, staged(out) as part:
        tell("synthetic CT", 0.0)
        write_case(part, phantom_case(size, "unilateral", 0))
        result = run_design(part / "ct", truth=part / "truth.nii.gz", progress=tell)
        write_outputs(result, part, tell)
    print_result(result, out)


@main.command()
@click.argument("out", type=_PATH)
@click.option("--size", type=click.Choice(_SIZES), default="class", show_default=True, help="Grid of the phantom.")
@click.option("--defect", default="unilateral", show_default=True, help="Kind of hole, e.g. frontal, vertex, large.")
@click.option("--seed", type=int, default=0, show_default=True, help="Chooses head, place, size and rim.")
@click.option("--from", "source", type=_PATH, metavar="CT", help="Cut this intact scan or mask instead of a phantom.")
@_allow
@_debug
def phantom(out: Path, size: str, defect: str, seed: int, source: Path | None, allow: tuple[str, ...]) -> None:
    """Write a head with a hole, and the bone that is missing.

    Files: OUT/ct (DICOM; OUT/mask.nii.gz for a mask), OUT/truth.nii.gz and OUT/truth.json.

    \b
    Examples:
      cranio-nb phantom case1 --size full --defect unilateral --seed 1
      cranio-nb phantom case2 --from scans/intact_head --defect frontal
    """
    from data_synth import DEFECTS, phantom_case
    from data_synth.files import write_case

    from ..output.staging import check_folder, staged
    from .console import progress_bar

    if defect not in DEFECTS:
        raise click.BadParameter(f"there is none named {defect!r}; choose one of {', '.join(DEFECTS)}.")
    check_folder(out, ("truth.nii.gz", "truth.json"))
    _check_case_folder(out)
    with progress_bar() as tell, staged(out) as part:
        tell("making the case", 0.0)
        case = phantom_case(size, defect, seed) if source is None else _cut(source, defect, seed, allow)
        write_case(part, case)
        tell("done", 1.0)
    click.echo(f"{out / ('mask.nii.gz' if case.hu is None else 'ct')}\n{out / 'truth.nii.gz'}")


@main.command()
@click.argument("scan", type=_PATH, metavar="INPUT")
@click.option("--out", type=_PATH, required=True, help="Folder to write to; made if missing.")
@click.option("--method", type=MethodName(), default="slicewise", show_default=True)
@click.option("--preset", default="default", show_default=True, metavar="NAME", help="paper: as published in 2011.")
@click.option("--params", type=_PATH, metavar="JSON", help="File with options of the method: {name: value, ...}.")
@click.option(
    "--prior", "learned", type=_PATH, metavar="NPZ", help="What `cranio-nb prior learn` made; for thin-plate."
)
@click.option("--planes", metavar="A:B", help="Close only what lies in planes A to B (see `cranio-nb inspect`).")
@click.option("--truth", type=_PATH, metavar="MASK", help="Missing bone on the input's own grid, to score against.")
@_mask
@_threshold
@_allow
@_debug
def design(
    scan: Path,
    out: Path,
    method: str,
    preset: str,
    params: Path | None,
    learned: Path | None,
    planes: str | None,
    truth: Path | None,
    mask: bool,
    threshold: float | None,
    allow: tuple[str, ...],
) -> None:
    """Design the prosthesis that closes the hole in a skull.

    INPUT is a folder of DICOM files, or a NIfTI or NRRD file with a CT in HU or a bone mask. Written are
    prosthesis.stl (world mm, LPS), patch.nii.gz (on the input's grid), design.json and report.html; all or nothing.

    \b
    Examples:
      cranio-nb design scans/head_ct --out out
      cranio-nb design skull.nii.gz --mask --preset paper --out out
      cranio-nb design scans/head_ct --threshold 300 --planes 40:75 --out out
    """
    from ..output.design_folder import FILES, write_outputs
    from ..output.staging import check_folder, staged
    from ..pipeline.run import run_design
    from .console import print_result, progress_bar

    check_asked(method, preset)
    options, between = _options(method, params), _planes(planes)
    options |= {} if learned is None else {"prior": str(learned)}
    if out.resolve() == scan.resolve():
        raise click.BadParameter("this is the input; nothing is ever written there.", param_hint="--out")
    check_folder(out, FILES)
    with progress_bar() as tell:
        result = run_design(
            scan,
            method=method,
            preset=preset,
            options=options,
            mask=mask or None,
            threshold=threshold,
            planes=between,
            truth=truth,
            allow=allow,
            progress=tell,
        )
        with staged(out) as part:
            write_outputs(result, part, tell)
    print_result(result, out)


@main.command()
@click.argument("scan", type=_PATH, metavar="INPUT")
@_mask
@_threshold
@_allow
@_json
@_debug
def inspect(scan: Path, mask: bool, threshold: float | None, allow: tuple[str, ...], as_json: bool) -> None:
    """Show how a scan is read and which openings its skull has.

    \b
    Examples:
      cranio-nb inspect scans/head_ct
      cranio-nb inspect skull.nrrd --mask --json
    """
    from ..evaluation.paper_tables import measure_opening
    from ..output.design_folder import load_record
    from ..stages.segmentation import bone_of
    from ..vault.opening_search import find_openings
    from .console import print_json, print_load, print_openings, progress_bar

    with progress_bar() as tell:
        volume, load = read_ct(scan, mask=mask or None, allow=allow, progress=lambda i, n: tell("reading", i / n))
    problem: CranioError | None = None
    sizes: list[OpeningSize] = []
    try:
        sizes = [measure_opening(one) for one in find_openings(bone_of(volume, threshold))]
    except CranioError as error:
        problem = error
    if as_json:
        print_json({"load": load_record(load), "openings": sizes, "problem": problem and problem.code})
    else:
        print_load(load)
        print_openings(sizes)
    if problem:
        raise problem


@main.command()
@click.argument("patch", type=_PATH)
@click.argument("truth", type=_PATH)
@click.option("--skull", type=_PATH, required=True, help="Skull with the hole: bone mask, or a CT.")
@_threshold
@_json
@_debug
def score(patch: Path, truth: Path, skull: Path, threshold: float | None, as_json: bool) -> None:
    """Measure a patch against the true one; all three on one grid.

    \b
    Examples:
      cranio-nb score out/patch.nii.gz case1/truth.nii.gz --skull case1/ct
      cranio-nb score patch.nrrd truth.nrrd --skull skull.nrrd --json
    """
    from ..evaluation import scores
    from ..stages.segmentation import bone_of
    from .console import print_json, print_table

    (made, _), (true, _), (scan, _) = read_ct(patch, mask=True), read_ct(truth, mask=True), read_ct(skull)
    found = dataclasses.asdict(scores.score(made, true, bone_of(scan, threshold)))
    if as_json:
        print_json(found)
        return
    units = {"hd95": "mm", "assd": "mm", "rmse": "mm", "overlap": "voxels"}
    print_table("", ("Measure", "Value", "Unit"), [(k, f"{v:.4g}", units.get(k, "")) for k, v in found.items()])


@main.command()
@_debug
def doctor() -> None:
    """Check this machine: versions, packages, memory, drawing.

    One line for each, with its remedy. The exit code is 1 if something needed is missing.

    \b
    Example:
      cranio-nb doctor
    """
    from .doctor import examine

    bad = False
    for check in examine():
        bad = bad or check.state == "missing"
        line = f"{check.state:8} {check.name}: {check.found}"
        click.echo(f"{line}. {check.remedy}" if check.remedy else line)
    if bad:
        raise click.exceptions.Exit(1)


def _options(method: str, params: Path | None) -> dict[str, Any]:
    """Options from a JSON file, checked against what the method has."""
    if params is None:
        return {}
    try:
        options = json.loads(params.read_text(encoding="utf-8"))
        if not isinstance(options, dict):
            raise ValueError
        check_options(method, options)
    except (OSError, ValueError) as error:
        why = str(error) if isinstance(error, InputRefused) else "it is not a readable JSON file of {name: value, ...}."
        raise click.BadParameter(why, param_hint="--params") from None
    return options


def _planes(opening: str | None) -> tuple[int, int] | None:
    """First and last plane of ``A:B``."""
    if opening is None:
        return None
    try:
        first, last = (int(part) for part in opening.split(":"))
    except ValueError:
        raise click.BadParameter("two plane numbers A:B are wanted.", param_hint="--planes") from None
    return first, last


def _check_case_folder(out: Path) -> None:
    """Refuse a folder with a series that no earlier case of ours can have left: it would be replaced."""
    if (out / "ct").exists() and not (out / "truth.json").is_file():
        message = "The output folder holds a folder named ct that was not written by this command."
        raise CannotWrite("CannotWrite", message, "Name another folder.")


def _cut(source: Path, defect: str, seed: int, allow: tuple[str, ...]) -> Case:
    """A hole in a given intact scan or mask."""
    from data_synth import cut_case

    scan, load = read_ct(source, allow=allow)
    try:
        return cut_case(scan.voxels, scan.affine, defect, seed, is_mask=load.kind == "mask")
    except ValueError as error:
        raise InputRefused("CannotCut", str(error)) from error

"""Draw the picture of the README again: `python docs/make_pictures.py`. All that it shows is synthetic."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import NDArray

from cranio_nb.drawing import figures
from cranio_nb.drawing.coarse_skull import skull_surface
from cranio_nb.mesh import Mesh
from cranio_nb.methods.slicewise.slices import SlicedDesign
from cranio_nb.pipeline.preparation import prepare
from cranio_nb.pipeline.run import RunResult, run_design
from data_synth import head_case
from data_synth.files import write_case

OUT = Path(__file__).parent / "img" / "result.png"
NOTHING = Mesh(np.zeros((0, 3)), np.zeros((0, 3), np.intp))
PX = 0.5  # mm
VIEW = np.array([1.0, -0.35, 0.15])  # from the left and a little from the front


def main() -> None:
    """Design what `cranio-nb demo` designs, and draw skull, prosthesis and one slice side by side."""
    with TemporaryDirectory() as folder:
        write_case(Path(folder), head_case("face", "full", "unilateral", 0))
        result = run_design(prepare(Path(folder) / "ct"))
    OUT.parent.mkdir(exist_ok=True)
    OUT.write_bytes(figures.png(side_by_side([*views(result), middle_slice(result)])))


def views(result: RunResult) -> list[Figure]:
    """The skull with its opening, and closed."""
    skull = skull_surface(result.case.bone)
    return [figures.view_figure(skull, mesh, VIEW, px_mm=PX) for mesh in (NOTHING, result.prosthesis.mesh)]


def middle_slice(result: RunResult) -> Figure:
    """The middle slice, with the boundaries, their ends and tangents, the curves and the patch."""
    sliced = next(part for part in result.prosthesis.working if isinstance(part, SlicedDesign))
    one = sliced.slices[len(sliced.slices) // 2]
    return figures.slice_figure(sliced, one, result.case.bone, result.prosthesis.patch)


def side_by_side(parts: list[Figure]) -> Figure:
    """Finished figures in a row, each in the middle of its height."""
    pictures = [pixels(figure) for figure in parts]
    height = max(len(picture) for picture in pictures)
    row = np.concatenate([centred(picture, height) for picture in pictures], axis=1)
    figure, ax = figures.new_figure(row.shape[1] / figures.DPI, height / figures.DPI)
    ax.imshow(row, interpolation="nearest", aspect="auto")
    return figure


def pixels(figure: Figure) -> NDArray[np.uint8]:
    """What a figure shows, shape (H, W, 3)."""
    figure.canvas.draw()
    return np.asarray(figure.canvas.buffer_rgba())[..., :3]  # type: ignore[attr-defined]


def centred(picture: NDArray[np.uint8], height: int) -> NDArray[np.uint8]:
    """A picture with white above and below."""
    spare = height - len(picture)
    return np.pad(picture, ((spare // 2, spare - spare // 2), (0, 0), (0, 0)), constant_values=255)


if __name__ == "__main__":
    main()

"""One piece of work for `speed.py`, alone in its process: python speed_tasks.py TASK [ARGUMENT ...].

Prints what it measured inside as JSON. Each task loads what it works with itself, so that none pays for another's.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

Figures = dict[str, float]
_PASSES = 3  # of what takes milliseconds: the fastest counts
_N_SLICES, _N_STEPS, _N_SNAXELS = 23, 200, 41


def read_ours(ct: str) -> Figures:
    """Our reader."""
    from cranio_nb.readers import read_ct

    read_ct(ct)
    return {}


def read_sitk(ct: str) -> Figures:
    """SimpleITK's reader."""
    _read_sitk(ct)
    return {}


def segment_sitk(ct: str) -> Figures:
    """What is compared with: SimpleITK reads, takes a threshold, keeps the largest component and fills its holes."""
    import SimpleITK as sitk

    bone = sitk.BinaryThreshold(_read_sitk(ct), 400, 32767)
    skull = sitk.RelabelComponent(sitk.ConnectedComponent(bone)) == 1
    filled = sitk.BinaryFillhole(skull)  # a view does not keep its image alive
    return {"voxels": float(sitk.GetArrayViewFromImage(filled).sum())}


def _read_sitk(ct: str) -> Any:
    import SimpleITK as sitk

    reader = sitk.ImageSeriesReader()
    reader.SetFileNames(reader.GetGDCMSeriesFileNames(ct))
    return reader.Execute()


def read_raw(ct: str) -> Figures:
    """The bytes of the files, and a copy of as many: no program that reads them can be faster."""
    import numpy as np

    timed = Timed()
    data = b"".join(path.read_bytes() for path in sorted(Path(ct).iterdir()))
    timed.lap("files")
    np.frombuffer(data, np.uint8).copy()
    timed.lap("copy")
    return timed.seconds


def checked_stl(ct: str, method: str, out: str) -> Figures:
    """From files to a checked STL in one process, through the package's face."""
    import cranio_nb as cn
    from cranio_nb.output.mesh_files import write_mesh

    scan, _ = cn.read_ct(ct)
    bone = cn.segment(scan)
    made = cn.design(bone, scan=scan, method=method)
    report = cn.check_mesh(made.mesh)
    write_mesh(made.mesh, Path(out) / "prosthesis.stl", n_parts=report.n_parts, report=report)
    return {}


def stages(source: str, method: str, out: str) -> Figures:
    """A design stage by stage, all files but the report; then the report, which is drawn but not written."""
    timed = Timed()
    from cranio_nb.output import files
    from cranio_nb.output.design_folder import design_record
    from cranio_nb.output.mesh_files import write_mesh
    from cranio_nb.output.nifti_files import write_nifti
    from cranio_nb.pipeline.preparation import prepare
    from cranio_nb.pipeline.run import run_design

    timed.lap("imports")
    case = prepare(source, mask=True if source.endswith(".nrrd") else None)
    result = run_design(case, method=method)
    timed.take(result.seconds)
    write_mesh(result.prosthesis.mesh, Path(out) / "prosthesis.stl", n_parts=result.mesh.n_parts, report=result.mesh)
    timed.lap("mesh file")
    assert result.prosthesis.patch is not None
    write_nifti(result.prosthesis.patch, Path(out) / "patch.nii.gz", case.load.order)
    timed.lap("voxel file")
    files.write_json(Path(out) / "design.json", design_record(result))
    timed.lap("record")
    without = sum(timed.seconds.values())
    from cranio_nb.output.design_page import measure_shots, report_page
    from cranio_nb.output.design_pictures import patch_shots, skull_views, surface_shots

    surface = surface_shots(case, skull_views(case), result.prosthesis)
    report_page(result, patch_shots(case, result.prosthesis) | surface | measure_shots(result))
    timed.lap("report")
    return timed.seconds | {"without report": without}


def balloons() -> Figures:
    """All curves of a lesion of 23 slices, equally many steps: ours, active_contour, and the scheme written densely."""
    import numpy as np
    from skimage.segmentation import active_contour

    from cranio_nb.stages.deformable_model import inflate

    start, slopes = _curves()
    still = {"tol": 0.0, "max_iter": _N_STEPS}  # nothing stops before the last step
    ours_s, made = fastest(lambda: inflate(start, slopes, **still))
    image = np.zeros((int(start.max()) + 20,) * 2)
    snake = {"alpha": 1.0, "beta": 1.0, "gamma": 1.0, "max_num_iter": _N_STEPS, "convergence": 0.0}
    rival_s, _ = fastest(
        lambda: [active_contour(image, curve + 5, boundary_condition="fixed", **snake) for curve in start], passes=1
    )
    apart = np.abs(made.curve - dense(start, slopes, _N_STEPS)).max()
    return {"ours": ours_s, "active_contour": rival_s, "from_dense_px": float(apart)}


def _curves() -> tuple[Any, Any]:
    """Start curves of 23 gaps of 60 to 150 px, outer and inner, and their end slopes per snaxel."""
    import numpy as np

    from cranio_nb.curves import cubic

    length = np.linspace(60, 150, _N_SLICES).repeat(2)
    theta = np.tile(np.radians([22.0, 15.0]), _N_SLICES)
    ends = np.stack([np.stack([length, sign * length * np.tan(theta)], axis=-1) for sign in (1, -1)], axis=-2)
    return cubic(length, theta, np.pi - theta, _N_SNAXELS), ends / (_N_SNAXELS - 1)


def dense(start: Any, slopes: Any, n_steps: int, *, pressure: float = 0.062) -> Any:
    """Equations (1) and (2) with full matrices, curve by curve: slow, and plain enough to be believed."""
    import numpy as np

    from cranio_nb.curves import normals

    # second and fourth differences at the free snaxels, from all snaxels and a ghost node beyond either end
    n = start.shape[1]
    second, fourth = np.zeros((2, n - 2, n + 2))
    for row in range(n - 2):
        second[row, row + 1 : row + 4] = -1, 2, -1
        fourth[row, row : row + 5] = 1, -4, 6, -4, 1
    # the ghosts by the slopes: c(-1) = c(1) - 2 c'(0), c(n) = c(n - 2) + 2 c'(n - 1)
    mirror = np.zeros((n + 2, n))
    mirror[1:-1] = np.eye(n)
    mirror[0, 1] = mirror[-1, -2] = 1
    force = second + fourth
    system = np.eye(n - 2) + (force @ mirror)[:, 1:-1]
    out = start.copy()
    for curve, (first, last) in zip(out, slopes, strict=True):
        ends = (force @ mirror)[:, [0, -1]] @ curve[[0, -1]] + force[:, [0, -1]] @ np.stack([-2 * first, 2 * last])
        for _ in range(n_steps):
            curve[1:-1] = np.linalg.solve(system, curve[1:-1] + pressure * normals(curve[None])[0, 1:-1] - ends)
    return out


def surfaces(mask: str) -> Figures:
    """The surface of one patch: ours, plain and smooth, those of skimage and of VTK."""
    import numpy as np
    from skimage.measure import marching_cubes

    from cranio_nb.readers import read_ct
    from cranio_nb.stages.surface_reconstruction import extract_surface

    patch = read_ct(mask, mask=True)[0]
    part = np.pad(patch.voxels[patch.box()], 1).astype(np.float32)
    return {
        "ours, smooth": fastest(lambda: extract_surface(patch))[0],
        "ours, plain": fastest(lambda: extract_surface(patch, smooth=False))[0],
        "skimage, Lorensen": fastest(lambda: marching_cubes(part, 0.5, method="lorensen"))[0],
        "skimage, Lewiner": fastest(lambda: marching_cubes(part, 0.5))[0],
    } | _vtk_surfaces(part)


def _vtk_surfaces(part: Any) -> Figures:
    """Flying edges and constrained surface nets; nothing where VTK is not installed."""
    try:  # what it takes alone, not what draws with it
        from vtkmodules.util.numpy_support import numpy_to_vtk  # noqa: TID251
        from vtkmodules.vtkCommonDataModel import vtkImageData  # noqa: TID251
        from vtkmodules.vtkFiltersCore import vtkFlyingEdges3D, vtkSurfaceNets3D  # noqa: TID251
    except ModuleNotFoundError:
        return {}
    image = vtkImageData()
    image.SetDimensions(*part.shape[::-1])
    image.GetPointData().SetScalars(numpy_to_vtk(part.ravel(), deep=True))

    def run(filter_: Any) -> None:
        filter_.SetInputData(image)
        filter_.SetValue(0, 0.5 if isinstance(filter_, vtkFlyingEdges3D) else 1)
        filter_.Update()

    return {
        "VTK, flying edges": fastest(lambda: run(vtkFlyingEdges3D()))[0],
        "VTK, surface nets": fastest(lambda: run(vtkSurfaceNets3D()))[0],
    }


class Timed:
    """Seconds of one step after another."""

    def __init__(self) -> None:
        self.seconds: Figures = {}
        self._last = time.perf_counter()

    def lap(self, name: str) -> None:
        """End a step."""
        self.take({name: time.perf_counter() - self._last})

    def take(self, seconds: Figures) -> None:
        """Steps that were measured elsewhere since the last one."""
        self.seconds |= seconds
        self._last = time.perf_counter()


def fastest(work: Callable[[], Any], passes: int = _PASSES) -> tuple[float, Any]:
    """Seconds of the fastest of some passes, and what the last one gave."""
    found = []
    for _ in range(passes):
        began = time.perf_counter()
        made = work()
        found.append(time.perf_counter() - began)
    return min(found), made


TASKS: dict[str, Callable[..., Figures]] = {
    task.__name__: task
    for task in (read_ours, read_sitk, segment_sitk, read_raw, checked_stl, stages, balloons, surfaces)
}


if __name__ == "__main__":
    print(json.dumps(TASKS[sys.argv[1]](*sys.argv[2:])))

"""From a head CT with a hole in the skull to the prosthesis that closes it.

For teaching and research. Not a medical device, not for clinical use.

>>> import cranio_nb as cn
>>> from data_synth import phantom_case
>>> case = phantom_case("tiny", "unilateral", 0)  # a synthetic head; `cn.read_ct("head_ct")` reads your own
>>> ct, truth = cn.Volume(case.hu, case.affine), cn.Volume(case.implant, case.affine)
>>> bone = cn.segment(ct, threshold=400)
>>> openings = cn.find_openings(bone)  # largest first
>>> made = cn.design(bone, openings, method="thin-plate")
>>> cn.check_mesh(made.mesh).sound, cn.score(made.patch, truth, bone).dice > 0.9
(True, True)
>>> [path.name for path in cn.save(made, "out")]  # all files or none
['prosthesis.stl', 'patch.nii.gz', 'design.json']

Names are loaded when they are first used. The folders, each of which imports only what stands above it here:

===============  =====================================================================================================
the files here   the nouns: `errors`, `grid`, `volume`, `mesh`, `curves`, `opening`, `prosthesis`
`options`        what may be given for an option: meaning, range, unit
`geometry`       work on triangle meshes; robust fits
`readers`        scan on disk -> CT in HU
`stages`         the paper's five: `segmentation`, `feature_extraction`, `deformable_model`, `prosthesis_volume`,
                 `surface_reconstruction`
`vault`          the skull seen from inside along rays, which real skulls need beyond the paper
`prior`          what intact skulls let one predict
`methods`        the paper's method and its rivals; `design` runs any of them, own ones too
`evaluation`     against the truth, at the rim, the paper's tables
`implant`        what a workshop asks
`drawing`        pictures and 3-D scenes
`pipeline`       scan -> design, trial, comparison
`output`         files and pages
`study`          cases x methods x parameters, on one machine or many
`teaching`       lessons, panels, exercises
`cli`            the command line
===============  =====================================================================================================

Frames. Conversions happen only in `Volume`, in `ChordFrame` and in the frames of `vault.slicing`.

=====  ===================  =====  ==========================================================================
voxel  (plane, row, col)    index  planes rise to the top of the head, rows to the back, columns to the left
slice  (row, col)           px     of a plane of the scan; mm in a plane of `vault.slicing`
chord  (along, out)         px     along the line between the two ends of a gap, and out of the head
world  (x, y, z)            mm     DICOM LPS: x to the patient's left, y to the back, z to the top of the head
=====  ===================  =====  ==========================================================================
"""

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_HOMES = {
    "Volume": "volume",
    "Mesh": "mesh",
    "Opening": "opening",
    "Prosthesis": "prosthesis",
    "CranioError": "errors",
    "read_ct": "readers",
    "segment": "stages.segmentation",
    "find_openings": "vault.opening_search",
    "survey_openings": "vault.opening_search",
    "design": "methods.design",
    "add_method": "methods.catalogue",
    "Piece": "methods.piece",
    "check_mesh": "geometry.mesh_check",
    "score": "evaluation.scores",
    "run_design": "pipeline.run",
    "prepare": "pipeline.preparation",
    "compare": "pipeline.compare",
    "show": "drawing.scene3d",
    "save": "output.design_folder",
}

__all__ = ["__version__", *_HOMES]


def __getattr__(name: str) -> Any:
    """A name of the package's face, from the module it lives in."""
    if name not in _HOMES:
        raise AttributeError(f"module 'cranio_nb' has no attribute {name!r}; it has {', '.join(_HOMES)}")
    return getattr(import_module(f".{_HOMES[name]}", __name__), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *_HOMES})

"""cranio_nb: from a head CT with a hole in the skull to the prosthesis that closes it.

For teaching and research. Not a medical device, not for clinical use.

The rooms, from the ground up; imports go down only, and rooms on one floor do not import each other unless said so.

========  ====================================================================================================
Nouns     `volume` voxels and where they stand; `curves` plane curves, gap ends, the chord frame; `mesh`
          triangles; `maps` numbers over rays; `prosthesis` opening, prosthesis, a row of Table 3; `errors` one sentence
          and a remedy
Stages    `readers` scan -> CT; `segment` CT -> bone; `opening` bone -> openings; `features` slice -> gap ends;
          `balloon` gap ends -> curves; `fill` curves -> patch; `surface` patch -> mesh; `evaluate` patch and
          truth -> measures; `fit` and `implant` prosthesis -> what a workshop asks; `export` -> files
Vault     `casting` rays from inside the head; `chart` the vault as radius maps; `symmetry` its symmetry plane; `rays`
          gap ends for real skulls; `slicing` planes to cut along
Learned   `headframe` lays a skull on the mean head; `vaultmap` radius maps on it, and `prior` what those of
          intact skulls tell about the bone in a hole (both see the vault); `prior_file` keeps it
Geometry  `nearest`, `crossings`, `mesh_check`: work on triangle meshes that stages share; `tetrahedra` mask -> mesh,
          `solid` mesh -> voxels, `membrane` rim -> flat fill; `sheet` and `sheet_motion` elastic surfaces
Methods   `methods.slicewise` the paper; `hull`, `reflection`, `you`, `thin_plate`, `dnurbs` its rivals; every method
          is `design(bone, openings, *, options) -> Prosthesis`, which `assembly` puts together from a patch, and
          `catalogue` knows them by name
Outside   `run` the pipeline as one call; `trial` a method in a process of its own; `truth`, `compare` methods against
          the missing bone and each other; `tables`, `render`, `plot`, `report`, `compare_page`, `outputs`, `console`,
          `doctor`, `prior_study`, `cli`. Only `plot` imports matplotlib
========  ====================================================================================================

Data's way: scan -> CT -> bone -> opening -> [slice: gap ends -> balloon -> fill] -> patch -> mesh -> `Prosthesis`.

Frames. Conversions happen only in `Volume`, in `ChordFrame` and in the frames of `slicing`.

=====  ===================  =====  ==========================================================================
voxel  (plane, row, col)    index  planes rise to the top of the head, rows to the back, columns to the left
slice  (row, col)           px     of a plane of the scan; mm in a plane of `slicing`
chord  (along, out)         px     along the line between the two ends of a gap, and out of the head
world  (x, y, z)            mm     DICOM LPS: x to the patient's left, y to the back, z to the top of the head
=====  ===================  =====  ==========================================================================
"""

from .readers import read_ct

__all__ = ["__version__", "read_ct"]
__version__ = "0.1.0"

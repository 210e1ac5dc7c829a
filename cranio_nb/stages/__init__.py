"""The paper's five stages, in its own order and by its own names. None imports another.

1. `segmentation`            CT in HU -> bone mask
2. `feature_extraction`      slice of bone -> the ends of its gap, with tangents (`GapEnds`)
3. `deformable_model`        gap ends -> the curve of the prosthesis across it (`Balloon`), outer and inner
4. `prosthesis_volume`       two curves -> the patch of the slice; slice upon slice, a volume
5. `surface_reconstruction`  patch -> closed triangle mesh

All five, on a skull that is a ring of bone, 60 to 75 px from its middle, with a gap of 40 degrees:

>>> import numpy as np
>>> from cranio_nb.curves import ChordFrame, cubic
>>> from cranio_nb.geometry.mesh_check import check_mesh
>>> from cranio_nb.stages.deformable_model import inflate, tangent_pressure
>>> from cranio_nb.stages.feature_extraction import extract_features, find_gap_ends
>>> from cranio_nb.stages.prosthesis_volume import fill_gap
>>> from cranio_nb.stages.segmentation import segment
>>> from cranio_nb.stages.surface_reconstruction import extract_surface
>>> from cranio_nb.volume import Volume
>>> row, col = np.indices((201, 201)) - 100.0
>>> ring = (np.hypot(row, col) >= 60) & (np.hypot(row, col) <= 75)
>>> gap = ring & (abs(np.degrees(np.arctan2(col, -row))) < 20)
>>> ct = Volume(np.stack([np.where(ring & ~gap, 900, -1000)] * 4), np.eye(4))

>>> bone = segment(ct)
>>> ends = find_gap_ends(extract_features(bone.voxels[1]), skip_px=3, reach_px=10)
>>> curves = []
>>> for pair in ends:  # outer, inner
...     frame = ChordFrame.of(pair, inside=(100, 100))
...     angles = frame.end_angles(pair)
...     start = cubic(frame.length, *angles, 21)
...     slopes = frame.length / 20 * np.array([[1, np.tan(angle)] for angle in angles])
...     balloon = inflate(start, slopes, pressure=tangent_pressure(frame.length, *angles, 21))
...     curves.append(frame.to_slice(balloon.curve))
>>> patch = fill_gap(*curves, bone.voxels[1])
>>> mesh = extract_surface(bone.with_voxels(np.stack([patch] * 4)))

The patch is the missing bone, and its surface is closed:

>>> bool(2 * (patch & gap).sum() / (patch.sum() + gap.sum()) > 0.95), check_mesh(mesh).sound
(True, True)
"""

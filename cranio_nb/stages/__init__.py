"""The paper's five stages, in its own order and by its own names. None imports another.

1. `segmentation`            CT in HU -> bone mask
2. `feature_extraction`      slice of bone -> the ends of its gap, with tangents (`GapEnds`)
3. `deformable_model`        gap ends -> the balloon at rest, outer and inner curve (`Balloon`)
4. `prosthesis_volume`       two curves -> the patch of the slice, slice upon slice a volume
5. `surface_reconstruction`  patch -> closed triangle mesh, its faces told apart as outer, inner and rim
"""

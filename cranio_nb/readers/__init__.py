"""Readers: a DICOM folder, a NIfTI or a NRRD file -> `Volume` in HU (or a bone mask) and a `LoadReport`.

1. `read`                  path -> DICOM, NIfTI or NRRD; every fault becomes one sentence
2. `dicom`                 a folder of DICOM files, headers first, then a plan, then the pixels
3. `image_file`            a NIfTI (`nifti`) or NRRD (`nrrd`) file, both by way of a `stored_image`
4. `hu_checks`, `regrid`   for all of them: are these HU of a head; sheared or uneven slices made even
5. `load_report`           what was found, chosen, left and corrected

All end in the package's own axes (planes up, rows back, columns left) and in LPS mm.
"""

from .load_report import Finding, LoadReport, warnings_of
from .read import ALLOWANCES, read_ct

__all__ = ["ALLOWANCES", "Finding", "LoadReport", "read_ct", "warnings_of"]

"""Readers: a DICOM folder, a NIfTI or a NRRD file -> `Volume` in HU (or a bone mask) and a `LoadReport`.

Headers first, then a plan, then the pixels: `dicom_files`, `dicom_scan`, `dicom_headers`, `dicom_series`,
`dicom_slices`, `dicom_geometry`, `dicom_steps`, `dicom_pixels` (`dicom_codecs`, `dicom_rescale`), put together in
`dicom`; `images` with `nifti_file` and `nrrd_file`; `regrid` and `plausible` serve both. All end in the package's own
axes (planes up, rows back, columns left) and in LPS mm.
"""

from .load_report import Finding, LoadReport
from .read import ALLOWANCES, read_ct

__all__ = ["ALLOWANCES", "Finding", "LoadReport", "read_ct"]

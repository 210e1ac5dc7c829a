"""Readers: a DICOM folder, a NIfTI or a NRRD file -> `Volume` in HU (or a bone mask) and a `LoadReport`."""

from .read import ALLOWANCES, read_ct
from .report import Finding, LoadReport

__all__ = ["ALLOWANCES", "Finding", "LoadReport", "read_ct"]

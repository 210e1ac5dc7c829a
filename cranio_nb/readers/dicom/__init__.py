"""A folder of DICOM files -> one CT in HU, slice by slice checked."""

"""Names of kernels, as the makers give them, and names that are none."""

import pytest

from cranio_nb.readers.dicom.kernel import describe_kernel


@pytest.mark.parametrize("name", ["BONE", "BONEPLUS", "Lung", "H70h", "Hr64", "FC30", "FC81"])
def test_kernels_for_edges_are_sharp(name: str) -> None:
    assert describe_kernel(name) == "sharp"


@pytest.mark.parametrize("name", ["STANDARD", "Soft", "H31s", "J40s", "Hr40", "FC21", "UB"])
def test_kernels_for_soft_tissue_are_soft(name: str) -> None:
    assert describe_kernel(name) == "soft"


@pytest.mark.parametrize("name", ["", "DOE^JOHN", "19700101", "H"])
def test_what_is_no_name_of_a_kernel_is_not_repeated(name: str) -> None:
    assert describe_kernel(name) == "unknown"

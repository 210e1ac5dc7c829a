"""Whatever is raised while a file is parsed becomes one refusal that names the file by its index alone."""

import warnings

import pytest

from cranio_nb.errors import InputRefused
from cranio_nb.readers.dicom.file_refusals import corrupt, over_limit, refusing


@pytest.mark.parametrize("error", [ValueError("SECRET"), KeyError("SECRET"), RecursionError("SECRET")])
def test_any_error_becomes_a_refusal_without_its_words(error: Exception) -> None:
    with pytest.raises(InputRefused) as caught, refusing(7):
        raise error
    assert caught.value.code == "CorruptDicom"
    assert "DICOM file 7 " in str(caught.value) and "SECRET" not in str(caught.value)


def test_a_refusal_stays_as_it_is() -> None:
    refusal = over_limit(3, "rows", 5000, 4096)
    with pytest.raises(InputRefused) as caught, refusing(7):
        raise refusal
    assert caught.value is refusal and refusal.code == "LimitExceeded"


def test_odd_values_warn_nobody_while_a_file_is_parsed() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with refusing(0):
            warnings.warn("odd value", stacklevel=1)


def test_the_code_of_a_damaged_file_may_be_given() -> None:
    assert corrupt(1, "is cut short").code == "CorruptDicom"
    assert corrupt(1, "is cut short", "CorruptPixelData").code == "CorruptPixelData"

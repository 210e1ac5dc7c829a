"""Values of elements: those of pydicom, however often the files before said the same."""

import io

import numpy as np
import pytest
from pydicom import dcmread
from pydicom.dataset import Dataset, FileMetaDataset
from pydicom.uid import ExplicitVRBigEndian, ExplicitVRLittleEndian, ImplicitVRLittleEndian

from cranio_nb.readers.dicom.elements import Converted, Elements


def read_back(syntax=ExplicitVRLittleEndian, **elements):
    """A data set as it is read from a file, its elements not yet converted."""
    written = Dataset()
    for keyword, value in elements.items():
        setattr(written, keyword, value)
    written.file_meta = FileMetaDataset()
    written.file_meta.TransferSyntaxUID = syntax
    written.file_meta.MediaStorageSOPClassUID, written.file_meta.MediaStorageSOPInstanceUID = "1.2", "1.2.3"
    stream = io.BytesIO()
    written.save_as(stream, enforce_file_format=True)
    stream.seek(0)
    return dcmread(stream)


@pytest.mark.parametrize("syntax", [ExplicitVRLittleEndian, ExplicitVRBigEndian, ImplicitVRLittleEndian])
def test_values_are_those_of_the_file_not_of_the_one_before(syntax):
    converted: Converted = {}
    for slope, rows, name in ((1.0, 512, "A"), (1.0, 512, "A"), (2.5, 256, "B"), (1.0, 512, "B")):
        one = Elements(
            read_back(syntax, RescaleSlope=slope, Rows=rows, Modality=name, PixelSpacing=[slope, 1]), converted
        )
        assert (one.number("RescaleSlope"), one.integer("Rows"), one.text("Modality")) == (slope, rows, name)
        np.testing.assert_array_equal(one.vector("PixelSpacing", 2), [slope, 1])


def test_the_same_bytes_in_another_order_or_alphabet_are_another_value():
    converted: Converted = {}
    little, big = (read_back(syntax, Rows=258) for syntax in (ExplicitVRLittleEndian, ExplicitVRBigEndian))
    swapped = read_back(ExplicitVRBigEndian, Rows=513)  # 0x0201, the bytes of 258 = 0x0102 turned round
    assert [Elements(one, converted).integer("Rows") for one in (little, big, swapped, little)] == [258, 258, 513, 258]
    texts = [
        Elements(read_back(SpecificCharacterSet=charset, PatientName=name), converted).text("PatientName")
        for charset, name in (("ISO_IR 100", "Ä"), ("ISO_IR 144", "Ф"), ("ISO_IR 100", "Ä"))
    ]
    assert texts == ["Ä", "Ф", "Ä"]


def test_a_padding_value_goes_by_the_sign_of_its_own_file():
    converted: Converted = {}
    for signed, value in ((0, 63536), (1, -2000), (0, 63536)):
        one = read_back(ImplicitVRLittleEndian, PixelRepresentation=signed, PixelPaddingValue=value)
        assert Elements(one, converted).number("PixelPaddingValue") == value


def test_what_is_not_of_its_kind_is_no_number_again_and_again():
    converted: Converted = {}
    for _ in range(2):
        one = read_back(Rows=4)
        one["RescaleSlope"] = one["Rows"].__class__(0x00281053, "LO", "steep")
        assert np.isnan(Elements(one, converted).number("RescaleSlope"))
    assert Elements(read_back(Rows=4), converted).number("RescaleSlope") is None


def test_a_keyword_that_there_is_not_is_a_mistake_of_the_program():
    with pytest.raises(KeyError, match="Slope"):
        Elements(read_back(Rows=4)).number("Slope")


def test_items_of_sequences_have_their_own_values():
    item, other = Dataset(), Dataset()
    item.RescaleSlope, other.RescaleSlope = 2, 3
    one = Elements(read_back(RescaleSlope=1, SharedFunctionalGroupsSequence=[item, other]), {})
    assert [each.number("RescaleSlope") for each in one.items("SharedFunctionalGroupsSequence")] == [2, 3]
    assert one.first("SharedFunctionalGroupsSequence").number("RescaleSlope") == 2
    assert one.number("RescaleSlope") == 1 and one.first("PlanePositionSequence") is None

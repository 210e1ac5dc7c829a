"""The elements of a data set -> their values as plain numbers and texts.

An absent value is None or an empty text, a value that is not of its kind is NaN. What one file says as the file
before it is not converted again: most of a series says the same in every slice.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydicom.datadict import tag_for_keyword
from pydicom.dataelem import RawDataElement
from pydicom.dataset import Dataset

Vector = NDArray[np.float64]
Converted = dict[str, tuple[tuple[Any, ...], Any]]
"""Keyword -> what the last file said, and its value."""
_LONGEST = 128  # bytes of an element that is compared with the one before it
_BY_OTHERS = frozenset({"PixelPaddingValue", "PixelPaddingRangeLimit"})  # their kind hangs on another element


class Elements:
    """The elements of a data set, by their keywords.

    Parameters
    ----------
    dataset : Dataset
        From `parse.parse_file`, or an item of a sequence in it.
    converted : dict, optional
        What other files of the series said; this one is entered.

    Examples
    --------
    >>> dataset = Dataset()
    >>> dataset.Modality, dataset.PixelSpacing, dataset.Rows = "CT", [0.5, 0.5], 512
    >>> elements = Elements(dataset)
    >>> elements.text("Modality"), elements.vector("PixelSpacing", 2), elements.integer("Rows")
    ('CT', array([0.5, 0.5]), 512)
    >>> elements.text("StudyID"), elements.number("RescaleSlope")
    ('', None)
    """

    def __init__(self, dataset: Dataset, converted: Converted | None = None) -> None:
        self._dataset, self._charset = dataset, str(dataset.original_character_set)
        self._converted = {} if converted is None else converted

    def __contains__(self, keyword_or_tag: Any) -> bool:
        return keyword_or_tag in self._dataset

    def first(self, keyword: str) -> Elements | None:
        """The first item of a sequence.

        Parameters
        ----------
        keyword : str

        Returns
        -------
        Elements or None
            None where there is none.
        """
        items = self._dataset.get(keyword)
        return Elements(items[0], self._converted) if items else None

    def items(self, keyword: str) -> list[Elements]:
        """All items of a sequence.

        Parameters
        ----------
        keyword : str

        Returns
        -------
        list of Elements
        """
        return [Elements(item, self._converted) for item in self._dataset.get(keyword) or ()]

    def value(self, keyword: str) -> Any:
        """An element's value as pydicom gives it.

        Parameters
        ----------
        keyword : str

        Returns
        -------
        Any
            None where absent or empty, NaN where its text is not of its kind.

        Raises
        ------
        KeyError
            For a keyword that DICOM does not know.
        """
        tag = tag_for_keyword(keyword)
        if tag is None:
            raise KeyError(keyword)
        try:
            value = self._read(keyword, tag)
        except Exception:
            # a value that cannot be converted, e.g. letters in a number
            return float("nan")
        return None if value is None or (isinstance(value, str) and not value.strip()) else value

    def _read(self, keyword: str, tag: int) -> Any:
        """The value, from the last file where that said the same in the same way."""
        raw = self._dataset.get_item(tag)
        if not isinstance(raw, RawDataElement) or keyword in _BY_OTHERS or raw.VR == "SQ" or raw.length > _LONGEST:
            return self._dataset.get(keyword)
        said = (raw.VR, raw.value, raw.is_implicit_VR, raw.is_little_endian, self._charset)
        before = self._converted.get(keyword)
        if before is None or before[0] != said:
            before = self._converted[keyword] = (said, self._dataset.get(keyword))
        return before[1]

    def text(self, keyword: str) -> str:
        """An element's text.

        Parameters
        ----------
        keyword : str

        Returns
        -------
        str
            Empty where absent.
        """
        value = self.value(keyword)
        return "" if value is None else str(value).strip()

    def texts(self, keyword: str) -> tuple[str, ...]:
        """The texts of an element with several values, in capitals.

        Parameters
        ----------
        keyword : str

        Returns
        -------
        tuple of str
        """
        value = self.value(keyword)
        values = [] if value is None else [value] if isinstance(value, str | float) else value
        return tuple(str(v).strip().upper() for v in values)

    def number(self, keyword: str) -> float | None:
        """An element's number.

        Parameters
        ----------
        keyword : str

        Returns
        -------
        float or None
            NaN where it is not one number.
        """
        value = self.value(keyword)
        try:
            return None if value is None else float(value)
        except (TypeError, ValueError):
            return float("nan")

    def integer(self, keyword: str) -> int | None:
        """An element's whole number.

        Parameters
        ----------
        keyword : str

        Returns
        -------
        int or None
            None also where it is not one number.
        """
        value = self.number(keyword)
        return None if value is None or not np.isfinite(value) else int(value)

    def vector(self, keyword: str, count: int) -> Vector | None:
        """Several numbers of an element.

        Parameters
        ----------
        keyword : str
        count : int

        Returns
        -------
        ndarray, shape (count,), or None
            NaN where there are fewer, more, or other things.
        """
        value = self.value(keyword)
        if value is None:
            return None
        try:
            numbers = np.array([float(v) for v in value])
        except (TypeError, ValueError):
            numbers = np.array([])
        return numbers if numbers.shape == (count,) else np.full(count, np.nan)

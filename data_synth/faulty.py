"""Recipes of folders that a reader must refuse, or recover from and say so."""

from __future__ import annotations

import numpy as np
from pydicom import uid
from pydicom.dataset import Dataset

from .fault_edits import (
    add_phase,
    chain,
    compress,
    drop,
    edit_pixels,
    encode_jpeg,
    encode_jpeg_ls,
    encode_rle,
    give_own_series,
    give_table,
    make_enhanced,
    make_floats,
    move,
    move_far_away,
    repeat_slices,
    set_elements,
    shift_hu,
    stored_pixels,
)
from .fault_files import (
    add_file,
    claim_huge_element,
    cut_file,
    nested_sequences,
    patch_bytes,
    relabel_syntax,
)
from .fault_series import EVERY, SCREENSHOT, SHAPE, STEP_MM, Recipe, Slices, turned_axial


def faulty_recipes() -> dict[str, Recipe]:
    """Folders that must be refused, or recovered with a message."""
    return (
        _faulty_stacks()
        | _faulty_geometry()
        | _faulty_series()
        | _faulty_rescale()
        | _faulty_pixels()
        | _faulty_files()
    )


def _faulty_stacks() -> dict[str, Recipe]:
    n = SHAPE[0]
    uneven = tuple(np.concatenate([np.arange(10) * 1.5, 15 + np.arange(10) * 2.5]).tolist())
    return {
        "one slice missing": Recipe(edit=drop(9)),
        "two neighbours missing": Recipe(edit=drop(9, 10)),
        "second slice missing": Recipe(edit=drop(1)),
        "last but one missing": Recipe(edit=drop(n - 2)),
        "two apart missing": Recipe(edit=drop(5, 9)),
        "eight in a row missing": Recipe(edit=drop(*range(6, 14))),
        "every other missing": Recipe(edit=drop(*range(1, n, 2))),
        "one missing, no numbers": Recipe(edit=chain(drop(9), set_elements(EVERY, InstanceNumber=None))),
        "first slices missing": Recipe(edit=drop(0, 1, 2)),
        "a slice without pixels": Recipe(edit=set_elements(4, PixelData=None)),
        "a slice pushed sideways": Recipe(edit=move(7, (4.0, 0, 0))),
        "a slice on another's place": Recipe(edit=move(7, (0, 0, STEP_MM))),
        "a slice 0.3 mm off its place": Recipe(edit=move(7, (0, 0, 0.3))),
        "a slice far above": Recipe(edit=move(n - 1, (0, 0, 400.0))),
        "two steps in one stack": Recipe(heights=uneven),
        "tilted gantry": Recipe(orientation=turned_axial(-15, 0), direction=(0.0, 0.0, 1.0)),
        "tilt stated by its tag alone": Recipe(edit=set_elements(EVERY, GantryDetectorTilt=15)),
        "three slices": Recipe(edit=drop(*range(3, n))),
        "one slice": Recipe(edit=drop(*range(1, n))),
        "slices 8 mm apart": Recipe(heights=tuple(np.arange(n) * 8.0)),
    }


def _faulty_geometry() -> dict[str, Recipe]:
    recipes: dict[str, Recipe] = {}
    for where, at in (("", EVERY), (" in one", 3)):
        for name in ("ImagePositionPatient", "ImageOrientationPatient", "PixelSpacing"):
            recipes[f"no {name}{where}"] = Recipe(edit=set_elements(at, **{name: None}))
    recipes |= {
        "all at one place": Recipe(edit=set_elements(EVERY, ImagePositionPatient=[0, 0, 0])),
        "orientation of zeros": Recipe(edit=set_elements(EVERY, ImageOrientationPatient=[0] * 6)),
        "orientation not orthogonal": Recipe(edit=set_elements(EVERY, ImageOrientationPatient=[1, 0, 0, 0.1, 1, 0])),
        "orientation too long": Recipe(edit=set_elements(EVERY, ImageOrientationPatient=[1.1, 0, 0, 0, 1.1, 0])),
        "one slice flipped": Recipe(edit=set_elements(9, ImageOrientationPatient=[-1, 0, 0, 0, 1, 0])),
        "last five turned by 0.01": Recipe(
            edit=set_elements(slice(-5, None), ImageOrientationPatient=list(turned_axial(0.573, 2)))
        ),
        "spacing zero": Recipe(edit=set_elements(EVERY, PixelSpacing=[0, 0])),
        "spacing negative": Recipe(edit=set_elements(EVERY, PixelSpacing=[-0.9, 0.95])),
        "spacing of one number": Recipe(edit=set_elements(EVERY, PixelSpacing=[0.9])),
        "spacing in metres": Recipe(edit=set_elements(EVERY, PixelSpacing=[0.0009, 0.00095])),
        "two spacings": Recipe(edit=set_elements(slice(9, None), PixelSpacing=[0.45, 0.45])),
        "one slice of another spacing": Recipe(edit=set_elements(9, PixelSpacing=[0.5, 0.5])),
        "positions a kilometre away": Recipe(edit=move_far_away),
    }
    return recipes


def _faulty_series() -> dict[str, Recipe]:
    mr = {"Modality": "MR", "SOPClassUID": "1.2.840.10008.5.1.4.1.1.4"}
    recipes = {
        "MR": Recipe(edit=set_elements(EVERY, **mr)),
        "PET": Recipe(edit=set_elements(EVERY, Modality="PT", SOPClassUID="1.2.840.10008.5.1.4.1.1.128")),
        "radiographs": Recipe(edit=set_elements(EVERY, Modality="CR", SOPClassUID="1.2.840.10008.5.1.4.1.1.1")),
        "screenshots": Recipe(edit=set_elements(EVERY, SOPClassUID=SCREENSHOT)),
        "last four of another modality": Recipe(edit=set_elements(slice(-4, None), **mr)),
        "last six derived": Recipe(edit=set_elements(slice(-6, None), ImageType=["DERIVED", "SECONDARY", "AXIAL"])),
        "last four screenshots": Recipe(edit=set_elements(slice(-4, None), SOPClassUID=SCREENSHOT)),
        "two patients": Recipe(edit=set_elements(slice(0, 10), PatientID="SYNTHETIC-2", PatientName="Other^One")),
        "two frames of reference": Recipe(edit=set_elements(slice(0, 10), FrameOfReferenceUID="1.2.3.4")),
        "two phases": Recipe(edit=add_phase),
        "two other slices at their places": Recipe(edit=repeat_slices(range(5, 7), PixelData=bytes(2 * 44 * 48))),
        "two equal series": Recipe(edit=_equal_series),
        "top half in another series": Recipe(edit=set_elements(slice(10, None), SeriesInstanceUID="1.2.3.5")),
        "every slice its own series": Recipe(edit=give_own_series, recovered=True),
        "enhanced without positions": Recipe(edit=make_enhanced(lose="position")),
        "enhanced without rescale": Recipe(edit=make_enhanced(shared_rescale=False, lose="rescale")),
    }
    return recipes


def _equal_series(slices: Slices) -> None:
    repeat_slices(range(len(slices)), SeriesInstanceUID="1.2.3.6", SeriesNumber=3)(slices)
    edit_pixels(lambda p, k: p + 5, slice(SHAPE[0], None))(slices)


def _faulty_rescale() -> dict[str, Recipe]:
    gone = {"RescaleSlope": None, "RescaleIntercept": None}
    return {
        "no rescale, unsigned": Recipe(edit=set_elements(EVERY, **gone)),
        "rescale missing in one": Recipe(edit=set_elements(6, **gone)),
        "rescale missing in the last": Recipe(edit=set_elements(SHAPE[0] - 1, **gone)),
        "slope zero": Recipe(edit=set_elements(EVERY, RescaleSlope=0)),
        "slope zero in one": Recipe(edit=set_elements(6, RescaleSlope=0)),
        "slope negative": Recipe(edit=set_elements(EVERY, RescaleSlope=-1)),
        "slope huge": Recipe(edit=set_elements(EVERY, RescaleSlope="1e30")),
        "intercept huge": Recipe(edit=set_elements(EVERY, RescaleIntercept="1e9")),
        "intercept of one gone astray": Recipe(edit=set_elements(6, RescaleIntercept=0)),
        "air at 0": Recipe(edit=shift_hu(1000)),
        "air at -900": Recipe(edit=shift_hu(100)),
        "air at -2000": Recipe(edit=shift_hu(-1000)),
        "twice the HU": Recipe(edit=shift_hu(0, 2)),
        "inverted HU": Recipe(edit=shift_hu(0, -1)),
        "a table for HU": Recipe(edit=give_table),
    }


def _faulty_pixels() -> dict[str, Recipe]:
    return {
        "floating-point pixels": Recipe(edit=make_floats),
        "colours": Recipe(edit=set_elements(EVERY, SamplesPerPixel=3, PhotometricInterpretation="RGB")),
        "too few bits declared": Recipe(edit=set_elements(EVERY, BitsStored=10, HighBit=9)),
        "rows halved": Recipe(edit=set_elements(EVERY, Rows=SHAPE[1] // 2)),
        "a column less": Recipe(edit=set_elements(EVERY, Columns=SHAPE[2] - 1)),
        "a row more": Recipe(edit=set_elements(EVERY, Rows=SHAPE[1] + 1)),
        "a row more in one": Recipe(edit=set_elements(5, Rows=SHAPE[1] + 1)),
        "no rows": Recipe(edit=set_elements(EVERY, Rows=0)),
        "sides of 65535": Recipe(edit=set_elements(EVERY, Rows=65535, Columns=65535)),
        "2^31 frames": Recipe(edit=set_elements(EVERY, NumberOfFrames=2**31 - 1)),
        "labelled as JPEG-LS": Recipe(files=relabel_syntax(uid.JPEGLSLossless)),
        "of an unknown syntax": Recipe(files=relabel_syntax("1.2.840.10008.1.2.4.99")),
        "JPEG-LS cut inside": Recipe(edit=compress(lambda ds: encode_jpeg_ls(ds)[:-80]), syntax=uid.JPEGLSLossless),
        "JPEG cut inside": Recipe(edit=compress(lambda ds: encode_jpeg(ds)[:-80]), syntax=uid.JPEGLosslessSV1),
        "run length cut inside": Recipe(edit=compress(lambda ds: encode_rle(ds)[:-80]), syntax=uid.RLELossless),
        "of the size of another image": Recipe(edit=compress(_smaller), syntax=uid.JPEGLSLossless),
        "all air": Recipe(hu=lambda hu: np.full_like(hu, -1000)),
    }


def _smaller(ds: Dataset) -> bytes:
    import jpeg_ls

    return bytes(jpeg_ls.encode_array(np.ascontiguousarray(stored_pixels(ds)[::2, ::2])))


def _faulty_files() -> dict[str, Recipe]:
    last = SHAPE[0] - 1
    recipes = {
        "one byte short": Recipe(files=cut_file(5, 0.9999)),
        "cut in half": Recipe(files=cut_file(5, 0.5)),
        "cut in its header": Recipe(files=cut_file(5, 600)),
        "topmost cut in half": Recipe(files=cut_file(last, 0.5)),
        "topmost cut in its header": Recipe(files=cut_file(last, 500)),
        "topmost cut to 100 bytes": Recipe(files=cut_file(last, 100)),
        "topmost empty": Recipe(files=cut_file(last, 0)),
        "one empty": Recipe(files=cut_file(5, 0)),
        "topmost without its mark": Recipe(files=patch_bytes(last, b"DICM", b"DICN")),
        "an element of 4 GB": Recipe(files=claim_huge_element),
        "letters in a position": Recipe(files=patch_bytes(5, b"-22\\-18.5", b"-2x\\-18.5")),
        "deeply nested": Recipe(files=add_file("image0099.dcm", nested_sequences(20_000))),
    }
    return recipes

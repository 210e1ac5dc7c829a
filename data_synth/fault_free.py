"""Recipes of folders that every reader must read exactly."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from pydicom import uid

from .fault_edits import (
    add_large_scout,
    add_scout,
    add_screenshot,
    add_second_series,
    chain,
    compress,
    edit_pixels,
    encode_jpeg,
    encode_jpeg2000,
    encode_jpeg_ls,
    encode_rle,
    make_big_endian,
    make_enhanced,
    number_slices,
    repeat_slices,
    rescale_each,
    set_elements,
)
from .fault_files import DICOM_ZERO, add_file, add_links, add_pipe, drop_preamble, rename_files
from .fault_series import EVERY, SHAPE, Edit, Recipe, Slices, head, turned_axial


def valid_recipes() -> dict[str, Recipe]:
    """Folders that must be read exactly."""
    recipes = {"plain": Recipe()}
    recipes |= _valid_geometry() | _valid_pixels() | _valid_codings() | _valid_series() | _valid_files()
    return recipes


def _valid_geometry() -> dict[str, Recipe]:
    directions = {
        "coronal": (1.0, 0, 0, 0, 0, -1.0),
        "coronal from behind": (-1.0, 0, 0, 0, 0, -1.0),
        "sagittal": (0, 1.0, 0, 0, 0, -1.0),
        "sagittal from the right": (0, -1.0, 0, 0, 0, -1.0),
        "prone": (-1.0, 0, 0, 0, -1.0, 0),
        "on the left side": (0, 1.0, 0, -1.0, 0, 0),
        "on the right side": (0, -1.0, 0, 1.0, 0, 0),
        "feet first": (-1.0, 0, 0, 0, 1.0, 0),
        "mirrored rows": (1.0, 0, 0, 0, -1.0, 0),
    }
    recipes = {name: Recipe(orientation=value) for name, value in directions.items()}
    for deg in (-30, -7, 0.5, 12, 25):
        for axis, name in enumerate(("nodded", "rolled", "turned")):
            recipes[f"{name} by {deg} degrees"] = Recipe(orientation=turned_axial(deg, axis))
    recipes["from the top down"] = Recipe(edit=lambda slices: slices.reverse())
    recipes["slice numbers reversed"] = Recipe(edit=number_slices(lambda k: len(head()) - k))
    recipes["no slice numbers"] = Recipe(edit=set_elements(EVERY, InstanceNumber=None))
    recipes["shuffled slice numbers"] = Recipe(edit=number_slices(lambda k: (k * 7) % SHAPE[0] + 1))
    recipes["no thickness"] = Recipe(edit=set_elements(EVERY, SliceThickness=None))
    return recipes


def _valid_pixels() -> dict[str, Recipe]:
    recipes = {}
    for bits in (12, 13, 14, 16, 32):
        recipes[f"{bits} bits, unsigned"] = Recipe(store={"bits": bits})
        recipes[f"{bits} bits, signed"] = Recipe(store={"bits": bits, "signed": True, "intercept": 0})
    recipes["signed with an intercept"] = Recipe(store={"signed": True})
    recipes["slope 2"] = Recipe(store={"slope": 2}, hu=lambda hu: (hu // 2 * 2).astype(np.int16))
    recipes["slope 0.5"] = Recipe(store={"slope": 0.5})
    recipes["intercept -8192"] = Recipe(store={"intercept": -8192})
    recipes["rescale of each slice"] = Recipe(edit=rescale_each)
    recipes["inverted display"] = Recipe(edit=set_elements(EVERY, PhotometricInterpretation="MONOCHROME1"))
    recipes["rubbish above 12 bits"] = Recipe(
        store={"bits": 12}, edit=edit_pixels(lambda p, k: p ^ ((np.arange(p.size).reshape(p.shape) * 5 % 16) << 12))
    )
    recipes["rubbish above 12 signed bits"] = Recipe(
        store={"bits": 12, "signed": True, "intercept": 0},
        edit=edit_pixels(lambda p, k: p.view("<u2") ^ ((np.arange(p.size).reshape(p.shape) * 5 % 16) << 12)),
    )
    recipes["12 bits in the upper part"] = Recipe(store={"bits": 12, "high": 15})
    recipes["a byte of padding"] = Recipe(hu=lambda hu: hu[:, :43, :47])
    recipes["bytes behind the pixels"] = Recipe(edit=_longer(10))
    for value in (-2000, -3024):
        recipes[f"padding of {value} with its tag"] = _padded(value, tagged=True)
        recipes[f"padding of {value} without a tag"] = _padded(value, tagged=False)
    return recipes


def _longer(count: int) -> Edit:
    def change(slices: Slices) -> None:
        for ds in slices:
            ds.PixelData = ds.PixelData + bytes(count)

    return change


def _padded(value: int, *, tagged: bool) -> Recipe:
    """Padding outside a round field of view; what is read there must be air."""

    def corners(hu: NDArray[np.int16], fill: int) -> NDArray[np.int16]:
        grid = np.meshgrid(*[np.linspace(-1, 1, n) for n in hu.shape[1:]], indexing="ij")
        return np.where(np.hypot(*grid) > 1.05, fill, hu).astype(np.int16)

    return Recipe(
        hu=lambda hu: corners(hu, value),
        truth=lambda hu: np.where(hu == value, -1024, hu).astype(np.int16),
        store={"signed": True, "intercept": 0},
        edit=_padding_tag(value) if tagged else None,
    )


def _padding_tag(value: int) -> Edit:
    def change(slices: Slices) -> None:
        for ds in slices:
            ds.add_new(0x00280120, "SS", value)

    return change


def _valid_codings() -> dict[str, Recipe]:
    recipes = {
        "implicit": Recipe(syntax=uid.ImplicitVRLittleEndian),
        "big endian": Recipe(syntax=uid.ExplicitVRBigEndian, edit=make_big_endian),
        "deflated": Recipe(syntax=uid.DeflatedExplicitVRLittleEndian),
        "enhanced": Recipe(edit=make_enhanced()),
        "enhanced, frames in another order": Recipe(edit=make_enhanced(lambda n: [k * 7 % n for k in range(n)])),
        "enhanced, rescale of each frame": Recipe(edit=chain(rescale_each, make_enhanced(shared_rescale=False))),
        "enhanced, deflated": Recipe(edit=make_enhanced(), syntax=uid.DeflatedExplicitVRLittleEndian),
        "enhanced, implicit": Recipe(edit=make_enhanced(), syntax=uid.ImplicitVRLittleEndian),
        "no preamble": Recipe(files=drop_preamble),
    }
    codings = {
        "run length": (uid.RLELossless, encode_rle),
        "JPEG-LS": (uid.JPEGLSLossless, encode_jpeg_ls),
        "JPEG 2000": (uid.JPEG2000Lossless, encode_jpeg2000),
        "JPEG": (uid.JPEGLosslessSV1, encode_jpeg),
        "JPEG, any predictor": (uid.JPEGLossless, encode_jpeg),
    }
    for name, (syntax, encode) in codings.items():
        recipes[name] = Recipe(edit=compress(encode), syntax=syntax)
    for name in ("JPEG-LS", "JPEG"):
        syntax, encode = codings[name]
        recipes[f"{name} in three pieces"] = Recipe(edit=compress(encode, 3), syntax=syntax)
    return recipes


def _valid_series() -> dict[str, Recipe]:
    markup = "<script>alert(1)</script> $(touch x) ../../etc"
    return {
        "with a scout": Recipe(edit=add_scout),
        "with a scout of another size": Recipe(edit=add_large_scout),
        "with a screenshot": Recipe(edit=add_screenshot),
        "with a thicker reconstruction": Recipe(edit=add_second_series()),
        "with a sharper reconstruction": Recipe(edit=add_second_series(ConvolutionKernel="H70s")),
        "with an MR series": Recipe(edit=add_second_series(Modality="MR", SOPClassUID="1.2.840.10008.5.1.4.1.1.4")),
        "exact copies of slices": Recipe(edit=repeat_slices(range(3, 7)), recovered=True),
        "markup in text": Recipe(edit=set_elements(EVERY, SeriesDescription=markup, PatientComments=markup)),
        "no frame of reference": Recipe(edit=set_elements(EVERY, FrameOfReferenceUID=None)),
        "no image type": Recipe(edit=set_elements(EVERY, ImageType=None)),
        "no kernel": Recipe(edit=set_elements(EVERY, ConvolutionKernel=None)),
    }


def _valid_files() -> dict[str, Recipe]:
    names = {
        "names without suffix": lambda k: f"IM{k:06d}",
        "names as identifiers": lambda k: f"1.2.840.{k + 10}.{k * 7919}",
        "names in Unicode": lambda k: f"Schädel 頭蓋 череп {k}.dcm",
        "names in another order": lambda k: f"{(k * 7) % SHAPE[0]:03d}.dcm",
        "names of 200 letters": lambda k: f"{'x' * 190}{k:03d}.dcm",
        "in subfolders": lambda k: f"part{k % 3}/IM{k}.dcm",
        "capital suffix": lambda k: f"IMG{k:04d}.DCM",
    }
    recipes = {name: Recipe(files=rename_files(rule)) for name, rule in names.items()}
    beside = {
        "a text file": ("notes.txt", b"nothing"),
        "a desktop's file": (".DS_Store", b"\0\0\0\1Bud1" + bytes(200)),
        "a thumbnail file": ("Thumbs.db", b"\xd0\xcf\x11\xe0" + bytes(600)),
        "a Mac's second file": ("__MACOSX/._image0003.dcm", b"\0\5\26\7\0\2\0\0Mac OS X" + bytes(104)),
        "an index": ("DICOMDIR", b"../../../etc/passwd"),
        "a photograph named as an image": ("photo.dcm", b"\xff\xd8\xff\xe0" + bytes(5000)),
        "a file that starts like DICOM": ("data.bin", b"\x08\x00\x01\x00" + bytes(400)),
        "a false preamble": ("fake.dcm", DICOM_ZERO + b"rubbish" * 40),
        "an empty file": ("LOCK", b""),
    }
    recipes |= {f"with {name}": Recipe(files=add_file(*what)) for name, what in beside.items()}
    recipes["with links"] = Recipe(files=add_links)
    recipes["with a pipe"] = Recipe(files=add_pipe)
    return recipes

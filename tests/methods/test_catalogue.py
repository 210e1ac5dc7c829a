"""Methods by name: built in, added in a test, offered by another package; what is no method is refused."""

import sys
from importlib.metadata import EntryPoint
from typing import Annotated

import numpy as np
import pytest
from scipy import ndimage

import cranio_nb as cn
from cranio_nb.errors import InputRefused, NoOpening
from cranio_nb.methods import catalogue, transfer
from cranio_nb.methods.piece import Piece
from cranio_nb.options import Option


def toy(bone, openings, *, grow_px=2):
    """The coarse sheet across the hole, grown."""
    for opening in openings:
        grown = ndimage.binary_dilation(opening.sheet.voxels, iterations=grow_px)
        yield Piece(grown, (opening,), {"parts": [{"voxels": int(grown.sum())}], "toy": True})


def half(bone):
    """A preset that depends on the grid."""
    return {"grow_px": round(2.0 / bone.spacing.max())}


@pytest.fixture
def mine():
    cn.add_method("mine", toy, presets={"thin": {"grow_px": 1}, "by grid": half})
    yield "mine"
    catalogue.remove_method("mine")


def test_a_method_added_in_one_line_designs(mine, skull, openings):
    bone = skull("burr_hole")
    made = cn.design(bone, openings("burr_hole"), method="mine", grow_px=3)
    grown = ndimage.binary_dilation(openings("burr_hole")[0].sheet.voxels, iterations=3)
    np.testing.assert_array_equal(made.patch.voxels, grown & ~bone.voxels)
    assert made.parameters == {"grow_px": 3, "smooth": True} and made.working == openings("burr_hole")
    assert made.record["parts"] == [{"opening": 0, "voxels": int(grown.sum())}] and made.record["toy"]


def test_its_presets_are_dicts_or_functions_of_the_bone(mine, skull, openings):
    bone = skull("burr_hole")
    assert catalogue.preset_names("mine") == ("default", "thin", "by grid")
    assert cn.design(bone, openings("burr_hole"), method="mine", preset="thin").parameters["grow_px"] == 1
    assert catalogue.preset_options("mine", "by grid", bone) == half(bone)
    with pytest.raises(InputRefused, match="thin"):
        cn.design(bone, openings("burr_hole"), method="mine", preset="paper")


def test_its_options_are_checked_like_those_of_any_method(mine, skull):
    assert catalogue.default_options("mine") == {"grow_px": 2, "smooth": True}
    for options, code in (
        ({"grow": 1}, "UnknownOption"),
        ({"grow_px": 1.5}, "BadOption"),
        ({"smooth": 1}, "BadOption"),
    ):
        with pytest.raises(InputRefused) as refused:
            cn.design(skull("burr_hole"), method="mine", **options)
        assert refused.value.code == code


def test_a_decorator_adds_too_and_a_cell_may_be_run_twice():
    def cell():
        @cn.add_method("mine")
        def pieces(bone, openings, *, shift=0.0):
            yield from ()

        return pieces

    try:
        first, second = cell(), cell()
        assert first is not second and catalogue.find_method("mine").pieces is second
        with pytest.raises(InputRefused) as refused:
            cn.add_method("mine", toy)
        assert refused.value.code == "MethodNameTaken"
    finally:
        catalogue.remove_method("mine")
    assert "mine" not in catalogue.method_names()


def positional(bone, openings, grow_px=2):
    yield from ()


def undefaulted(bone, openings, *, grow_px):
    yield from ()


def smooth(bone, openings, *, smooth=True):
    yield from ()


@pytest.mark.parametrize(
    ("name", "pieces", "presets", "said"),
    [
        ("hull", toy, None, "already"),
        ("a:b", toy, None, "colons"),
        ("", toy, None, "spaces"),
        ("mine", 3, None, "function"),
        ("mine", lambda bone: iter(()), None, "openings"),
        ("mine", positional, None, "keyword-only"),
        ("mine", undefaulted, None, "keyword-only"),
        ("mine", smooth, None, "smooth"),
        ("mine", toy, {"default": {}}, "presets"),
    ],
)
def test_what_is_no_method_is_refused_with_what_is_wanted(name, pieces, presets, said):
    with pytest.raises(InputRefused, match=said) as refused:
        cn.add_method(name, pieces, presets=presets)
    assert refused.value.remedy and "mine" not in catalogue.method_names()


def wrong_shape(bone, openings):
    yield from (Piece(np.ones((2, 2, 2), bool)) for _ in openings)


def no_piece(bone, openings):
    yield from (opening.sheet for opening in openings)


def too_few(bone, openings):
    yield from ()


@pytest.mark.parametrize("pieces", [wrong_shape, no_piece, too_few])
def test_pieces_that_are_none_are_refused(pieces, skull, openings):
    cn.add_method("mine", pieces)
    try:
        with pytest.raises(InputRefused) as refused:
            cn.design(skull("burr_hole"), openings("burr_hole"), method="mine")
        assert refused.value.code == "BadPiece" and "mine" in str(refused.value)
    finally:
        catalogue.remove_method("mine")


def test_a_method_that_bridges_nothing_says_so(skull, openings):
    cn.add_method("mine", lambda bone, openings: (Piece(np.zeros(bone.shape, bool)) for _ in openings))
    try:
        with pytest.raises(NoOpening) as refused:
            cn.design(skull("burr_hole"), openings("burr_hole"), method="mine")
        assert refused.value.code == "NothingBridged" and "mine" in refused.value.message
    finally:
        catalogue.remove_method("mine")


def test_another_package_offers_a_method(monkeypatch, tmp_path, skull, openings):
    (tmp_path / "their_method.py").write_text(
        "from cranio_nb.methods.piece import Piece\n"
        "PRESETS = {'none': {}}\n"
        "def pieces(bone, openings, *, times=1):\n"
        "    for opening in openings:\n"
        "        yield Piece(opening.sheet.voxels)\n"
    )
    monkeypatch.syspath_prepend(str(tmp_path))
    point = EntryPoint("theirs", "their_method", catalogue.GROUP)
    monkeypatch.setattr(catalogue, "entry_points", lambda group: [point] if group == catalogue.GROUP else [])
    assert catalogue.method_names()[-1] == "theirs" and "their_method" not in sys.modules
    assert catalogue.default_options("theirs") == {"times": 1, "smooth": True}
    assert cn.design(skull("burr_hole"), openings("burr_hole"), method="theirs", preset="none").patch.voxels.any()
    with pytest.raises(InputRefused, match="theirs"):
        cn.add_method("theirs", toy)


def test_other_packages_are_not_asked_for_a_built_in_method(monkeypatch):
    monkeypatch.setattr(catalogue, "entry_points", lambda group: pytest.fail("asked"))
    for name in catalogue.METHODS:
        assert catalogue.find_method(name).name == name and catalogue.default_options(name)["smooth"] is True


def test_an_unknown_name_lists_those_known():
    with pytest.raises(InputRefused, match="thin-plate") as refused:
        catalogue.find_method("magic")
    assert refused.value.code == "UnknownMethod"


@pytest.mark.parametrize(
    ("value", "default", "fits"),
    [
        *[(1, 1, True), (1.5, 1, False), (True, 1, False), (1, 1.0, True), (None, None, True), (2, None, True)],
        *[("a", "b", True), (1, "b", False), (False, True, True), (None, 1.0, False)],
    ],
)
def test_kinds_of_values(value, default, fits):
    cn.add_method("mine", eval("lambda bone, openings, *, x=default: iter(())", {"default": default}))
    try:
        if fits:
            catalogue.check_options("mine", {"x": value})
        else:
            with pytest.raises(InputRefused):
                catalogue.check_options("mine", {"x": value})
    finally:
        catalogue.remove_method("mine")


def ranged(bone, openings, *, grow_px: 'Annotated[int, Option("How far.", 1, 5, "px")]' = 2):
    yield from ()


def test_an_own_method_declares_ranges_and_keeps_them_in_another_process(monkeypatch):
    cn.add_method("mine", ranged)
    try:
        packed = transfer.pack_methods()
        catalogue.remove_method("mine")
        monkeypatch.setattr(transfer, "_MADE", "of another process")
        transfer.unpack_methods(packed)
        assert catalogue.options_of("mine")["grow_px"].limits == "1 to 5 px"
        with pytest.raises(InputRefused, match="from 1 to 5 px"):
            catalogue.check_options("mine", {"grow_px": 6})
    finally:
        catalogue.remove_method("mine")


def off(bone, openings, *, grow_px: Annotated[int, Option("How far.", 1, 5, "px")] = 9):
    yield from ()


def lost(bone, openings, *, grow_px: "Annotated[Nowhere, Option('How far.')]" = 9):  # noqa: F821
    yield from ()


@pytest.mark.parametrize(("pieces", "said"), [(off, "default of grow_px"), (lost, "Nowhere")])
def test_a_declaration_that_cannot_hold_is_refused(pieces, said):
    with pytest.raises(InputRefused, match=said):
        cn.add_method("mine", pieces)

"""Pieces of boxes whose voxels are counted by hand."""

import numpy as np

from cranio_nb.geometry.voxel_pieces import edge_labels, keep_main_piece, keep_solid_piece
from cranio_nb.volume import Volume

GRID = np.diag([0.5, 0.5, 0.5, 1])


def test_the_main_piece_fills_most_of_the_opening_even_if_another_is_larger():
    patch_3d, opening = np.zeros((2, 5, 20, 20), bool)
    patch_3d[1:4, 2:6, 2:6] = True
    patch_3d[:, 10:20, 10:20] = True
    opening[1:4, 3:5, 3:5] = True
    opening[2, 12, 12] = True
    kept = keep_main_piece(patch_3d, opening)
    np.testing.assert_array_equal(kept, patch_3d & (np.indices(patch_3d.shape)[1] < 8))


def test_the_main_piece_off_the_opening_is_the_largest_and_one_piece_is_itself():
    two = np.zeros((3, 10, 10), bool)
    two[:, 1:3, 1:3], two[:, 5:9, 5:9] = True, True
    off = np.zeros_like(two)
    off[0, 4, 4] = True
    assert keep_main_piece(two, off).sum() == 3 * 16
    one = two & (np.indices(two.shape)[1] < 4)
    np.testing.assert_array_equal(keep_main_piece(one, off), one)
    assert not keep_main_piece(np.zeros_like(two), off).any()


def test_pieces_do_not_change_their_inputs():
    patch = np.zeros((4, 9, 9), bool)
    patch[:, 1:4, 1:4] = patch[:, 6:8, 6:8] = True
    before = patch.copy()
    keep_main_piece(patch, patch)
    keep_solid_piece(patch, Volume(patch, GRID), Volume(~patch, GRID))
    np.testing.assert_array_equal(patch, before)


def test_a_solid_piece_drops_films_pores_and_what_lies_elsewhere():
    patch, opening, bone = np.zeros((3, 30, 30, 30), bool)
    patch[5:15, 5:15, 5:15] = True
    patch[10, 10, 10] = False  # a pore
    patch[15, 5:15, 5:25] = True  # a film, half a mm thick, beside it
    patch[20:28, 20:28, 20:28] = True  # elsewhere
    opening[8:12, 8:12, 8:12] = True
    made = keep_solid_piece(patch, Volume(opening, GRID), Volume(bone, GRID))
    wanted = np.zeros_like(patch)
    wanted[5:15, 5:15, 5:15] = True
    np.testing.assert_array_equal(made & wanted, wanted)
    assert not made[16:].any() and not made[15, :, 16:].any()


def test_a_solid_piece_keeps_off_bone_and_away_from_holes_it_does_not_reach():
    patch, opening, bone = np.zeros((3, 20, 20, 20), bool)
    patch[5:15, 5:15, 5:15] = True
    bone[10, 10, 10] = True
    patch &= ~bone
    opening[7:9, 7:9, 7:9] = True
    assert not (keep_solid_piece(patch, Volume(opening, GRID), Volume(bone, GRID)) & bone).any()
    empty = Volume(np.zeros_like(bone), GRID)
    assert not keep_solid_piece(patch, empty, Volume(bone, GRID)).any()


def test_pieces_at_the_edge_of_their_slice_are_told_from_those_at_the_ends_of_the_scan():
    labels = np.zeros((3, 5, 5), int)
    for label, (row, col) in enumerate([(0, 2), (4, 2), (2, 0), (2, 4)], 1):
        labels[1, row, col] = label
    labels[0, 2, 2], labels[2, 2, 2], labels[1, 2, 2] = 5, 6, 7
    assert edge_labels(labels).tolist() == [0, 1, 2, 3, 4]

"""Rows of the paper's tables from records that are known."""

from cranio_nb.evaluation.paper_tables import (
    balloon_ranges,
    count_crossed,
    count_not_converged,
    count_statuses,
    pick_slices,
)

ONE = {"status": "balloon", "theta0": (5.0, 12.0), "theta1": (160.0, 150.0), "n_iter": (50, 31)}
OTHER = {"status": "balloon", "theta0": (22.0, 20.0), "theta1": (156.0, 143.0), "n_iter": (90, 147)}
NONE = [{"status": "hull"}, {"status": "skipped"}]
SLICES = [ONE | {"converged": (True, True)}, OTHER | {"converged": (True, False)}, *NONE]


def test_ranges_are_those_of_the_balloons():
    found = balloon_ranges(SLICES)
    assert found["outer"] == {"theta0": (5.0, 22.0), "theta1": (156.0, 160.0), "n_iter": (50, 90)}
    assert found["inner"] == {"theta0": (12.0, 20.0), "theta1": (143.0, 150.0), "n_iter": (31, 147)}
    assert balloon_ranges(NONE) == {}


def test_slices_are_counted_by_what_filled_them():
    assert count_statuses(SLICES) == {"balloon": 2, "hull": 1, "carried": 0, "skipped": 1}
    assert count_not_converged(SLICES) == 1


def test_slices_shown_are_spread_and_hold_each_kind():
    statuses = ["hull", "hull", *["balloon"] * 20, "carried", *["balloon"] * 5, "skipped"]
    chosen = pick_slices(statuses, 6)
    assert chosen == sorted(set(chosen)) and len(chosen) == 6
    assert {statuses[i] for i in chosen} == {"hull", "balloon", "carried", "skipped"}
    assert pick_slices(["balloon"] * 3, 6) == [0, 1, 2]
    assert pick_slices([], 6) == []
    assert pick_slices(["balloon"] * 60, 6) == [5, 15, 25, 35, 45, 55]


def test_crossed_slices_are_counted_and_shown_first():
    assert (
        count_crossed([*SLICES, {"status": "carried", "crossed": True}, {"status": "balloon", "crossed": False}]) == 1
    )
    kinds = [*["balloon"] * 8, "carried", "crossed", *["balloon"] * 8]
    assert {kinds[i] for i in pick_slices(kinds, 2)} == {"crossed", "balloon"}

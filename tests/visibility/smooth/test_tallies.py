"""Numbers of sheets by row and item."""

from __future__ import annotations

import numpy as np

from vectorplot.visibility.smooth.rays import Cells, Tally, all_tallies, no_tally


def random_tally(rows: int, items: int, entries: int, seed: int) -> Tally:
    rng = np.random.default_rng(seed)
    return Tally(rng.integers(0, rows, entries), rng.integers(0, items, entries), rng.integers(-3, 4, entries))


def test_rows_are_taken_in_their_order_and_as_often_as_named() -> None:
    tally, which = random_tally(7, 5, 20, 1), np.array([3, 0, 3, 6])
    assert np.array_equal(tally.of_rows(which).table(4, 5), tally.table(7, 5)[which])
    doubled = all_tallies([tally, no_tally(), tally.in_rows(np.arange(7) + 2)])
    expected = np.pad(tally.table(7, 5), ((0, 2), (0, 0))) + np.pad(tally.table(7, 5), ((2, 0), (0, 0)))
    assert np.array_equal(doubled.table(9, 5), expected)


def test_cells_hold_what_a_whole_table_would() -> None:
    """And no more of it than of each curve the items that something is said of."""
    curve = np.array([0, 0, 0, 2, 2, 5])
    one, two = random_tally(6, 9, 7, 2), random_tally(6, 9, 4, 3)
    cells = Cells.of(curve, [one, two])
    for tally in (one, two):
        table = np.zeros((6, 9), dtype=np.intp)
        table[cells.piece, cells.item] = cells.values(tally)
        assert np.array_equal(table, tally.table(6, 9))
    assert len(cells.piece) == len({(piece, item) for piece, item in zip(cells.piece, cells.item, strict=True)})
    assert len(Cells.of(curve, [no_tally()]).piece) == 0

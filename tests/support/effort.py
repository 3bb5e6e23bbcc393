"""How much tests try: what finds most at every change, and by hand much more (--hypothesis-profile=long).

The profile counts for what Hypothesis makes up, for views and samples that tests draw at random, and for the rows of
tables: tests with several parameters that have the mark `spread`.
"""

from __future__ import annotations

from collections import defaultdict
from zlib import crc32

import pytest
from hypothesis import settings

USUAL, LONG = 25, 600
"""Examples of a property, in the profiles ci and long."""


def register_profiles() -> None:
    """ci: the same few examples on every run, for a failure that comes and goes teaches nothing; long: others on every
    run, and many."""
    settings.register_profile("ci", derandomize=True, deadline=None, max_examples=USUAL, database=None)
    settings.register_profile("long", deadline=None, max_examples=LONG)


def examples(count: int) -> int:
    """So many examples for each hundred of the property's own count, as the profile has of its own: a quarter in ci."""
    return max(6, count * settings().max_examples // 100)


def several(usual: int, *, long: int) -> int:
    """How many views or samples to draw at random."""
    return long if settings().max_examples >= LONG else usual


def rows_to_try(items: list[pytest.Item]) -> list[pytest.Item]:
    """The tests to run: in ci so few rows of a table with the mark `spread` that each value of each parameter comes.

    What goes wrong for one value goes wrong in its row, whatever stands beside it; what needs two values at once is
    left to the whole table, in long. With the mark `spread(parts=3)` every third row of the table is tried, whatever is
    in it; the name of the test says which: of cases that many tests look at each one tries others.
    """
    if settings().max_examples >= LONG:
        return items
    tables: dict[tuple[str, str], list[pytest.Item]] = defaultdict(list)
    for item in items:
        if item.get_closest_marker("spread"):
            tables[item.nodeid.partition("[")[0], item.name.partition("[")[0]].append(item)
    left_out = {item for rows in tables.values() for item in _left_out(rows)}
    return [item for item in items if item not in left_out]


def _left_out(rows: list[pytest.Item]) -> list[pytest.Item]:
    """The rows of a table that are left to the whole of it."""
    mark = rows[0].get_closest_marker("spread")
    if mark is not None and "parts" in mark.kwargs:
        parts = min(mark.kwargs["parts"], len(rows))
        first = crc32(rows[0].name.partition("[")[0].encode()) % parts
        return [row for number, row in enumerate(rows) if number % parts != first]
    columns = [_numbered(column) for column in zip(*map(_values, rows), strict=True)]
    lengths = [max(column) + 1 for column in columns]
    # One step further in each round, so that parameters with as many values do not always meet in the same way.
    tried = {
        tuple((row + number * (row // length)) % length for number, length in enumerate(lengths))
        for row in range(max(lengths))
    }
    return [row for row, place in zip(rows, zip(*columns, strict=True), strict=True) if place not in tried]


def _values(row: pytest.Item) -> list[tuple[int, ...]]:
    """What stands for the values that a test has of each of its lists of parameters."""
    params = row.callspec.params  # type: ignore[attr-defined]
    named = [mark.args[0] for mark in row.iter_markers("parametrize")]
    lists = [[name.strip() for name in names.split(",")] if isinstance(names, str) else names for names in named]
    return [tuple(id(params[name]) for name in names) for names in lists]


def _numbered(column: tuple[tuple[int, ...], ...]) -> list[int]:
    """Equal ones have equal numbers, by where they come first."""
    first = {value: number for number, value in enumerate(dict.fromkeys(column))}
    return [first[value] for value in column]

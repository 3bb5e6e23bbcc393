"""All sheets of a scene, asked at once: those that can be are asked as one."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.vectors import from_components
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.stacked import StackedSurfaces
from vectorplot.visibility.smooth.sheets.parametric_places import StackedSheets
from vectorplot.visibility.smooth.sheets.parametric_sheet import ParametricSheet
from vectorplot.visibility.smooth.sheets.surface_sheet import OnSheet, Sheet

Rows = Ints | slice
"""Some of the rows of arrays, by their indices, or all of them."""


@dataclass(frozen=True, eq=False)
class SheetGroup:
    """Sheets that are asked as one, and their numbers (g,) among all sheets; stacked: whether the third number of a
    place says which of them it is on."""

    as_one: OnSheet
    numbers: Ints
    stacked: bool


@dataclass(frozen=True, eq=False)
class Sheets:
    """Sheets, asked at places (k,3) by their numbers (k,). Where the number is -1 the answer is NaN, or no.

    counted_as (s,): the numbers of the items they belong to, where these are not those of the scene.
    """

    sheets: tuple[Sheet, ...]
    counted_as: Ints | None = None

    def __len__(self) -> int:
        return len(self.sheets)

    def __iter__(self) -> Iterator[Sheet]:
        return iter(self.sheets)

    def __getitem__(self, number: int) -> Sheet:
        return self.sheets[number]

    @cached_property
    def item(self) -> Ints:
        """(s,) the items they belong to."""
        if self.counted_as is not None:
            return self.counted_as
        return np.array([sheet.item for sheet in self.sheets], dtype=np.intp)

    @cached_property
    def hides(self) -> Bools:
        """(s,) whether they hide what is behind them."""
        return np.array([sheet.hides for sheet in self.sheets], dtype=np.bool_)

    @cached_property
    def groups(self) -> tuple[SheetGroup, ...]:
        """Placed surfaces that are closed in the same directions are asked as one, others each alone."""
        members: dict[object, list[int]] = {}
        for number, sheet in enumerate(self.sheets):
            placed = isinstance(sheet, ParametricSheet) and isinstance(sheet.surface, PlacedSurface)
            members.setdefault(_closed(sheet) if placed else number, []).append(number)
        return tuple(self._group(numbers) for numbers in members.values())

    def _group(self, numbers: Sequence[int]) -> SheetGroup:
        of = np.array(numbers, dtype=np.intp)
        if len(of) == 1:
            return SheetGroup(self.sheets[of[0]], of, False)
        sheets = [sheet for sheet in map(self.__getitem__, numbers) if isinstance(sheet, ParametricSheet)]
        placed = tuple(sheet.surface for sheet in sheets if isinstance(sheet.surface, PlacedSurface))
        return SheetGroup(StackedSheets(StackedSurfaces(placed), any(sheet.holed for sheet in sheets)), of, True)

    @cached_property
    def group(self) -> Ints:
        """(s+1,) the group of each, and -1 for no sheet."""
        result = np.full(len(self.sheets) + 1, -1)
        for number, group in enumerate(self.groups):
            result[group.numbers] = number
        return result

    @cached_property
    def row(self) -> Ints:
        """(s+1,) which one of its group each is."""
        result = np.zeros(len(self.sheets) + 1, dtype=np.intp)
        for group in self.groups:
            result[group.numbers] = np.arange(len(group.numbers))
        return result

    def places(self, number: Ints, places: Floats) -> Floats:
        """(k,3) the places as the groups take them."""
        result = places.copy()
        stacked = np.array([*(group.stacked for group in self.groups), False])[self.group[number]]
        result[stacked, 2] = self.row[number[stacked]]
        return result

    def points(self, number: Ints, places: Floats) -> Floats:
        """(k,3) points."""
        return self._vectors(number, places, lambda sheet, which, at: sheet.points(at))

    def normals(self, number: Ints, places: Floats) -> Floats:
        """(k,3) unit normals; NaN at singular points."""
        return self._vectors(number, places, lambda sheet, which, at: sheet.normals(at))

    def bends(self, number: Ints, places: Floats, directions: Floats) -> Floats:
        """(k,) how strongly the sheets bend towards their normals along directions (k,3)."""
        result = np.full(len(number), np.nan)
        for sheet, which, at in self._each(number, places):
            result[which] = sheet.bends(at, directions[which])
        return result

    def moved(self, number: Ints, places: Floats, steps: Floats) -> Floats:
        """(k,3) the places that small tangential steps (k,3) lead to, to first order."""
        return self._vectors(number, places, lambda sheet, which, at: sheet.moved(at, steps[which]))

    def inwards(self, number: Ints, places: Floats) -> Floats:
        """(k,3) tangents into the sheets at places on their borders; 0 elsewhere."""
        return self._vectors(number, places, lambda sheet, which, at: sheet.inwards(at))

    def turnings(self, number: Ints, places: Floats) -> Floats:
        """(k,3) the direction to which both wings of cuspidal edges turn, at places on them."""
        return self._vectors(number, places, lambda sheet, which, at: sheet.turnings(at))

    def missed(self, number: Ints, points: Floats, ways: Floats, places: Floats) -> tuple[Floats, Floats, Floats]:
        """(k,) and (k,3): one Newton step for where lines points + t ways meet the sheets: t, and the places there; and
        the points (k,3) of the sheets at the places from which the step is taken."""
        t = np.full(len(number), np.nan)
        met, here = (np.full((len(number), 3), np.nan) for _ in range(2))
        for sheet, which, at in self._each(number, places):
            t[which], met[which], here[which] = sheet.missed(points[which], ways[which], at)
        return t, met, here

    def apart(self, number: Ints, one: Floats, two: Floats) -> Floats:
        """(k,) how far places are from each other as parts of the domains."""
        result = np.full(len(number), np.nan)
        for sheet, which, at in self._each(number, one):
            result[which] = sheet.apart(at, two[which])
        return result

    def on_sheet(self, number: Ints, places: Floats) -> Bools:
        """(k,) whether places lie in the domains."""
        result = np.zeros(len(number), dtype=np.bool_)
        for sheet, which, at in self._each(number, places):
            result[which] = sheet.on_sheet(at)
        return result

    def _vectors(self, number: Ints, places: Floats, ask: Callable[[OnSheet, Rows, Floats], Floats]) -> Floats:
        result = np.full((len(number), 3), np.nan)
        for sheet, which, at in self._each(number, places):
            result[which] = ask(sheet, which, at)
        return result

    def _each(self, number: Ints, places: Floats) -> Iterator[tuple[OnSheet, Rows, Floats]]:
        """Each group that is asked, which rows it is asked for, and the places as it takes them."""
        of = self.group[number]
        counts = np.bincount(of + 1, minlength=1)[1:]
        for one in np.flatnonzero(counts).tolist():
            # Where one group is asked for everything there is nothing to choose.
            which: Rows = slice(None) if counts[one] == len(of) else np.flatnonzero(of == one)
            group, at = self.groups[one], places[which]
            if group.stacked:
                at = from_components(at[:, 0], at[:, 1], self.row[number[which]])
            yield group.as_one, which, at


def _closed(sheet: Sheet) -> object:
    domain = sheet.surface.domain if isinstance(sheet, ParametricSheet) else None
    return None if domain is None else ("closed", domain.closed_u, domain.closed_v)

"""Curves of one sort on sheets that are asked as one: one family of them all."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.visibility.smooth.sheets.directed_curves import DirectedCurves
from vectorplot.visibility.smooth.sheets.family import ConditionCurves, Family, ParameterCurves, RimCurves
from vectorplot.visibility.smooth.sheets.meeting_families import FaceCurves, SheetsMeet
from vectorplot.visibility.smooth.sheets.parametric_places import OnParametrised, StackedSheets
from vectorplot.visibility.smooth.sheets.scene_sheets import Sheets
from vectorplot.visibility.smooth.tracing.traced_curves import Curves

NONE = -1

ON_ONE = (ParameterCurves, DirectedCurves, RimCurves, ConditionCurves, FaceCurves)
"""Families of curves that lie on one sheet."""


def with_merged_families(parts: Sequence[Curves], sheets: Sheets) -> list[Curves]:
    """The same curves, those of one sort on the sheets of a group in one family, the same in all parts: so they are
    asked at once.

    Their places say on which sheet of the group they are.
    """
    if not any(group.stacked for group in sheets.groups):
        return list(parts)
    known: dict[object, Family] = {}
    return [_with_merged(curves, sheets, known) for curves in parts]


def _with_merged(curves: Curves, sheets: Sheets, known: dict[object, Family]) -> Curves:
    """As with_merged_families; known: the families there are already, those that are new among them afterwards."""
    number: dict[object, int] = {}
    families: list[Family] = []
    new = np.zeros(len(curves.families), dtype=np.intp)
    first, second = (np.zeros(len(curves.families), dtype=np.bool_) for _ in range(2))
    for old, family in enumerate(curves.families):
        found = _merged(family, sheets)
        key = old if found is None else found.key
        if key not in number:
            number[key] = len(families)
            families.append(family if found is None else known.setdefault(key, found.family))
        new[old] = number[key]
        first[old], second[old] = (False, False) if found is None else (True, found.on_second)
    places, second_places = curves.places.copy(), curves.second_places.copy()
    for which, sheet, at in ((first, curves.sheet, places), (second, curves.second_sheet, second_places)):
        own = np.flatnonzero(which[curves.family][curves.owner])
        at[own] = sheets.places(sheet[curves.owner[own]], at[own])
    of, merged = new[curves.family], tuple(families)
    return replace(curves, places=places, second_places=second_places, family=of, families=merged)


@dataclass(frozen=True)
class _Merged:
    """A family of all curves of one sort: the sort, and whether second places are those on a sheet."""

    key: object
    family: Family
    on_second: bool


def _merged(family: Family, sheets: Sheets) -> _Merged | None:
    """What a family becomes; None where it stays alone."""
    if isinstance(family, SheetsMeet):
        one, two = (int(sheets.group[number]) for number in (family.sheet, family.second))
        surface, other = sheets.groups[one].as_one, sheets.groups[two].as_one
        if not isinstance(surface, OnParametrised) or not isinstance(other, OnParametrised):
            return None
        return _Merged(("meetings", one, two), replace(family, surface=surface, other=other), True)
    if not isinstance(family, ON_ONE) or family.second != NONE:
        return None
    group = int(sheets.group[family.sheet])
    surface = sheets.groups[group].as_one
    if group == NONE or not isinstance(surface, StackedSheets):
        return None
    if isinstance(family, ParameterCurves) and family.weighted is not None:
        return None
    degrees = family.degrees_along if isinstance(family, ParameterCurves) else ()
    key = (type(family), group, _said(family) if isinstance(family, ConditionCurves) else degrees)
    return _Merged(key, replace(family, surface=surface), False)


def _said(family: ConditionCurves) -> tuple[object, ...]:
    """Equal for conditions that differ in their surfaces only."""
    condition = family.condition
    values = [value for name, value in vars(condition).items() if name != "surface"]
    return (type(condition), *(np.asarray(value, dtype=np.float64).tobytes() for value in values))

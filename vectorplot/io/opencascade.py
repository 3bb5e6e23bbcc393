"""The binding of OpenCASCADE, which differs from version to version: 7.9 and 8.0 are known."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator
from importlib import import_module
from typing import Any


def occ(module: str) -> Any:
    """A module of the binding. Errors: ImportError where it is not installed."""
    return import_module(f"OCP.{module}")


class Numbers:
    """Numbers of shapes of OpenCASCADE, from 0 as they come: the same for what is the same shape in the same place,
    whichever way round it is."""

    def __init__(self) -> None:
        self._known = defaultdict[int, list[tuple[Any, int]]](list)
        self._count = 0

    def of(self, shape: Any) -> int:
        """The number of a shape, a new one for a new shape."""
        alike = self._known[hash(shape)]
        found = next((number for one, number in alike if one.IsSame(shape)), None)
        if found is None:
            found, self._count = self._count, self._count + 1
            alike.append((shape, found))
        return found


def explored(shape: Any, kind: str, outside: str = "SHAPE") -> Iterator[Any]:
    """The parts of a shape of a kind, such as FACE, that are in none of another kind."""
    kinds, topods = occ("TopAbs").TopAbs_ShapeEnum, occ("TopoDS").TopoDS
    name = kind.capitalize()
    cast = getattr(topods, f"{name}_s", None) or getattr(topods, name)
    explorer = occ("TopExp").TopExp_Explorer(
        shape, getattr(kinds, f"TopAbs_{kind}"), getattr(kinds, f"TopAbs_{outside}")
    )
    while explorer.More():
        yield cast(explorer.Current())
        explorer.Next()

"""Records: frozen dataclasses of arrays in which every field says one thing of every element; chosen, and put together.

A field has one row for every element, or, where it is marked with IN_COLUMNS, one column; one that is None stays so,
and one that is marked with APART, which belongs to none of them. A field may be such a record itself.
What is said of polylines, and of their points, is in polylines.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import Field, fields, replace
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, Self, TypeVar

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Ints

_COLUMNS = "columns"

BELONGS_TO = "belongs to"
"""The key under which a field says what its rows are of."""

APART = {BELONGS_TO: "none"}
"""Marks a field that belongs to none of the elements: single points, nodes, or what is true of all."""

IN_COLUMNS = {_COLUMNS: True}
"""Marks a field whose last index, not its first one, is that of the element: (3,n) points, (4,n) planes."""


class Record(Protocol):
    """A frozen dataclass of arrays."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]


R = TypeVar("R", bound=Record)


class Elements:
    """What records of elements give: some of these."""

    if TYPE_CHECKING:
        __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    def take(self, which: Ints | Bools) -> Self:
        """Some of the elements, see `take`."""
        return take(self, which)


def take(record: R, which: Ints | Bools) -> R:
    """Some of the elements, with all that is said of them: those with these indices, in this order; or those where a
    mask is true."""
    chosen = which.nonzero()[0] if which.dtype == np.bool_ else which
    values = {f: getattr(record, f.name) for f in fields(record) if f.metadata != APART}
    return replace(record, **{f.name: entries(f, v, chosen) for f, v in values.items() if v is not None})


def joined(records: Sequence[R]) -> R:
    """All elements of at least one record, one record after the other, with all that is said of them."""
    values = {f: [getattr(record, f.name) for record in records] for f in fields(records[0]) if f.metadata != APART}
    return replace(records[0], **{f.name: in_a_row(f, v) for f, v in values.items() if v[0] is not None})


def entries(f: Field[Any], values: NDArray[Any], which: Ints | Bools | slice) -> NDArray[Any]:
    """What the values of a field say of some of its elements."""
    if isinstance(values, Elements):
        return values.take(which)
    if isinstance(which, slice):
        return values[..., which] if _COLUMNS in f.metadata else values[which]
    axis = values.ndim - 1 if _COLUMNS in f.metadata else 0
    # take moves rows and columns several times as fast as an index between brackets does.
    return values.take(which.nonzero()[0] if which.dtype == np.bool_ else which, axis=axis)


def in_a_row(f: Field[Any], values: Sequence[NDArray[Any]]) -> NDArray[Any]:
    """The values (v, ...) of a field, one after the other."""
    return np.concatenate(values, axis=-1 if f.metadata.get(_COLUMNS) else 0)

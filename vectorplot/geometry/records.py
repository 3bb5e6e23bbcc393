"""Records: frozen dataclasses of arrays in which every field says one thing of every element; chosen, and put together.

A field has one row for every element, or, where it is marked with IN_COLUMNS, one column; one that is None stays so.
What is said of polylines, and of their points, is in polylines.py.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import Field, fields, replace
from typing import Any, ClassVar, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Ints

_COLUMNS = "columns"

IN_COLUMNS = {_COLUMNS: True}
"""Marks a field whose last index, not its first one, is that of the element: (3,n) points, (4,n) planes."""


class Record(Protocol):
    """A frozen dataclass of arrays."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]


R = TypeVar("R", bound=Record)


def take(record: R, which: Ints | Bools) -> R:
    """Some of the elements, with all that is said of them: those with these indices, in this order; or those where a
    mask is true."""
    chosen = which.nonzero()[0] if which.dtype == np.bool_ else which
    values = {f: getattr(record, f.name) for f in fields(record)}
    return replace(record, **{f.name: entries(f, v, chosen) for f, v in values.items() if v is not None})


def joined(records: Sequence[R]) -> R:
    """All elements of at least one record, one record after the other, with all that is said of them."""
    values = {f: [getattr(record, f.name) for record in records] for f in fields(records[0])}
    return replace(records[0], **{f.name: in_a_row(f, v) for f, v in values.items() if v[0] is not None})


def entries(f: Field[Any], values: NDArray[Any], which: Ints | Bools | slice) -> NDArray[Any]:
    """What the values of a field say of some of its elements."""
    if isinstance(which, slice):
        return values[..., which] if _COLUMNS in f.metadata else values[which]
    axis = values.ndim - 1 if _COLUMNS in f.metadata else 0
    # take moves rows and columns several times as fast as an index between brackets does.
    return values.take(which.nonzero()[0] if which.dtype == np.bool_ else which, axis=axis)


def in_a_row(f: Field[Any], values: Sequence[NDArray[Any]]) -> NDArray[Any]:
    """The values (v, ...) of a field, one after the other."""
    return np.concatenate(values, axis=-1 if f.metadata.get(_COLUMNS) else 0)

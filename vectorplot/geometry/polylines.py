"""Polylines and polygons, and what is said of each point and of each line: chosen, put together, led round.

Curves on a surface, in faces of a mesh, on two sheets or on a page are polylines of which more is known: parameters
beside every point, a level or a kind beside every line. Such a type has the fields ``offsets`` and mostly ``closed`` as
Polylines have them, and marks with EACH_POINT, EACH_LINE, APART or DOUBTS what its other fields belong to; the
functions here then take care of all of them. Fields of coordinates (3,p) are marked with IN_COLUMNS of records.py as
well.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import Field, dataclass, field, fields, replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any, ClassVar, Protocol, Self, TypeVar

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.records import BELONGS_TO, entries, in_a_row

EACH_POINT = {BELONGS_TO: "point"}
"""Marks a field with one row for every point."""

EACH_LINE = {BELONGS_TO: "line"}
"""Marks a field with one row for every polyline."""

DOUBTS = {BELONGS_TO: "doubts"}
"""Marks a field with sentences about all polylines."""


class LineRecord(Protocol):
    """A frozen dataclass with polylines that may be open only."""

    __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

    @property
    def offsets(self) -> Ints:
        """(m+1,): polyline i has the points offsets[i] to offsets[i+1]."""


class RingRecord(LineRecord, Protocol):
    """A frozen dataclass with polylines that may be closed."""

    @property
    def closed(self) -> Bools:
        """(m,): the last point joins the first, which is not repeated."""


L = TypeVar("L", bound=LineRecord)


class LineElements:
    """What records of polylines or polygons give: some of these."""

    if TYPE_CHECKING:
        __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

        @property
        def offsets(self) -> Ints:
            """(m+1,)."""

    def take(self, which: Ints | Bools) -> Self:
        """Some of the polylines, see `take`."""
        return take(self, which)


class NumberedLines:
    """What polylines with points of their own give by number: how many there are, and the points of each."""

    if TYPE_CHECKING:
        __dataclass_fields__: ClassVar[dict[str, Field[Any]]]

        @property
        def points(self) -> Floats:
            """(p,d)."""

        @property
        def offsets(self) -> Ints:
            """(m+1,)."""

        @property
        def closed(self) -> Bools:
            """(m,)."""

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __getitem__(self, line: int) -> Floats:
        """(k,d) the points of a polyline; a closed one ends with its first point."""
        return self.points[indices_along(self, line)]


@dataclass(frozen=True, eq=False)
class Polylines(NumberedLines):
    """Polylines, open and closed.

    points (p,d); offsets (m+1,): polyline i has the points offsets[i] to offsets[i+1]; closed (m,): the last point
    joins the first, which is not repeated.
    Edge cases: no polylines at all is points (0,d), offsets (1,).
    """

    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    closed: Bools = field(metadata=EACH_LINE)


@dataclass(frozen=True, eq=False)
class Rounds:
    """Polylines led back to where they begin: index (n,) of points, line after line, those of a closed one with its
    first once more at the end; offsets (m+1,) of the lines then; again (c,): where in index the points stand that come
    once more, and start (c,): which they are."""

    index: Ints
    offsets: Ints
    again: Ints
    start: Ints


def closed_round(lines: RingRecord) -> Rounds:
    """The polylines as open ones: closed ones come back to their first point."""
    sizes = np.diff(lines.offsets)
    goes_round = lines.closed & (sizes > 0)
    offsets = ragged.offsets(sizes + goes_round)
    index = ragged.ranges(lines.offsets[:-1], sizes + goes_round)
    again, start = offsets[1:][goes_round] - 1, lines.offsets[:-1][goes_round]
    index[again] = start
    return Rounds(index, offsets, again, start)


def indices_along(lines: RingRecord, line: int) -> Ints:
    """(k,) the points of one polyline in order; a closed one ends with its first point.

    Errors: IndexError for a number that no polyline has, so that loops over them end; -1 is the last one.
    """
    closed = bool(lines.closed[line])
    first, end = lines.offsets[np.arange(len(lines.closed))[line] + np.array([0, 1])]
    return np.append(np.arange(first, end), [first] * bool(closed and end > first)).astype(np.intp)


def segments(lines: RingRecord) -> Ints:
    """(s,2) the points at which the segments of polylines begin and end, those that close them in their places."""
    rounds = closed_round(lines)
    begins = np.ones(len(rounds.index), dtype=np.bool_)
    begins[rounds.offsets[1:][np.diff(rounds.offsets) > 0] - 1] = False
    at = np.flatnonzero(begins)
    return np.stack([rounds.index[at], rounds.index[at + 1]], axis=1)


def take(lines: L, which: Ints | Bools) -> L:
    """Some of the polylines, with all that is said of them: those with these indices, in this order; or those where a
    mask is true."""
    if which.dtype == np.bool_ and which.all():
        return lines
    points, offsets = ragged.take(lines.offsets, which)
    return _with_rows(lines, points, which, offsets)


def split(lines: L, bounds: Ints) -> list[L]:
    """The polylines in parts, with all that is said of them: part k has those from bounds[k] to bounds[k+1]."""
    ends = bounds.tolist()
    at = lines.offsets[bounds].tolist()
    said = [(f, getattr(lines, f.name)) for f in fields(lines) if BELONGS_TO in f.metadata]
    of_points = [(f, values) for f, values in said if f.metadata[BELONGS_TO] == "point" and values is not None]
    of_lines = [(f, values) for f, values in said if f.metadata[BELONGS_TO] == "line" and values is not None]

    def part(k: int, begin: int, end: int) -> L:
        points, which = slice(at[k], at[k + 1]), slice(begin, end)
        rows = {f.name: entries(f, values, points) for f, values in of_points}
        rows |= {f.name: entries(f, values, which) for f, values in of_lines}
        return replace(lines, offsets=lines.offsets[begin : end + 1] - at[k], **rows)

    return [part(k, begin, end) for k, (begin, end) in enumerate(pairwise(ends))]


def with_points(lines: L, points: Ints, which: Ints, offsets: Ints) -> L:
    """Polylines through the points with these indices, and offsets (k+1,) among them; all else that is said of each is
    what is said of the one of these lines (k,)."""
    return _with_rows(lines, points, which, offsets)


def with_points_kept(lines: L, kept: Bools) -> L:
    """The polylines with those of their points (p,) that are kept, without those that keep less than two."""
    owner = ragged.owner(np.diff(lines.offsets))
    counts = np.bincount(owner[kept], minlength=len(lines.offsets) - 1)
    real = counts > 1
    return _with_rows(lines, kept & real[owner], real, ragged.offsets(counts[real]))


def _with_rows(lines: L, points: Ints | Bools | slice, which: Ints | Bools | slice, offsets: Ints) -> L:
    values = {f.name: getattr(lines, f.name) for f in fields(lines)}
    chosen = {"point": points, "line": which}
    rows = {
        f.name: entries(f, values[f.name], chosen[f.metadata[BELONGS_TO]])
        for f in fields(lines)
        if f.metadata.get(BELONGS_TO) in chosen and values[f.name] is not None
    }
    return replace(lines, offsets=offsets, **rows)


def joined(parts: Sequence[L]) -> L:
    """All polylines of at least one part, one part after the other, with all that is said of them; a doubt that several
    parts have is said once. A field without a mark, or with nothing in it, is that of the first part."""
    rows: dict[str, Any] = {}
    for f in fields(parts[0]):
        values = [getattr(part, f.name) for part in parts]
        if f.metadata == DOUBTS:
            rows[f.name] = tuple(dict.fromkeys(text for texts in values for text in texts))
        elif BELONGS_TO in f.metadata and values[0] is not None:
            rows[f.name] = in_a_row(f, values)
    offsets = ragged.offsets(np.concatenate([np.diff(part.offsets) for part in parts]))
    return replace(parts[0], offsets=offsets, **rows)


# Polylines in space.


@dataclass(frozen=True, eq=False)
class Strokes:
    """Polylines in space.

    Parameters
    ----------
    points : (p, 3) array of float
        In world units.
    offsets : (m+1,) array of int
        Stroke i has the points offsets[i] to offsets[i+1].
    kind : (m,) array of int
        LineKind values.
    item : (m,) array of int
        Index of the item a stroke belongs to.

    Notes
    -----
    Edge cases: no strokes at all is points (0,3), offsets (1,).

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> kind = np.array([vp.LineKind.CURVE])
    >>> strokes = vp.Strokes(np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0)]), np.array([0, 2]), kind, np.array([0]))
    >>> len(strokes)
    1
    """

    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    kind: Ints = field(metadata=EACH_LINE)
    item: Ints = field(metadata=EACH_LINE)

    def __len__(self) -> int:
        return len(self.offsets) - 1

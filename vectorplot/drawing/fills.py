"""Filled polygons on the page, painted one over the other."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, joined, take

Colours = NDArray[np.uint8]

SEAM_MM = 0.15
"""Opaque polygons are stroked in their own colour with a line of this width, so that the paper does not shine through
between neighbours, both of which cover a pixel in part only. A line as wide as a pixel does that: this one does from
170 dots per inch on. A polygon grows by half of it. Blank ones (FillKind.BACKGROUND) are not stroked: there is nothing
of them to be seen."""


class FillKind(IntEnum):
    """What a filled polygon is.

    Examples
    --------
    >>> from vectorplot.drawing import FillKind
    >>> FillKind.CLEAR_SHADOW.word
    'clear_shadow'
    >>> [kind.word for kind in FillKind][:3]
    ['face', 'shadow', 'shadow_border']
    """

    FACE = 0
    """A face, or a part of one."""
    SHADOW = 1
    """A part of a face that light does not reach."""
    SHADOW_BORDER = 2
    """The soft border of a shadow (aura)."""
    CLEAR_SHADOW = 3
    """A part of a face that light reaches through something transparent."""
    PATTERN = 4
    """A coloured polygon on a face."""
    REFLECTION = 5
    """What a mirror shows."""
    LIGHT = 6
    """A part of a face that light reaches by way of a mirror."""
    GLASS = 7
    """A face that one sees through."""
    EDGE = 8
    """A line between two points."""
    BACKGROUND = 9
    """The paper, or a blank polygon that hides what is behind it."""
    BAND = 10
    """A band of equal shade on a round body, which reaches under the next brighter one."""

    @property
    def word(self) -> str:
        """The kind as the JSON file spells it."""
        return self.name.lower()


@dataclass(frozen=True, eq=False)
class Fills:
    """Filled polygons, each painted over those before it.

    Parameters
    ----------
    points : (p, 2) array of float
        On the page in mm, y upwards.
    offsets : (m+1,) array of int
        Polygon k has the corners offsets[k] to offsets[k+1].
    colours : (p, 3) array of uint8
        Red, green and blue of every corner.
    opacity : (m,) array of float
        0 (clear) to 1.
    item : (m,) array of int
        Indices into Drawing.items, -1 for none.
    points3d : (p, 3) array of float
        The same points in the world.
    kind : (m,) array of int
        FillKind values.

    Raises
    ------
    InputError
        Where the arrays do not fit together.

    Notes
    -----
    A polygon is simple, wound either way; one with holes is cut open to them first. One of two corners is a line, as
    wide as the pen of its layer, in the mean of their colours. A polygon whose corners have one colour is flat, any
    other one is convex, and shaded linearly over each triangle of the fan from its first corner.

    Source: Glaeser, sections 4.5 and 5.1.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot.drawing import Fills
    >>> triangle = np.array([(10.0, 10.0), (90.0, 10.0), (50.0, 70.0)])
    >>> red = np.array([(255, 0, 0)], dtype=np.uint8)
    >>> fills = Fills.flat(triangle, np.array([0, 3]), red)
    >>> fills
    <Fills: 1 polygons, 3 corners>
    >>> vp.Drawing(100, 80, (vp.Layer("faces", vp.Pen(), (fills,)),))
    <Drawing '': 100x80 mm, marks: faces 1>
    """

    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    colours: Colours = field(metadata=EACH_POINT)
    opacity: Floats = field(metadata=EACH_LINE)
    item: Ints = field(metadata=EACH_LINE)
    points3d: Floats = field(metadata=EACH_POINT)
    kind: Ints = field(metadata=EACH_LINE)

    def __post_init__(self) -> None:
        p, m = len(self.points), len(self.offsets) - 1
        fits = self.points.shape == (p, 2) and self.points3d.shape == (p, 3) and self.colours.shape == (p, 3)
        fits &= all(column.shape == (m,) for column in (self.opacity, self.item, self.kind))
        if not (
            fits and m >= 0 and self.offsets[0] == 0 and self.offsets[-1] == p and (np.diff(self.offsets) >= 0).all()
        ):
            raise InputError(f"fills: {p} points and {m} polygons do not fit the other columns")
        if self.colours.dtype != np.uint8:
            raise InputError(f"fills: colours are of type {self.colours.dtype}, not uint8")

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __repr__(self) -> str:
        return f"<Fills: {len(self)} polygons, {len(self.points)} corners>"

    @classmethod
    def empty(cls) -> Fills:
        """No polygons at all.

        result: of length 0.
        """
        none = np.zeros(0, dtype=np.intp)
        colours = np.zeros((0, 3), dtype=np.uint8)
        return cls(np.zeros((0, 2)), np.zeros(1, dtype=np.intp), colours, np.zeros(0), none, np.zeros((0, 3)), none)

    @classmethod
    def flat(
        cls,
        points: Floats,
        offsets: Ints,
        colours: Colours,
        *,
        points3d: Floats | None = None,
        opacity: ArrayLike = 1.0,
        item: ArrayLike = -1,
        kind: ArrayLike = FillKind.FACE,
    ) -> Fills:
        """Polygons of one colour each.

        points (p,2): on the page in mm, y upwards; offsets (m+1,): polygon k has the corners offsets[k] to
        offsets[k+1]; colours (m,3): red, green and blue; points3d (p,3): the same points in the world; where None, the
        world is the page; opacity, item, kind: for each polygon (m,), or one for all; result: the polygons in the same
        order.
        Errors: for what Fills refuses.
        """
        count = len(offsets) - 1
        solid = np.column_stack((points, np.zeros(len(points)))) if points3d is None else points3d
        return cls(
            points,
            offsets,
            np.repeat(colours, np.diff(offsets), axis=0),
            np.array(np.broadcast_to(np.asarray(opacity, dtype=np.float64), count)),
            np.array(np.broadcast_to(np.asarray(item, dtype=np.intp), count)),
            solid,
            np.array(np.broadcast_to(np.asarray(kind, dtype=np.intp), count)),
        )

    @classmethod
    def whole_page(cls, width_mm: float, height_mm: float, colour: Colours) -> Fills:
        """A sheet of paper in a colour.

        width_mm, height_mm: the sides of the page; colour (3,): red, green and blue; result: one polygon of the kind
        BACKGROUND.
        """
        corners = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]) * (width_mm, height_mm)
        return cls.flat(corners, np.array([0, 4]), colour[None, :], kind=FillKind.BACKGROUND)

    @classmethod
    def joined(cls, *parts: Fills) -> Fills:
        """The polygons of all parts, one part after the other.

        parts: as many as there are, also none; result: in the same order.
        """
        return joined(parts or (cls.empty(),))

    def take(self, which: Ints) -> Fills:
        """The polygons with these numbers, in this order.

        which (k,): numbers from 0, each one as often as wanted; result: k polygons.
        """
        return take(self, which)

    def in_triangles(self) -> Fills:
        """The same picture, with the triangles of their fans in place of shaded polygons.

        result: flat polygons, and shaded ones of three corners.
        """
        first = self.offsets[:-1]
        differs = (self.colours != np.repeat(self.colours[first], np.diff(self.offsets), axis=0)).any(axis=1)
        shaded = np.zeros(len(self), dtype=np.bool_)
        shaded[ragged.owner(np.diff(self.offsets))[differs]] = True
        plain, fan = self.take(np.flatnonzero(~shaded)), self.take(np.flatnonzero(shaded))
        corners, of = ragged.fans(fan.offsets)
        at = corners.ravel()
        triangles = Fills(
            fan.points[at],
            3 * np.arange(len(of) + 1),
            fan.colours[at],
            fan.opacity[of],
            fan.item[of],
            fan.points3d[at],
            fan.kind[of],
        )
        number = np.concatenate([np.flatnonzero(~shaded), np.flatnonzero(shaded)[of]])
        return Fills.joined(plain, triangles).take(np.argsort(number, kind="stable"))

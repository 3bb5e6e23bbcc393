"""The display list: what a backend needs to know, and nothing else."""

from __future__ import annotations

from base64 import b64encode
from collections.abc import Collection, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.arcs import EllipseArcs
from vectorplot.curves.bezier import BezierPaths
from vectorplot.drawing.fills import Fills
from vectorplot.drawing.texts import Texts
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT
from vectorplot.words import LineKind

if TYPE_CHECKING:
    from vectorplot.save import Destination

NO_CURVE = -1
"""Of what is no curve, or nobody knows which."""


@dataclass(frozen=True)
class Pen:
    """A pen: width of the stroke in mm, colour as #rrggbb, and dashes.

    Parameters
    ----------
    width_mm : float
        Width of the stroke in mm.
    colour : str
        #rrggbb.
    dash_mm : (float, float), optional
        Dash and gap in mm of the strokes that are drawn with it, which are real strokes then; none where None or 0.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Pen(width_mm=0.5)
    Pen(width_mm=0.5, colour='#000000', dash_mm=None)
    """

    width_mm: float = 0.3
    colour: str = "#000000"
    dash_mm: tuple[float, float] | None = None


@dataclass(frozen=True, eq=False)
class Paths:
    """Many stroked polylines on the page.

    Parameters
    ----------
    points : (p, 2) array of float
        In mm, y upwards from the lower left corner.
    offsets : (m+1,) array of int
        Path i has the points offsets[i] to offsets[i+1].
    closed : (m,) array of bool
        The last point joins the first (which is not repeated).
    kind : (m,) array of int
        LineKind values.
    item : (m,) array of int
        Indices into Drawing.items.
    hidden_by : (m,) array of int
        Number of items in front, 0 = visible.
    points3d : (p, 3) array of float
        The same points in the world.
    smooth : (m,) array of bool
        The points lie on a smooth curve, between them is more of it; none does unless said otherwise.
    directions : (p, 2) array of float
        Angles in radians, from the page's x axis, at which the curve that a smooth path follows arrives at each point
        and leaves it; they differ in corners and cusps. NaN, as everywhere unless said otherwise, where they are not
        known.
    curve : (m,) array of int
        The curve that a path is a part of, by a number of its own in the drawing; -1, as everywhere unless said
        otherwise, where it is none or not known. Of a path that follows several curves that of its first part.
    handles : (p, 2) array of float
        The lengths in mm of the handles, from each point back and ahead, of the Bézier curves that are exactly, or but
        for a ten-thousandth of a mm, the curve that a smooth path follows from point to point. NaN, as everywhere
        unless said otherwise, where there are none.
    lamp : (m,) array of int
        The lamp, by its number among those that shine, whose light ends at a path that is a terminator or the edge of a
        shadow; 0, as everywhere unless said otherwise, for all other paths.

    Examples
    --------
    >>> import vectorplot as vp
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> drawing = vp.draw(vp.Scene((vp.Item("triangle", triangle),)))
    >>> paths = [strokes for layer in drawing.layers for strokes in layer.strokes if len(strokes)]
    >>> paths[0].points.shape, paths[0].closed.tolist()
    ((3, 2), [True])
    """

    points: Floats = field(metadata=EACH_POINT)
    offsets: Ints
    closed: Bools = field(metadata=EACH_LINE)
    kind: Ints = field(metadata=EACH_LINE)
    item: Ints = field(metadata=EACH_LINE)
    hidden_by: Ints = field(metadata=EACH_LINE)
    points3d: Floats = field(metadata=EACH_POINT)
    smooth: Bools = field(default_factory=lambda: np.zeros(0, dtype=np.bool_), metadata=EACH_LINE)
    directions: Floats = field(default_factory=lambda: np.zeros((0, 2)), metadata=EACH_POINT)
    curve: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.intp), metadata=EACH_LINE)
    handles: Floats = field(default_factory=lambda: np.zeros((0, 2)), metadata=EACH_POINT)
    lamp: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.intp), metadata=EACH_LINE)

    def __post_init__(self) -> None:
        if not len(self.smooth):
            object.__setattr__(self, "smooth", np.zeros(len(self), dtype=np.bool_))
        if not len(self.directions) and len(self.points):
            object.__setattr__(self, "directions", np.full((len(self.points), 2), np.nan))
        if not len(self.handles) and len(self.points):
            object.__setattr__(self, "handles", np.full((len(self.points), 2), np.nan))
        if not len(self.curve):
            object.__setattr__(self, "curve", np.full(len(self), NO_CURVE))
        if not len(self.lamp):
            object.__setattr__(self, "lamp", np.zeros(len(self), dtype=np.intp))

    def __len__(self) -> int:
        return len(self.offsets) - 1

    @classmethod
    def of_polylines(
        cls,
        polylines: Iterable[ArrayLike],
        *,
        closed: ArrayLike = False,
        kind: ArrayLike = LineKind.CURVE,
        item: ArrayLike = 0,
    ) -> Paths:
        """Paths from polylines of one's own.

        Parameters
        ----------
        polylines : iterable of (k, 2) array_like of float
            Points in mm on the page, y upwards; k, two or more, differs from one to the next.
        closed : (m,) array_like of bool, or bool
            Which polylines are closed; one whose last point repeats the first is closed as well, and loses the repeated
            point.
        kind, item : (m,) array_like of int, or int
            What kind of line each is, and of which item; one number counts for all.

        Returns
        -------
        Paths
            Visible ones, in this order. Their points in space (points3d) are those on the page, at height 0.

        Raises
        ------
        InputError
            For a polyline of fewer than two points, or with points that are not two finite numbers; for closed, kind or
            item with neither one entry nor one for each polyline.

        Examples
        --------
        >>> import vectorplot as vp
        >>> paths = vp.Paths.of_polylines([[(10, 10), (40, 10)], [(10, 20), (40, 20), (25, 40), (10, 20)]])
        >>> paths.offsets.tolist(), paths.closed.tolist()
        ([0, 2, 5], [False, True])
        """
        lines = _lines_of(polylines)
        rounds, kinds, items = (_of_each(entries, len(lines)) for entries in (closed, kind, item))
        repeated = np.array([len(line) > 2 and (line[0] == line[-1]).all() for line in lines], dtype=np.bool_)
        lines = [line[:-1] if again else line for line, again in zip(lines, repeated.tolist(), strict=True)]
        points = np.concatenate([np.zeros((0, 2)), *lines])
        return cls(
            points,
            ragged.offsets(np.array([len(line) for line in lines], dtype=np.intp)),
            rounds.astype(np.bool_) | repeated,
            kinds.astype(np.intp),
            items.astype(np.intp),
            np.zeros(len(lines), dtype=np.intp),
            np.column_stack([points, np.zeros(len(points))]),
        )

    @classmethod
    def empty(cls) -> Paths:
        """No paths at all."""
        none = np.zeros(0, dtype=np.intp)
        one, flags = np.zeros(1, dtype=np.intp), np.zeros(0, dtype=np.bool_)
        return cls(np.zeros((0, 2)), one, flags, none, none, none, np.zeros((0, 3)))


def _lines_of(polylines: Iterable[ArrayLike]) -> list[Floats]:
    """The polylines (k,2). Errors: InputError as in Paths.of_polylines."""
    lines = [np.asarray(line, dtype=np.float64) for line in polylines]
    for number, line in enumerate(lines):
        if line.ndim != 2 or line.shape[1] != 2 or len(line) < 2 or not np.isfinite(line).all():
            raise InputError(f"polyline {number}: expected two or more points of two finite numbers")
    return lines


def _of_each(entries: ArrayLike, count: int) -> NDArray[Any]:
    """(count,) entries, or one that counts for all. Errors: InputError for another number of them."""
    own = np.asarray(entries)
    if own.shape not in ((), (count,)):
        raise InputError(f"closed, kind and item: expected one entry, or {count}")
    return np.broadcast_to(own, count)


@dataclass(frozen=True, eq=False)
class CurvedStrokes:
    """Strokes of which some are drawn as curves.

    paths: all of them as polylines; beziers: one path for each, in mm, without segments for a stroke that is drawn as
    its polyline; arcs: those of them that are arcs of ellipses.
    Paths and arcs begin and end where their polylines do.
    """

    paths: Paths
    beziers: BezierPaths
    arcs: EllipseArcs

    def __len__(self) -> int:
        return len(self.paths)


STROKES = (Paths, CurvedStrokes)
"""The marks that a pen draws."""


@dataclass(frozen=True, eq=False)
class Layer:
    """Marks in drawing order: strokes drawn with one pen, filled polygons, and texts in the pen's colour.

    Parameters
    ----------
    name : str
        What the layer holds, such as ``visible``.
    pen : Pen
        What draws its strokes.
    marks : tuple of Paths, CurvedStrokes, Fills and Texts
        In drawing order.
    plotted : bool
        False for a layer that is there to be looked at only (its label gets the prefix % that plotter drivers skip).

    Examples
    --------
    >>> import vectorplot as vp
    >>> layer = vp.Layer("visible", vp.Pen(), (vp.Paths.empty(),))
    >>> len(layer.strokes), len(layer.fills), layer.plotted
    (1, 0, True)
    """

    name: str
    pen: Pen
    marks: tuple[Paths | CurvedStrokes | Fills | Texts, ...]
    plotted: bool = True

    @property
    def strokes(self) -> tuple[Paths, ...]:
        """The polylines of all marks that are strokes."""
        strokes = (mark for mark in self.marks if isinstance(mark, STROKES))
        return tuple(mark.paths if isinstance(mark, CurvedStrokes) else mark for mark in strokes)

    @property
    def fills(self) -> tuple[Fills, ...]:
        """All marks that are filled polygons."""
        return tuple(mark for mark in self.marks if isinstance(mark, Fills))

    @property
    def texts(self) -> tuple[Texts, ...]:
        """All marks that are texts."""
        return tuple(mark for mark in self.marks if isinstance(mark, Texts))


@dataclass(frozen=True, eq=False)
class Drawing:
    """A page in mm and its layers in drawing order.

    Parameters
    ----------
    width_mm, height_mm : float
        The sides of the page.
    layers : tuple of Layer
        In drawing order.
    items : tuple of str
        The names of the items the marks belong to.
    title : str
        What it shows.
    page_from_world : (4, 4) array of float
        Acts on columns (x,y,z,1); divide by the last component to get mm.
    font : str
        The family that its texts are set in, or a file of a font, which SVG holds then; what the reader has where
        nothing is said.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Drawing(100, 80, (vp.Layer("visible", vp.Pen(), (vp.Paths.empty(),)),), title="Nothing")
    <Drawing 'Nothing': 100x80 mm, marks: visible 0>
    """

    width_mm: float
    height_mm: float
    layers: tuple[Layer, ...]
    items: tuple[str, ...] = ()
    title: str = ""
    page_from_world: Floats = field(default_factory=lambda: np.eye(4))
    font: str = ""

    def __repr__(self) -> str:
        layers = ", ".join(f"{layer.name} {sum(map(len, layer.marks))}" for layer in self.layers)
        return f"<Drawing {self.title!r}: {self.width_mm:g}x{self.height_mm:g} mm, marks: {layers or 'none'}>"

    def save(self, path: Destination, *, format: str | None = None) -> None:
        """Write the drawing in the format of the suffix, or in a named one, as `vp.save` does.

        Parameters
        ----------
        path : str, path or file object
            The file: svg, ps, eps, pdf, png, tex, dxf, json; or an open one.
        format : str, optional
            In place of the suffix; needed for an open file.

        Raises
        ------
        InputError
            For an unknown suffix or format.
        OSError
            Where the file cannot be written.

        Examples
        --------
        >>> import os, tempfile
        >>> import vectorplot as vp
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     vp.Drawing(100, 80, ()).save(os.path.join(folder, "empty.svg"))
        ...     os.listdir(folder)
        ['empty.svg']
        """
        from vectorplot.save import save

        save(self, path, format=format)

    def _repr_mimebundle_(
        self, include: Collection[str] | None = None, exclude: Collection[str] | None = None
    ) -> dict[str, str]:
        """What a notebook shows and stores: SVG, or PNG where there are very many marks; the other one if asked for."""
        from vectorplot.save import SHOWN, shown_as, write

        for format in shown_as(self):
            kind = SHOWN[format]
            if (not include or kind in include) and kind not in (exclude or ()):
                content = write(self, format)
                return {kind: content.decode() if format == "svg" else b64encode(content).decode()}
        return {}

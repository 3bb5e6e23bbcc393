"""Arrows, axes, dimensions, angles, radii, leaders and centre lines as curves in space, with labels at them."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve, is_curve, vector
from vectorplot.curves.families import Circle, Line
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import component_sum, cross, norm, normalize
from vectorplot.scene.item import Item
from vectorplot.scene.labels import (
    DEFAULT_SIZE_MM,
    IN_WORLD,
    MEASURE,
    Along,
    AtVertex,
    BesidePoint,
    Label,
    Measures,
    OnCurve,
    OnPage,
    capital_height,
)
from vectorplot.scene.scene import Scene, together
from vectorplot.surfaces.surface import is_parametrised
from vectorplot.tolerances import ROUNDING

# Arrows and axes: curves in space, hidden like any others, and labels at them.

OWN_LINES = ("label", "centre")
"""What annotations are drawn as."""

PLACES = 17
"""On each annotation, which say how far it reaches."""

MOST_TICKS = 1000
"""On one axis."""


def arrow(
    start: ArrayLike, end: ArrayLike, text: str = "", *, name: str = "", size_mm: float | str = DEFAULT_SIZE_MM
) -> Scene:
    """A straight arrow in space, with a text at its tip.

    Parameters
    ----------
    start, end : (3,) array_like of float
        In the world; the tip is at the end.
    text : str
        What it is called.
    name : str
        Of the item; arrow and the text where none is given.
    size_mm : float or str
        Of the letters.

    Returns
    -------
    Scene
        A thin line, hidden like any other curve, and a label with an arrowhead, to be drawn together with others.

    Raises
    ------
    InputError
        For an arrow without length.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.surfaces import Sphere
    >>> drawing = vp.draw([Sphere(1.0), vp.arrow((0, 0, 1), (0, 0, 2), "n")])
    >>> drawing.items
    ('sphere', 'arrow n')
    """
    item = thin_line(name or f"arrow {text}".strip(), Line.through(start, end))
    return Scene((item,), labels=(Label(text, OnCurve(item.name), item.name, size_mm, mark="arrow"),))


MOST_ARROWS = 5000
"""Of one field."""


SITES = 128
"""Columns and rows of places on a surface among which those of arrows are chosen."""


def field_arrows(
    item: Item,
    field: str | Callable[[Floats], ArrayLike],
    *,
    apart: float | None = None,
    longest: float | None = None,
) -> Scene:
    """Arrows along the vectors of a field, at vertices of a mesh or places on a surface.

    Parameters
    ----------
    item : Item
        A mesh or a parametrised surface.
    field : str or callable
        The name of a field of vectors of a mesh, with the parts name.x, name.y and name.z; or what takes points (k, 3)
        in the world to vectors (k, 3).
    apart : float, optional
        One arrow for each cube with such an edge, of a mesh at its vertex that comes first, of a surface at the place
        nearest to its middle; a sixteenth of the extent where None.
    longest : float, optional
        The length of the longest one in world units, the others in proportion; as long as they are apart where None.

    Returns
    -------
    Scene
        Thin lines with arrowheads, to be drawn together with the item.

    Raises
    ------
    InputError
        For a field that the item has not, a function that gives other than (k, 3) numbers, an implicit surface or a
        curve, lengths that are not positive, and more than 5000 arrows.

    Notes
    -----
    Edge cases: no arrow where the field has no vector or one without length; InputWarning where that is so everywhere.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot.scene import Fields, field_arrows
    >>> square = vp.Mesh.from_polygons([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    >>> wind = Fields.of(square, {"wind": np.array([(0, 0, 1.0), (0, 0, 2.0), (0, 0, 0), (0, 0, 1.0)])}, {})
    >>> len(field_arrows(vp.Item("square", square, fields=wind), "wind"))
    3
    """
    points = _sites(item)
    name = field if isinstance(field, str) else "field"
    extent = float(np.ptp(points, axis=0).max()) if len(points) else 0.0
    step = extent / 16.0 if apart is None else apart
    long = step if longest is None else longest
    if not (0.0 < step < np.inf and 0.0 < long < np.inf):
        raise InputError(f"arrows of {name}: expected positive lengths, got {step:g} apart and {long:g} long")
    vectors = _vectors_at(item, field, points)
    sizes = np.sqrt(component_sum(vectors * vectors))
    there = np.flatnonzero(np.isfinite(sizes) & (sizes > 0.0))
    places = (points[there] - points.min(axis=0, initial=np.inf)) / step + ROUNDING
    cells = np.floor(places)
    if not isinstance(item.shape, Mesh):
        away = places - cells - 0.5
        order = np.argsort(component_sum(away * away), kind="stable")
        there, cells = there[order], cells[order]
    _, first = np.unique(cells, axis=0, return_index=True)
    if len(first) > MOST_ARROWS:
        raise InputError(f"arrows of {name}: {len(first)} of them, expected {MOST_ARROWS} or fewer: larger 'apart'")
    if not len(first):
        text = f"{item.name}: no arrows of {name}: it has no vectors there, or none with a length"
        warnings.warn(text, InputWarning, stacklevel=2)
        return Scene(())
    some = there[np.sort(first)]
    ways = vectors[some] * (long / float(sizes[some].max()))
    items, labels = [], []
    for number, (start, way) in enumerate(zip(points[some], ways, strict=True), start=1):
        line = thin_line(f"{item.name} {name} {number}", Line.through(start, start + way), f"{item.name} {name}")
        items.append(line)
        labels.append(Label("", OnCurve(line.name), line.name, mark="arrow"))
    return Scene(tuple(items), labels=tuple(labels))


def _sites(item: Item) -> Floats:
    """(n,3) the vertices of a mesh, or places on a surface."""
    if isinstance(item.shape, Mesh):
        return item.mesh.vertices
    if not is_parametrised(item.shape):
        raise InputError(f"{item.name}: arrows of a field stand on meshes and parametrised surfaces")
    u, v = item.shape.domain.grid(SITES, SITES)
    points = item.shape.points(*np.meshgrid(u, v, indexing="ij")).reshape(-1, 3)
    return np.asarray(points[np.isfinite(points).all(axis=1)])


def _vectors_at(item: Item, field: str | Callable[[Floats], ArrayLike], points: Floats) -> Floats:
    """(n,3) the vectors of a field, known by its name or as a function, at points."""
    if not isinstance(field, str):
        vectors = np.asarray(field(points), dtype=np.float64)
        if vectors.shape != points.shape:
            raise InputError(f"{item.name}: a field of vectors gives {points.shape}, not {vectors.shape}")
        return vectors
    if item.fields is None:
        raise InputError(f"{item.name}: there is no field {field!r}: the item has none")
    return np.asarray(item.fields.vectors(field)(points))


def axes(
    length: float | Sequence[float] = 1.0,
    *,
    origin: ArrayLike = (0.0, 0.0, 0.0),
    names: Sequence[str] = ("x", "y", "z"),
    ticks: float | None = None,
    size_mm: float | str = DEFAULT_SIZE_MM,
) -> Scene:
    """Three coordinate axes with their names, and numbers at ticks.

    Parameters
    ----------
    length : float or three of them
        Of the axes from the origin, in world units.
    origin : (3,) array_like of float
        Where they begin.
    names : three str
        At their tips.
    ticks : float, optional
        The step between ticks; without one there are none.
    size_mm : float or str
        Of the names; numbers have two thirds of it.

    Returns
    -------
    Scene
        Thin lines, hidden like any other curves, and their labels, to be drawn together with others.

    Raises
    ------
    InputError
        For lengths and a step that are not positive, and more than a thousand ticks.

    Examples
    --------
    >>> import vectorplot as vp
    >>> [label.text for label in vp.axes(2.5, ticks=1).labels]
    ['x', '1', '2', 'y', '1', '2', 'z', '1', '2']
    """
    base = vector("axes: origin", origin)
    lengths = [float(one) for one in (length if isinstance(length, Sequence) else [length] * 3)]
    if len(lengths) != 3 or len(names) != 3 or not all(0.0 < one < np.inf for one in lengths):
        raise InputError("axes: expected one positive length or three, and three names")
    if ticks is not None and not (ticks > 0.0 and max(lengths) <= MOST_TICKS * ticks):
        raise InputError(f"axes: ticks every {ticks:g}: expected a positive step, and at most {MOST_TICKS} of them")
    items, labels = [], []
    for way, one, text in zip(np.eye(3), lengths, names, strict=True):
        item = thin_line(f"axis {text}", Line.through(base, base + one * way))
        items.append(item)
        labels.append(Label(text, OnCurve(item.name), item.name, size_mm, mark="arrow"))
        steps = np.arange(1, int(one / ticks) + 1) if ticks else np.zeros(0)
        # The last tick would lie under the arrowhead.
        for at in (steps * (ticks or 0.0)).tolist():
            if at < 0.95 * one:
                place = OnCurve(item.name, at / one)
                labels.append(
                    Label(f"{at:g}", place, f"{item.name} {at:g}", capital_height(size_mm) * 2.0 / 3.0, mark="tick")
                )
    return Scene(tuple(items), labels=tuple(labels))


def is_annotation(item: Item) -> bool:
    """Whether an item is a line of an axis, a dimension, a leader or a centre line: pictures show it as they show
    labels, whatever other lines they have."""
    return is_curve(item.shape) and item.lines is not None and len(item.lines) == 1 and item.lines[0] in OWN_LINES


def only_annotations(scene: Scene) -> Scene:
    """The scene, of which only annotations have lines."""
    items = (item if is_annotation(item) else replace(item, lines=()) for item in scene.items)
    return replace(scene, items=tuple(items))


def annotation_points(scene: Scene) -> Floats:
    """(n,3) places on the annotations of a scene, their ends among them."""
    shapes = [item.shape for item in scene.items if is_annotation(item)]
    found = [shape.points(np.linspace(shape.start, shape.end, PLACES)) for shape in shapes if is_curve(shape)]
    return np.concatenate([np.zeros((0, 3)), *found])


def leader_tips(scene: Scene) -> dict[str, Floats]:
    """(3,) what each leader of a scene points at, by the name of its item: the start of a line that has its only
    arrowhead there."""
    marks = [one.at for one in scene.labels if one.mark == "arrow" and isinstance(one.at, OnCurve)]
    heads = Counter(at.item for at in marks)
    curves = {item.name: item.shape for item in scene.items if is_annotation(item) and is_curve(item.shape)}
    names = [at.item for at in marks if at.part == 0.0 and heads[at.item] == 1]
    return {name: curves[name].points(np.array(curves[name].start)) for name in names if name in curves}


def thin_line(name: str, curve: Curve, group: str = "") -> Item:
    """A curve that is drawn as leaders are; group: of the lines that belong together."""
    return Item(name, curve, "black", lines=("label",), group=group or name)


# Dimensions, angles, radii, leaders and centre lines: curves in space, and labels at them.
#
# Source: ISO 128-22 (leaders), ISO 128-24 (centre lines), ISO 129-1 (dimensions).

BEYOND, SHORT = 0.15, 0.05
"""How far extension lines go on beyond the dimension line, and how far from the thing they begin, as parts of the way
between, where nothing is said."""

CROSS = 0.2
"""Centre marks reach so far beyond the circle, in radii, where nothing is said."""


def dimension(
    start: ArrayLike,
    end: ArrayLike,
    offset: ArrayLike,
    text: str | None = None,
    *,
    size_mm: float | str = DEFAULT_SIZE_MM,
    gap: float | None = None,
    beyond: float | None = None,
) -> Scene:
    """A dimension line beside two points, with extension lines, arrowheads and its measure.

    Parameters
    ----------
    start, end : (3,) array_like of float
        Between which points is measured.
    offset : (3,) array_like of float
        From these points to the dimension line.
    text : str, optional
        What it says, with <> for the measure and <0.1> for other lengths, as in "<> H7" or "4x <> ±<0.1>": the distance
        of the points where nothing is given.
    size_mm : float or str
        Of the letters.
    gap, beyond : float, optional
        How far from the points extension lines begin, and how far beyond the dimension line they end, in world units;
        where None 0.05 and 0.15 times the offset.

    Returns
    -------
    Scene
        Thin lines, hidden like any other curves, and their labels, to be drawn together with others.

    Raises
    ------
    InputError
        For points in one place, and an offset without length; for a gap that is negative or reaches the dimension line,
        and a length beyond that is negative.

    Notes
    -----
    The look is that of ISO 129-1: arrowheads of 20 degrees, the measure above the line.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.dimension((0, 0, 0), (3, 4, 0), (0, 0, -1)).labels[-1].text
    '5'
    """
    one, other, off = (vector("dimension: a point", point) for point in (start, end, offset))
    long = float(norm(other - one))
    if not long > 0.0 or not np.any(off):
        raise InputError("dimension: two different points and an offset are needed")
    reach = float(norm(off))
    before = SHORT if gap is None else gap / reach
    behind = BEYOND if beyond is None else beyond / reach
    if not (0.0 <= before < 1.0 and 0.0 <= behind < np.inf):
        raise InputError("dimension: expected a gap before the dimension line, and a length of 0 or more beyond it")
    said, measured = _said(text, MEASURE, long)
    lines = [
        Line.through(one + before * off, one + (1.0 + behind) * off),
        Line.through(other + before * off, other + (1.0 + behind) * off),
        Line.through(one + off, other + off),
    ]
    names = [f"extension {said} 1", f"extension {said} 2", f"dimension {said}"]
    group = f"dimension {said} {_place(one)} {_place(other)} {_place(off)}"
    items = tuple(thin_line(name, line, group) for name, line in zip(names, lines, strict=True))
    return Scene(items, labels=_measured(items[2].name, said, measured, size_mm))


def angle(
    vertex: ArrayLike,
    one: ArrayLike,
    other: ArrayLike,
    radius: float,
    text: str | None = None,
    *,
    size_mm: float | str = DEFAULT_SIZE_MM,
) -> Scene:
    """The arc of an angle, with arrowheads and its measure.

    Parameters
    ----------
    vertex : (3,) array_like of float
        Of the angle.
    one, other : (3,) array_like of float
        Points on its sides.
    radius : float
        Of the arc, in world units.
    text : str, optional
        What it says, with <> for the angle in degrees and its sign: that alone where nothing is given.
    size_mm : float or str
        Of the letters.

    Returns
    -------
    Scene
        A thin arc, hidden like any other curve, and its labels, to be drawn together with others.

    Raises
    ------
    InputError
        For sides in one line, and a radius that is not positive.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.angle((0, 0, 0), (1, 0, 0), (1, 1, 0), radius=0.5).labels[-1].text
    '45°'
    """
    middle = vector("angle: vertex", vertex)
    first, second = (normalize(vector("angle: a point", point) - middle) for point in (one, other))
    axis = cross(first, second)
    sine, cosine = float(norm(axis)), float(matmul(first, second))
    if not sine > 0.0 or not 0.0 < radius < np.inf:
        raise InputError("angle: two sides that are not in one line, and a positive radius are needed")
    begins = _angle_on(Circle(middle, radius, axis), middle, first)
    arc = Circle(middle, radius, axis, begins, begins + float(arctan2(sine, cosine)))
    degrees = Measures().angle(float(np.degrees(arctan2(sine, cosine))))
    measured = f"{MEASURE}°" if text is None else text.replace(MEASURE, f"{MEASURE}°")
    said = measured.replace(MEASURE, degrees)
    item = thin_line(f"angle {said}", arc)
    # Letters along an arc that is hardly larger than they are would fall over each other.
    label = Label(said, OnCurve(item.name, 0.5), item.name, size_mm, measured=measured if MEASURE in measured else "")
    return Scene((item,), labels=(*_heads(item.name, size_mm), label))


def radius(
    centre: ArrayLike, point: ArrayLike, text: str | None = None, *, size_mm: float | str = DEFAULT_SIZE_MM
) -> Scene:
    """The dimension of a radius: a line from the centre to a point of the circle, with an arrowhead there.

    Parameters
    ----------
    centre, point : (3,) array_like of float
        In the world.
    text : str, optional
        What it says, with <> for R and the radius: these alone where nothing is given.
    size_mm : float or str
        Of the letters.

    Returns
    -------
    Scene
        A thin line, hidden like any other curve, and its labels, to be drawn together with others.

    Raises
    ------
    InputError
        For points in one place.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.radius((0, 0, 0), (3, 4, 0)).labels[-1].text
    'R5'
    """
    middle, outer = vector("radius: centre", centre), vector("radius: a point", point)
    said, measured = _said(text, f"R{MEASURE}", _distance("radius", middle, outer))
    item = thin_line(f"radius {said}", Line.through(middle, outer))
    head = Label("", OnCurve(item.name), f"{item.name} end", size_mm, mark="arrow")
    return Scene((item,), labels=(head, Label(said, Along(item.name), item.name, size_mm, "above", measured=measured)))


def diameter(
    centre: ArrayLike, point: ArrayLike, text: str | None = None, *, size_mm: float | str = DEFAULT_SIZE_MM
) -> Scene:
    """The dimension of a diameter: a line across a circle through its centre, with arrowheads.

    Parameters
    ----------
    centre : (3,) array_like of float
        In the world.
    point : (3,) array_like of float
        One of its ends, on the circle.
    text : str, optional
        What it says, with <> for ø and the diameter, as in "<> H7": these alone where nothing is given.
    size_mm : float or str
        Of the letters.

    Returns
    -------
    Scene
        A thin line, hidden like any other curve, and its labels, to be drawn together with others.

    Raises
    ------
    InputError
        For points in one place.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.diameter((0, 0, 0), (3, 4, 0)).labels[-1].text
    'ø10'
    """
    middle, outer = vector("diameter: centre", centre), vector("diameter: a point", point)
    said, measured = _said(text, f"ø{MEASURE}", 2.0 * _distance("diameter", middle, outer))
    item = thin_line(f"diameter {said}", Line.through(2.0 * middle - outer, outer))
    return Scene((item,), labels=_measured(item.name, said, measured, size_mm))


def leader(point: ArrayLike, elbow: ArrayLike, text: str, *, size_mm: float | str = DEFAULT_SIZE_MM) -> Scene:
    """A line from a text to what it is about, with an arrowhead there.

    Parameters
    ----------
    point : (3,) array_like of float
        What it is about, in the world.
    elbow : (3,) array_like of float
        Where the text is.
    text : str
        What it says.
    size_mm : float or str
        Of the letters.

    Returns
    -------
    Scene
        A thin line, hidden like any other curve, and its labels, to be drawn together with others.

    Raises
    ------
    InputError
        For points in one place.

    Examples
    --------
    >>> import vectorplot as vp
    >>> [label.mark for label in vp.leader((0, 0, 1), (2, 0, 2), "4 x ø6").labels]
    ['arrow', 'none']
    """
    tip, end = vector("leader: a point", point), vector("leader: elbow", elbow)
    _distance("leader", tip, end)
    item = thin_line(f"leader {text}".strip(), Line.through(tip, end))
    head = Label("", OnCurve(item.name, 0.0), f"{item.name} end", size_mm, mark="arrow")
    return Scene((item,), labels=(head, Label(text, OnCurve(item.name), item.name, size_mm)))


def centre_line(start: ArrayLike, end: ArrayLike, *, name: str = "centre line") -> Scene:
    """The axis of something round, as a line of dashes and dots which nothing hides.

    Parameters
    ----------
    start, end : (3,) array_like of float
        In the world; a little outside of what is round.
    name : str
        Of the item.

    Returns
    -------
    Scene
        The line, to be drawn together with others.

    Raises
    ------
    InputError
        For points in one place.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.centre_line((0, 0, -1), (0, 0, 5)).items[0].lines
    ('centre',)
    """
    ends = [vector("centre_line: a point", point) for point in (start, end)]
    _distance("centre_line", *ends)
    return Scene((Item(name, Line.through(*ends), "black", lines=("centre",), group=f"{name} {_place(ends[0])}"),))


def centre_mark(
    centre: ArrayLike, radius: float, axis: ArrayLike = (0.0, 0.0, 1.0), *, beyond: float | None = None
) -> Scene:
    """The centre lines of a circle: two that cross in its centre at right angles, and reach a little beyond it.

    Parameters
    ----------
    centre : (3,) array_like of float
        In the world.
    radius : float
        Of the circle.
    axis : (3,) array_like of float
        At right angles to the circle.
    beyond : float, optional
        How far the lines go on beyond the circle, in world units; where None 0.2 times the radius.

    Returns
    -------
    Scene
        Lines of dashes and dots, which nothing hides, to be drawn together with others; of circles about a coordinate
        axis they are parallel to the others.

    Raises
    ------
    InputError
        For a radius that is not positive, a length beyond that is negative, and an axis without length.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.centre_mark((0, 0, 0), 5.0).bounds[1].tolist()
    [6.0, 6.0, 0.0]
    """
    middle, along = vector("centre_mark: centre", centre), vector("centre_mark: axis", axis)
    if not 0.0 < radius < np.inf or not np.any(along):
        raise InputError("centre_mark: a positive radius and an axis are needed")
    reach = radius + (CROSS * radius if beyond is None else beyond)
    if not radius <= reach < np.inf:
        raise InputError("centre_mark: expected a length of 0 or more beyond the circle")
    along = normalize(along)
    # The coordinate axis that is farthest from it: for circles about one of these, one of the others.
    first = normalize(cross(along, np.eye(3)[int(np.argmin(np.abs(along)))]))
    both = [centre_line(middle - way, middle + way) for way in reach * np.array([first, cross(along, first)])]
    group = f"centre mark {_place(middle)} {_place(along)} {radius:g}"
    marks = zip(("centre mark", "centre mark 2"), both, strict=True)
    return Scene(tuple(Item(name, one.items[0].shape, "black", lines=("centre",), group=group) for name, one in marks))


# Dimensions in chains, from a base line, and along a scale; chamfers and threads.
#
# Source: ISO 129-1 (arrangement of dimensions), ISO 6410-1 (threads).

STEP = 0.7
"""From one dimension line to the next of those from a base line, in offsets, where nothing is said."""

ORDINATE_BEYOND = 1.2
"""How far the lines beside the measures of a running dimension reach beyond the dimension line, in offsets."""

JOG = 0.35
"""What part of these lines leads aside where they stand apart."""

THREAD_TURN = 1.5 * np.pi
"""The arc that stands for a thread seen along its axis: three quarters of a circle."""


@dataclass(frozen=True, eq=False)
class _Row:
    """Points that are dimensioned along one direction: points (n,3); along (3,) of length 1, from the first to the
    last; out (3,) of length 1 towards the dimension line; feet (n,3) of their extension lines on that."""

    points: Floats
    along: Floats
    out: Floats
    feet: Floats
    reach: float

    @classmethod
    def of(cls, what: str, points: ArrayLike, offset: ArrayLike) -> _Row:
        """The row of some points, an offset from the first of them to the dimension line. Errors: InputError."""
        places = np.array([vector(f"{what}: a point", point) for point in np.asarray(points, dtype=np.float64)])
        off = vector(f"{what}: offset", offset)
        reach = float(norm(off))
        if len(places) < 2 or not reach > 0.0:
            raise InputError(f"{what}: two points or more and an offset are needed")
        out = off / reach
        way = places[-1] - places[0]
        way = way - float(matmul(way, out)) * out
        if not float(norm(way)) > 0.0:
            raise InputError(f"{what}: the first and the last point are in line with the offset")
        along = normalize(way)
        heights = matmul(places - places[0], out)
        feet = places + (reach - heights)[:, None] * out
        if not (heights < reach).all():
            raise InputError(f"{what}: a point is beyond the dimension line")
        # All in the plane through the first point.
        aside = cross(along, out)
        feet = feet - matmul(feet - feet[0], aside)[:, None] * aside
        return cls(places, along, out, feet, reach)

    @property
    def places(self) -> Floats:
        """(n,) how far along each is from the first."""
        return matmul(self.points - self.points[0], self.along)

    def lines(self, one: int, other: int, level: float, gap: float | None, beyond: float | None) -> tuple[Line, ...]:
        """Two extension lines and the dimension line, so far beyond that of the row."""
        found = []
        ends = self.feet[[one, other]] + level * self.out
        for k, end in zip((one, other), ends, strict=True):
            start = end - float(matmul(end - self.points[k], self.out)) * self.out
            far = float(matmul(end - start, self.out))
            before = SHORT * self.reach if gap is None else gap
            behind = BEYOND * self.reach if beyond is None else beyond
            if not (0.0 <= before < far and 0.0 <= behind < np.inf):
                raise InputError("expected a gap before the dimension line, and a length of 0 or more beyond it")
            found.append(Line.through(start + before * self.out, end + behind * self.out))
        return (*found, Line.through(*ends))

    def dimension(
        self, one: int, other: int, level: float, size_mm: float | str, gap: float | None, beyond: float | None
    ) -> Scene:
        """The dimension between two of the points, so far beyond that of the row."""
        first, second, line = self.lines(one, other, level, gap, beyond)
        said, measured = _said(None, MEASURE, abs(float(self.places[other] - self.places[one])))
        group = f"dimension {said} {_place(self.points[one])} {_place(self.points[other])} {_place(self.out)} {level:g}"
        names = (f"extension {said} 1", f"extension {said} 2", f"dimension {said}")
        named = zip(names, (first, second, line), strict=True)
        items = tuple(thin_line(name, curve, group) for name, curve in named)
        return Scene(items, labels=_measured(items[2].name, said, measured, size_mm))


def chain_dimension(
    points: ArrayLike,
    offset: ArrayLike,
    *,
    size_mm: float | str = DEFAULT_SIZE_MM,
    gap: float | None = None,
    beyond: float | None = None,
) -> Scene:
    """Dimensions from each point to the next one, all in one line.

    Parameters
    ----------
    points : (n, 3) array_like of float
        In the world, two or more, in their order along the line.
    offset : (3,) array_like of float
        From the first point to the dimension line, which runs across it, from the first to the last point.
    size_mm : float or str
        Of the letters.
    gap, beyond : float, optional
        See dimension.

    Returns
    -------
    Scene
        Thin lines, hidden like any other curves, and their labels, to be drawn together with others.

    Raises
    ------
    InputError
        For fewer points, for a first and a last one in line with the offset, for points beyond the dimension line; and
        as in dimension.

    Examples
    --------
    >>> import vectorplot as vp
    >>> chain = vp.chain_dimension([(0, 0, 0), (10, 0, 0), (25, 0, 2)], (0, 0, -8))
    >>> [label.text for label in chain.labels if label.text]
    ['10', '15']
    """
    row = _Row.of("chain_dimension", points, offset)
    return together([row.dimension(k, k + 1, 0.0, size_mm, gap, beyond) for k in range(len(row.points) - 1)])


def baseline_dimension(
    points: ArrayLike,
    offset: ArrayLike,
    *,
    step: float | None = None,
    size_mm: float | str = DEFAULT_SIZE_MM,
    gap: float | None = None,
    beyond: float | None = None,
) -> Scene:
    """Dimensions from the first point to each of the others, one outside of the other.

    Parameters
    ----------
    points, offset : (n, 3) array_like of float and (3,) array_like of float
        See chain_dimension.
    step : float, optional
        From one dimension line to the next, in world units; where None 0.7 times the offset.
    size_mm, gap, beyond : float or str, float and float
        See chain_dimension.

    Returns
    -------
    Scene
        See chain_dimension.

    Raises
    ------
    InputError
        See chain_dimension; for a step that is not positive.

    Examples
    --------
    >>> import vectorplot as vp
    >>> base = vp.baseline_dimension([(0, 0, 0), (10, 0, 0), (25, 0, 0)], (0, 0, -8))
    >>> [label.text for label in base.labels if label.text]
    ['10', '25']
    """
    row = _Row.of("baseline_dimension", points, offset)
    apart = STEP * row.reach if step is None else step
    if not 0.0 < apart < np.inf:
        raise InputError(f"baseline_dimension: a step of {apart:g}: expected a positive length")
    levels = [(k, (k - 1) * apart) for k in range(1, len(row.points))]
    return together([row.dimension(0, k, level, size_mm, gap, beyond) for k, level in levels])


def ordinate_dimension(
    points: ArrayLike,
    offset: ArrayLike,
    *,
    apart: float = 0.0,
    size_mm: float | str = DEFAULT_SIZE_MM,
    gap: float | None = None,
    beyond: float | None = None,
) -> Scene:
    """A running dimension: how far each point is from the first one, written at its extension line.

    Parameters
    ----------
    points, offset : (n, 3) array_like of float and (3,) array_like of float
        See chain_dimension.
    apart : float
        The extension lines of points that are closer to each other lead so far apart beyond the dimension line, in
        world units; on technical sheets as far as letters need.
    size_mm, gap : float or str, and float
        See chain_dimension.
    beyond : float, optional
        How far the extension lines go on beyond the dimension line, beside the measures; where None 1.2 times the
        offset.

    Returns
    -------
    Scene
        See chain_dimension. The dimension line has an arrowhead at every point but the first, where it has a dot.

    Raises
    ------
    InputError
        See chain_dimension; for a length apart that is negative.

    Examples
    --------
    >>> import vectorplot as vp
    >>> scale = vp.ordinate_dimension([(0, 0, 0), (10, 0, 0), (25, 0, 0)], (0, 0, -8))
    >>> [label.text for label in scale.labels if label.text]
    ['0', '10', '25']
    """
    row = _Row.of("ordinate_dimension", points, offset)
    if not 0.0 <= apart < np.inf:
        raise InputError(f"ordinate_dimension: {apart:g} apart: expected a length of 0 or more")
    far = ORDINATE_BEYOND * row.reach if beyond is None else beyond
    before = SHORT * row.reach if gap is None else gap
    if not 0.0 < far < np.inf or not 0.0 <= before < row.reach:
        raise InputError(
            "ordinate_dimension: expected a gap before the dimension line, and a positive length beyond it"
        )
    places = row.places
    group = f"ordinate {_place(row.points[0])} {_place(row.points[-1])} {_place(row.out)}"
    moved = spread(places, apart) - places
    items: list[Item] = []
    labels: list[Label] = []
    base = "ordinate 0"
    for k, (place, foot) in enumerate(zip(places.tolist(), row.feet, strict=True)):
        said = Measures().length(abs(place))
        name = f"ordinate {k} {said}"
        start = foot - float(matmul(foot - row.points[k], row.out)) * row.out
        bend = foot + JOG * far * row.out + float(moved[k]) * row.along
        items.append(thin_line(f"{name} extension", Line.through(start + before * row.out, foot), group))
        items.append(thin_line(f"{name} lead", Line.through(foot, bend), group))
        items.append(thin_line(f"{name} measure", Line.through(bend, bend + (1.0 - JOG) * far * row.out), group))
        measure = Along(items[-1].name)
        labels.append(Label(said, measure, name, size_mm, "above", measured=f"<{abs(place)!r}>"))
        if place == 0.0:
            labels.append(Label("", OnCurve(items[-2].name, 0.0), f"{base} origin", size_mm, mark="dot"))
        else:
            items.append(thin_line(f"{name} line", Line.through(row.feet[0], foot), group))
            labels.append(Label("", OnCurve(items[-1].name), f"{name} end", size_mm, mark="arrow"))
    return together([Scene(tuple(items), labels=tuple(labels))])


def spread(places: Floats, apart: float) -> Floats:
    """(n,) places on a line that are so far apart at least, in the same order, each as near as that allows to where it
    was: clusters stand about their middles."""
    order = np.argsort(places, kind="stable")
    groups: list[tuple[float, int]] = []
    for place in places[order].tolist():
        middle, count = place, 1
        while groups and middle - 0.5 * (count - 1) * apart < groups[-1][0] + 0.5 * (groups[-1][1] - 1) * apart + apart:
            before, many = groups.pop()
            middle = (before * many + middle * count) / (many + count)
            count += many
        groups.append((middle, count))
    found = np.concatenate([middle + apart * (np.arange(count) - 0.5 * (count - 1)) for middle, count in groups])
    result = np.empty_like(places)
    result[order] = found
    return result


def chamfer(
    start: ArrayLike,
    end: ArrayLike,
    elbow: ArrayLike,
    text: str | None = None,
    *,
    size_mm: float | str = DEFAULT_SIZE_MM,
) -> Scene:
    """The dimension of a chamfer: a leader to the middle of its edge, with its width and angle.

    Parameters
    ----------
    start, end : (3,) array_like of float
        Of the sloping edge, as one sees it from the side; its sides run along two of the coordinate axes.
    elbow : (3,) array_like of float
        Where the text is.
    text : str, optional
        What it says, with <> for the width: the width and the angle where nothing is given.
    size_mm : float or str
        Of the letters.

    Returns
    -------
    Scene
        A thin line, hidden like any other curve, and its labels, to be drawn together with others.

    Raises
    ------
    InputError
        For an edge along a coordinate axis, or along none of the planes of two of them.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.chamfer((0, 0, 2), (2, 0, 0), (8, 0, 8)).labels[-1].text
    '2 × 45°'
    """
    one, other = vector("chamfer: start", start), vector("chamfer: end", end)
    sides = np.sort(np.abs(other - one))[::-1]
    if not (sides[1] > 0.0 and sides[2] == 0.0):
        raise InputError("chamfer: expected an edge that slopes along two of the coordinate axes")
    degrees = float(np.degrees(arctan2(sides[1], sides[0])))
    usual = f"<{float(sides[1])!r}>"
    measured = f"{usual} × {Measures().angle(degrees)}°" if text is None else text.replace(MEASURE, usual)
    found = leader(0.5 * (one + other), elbow, _written(measured, Measures(), ""), size_mm=size_mm)
    head, written = found.labels
    return replace(found, labels=(head, replace(written, measured=measured)))


def thread(start: ArrayLike, end: ArrayLike, radius: float) -> Scene:
    """The thread of a bolt or a screw: thin lines at its root, and three quarters of a thin circle.

    Parameters
    ----------
    start, end : (3,) array_like of float
        From where to where it goes along its axis; the circle is at the start.
    radius : float
        Of the root, in world units.

    Returns
    -------
    Scene
        Thin lines to be drawn on a technical sheet, where nothing hides them in views along the axis and across it.

    Raises
    ------
    InputError
        For points in one place, and a radius that is not positive.

    Examples
    --------
    >>> import vectorplot as vp
    >>> len(vp.thread((0, 0, 0), (0, 0, 20), 3.3))
    5
    """
    return _thread("thread", start, end, radius)


def threaded_hole(start: ArrayLike, end: ArrayLike, radius: float) -> Scene:
    """The thread of a tapped hole: thin lines at its major diameter, and three quarters of a thin circle.

    Parameters
    ----------
    start, end : (3,) array_like of float
        From where to where it goes along its axis; the circle is at the start.
    radius : float
        The larger one of the thread, in world units.

    Returns
    -------
    Scene
        Thin lines, hidden like any other curves: dashed in views from the side, in full in sections.

    Raises
    ------
    InputError
        For points in one place, and a radius that is not positive.

    Examples
    --------
    >>> import vectorplot as vp
    >>> len(vp.threaded_hole((0, 0, 0), (0, 0, 20), 4.0))
    5
    """
    return _thread("threaded hole", start, end, radius)


def _thread(what: str, start: ArrayLike, end: ArrayLike, radius: float) -> Scene:
    """Two pairs of thin lines in planes through the axis, and an arc."""
    one, other = vector(f"{what}: start", start), vector(f"{what}: end", end)
    _distance(what, one, other)
    if not 0.0 < radius < np.inf:
        raise InputError(f"{what}: a positive radius is needed")
    along = normalize(other - one)
    first = normalize(cross(along, np.eye(3)[int(np.argmin(np.abs(along)))]))
    items = []
    for number, way in enumerate((first, cross(along, first)), start=1):
        group = f"{what} {number} {_place(one)} {_place(other)} {radius:g}"
        for sign in (1.0, -1.0):
            aside = sign * radius * way
            items.append(thin_line(f"{what} line", Line.through(one + aside, other + aside), group))
    begins = _angle_on(Circle(one, radius, along), one, first)
    arc = Circle(one, radius, along, begins, begins + THREAD_TURN)
    items.append(thin_line(f"{what} arc", arc, f"{what} arc {_place(one)} {_place(other)} {radius:g}"))
    return together([Scene((item,)) for item in items])


def _measured(name: str, said: str, measured: str, size_mm: float | str) -> tuple[Label, ...]:
    """Arrowheads at both ends of a curve, and a text along it."""
    return (*_heads(name, size_mm), Label(said, Along(name), name, size_mm, "above", measured=measured))


def _said(text: str | None, usual: str, long: float) -> tuple[str, str]:
    """What a dimension says of a length, and the same with <> for the measure; the latter is nothing for texts without
    one. usual: the measure with its sign, which <> stands for in a text."""
    measured = usual if text is None else text.replace(MEASURE, usual)
    if MEASURE not in measured and not IN_WORLD.search(measured):
        return measured, ""
    return _written(measured, Measures(), Measures().length(long)), measured


def _written(measured: str, measures: Measures, measure: str) -> str:
    """A text in which <> and lengths in the world are written as measures."""
    return IN_WORLD.sub(lambda found: measures.length(float(found[1])), measured.replace(MEASURE, measure))


def measured_label(label: Label, items: Mapping[str, Item], measures: Measures) -> Label:
    """The label with the measure that it tells of, as measures write it: of a line its length, of an arc its angle."""
    shape = items[label.at.item].shape if isinstance(label.at, Along | OnCurve) and label.at.item in items else None
    if not label.measured:
        return label
    if is_curve(shape) and f"{MEASURE}°" in label.measured:
        measure = measures.angle(float(np.degrees(abs(shape.end - shape.start))))
    elif is_curve(shape):
        measure = measures.length(float(norm(np.diff(shape.points(np.array([shape.start, shape.end])), axis=0)[0])))
    else:
        measure = ""
    return replace(label, text=_written(label.measured, measures, measure))


def _heads(name: str, size_mm: float | str) -> tuple[Label, ...]:
    """Arrowheads at both ends of a curve."""
    ends = enumerate((0.0, 1.0))
    return tuple(Label("", OnCurve(name, part), f"{name} end {k}", size_mm, mark="arrow") for k, part in ends)


def _distance(what: str, one: Floats, other: Floats) -> float:
    """Between two points. Errors: InputError where they are one."""
    long = float(norm(other - one))
    if not long > 0.0:
        raise InputError(f"{what}: two different points are needed")
    return long


def _place(point: Floats) -> str:
    """A point in words, which tell lines that belong together from others."""
    return ",".join(f"{x:.17g}" for x in point.tolist())


def _angle_on(circle: Circle, middle: Floats, way: Floats) -> float:
    """The parameter of a circle in a direction from its middle."""
    right, left = (circle.points(np.array(at)) - middle for at in (0.0, 0.5 * np.pi))
    return float(arctan2(matmul(way, left), matmul(way, right)))


# Where the things are that labels of a scene name.

CHORDS = 256
"""Letters along a curve follow so many chords of it."""


@dataclass(frozen=True, eq=False)
class LabelAnchors:
    """Labels and what they name: points (l,3) in the world, NaN for those on the page; courses: the points (k,3) of the
    curve, for those on or along one."""

    labels: tuple[Label, ...]
    points: Floats
    courses: tuple[Floats | None, ...]

    def __len__(self) -> int:
        return len(self.labels)


def label_anchors(scene: Scene) -> LabelAnchors:
    """What the labels of a scene name.

    Errors: InputError, with the label's name, for an item or a vertex that the scene does not have, and for one that is
    no curve or no polyhedron.
    """
    items = {item.name: item for item in reversed(scene.items)}
    measures = Measures() if scene.measures is None else scene.measures
    labels = tuple(measured_label(label, items, measures) for label in scene.labels)
    courses = tuple(
        _trace(label, label.at, items) if isinstance(label.at, (Along, OnCurve)) else None for label in labels
    )
    found = zip(labels, courses, strict=True)
    points = [_point(label, items) if course is None else _part(label, course) for label, course in found]
    return LabelAnchors(labels, np.array(points, dtype=np.float64).reshape(-1, 3), courses)


def _point(label: Label, items: dict[str, Item]) -> Floats:
    at = label.at
    if isinstance(at, OnPage):
        return np.full(3, np.nan)
    if isinstance(at, BesidePoint):
        return np.array(at.point, dtype=np.float64)
    if isinstance(at, tuple):
        return np.array(at, dtype=np.float64)
    assert isinstance(at, AtVertex)
    shape = _item(label, at.item, items).shape
    if not isinstance(shape, Mesh):
        raise InputError(f"label {label.name}: {at.item} has no vertices: it is no polyhedron")
    if not 0 <= at.vertex < len(shape.vertices):
        raise InputError(f"label {label.name}: {at.item} has {len(shape.vertices)} vertices, not {at.vertex + 1}")
    return np.asarray(shape.vertices[at.vertex])


def _trace(label: Label, at: Along | OnCurve, items: dict[str, Item]) -> Floats:
    shape = _item(label, at.item, items).shape
    if not is_curve(shape):
        raise InputError(f"label {label.name}: {at.item} is no curve")
    points = shape.points(np.linspace(shape.start, shape.end, CHORDS + 1))
    return np.asarray(points[np.isfinite(points).all(axis=1)])


def _part(label: Label, course: Floats) -> Floats:
    """The point of a course at the part of its length that a label is at."""
    assert isinstance(label.at, (Along, OnCurve))
    passed = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(course, axis=0), axis=1))])
    if not len(course) or not passed[-1] > 0.0:
        raise InputError(f"label {label.name}: {label.at.item} has no length")
    at = label.at.part * passed[-1]
    return np.array([np.interp(at, passed, column) for column in course.T])


def _item(label: Label, name: str, items: dict[str, Item]) -> Item:
    if name not in items:
        raise InputError(f"label {label.name}: there is no item {name!r}")
    return items[name]

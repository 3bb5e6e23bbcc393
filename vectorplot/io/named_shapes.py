"""The surfaces and curves that a scene file can name, splines with their kinds and points among them."""

from __future__ import annotations

from collections.abc import Callable
from math import degrees, pi
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve
from vectorplot.curves.families import Circle, Helix, Line, Loxodrome, cylinder_branches
from vectorplot.curves.splines import (
    MOST_CONTROLS,
    AkimaSpline,
    ApproximatingSpline,
    BSpline,
    CubicSpline,
    InterpolatingSpline,
    SplineCurve,
    SplineKind,
    nurbs_curve,
    spline_curve,
)
from vectorplot.errors import InputError
from vectorplot.io.scene_words import Words
from vectorplot.io.shape_arguments import (
    Family,
    Formulas,
    Slot,
    formula_curve,
    formula_graph,
    formula_graph_over_disc,
    formula_implicit,
    formula_surface,
    read_angle,
    read_angles,
    read_box,
    read_family,
    read_flag,
    read_formulas,
    read_number,
    read_numbers,
    read_whole,
)
from vectorplot.surfaces.capped_bodies import Capped, Frustum, rod
from vectorplot.surfaces.graphs import Disc
from vectorplot.surfaces.minimal import MinimalSurface, helicoid_to_catenoid, minimal_spiral_surface
from vectorplot.surfaces.quadrics import (
    Cone,
    Cylinder,
    Ellipsoid,
    EllipticSections,
    HyperbolicParaboloid,
    Hyperboloid,
    HyperboloidSheet,
    Paraboloid,
    Quadric,
    Sphere,
)
from vectorplot.surfaces.splines import SplineSurface, landscape, nurbs_surface, spline_surface
from vectorplot.surfaces.surface import Domain, Surface
from vectorplot.surfaces.swept import (
    Swept,
    helical_surface,
    revolution_surface,
    rotoidal_surface,
    spiral_surface,
    translation_surface,
)
from vectorplot.surfaces.tori import ImplicitCyclide, ImplicitTorus, Torus, dupin_cyclide
from vectorplot.surfaces.trimmed import TrimmedSurface
from vectorplot.tolerances import ROUNDING

# Splines in scene files: curves through points, surfaces through grids, and their kinds.


def read_points(words: Words, at: int, owner: str, what: str) -> tuple[Floats, int]:
    """(n,3) points with commas between them."""
    columns, at = words.points(at, 3, owner, what)
    if len(columns[0]) > MOST_CONTROLS:
        words.fail(at, f"{owner}{what}: {len(columns[0])} of them, expected at most {MOST_CONTROLS}")
    return np.array(columns).T, at


def read_list(words: Words, at: int, owner: str, what: str) -> tuple[Floats, int]:
    """(n,) numbers with blanks or commas between them."""
    value, at = read_number(words, at, owner, what)
    values = [value]
    while words.words[at] == "," or words.is_number(at) or words.words[at].startswith('"'):
        value, at = read_number(words, at + (words.words[at] == ","), owner, what)
        values.append(value)
    return np.array(values), at


def read_rows(words: Words, at: int, owner: str, what: str) -> tuple[Floats, int]:
    """(m,n) numbers, a comma between rows."""
    rows: list[list[float]] = [[]]
    start = at
    while True:
        value, at = read_number(words, at, owner, what)
        rows[-1].append(value)
        if words.words[at] == ",":
            rows.append([])
            at += 1
        elif not words.is_number(at) and not words.words[at].startswith('"'):
            break
    _check_lengths(words, start, owner, f"row %d of {what}", [len(row) for row in rows])
    return np.array(rows), at


def read_lines(words: Words, at: int, owner: str, what: str) -> tuple[Floats, int]:
    """(m,n,3) the points of a grid, line after line, the word before each."""
    start = at
    lines: list[Floats] = []
    while not lines or words.words[at] == what:
        points, at = read_points(words, at + bool(lines), owner, f"a point of a {what}")
        lines.append(points)
    _check_lengths(words, start, owner, f"{what} %d", [len(line) for line in lines])
    return np.stack(lines), at


def read_kind(words: Words, at: int, owner: str, what: str) -> tuple[SplineKind, int]:
    """A kind of spline, its word included."""
    word = words.words[at]
    if word not in _KINDS:
        words.fail(at, f"{owner}{what}: expected one of {', '.join(_KINDS)}, got {words.shown(at)}")
    return read_family(words, at + 1, owner, word, _KINDS)


def _read_named_kind(words: Words, at: int, owner: str, what: str) -> tuple[SplineKind, int]:
    """A kind of spline whose word stands before."""
    return read_family(words, at, owner, what, _KINDS)


def _check_lengths(words: Words, at: int, owner: str, what: str, lengths: list[int]) -> None:
    """All lines must be equally long."""
    for number, length in enumerate(lengths, start=1):
        if length != lengths[0]:
            words.fail(at, f"{owner}{what % number} has {length}, {what % 1} has {lengths[0]}")


_FLAG = Slot(read_flag, False)
_ORDER = Slot(read_whole, 4)
_THROUGH = {"closed": _FLAG, "parameters": Slot(read_list)}
_POINTS = Slot(read_points, needed=True)
_LIST = Slot(read_list)


def _cubic(*, tangents: tuple[float, ...] | None, **values: Any) -> CubicSpline:
    return CubicSpline(tangents=None if tangents is None else (tangents[:3], tangents[3:]), **values)


def _approximating(*, controls: int, **values: Any) -> ApproximatingSpline:
    return ApproximatingSpline(controls, **values)


_KINDS = {
    "akima": Family(_THROUGH, (), AkimaSpline),
    "cubic": Family({**_THROUGH, "tangents": Slot(read_numbers(6))}, (), _cubic),
    "bspline": Family({"order": _ORDER, "closed": _FLAG}, (), BSpline),
    "interpolating": Family({"order": _ORDER, **_THROUGH}, (), InterpolatingSpline),
    "approximating": Family(
        {"controls": Slot(read_whole, needed=True), "order": _ORDER, **_THROUGH}, (), _approximating
    ),
}
"""Kinds of splines, by their words."""


def _curve_of(kind: Callable[..., SplineKind]) -> Callable[..., SplineCurve]:
    """How to build a curve of a kind."""

    def build(*, points: Floats, **values: Any) -> SplineCurve:
        return spline_curve(points, kind(**values))

    return build


SPLINE_CURVES = {
    **{
        word: Family({"points": _POINTS, **family.slots}, ("points",), _curve_of(family.build))
        for word, family in _KINDS.items()
    },
    "nurbs": Family(
        {"points": _POINTS, "order": _ORDER, "weights": _LIST, "knots": _LIST, "closed": _FLAG},
        ("points",),
        lambda points, **values: nurbs_curve(points, **values),
    ),
}
"""Splines as curves, by their words."""


def _surface(*, grid: Floats, kind: SplineKind | None, u: SplineKind | None, v: SplineKind | None) -> SplineSurface:
    return spline_surface(grid, u or kind, v or kind)


def _nurbs(
    *,
    grid: Floats,
    orders: tuple[float, ...],
    weights: Floats | None,
    knots_u: Floats | None,
    knots_v: Floats | None,
    closed_u: bool,
    closed_v: bool,
) -> SplineSurface:
    if not all(order.is_integer() for order in orders):
        raise InputError(f"nurbs: orders {orders[0]:g} and {orders[1]:g} must be whole numbers")
    if weights is not None and weights.size != grid[..., 0].size:
        raise InputError(f"nurbs: {weights.size} weights for {grid[..., 0].size} points")
    return nurbs_surface(
        grid,
        None if weights is None else weights.reshape(grid.shape[:2]),
        orders=(int(orders[0]), int(orders[1])),
        knots=(knots_u, knots_v),
        closed=(closed_u, closed_v),
    )


def _landscape(*, heights: Floats, kind: SplineKind | None, **values: Any) -> SplineSurface:
    # Rows are written from south to north, each from west to east.
    return landscape(heights.T, kind=kind, **values)


_LINES = Slot(read_lines, needed=True, into="grid")
_KIND = dict.fromkeys(_KINDS, Slot(_read_named_kind, into="kind"))

SPLINE_SURFACES = {
    "spline": Family({"line": _LINES, **_KIND, "u": Slot(read_kind), "v": Slot(read_kind)}, (), _surface),
    "nurbs": Family(
        {
            "line": _LINES,
            "orders": Slot(read_numbers(2), (4.0, 4.0)),
            "weights": _LIST,
            "knots_u": _LIST,
            "knots_v": _LIST,
            "closed_u": _FLAG,
            "closed_v": _FLAG,
        },
        (),
        _nurbs,
    ),
    "landscape": Family(
        {
            "heights": Slot(read_rows, needed=True),
            "x": Slot(read_numbers(2), needed=True),
            "y": Slot(read_numbers(2), needed=True),
            **_KIND,
        },
        ("heights",),
        _landscape,
    ),
}
"""Splines as surfaces, by their words."""


# The surfaces and curves that a scene file can name.

Pair = tuple[float, float]

TURN = (0.0, 2.0 * pi)


def _number(default: float | None = None, *, needed: bool = False) -> Slot:
    return Slot(read_number, default, needed)


def _numbers(*default: float) -> Slot:
    return Slot(read_numbers(len(default)), default)


def _formulas(count: int, *variables: str) -> Slot:
    return Slot(read_formulas(count, *variables), needed=True, quoted=True)


_CENTRE = _numbers(0.0, 0.0, 0.0)
_PART = Slot(read_angles)
_RANGE = Slot(read_numbers(2), needed=True)
_TURNED = Slot(read_angles, TURN)


def _trimmed(build: Callable[..., Surface]) -> Callable[..., Surface]:
    """How to build a surface and take a part of it."""

    def part(*, u: Pair | None = None, v: Pair | None = None, **values: Any) -> Surface:
        surface = build(**values)
        if u is None and v is None:
            return surface
        try:
            return TrimmedSurface(surface, u, v)
        except InputError:
            raise InputError(_no_part(surface.domain, u, v)) from None

    return part


def _closable(build: Callable[..., EllipticSections]) -> Callable[..., Surface]:
    """How to build a surface that can be closed by flat caps, or take a part of it."""

    def closed(*, capped: bool, u: Pair | None = None, v: Pair | None = None, **values: Any) -> Surface:
        if not capped:
            return _trimmed(build)(u=u, v=v, **values)
        if u is not None:
            raise InputError("'capped' needs the whole turn, without 'u'")
        surface = build(**values)
        try:
            return Capped(surface, v)
        except InputError:
            if v is None or not hasattr(surface, "domain") or _is_part(surface.domain, v):
                raise
            raise InputError(_no_part(surface.domain, u, v)) from None

    return closed


def _is_part(domain: Domain, v: Pair) -> bool:
    slack = ROUNDING * domain.size[1]
    return domain.v_start - slack <= v[0] < v[1] <= domain.v_end + slack


def _frustum(*, radii: Pair, height: float, centre: tuple[float, ...]) -> Frustum:
    return Frustum(radii[0], radii[1], height, centre)


def _rod(*, radius: float, points: tuple[float, ...]) -> Surface:
    return rod(points[:3], points[3:], radius)


def _no_part(domain: Domain, u: Pair | None, v: Pair | None) -> str:
    """What is wrong with parts that are no parts, in degrees as in the file."""
    wanted = [f"{name} {degrees(p[0]):g} {degrees(p[1]):g}" for name, p in (("u", u), ("v", v)) if p is not None]
    ranges = [
        f"u {degrees(domain.u_start):g} to {degrees(domain.u_end):g}" if u is not None else "",
        f"v {degrees(domain.v_start):g} to {degrees(domain.v_end):g}" if v is not None else "",
    ]
    return f"'{' '.join(wanted)}' is no part of {', '.join(filter(None, ranges))} degrees"


def _cone(
    *, radius: float | None, height: float | None, slope: float | None, bottom: float, top: float, **values: Any
) -> Cone:
    """A cone that stands on its base circle, or by the slope of its rulings."""
    if slope is None:
        if values.pop("depth_slope") is not None:
            raise InputError("cone: 'depth_slope' needs 'slope'")
        return Cone.standing(1.0 if radius is None else radius, 1.0 if height is None else height, **values)
    if radius is not None or height is not None:
        raise InputError("cone: give 'radius' and 'height', or 'slope', 'bottom' and 'top'")
    return Cone(slope, bottom, top, **values)


def _bent(*, width: float, bending: float, angle: Pair) -> MinimalSurface:
    return helicoid_to_catenoid(bending, width=_width(width), start=angle[0], end=angle[1])


def _minimal_spiral(*, growth: float, bending: float, width: float, angle: Pair) -> MinimalSurface:
    return minimal_spiral_surface(growth, bending, width=_width(width), start=angle[0], end=angle[1])


def _width(width: float) -> float:
    if not width > 0.0:
        raise InputError(f"a width of {width:g}: expected a positive number")
    return width


def _function(*, formulas: Formulas, u: Pair, v: Pair, closed_u: bool, closed_v: bool) -> Surface:
    return formula_surface(formulas, Domain(*u, *v, closed_u=closed_u, closed_v=closed_v))


def _graph(
    *, formula: Formulas, x: Pair | None, y: Pair | None, disc: float | None, centre: Pair | None, hole: float | None
) -> Surface:
    """A graph above a rectangle or above a disc."""
    if disc is None:
        if x is None or y is None or centre is not None or hole is not None:
            raise InputError("graph: expected 'x' and 'y' with their ranges, or 'disc' with 'centre' and 'hole'")
        return formula_graph(formula, Domain(*x, *y))
    if x is not None or y is not None:
        raise InputError("graph: 'x' and 'y' do not go with 'disc'")
    return formula_graph_over_disc(formula, Disc(disc, centre or (0.0, 0.0)), hole=hole or 0.0)


def _swept(build: Callable[..., Swept]) -> Callable[..., Swept]:
    """How to build a surface that a curve sweeps while it turns."""

    def turned(*, generator: Curve, angle: Pair, **values: float) -> Swept:
        return build(generator, start=angle[0], end=angle[1], **values)

    return turned


def _arc(*, radius: float, centre: tuple[float, ...], axis: tuple[float, ...], arc: Pair) -> Circle:
    return Circle(centre, radius, axis, arc[0], arc[1])


def _helix(*, arc: Pair, **values: Any) -> Helix:
    return Helix(start=arc[0], end=arc[1], **values)


def _loxodrome(*, radius: float, course: float, arc: Pair) -> Loxodrome:
    return Loxodrome(radius, course, arc[0], arc[1])


def _cylinders(*, r: float, s: float, a: float, branch: int) -> Curve:
    """One branch of the curve common to two cylinders."""
    branches = cylinder_branches(r, s, a)
    if not branches:
        raise InputError("cylinder_intersection: the cylinders do not meet, or in one point only: no curve")
    if not 1 <= branch <= len(branches):
        raise InputError(f"cylinder_intersection: there is no branch {branch}, there {_are(len(branches))}")
    return branches[branch - 1]


def _are(count: int) -> str:
    return "is one" if count == 1 else f"are {count}"


def _function_curve(*, formulas: Formulas, t: Pair, closed: bool) -> Curve:
    return formula_curve(formulas, t[0], t[1], closed=closed)


CURVES = {
    "line": Family({"points": Slot(read_numbers(6), needed=True)}, ("points",), lambda points: _line(points)),
    "circle": Family(
        {"radius": _number(1.0), "centre": _CENTRE, "axis": _numbers(0.0, 0.0, 1.0), "arc": _TURNED}, ("radius",), _arc
    ),
    "helix": Family(
        {
            "radius": _number(1.0),
            "rise": _number(needed=True),
            "centre": _CENTRE,
            "axis": _numbers(0.0, 0.0, 1.0),
            "arc": _TURNED,
        },
        ("radius", "rise"),
        _helix,
    ),
    "loxodrome": Family(
        {
            "radius": _number(1.0),
            "course": Slot(read_angle, needed=True),
            "arc": Slot(read_angles, (-4.0 * pi, 4.0 * pi)),
        },
        ("radius", "course"),
        _loxodrome,
    ),
    "cylinder_intersection": Family(
        {
            "r": _number(needed=True),
            "s": _number(needed=True),
            "a": _number(0.0),
            "branch": Slot(read_whole, 1),
        },
        ("r", "s", "a"),
        _cylinders,
    ),
    "curve": Family(
        {"formulas": _formulas(3, "t"), "t": _RANGE, "closed": Slot(read_flag, False)}, ("formulas",), _function_curve
    ),
    **SPLINE_CURVES,
}
"""Curves, by their words."""


def _line(points: tuple[float, ...]) -> Line:
    return Line.through(points[:3], points[3:])


def _read_curve(words: Words, at: int, owner: str, what: str) -> tuple[Curve, int]:
    """A curve that the words from its slots on describe; what: its word."""
    return read_family(words, at, owner, what, CURVES)


def _read_path(words: Words, at: int, owner: str, what: str) -> tuple[Curve, int]:
    """A curve, its word included."""
    word = words.words[at]
    if word not in CURVES:
        words.fail(at, f"{owner}{what}: expected one of {', '.join(CURVES)}, got {words.shown(at)}")
    return read_family(words, at + 1, owner, word, CURVES)


_GENERATOR = dict.fromkeys(CURVES, Slot(_read_curve, needed=True, into="generator"))
_ANGULAR = {"centre": _CENTRE, "u": _PART}
_CLOSABLE = {**_ANGULAR, "capped": Slot(read_flag, False)}
_BENT = {"width": _number(1.5), "angle": _TURNED}

SURFACES = {
    "torus": Family(
        {"major": _number(3.0), "minor": _number(1.0), **_ANGULAR, "v": _PART}, ("major", "minor"), _trimmed(Torus)
    ),
    "sphere": Family({"radius": _number(1.0), **_CLOSABLE, "v": _PART}, ("radius",), _closable(Sphere)),
    "ellipsoid": Family(
        {"semi_axes": _numbers(1.0, 1.0, 1.0), **_CLOSABLE, "v": _PART}, ("semi_axes",), _closable(Ellipsoid)
    ),
    "cylinder": Family(
        {"radius": _number(1.0), "bottom": _number(0.0), "top": _number(1.0), "depth": _number(), **_CLOSABLE},
        ("radius", "bottom", "top"),
        _closable(Cylinder),
    ),
    "cone": Family(
        {
            "radius": _number(),
            "height": _number(),
            "slope": _number(),
            "bottom": _number(0.0),
            "top": _number(1.0),
            "depth_slope": _number(),
            **_CLOSABLE,
        },
        ("radius", "height"),
        _closable(_cone),
    ),
    "frustum": Family(
        {"radii": _numbers(1.0, 0.5), "height": _number(1.0), **_CLOSABLE}, ("radii", "height"), _closable(_frustum)
    ),
    "rod": Family({"radius": _number(1.0), "points": Slot(read_numbers(6), needed=True)}, ("radius",), _rod),
    "hyperboloid": Family(
        {"semi_axes": _numbers(1.0, 1.0, 1.0), "bottom": _number(-1.0), "top": _number(1.0), **_CLOSABLE},
        ("semi_axes", "bottom", "top"),
        _closable(Hyperboloid),
    ),
    "hyperboloid_sheet": Family(
        {"semi_axes": _numbers(1.0, 1.0, 1.0), "top": _number(2.0), **_CLOSABLE},
        ("semi_axes", "top"),
        _closable(HyperboloidSheet),
    ),
    "paraboloid": Family(
        {"a": _number(1.0), "b": _number(1.0), "top": _number(1.0), **_CLOSABLE},
        ("a", "b", "top"),
        _closable(Paraboloid),
    ),
    "hyperbolic_paraboloid": Family(
        {"a": _number(1.0), "b": _number(1.0), "width": _number(1.0), "depth": _number(1.0), "centre": _CENTRE},
        ("a", "b", "width", "depth"),
        HyperbolicParaboloid,
    ),
    "cyclide": Family(
        {
            "major": _number(3.0),
            "minor": _number(1.0),
            "centre": Slot(read_numbers(3), needed=True),
            "radius": _number(needed=True),
            "u": _PART,
            "v": _PART,
        },
        ("major", "minor"),
        _trimmed(dupin_cyclide),
    ),
    "helicoid": Family({**_BENT, "bending": Slot(read_angle, 0.0)}, ("width",), _bent),
    "catenoid": Family({**_BENT, "bending": Slot(read_angle, 0.5 * pi)}, ("width",), _bent),
    "minimal_spiral": Family(
        {"growth": _number(needed=True), **_BENT, "bending": Slot(read_angle, 0.0)}, ("growth",), _minimal_spiral
    ),
    "translation": Family({**_GENERATOR, "path": Slot(_read_path, needed=True)}, (), translation_surface),
    "revolution": Family({**_GENERATOR, "angle": _TURNED}, (), _swept(revolution_surface)),
    "helical": Family(
        {**_GENERATOR, "rise": _number(needed=True), "angle": _TURNED}, ("rise",), _swept(helical_surface)
    ),
    "rotoidal": Family(
        {**_GENERATOR, "ratio": _number(needed=True), "distance": _number(needed=True), "angle": _TURNED},
        ("ratio", "distance"),
        _swept(rotoidal_surface),
    ),
    "spiral": Family(
        {**_GENERATOR, "growth": _number(needed=True), "angle": _TURNED}, ("growth",), _swept(spiral_surface)
    ),
    "function": Family(
        {
            "formulas": _formulas(3, "u", "v"),
            "u": _RANGE,
            "v": _RANGE,
            "closed_u": Slot(read_flag, False),
            "closed_v": Slot(read_flag, False),
        },
        ("formulas",),
        _function,
    ),
    "graph": Family(
        {
            "formula": _formulas(1, "x", "y"),
            "x": Slot(read_numbers(2)),
            "y": Slot(read_numbers(2)),
            "disc": _number(),
            "centre": Slot(read_numbers(2)),
            "hole": _number(),
        },
        ("formula",),
        _graph,
    ),
    "implicit": Family(
        {"formula": _formulas(1, "x", "y", "z"), "box": Slot(read_box, needed=True)},
        ("formula",),
        lambda formula, box: formula_implicit(formula, box),
    ),
    "quadric": Family(
        {
            "coefficients": Slot(read_numbers(10), needed=True),
            "box": Slot(read_box, needed=True),
            "centre": _CENTRE,
        },
        ("coefficients",),
        lambda coefficients, box, centre: Quadric(coefficients, box, centre),
    ),
    "implicit_torus": Family(
        {"major": _number(3.0), "minor": _number(1.0), "centre": _CENTRE}, ("major", "minor"), ImplicitTorus
    ),
    "implicit_cyclide": Family(
        {
            "major": _number(3.0),
            "minor": _number(1.0),
            "centre": Slot(read_numbers(3), needed=True),
            "radius": _number(needed=True),
            "box": Slot(read_box, into="bounds"),
        },
        ("major", "minor"),
        ImplicitCyclide,
    ),
    **SPLINE_SURFACES,
}
"""Surfaces, by their words."""

SLOT_WORDS = frozenset(word for families in (SURFACES, CURVES) for family in families.values() for word in family.slots)
"""The words of all slots."""

"""Smooth surfaces and curves as words of the scene language."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from json import dumps
from math import degrees, pi, radians
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.curves.curve import Curve
from vectorplot.curves.derivatives import NumericFunction
from vectorplot.curves.families.circle import Circle
from vectorplot.curves.families.cylinder_intersections import CylinderBranch, cylinder_intersection
from vectorplot.curves.families.helix import Helix
from vectorplot.curves.families.line import Line
from vectorplot.curves.families.loxodrome import Loxodrome
from vectorplot.curves.function_curve import FunctionCurve
from vectorplot.curves.placed_curve import PlacedCurve
from vectorplot.curves.splines.spline_curve import SplineCurve
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.io.scenes.scene_formulas import Formulas
from vectorplot.scene.light import Light
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.scene.terrains.terrain_lines import Roads, Serpentine, TerrainLines, WaterCourses
from vectorplot.surfaces.families.capped import Capped, Frustum
from vectorplot.surfaces.families.cyclide import ImplicitCyclide
from vectorplot.surfaces.families.cylinder import Cone, Cylinder
from vectorplot.surfaces.families.ellipsoid import Ellipsoid, Sphere
from vectorplot.surfaces.families.hyperbolic_paraboloid import HyperbolicParaboloid
from vectorplot.surfaces.families.hyperboloid import Hyperboloid, HyperboloidSheet, Paraboloid
from vectorplot.surfaces.families.minimal import HelicoidCurve, MinimalSurface, SpiralCurve
from vectorplot.surfaces.families.quadric import Quadric
from vectorplot.surfaces.families.swept.motions import Rotoid, Screw, SpiralMotion, Translation
from vectorplot.surfaces.families.swept.swept import Swept
from vectorplot.surfaces.families.torus import ImplicitTorus, Torus
from vectorplot.surfaces.function_surface import FunctionSurface
from vectorplot.surfaces.graphs.graph import Graph, PolarGraph
from vectorplot.surfaces.implicit_function import ImplicitFunction
from vectorplot.surfaces.inversion import InvertedSurface
from vectorplot.surfaces.placed_surface import PlacedImplicit, PlacedSurface
from vectorplot.surfaces.splines.spline_surface import SplineSurface
from vectorplot.surfaces.surface import Domain, ImplicitSurface, Surface
from vectorplot.surfaces.trims.trimmed import TrimmedSurface


def surface_text(shape: Surface | ImplicitSurface) -> str:
    """The words of a surface from its family's name on, its place included.

    Error: lengths and formulas keep every digit, angles are right to rounding: the file has them in degrees.
    Errors: InputError for surfaces that the language cannot name, such as functions in Python.
    """
    if isinstance(shape, PlacedSurface | PlacedImplicit):
        matrix, shift, inner = np.asarray(shape.matrix), np.asarray(shape.shift), shape.surface
        while isinstance(inner, PlacedSurface | PlacedImplicit):
            shift = matmul(np.asarray(inner.shift), matrix) + shift
            matrix, inner = matmul(np.asarray(inner.matrix), matrix), inner.surface
        return surface_text(inner) + _placement(matrix, shift)
    if isinstance(shape, TrimmedSurface):
        return _trimmed(shape)
    writer = _WRITERS.get(type(shape))
    if writer is None:
        raise InputError(f"the scene language has no word for a {type(shape).__name__}")
    return writer(shape)


def lines_text(curves: SurfaceLines, lights: Sequence[Light]) -> str:
    """The words of the lines on a surface. Errors: InputError for a light that the scene does not have."""
    words = []
    if curves.columns or curves.rows:
        words.append(f"parameter_lines {int(curves.columns)} {int(curves.rows)}")
    if curves.isophotes:
        words.append(f"isophotes at {_list(curves.isophotes)}")
        if curves.light is not None:
            if curves.light >= len(lights):
                raise InputError(f"isophotes: there is no light {curves.light + 1}")
            words.append(f"lit_by {curves.light + 1}")
    for section in curves.sections:
        if section.offsets:
            word = "slices" if section.slices else "sections"
            index = " index 1" * section.index + " numbered" * section.numbered
            words.append(f"{word} normal {_numbers(section.normal)} at {_list(section.offsets)}{index}")
    words += [f"surface_curve {_quoted(path.function)} t {_numbers((path.start, path.end))}" for path in curves.paths]
    if curves.integral:
        from vectorplot.io.scenes.items.scene_integral import integral_text

        words += [integral_text(lines) for lines in curves.integral]
    words += [_terrain_text(asked) for asked in curves.terrain]
    words += ["smooth_contours"] * curves.smooth_contours
    words += ["smooth_lines"] * curves.smooth + ["isophote_edges"] * curves.along_edges
    words += [f"detail {_numbers((curves.detail,))}"] * (curves.detail != 1.0)
    return "".join(f"\n  {word}" for word in words)


def _terrain_text(asked: TerrainLines) -> str:
    if isinstance(asked, WaterCourses):
        return "water " + " , ".join(_numbers(place) for place in asked.places)
    if isinstance(asked, Roads):
        return f"road {_numbers(asked.start)} , {_numbers(asked.end)}"
    if isinstance(asked, Serpentine):
        sizes = (("slope", asked.slope_deg), ("radius", asked.radius), ("width", asked.width))
        said = "".join(f" {name} {_numbers((size,))}" for name, size in sizes if size is not None)
        return f"serpentine {_numbers(asked.start)} , {_numbers(asked.end)}{said}"
    return "valley_lines" if asked.valleys else "watersheds"


def _numbers(values: Iterable[float]) -> str:
    return " ".join(repr(float(value)) for value in values)


def _list(values: Iterable[float]) -> str:
    return " , ".join(repr(float(value)) for value in values)


def _named(**values: float | ArrayLike | None) -> str:
    """Words with their numbers, without those that are None, and without a centre in the origin."""
    parts = []
    for word, value in values.items():
        if value is not None and not (word == "centre" and not np.any(np.asarray(value))):
            parts.append(f" {word} {_numbers(np.atleast_1d(np.asarray(value, dtype=np.float64)).ravel())}")
    return "".join(parts)


def _degrees(*angles: float) -> str:
    """Angles in degrees, with as few digits as give the same radians back."""
    return _numbers(
        next(
            (short for short in (round(degrees(a), digits) for digits in range(15)) if radians(short) == a), degrees(a)
        )
        for a in angles
    )


def _range(domain: Domain, start: float = 0.0, end: float = 2.0 * pi) -> str:
    """The angle that a motion runs through."""
    if (domain.v_start, domain.v_end) == (start, end):
        return ""
    return f" angle {_degrees(domain.v_start, domain.v_end)}"


def _box(box: ArrayLike) -> str:
    return f" box {_numbers(np.asarray(box).T.ravel())}"


def _placement(matrix: Any, shift: Any) -> str:
    if np.array_equal(matrix, np.eye(3)):
        return f"\n  translation {_numbers(shift)}"
    return f"\n  matrix {_numbers(np.column_stack([matrix.T, shift]).ravel())}"


def _trimmed(part: TrimmedSurface) -> str:
    """A part of a surface whose parameters are angles in the language."""
    whole = part.surface
    words = surface_text(whole)
    angular_v = isinstance(whole, Torus | Sphere | Ellipsoid | InvertedSurface)
    angular_u = angular_v or isinstance(whole, Cylinder | Cone | Frustum | Hyperboloid | HyperboloidSheet | Paraboloid)
    for name, span, angular in (("u", part.u, angular_u), ("v", part.v, angular_v)):
        if span is not None:
            if not angular:
                raise InputError(f"the scene language has no word for a part in {name} of a {type(whole).__name__}")
            words += f" {name} {_degrees(*span)}"
    return words


def _capped(body: Capped) -> str:
    """A body with caps, its range of v in degrees where that is an angle."""
    words = surface_text(body.surface)
    if body.v is not None:
        if not isinstance(body.surface, Sphere | Ellipsoid):
            raise InputError(f"the scene language has no word for a part in v of a {type(body.surface).__name__}")
        words += f" v {_degrees(*body.v)}"
    return f"{words} capped"


def _formulas(function: NumericFunction) -> Formulas:
    formulas = function.function.function
    if not isinstance(formulas, Formulas):
        raise InputError(f"{function.function.name} is Python and no formula: it cannot be written into a scene file")
    return formulas


def _quoted(function: NumericFunction) -> str:
    return " ".join(dumps(expression.text) for expression in _formulas(function).expressions)


def _cyclide(surface: InvertedSurface) -> str:
    torus = surface.surface
    if not isinstance(torus, Torus) or np.any(torus.centre):
        raise InputError("the scene language has no word for an inverted surface other than a torus about the origin")
    centre = _numbers(np.asarray(surface.centre))
    return f"cyclide {_numbers((torus.major, torus.minor))} centre {centre} radius {float(surface.radius)!r}"


def _implicit_cyclide(s: ImplicitCyclide) -> str:
    words = f"implicit_cyclide {_numbers((s.major, s.minor))} centre {_numbers(np.asarray(s.centre))}"
    return words + f" radius {float(s.radius)!r}" + ("" if s.bounds is None else _box(s.bounds))


def _minimal(surface: MinimalSurface) -> str:
    domain = surface.domain
    if domain.u_start != -domain.u_end:
        raise InputError("the scene language has no word for a minimal surface that is wider on one side")
    if isinstance(surface.curve, SpiralCurve):
        name = f"minimal_spiral {float(surface.curve.growth)!r}"
    elif isinstance(surface.curve, HelicoidCurve):
        name = "helicoid"
    else:
        raise InputError(f"the scene language has no word for a {type(surface.curve).__name__}")
    bending = f" bending {_degrees(surface.bending)}" if surface.bending else ""
    return f"{name} width {domain.u_end!r}{bending}{_range(domain)}"


def _swept(surface: Swept) -> str:
    generator, motion = _curve(surface.generator), surface.motion
    if isinstance(motion, Translation):
        return f"translation {generator} path {_curve(motion.path)}"
    if isinstance(motion, Screw):
        name = f"helical {float(motion.rise)!r}" if motion.rise else "revolution"
    elif isinstance(motion, Rotoid):
        name = f"rotoidal {_numbers((motion.ratio, motion.distance))}"
    elif isinstance(motion, SpiralMotion):
        name = f"spiral {float(motion.growth)!r}"
    else:
        raise InputError(f"the scene language has no word for the motion {type(motion).__name__}")
    return f"{name} {generator}{_range(surface.domain)}"


def curve_text(curve: Curve) -> str:
    """The words of a curve in space as an item, from its kind on, its place included.

    Error: as for surfaces. Errors: InputError for curves that the language cannot name.
    """
    if isinstance(curve, PlacedCurve):
        return curve_text(curve.curve) + _placement(np.asarray(curve.matrix), np.asarray(curve.shift))
    words = _curve(curve)
    return words if words.startswith("curve ") else f"curve {words}"


def _curve(curve: Curve) -> str:
    if isinstance(curve, Line):
        p, q = np.asarray(curve.point), np.asarray(curve.direction)
        if (curve.start, curve.end) == (0.0, 1.0) and np.array_equal((p + q) - p, q):
            return f"line {_numbers(p)} , {_numbers(p + q)}"
        parts = " ".join(f'"{a!r} + ({b!r})*t"' for a, b in zip(p.tolist(), q.tolist(), strict=True))
        return f"curve {parts} t {_numbers((curve.start, curve.end))}"
    if isinstance(curve, Circle):
        return f"circle {float(curve.radius)!r}{_named(centre=curve.centre, axis=curve.axis)}{_arc(curve)}"
    if isinstance(curve, Helix):
        words = f"helix {_numbers((curve.radius, curve.rise))}"
        return f"{words}{_named(centre=curve.centre, axis=curve.axis)}{_arc(curve)}"
    if isinstance(curve, Loxodrome):
        arc = f" arc {_degrees(curve.start, curve.end)}"
        return f"loxodrome {float(curve.radius)!r} course {_degrees(curve.alpha)}{arc}"
    if isinstance(curve, CylinderBranch):
        branch = cylinder_intersection(curve.r, curve.s, curve.a).index(curve) + 1
        return f"cylinder_intersection {_numbers((curve.r, curve.s, curve.a))} branch {branch}"
    if isinstance(curve, FunctionCurve):
        closed = " closed" if curve.closed else ""
        return f"curve {_quoted(curve.function)} t {_numbers((curve.start, curve.end))}{closed}"
    if isinstance(curve, SplineCurve):
        closed = " closed" if curve.closed else ""
        weights = "" if curve.weights is None else f" weights {_list(np.asarray(curve.weights))}"
        words = f"nurbs {_points(curve.controls)} order {curve.order} knots {_list(np.asarray(curve.knots))}"
        return f"{words}{weights}{closed}"
    raise InputError(f"the scene language has no word for the curve {type(curve).__name__}")


def _spline(surface: SplineSurface) -> str:
    lines = "".join(f"\n  line {_points(line)}" for line in np.asarray(surface.controls))
    knots = f" knots_u {_list(np.asarray(surface.knots_u))} knots_v {_list(np.asarray(surface.knots_v))}"
    weights = "" if surface.weights is None else f"\n  weights {_list(np.asarray(surface.weights).ravel())}"
    closed = (" closed_u" if surface.closed_u else "") + (" closed_v" if surface.closed_v else "")
    return f"nurbs orders {surface.order_u} {surface.order_v}{knots}{closed}{lines}{weights}"


def _points(points: ArrayLike) -> str:
    return " , ".join(_numbers(point) for point in np.asarray(points).tolist())


def _arc(curve: Circle | Helix) -> str:
    return "" if (curve.start, curve.end) == (0.0, 2.0 * pi) else f" arc {_degrees(curve.start, curve.end)}"


def _function(surface: FunctionSurface) -> str:
    d = surface.domain
    closed = (" closed_u" if d.closed_u else "") + (" closed_v" if d.closed_v else "")
    ranges = f"u {_numbers((d.u_start, d.u_end))} v {_numbers((d.v_start, d.v_end))}"
    return f"function {_quoted(surface.function)} {ranges}{closed}"


def _graph(surface: Graph) -> str:
    if surface.heights.inside is not None:
        raise InputError("the scene language has no word for a graph above a region other than a rectangle or a disc")
    d = surface.domain
    return f"graph {_quoted(surface.heights)} x {_numbers((d.u_start, d.u_end))} y {_numbers((d.v_start, d.v_end))}"


def _polar_graph(surface: PolarGraph) -> str:
    d = surface.domain
    hole = f" hole {d.u_start!r}" if d.u_start else ""
    return f"graph {_quoted(surface.plane.heights)} disc {d.u_end!r}{_named(centre=surface.centre)}{hole}"


_WRITERS: dict[type, Callable[[Any], str]] = {
    Torus: lambda s: f"torus {_numbers((s.major, s.minor))}{_named(centre=s.centre)}",
    Sphere: lambda s: f"sphere {_numbers((s.radius,))}{_named(centre=s.centre)}",
    Ellipsoid: lambda s: f"ellipsoid {_numbers(s.semi_axes)}{_named(centre=s.centre)}",
    Cylinder: lambda s: f"cylinder {_numbers((s.radius, s.bottom, s.top))}{_named(depth=s.depth, centre=s.centre)}",
    Cone: lambda s: (
        "cone" + _named(slope=s.slope, bottom=s.bottom, top=s.top, depth_slope=s.depth_slope, centre=s.centre)
    ),
    Frustum: lambda s: f"frustum {_numbers((s.radius, s.top_radius, s.height))}{_named(centre=s.centre)}",
    Capped: _capped,
    Hyperboloid: lambda s: f"hyperboloid {_numbers((*s.semi_axes, s.bottom, s.top))}{_named(centre=s.centre)}",
    HyperboloidSheet: lambda s: f"hyperboloid_sheet {_numbers((*s.semi_axes, s.top))}{_named(centre=s.centre)}",
    Paraboloid: lambda s: f"paraboloid {_numbers((s.a, s.b, s.top))}{_named(centre=s.centre)}",
    HyperbolicParaboloid: lambda s: (
        f"hyperbolic_paraboloid {_numbers((s.a, s.b, s.width, s.depth))}{_named(centre=s.centre)}"
    ),
    InvertedSurface: _cyclide,
    MinimalSurface: _minimal,
    Swept: _swept,
    FunctionSurface: _function,
    Graph: _graph,
    PolarGraph: _polar_graph,
    ImplicitFunction: lambda s: f"implicit {_quoted(s.function)}{_box(s.box)}",
    Quadric: lambda s: f"quadric {_numbers(s.coefficients)}{_box(s.box)}{_named(centre=s.origin)}",
    ImplicitTorus: lambda s: f"implicit_torus {_numbers((s.major, s.minor))}{_named(centre=s.centre)}",
    ImplicitCyclide: _implicit_cyclide,
    SplineSurface: _spline,
}

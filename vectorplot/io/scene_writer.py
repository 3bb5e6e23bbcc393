"""Scenes as text in the scene language, with every digit: smooth surfaces, curves, items and all that stands around."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from json import dumps
from math import degrees, pi, radians
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve, is_curve
from vectorplot.curves.derivatives import NumericFunction
from vectorplot.curves.families import Circle, CylinderBranch, Helix, Line, Loxodrome, cylinder_intersection
from vectorplot.curves.placed_curves import FunctionCurve, PlacedCurve
from vectorplot.curves.splines import SplineCurve
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.reserved_words import RESERVED
from vectorplot.io.scene_item import hatch_text
from vectorplot.io.scene_statements import ink_texts, sheet_text
from vectorplot.io.scene_words import bare_word
from vectorplot.io.shape_arguments import Formulas
from vectorplot.scene.colour_scales import Colouring
from vectorplot.scene.cuts import Cut
from vectorplot.scene.item import Item, Pattern
from vectorplot.scene.labels import Along, AtVertex, BesidePoint, Label, Measures, OnCurve, OnPage
from vectorplot.scene.light import Light
from vectorplot.scene.material import FINISH_WORDS, Material
from vectorplot.scene.page import Page, in_latex
from vectorplot.scene.placement import FittedPage, PageAtScale, PageOfWidth
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import NO_LINES, Roads, Serpentine, SurfaceLines, TerrainLines, WaterCourses
from vectorplot.surfaces.capped_bodies import Capped, Frustum
from vectorplot.surfaces.function_surface import FunctionSurface
from vectorplot.surfaces.graphs import Graph, PolarGraph
from vectorplot.surfaces.implicit import ImplicitFunction
from vectorplot.surfaces.inversion import InvertedSurface
from vectorplot.surfaces.minimal import HelicoidCurve, MinimalSurface, SpiralCurve
from vectorplot.surfaces.parameter_regions import Loop
from vectorplot.surfaces.placed_surface import PlacedImplicit, PlacedSurface
from vectorplot.surfaces.quadrics import (
    Cone,
    Cylinder,
    Ellipsoid,
    HyperbolicParaboloid,
    Hyperboloid,
    HyperboloidSheet,
    Paraboloid,
    Quadric,
    Sphere,
)
from vectorplot.surfaces.splines import SplineSurface
from vectorplot.surfaces.surface import Domain, ImplicitSurface, Surface, is_implicit, is_parametrised
from vectorplot.surfaces.swept import Rotoid, Screw, SpiralMotion, Swept, Translation
from vectorplot.surfaces.tori import ImplicitCyclide, ImplicitTorus, Torus
from vectorplot.surfaces.trimmed import TrimmedSurface
from vectorplot.words import COLOURS

if TYPE_CHECKING:
    from vectorplot.surfaces.subdivision import LimitPlaces

# Smooth surfaces and curves as words of the scene language.


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
        from vectorplot.io.integral_line_words import integral_text

        words += [integral_text(lines) for lines in curves.integral]
    words += [_terrain_text(asked) for asked in curves.terrain]
    for one in curves.contours:
        said = str(one.values) if isinstance(one.values, int) else f"at {_list(one.values)}"
        words.append(f"contours {dumps(one.name)} {said}")
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
    trims = [f"\n  trim {_loop(loop)}" for loop in part.trims]
    return words + "".join([*trims, *(f"\n  trim_hole {_loop(loop)}" for loop in part.holes)])


def _loop(loop: Loop) -> str:
    """A curve in u and v that trims a surface."""
    if isinstance(loop, FunctionCurve):
        u, v, _ = _formulas(loop.function).expressions
        return f"{dumps(u.text)} {dumps(v.text)} t {_numbers((loop.start, loop.end))}"
    if is_curve(loop):
        raise InputError(f"the scene language has no word for a {type(loop).__name__} that trims a surface")
    return " , ".join(_numbers(corner) for corner in np.asarray(loop, dtype=np.float64))


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


# Scenes as text in the scene language, with every digit.


def write_scene(scene: Scene) -> str:
    """A scene as a text in the scene language, with every digit.

    Source: Glaeser, section 3.6; erratum G3-16.
    """
    blocks: list[str] = []
    if scene.title:
        blocks.append(f"title {dumps(scene.title)}")
    if scene.background is not None:
        blocks.append(f"background {_colour(scene.background)}")
    if scene.exposure != 1.0:
        blocks.append(f"exposure {scene.exposure if scene.exposure == 'fitted' else format(scene.exposure, '.17g')}")
    if scene.depth_cue is not None:
        blocks.append(f"depth_cue {' '.join(scene.depth_cue.by)} {scene.depth_cue.steps}")
    if scene.colouring is not None:
        blocks.append(_colouring(scene.colouring))
    if scene.box is not None:
        blocks.append(f"box_axes names {' '.join(map(dumps, scene.box.names))} size {_size(scene.box.capitals_mm)}")
    if scene.scale_bar is not None:
        bar = scene.scale_bar
        length = "" if bar.length is None else f" length {bar.length:.17g}"
        blocks.append(f"scale_bar {dumps(bar.unit)}{length} size {_size(bar.capitals_mm)}")
    if scene.page is not None:
        blocks.append(_page(scene.page))
    if scene.camera is not None:
        blocks.append(_camera(scene.camera))
    blocks.extend(_light(light) for light in scene.lights)
    blocks.extend(_item(item, scene.lights) for item in scene.items)
    blocks.extend(map(_label, scene.labels))
    blocks.extend(_cut(cut) for cut in scene.cuts if cut.items != ())
    if scene.explosion is not None:
        said = scene.explosion
        blocks.extend(f"explode {dumps(name)} {_numbers(step)}" for name, step in said.moves)
        blocks.extend([] if said.moves else [f"explode {_numbers(said.way)} {said.factor:.17g}"])
    if scene.measures is not None and (told := _measures(scene.measures)):
        blocks.append(f"measures {told}")
    if scene.sheet is not None and (told := sheet_text(scene.sheet)):
        blocks.append(told)
    if scene.inks is not None:
        blocks.extend(ink_texts(scene.inks))
    return "".join(block + "\n" for block in blocks)


def _name(text: str) -> str:
    return text if bare_word(text) and text not in RESERVED else dumps(text)


def _colouring(own: Colouring) -> str:
    if not isinstance(own.by, str):
        raise InputError("colours by a function of Python have no words")
    words = [f"colour_by {dumps(own.by)} map {dumps(own.colour_map)} steps {own.steps}"]
    words += [] if own.label is None else [f"called {dumps(own.label)}"]
    words += [f"classes {', '.join(f'{limit:.17g}' for limit in own.at)}"] if own.at else []
    words += [f"{word} {end:.17g}" for word, end in (("low", own.low), ("high", own.high)) if end is not None]
    words += [f"{word} {_colour(name)}" for word, name in (("under", own.under), ("over", own.over)) if name]
    words += [*(["logarithmic"] if own.logarithmic else []), *([] if own.is_lit else ["unlit"])]
    return " ".join([*words, f"size {_size(own.capitals_mm)}"])


def _colour(text: str) -> str:
    return text if text in COLOURS else dumps(text)


def _names_listed(points: Floats) -> str:
    """Points with commas between them, one a line."""
    return " ,\n  ".join(" ".join(map(repr, point)) for point in points.tolist())


def _page(page: Page) -> str:
    if isinstance(page, PageOfWidth):
        return f"page width {in_latex(page.width_mm) or repr(page.width_mm)} margin {page.margin_mm!r}"
    if isinstance(page, PageAtScale):
        return f"page scale {page.mm_per_unit!r} margin {page.margin_mm!r}"
    fit = " fit" if isinstance(page, FittedPage) else ""
    return f"page {page.width_mm!r}x{page.height_mm!r}{fit} margin {page.margin_mm!r}"


def _camera(camera: Camera) -> str:
    words = [f"camera eye {_numbers(camera.eye)} target {_numbers(camera.target)}"]
    if camera.up is not None:
        words.append(f"up {_numbers(camera.up)}")
    words.append(f"twist {float(camera.twist_deg)!r} field_of_vision {float(camera.fov_deg)!r}")
    if camera.parallel:
        words.append("parallel")
    if camera.height is not None:
        words.append(f"height {float(camera.height)!r}")
    words.extend(f"{name} {float(depth)!r}" for name, depth in (("near", camera.near), ("far", camera.far)) if depth)
    return " ".join(words)


def _light(light: Light) -> str:
    words = ["light", *([_name(light.name)] if light.name else [])]
    words.append(f"{'direction' if light.parallel else 'position'} {_numbers(light.position)}")
    if light.intensity is not None:
        words.append(f"intensity {float(light.intensity)!r}")
    if light.colour != "white":
        words.append(f"colour {_colour(light.colour)}")
    if light.fading:
        words.append("fading")
    return " ".join(words)


def _cut(cut: Cut) -> str:
    conditions = []
    for plane in cut.planes:
        terms = [f"{factor:+.17g}{axis}" for factor, axis in zip(plane.normal, "xyz", strict=True) if factor]
        conditions.append(f"{' '.join(terms)} {'=' if plane.to_eye else '>'} {plane.offset!r}")
    words = ["cut", dumps(", ".join(conditions)), *([cut.away] if cut.away != "gone" else [])]
    hatch = [*([] if cut.spacing_mm is None else [f"spacing {cut.spacing_mm:.17g}"]), f"angle {cut.angle_deg:.17g}"]
    items = [] if cut.items is None else ["of", *map(dumps, cut.items)]
    return " ".join([*words, *([f"colour {_colour(cut.colour)}"] if cut.colour else []), *hatch, *items])


def _label(label: Label) -> str:
    at = label.at
    if isinstance(at, AtVertex):
        place = f"vertex {_name(at.item)} {at.vertex + 1}"
    elif isinstance(at, (Along, OnCurve)):
        place = f"{'on' if isinstance(at, OnCurve) else 'along'} {_name(at.item)} {float(at.part)!r}"
    elif isinstance(at, OnPage):
        place = f"page {_numbers((at.x_mm, at.y_mm))}"
    else:
        place = f"at {_numbers(at.point if isinstance(at, BesidePoint) else at)}"
    words = [
        "label",
        _name(label.name) if label.name else '""',
        dumps(label.text),
        place,
        f"size {_size(label.capitals_mm)}",
    ]
    words += [f"measured {dumps(label.measured)}"] if label.measured else []
    words += [f"place {label.place}", *([f"hidden {label.hidden}"] if label.hidden else []), f"mark {label.mark}"]
    return " ".join(words)


def _size(size_mm: float) -> str:
    """A size of letters: the word that LaTeX has for it, or mm."""
    return in_latex(size_mm) or repr(float(size_mm))


def _measures(measures: Measures) -> str:
    decimals = [] if measures.decimals is None else [f"decimals {measures.decimals}"]
    return " ".join([*decimals, *(word for word in ("zeros", "comma") if getattr(measures, word))])


def _item(item: Item, lights: tuple[Light, ...]) -> str:
    colour = _colour_words(item.colour)
    form = ["general"] if isinstance(item.shape, Mesh) else []
    words = [_name(item.name), colour, *form, *_material(item.material)]
    words.append(f"occludes {'yes' if item.hides else 'no'}")
    if item.group:
        words.append(f"group {_name(item.group)}")
    if item.hatch is not None:
        words.append(hatch_text(item.hatch))
    lines = item.default_lines if item.lines is None else item.lines
    if lines is not None:
        words.append(f"lines {', '.join(lines) or 'none'}")
    return " ".join(words) + _shape(item, lights) + _edges(item) + _face_looks(item) + _patterns(item.patterns)


def _colour_words(colour: str) -> str:
    return colour if colour in COLOURS else f"colour {dumps(colour)}"


def _edges(item: Item) -> str:
    """The list of the edges to be drawn; parts of edges that a cut left are none of the language."""
    if item.drawn_edges is None or not isinstance(item.shape, Mesh) or _limit(item) is not None:
        return ""
    number = {tuple(vertex): k + 1 for k, vertex in enumerate(item.shape.vertices.tolist())}
    listed = [*item.drawn_edges.tolist(), *([] if item.added_edges is None else item.added_edges.tolist())]
    ends = [[number.get(tuple(end)) for end in edge] for edge in listed]
    return "\nedges " + (" , ".join(f"{one} {two}" for one, two in ends if one and two) or "none")


def _face_looks(item: Item) -> str:
    """The looks of single faces."""
    if item.face_looks is None or not isinstance(item.shape, Mesh):
        return ""
    own, rows, places = item.face_looks.at(item.shape), [], _limit(item)
    if places is not None:
        faces = np.full(places.surface.cage.face_count, -1)
        faces[places.source] = own
        own = faces
    for number, look in enumerate(item.face_looks.looks):
        numbers = " ".join(str(face + 1) for face in np.flatnonzero(own == number).tolist())
        words = [] if look.colour is None else [_colour_words(look.colour)]
        words += [] if look.material is None else _material(look.material)
        rows += [f"{numbers} {' '.join(words)}"] if numbers and words else []
    return "\nface_looks " + " ,\n  ".join(rows) if rows else ""


def _shape(item: Item, lights: tuple[Light, ...]) -> str:
    if item.curves and is_curve(item.shape):
        raise InputError(f"{item.name}: the scene language has lines of its own for surfaces and polyhedra only")
    if isinstance(item.shape, Mesh) and item.curves == NO_LINES:
        return _mesh(item.shape)

    shape = item.shape
    try:
        if isinstance(shape, Mesh):
            if item.curves.columns or item.curves.rows or item.curves.paths:
                raise InputError("parameter lines and curves u(t), v(t) are for surfaces only")
            places = _limit(item)
            return (_mesh(shape) if places is None else _cage(places)) + lines_text(item.curves, lights)
        if is_parametrised(shape) or is_implicit(shape):
            return f"\nsurface {surface_text(shape)}{lines_text(item.curves, lights)}"
        if is_curve(shape):
            return f"\n{curve_text(shape)}"
        raise InputError(f"the scene language has no word for a {type(shape).__name__}")
    except InputError as error:
        raise InputError(f"{item.name}: {error.cause}") from None


def _limit(item: Item) -> LimitPlaces | None:
    """Where the triangles of an item lie on a limit surface, if it is all there is of it."""
    normals = item.normals
    if normals is None or normals.places is None or not normals.has_faces_of(item.mesh):
        return None
    return normals.places


def _cage(places: LimitPlaces) -> str:
    """The cage of a limit surface, and how it is subdivided."""
    surface = places.surface
    sharp = " , ".join(f"{one + 1} {two + 1}" for one, two in surface.sharp.tolist())
    words = f"{_mesh(surface.cage.transformed(places.matrix))}\nsubdivision {surface.scheme}"
    return f"{words} creases {sharp}" if sharp else words


def _material(material: Material) -> list[str]:
    own = [(name, getattr(material, name)) for name in FINISH_WORDS]
    finish = [f"{name} {value!r}" for name, value in own if value is not None]
    words = [material.word, *finish, f"opacity {float(material.opacity)!r}"]
    if material.refraction != 1.0:
        words.append(f"refraction {float(material.refraction)!r}")
    return words


def _mesh(mesh: Mesh) -> str:
    vertices = _names_listed(mesh.vertices) if len(mesh.vertices) else "none"
    polygons = mesh.polygons()
    faces = " ,\n  ".join(" ".join(str(corner + 1) for corner in polygon) for polygon in polygons) or "none"
    text = f"\nvertices\n  {vertices}\nfaces\n  {faces}"
    if mesh.present is not None:
        text += "\nremoved_faces " + " , ".join(str(face + 1) for face in np.flatnonzero(~mesh.present).tolist())
    return text


def _patterns(patterns: tuple[Pattern, ...]) -> str:
    if not patterns:
        return ""
    rows = [
        f"\n  face {p.face + 1} polygon {dumps(p.name)} {_colour(p.colour)}\n  {_names_listed(np.asarray(p.points))}"
        for p in patterns
    ]
    return "\npatterns" + "".join(rows)

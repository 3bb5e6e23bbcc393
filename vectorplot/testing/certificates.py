"""Certificates of drawings: what hides which part of which line, for a checker that knows nothing of this package."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.backends.json import json_bytes, plain
from vectorplot.curves.curve import is_curve
from vectorplot.curves.derivatives import NumericFunction
from vectorplot.curves.families import Circle, Helix, Line
from vectorplot.curves.placed_curves import FunctionCurve
from vectorplot.drawing.drawing import Drawing
from vectorplot.drawing.finishing import DASH_MM
from vectorplot.drawing.pens import Style, style_of_scene
from vectorplot.effects.glass import refracting_items
from vectorplot.geometry import ragged
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.anything import scene_of
from vectorplot.io.shape_arguments import Formulas
from vectorplot.pictures.options import check_look
from vectorplot.pictures.prepared_scene import Paper, prepared_scene
from vectorplot.scene.added_lines import curve_light, with_default_lines
from vectorplot.scene.item import Item
from vectorplot.scene.page import Page
from vectorplot.scene.placement import page_of
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.surfaces.capped_bodies import Capped, CappedPart, Frustum
from vectorplot.surfaces.function_surface import FunctionSurface
from vectorplot.surfaces.graphs import Graph, PolarGraph
from vectorplot.surfaces.inversion import InvertedSurface
from vectorplot.surfaces.minimal import HelicoidCurve, MinimalSurface
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import (
    Cone,
    Cylinder,
    Ellipsoid,
    EllipticSections,
    HyperbolicParaboloid,
    Hyperboloid,
    HyperboloidSheet,
    Paraboloid,
    Sphere,
)
from vectorplot.surfaces.surface import Surface
from vectorplot.surfaces.swept import Rotoid, Screw, SpiralMotion, Swept, Translation
from vectorplot.surfaces.tori import Torus
from vectorplot.testing import certified_drawing as drawn
from vectorplot.testing import certified_image as image
from vectorplot.testing import certified_surfaces as shapes
from vectorplot.testing import check_certificate as checker
from vectorplot.tolerances import (
    CERTIFIED_DAMPING,
    CERTIFIED_FORMULA,
    CERTIFIED_MM,
    CERTIFIED_POLE,
    LEAST_DIVISOR,
    MEANT_AT_POLE,
    ROUNDING,
)
from vectorplot.visibility.polyhedra.lines import kinds_of
from vectorplot.visibility.projected_faces import project_faces
from vectorplot.words import DRAWN, LineKind, line_kinds

if TYPE_CHECKING:
    from vectorplot.save import Destination

SIZE_MM = 0.01
"""Parts of lines that are shorter are not looked at."""

SMOOTH_MM = 0.05
"""So much is left open beside outlines of surfaces by formulas: strokes on them are off by up to 0.02 mm."""

COARSEST = 8
"""Lines of a net along u and v, from which it is refined."""

STRETCHED = 2.0
"""Gaps between dashes are no more than so many times as long as they are meant to be."""


@dataclass(frozen=True, eq=False)
class Certificate:
    """What proves a drawing.

    Parameters
    ----------
    content : dict
        As it stands in its file, see `docs/for_tests.md`.
    unproved : tuple of str
        What cannot be proved of the drawing, a few words each; empty where all of it can be.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, testing
    >>> cube = geometry.box((2, 2, 2))
    >>> certificate = testing.certificate(cube, vp.draw(cube))
    >>> [len(one["triangles"]) for one in certificate.content["items"]]
    [12]
    """

    content: dict[str, Any]
    unproved: tuple[str, ...] = ()

    def __bytes__(self) -> bytes:
        """The file: JSON in ASCII, an item, the claims of a stroke, or a hidden part of a line in a line each."""
        head = {key: value for key, value in self.content.items() if not isinstance(value, list) or key in _HEAD}
        rows = {key: value for key, value in self.content.items() if key not in head}
        tables = [f'"{key}": [{",".join(chr(10) + json.dumps(row) for row in value)}]' for key, value in rows.items()]
        return (json.dumps(head)[:-1] + ",\n" + ",\n".join(tables) + "}\n").encode("ascii")

    def save(self, path: Destination) -> None:
        """Write the file, whole or not at all.

        Parameters
        ----------
        path : str, path or file object
            The file, or an open one.

        Raises
        ------
        InputError
            For what is neither.
        OSError
            Where the file cannot be written.

        Examples
        --------
        >>> import os, tempfile
        >>> import vectorplot as vp
        >>> from vectorplot import geometry, testing
        >>> cube = geometry.box((2, 2, 2))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     testing.certificate(cube, vp.draw(cube)).save(os.path.join(folder, "cube.json"))
        ...     os.listdir(folder)
        ['cube.json']
        """
        from vectorplot.save import format_for, put

        format_for(path, "json")
        put(path, bytes(self))


_HEAD = ("page_from_world", "window_mm", "not_certified", "clear")


def certificate(
    scene: object,
    drawing: Drawing,
    camera: Camera | str | None = None,
    *,
    page: Page | str | None = None,
    lines: str | Iterable[str] | None = None,
    crease_angle_deg: float = 25.0,
    style: Style | str | None = None,
    hidden: Literal["none", "dashed", "solid"] | None = None,
    size_mm: float = SIZE_MM,
    width_mm: float = CERTIFIED_MM,
    smooth_mm: float = SMOOTH_MM,
) -> Certificate:
    """What hides each hidden stroke of a drawing, and each part of a line of its meshes that it does not show.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, or several of these
        What is drawn.
    drawing : Drawing
        What `draw` made of it, or something else did.
    camera : Camera or str, optional
        As in `draw`.
    page : Page or str, optional
        As in `draw`; its margin counts, within which all lines are.
    lines : str or iterable of str, optional
        As in `draw`.
    crease_angle_deg : float
        As in `draw`.
    style : Style or str, optional
        As in `draw`.
    hidden : {"none", "dashed", "solid"}, optional
        As in `draw`; where neither this nor the style says it, hidden lines are dashed if there are any.
    size_mm : float
        Parts of lines that are shorter are not looked at; in mm on the page.
    width_mm : float
        Beside the outlines of what is in front strips of this width are left open; in mm on the page.
    smooth_mm : float
        The same where there are surfaces by formulas, on which strokes are not exact; parts of lines are not looked at
        there up to as many times the length.

    Returns
    -------
    Certificate
        With the meshes in the world, the camera's matrix, and what hides what.

    Raises
    ------
    InputError
        See `draw`; for the style of a wireframe, in which nothing hides anything.

    Notes
    -----
    It is found without the hidden-line engine of this package, and shows right drawings right: whether this one is,
    `check_certificate.py` says, see `docs/for_tests.md`. Surfaces without formulas are not certified, nor are
    strokes of other kinds than contour, boundary, crease, edges, intersection, pattern, section, isophote, parameter
    and integral; a drawing with a halo, or thin ends, shows less than its lines.

    Source: Glaeser, section 7.2 (what a convex face hides of a segment is one interval).

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, testing
    >>> cube = geometry.box((2, 2, 2))
    >>> made = testing.certificate(cube, vp.draw(cube, "iso"), "iso")
    >>> made.unproved, len(made.content["hidden_lines"])
    ((), 6)
    """
    given = scene_of(scene) if lines is not None else with_default_lines(scene_of(scene))
    chosen, _ = style_of_scene(given.inks, style)
    check_look(chosen.look, certificate=True)
    kinds = line_kinds(DRAWN if lines is None else lines)
    paper = Paper(Page(drawing.width_mm, drawing.height_mm, 0.0), fit=True)
    prepared = prepared_scene(given, camera, paper, None, None)
    view, items = look(prepared.scene, prepared.camera), prepared.scene.items
    # What is behind glass that refracts light is seen bent, elsewhere, or not at all: not as hidden, either.
    bends = refracting_items(prepared.scene, view, project_faces(view))
    hides = view.occludes | bends
    triangles, owner = _triangles(view)
    world, first = prepared.scene.vertices, view.item_vertices
    found = json.loads(json_bytes(drawing))
    hidden = chosen.hidden if hidden is None else hidden
    if hidden == "none" and any(stroke["hidden_by"] for stroke in found["strokes"]):
        hidden = "dashed"
    margin = float(page_of(page, given).margin_mm)
    gap = max((layer.pen.dash_mm[1] for layer in drawing.layers if layer.pen.dash_mm), default=DASH_MM[1])
    parts = [() if item.cut_by or item.is_cut_face else surfaces_of(item.shape) for item in items]
    netted = [np.asarray(world), *(part.patch.points(*part.patch.grid()[:, ::2].T) for one in parts for part in one)]
    rows = image.image_rows(np.array(found["page_from_world"]), np.concatenate(netted))
    nets = _within_budget([_nets(one, rows, smooth_mm) for one in parts])
    parts = [one if net else () for one, net in zip(parts, nets, strict=True)]
    partial = _broken(drawing) or ("hidden lines behind glass" if bends.any() and hidden != "none" else "")
    said = [f"that {partial} are complete"] if partial else []
    content: dict[str, Any] = {
        "format": checker.FORMATS[1],
        "version": 1,
        "page_from_world": found["page_from_world"],
        "window_mm": [[margin, margin], [drawing.width_mm - margin, drawing.height_mm - margin]],
        "size_mm": float(size_mm),
        "width_mm": float(width_mm),
        "smooth_mm": float(smooth_mm),
        "crease_angle_deg": float(crease_angle_deg),
        "hidden_gap_mm": {"none": None, "solid": 0.0, "dashed": STRETCHED * max(gap, DASH_MM[1])}[hidden],
        "not_certified": said
        + [line for item, one in zip(items, parts, strict=True) for line in _not_certified(item, kinds, one)],
        "items": [
            {
                "name": item.name,
                "hides": bool(hides[number]),
                "smooth": not isinstance(item.shape, Mesh),
                **_conditions(item, parts[number]),
                "isophotes": _lights(prepared.scene, view, item) if parts[number] else [],
                "surfaces": nets[number],
                "lines": [] if partial else _complete(item, kinds),
                "vertices": plain(world[first[number] : first[number + 1]]),
                "triangles": (triangles[owner == number] - first[number]).tolist(),
            }
            for number, item in enumerate(items)
        ],
    }
    strange = {stroke["kind"] for stroke in found["strokes"]} - {"edges", *drawn.EDGE_KINDS, *drawn.FACE_KINDS}
    said = [*content["not_certified"], *(f"strokes of the kind {kind}" for kind in sorted(strange))]
    shapes = drawn.shapes_of(content)
    return Certificate({**content, **strokes_claimed(found, content, shapes), **_lines_claimed(shapes)}, tuple(said))


def _triangles(view: View) -> tuple[Ints, Ints]:
    """(t,3) the faces of a view as triangles, and the item (t,) of each: those around the first corner of each of the
    convex parts."""
    count = view.face_sizes - 2
    corner, step = np.repeat(view.offsets[:-1], count), ragged.place(count)
    return view.corners[np.stack([corner, corner + step + 1, corner + step + 2], axis=1)], view.face_item.repeat(count)


def _broken(drawing: Drawing) -> str:
    """Which visible lines of a drawing have gaps that nothing hides; empty where none have."""
    seen = [
        (layer.pen, paths.kind) for layer in drawing.layers for paths in layer.strokes if (paths.hidden_by == 0).any()
    ]
    dashed = any(pen.dash_mm is not None and any(pen.dash_mm) for pen, _ in seen)
    lettered = any((kind == LineKind.LABEL).any() for _, kind in seen) or any(layer.texts for layer in drawing.layers)
    return " and ".join(["dashed lines"] * dashed + ["lines beside labels"] * lettered)


def _complete(item: Item, kinds: frozenset[LineKind]) -> list[str]:
    """The kinds of lines of which all on an item are drawn."""
    own = {kind.word for kind in kinds_of(item, kinds)} & {*drawn.EDGE_KINDS}
    if item.drawn_edges is not None or item.cut_by or item.is_cut_face or LineKind.GHOST in kinds_of(item, kinds):
        return []
    return sorted(own - {"contour"} if item.curves.smooth_contours else own)


def _not_certified(item: Item, kinds: frozenset[LineKind], surfaces: tuple[_Surface, ...]) -> list[str]:
    """What cannot be proved of a drawing because of an item, a few words each."""
    if is_curve(item.shape):
        return []
    if not isinstance(item.shape, Mesh) and not surfaces:
        return [f"what {item.name} shows and hides, which is a smooth shape without formulas, or too large"]
    left = {kind.word for kind in kinds_of(item, kinds)} & {*drawn.EDGE_KINDS} - {*_complete(item, kinds)}
    there = surfaces or item.mesh.face_count
    return [f"that each {', '.join(sorted(left))} of {item.name} is there"] if left and there else []


# Surfaces by their formulas.


@dataclass(frozen=True)
class _Surface:
    """A surface with formulas, the coarsest net on it, and the rows of its certificate that name it."""

    formulas: tuple[str, str, str]
    placement: Floats
    patch: shapes.Patch


def surfaces_of(shape: Any) -> tuple[_Surface, ...]:
    """A shape as surfaces by formulas, caps and mantles apart; none where there are none, or they give other points."""
    place = np.hstack([np.eye(3), np.zeros((3, 1))])
    while isinstance(shape, PlacedSurface):
        matrix, shift = np.asarray(shape.matrix), np.asarray(shape.shift)
        turned = (place[:, :3, None] * np.vstack([matrix, shift]).T).sum(axis=1)
        turned[:, 3] += place[:, 3]
        place, shape = turned, shape.surface
    found = []
    for part in shape.parts if isinstance(shape, Capped) else (shape,):
        formulas = _formulas(part)
        if formulas is None:
            return ()
        domain = part.domain
        u, v = (
            np.linspace(low, high, COARSEST + 1)
            for low, high in ((domain.u_start, domain.u_end), (domain.v_start, domain.v_end))
        )
        at = np.meshgrid(u, v, indexing="ij")
        points = part.points(*at)
        size = float(np.abs(points).max()) if np.isfinite(points).all() else np.nan
        for knots, rows in ((u, points), (v, points.swapaxes(0, 1))):
            for end, step in ((0, 1), (-1, -1)):
                if (np.ptp(rows[end], axis=0) < ROUNDING * size).all():
                    knots[end] += step * CERTIFIED_POLE * (knots[-1] - knots[0])
        row = {"formulas": list(formulas), "placement": place.tolist(), "u": u.tolist(), "v": v.tolist()}
        try:
            patch = shapes.patch_of(row)
            same = np.abs(patch._replace(place=np.eye(3, 4)).points(*at) - points).max() <= CERTIFIED_FORMULA * size
        except (ValueError, SyntaxError):
            return ()
        if not same:
            return ()
        found.append(_Surface(formulas, place, patch))
    return tuple(found)


def _formulas(shape: object) -> tuple[str, str, str] | None:
    """x, y, z of a surface without place, in u and v; None where there are none."""
    match shape:
        case CappedPart(body=body, part="mantle"):
            profile = _profile(body.surface)
            # Radii of a body are positive.
            turned = "" if body._outside > 0.0 else "-1.0*"
            return None if profile is None else _sections(body, turned + profile[0], profile[1])
        case CappedPart(body=body, part=part, v=(low, high)):
            rim, middle = (high, low) if part == "bottom" else (low, high)
            radius, height = (float(one[0]) for one in body.profile_of(part, np.array([rim]))[0])
            return _sections(body, f"{radius!r}*(({middle!r}-v)/({middle - rim!r}))", repr(height))
        case EllipticSections():
            profile = _profile(shape)
            return None if profile is None else _sections(shape, *profile)
        case HyperbolicParaboloid():
            return _moved(("u", "v", f"(u/{shape.a!r})**2-(v/{shape.b!r})**2"), shape.centre)
        case InvertedSurface():
            inner = _formulas(shape.surface)
            if inner is None:
                return None
            way = [f"({text}-({float(c)!r}))" for text, c in zip(inner, np.asarray(shape.centre), strict=True)]
            square = f"({'+'.join(f'{one}**2' for one in way)})"
            return _moved(tuple(f"{float(shape.radius) ** 2!r}*{one}/{square}" for one in way), shape.centre)
        case MinimalSurface(curve=HelicoidCurve(), bending=angle):
            c, s = (f"({float(part)!r})" for part in (np.cos(angle), np.sin(angle)))
            return (
                f"-{c}*sinh(u)*sin(v)-{s}*cosh(u)*cos(v)",
                f"{c}*sinh(u)*cos(v)-{s}*cosh(u)*sin(v)",
                f"{c}*v+{s}*u",
            )
        case FunctionSurface():
            return cast("tuple[str, str, str] | None", _written(shape.function))
        case Graph():
            height = _written(shape.heights, u="x", v="y")
            return None if height is None else ("u", "v", *height)
        case PolarGraph():
            x, y = (f"({float(c)!r}+u*{wave}(v))" for c, wave in zip(shape.centre, ("cos", "sin"), strict=True))
            height = _written(shape.plane.heights, **{x: "x", y: "y"})
            return None if height is None else (x, y, *height)
        case Swept(generator=generator, motion=motion):
            curve = _curve(generator, "u")
            return None if curve is None else _carried(curve, motion)
    return None


def _profile(shape: EllipticSections) -> tuple[str, str] | None:
    """Radius and height by v of a surface with elliptic sections."""
    match shape:
        case Ellipsoid():
            return "cos(v)", f"{float(np.asarray(shape.semi_axes)[2])!r}*sin(v)"
        case Sphere():
            return "cos(v)", f"{shape.radius!r}*sin(v)"
        case Cylinder():
            return "1.0", "v"
        case Cone():
            return "v", "v"
        case Frustum():
            low, high, height = (f"{float(one)!r}" for one in (shape.radius, shape.top_radius, shape.height))
            return f"({low}*(1.0-v/{height})+{high}*v/{height})", "v"
        case Hyperboloid():
            return "cosh(v)", f"{float(np.asarray(shape.semi_axes)[2])!r}*sinh(v)"
        case HyperboloidSheet():
            return "sinh(v)", f"{float(np.asarray(shape.semi_axes)[2])!r}*cosh(v)"
        case Paraboloid():
            return "v", "v**2"
        case Torus():
            return f"({shape.major!r}-{shape.minor!r}*cos(v))", f"{shape.minor!r}*sin(v)"
    return None


def _sections(body: EllipticSections, radius: str, height: str) -> tuple[str, str, str]:
    a, b = (float(part) for part in body._ellipse())
    return _moved((f"{a!r}*{radius}*cos(u)", f"{b!r}*{radius}*sin(u)", height), body._middle())


def _moved(formulas: Iterable[str], by: ArrayLike) -> tuple[str, str, str]:
    x, y, z = (f"{float(c)!r}+{text}" for c, text in zip(np.asarray(by), formulas, strict=True))
    return x, y, z


def _written(function: NumericFunction, **names: str) -> Any:
    """The formulas of a function that was read as formulas, in other names, such as u for x; None for others."""
    formulas = getattr(function.function, "function", None)
    if not isinstance(formulas, Formulas):
        return None
    texts = [one.text.replace("^", "**") for one in formulas.expressions]
    for new, old in names.items():
        texts = [re.sub(rf"\b{old}\b", new, text) for text in texts]
    return tuple(f"({text})" for text in texts)


def _curve(curve: object, name: str) -> tuple[str, str, str] | None:
    """x, y, z of a curve in space by its parameter's name; None where there are no formulas."""
    match curve:
        case Line():
            return _moved([f"({float(way)!r})*{name}" for way in np.asarray(curve.direction)], curve.point)
        case Circle() | Helix():
            circle = curve if isinstance(curve, Circle) else curve._round
            rise = np.zeros(3) if isinstance(curve, Circle) else curve._upwards
            e, f, _ = circle.radius * circle.frame
            rows = zip(e.tolist(), f.tolist(), rise.tolist(), strict=True)
            return _moved(
                [f"({a!r})*cos({name})+({b!r})*sin({name})+({c!r})*{name}" for a, b, c in rows], circle.centre
            )
        case FunctionCurve():
            return cast("tuple[str, str, str] | None", _written(curve.function, **{name: "t"}))
    return None


def _carried(curve: tuple[str, str, str], motion: object) -> tuple[str, str, str] | None:
    """x, y, z of a curve in u that a motion carries for the time v; None where there are no formulas."""
    x, y, z = (f"({text})" for text in curve)
    match motion:
        case Translation(path=path):
            way = _curve(path, "v")
            return None if way is None else (f"{x}+{way[0]}", f"{y}+{way[1]}", f"{z}+{way[2]}")
        case Screw(rise=rise):
            z = f"{z}+{rise!r}*v"
        case Rotoid(ratio=ratio, distance=distance):
            across, angle = f"({x}-{distance!r})", f"({ratio!r}*v)"
            x = f"({across}*cos{angle}+{z}*sin{angle}+{distance!r})"
            z = f"({z}*cos{angle}-{across}*sin{angle})"
        case SpiralMotion(growth=growth):
            x, y, z = (f"(exp({growth!r}*v)*{text})" for text in (x, y, z))
        case _:
            return None
    return f"{x}*cos(v)-{y}*sin(v)", f"{x}*sin(v)+{y}*cos(v)", z


def _within_budget(nets: list[list[dict[str, Any]]]) -> list[list[dict[str, Any]]]:
    """The nets of items, without those after which there were too many cells."""
    cells = [sum((len(net["u"]) - 1) * (len(net["v"]) - 1) for net in own) for own in nets]
    fits = np.cumsum(cells) <= 2 * shapes.MOST_CELLS
    return [own if fit else [] for own, fit in zip(nets, fits.tolist(), strict=True)]


def _conditions(item: Item, surfaces: tuple[_Surface, ...]) -> dict[str, list[list[float]]]:
    """Where parameter lines and plane sections of an item are: values of u and of v; rows of normal and offset."""
    planes = [[*np.asarray(one.normal).tolist(), offset] for one in item.curves.sections for offset in one.offsets]
    if not surfaces:
        return {"parameters": [], "planes": planes}
    values = cast("Surface", item.shape).domain.grid(max(item.curves.columns, 1), max(item.curves.rows, 1))
    return {"parameters": [one.tolist() for one in values], "planes": planes}


def _lights(scene: Scene, view: View, item: Item) -> list[list[float]]:
    """What isophotes of an item are of: rows of direction or place, 0 or 1, and cosine."""
    if not item.curves.isophotes:
        return []
    light = curve_light(scene, view, item)
    return [
        [*map(float, np.asarray(light.position)), 0.0 if light.parallel else 1.0, float(cosine)]
        for cosine in item.curves.isophotes
    ]


def _nets(surfaces: tuple[_Surface, ...], rows: Floats, smooth_mm: float) -> list[dict[str, Any]]:
    """The rows of a certificate that name surfaces; those with the same ends of u share its lines, as caps and mantles
    do, whose rims are one."""
    patches = [_refined(one.patch, rows, _AIM * smooth_mm) for one in surfaces]
    lines = [
        np.unique(np.concatenate([other.u for other in patches if (other.u[[0, -1]] == one.u[[0, -1]]).all()]))
        for one in patches
    ]
    return [
        {"formulas": list(one.formulas), "placement": one.placement.tolist(), "u": u.tolist(), "v": patch.v.tolist()}
        for one, patch, u in zip(surfaces, patches, lines, strict=True)
    ]


def _on_surfaces(strokes: list[Any], items: list[Any], shapes: drawn.Shapes) -> list[list[float]]:
    """Where on surfaces strokes run, in pieces that are straight in u and v: rows of stroke, segment, from, to, the
    number of the surface, u and v where the piece begins, and where it ends."""
    found, first = [], 0
    for item in items:
        own = [number for number, one in enumerate(strokes) if one["item"] == item["name"] and item["surfaces"]]
        if own:
            patches = [patch for _, patch in shapes.patches[first : first + len(item["surfaces"])]]
            ways = [np.array([*strokes[k]["points3d"], *strokes[k]["points3d"][: strokes[k]["closed"]]]) for k in own]
            values = [item["parameters"] if strokes[k]["kind"] == "parameter" else [[], []] for k in own]
            cut = [strokes[k]["kind"] == "section" for k in own]
            pieces = _pieces(own, ways, values, (cut, item["planes"]), patches, shapes.view, shapes.limits.fine)
            pieces[:, 4] += first
            found.append(pieces)
        first += len(item["surfaces"])
    table = np.concatenate([np.zeros((0, 9)), *found])
    return [[int(a), int(b), c, d, int(e), *rest] for a, b, c, d, e, *rest in table.tolist()]


def _pieces(
    own: list[int],
    ways: list[Floats],
    values: list[Any],
    sections: tuple[list[bool], list[list[float]]],
    patches: list[shapes.Patch],
    rows: Floats,
    slack: float,
) -> Floats:
    """(n,9) such rows of strokes by their numbers and points in the world, on patches of one item; values: those of u
    and of v on one of which a stroke runs, if it is a parameter line; sections: which strokes are some, of what planes,
    rows of normal and offset."""
    points, count = np.concatenate(ways), np.array([len(way) for way in ways])
    stroke = np.repeat(np.arange(len(own)), count)
    begin = np.flatnonzero(stroke[:-1] == stroke[1:])
    names = np.stack([np.array(own)[stroke[begin]], begin - (np.cumsum(count) - count)[stroke[begin]]], axis=1)
    on = [_feet(patch, points, rows) for patch in patches]
    page = points_on(rows, points)[:, :2]
    cut = np.flatnonzero(np.array(sections[0], dtype=np.bool_)[stroke])
    for patch, (feet, _) in zip(patches, on, strict=True):
        if len(cut) and len(sections[1]):
            feet[cut] = feet_in_planes(patch, feet[cut], points[cut], np.array(sections[1]))
        held = np.zeros(feet.shape, dtype=np.bool_)
        for number, lines in enumerate(values):
            _snap(feet, held, np.flatnonzero(stroke == number), lines)
        lined = held.any(axis=1)
        feet[lined] = _stepped(patch, rows, feet[lined], page[lined], (False, False), held[lined])
    off = np.stack([np.maximum(away[begin], away[begin + 1]) for _, away in on])
    found = []
    for number, (patch, (place, _)) in enumerate(zip(patches, on, strict=True)):
        chosen = begin[off.argmin(axis=0) == number]
        ends = np.stack([place[chosen], place[chosen + 1]], axis=1)
        size = np.array([patch.u[-1] - patch.u[0], patch.v[-1] - patch.v[0]])
        # The shorter way over a seam, for surfaces that close there.
        closed = np.array(_closed(patch))
        ends[:, 1] -= closed * size * np.rint((ends[:, 1] - ends[:, 0]) / size)
        # In a pole the other parameter is that of the other end.
        for axis, other in ((0, 1), (1, 0)):
            for pole in _poles(patch, axis):
                for k in (0, 1):
                    at = np.abs(ends[:, k, axis] - pole) < MEANT_AT_POLE * size[axis]
                    ends[at, k, other] = ends[at, 1 - k, other]
        rows_of = np.column_stack([names[off.argmin(axis=0) == number], np.zeros(len(chosen)), np.ones(len(chosen))])
        lines = np.stack([page[chosen], page[chosen + 1]], axis=1)
        for _ in range(_HALVED):
            cells = np.sort(ends, axis=1).swapaxes(1, 2).reshape(-1, 4)
            bad = shapes.deviations(patch, rows, cells).sum(axis=1) > _AIM * slack
            if not bad.any():
                break
            middle, at = 0.5 * (rows_of[bad, 2] + rows_of[bad, 3]), ends[bad].mean(axis=1)
            way = lines[bad, 1] - lines[bad, 0]
            ahead = points_on(rows, patch.points(*at.T))[:, :2] - lines[bad, 0]
            share = (ahead * way).sum(axis=1) / np.maximum((way * way).sum(axis=1), LEAST_DIVISOR)
            # Straight on in u and v where that is below the line, as on parameter lines; else what is below its middle.
            straight = np.hypot(*(ahead - share[:, None] * way).T) < _BESIDE * slack
            straight &= (share > rows_of[bad, 2]) & (share < rows_of[bad, 3])
            below = _stepped(patch, rows, at, lines[bad, 0] + middle[:, None] * way, closed)
            at, middle = np.where(straight[:, None], at, below), np.where(straight, share, middle)
            before, after = rows_of[bad].copy(), rows_of[bad].copy()
            before[:, 3], after[:, 2] = middle, middle
            rows_of = np.concatenate([rows_of[~bad], before, after])
            halves = np.stack([ends[bad, 0], at], axis=1), np.stack([at, ends[bad, 1]], axis=1)
            ends, lines = np.concatenate([ends[~bad], *halves]), np.concatenate([lines[~bad], lines[bad], lines[bad]])
        for axis in range(2):
            if closed[axis]:
                rows_of, ends = _cut_at_seam(rows_of, ends, axis, (patch.u, patch.v)[axis])
        found.append(np.column_stack([rows_of, np.full(len(ends), number), ends.reshape(-1, 4)]))
    return np.concatenate(found)


def _snap(feet: Floats, held: Bools, which: Ints, lines: list[list[float]]) -> None:
    """Put some u and v on the parameter line that they are nearest to, all on the same."""
    best = np.inf
    for axis, values in enumerate(lines):
        if values:
            away = np.abs(np.subtract.outer(feet[which, axis], values))
            far = np.median(away, axis=0)
            if far.min() < best:
                best, chosen = float(far.min()), (axis, values[int(far.argmin())])
    if best < _ON_LINE:
        # Where the surface closes, both ends of the range are meant.
        near = np.abs(feet[which, chosen[0]] - chosen[1]) < 0.5
        feet[which[near], chosen[0]] = chosen[1]
        held[which[near], chosen[0]] = True


def feet_in_planes(patch: shapes.Patch, feet: Floats, points: Floats, planes: Floats) -> Floats:
    """(n,2) u and v near given ones, where a surface is nearest to points (n,3) within the planes (p,4) these are in.

    Ends of dashes are on chords: what is nearest to them in space, or below them on the page, is beside the plane."""
    normals = planes[:, :3] / np.sqrt((planes[:, :3] ** 2).sum(axis=1))[:, None]
    offsets = planes[:, 3] / np.sqrt((planes[:, :3] ** 2).sum(axis=1))
    nearest = np.abs((points[:, None] * normals).sum(axis=2) - offsets).argmin(axis=1)
    feet = feet.copy()
    for number in np.unique(nearest).tolist():
        which, stretch = nearest == number, np.eye(4)
        # Ways across the plane count so many times.
        stretch[:3, :3] += (_ACROSS - 1.0) * np.multiply.outer(normals[number], normals[number])
        feet[which] = _stepped(patch, stretch, feet[which], points_on(stretch, points[which]), (False, False))
    return feet


_ACROSS = 30.0
"""Points of sections are so many times nearer to their planes than to points of chords."""

_ON_LINE = 1e-2
"""Vertices of parameter lines are no farther from these, in u and v."""

_BESIDE = 0.6
"""Curves are so far beside their chords at most, as a part of what is left open."""


def _poles(patch: shapes.Patch, axis: int) -> list[float]:
    """The ends of a parameter at which a surface is a point."""
    found = []
    for end in (0, -1):
        knots = [patch.u, patch.v]
        knots[axis] = np.full_like(knots[1 - axis], knots[axis][end])
        points = patch.points(*knots)
        if (np.ptp(points, axis=0) <= MEANT_AT_POLE * np.abs(points).max()).all():
            found.append(float(knots[axis][0]))
    return found


_HALVED = 10
"""Segments are halved so many times at most."""


def _cut_at_seam(rows: Floats, ends: Floats, axis: int, knots: Floats) -> tuple[Floats, Floats]:
    """Pieces within the range of a parameter that closes: cut where they leave it, and brought back."""
    low, high = float(knots[0]), float(knots[-1])
    for seam, step in ((low, high - low), (high, low - high)):
        over = np.sign(step) * (ends[:, :, axis] - seam) < 0.0
        both, one = over.all(axis=1), over.any(axis=1) & ~over.all(axis=1)
        ends[both, :, axis] += step
        share = ((seam - ends[one, 0, axis]) / (ends[one, 1, axis] - ends[one, 0, axis]))[:, None]
        at = ends[one, 0] + share * (ends[one, 1] - ends[one, 0])
        at[:, axis] = seam
        first, second = np.stack([ends[one, 0], at], axis=1), np.stack([at, ends[one, 1]], axis=1)
        starts = over[one, 0]
        first[starts, :, axis] += step
        second[~starts, :, axis] += step
        before, after = rows[one].copy(), rows[one].copy()
        before[:, 3] = after[:, 2] = rows[one, 2] + share[:, 0] * (rows[one, 3] - rows[one, 2])
        rows = np.concatenate([rows[~one], before, after])
        ends = np.concatenate([ends[~one], first, second])
    ends[:, :, axis] = np.clip(ends[:, :, axis], low, high)
    return rows, ends


def points_on(rows: Floats, points: Floats) -> Floats:
    """(n,3) the image of points."""
    return image.image_of(rows, points)[0]


def _closed(patch: shapes.Patch) -> tuple[bool, bool]:
    """Whether a net closes along u and along v."""
    (low, high), (front, back) = (
        (patch.points(patch.u[end] + 0.0 * patch.v, patch.v) for end in (0, -1)),
        (patch.points(patch.u, patch.v[end] + 0.0 * patch.u) for end in (0, -1)),
    )
    size = CERTIFIED_FORMULA * float(np.abs(low).max())
    return bool(np.abs(low - high).max() <= size), bool(np.abs(front - back).max() <= size)


def _feet(patch: shapes.Patch, points: Floats, rows: Floats) -> tuple[Floats, Floats]:
    """(n,2) u and v where a surface is nearest to points, and (n,) how far it is; from the nearest points of its net.

    Ends of dashes are on chords, and lie below the surface: what is in the same place on the page counts."""
    from scipy.spatial import cKDTree

    u, v = np.meshgrid(patch.u, patch.v, indexing="ij")
    _, nearest = cKDTree(patch.points(u, v).reshape(-1, 3)).query(points)
    place = np.stack([u.ravel()[nearest], v.ravel()[nearest]], axis=1)
    place = _stepped(patch, np.eye(4), place, points, (False, False))
    under = _stepped(patch, rows, place, points_on(rows, points)[:, :2], (False, False))
    off = np.linalg.norm(patch.points(*place.T) - points, axis=1)
    place = np.where((off > CERTIFIED_FORMULA * np.abs(points).max(initial=0.0) * 1e3)[:, None], under, place)
    return place, np.linalg.norm(patch.points(*place.T) - points, axis=1)


_STEPS = 6
"""Of Levenberg and Marquardt's method."""


def _stepped(
    patch: shapes.Patch, rows: Floats, place: Floats, target: Floats, closed: Any, held: Bools | bool = False
) -> Floats:
    """(n,2) u and v, near given ones, whose image is at places (n,2) on the page, or (n,3); beside contours near them;
    closed: in which of u and v it closes; held (n,2): those that remain."""
    size = target.shape[1]
    low, high = np.array([patch.u[0], patch.v[0]]), np.array([patch.u[-1], patch.v[-1]])
    low, high = np.where(closed, -np.inf, low), np.where(closed, np.inf, high)
    for _ in range(_STEPS):
        jets = patch.jets(rows, np.repeat(place, 2, axis=1))[:size]
        at = np.stack([np.broadcast_to(one.value.low, len(place)) for one in jets], axis=1)
        slope = np.stack([shapes.numbers(one.slopes, len(place)) for one in jets], axis=1)
        slope = np.where(np.broadcast_to(held, place.shape)[:, None], 0.0, slope)
        (a, b), c = (slope * slope).sum(axis=1).T, (slope[..., 0] * slope[..., 1]).sum(axis=1)
        damping = CERTIFIED_DAMPING * (a + b)
        a, b = a + damping, b + damping
        p, q = (slope * (target - at)[..., None]).sum(axis=1).T
        below = np.maximum(a * b - c * c, LEAST_DIVISOR)
        step = np.stack([b * p - c * q, a * q - c * p], axis=1) / below[:, None]
        # On a border only the way along it is free.
        stopped = (place + step < low) | (place + step > high)
        alone = np.stack([p / np.maximum(a, LEAST_DIVISOR), q / np.maximum(b, LEAST_DIVISOR)], axis=1)
        place = np.clip(place + np.where(stopped[:, ::-1], alone, step), low, high)
    return place


_AIM = 0.2
"""Nets and pieces are off their surfaces by this part of what is left open, if they can be made so fine."""

_FEW = 3
"""Parts into which the cells of coarse nets are divided at a time."""


def _refined(patch: shapes.Patch, rows: Floats, off: float) -> shapes.Patch:
    """The surface with a net that is off by no more; as fine as may be where that is not fine enough."""
    for _ in range(shapes.DEEPEST):
        shape = len(patch.u) - 1, len(patch.v) - 1
        along_u, mixed, along_v = shapes.deviations(patch, rows, patch.grid()).T.reshape(3, *shape)
        if not (along_u + mixed + along_v > off).any():
            break
        most = (along_u + 0.5 * mixed).max(axis=1), (along_v + 0.5 * mixed).max(axis=0)
        wanted = [np.ceil(np.sqrt(2.0 * one / off)).clip(1.0) for one in most]
        few = min(shape) < 4 * COARSEST or not wanted[0].sum() * wanted[1].sum() < shapes.MOST_CELLS
        # Bounds on coarse cells are too large.
        parts = [(np.minimum(one, _FEW) if few else one).astype(np.intp) for one in wanted]
        if int(parts[0].sum()) * int(parts[1].sum()) > shapes.MOST_CELLS:
            break
        lines = [_divided(knots, many) for knots, many in zip(patch[2:], parts, strict=True)]
        patch = patch._replace(u=lines[0], v=lines[1])
    return patch


def _divided(knots: Floats, parts: Ints) -> Floats:
    """Rising numbers, each interval (n,) divided into so many equal parts."""
    share = (np.arange(parts.sum()) - np.repeat(np.cumsum(parts) - parts, parts)) / np.repeat(parts, parts)
    return np.append(np.repeat(knots[:-1], parts) + share * np.repeat(np.diff(knots), parts), knots[-1])


def strokes_claimed(found: Any, content: dict[str, Any], shapes: drawn.Shapes) -> dict[str, Any]:
    """What a certificate says of the strokes of a drawing, both as in files: where they run on surfaces, which of them
    are clear, and what hides each of the others."""
    content = {**content, "on_surfaces": _on_surfaces(found["strokes"], content["items"], shapes)}
    model = drawn.model_of(found, content, shapes)
    dark = np.flatnonzero(model.hidden[model.strokes.owner])
    parts = _hidden(shapes, image.take(model.strokes, dark))
    return {
        "on_surfaces": content["on_surfaces"],
        "clear": np.flatnonzero(~model.hidden).tolist(),
        "hidden_strokes": _rows(drawn.places_of(model.strokes)[dark], parts),
    }


def _lines_claimed(shapes: drawn.Shapes) -> dict[str, Any]:
    """What hides each part of a line of meshes that is hidden."""
    lines = _hidden(shapes, image.take(shapes.sides, shapes.wanted))
    return {"hidden_lines": _rows(shapes.ends[shapes.wanted], lines)}


def _rows(names: Ints, parts: image.Parts) -> list[list[Any]]:
    """Parts of segments with names (n,2): two numbers, from where to where, and by which triangle each is hidden."""
    columns = zip(*names[parts.line].T.tolist(), *(column.tolist() for column in parts[1:]), strict=True)
    return [list(row) for row in columns]


def _hidden(shapes: drawn.Shapes, lines: image.Segments) -> image.Parts:
    """The parts of segments that triangles hide, by as few of these as possible, one after the other.

    Of all that begin before the part so far ends the one that ends last goes on (the greedy cover of an interval).
    """
    parts = image.joined(image.hidden_parts(lines, shapes.of, 0.0))
    if not len(parts.line):
        return parts
    parts = image.take(parts, np.lexsort((parts.low, parts.line)))
    shift = 4.0 * np.arange(len(lines.owner) + 1)
    key, last = parts.low + shift[parts.line], np.searchsorted(parts.line, np.arange(len(lines.owner)), side="right")
    best = _last_maximum(parts.high + shift[parts.line])
    line = np.unique(parts.line)
    reach = np.full(len(line), -1.0)
    found = []
    while len(line):
        at = np.searchsorted(key, reach + shift[line], side="right") - 1
        # Where nothing goes on, the next part begins.
        goes_on = (at >= 0) & (parts.line[at] == line)
        chosen = best[np.maximum(at, 0)]
        goes_on &= parts.high[chosen] > reach + ROUNDING
        chosen = np.where(goes_on, chosen, at + 1)
        kept = chosen < last[line]
        line, reach, chosen, goes_on = line[kept], reach[kept], chosen[kept], goes_on[kept]
        low = np.where(goes_on, np.maximum(reach, parts.low[chosen]), parts.low[chosen])
        found.append(image.Parts(line, low, parts.high[chosen], parts.by[chosen]))
        reach = np.maximum(reach, parts.high[chosen])
    return image.joined(found)


def _last_maximum(values: Floats) -> Ints:
    """(n,) where the largest of the values up to each stands."""
    running = np.maximum.accumulate(values)
    new = np.ones(len(values), dtype=np.bool_)
    new[1:] = running[1:] > running[:-1]
    return np.maximum.accumulate(np.where(new, np.arange(len(values)), 0))


def assert_certified(
    scene: object,
    drawing: Drawing,
    camera: Camera | str | None = None,
    *,
    page: Page | str | None = None,
    lines: str | Iterable[str] | None = None,
    crease_angle_deg: float = 25.0,
    style: Style | str | None = None,
    hidden: Literal["none", "dashed", "solid"] | None = None,
    size_mm: float = SIZE_MM,
    width_mm: float = CERTIFIED_MM,
    smooth_mm: float = SMOOTH_MM,
) -> dict[str, int]:
    """How much was compared, where a drawing is proved; otherwise an AssertionError that names what is wrong.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, or several of these
        What is drawn.
    drawing : Drawing
        What is checked.
    camera : Camera or str, optional
        As in `draw`.
    page : Page or str, optional
        As in `draw`; its margin counts, within which all lines are.
    lines : str or iterable of str, optional
        As in `draw`.
    crease_angle_deg : float
        As in `draw`.
    style : Style or str, optional
        As in `draw`.
    hidden : {"none", "dashed", "solid"}, optional
        As in `draw`; where neither this nor the style says it, hidden lines are dashed if there are any.
    size_mm : float
        In mm, see `certificate`.
    width_mm : float
        In mm, see `certificate`.
    smooth_mm : float
        In mm, see `certificate`.

    Returns
    -------
    dict
        The numbers of strokes, triangles, lines of meshes that have to be drawn or hidden, and named triangles.

    Raises
    ------
    AssertionError
        With what is wrong: places on the page, and how long the worst is; or with what cannot be proved.
    InputError
        See `certificate`.

    Notes
    -----
    Unlike `assert_drawing_is_right` it samples nothing: every stroke is compared with all triangles, and every contour,
    crease and border has to be there. A certificate is made of the scene, and checked by `check_certificate.py`, which
    knows nothing of this package.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, testing
    >>> cube = geometry.box((2, 2, 2))
    >>> testing.assert_certified(cube, vp.draw(cube, "iso", hidden="solid"), "iso", hidden="solid")["lines"]
    12
    """
    how = {"page": page, "lines": lines, "crease_angle_deg": crease_angle_deg, "style": style, "hidden": hidden}
    made = certificate(scene, drawing, camera, **how, size_mm=size_mm, width_mm=width_mm, smooth_mm=smooth_mm)  # type: ignore[arg-type]
    wrong, unproven, counts = checker.check(json.loads(json_bytes(drawing)), made.content)
    assert not wrong, "; ".join(wrong)
    assert not unproven, f"not proven: {'; '.join(unproven)}"
    return counts

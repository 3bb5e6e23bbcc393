"""Scenes in the colours of a map: bodies cut into bands, each of a colour."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.curves.curve import is_curve
from vectorplot.drawing.pens.pen_rules import PenRule
from vectorplot.effects.scales.colour_maps import map_colours
from vectorplot.effects.scales.value_refinement import linear_triangles, reached
from vectorplot.errors import InputError
from vectorplot.features.facet_demands import Within
from vectorplot.features.facets import Facets
from vectorplot.features.feature_lines.mesh_bending import mesh_bending, smooth_normals
from vectorplot.features.meshes.mesh_curves import face_triangles
from vectorplot.features.stacked_facets import facets_of_all
from vectorplot.geometry.budget import USUAL as USUAL_BUDGET
from vectorplot.geometry.cuts.level_bands import level_bands
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import TRIANGLE, Mesh
from vectorplot.geometry.repair.mesh_repair import welded
from vectorplot.geometry.vectors import norm
from vectorplot.io.expressions.expression import parse_expression
from vectorplot.scene.fields import Fields
from vectorplot.scene.item import Item
from vectorplot.scene.naming.scales import Colouring
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import NO_LINES, SurfaceLines
from vectorplot.scene.surface_normals import SurfaceNormals
from vectorplot.surfaces.surface import is_implicit, is_parametrised
from vectorplot.tolerances.of_extent import COLOURED_OF_EXTENT
from vectorplot.words import LineKind, unknown

LINE_MM = 0.25
"""The width of lines between bands."""

OWN_INK = (LineKind.SECTION, LineKind.INDEX, LineKind.ISOPHOTE)
"""Lines that run across bands, and have nothing of their colours."""

IN_COLOURS = tuple(kind.word for kind in LineKind if kind not in OWN_INK)
"""The kinds of lines that have the colours of bands."""

WORDS = ("x", "y", "z", "height", "slope", "curvature")
"""Numbers that every shape has at its points; all else is a formula."""


PART_OF_STEP = 0.25
"""Of the difference of two colours: how far numbers may be from linear in a triangle."""


@dataclass(frozen=True, eq=False)
class _Valued:
    """Triangles (t,3) of points (n,3), with a number (n,) at each; and the mesh of those without a number, if there are
    any. is_stepped: numbers are of faces, which share no points. normals: of the surface they stand for."""

    points: Floats
    values: Floats
    triangles: Ints
    without: Mesh | None = None
    is_stepped: bool = False
    normals: SurfaceNormals | None = None


@dataclass(frozen=True)
class ColourBar:
    """Which number is which colour: low and high, the numbers at both ends; colours: #rrggbb from low to high; title:
    what stands above; pens: of the lines between the bands, by the names of these; bands: the names of those of every
    item."""

    low: float
    high: float
    colours: tuple[str, ...]
    title: str
    pens: tuple[PenRule, ...]
    bands: tuple[tuple[str, tuple[str, ...]], ...]

    def with_pens(self, rules: Sequence[PenRule]) -> tuple[PenRule, ...]:
        """The pens of the bands, and after them rules for the scene before it was coloured: what is for an item is for
        all of its bands."""
        bands = dict(self.bands)
        names = [(rule.item,) if rule.item is None else bands.get(rule.item, (rule.item,)) for rule in rules]
        of_bands = [replace(rule, item=name) for rule, own in zip(rules, names, strict=True) for name in own]
        whole = [rule for rule in of_bands if rule.kind is None and rule.item is not None]
        # Pens of a kind would come before those of an item that name none.
        return (*self.pens, *(replace(rule, kind=kind) for rule in whole for kind in IN_COLOURS), *of_bands)


def coloured(scene: Scene, colouring: Colouring) -> tuple[Scene, ColourBar]:
    """The scene with a band of every body for each colour, and the bar that explains them.

    Smooth surfaces become triangles within COLOURED_OF_EXTENT of the extent of the scene; their parameter lines, paths
    and integral curves are left out. Triangles are divided until formulas and functions are linear in each within
    PART_OF_STEP of a colour, or there are too many. Cut faces keep their colour and their hatches.
    Errors: InputError for an unknown map or word, a formula that is none, a scene without bodies, numbers that are not
    finite anywhere.
    """
    colours = map_colours(colouring.colour_map, colouring.steps)
    size = float(norm(np.ptp(scene.bounds, axis=0)))
    field = isinstance(colouring.by, str) and any(_has_field(item, colouring.by) for item in scene.items)
    plain = (
        is_curve(item.shape) or item.is_cut_face or (field and not _has_field(item, str(colouring.by)))
        for item in scene.items
    )
    if not field:
        _check_word(colouring.by, scene)
    numbered = [k for k, left in enumerate(plain) if not left]
    smooth = _faceted(scene, numbered, COLOURED_OF_EXTENT * size)
    given: list[_Valued | None] = [None] * len(scene.items)
    for k in numbered:
        given[k] = _valued(scene.items[k], colouring, smooth.get(k), scene.exaggeration)
    values = np.concatenate([np.zeros(0), *(one.values for one in given if one is not None)])
    values = values[np.isfinite(values)]
    if not len(values):
        raise InputError(f"colouring by {colouring.title or 'a function'}: nothing in the scene has a finite number")
    low, high = float(values.min()), float(values.max())
    levels = np.linspace(low, high, len(colours) + 1)[1:-1] if high > low else np.zeros(0)
    items: list[Item] = []
    pens: list[PenRule] = []
    names = []
    for item, whole in zip(scene.items, given, strict=True):
        if whole is None:
            items.append(item)
            continue
        lines = _kept_lines(item.curves)
        own = []
        parts = level_bands(whole.points, whole.values, whole.triangles, levels)
        if whole.without is not None:
            bare = replace(item, name=f"{item.name} 0", shape=whole.without, patterns=(), curves=lines)
            items.append(replace(bare, group=item.group or item.name, fields=None))
            own.append(bare.name)
        for k in range(len(colours)):
            mesh = welded(parts.mesh(k))[0] if whole.is_stepped else parts.mesh(k)
            if mesh.face_count:
                name = f"{item.name} {k + 1}"
                group = item.group or item.name
                band = replace(item, name=name, shape=mesh, colour=colours[k], patterns=(), curves=lines, group=group)
                items.append(replace(band, fields=None, normals=whole.normals))
                own.append(name)
                pens.extend(PenRule(kind, name, colour=colours[k]) for kind in IN_COLOURS)
                pens.append(PenRule("boundary", name, width_mm=LINE_MM))
        names.append((item.name, tuple(own)))
    bar = ColourBar(low, high, tuple(colours), colouring.title, tuple(pens), tuple(names))
    return replace(scene, items=tuple(items), colouring=None), bar


def _kept_lines(lines: SurfaceLines) -> SurfaceLines:
    """Those lines that meshes have too."""
    if not lines:
        return NO_LINES
    return replace(lines, columns=0, rows=0, paths=(), integral=(), terrain=(), smooth_contours=False)


def _faceted(scene: Scene, numbers: Sequence[int], allowed: float) -> dict[int, Facets]:
    """The facets of those of some items that are smooth surfaces, off these by no more than is allowed."""
    smooth = [k for k in numbers if is_parametrised(scene.items[k].shape) or is_implicit(scene.items[k].shape)]
    within = Within(lambda points: np.full(points.shape[:-1], allowed))
    found = facets_of_all([scene.items[k].shape for k in smooth], lambda _: within, USUAL_BUDGET.facets)
    return dict(zip(smooth, found, strict=True))


def _valued(item: Item, colouring: Colouring, found: Facets | None, exaggeration: float) -> _Valued:
    """The triangles of an item and the numbers at their corners; what has none has the lowest there is. found: the
    facets of a smooth surface; exaggeration: what heights were multiplied with."""
    mesh, normals, of_surface = item.mesh, None, None
    if found is not None:
        mesh, normals = found.mesh, found.normals
        of_surface = SurfaceNormals(mesh, np.nan_to_num(normals), found.sharp)
    if not mesh.face_count:
        return _Valued(mesh.vertices, np.zeros(len(mesh.vertices)), np.zeros((0, TRIANGLE), dtype=np.intp))
    if isinstance(colouring.by, str) and _has_field(item, colouring.by):
        assert item.fields is not None
        return _of_field(item.fields, colouring.by, mesh)
    points, triangles = mesh.vertices, face_triangles(mesh).triangles
    try:
        if (numbers := _of_places(colouring.by)) is None:
            values = _of_shape(str(colouring.by), mesh, triangles, normals)
            values = values / exaggeration if colouring.by in ("z", "height") else values
        else:
            range_ = reached(points, triangles, numbers)
            points, triangles = linear_triangles(points, triangles, numbers, PART_OF_STEP * range_ / colouring.steps)
            values = numbers(points)
    except InputError as error:
        raise InputError(f"{item.name}: {error.cause}") from None
    known = np.isfinite(values)
    least = float(values[known].min()) if known.any() else np.nan
    return _Valued(points, np.where(known, values, least), triangles, normals=of_surface)


def _has_field(item: Item, name: str) -> bool:
    return item.fields is not None and name in item.fields.names


def _check_word(by: object, scene: Scene) -> None:
    """An InputError, which names the fields of the scene, for a word that is none of them and no formula."""
    names = dict.fromkeys(name for item in scene.items if item.fields is not None for name in item.fields.names)
    if not isinstance(by, str) or by in WORDS or not names:
        return
    try:
        parse_expression(by, ("x", "y", "z"))
    except InputError:
        raise unknown("colouring by", by, [*WORDS, *names], "or a formula") from None


def _of_field(fields: Fields, name: str, mesh: Mesh) -> _Valued:
    """The triangles of a mesh with the numbers of a field, and those that have none."""
    points, triangles = mesh.vertices, face_triangles(mesh).triangles
    stepped = fields.is_on_faces(name)
    if stepped:
        middles = points[triangles].mean(axis=1)
        values = np.repeat(fields.at(name, middles), TRIANGLE)
        points, triangles = points[triangles].reshape(-1, 3), np.arange(len(values)).reshape(-1, TRIANGLE)
    else:
        values = fields.at(name, points)
    known = np.isfinite(values)
    told = known[triangles].all(axis=1)
    without = None if told.all() else welded(Mesh.from_triangles(points, triangles[~told]))[0]
    least = float(values[known].min()) if known.any() else np.nan
    return _Valued(points, np.where(known, values, least), triangles[told], without, stepped)


def _of_shape(by: str, mesh: Mesh, triangles: Ints, normals: Floats | None) -> Floats:
    """(v,) the numbers of WORDS at the vertices of a mesh; normals (v,3): of the surface it stands for, if they are
    known."""
    points = mesh.vertices
    if by == "slope":
        x, y, z = (smooth_normals(points, triangles) if normals is None else normals).T
        return np.asarray(np.degrees(arctan2(np.hypot(x, y), np.abs(z))))
    if by == "curvature":
        second = mesh_bending(face_triangles(mesh)).second
        return np.asarray(-0.5 * (second[:, 0] + second[:, 2]))
    return np.asarray(points[:, 2 if by == "height" else "xyz".index(by)])


def _of_places(by: str | Callable[[Floats], Floats]) -> Callable[[Floats], Floats] | None:
    """The numbers (n,) at points (n,3) that a formula or a function says; None for WORDS."""
    if by in WORDS:
        return None
    if isinstance(by, str):
        try:
            formula = parse_expression(by, ("x", "y", "z"))
        except InputError as error:
            raise InputError(f"colouring by {by!r}: expected {', '.join(WORDS)} or a formula; {error.cause}") from None

        def of_formula(points: Floats) -> Floats:
            with np.errstate(all="ignore"):
                found = np.asarray(formula(x=points[:, 0], y=points[:, 1], z=points[:, 2]), dtype=np.float64)
            return np.asarray(np.broadcast_to(found, (len(points),)))

        return of_formula
    function = by

    def of_function(points: Floats) -> Floats:
        values = np.asarray(function(points), dtype=np.float64)
        if values.shape != (len(points),):
            raise InputError(f"colouring: the function gives numbers of shape {values.shape} for {len(points)} points")
        return values

    return of_function

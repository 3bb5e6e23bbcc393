"""One item of a scene file: its draft, where it stands, the modifiers that change it, and how its faces are hatched."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Collection, Mapping, Sequence
from copy import copy
from dataclasses import dataclass, fields
from types import MappingProxyType
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.algebra import determinant, matmul
from vectorplot.geometry.convex_bodies import polyhedron_intersection
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.solids import (
    BOTH_CAPS,
    BOTTOM,
    FULL_TURN,
    IDENTITY,
    NOT_PLANAR,
    TOP,
    area_vector,
    box,
    check_hole_count,
    has_convex_outline,
    is_planar,
    placed,
    regular_polygon,
    revolution,
    swept_polygon,
    turned_outwards,
)
from vectorplot.geometry.winding import edge_uses, mesh_edges
from vectorplot.io.scene_words import Words
from vectorplot.io.surface_line_words import CurveDraft
from vectorplot.scene.colour_scales import Fields
from vectorplot.scene.face_looks import FaceLook, FaceLooks
from vectorplot.scene.hatching import HATCHED_ALONG, HATCHED_BY, Hatching
from vectorplot.scene.item import Item, Pattern
from vectorplot.scene.material import Material
from vectorplot.scene.surface_lines import NO_LINES, SurfaceLines
from vectorplot.surfaces.surface import ImplicitSurface, Surface, is_parametrised
from vectorplot.tolerances import LARGEST

# Where items of scene files stand: placements, and the modifiers that change them.

Placement = tuple[float, ...]
"""The first three rows of a matrix (4,4), row by row."""

_QUARTERS = ((1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0))


def moved(placement: Placement, x: float, y: float, z: float) -> Placement:
    """A placement followed by a translation."""
    a, b, c, t, d, e, f, u, g, h, i, v = placement
    return (a, b, c, t + x, d, e, f, u + y, g, h, i, v + z)


def scaled(placement: Placement, x: float, y: float, z: float) -> Placement:
    """A placement followed by stretching along the axes."""
    a, b, c, t, d, e, f, u, g, h, i, v = placement
    return (x * a, x * b, x * c, x * t, y * d, y * e, y * f, y * u, z * g, z * h, z * i, z * v)


def affinely_mapped(placement: Placement, rows: Placement) -> Placement:
    """A placement followed by an affine map: the first three rows of its matrix (4,4)."""
    if placement == IDENTITY:
        return rows
    below = (0.0, 0.0, 0.0, 1.0)
    after, before = (np.array([*one, *below]).reshape(4, 4) for one in (rows, placement))
    return tuple((matmul(after, before))[:3].ravel().tolist())


def turned(placement: Placement, axis: str, angle_deg: float) -> Placement:
    """A placement followed by a rotation about an axis through the origin, counter-clockwise seen from its tip.

    Quarter turns are exact. Source: Glaeser, section 1.6, equations 27 to 29.
    """
    quarters = angle_deg / 90.0
    if quarters == int(quarters):
        cos, sin = _QUARTERS[int(quarters) % 4]
    else:
        cos, sin = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
    # Row by row and written out: thousands of items are turned.
    a, b, c, t, d, e, f, u, g, h, i, v = placement
    if axis == "x":
        second = (cos * d - sin * g, cos * e - sin * h, cos * f - sin * i, cos * u - sin * v)
        return (a, b, c, t, *second, sin * d + cos * g, sin * e + cos * h, sin * f + cos * i, sin * u + cos * v)
    if axis == "y":
        third = (cos * g - sin * a, cos * h - sin * b, cos * i - sin * c, cos * v - sin * t)
        return (sin * g + cos * a, sin * h + cos * b, sin * i + cos * c, sin * v + cos * t, d, e, f, u, *third)
    first = (cos * a - sin * d, cos * b - sin * e, cos * c - sin * f, cos * t - sin * u)
    return (*first, sin * a + cos * d, sin * b + cos * e, sin * c + cos * f, sin * t + cos * u, g, h, i, v)


def read_rotation(words: Words, at: int, owner: str, placement: Placement) -> tuple[Placement, int]:
    """An axis and an angle."""
    axis = words.words[at + 1]
    if axis not in ("x", "y", "z"):
        words.fail(at + 1, f"{owner}expected an axis x, y or z after 'rotation', got {words.shown(at + 1)}")
    angle = words.number(at + 2, owner, "the angle of a rotation")
    return turned(placement, axis, angle), at + 3


def read_scale(words: Words, at: int, owner: str, placement: Placement) -> tuple[Placement, int]:
    """One factor, or three along the axes; a negative one mirrors."""
    count = 3 if words.is_number(at + 2) or words.words[at + 2] == "," else 1
    factors, end = words.numbers(at + 1, count, owner, "a factor of scale")
    if not all(factors):
        words.fail(at, f"{owner}scale: a factor of 0")
    x, y, z = factors * (3 // count)
    return _finite(words, at, owner, scaled(placement, x, y, z)), end


def read_matrix(words: Words, at: int, owner: str, placement: Placement) -> tuple[Placement, int]:
    """The twelve numbers of an affine map."""
    rows, end = words.numbers(at + 1, 12, owner, "matrix")
    with np.errstate(divide="ignore"):
        volume = determinant(np.array(rows).reshape(3, 4)[:, :3])
    if not volume:
        words.fail(at, f"{owner}matrix: its determinant is 0")
    return _finite(words, at, owner, affinely_mapped(placement, tuple(rows))), end


def _finite(words: Words, at: int, owner: str, placement: Placement) -> Placement:
    if not all(abs(number) <= LARGEST for number in placement):
        words.fail(at, f"{owner}'{words.words[at]}' goes beyond the range of numbers")
    return placement


# One item of a scene file: what the file says about it, gathered word by word, and the item made of it.

_NORMAL = Material()

BORE_ORDER = 48
"""How many sides a bore has."""

NEEDED = {
    "vertices": ("vertices", "faces"),
    "revolution": ("meridian", "order"),
    "translation": ("base_points", "trans_vector"),
    "box": ("lengths",),
    "intersection": ("parts",),
    "surface": ("surface",),
    "curve": ("curve",),
    "mesh": ("mesh",),
    "terrain": ("terrain",),
}
"""What every kind of item cannot be without."""


@dataclass(frozen=True)
class Subdivision:
    """Of a polyhedron, as `subdivided_item` takes it; creases: by the vertices at their ends, from 0."""

    scheme: str = "catmull-clark"
    creases: tuple[tuple[int, int], ...] = ()
    crease_angle_deg: float | None = None


class Draft:
    """What has been read about an item so far. Attributes of the class are what holds where the file is silent.

    index, kind_index: the words that name it and its kind; owner: how messages about it begin.
    """

    colour: str | None = None
    material: str | None = None
    finish: Mapping[str, float] = MappingProxyType({})
    opacity: float | None = None
    refraction = 1.0
    form: str | None = None
    kind: str | None = None
    kind_index = 0
    hollow = False
    solid = False
    shown_caps: frozenset[str] = frozenset()
    angle_deg = FULL_TURN
    lengths: tuple[float, ...] | list[float] | None = None
    order: int | None = None
    meridian: list[list[float]] | None = None
    base_points: list[list[float]] | None = None
    trans_vector: list[float] | None = None
    cutouts: tuple[list[list[float]], ...] = ()
    bores: tuple[tuple[float, ...], ...] = ()
    vertices: list[list[float]] | None = None
    faces: list[list[int]] | None = None
    edges: list[list[int]] | None = None
    parts: tuple[str, ...] | None = None
    removed: list[int] | None = None
    lines: tuple[str, ...] | None = None
    occludes: bool | None = None
    group: str | None = None
    hatch: Hatching | None = None
    subdivision: Subdivision | None = None
    mesh: Mesh | None = None
    fields: Fields | None = None
    mesh_looks: FaceLooks | None = None
    surface: Surface | ImplicitSurface | None = None
    curve: Curve | None = None
    terrain: tuple[Mesh, float] | None = None
    curves = CurveDraft()
    trims: tuple[Any, ...] = ()
    trim_holes: tuple[Any, ...] = ()
    trim_index: int = 0

    def __init__(self, name: str, index: int) -> None:
        self.name = name
        self.index = index
        self.owner = name + ": "
        self.patterns: list[Pattern] = []
        self.looks: dict[int, FaceLook] = {}
        self.places: list[Placement] = [IDENTITY]

    def at(self, number: int) -> Draft:
        """The draft of one of the copies of the item, in its place."""
        if len(self.places) == 1:
            return self
        one = copy(self)
        one.places = [self.places[number]]
        one.name = self.name if number == 0 else f"{self.name} {number + 1}"
        return one

    @property
    def placement(self) -> Placement:
        """Where the first one stands."""
        return self.places[0]

    def missing(self) -> str | None:
        """The first word that the item still needs, or None."""
        if self.kind is None:
            return "vertices"
        return next((word for word in NEEDED[self.kind] if getattr(self, word) is None), None)

    @property
    def caps(self) -> Collection[str]:
        """Which ends of a swept body are there."""
        return self.shown_caps if self.hollow else BOTH_CAPS


def finished(draft: Draft, words: Words, parts: Sequence[Mesh]) -> Item:
    """The item that a complete draft describes; parts: the shapes that an intersection is made of.

    Errors: InputError with file, line and the item's name for anything that makes no shape.
    """
    shape: Mesh | Surface | ImplicitSurface | Curve
    curves, looks = NO_LINES, None
    try:
        if draft.surface is not None:
            shape, curves = _surface(draft, draft.surface)
        elif draft.curve is not None:
            shape = _space_curve(draft, words, draft.curve)
        else:
            shape = _polyhedron(draft, words, parts)
            if draft.curves:
                from vectorplot.io.scene_surfaces import curves_of

                times = None if draft.terrain is None else draft.terrain[1]
                curves = curves_of(draft.curves, shape, shape.bounds, times)
            looks = _face_looks(draft, shape)
    except InputError as error:
        if error.file is not None:
            raise
        words.fail(draft.kind_index, draft.owner + error.cause)
    drawn, added = _listed_edges(draft, shape)
    item = Item(
        draft.name,
        shape,
        "gray" if draft.colour is None else draft.colour,
        material_of(draft),
        tuple(draft.patterns),
        draft.lines,
        draft.occludes,
        curves,
        draft.group or "",
        draft.hatch,
        (words.name, words.line(draft.index)),
        fields=None if draft.fields is None else draft.fields.transformed(_matrix(draft.placement)),
        drawn_edges=drawn,
        added_edges=added,
        face_looks=looks,
    )
    return item if draft.subdivision is None else _subdivided(item, draft, draft.subdivision, words)


def _subdivided(item: Item, draft: Draft, how: Subdivision, words: Words) -> Item:
    # Few items are cages: what subdivides them is loaded for them.
    from vectorplot.scene.subdivided import subdivided_item

    try:
        return subdivided_item(item, how.scheme, creases=how.creases, crease_angle_deg=how.crease_angle_deg)
    except InputError as error:
        words.fail(draft.kind_index, error.cause)


def _face_looks(draft: Draft, shape: Mesh) -> FaceLooks | None:
    """The looks of faces that the file of a mesh gives, and over them those of the scene."""
    given, own = draft.mesh_looks, FaceLooks.of(shape, draft.looks) if draft.looks else None
    if given is None:
        return own
    if own is None:
        return FaceLooks(shape, given.looks, given.of_face)
    of_face = np.where(own.of_face >= 0, own.of_face + len(given.looks), given.of_face)
    return FaceLooks(shape, (*given.looks, *own.looks), of_face)


def _listed_edges(draft: Draft, shape: object) -> tuple[Floats | None, Floats | None]:
    """(e,2,3) the ends of the listed edges that are sides of faces, and of those that are not; None where all edges are
    drawn, and where there are none of the others."""
    if draft.edges is None or not isinstance(shape, Mesh):
        return None, None
    listed = np.array(draft.edges, dtype=np.intp).reshape(-1, 2) - 1
    count = len(shape.vertices)
    low, high = np.sort(listed, axis=1).T
    least, most = mesh_edges(shape).T
    known = np.isin(low * count + high, least * count + most)
    ends = shape.vertices[listed]
    return ends[known], None if known.all() else ends[~known]


def _matrix(placement: Sequence[float]) -> Floats:
    """(4,4) acting on columns, of the twelve numbers of a placement."""
    return np.vstack([np.array(placement).reshape(3, 4), np.eye(4)[3]])


def _surface(draft: Draft, surface: Surface | ImplicitSurface) -> tuple[Surface | ImplicitSurface, SurfaceLines]:
    from vectorplot.io.scene_surfaces import checked_bounds, curves_of, placed_surface

    _check_faceless(draft, "surface")
    for word, given in (
        ("smooth_lines", draft.curves.lines.smooth),
        ("isophote_edges", draft.curves.lines.along_edges),
        ("smooth_contours", draft.curves.lines.smooth_contours),
        ("contours", draft.curves.lines.contours),
    ):
        if given:
            raise InputError(f"'{word}' is for polyhedra only")
    if draft.trim_index:
        if not is_parametrised(surface):
            raise InputError("'trim' is for surfaces with parameters u and v only")
        from vectorplot.surfaces.trimmed import TrimmedSurface

        surface = TrimmedSurface(surface, trims=draft.trims, holes=draft.trim_holes)
    shape = placed_surface(surface, draft.placement)
    if draft.curves.lines.paths and not is_parametrised(shape):
        raise InputError("'surface_curve' is for surfaces with parameters u and v only")
    if draft.curves.lines.terrain:
        raise InputError("'water', 'watersheds', 'valley_lines', 'road' and 'serpentine' are for terrains only")
    if draft.curves.lines.integral and not is_parametrised(shape):
        raise InputError("integral curves are for polyhedra and surfaces with parameters u and v only")
    return shape, curves_of(draft.curves, shape, checked_bounds(shape))


def _space_curve(draft: Draft, words: Words, curve: Curve) -> Curve:
    from vectorplot.io.scene_surfaces import placed_curve

    _check_faceless(draft, "curve")
    _check_untrimmed(draft, words)
    _check_lineless(draft, words)
    return placed_curve(curve, draft.placement)


def _check_faceless(draft: Draft, what: str) -> None:
    if draft.removed is not None or draft.patterns or draft.looks:
        raise InputError(f"a {what} has no faces for 'removed_faces', 'face_looks' and 'patterns'")


def _check_lineless(draft: Draft, words: Words) -> None:
    if draft.curves:
        words.fail(draft.curves.index, f"{draft.owner}'{words.words[draft.curves.index]}' is for surfaces only")


def _check_untrimmed(draft: Draft, words: Words) -> None:
    if draft.trim_index:
        words.fail(draft.trim_index, f"{draft.owner}'{words.words[draft.trim_index]}' is for surfaces only")


def _check_unparametrised(draft: Draft, words: Words) -> None:
    if draft.curves.lines.columns or draft.curves.lines.rows:
        words.fail(draft.curves.index, f"{draft.owner}'parameter_lines' is for surfaces only")
    if draft.curves.lines.paths:
        words.fail(draft.curves.index, f"{draft.owner}'surface_curve' is for surfaces only")


def _polyhedron(draft: Draft, words: Words, parts: Sequence[Mesh]) -> Mesh:
    _check_untrimmed(draft, words)
    _check_unparametrised(draft, words)
    mesh = _SHAPES[draft.kind or ""](draft, words, parts)
    if draft.removed is not None:
        mesh = _without_faces(mesh, draft.removed)
    if draft.patterns:
        _check_patterns(draft.patterns, mesh)
    return mesh


def material_of(draft: Draft) -> Material:
    """The material that the words of a draft describe."""
    if draft.material is None and draft.opacity is None and draft.refraction == 1.0:
        return _NORMAL
    return Material(draft.material or "normal", draft.opacity, draft.refraction, **draft.finish)


def _box(draft: Draft, words: Words, parts: Sequence[Mesh]) -> Mesh:
    if min(draft.lengths or (0.0,)) < 0.0:
        said = " ".join(f"{length:g}" for length in draft.lengths or ())
        back = " ".join(f"{min(length, 0.0):g}" for length in draft.lengths or ())
        raise InputError(f"box {said}: lengths are positive; 'translation {back}' moves the box")
    return box(draft.lengths or (), caps=draft.caps, placement=draft.placement)


def _revolution(draft: Draft, words: Words, parts: Sequence[Mesh]) -> Mesh:
    meridian = np.array(draft.meridian).T
    body = revolution(meridian, draft.order or 0, angle_deg=draft.angle_deg, caps=draft.caps)
    return placed(body, draft.placement)


def _translation(draft: Draft, words: Words, parts: Sequence[Mesh]) -> Mesh:
    base = np.array(draft.base_points).T
    body = swept_polygon(base, np.array(draft.trans_vector), caps=draft.caps, holes=_holes(draft, base))
    if not is_planar(base):
        _warn(draft, words, NOT_PLANAR)
    return placed(body, draft.placement)


def _holes(draft: Draft, base: Floats) -> list[Floats]:
    """(h,3) the corners of each hole through a prism over a base, in its plane."""
    normal = area_vector(base)
    if not normal.any():
        return []
    check_hole_count(len(draft.bores) + len(draft.cutouts))
    for *_, radius in draft.bores:
        if not radius > 0.0:
            raise InputError(f"a bore of radius {radius:g}: expected more than 0")
    round_ones = [regular_polygon(BORE_ORDER, r, centre=(x, y, z), normal=normal) for x, y, z, r in draft.bores]
    return [*(np.array(cutout).T for cutout in draft.cutouts), *round_ones]


def _intersection(draft: Draft, words: Words, parts: Sequence[Mesh]) -> Mesh:
    body = parts[0]
    for part in parts[1:]:
        body = polyhedron_intersection(body, part)
    if not body.face_count:
        raise InputError(f"{' and '.join(draft.parts or ())} have no volume in common")
    return placed(body, draft.placement)


def _from_file(draft: Draft, words: Words, parts: Sequence[Mesh]) -> Mesh:
    assert draft.mesh is not None
    _check_solid(draft, words, draft.mesh)
    return placed(draft.mesh, draft.placement)


def _general(draft: Draft, words: Words, parts: Sequence[Mesh]) -> Mesh:
    """A polyhedron from its lists; turned outwards where it is convex and not called general."""
    vertices = np.array(draft.vertices, dtype=np.float64).reshape(3, -1).T
    for what, groups in (("face", draft.faces), ("edge", draft.edges)):
        for number, group in enumerate(groups or (), 1):
            if min(group) < 1 or max(group) > len(vertices):
                bad = next(v for v in group if not 1 <= v <= len(vertices))
                raise InputError(f"{what} {number} names vertex {bad}, there are {len(vertices)}, counted from 1")
    mesh = Mesh.from_polygons(vertices, [[vertex - 1 for vertex in face] for face in draft.faces or ()])
    if draft.edges is not None:
        _check_edges(draft.edges)
    _check_solid(draft, words, mesh)
    if draft.form not in ("general", "concave"):
        outwards = turned_outwards(mesh)
        if has_convex_outline(outwards):
            mesh = outwards
        elif draft.form == "convex":
            _warn(draft, words, "is not convex; its faces are taken as they are listed")
    return placed(mesh, draft.placement)


def _check_solid(draft: Draft, words: Words, mesh: Mesh) -> None:
    """An InputWarning for what is called solid and has open edges."""
    if draft.solid and (open_edges := int((edge_uses(mesh).count == 1).sum())):
        several = "edge has" if open_edges == 1 else "edges have"
        _warn(draft, words, f"is no solid: {open_edges} {several} a face on one side only; it is taken as it is, open")


def _warn(draft: Draft, words: Words, cause: str) -> None:
    line = words.line(draft.index)
    warnings.warn(f"{words.name}:{line}: {draft.owner}{cause}", InputWarning, stacklevel=3)


def _check_edges(edges: list[list[int]]) -> None:
    """Every listed edge must join two vertices."""
    for number, edge in enumerate(edges, 1):
        if len(edge) != 2 or edge[0] == edge[1]:
            raise InputError(f"edge {number}: expected two different vertices")


def _without_faces(mesh: Mesh, removed: list[int]) -> Mesh:
    present = np.ones(mesh.face_count, dtype=np.bool_) if mesh.present is None else mesh.present.copy()
    for number in removed:
        if not 1 <= number <= mesh.face_count:
            raise InputError(f"removed_faces: there is no face {number}, faces run from 1 to {mesh.face_count}")
        present[number - 1] = False
    return Mesh(mesh.vertices, mesh.corners, mesh.offsets, present)


def _check_patterns(patterns: Sequence[Pattern], mesh: Mesh) -> None:
    for pattern in patterns:
        if not 0 <= pattern.face < mesh.face_count:
            cause = f"there is no face {pattern.face + 1}, faces run from 1 to {mesh.face_count}"
            raise InputError(f"patterns, polygon {pattern.name}: {cause}")


def _terrain(draft: Draft, words: Words, parts: Sequence[Mesh]) -> Mesh:
    assert draft.terrain is not None
    return placed(draft.terrain[0], draft.placement)


_SHAPES: dict[str, Callable[[Draft, Words, Sequence[Mesh]], Mesh]] = {
    "box": _box,
    "revolution": _revolution,
    "translation": _translation,
    "vertices": _general,
    "intersection": _intersection,
    "mesh": _from_file,
    "terrain": _terrain,
}

CAP_WORDS = {"+bottom": BOTTOM, "+top": TOP}


# How the faces of an item are hatched, as scene files say it.

_NUMBERS = {"spacing": "spacing_mm", "angle": "angle_deg", "width": "width_mm"}
"""Words before a number, and the fields that it fills."""


def read_hatch(words: Words, at: int, owner: str) -> tuple[Hatching, int]:
    """The hatching that a word from HATCHED_BY, and what follows it, asks for; and the word behind.

    Errors: InputError with file and line for another word, a number that is out of range, a word that comes twice.
    """
    start, by = at, words.words[at]
    if by not in HATCHED_BY:
        words.fail(at, f"{owner}hatch: expected one of {', '.join(HATCHED_BY)}, got {words.shown(at)}")
    given: dict[str, Any] = {"by": by}
    at += 1
    while by != "none" and (word := words.words[at]) in (*_NUMBERS, "cross", "along"):
        field = _NUMBERS.get(word, word)
        if field in given:
            words.fail(at, f"{owner}hatch: '{word}' comes twice")
        at += 1
        if word in _NUMBERS:
            given[field] = words.number(at, owner, word)
            at += 1
        elif word == "along":
            given[field] = words.words[at]
            if given[field] not in HATCHED_ALONG:
                cause = f"hatch along: expected one of {', '.join(HATCHED_ALONG)}, got {words.shown(at)}"
                words.fail(at, owner + cause)
            at += 1
        else:
            given[field] = True
    try:
        return Hatching(**given), at
    except InputError as error:
        words.fail(start, owner + error.cause)


def hatch_text(hatching: Hatching) -> str:
    """The words for a hatching: what is not as usual."""
    usual = Hatching(hatching.by)
    own = {field.name: getattr(hatching, field.name) for field in fields(Hatching)}
    said = [f"{word} {own[field]!r}" for word, field in _NUMBERS.items() if own[field] != getattr(usual, field)]
    if hatching.cross:
        said.append("cross")
    if hatching.along != usual.along:
        said.append(f"along {hatching.along}")
    return " ".join(["hatch", hatching.by, *said])

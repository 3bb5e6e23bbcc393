"""The curves in which smooth surfaces meet themselves, each other and polyhedra, and which come near each other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.conditions import ImplicitSection
from vectorplot.features.contours_and_isophotes import section_by_implicit
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.holes import near_to
from vectorplot.features.implicit_curves import implicit_intersection
from vectorplot.features.intersection_tracing import DoubleCurves
from vectorplot.features.intersections import (
    implicit_mesh_section,
    intersections_of_grids,
    mesh_section,
    self_intersections,
)
from vectorplot.features.patches import SurfaceGrids
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.boxes import SlabHulls
from vectorplot.geometry.chord_refinement import bisected
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import closed_round
from vectorplot.geometry.vectors import all_finite
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.surfaces.parameter_regions import ParameterRegions
from vectorplot.surfaces.trimmed import is_embedded
from vectorplot.tolerances import OUTSIDE_DOMAIN
from vectorplot.visibility.polyhedra.lines import kept_apart
from vectorplot.visibility.smooth import sight_lines
from vectorplot.visibility.smooth.curve_families import (
    Along,
    ConditionCurves,
    FaceCurves,
    ImplicitFaceCurves,
    SheetsMeet,
    SpatialCurves,
)
from vectorplot.visibility.smooth.events import Roots, roots_along
from vectorplot.visibility.smooth.implicit_items import as_spatial_curves, tracing_in_world
from vectorplot.visibility.smooth.sheets import ImplicitSheet, ParametricSheet
from vectorplot.visibility.smooth.traced_curves import Curves, as_curves, no_curves, together
from vectorplot.words import LineKind

# The curves in which implicit surfaces meet parametrised ones, each other and polyhedra.

Doubts = tuple[str, ...]


def parametrised_with_implicit(
    one: ParametricSheet, first: int, two: ImplicitSheet, second: int, item: int, tracing: Tracing
) -> tuple[Curves, Doubts]:
    """The curves in which two sheets of these numbers meet, within the box of the implicit one; and doubts."""
    found = section_by_implicit(one.surface, two.surface, tracing=tracing)
    family = ConditionCurves(one.whole, first, ImplicitSection(one.whole.surface, two.surface), second)
    curves = as_curves(found, LineKind.INTERSECTION, item, family)
    return within_box(replace(curves, second_places=curves.points), two), found.doubts


def implicit_with_implicit(
    one: ImplicitSheet, first: int, two: ImplicitSheet, second: int, item: int, tracing: Tracing
) -> tuple[Curves, Doubts]:
    """The curves in which two sheets of these numbers meet, within both boxes; and doubts."""
    found = implicit_intersection(one.home, two.home, tracing=tracing_in_world(one, tracing))
    family = SpatialCurves(one, first, two.surface, second)
    curves = as_spatial_curves(found, LineKind.INTERSECTION, one, family)
    whole = replace(curves, item=np.full(len(curves), item), second_places=curves.points)
    return within_box(whole, two), found.doubts


def implicit_with_mesh(
    sheet: ImplicitSheet, number: int, mesh: Mesh, item: int, tracing: Tracing
) -> tuple[Curves, Doubts]:
    """The curves in which a sheet meets the faces of a mesh in the view's coordinates; and doubts."""
    view, world = sheet.view, tracing_in_world(sheet, tracing)
    placed = Mesh(view.world_of(mesh.vertices.T), mesh.corners, mesh.offsets, mesh.present)
    section = implicit_mesh_section(sheet.home, placed, tracing=world)
    family, normals = ImplicitFaceCurves(sheet, number), matmul(section.normals, view.axes.T)
    curves = as_spatial_curves(section.curves, LineKind.INTERSECTION, sheet, family, normals)
    return replace(curves, item=np.full(len(curves), item)), section.curves.doubts


def within_box(curves: Curves, sheet: ImplicitSheet) -> Curves:
    """The parts of curves inside the box of an implicit surface that they lie on; they end on its sides exactly."""

    def depths(_: Ints, at: Along) -> Floats:
        return sheet.depths_in_box(at.points)

    values = sheet.depths_in_box(curves.points)
    # What lies in a side of the box is inside.
    values = np.where(np.abs(values) <= OUTSIDE_DOMAIN, 0.0, values)
    if not len(curves) or (values >= 0.0).all():
        return curves
    roots = roots_along(curves, depths, values)
    at = curves.at(roots.chord, roots.part)
    second = np.where(np.isfinite(curves.second_places[roots.chord]), at.points, np.nan)
    return _divided(curves, values >= 0.0, roots, replace(at, second_places=second))


def beyond_near_plane(view: View, curves: Curves) -> Curves:
    """The parts of curves that are farther from the eye than the near plane: what is behind the eye hides nothing, and
    no sight line leads there."""
    depth = sight_lines.depth(view, curves.points) - view.near
    if not len(curves) or (depth > 0.0).all():
        return curves
    roots = roots_along(curves, lambda _, at: sight_lines.depth(view, at.points) - view.near, depth)
    return _divided(curves, depth > 0.0, roots, curves.at(roots.chord, roots.part))


LOOKS = 8
"""Places of a chord at which is looked whether it is within trims."""

HALVINGS = 52
"""Of the way from one of them to the next: it comes down to rounding."""


def within_trims(curves: Curves, sheets: Mapping[int, SmoothSheet]) -> Curves:
    """The parts of curves within the trims of the sheets, by their numbers, that they lie on; they end on these."""
    trims = {k: s.trims for k, s in sheets.items() if isinstance(s, ParametricSheet) and s.trims is not None}
    if not len(curves) or not trims:
        return curves
    regions = ParameterRegions.together(list(trims.values()))
    region = np.full(max(trims) + 2, -1)
    region[list(trims)] = np.arange(len(trims))

    def inside(chord: Ints, at: Along) -> Bools:
        found = np.ones(len(chord), dtype=np.bool_)
        for numbers, places in ((curves.sheet, at.places), (curves.second_sheet, at.second_places)):
            of = numbers[curves.owner[chord]]
            of = region[np.where(of < len(region) - 1, of, -1)]
            own = np.flatnonzero(of >= 0)
            found[own] &= regions.contains(places[own, 0], places[own, 1], of[own])
        return found

    every, chord = np.arange(len(curves.points)), curves.chords
    at_points = inside(every, Along(curves.places, curves.points, curves.points, curves.second_places))
    part = np.arange(1, LOOKS)[:, None] / LOOKS
    there = np.empty((LOOKS + 1, len(chord)), dtype=np.bool_)
    there[0], there[-1] = at_points[chord], at_points[chord + 1]
    looks = np.tile(chord, LOOKS - 1), np.broadcast_to(part, (LOOKS - 1, len(chord))).ravel()
    there[1:-1] = inside(looks[0], curves.at(*looks)).reshape(LOOKS - 1, -1)
    if there.all():
        return curves
    look, own = np.nonzero(there[1:] != there[:-1])
    was, from_, low = there[look, own], chord[own], look / LOOKS

    def goes_on(which: Ints, part: Floats) -> Bools:
        return np.asarray(inside(from_[which], curves.at(from_[which], part)) == was[which])

    before, after = bisected(goes_on, low, low + 1.0 / LOOKS, HALVINGS)
    roots = Roots(from_, np.where(was, before, after), was)
    at = curves.at(roots.chord, roots.part)
    faces = ~np.isfinite(at.second_places)
    second = np.where(faces, curves.second_places[roots.chord], at.second_places)
    return _divided(curves, at_points, roots, replace(at, second_places=second))


def _divided(curves: Curves, inside: Bools, roots: Roots, at: Along) -> Curves:
    """The parts of curves inside of something: their points that are (n,), and places at which they pass its border,
    inside before that where the roots fall."""
    order = np.argsort(np.concatenate([np.arange(len(inside)), roots.chord + roots.part]), kind="stable")
    owner = np.concatenate([curves.owner, curves.owner[roots.chord]])[order]
    goes_on = np.concatenate([inside, ~roots.falls])[order]
    goes_on[:-1] &= owner[1:] == owner[:-1]
    goes_on[-1:] = False
    points = np.concatenate([curves.points, at.points])[order]
    # A cut in a point of the polyline makes no chord.
    goes_on[:-1] &= (points[1:] != points[:-1]).any(axis=1)
    comes = np.concatenate([[False], goes_on[:-1]])
    kept, starts = goes_on | comes, goes_on & ~comes
    places = np.concatenate([curves.places, at.places])[order]
    offsets = np.append(np.flatnonzero(starts[kept]), kept.sum())
    source = owner[starts]
    cut = np.bincount(curves.owner[roots.chord], minlength=len(curves)) > 0
    return replace(
        curves.take(source),
        points=points[kept],
        places=places[kept],
        second_places=np.concatenate([curves.second_places, at.second_places])[order][kept],
        offsets=offsets.astype(np.intp),
        closed=curves.closed[source] & ~cut[source],
    )


# Which of many sheets come near each other, judged by the points of their tessellations.

SLACK = 0.01
"""Part of its size that a tessellation may lie inside of its sheet."""


def near_sheets(points: Sequence[Floats]) -> list[tuple[int, int]]:
    """The pairs of sheets, each once and in order, that their hulls do not separate; points (k,3): of the tessellation
    of each, NaN in holes.

    Edge cases: a sheet without points is near none.
    """
    finite = [own[all_finite(own)] for own in points]
    known = np.flatnonzero([len(own) > 0 for own in finite])
    if not len(known):
        return []
    hulls = SlabHulls.of(np.concatenate(finite), np.array([len(finite[k]) for k in known.tolist()]))
    hulls = hulls.widened(SLACK * (hulls.high - hulls.low)[:3].max(axis=0))
    one, two = hulls.near(hulls)
    one, two = known[one[one < two]], known[two[one < two]]
    order = np.lexsort((two, one))
    return list(zip(one[order].tolist(), two[order].tolist(), strict=True))


# The curves in which smooth surfaces meet themselves, each other and polyhedra.

SmoothSheet = ParametricSheet | ImplicitSheet


@dataclass(frozen=True, eq=False)
class Meetings:
    """The curves in which sheets meet; for each sheet (s,) whether it meets itself, or may; what could not be
    decided."""

    curves: Curves
    meets_itself: Bools
    doubts: tuple[tuple[str, str], ...]


def meetings(scene: Scene, view: View, sheets: tuple[SmoothSheet, ...], wants: Bools, tracing: Tracing) -> Meetings:
    """All meetings of sheets of which one belongs to an item that wants intersections; wants (i,).

    A curve belongs to the item, of those that want it, that comes first in the scene. A sheet whose meetings with
    itself nobody wants may meet itself, unless it is known to be embedded.
    """
    parts, doubts = [], []
    itself = np.zeros(len(sheets), dtype=np.bool_)
    for number, sheet in enumerate(sheets):
        # Where an implicit surface meets itself its gradient vanishes; these lines are not looked for.
        itself[number] = isinstance(sheet, ParametricSheet) and not is_embedded(sheet.surface)
        # Faces of bodies end before they would.
        itself[number] &= not (isinstance(sheet, ParametricSheet) and sheet.of_body)
        if itself[number] and wants[sheet.item] and isinstance(sheet, ParametricSheet):
            found = self_intersections(sheet.asked, tracing=tracing)
            itself[number] = len(found) > 0 or bool(found.doubts)
            doubts += [(scene.items[sheet.item].name, text) for text in found.doubts]
            parts.append(within_trims(_double(found, sheet, number, sheet, number, sheet.item), {number: sheet}))
    pairs = []
    for one, two in near_sheets([sheet.vertices for sheet in sheets]) if wants.any() else ():
        items = [i for i in sorted((sheets[one].item, sheets[two].item)) if wants[i]]
        # The sheets of one item are parts of one surface, which meet at its sharp edges only.
        if items and sheets[one].item != sheets[two].item:
            pairs.append((one, two, items[0]))
    for (one, two, _), (part, unsure) in zip(pairs, _of_pairs(sheets, pairs, tracing), strict=True):
        names = " and ".join(scene.items[sheets[k].item].name for k in (one, two))
        doubts += [(names, text) for text in unsure]
        parts.append(part)
    apart = kept_apart(scene, view)
    shapes = [(k, item.shape) for k, item in enumerate(scene.items)]
    meshes = [(k, shape) for k, shape in shapes if isinstance(shape, Mesh) and shape.face_count]
    boxes = [_box(sheet.vertices) for sheet in sheets if meshes]
    for other, shape in meshes:
        mesh = Mesh(view.points_of(shape.vertices).T, shape.corners, shape.offsets, shape.present)
        box = _box(mesh.vertices)
        for number, sheet in enumerate(sheets):
            items = [i for i in sorted((sheet.item, other)) if wants[i]]
            if items and not apart[sheet.item, other] and _overlap(boxes[number], box):
                part, unsure = _with_mesh(sheet, number, mesh, items[0], tracing)
                names = f"{scene.items[sheet.item].name} and {scene.items[other].name}"
                doubts += [(names, text) for text in unsure]
                parts.append(part)
    return Meetings(together(parts), itself, tuple(doubts))


def _of_pairs(
    sheets: Sequence[SmoothSheet], pairs: Sequence[tuple[int, int, int]], tracing: Tracing
) -> list[tuple[Curves, tuple[str, ...]]]:
    """The curves of pairs of sheets, given by their numbers and the item whose the curves are; and doubts."""
    parametrised = {k: sheet for k, sheet in enumerate(sheets) if isinstance(sheet, ParametricSheet)}
    smooth = [pair for pair in pairs if pair[0] in parametrised and pair[1] in parametrised]
    grids = {k: SurfaceGrids(parametrised[k].asked) for pair in smooth for k in pair[:2]}
    curves = iter(intersections_of_grids([(grids[one], grids[two]) for one, two, _ in smooth], tracing))
    result = []
    for one, two, item in pairs:
        first, second = sheets[one], sheets[two]
        if not isinstance(first, ImplicitSheet) and not isinstance(second, ImplicitSheet):
            found = next(curves)
            whole = _double(found, first, one, second, two, item)
            result.append((within_trims(whole, {one: first, two: second}), found.doubts))
        elif isinstance(first, ImplicitSheet) and isinstance(second, ImplicitSheet):
            result.append(implicit_with_implicit(first, one, second, two, item, tracing))
        elif isinstance(first, ImplicitSheet):
            assert isinstance(second, ParametricSheet)
            result.append(parametrised_with_implicit(second, two, first, one, item, tracing))
        else:
            assert isinstance(second, ImplicitSheet)
            result.append(parametrised_with_implicit(first, one, second, two, item, tracing))
    return result


def _with_mesh(
    sheet: SmoothSheet, number: int, mesh: Mesh, item: int, tracing: Tracing
) -> tuple[Curves, tuple[str, ...]]:
    """The curves of a sheet and a mesh in the view's coordinates."""
    if isinstance(sheet, ImplicitSheet):
        return implicit_with_mesh(sheet, number, mesh, item, tracing)
    section = mesh_section(sheet.asked, mesh, tracing=tracing)
    family, found = FaceCurves(sheet, number), section.curves
    curves = as_curves(found, LineKind.INTERSECTION, item, family, section.normals)
    return within_trims(curves, {number: sheet}), found.doubts


def curves_of_pairs(
    sheets: Sequence[ParametricSheet], pairs: Sequence[tuple[int, int, int]], tracing: Tracing
) -> list[tuple[Curves, tuple[str, ...]]]:
    """The curves of pairs of sheets that are none of a scene's, given by their numbers and the item whose the curves
    are; and doubts about them."""
    boxes = [_box(sheet.vertices) for sheet in sheets]
    near = [_overlap(boxes[one], boxes[two]) for one, two, _ in pairs]
    found = iter(_of_pairs(sheets, [pair for pair, meets in zip(pairs, near, strict=True) if meets], tracing))
    return [next(found) if meets else (no_curves(), ()) for meets in near]


def curves_with_mesh(sheet: ParametricSheet, mesh: Mesh, item: int, tracing: Tracing) -> tuple[Curves, tuple[str, ...]]:
    """The curves of a sheet that is none of a scene's with a mesh in the view's coordinates, and doubts about them;
    item: whose they are."""
    if not _overlap(_box(sheet.vertices), _box(mesh.vertices)):
        return no_curves(), ()
    return _with_mesh(sheet, 0, mesh, item, tracing)


def _box(points: Floats) -> Floats:
    """(2,3) the box around points; empty without any."""
    good = points[np.isfinite(points).all(axis=1)]
    if not len(good):
        return np.array([[np.inf] * 3, [-np.inf] * 3])
    return np.stack([good.min(axis=0), good.max(axis=0)])


def _overlap(one: Floats, two: Floats) -> bool:
    """Whether boxes overlap, tessellations a little inside of them."""
    if not (np.isfinite(one).all() and np.isfinite(two).all()):
        return False
    slack = SLACK * float(np.ptp(one, axis=0).max() + np.ptp(two, axis=0).max())
    return bool((one[0] <= two[1] + slack).all() and (two[0] <= one[1] + slack).all())


def _double(
    found: DoubleCurves, one: ParametricSheet, first: int, two: ParametricSheet, second: int, item: int
) -> Curves:
    """Curves on two sheets, closed ones led back to their first point in whatever roles and periods it is there."""
    rounds = closed_round(found)
    index, back, start = rounds.index, rounds.again, rounds.start
    places, others = _places(found.one)[index], _places(found.two)[index]
    swaps = np.zeros(len(start), dtype=np.bool_)
    if first == second:
        kept = one.apart(places[back - 1], _places(found.one)[start])
        swapped = one.apart(places[back - 1], _places(found.two)[start])
        swaps = swapped < kept
    ends = np.where(swaps[:, None], found.two[start], found.one[start])
    other_ends = np.where(swaps[:, None], found.one[start], found.two[start])
    places[back, :2] = near_to(one.surface.domain, ends, places[back - 1, :2])
    others[back, :2] = near_to(two.surface.domain, other_ends, others[back - 1, :2])
    many = len(found)
    return Curves(
        found.points[index],
        places,
        others,
        rounds.offsets,
        found.closed,
        np.full(many, int(LineKind.INTERSECTION)),
        np.full(many, item, dtype=np.intp),
        np.zeros(many, dtype=np.intp),
        np.zeros(many),
        (SheetsMeet(one, first, two, second),),
    )


def _places(parameters: Floats) -> Floats:
    return np.concatenate([parameters, np.zeros((len(parameters), 1))], axis=1)

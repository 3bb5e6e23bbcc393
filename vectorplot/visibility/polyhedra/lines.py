"""Every line of a scene that could be drawn, before anything hides it."""

from __future__ import annotations

from collections.abc import Callable, Collection
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.mesh_edge_lines import Edges, Faces, mesh_edges, smooth_mesh_edges
from vectorplot.features.mesh_intersections import face_intersections, self_intersections_of_parts
from vectorplot.features.mesh_lines import (
    MeshCurves,
    curves_of_values,
    face_triangles,
    mesh_isophote_edges,
    mesh_isophotes,
    mesh_plane_sections,
    mesh_point_light_isophote_edges,
    mesh_point_light_isophotes,
    pattern_outline,
)
from vectorplot.geometry import ragged, records
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.boxes import overlapping_boxes
from vectorplot.geometry.budget import USUAL, Budget, part_of, unheard
from vectorplot.geometry.component_arrays import dot
from vectorplot.geometry.connectivity import pieces_of_faces
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_cuts import HalfSpaces, segments_outside
from vectorplot.geometry.mesh_repair import MANY_FACES
from vectorplot.geometry.polylines import segments
from vectorplot.geometry.records import IN_COLUMNS, Elements
from vectorplot.scene.added_lines import curve_light
from vectorplot.scene.item import Item
from vectorplot.scene.page import Page
from vectorplot.scene.placement import Placement, field_of_vision
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import FieldContours, Roads, Serpentine, TerrainLines, WaterCourses
from vectorplot.scene.view import View, first_coincident
from vectorplot.tolerances import CUT_EDGE_OF_EXTENT
from vectorplot.visibility.projected_faces import ProjectedFaces
from vectorplot.words import FEATURE_KINDS, LineKind, unknown

if TYPE_CHECKING:
    from vectorplot.visibility.smooth.traced_curves import ChordParts


@dataclass(frozen=True, eq=False)
class Lines(Elements):
    """Straight lines in the view's coordinates. start, end (3,n); kind (n,): LineKind values; item (n,); side (n,): 1
    or -1 for an outline with its surface left or right of start -> end in the image, else 0; smooth (n,): chords of
    smooth curves; behind (n,): how many smooth surfaces hide all of it; aside (3,n): offset at which it is tested,
    as contours across faces are just outside of these; chords: the parts of smooth curves, if any; lamp (n,): whose
    light ends there, by number, 0 for other lines.
    """

    start: Floats = field(metadata=IN_COLUMNS)
    end: Floats = field(metadata=IN_COLUMNS)
    kind: Ints
    item: Ints
    side: Ints
    smooth: Bools
    behind: Ints
    aside: Floats = field(metadata=IN_COLUMNS)
    chords: ChordParts | None = None
    lamp: Ints = field(default_factory=lambda: np.zeros(0, dtype=np.intp))

    def __post_init__(self) -> None:
        if not len(self.lamp):
            object.__setattr__(self, "lamp", np.zeros(len(self.kind), dtype=np.intp))

    def __len__(self) -> int:
        return len(self.kind)

    def sides(self, view: View) -> Ints:
        """The sides of all outlines, see side, those of smooth surfaces too.

        result: (n,) 1, -1 or 0.
        """
        return self.side + self.chords.sides(view) if self.chords else self.side

    def ends(self, view: View, which: Ints, low: Floats, high: Floats) -> tuple[Floats, Floats]:
        """Both ends of parts of lines.

        which: (k,) of which line each is a part; low, high: (k,) from where to where, 0 to 1.
        """
        start, end = _divided(self.start.take(which, axis=1), self.end.take(which, axis=1), low, high)
        if self.chords:
            self.chords.take(which).cut(view, low, high, start, end)
        return start, end

    def cut(self, view: View, which: Ints, low: Floats, high: Floats) -> Lines:
        """Parts of lines as lines."""
        some = self.take(which)
        start, end = _divided(some.start, some.end, low, high)
        if not some.chords:
            return replace(some, start=start, end=end)
        begin, stop = some.chords.cut(view, low, high, start, end)
        return replace(some, start=start, end=end, chords=replace(some.chords, begin=begin, end=stop))


def _divided(start: Floats, end: Floats, low: Floats, high: Floats) -> tuple[Floats, Floats]:
    """The points (3,k) at low and high (k,) of lines; exact at 0 and 1."""
    along = end - start
    return start + low * along, np.where(high < 1.0, start + high * along, end)


def joined_lines(parts: Collection[Lines]) -> Lines:
    """All lines of all parts, none of which has chords of smooth curves."""
    ends, none = np.zeros((3, 0)), np.zeros(0, dtype=np.intp)
    return records.joined((straight_lines(ends, ends, none, none, none), *parts))


def straight_lines(start: Floats, end: Floats, kind: Ints, item: Ints, side: Ints) -> Lines:
    """Lines none of which is a chord of a curve, nor behind a smooth surface."""
    none = np.zeros(len(kind), dtype=np.intp)
    return Lines(start, end, kind, item, side, none.astype(np.bool_), none, np.zeros((3, len(kind))))


def wanted_kinds(scene: Scene, kinds: frozenset[LineKind]) -> list[tuple[frozenset[LineKind], Bools]]:
    """The sets of kinds that items want, each with the items (i,) that want it: their own, or else those asked for."""
    own = [kinds_of(item, kinds) for item in scene.items]
    return [(one, np.array([other == one for other in own], dtype=np.bool_)) for one in dict.fromkeys(own)]


def items_wanting(kind: LineKind, scene: Scene, kinds: frozenset[LineKind]) -> Bools:
    """(i,) the items on which lines of a kind are looked for, see kinds_of."""
    found = (kind in kinds_of(item, kinds) for item in scene.items)
    return np.fromiter(found, dtype=np.bool_, count=len(scene.items))


def kinds_of(item: Item, kinds: frozenset[LineKind]) -> frozenset[LineKind]:
    """The kinds to look for on an item: its own, or else those asked for, and those that edges of cuts and ghosts are
    before they are told from others."""
    own = kinds if item.lines is None else frozenset(map(LineKind.from_word, item.lines))
    if LineKind.GHOST in own:
        own |= {LineKind.CONTOUR, LineKind.BOUNDARY, LineKind.CREASE}
    return own | {LineKind.BOUNDARY} if item.cut_by and LineKind.CUT in own else own


def edge_lines(
    scene: Scene, view: View, faces: ProjectedFaces, kinds: frozenset[LineKind], crease_angle_deg: float, backs: Bools
) -> Lines:
    """Contours, boundaries, creases and other edges of all items; kinds: unless an item has its own; backs (i,): items
    whose edges between faces turned away are wanted too (of closed solids they are hidden). Items with drawn_edges
    have these only, flat ones as creases, and tangent_edges; added_edges are creases too, less what is cut away.
    Source: Glaeser, sections 3.3, 4.4 and 7.2.
    """
    parts = []
    smooth, listed = _smoothly_outlined(scene), _listing_edges(scene)
    ways = (mesh_edges, ~smooth & ~listed), (smooth_mesh_edges, smooth & ~listed), (_all_edges, listed)
    asking = [(wanted, items & those, find) for wanted, items in wanted_kinds(scene, kinds) for find, those in ways]
    for wanted, items, find in asking:
        if not items.any():
            continue
        asked = all_faces = _faces(view, faces)
        which = np.flatnonzero(items[view.face_item])
        if len(which) < view.face_count:
            asked = _some_faces(all_faces, which)
        edges = find(asked, wanted, crease_angle_deg)
        item = view.face_item[which[edges.face]]
        kept = edges.front | backs[item]
        if find is _all_edges:
            edges, among = _listed_edges(scene, view, edges, item, wanted)
            kept &= among
        edges = records.take(edges, kept)
        ends = view.points.take(edges.start, axis=1), view.points.take(edges.end, axis=1)
        lines = straight_lines(*ends, edges.kind, item[kept], edges.side)
        if find is _all_edges and touching_parts(scene):
            from vectorplot.visibility.polyhedra.smooth_lines import beside_flat_faces

            lines = replace(lines, aside=beside_flat_faces(scene, view, asked, view.face_item[which], edges))
        parts.append(lines)
    return joined_lines([*parts, *_added_edges(scene, view, kinds)])


def touching_parts(scene: Scene) -> bool:
    """Whether there are several items, and triangles stand for the smooth faces of some: where these touch others, as a
    pin its bore, the triangles of both pierce."""
    return len(scene.items) > 1 and any(item.normals is not None for item in scene.items)


def _all_edges(faces: Faces, kinds: Collection[LineKind], crease_angle_deg: float) -> Edges:
    return mesh_edges(faces, {*kinds, LineKind.EDGES}, crease_angle_deg)


def _added_edges(scene: Scene, view: View, kinds: frozenset[LineKind]) -> list[Lines]:
    """The segments of items that are no edges of theirs, as creases."""
    parts = []
    for number, item in enumerate(scene.items):
        if item.added_edges is None or not {LineKind.CREASE, LineKind.EDGES} & kinds_of(item, kinds):
            continue
        start, end, _ = segments_outside(item.added_edges[:, 0], item.added_edges[:, 1], item.cut_by)
        none = np.zeros(len(start), dtype=np.intp)
        ends = view.points_of(start), view.points_of(end)
        parts.append(straight_lines(*ends, np.full(len(start), int(LineKind.CREASE)), none + number, none))
    return parts


def _listed_edges(
    scene: Scene, view: View, edges: Edges, item: Ints, kinds: Collection[LineKind]
) -> tuple[Edges, Bools]:
    """The edges, listed flat ones as creases where edges are not asked for; and whether they are listed and asked for.

    item (e,): of which they are. A part of a listed edge that a cut leaves counts as listed, and so do edges of cuts.
    """
    flat = (edges.kind == LineKind.EDGES) & (LineKind.EDGES not in kinds)
    kind = np.where(flat, int(LineKind.CREASE), edges.kind)
    among = np.zeros(len(item), dtype=np.bool_)
    start, end = view.points[:, edges.start], view.points[:, edges.end]

    def listed(own: Ints, ends: Floats) -> Ints:
        one, two = (view.points_of(side) for side in (ends[:, 0], ends[:, 1]))
        return own[_lie_along(start[:, own], end[:, own], one, two, view.tolerance)]

    for number in np.unique(item).tolist():
        asked = scene.items[number]
        if asked.tangent_edges is not None and LineKind.TANGENT in kinds:
            tangent = listed(np.flatnonzero(item == number), asked.tangent_edges)
            kind[tangent], among[tangent] = LineKind.TANGENT, True
        if asked.drawn_edges is not None:
            own = np.flatnonzero((item == number) & (~flat | (LineKind.CREASE in kinds)))
            among[listed(own, asked.drawn_edges)] = True
        borders = np.flatnonzero((item == number) & (edges.kind == LineKind.BOUNDARY))
        middle = matmul(0.5 * (start + end)[:, borders].T, view.axes) * view.scale + view.centre
        for region in scene.items[number].cut_by:
            among[borders] |= region.is_border(middle, CUT_EDGE_OF_EXTENT * view.scale)
    return replace(edges, kind=kind), among


def _lie_along(start: Floats, end: Floats, one: Floats, two: Floats, tolerance: float) -> Bools:
    """(n,) which segments from start to end (3,n) are, or are parts of, segments from one to two (3,l)."""
    from scipy.spatial import cKDTree

    if not one.shape[1]:
        return np.zeros(start.shape[1], dtype=np.bool_)
    listed = np.concatenate([np.concatenate([one, two]), np.concatenate([two, one])], axis=1).T
    along: Bools = np.isfinite(
        cKDTree(listed).query(np.concatenate([start, end]).T, distance_upper_bound=2 * tolerance)[0]
    )
    # The others may be parts of listed ones: then they begin in the box of a short piece of one.
    way = two - one
    length = np.sqrt(dot(way, way))
    pieces = np.ceil(length / np.where(length.mean() > 0.0, length.mean(), 1.0)).astype(np.intp) + 1
    owner, place = ragged.owner(pieces), ragged.place(pieces)
    first, last = (one[:, owner] + (place + more) / pieces[owner] * way[:, owner] for more in (0, 1))
    rest = np.flatnonzero(~along)
    low, high = np.minimum(first, last) - tolerance, np.maximum(first, last) + tolerance
    part, piece = overlapping_boxes(start[:, rest], start[:, rest], low, high)
    part, whole = rest[part], owner[piece]
    for side in (start, end):
        near = _from_segments(side[:, part], one[:, whole], two[:, whole]) <= tolerance
        part, whole = part[near], whole[near]
    along[part] = True
    return along


def _from_segments(points: Floats, one: Floats, two: Floats) -> Floats:
    """(n,) distances of points (3,n) from segments from one to two (3,n)."""
    way, to = two - one, points - one
    square = dot(way, way)
    to -= np.clip(dot(to, way) / np.where(square > 0.0, square, 1.0), 0.0, 1.0) * way
    return np.asarray(np.sqrt(dot(to, to)))


def _listing_edges(scene: Scene) -> Bools:
    """(i,) the items that list the edges to be drawn."""
    listed = (item.drawn_edges is not None or item.tangent_edges is not None for item in scene.items)
    return np.fromiter(listed, dtype=np.bool_, count=len(scene.items))


def _faces(view: View, faces: ProjectedFaces) -> Faces:
    return Faces(view.points, view.corners, view.offsets, view.inner, faces.facing)


def _some_faces(faces: Faces, which: Ints) -> Faces:
    size = np.diff(faces.offsets)[which]
    offsets = ragged.offsets(size)
    shift = faces.offsets[which] - offsets[:-1]
    position = np.arange(offsets[-1]) + np.repeat(shift, size)
    return Faces(faces.points, faces.corners[position], offsets, faces.inner[position], faces.facing[which])


def intersection_lines(
    scene: Scene, view: View, faces: ProjectedFaces, kinds: frozenset[LineKind], solid: Bools, backs: Bools
) -> Lines:
    """The segments in which different items, or faces of one, pierce each other.

    A segment belongs to the item, of those that want intersections, that comes first in the scene. backs (i,): items
    whose faces that turn away are met too; what lies in those of a closed solid is hidden, but for its outline.
    """
    wants = items_wanting(LineKind.INTERSECTION, scene, kinds)
    part = _parts(scene, view, solid)
    faced = np.array([item.is_cut_face for item in scene.items], dtype=np.bool_)
    apart = kept_apart(scene, view)
    faced[faced] = ~(wants & ~apart[faced]).any(axis=1)
    left_out = (_beyond_two(first_coincident(view)) | faced)[view.face_item]
    left_out |= (faces.facing < 0) & (~backs & _outlined(scene, kinds))[view.face_item]
    asked, which = _faces(view, faces), np.flatnonzero(~left_out)
    if len(which) < view.face_count:
        asked = _some_faces(asked, which)
    own = np.flatnonzero((wants & ~solid)[view.face_item[which]])
    itself = self_intersections_of_parts(_some_faces(asked, own), part[which][own], view.tolerance)
    met = records.joined(
        [
            face_intersections(asked, part[which], view.tolerance),
            replace(itself, one=own[itself.one], two=own[itself.two]),
        ]
    )
    one, two = view.face_item[which[met.one]], view.face_item[which[met.two]]
    one, two = np.minimum(one, two), np.maximum(one, two)
    kept = (wants[one] | wants[two]) & ~apart[one, two]
    owner = np.where(wants[one], one, two)[kept]
    kind = np.full(int(kept.sum()), int(LineKind.INTERSECTION))
    return straight_lines(
        met.start.compress(kept, axis=1), met.end.compress(kept, axis=1), kind, owner, np.zeros_like(kind)
    )


def kept_apart(scene: Scene, view: View) -> Bools:
    """(i,i) which items do not meet: faces of cuts, and what the planes of these cut."""
    many = len(scene.items)
    faces = [k for k, item in enumerate(scene.items) if item.is_cut_face]
    if not faces:
        return np.broadcast_to(np.False_, (many, many))
    cuts = list(dict.fromkeys(item.cut_by for item in scene.items))
    numbers = {regions: k for k, regions in enumerate(cuts)}
    own = np.array([numbers[item.cut_by] for item in scene.items], dtype=np.intp)
    apart = np.zeros((many, many), dtype=np.bool_)
    for face in faces:
        points, tolerance = scene.items[face].mesh.vertices, CUT_EDGE_OF_EXTENT * view.scale
        on = [any(region.is_border(points, tolerance).all() for region in regions) for regions in cuts]
        apart[face] |= np.array(on, dtype=np.bool_)[own]
    return apart | apart.T


def _outlined(scene: Scene, kinds: frozenset[LineKind]) -> Bools:
    """(i,) the items of which all edges of the outline are drawn: what else lies on these adds nothing."""
    return items_wanting(LineKind.CONTOUR, scene, kinds) & ~_smoothly_outlined(scene) & ~_listing_edges(scene)


def _smoothly_outlined(scene: Scene) -> Bools:
    """(i,) the items whose contours run across their faces, as on the smooth shapes they stand for."""
    return np.array([item.curves.smooth_contours for item in scene.items], dtype=np.bool_)


def _parts(scene: Scene, view: View, solid: Bools) -> Ints:
    """(f,) numbers that faces have in common where they are of one item and are connected."""
    whole = solid.copy()
    open_ = np.flatnonzero(~solid)
    whole[open_] = [_in_one_piece(scene.items[k]) for k in open_.tolist()]
    if whole.all():
        return view.face_item
    some = np.flatnonzero(~whole[view.face_item])
    corners, offsets = ragged.take(view.offsets, some)
    count, piece = pieces_of_faces(view.points.shape[1], view.corners[corners], offsets)
    owner = np.zeros(count, dtype=np.intp)
    owner[piece] = view.face_item[some]
    pieces = np.bincount(owner, minlength=len(whole))
    part = ragged.starts(np.where(whole, 1, pieces))[view.face_item]
    part[some] += piece - ragged.starts(pieces)[view.face_item[some]]
    return part


def _in_one_piece(item: Item) -> bool:
    """Whether an item is known to be connected: meshes of many faces are asked, all others looked at together."""
    mesh = item.shape
    return isinstance(mesh, Mesh) and mesh.face_count >= MANY_FACES and mesh.present is None and mesh.pieces[0] == 1


def _beyond_two(first: Ints) -> Bools:
    """(i,) the items that are in the place of two others, of which the first ones (i,) are given: what they meet, and
    how they meet each other, is told by the first two."""
    later = np.flatnonzero(first != np.arange(len(first)))
    second = later[np.unique(first[later], return_index=True)[1]]
    result = np.zeros(len(first), dtype=np.bool_)
    result[later], result[second] = True, False
    return result


def pattern_lines(scene: Scene, view: View, kinds: frozenset[LineKind]) -> Lines:
    """The outlines of all patterns on faces that are present."""
    starts, ends, items = [], [], []
    for number, item in enumerate(scene.items):
        if LineKind.PATTERN not in kinds_of(item, kinds):
            continue
        for pattern in item.patterns:
            if item.mesh.present is None or item.mesh.present[pattern.face]:
                outline = pattern_outline(item.mesh, pattern.face, pattern.points)
                starts.append(outline)
                ends.append(np.roll(outline, -1, axis=0))
                items.append(np.full(len(outline), number))
    start, end = (view.points_of(np.concatenate([np.zeros((0, 3)), *part])) for part in (starts, ends))
    owner = np.concatenate([np.zeros(0, dtype=np.intp), *items])
    return straight_lines(start, end, np.full(len(owner), int(LineKind.PATTERN)), owner, np.zeros_like(owner))


def mesh_curve_lines(
    scene: Scene,
    view: View,
    kinds: frozenset[LineKind],
    crease_angle_deg: float,
    budget: Budget = USUAL,
    done: Callable[[float], None] = unheard,
) -> Lines:
    """The isophotes, sections, integral curves, lines of terrains, feature lines and contours across faces that
    polyhedra ask for: they lie in the faces.

    At edges that turn by more than the crease angle a mesh is not smooth: isophotes end there. budget: of shortest
    ways; done: is told the part of the work that is done.
    Errors: InputError, with the item's name, for a light that the scene does not have, and as in item_integral_lines.
    """
    parts = []
    for number, item in enumerate(scene.items):
        wanted = kinds_of(item, kinds)
        if isinstance(item.shape, Mesh) and item.shape.face_count:
            if LineKind.CONTOUR in wanted and item.curves.smooth_contours:
                parts.append(_contours_across_faces(view, item, number, crease_angle_deg))
            if LineKind.ISOPHOTE in wanted and item.curves.isophotes:
                found = _mesh_isophotes(scene, view, item, crease_angle_deg)
                parts.append(_lines_of_curves(view, found, LineKind.ISOPHOTE, number, item.curves.smooth))
            for section in item.curves.sections:
                if section.kind in wanted:
                    found = mesh_plane_sections(item.shape, section.normal, section.offsets)
                    parts.append(_lines_of_curves(view, found, section.kind, number, item.curves.smooth))
            for asked_values in item.curves.contours if LineKind.SECTION in wanted else ():
                found = _field_contours(item, item.shape, asked_values)
                parts.append(_lines_of_curves(view, found, LineKind.SECTION, number, item.curves.smooth))
            if LineKind.INTEGRAL in wanted and item.curves.integral:
                from vectorplot.visibility.polyhedra.smooth_lines import item_integral_lines

                told = part_of(done, number, len(scene.items))
                for place, lines in enumerate(item.curves.integral):
                    own = part_of(told, place, len(item.curves.integral))
                    found = item_integral_lines(item, lines, budget, own, crease_angle_deg)
                    parts.append(_lines_of_curves(view, found, LineKind.INTEGRAL, number, item.curves.smooth))
            if LineKind.INTEGRAL in wanted:
                for asked in item.curves.terrain:
                    found = _terrain_lines(item, item.shape, asked)
                    parts.append(_lines_of_curves(view, found, LineKind.INTEGRAL, number, item.curves.smooth))
            if features := [kind for kind in FEATURE_KINDS if kind in wanted]:
                from vectorplot.visibility.polyhedra.smooth_lines import item_feature_lines

                for kind, found in item_feature_lines(item, item.shape, view, features).items():
                    parts.append(_lines_of_curves(view, found, kind, number, True))
    return joined_lines(parts)


def _field_contours(item: Item, mesh: Mesh, asked: FieldContours) -> MeshCurves:
    """The lines on which a field of an item has some values. Errors: InputError for one that it has not at vertices."""
    at_vertices = () if item.fields is None else tuple(item.fields.at_vertices)
    if item.fields is None or asked.name not in at_vertices:
        raise unknown(f"{item.name}: contours: field at the vertices", asked.name, at_vertices)
    numbers = item.fields.at(asked.name, mesh.vertices)
    levels = np.array(asked.levels(numbers), dtype=np.float64)
    return curves_of_values(face_triangles(mesh), levels, lambda level: numbers - level)


def _terrain_lines(item: Item, mesh: Mesh, asked: TerrainLines) -> MeshCurves:
    """What a terrain asks for. Errors: InputError with the item's name."""
    # Terrains are rare: what finds their lines is loaded for them.
    from vectorplot.features.terrain_roads import roads
    from vectorplot.features.terrain_serpentines import serpentine
    from vectorplot.features.terrain_water import valley_lines, water_courses, watersheds

    try:
        if isinstance(asked, WaterCourses):
            return water_courses(mesh, asked.places)
        if isinstance(asked, Roads):
            return roads(mesh, asked.start, asked.end)
        if isinstance(asked, Serpentine):
            slope = float(np.radians(asked.slope_deg))
            return serpentine(mesh, asked.start, asked.end, slope, radius=asked.radius, width=asked.width)
        return valley_lines(mesh) if asked.valleys else watersheds(mesh)
    except InputError as error:
        raise InputError(f"{item.name}: {error.cause}") from None


def _contours_across_faces(view: View, item: Item, number: int, crease_angle_deg: float) -> Lines:
    # Few meshes are taken for smooth shapes: what finds their contours is loaded for them.
    from vectorplot.visibility.polyhedra.smooth_lines import smooth_contour_lines

    found = smooth_contour_lines(item, view, crease_angle_deg)
    numbers = np.full(len(found.side), number)
    lines = straight_lines(found.start, found.end, np.full_like(numbers, int(LineKind.CONTOUR)), numbers, found.side)
    return replace(lines, smooth=np.ones(len(numbers), dtype=np.bool_), aside=found.aside)


def _mesh_isophotes(scene: Scene, view: View, item: Item, crease_angle_deg: float) -> MeshCurves:
    light, cosines = curve_light(scene, view, item), item.curves.isophotes
    if item.curves.along_edges:
        along = mesh_isophote_edges if light.parallel else mesh_point_light_isophote_edges
        return along(item.mesh, light.position, cosines)
    across = mesh_isophotes if light.parallel else mesh_point_light_isophotes
    return across(item.mesh, light.position, cosines, crease_angle_deg)


def _lines_of_curves(view: View, curves: MeshCurves, kind: LineKind, item: int, smooth: bool) -> Lines:
    """The segments of curves; smooth: they are chords of smooth curves through their ends."""
    points = view.points_of(curves.points)
    begin, end = segments(curves).T
    numbers = np.full(len(begin), item)
    kinds = np.full(len(begin), int(kind))
    lines = straight_lines(points.take(begin, axis=1), points.take(end, axis=1), kinds, numbers, np.zeros_like(numbers))
    return replace(lines, smooth=np.full(len(begin), smooth))


# What part of a segment is in front of the eye, and inside the picture.


def window_planes(view: View, low: Floats, high: Floats) -> Floats:
    """(4,4) planes (unit normal, constant) of a window in the image plane from low to high (2,), positive inside."""
    (left, bottom), (right, top) = low, high
    if view.eye is None:
        x, y = view.target[:2]
        rows = [[1, 0, 0, x + left], [-1, 0, 0, -x - right], [0, 1, 0, y + bottom], [0, -1, 0, -y - top]]
        return np.array(rows, dtype=np.float64)
    d = view.focus
    normals = np.array([[d, 0, left], [-d, 0, -right], [0, d, bottom], [0, -d, -top]])
    normals /= np.sqrt((normals * normals).sum(axis=1))[:, None]
    return np.column_stack([normals, matmul(normals, view.eye)])


def near_plane(view: View) -> Floats:
    """(1,4) the near plane, positive beyond it; no row in a parallel projection."""
    if view.eye is None:
        return np.zeros((0, 4))
    return np.array([[0.0, 0.0, -1.0, view.near - view.eye[2]]])


def inside(planes: Floats, start: Floats, end: Floats) -> tuple[Floats, Floats]:
    """Parameters (n,) between which segments (3,n) have no negative distance from any plane; low > high: nowhere.

    Source: Glaeser, section 2.5, with the near plane first (errata G2-08, G2-09).
    """
    low, high = np.zeros(start.shape[1]), np.ones(start.shape[1])
    for a, b, c, d in planes:
        at_start = a * start[0] + b * start[1] + c * start[2] - d
        at_end = a * end[0] + b * end[1] + c * end[2] - d
        crossing = (at_start < 0.0) != (at_end < 0.0)
        where = at_start / np.where(crossing, at_start - at_end, 1.0)
        entering = crossing & (at_start < 0.0)
        low = np.where(entering, np.maximum(low, where), low)
        high = np.where(crossing & ~entering, np.minimum(high, where), high)
        high = np.where((at_start < 0.0) & (at_end < 0.0), -1.0, high)
    return low, high


def frame_of(view: View, lines: Lines, page: Page, fit: bool) -> Placement | None:
    """The frame of a picture of lines: the camera's field of vision where they are not to be fitted to the page, or
    reach too far; else None."""
    if fit and not view.reaches_too_far(lines.start, lines.end):
        return None
    return field_of_vision(view, page, fit)


def in_frame(view: View, lines: Lines, frame: Placement | None) -> Lines:
    """The lines in front of the eye, and inside the frame of the picture if it has one."""
    return in_window(view, lines, None if frame is None else frame.window)


def in_window(view: View, lines: Lines, window: tuple[Floats, Floats] | None) -> Lines:
    """The lines in front of the eye, and inside a window of the image plane from one corner (2,) to the other, if there
    is one."""
    planes = near_plane(view)
    if window is not None:
        planes = np.concatenate([planes, window_planes(view, *window)])
    if not len(planes):
        return lines
    low, high = inside(planes, lines.start, lines.end)
    kept = np.flatnonzero(low < high)
    return lines.cut(view, kept, low[kept], high[kept])


# Which lines are edges of cuts, and which are ghosts of what was cut away.


def with_kinds_of_cuts(scene: Scene, view: View, lines: Lines, kinds: frozenset[LineKind]) -> Lines:
    """The lines; borders of items on what was cut away of them are edges of cuts, and in the planes of these; all
    outlines of ghosts but those are ghosts, and sections of cut faces are hatches. Borders that
    were looked for only because of that are left out."""
    kind, kept = lines.kind.copy(), np.ones(len(lines), dtype=np.bool_)
    start, end = lines.start, lines.end
    for number, item in enumerate(scene.items):
        own = kinds if item.lines is None else frozenset(map(LineKind.from_word, item.lines))
        if item.is_cut_face:
            kind[(lines.item == number) & (kind == LineKind.SECTION)] = LineKind.HATCH
        if not item.cut_by or not own & {LineKind.CUT, LineKind.BOUNDARY, LineKind.GHOST}:
            continue
        which = np.flatnonzero((lines.item == number) & (kind == LineKind.BOUNDARY))
        shifts, cut = _onto_cuts(item.cut_by, view, lines.take(which), 2 if item.is_cut_face else 1)
        which, other = which[cut], which[~cut]
        if LineKind.GHOST in own:
            kind[lines.item == number] = LineKind.GHOST
            # Where it was cut the edge of what is left runs.
            kept[which] = False
            continue
        kind[which] = LineKind.CUT
        kept[which], kept[other] = LineKind.CUT in own, LineKind.BOUNDARY in own and not item.is_cut_face
        start, end = start.copy(), end.copy()
        start[:, which] += shifts[0][:, cut]
        end[:, which] += shifts[1][:, cut]
    if kept.all() and (kind == lines.kind).all():
        return lines
    return replace(lines, kind=kind, start=start, end=end).take(kept)


def _onto_cuts(regions: tuple[HalfSpaces, ...], view: View, lines: Lines, planes: int) -> tuple[Floats, Bools]:
    """The ways (2,3,n) of both ends of lines onto the planes on which they run along the borders of regions, and which
    of them do so on so many planes. Rims of holes are looked at from a little inside of the surface."""
    ways, found = np.zeros((2, 3, len(lines))), np.zeros(len(lines), dtype=np.intp)
    for region in regions:
        normals = matmul(np.array(region.normals), view.axes.T)
        offsets = (np.array(region.offsets) - matmul(np.array(region.normals), view.centre)) / view.scale
        here = HalfSpaces(tuple(map(tuple, normals.tolist())), tuple(offsets.tolist()))
        heights = np.stack([here.heights(points.T) for points in (lines.start, lines.end)])
        before = (heights >= -CUT_EDGE_OF_EXTENT).all(axis=(0, 1))
        off = np.abs(heights).max(axis=0)
        nearest = np.argmin(off, axis=0)
        column = np.arange(len(lines))
        on = before & (off[nearest, column] <= CUT_EDGE_OF_EXTENT)
        way = -heights[:, nearest, column][:, None, :] * normals[nearest].T
        ways[:, :, on] = way[:, :, on]
        found += np.where(before, (off <= CUT_EDGE_OF_EXTENT).sum(axis=0), 0)
    return ways, found >= planes

"""Shadow casters: a view from a light, what keeps its light away, and which things may shadow which faces."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.boxes import overlapping_boxes
from vectorplot.geometry.clipping import Polygons, cut_polygons
from vectorplot.geometry.component_arrays import cross
from vectorplot.geometry.polygon_cuts import PlaneBundles, planes_of
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, LineElements
from vectorplot.geometry.records import IN_COLUMNS
from vectorplot.geometry.rotations import look_rotation
from vectorplot.scene.light import Light
from vectorplot.scene.view import View
from vectorplot.tolerances import NEAR_OF_DISTANCE
from vectorplot.visibility.painter.unseen import unseen_faces
from vectorplot.visibility.polyhedra.lines import near_plane, window_planes
from vectorplot.visibility.projected_faces import crossing_items, newell, project_faces

# A view from a light: which faces are lit, and what lies before what on the rays of light.
#
# A light system is a camera without twist; but a light may stand in the midst of the scene. Then it has six images, one
# on each side of a cube about it. They only say which pairs of faces share rays; what is dark, is decided in the view.

FAR = 1e12
"""A light this many times the scene's extent away has parallel rays: they turn by less than what counts as zero."""

NEAREST_OF_FARTHEST = 0.02
"""A light has one image if no point of the scene is nearer to it, along its axis, than this part of the farthest."""

CUBE = np.array(
    [
        [[0, 1, 0], [0, 0, 1], [1, 0, 0]],
        [[0, 0, 1], [0, 1, 0], [-1, 0, 0]],
        [[0, 0, 1], [1, 0, 0], [0, 1, 0]],
        [[1, 0, 0], [0, 0, 1], [0, -1, 0]],
        [[1, 0, 0], [0, 1, 0], [0, 0, 1]],
        [[0, 1, 0], [1, 0, 0], [0, 0, -1]],
    ],
    dtype=np.float64,
)
"""Axes of the six images of a light in the scene: right, up, away from the light."""


@dataclass(frozen=True, eq=False)
class FacePlanes:
    """The planes of the faces of a view: planes (4,f) unit normals and constants, first (3,f) a corner of each, area
    (f,) twice the areas, arm (f,) the greatest distance of a corner from that one."""

    planes: Floats
    first: Floats
    area: Floats
    arm: Floats

    @classmethod
    def of(cls, view: View) -> FacePlanes:
        """The planes of all faces."""
        normal, arm, first = newell(view, np.arange(view.face_count))
        point = view.points[:, first]
        return cls(planes_of(normal, point), point, np.sqrt((normal * normal).sum(axis=0)), arm)


@dataclass(frozen=True, eq=False)
class LightSystem:
    """A light in a view's coordinates: position (3,), or for parallel rays the unit vector towards the light; axes
    (k,3,3) of its images: right, up, away from the light; whether each image stops at a window, the side of a cube."""

    position: Floats
    parallel: bool
    axes: Floats
    windowed: bool

    def towards(self, points: Floats) -> Floats:
        """(3,n) vectors from points (3,n) to the light."""
        if self.parallel:
            return np.broadcast_to(self.position[:, None], points.shape)
        return np.asarray(self.position[:, None] - points)

    def facing(self, faces: FacePlanes, tolerance: float) -> Ints:
        """(f,) 1 for faces that turn their outside to the light, -1 their inside, 0 for those that it grazes: whose
        images are narrower than the tolerance."""
        ray = self.towards(faces.first)
        cosine = (faces.planes[:3] * ray).sum(axis=0) * faces.area
        distance = np.sqrt((ray * ray).sum(axis=0))
        limit = tolerance * faces.arm * np.maximum(distance, tolerance)
        return np.where(np.abs(cosine) <= limit, 0, np.sign(cosine)).astype(np.intp)


def light_system(view: View, light: Light) -> LightSystem:
    """The light system of a light of the scene.

    Errors: InputError for a position that is not finite, or parallel rays from no direction.
    Source: Glaeser, sections 2.3 and 6.3.
    """
    given = np.asarray(light.position, dtype=np.float64)
    if given.shape != (3,) or not np.isfinite(given).all():
        raise InputError(f"light {light.name}: its position must be three finite numbers")
    if light.parallel:
        position = matmul(view.axes, _unit(given, light))
    else:
        position = view.points_of(given[None])[:, 0]
        if not np.isfinite(position).all():
            raise InputError(f"light {light.name}: it is out of range")
    distance = float(np.sqrt((np.minimum(np.abs(position), FAR) ** 2).sum()))
    parallel = light.parallel or distance >= FAR
    away = -_unit(position, light) if distance > 0.0 else np.array([0.0, 0.0, -1.0])
    if parallel:
        return LightSystem(-away, True, _axes(away)[None], False)
    depth = matmul(away, view.points - position[:, None])
    if depth.size and not depth.min() > NEAREST_OF_FARTHEST * depth.max():
        return LightSystem(position, False, CUBE, True)
    return LightSystem(position, False, _axes(away)[None], False)


def _unit(vector: Floats, light: Light) -> Floats:
    largest = float(np.abs(vector).max())
    if not largest > 0.0:
        raise InputError(f"light {light.name}: parallel rays need a direction that is not zero")
    scaled = vector / largest
    return np.asarray(scaled / np.sqrt(matmul(scaled, scaled)), dtype=np.float64)


def _axes(away: Floats) -> Floats:
    """(3,3) right, up and away from the light."""
    right = np.cross(np.eye(3)[int(np.argmin(np.abs(away)))], away)
    right = right / np.sqrt(matmul(right, right))
    return np.array([right, np.cross(away, right), away])


@dataclass(frozen=True, eq=False)
class LightView:
    """What a light sees, as a camera without twist; turn (3,3): from the coordinates of the picture's view to those of
    this one; planes (p,4): what it sees is on the positive side of these."""

    view: View
    turn: Floats
    planes: Floats


def light_views(view: View, system: LightSystem) -> list[LightView]:
    """The images of a light: one, or six in a cube about a lamp that stands in the midst of the scene."""
    found = []
    for back in [system.position] if system.parallel else [-axes[2] for axes in system.axes]:
        turn = np.ascontiguousarray(look_rotation(back).T)
        eye = None if system.parallel else matmul(turn, system.position)
        focus = 1.0 if eye is None else max(float(eye[2]), 1.0)
        seen = replace(
            view,
            axes=matmul(turn, view.axes),
            points=matmul(turn, view.points),
            eye=eye,
            target=np.zeros(3),
            focus=focus,
            near=-np.inf if eye is None else NEAR_OF_DISTANCE,
        )
        planes = near_plane(seen)
        if system.windowed:
            corner = np.full(2, focus)
            planes = np.concatenate([planes, window_planes(seen, -corner, corner)])
        found.append(LightView(seen, turn, planes))
    return found


@dataclass(frozen=True, eq=False)
class LightBoxes:
    """Where faces are in one image of a light: which (n,), ascending; box (6,n): smallest and largest x and y, nearest
    and farthest depth."""

    which: Ints
    box: Floats

    def grouped(self, group: Ints) -> LightBoxes:
        """The boxes of groups of faces: group (m,) is the group of the face that which numbers, ascending with it."""
        number = group[self.which]
        starts = np.flatnonzero(np.concatenate([[True], number[1:] != number[:-1]])) if len(number) else number
        rows = [
            (np.maximum if k % 2 else np.minimum).reduceat(row, starts) if len(starts) else row
            for k, row in enumerate(self.box)
        ]
        return LightBoxes(number[starts], np.stack(rows))


def light_boxes(view: View, system: LightSystem, faces: Ints) -> list[LightBoxes]:
    """The boxes of some faces in each image of the light; which numbers them as they come."""
    position, offsets = ragged.take(view.offsets, faces)
    points = view.points[:, view.corners[position]]
    if not system.parallel:
        points = points - system.position[:, None]
    numbers = np.arange(len(faces))
    result = []
    for axes in system.axes:
        x, y, depth = matmul(axes, points)
        which, ends = numbers, offsets
        if system.windowed:
            (x, y, depth), ends, which = _in_window(np.stack([x, y, depth]), offsets, view.tolerance)
        if not system.parallel:
            x, y = x / depth, y / depth
        result.append(LightBoxes(which, _boxes(np.stack([x, y, depth]), ends)))
    return result


def _in_window(points: Floats, offsets: Ints, tolerance: float) -> tuple[Floats, Ints, Ints]:
    """The parts of polygons before the light and in the window from -1 to 1 of its image, and which polygons have one.

    A face that comes nearer to the light than half the tolerance has the light in its plane, and casts no shadow.
    """
    depth = points[2]
    possible = np.logical_or.reduceat(depth > 0.0, offsets[:-1]) if len(offsets) > 1 else np.zeros(0, dtype=np.bool_)
    which = np.flatnonzero(possible)
    position, ends = ragged.take(offsets, which)
    polygons = Polygons(np.ascontiguousarray(points[:, position].T), ends)
    polygons, _ = cut_polygons(polygons, polygons.points[:, 2] - 0.25 * tolerance)
    for axis, sign in ((0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)):
        reach = sign * polygons.points[:, axis]
        polygons, _ = cut_polygons(polygons, (1.0 + tolerance) * polygons.points[:, 2] - reach)
    filled = np.flatnonzero(np.diff(polygons.offsets))
    ends = np.append(polygons.offsets[filled], len(polygons.points))
    return polygons.points.T, ends, which[filled]


def _boxes(points: Floats, offsets: Ints) -> Floats:
    """(6,n) smallest and largest x, y and depth."""
    if len(offsets) == 1:
        return np.zeros((6, 0))
    return np.stack([f.reduceat(row, offsets[:-1]) for row in points for f in (np.minimum, np.maximum)])


# What keeps light away: convex solids by their outlines, all else face by face.


@dataclass(frozen=True, eq=False)
class Casters:
    """Convex things that cast shadows. volumes: planes of what each keeps dark, the cone of rays through its outline
    behind all its faces; item (k,); face (g,): the faces they show the light, caster (g,) ascending: whose they are;
    known: pairs (n,) of items and faces whose shadows come from elsewhere. No face of a convex body lies behind all
    its other lit ones: it never shadows its outside.
    Source: Glaeser, section 6.3, figure 5.
    """

    volumes: PlaneBundles
    item: Ints
    face: Ints
    caster: Ints
    known: Callable[[Ints, Ints], Bools] | None = None

    def __len__(self) -> int:
        return len(self.item)

    def take(self, which: Ints) -> Casters:
        """Some of them, given by ascending numbers."""
        number = np.full(len(self), -1, dtype=np.intp)
        number[which] = np.arange(len(which))
        own = np.flatnonzero(number[self.caster] >= 0)
        return replace(
            self,
            volumes=self.volumes.take(which),
            item=self.item[which],
            face=self.face[own],
            caster=number[self.caster[own]],
        )


def shadow_casters(
    view: View, planes: FacePlanes, system: LightSystem, facing: Ints, items: Bools, solids: Bools, sides: Ints
) -> Casters:
    """What the items (i,) that cast shadows, solids (i,) among them, put before a light; sides (i,): as of body_sides.

    A closed body that the light is outside of keeps it away with the faces that it turns to the light; any other item
    with all its faces. Edge cases: faces that the light grazes keep nothing away.
    """
    lit = np.zeros(len(items), dtype=np.bool_)
    lit[view.face_item[facing > 0]] = True
    whole = items & solids & lit
    of_solid = np.flatnonzero(whole[view.face_item] & (facing > 0))
    loose = items & ~whole
    one_sided, turned = turned_to_light(view, sides, system, facing)
    alone = np.flatnonzero(loose[view.face_item] & (facing != 0) & (~one_sided[view.face_item] | turned))
    item, owner = np.unique(view.face_item[of_solid], return_inverse=True)
    face = np.concatenate([of_solid, alone])
    caster = np.concatenate([owner, len(item) + np.arange(len(alone))])
    volumes = _volumes(view, planes, system, facing, of_solid, alone, caster)
    return Casters(volumes, np.concatenate([item, view.face_item[alone]]), face, caster)


def turned_to_light(view: View, sides: Ints, system: LightSystem, facing: Ints) -> tuple[Bools, Bools]:
    """(i,) closed items, by their sides (i,), see body_sides, that the light is outside of, and (f,) the faces that
    they turn to it."""
    side = np.where(_near_light(view, system), 0, sides)
    return side != 0, np.asarray(facing * side[view.face_item] > 0)


def _near_light(view: View, system: LightSystem) -> Bools:
    """(i,) the items with the light in the box of their vertices."""
    counts = np.diff(view.item_vertices)
    result = np.zeros(len(counts), dtype=np.bool_)
    filled = np.flatnonzero(counts)
    if system.parallel or not len(filled):
        return result
    starts = view.item_vertices[filled]
    low, high = (f.reduceat(view.points, starts, axis=1) for f in (np.minimum, np.maximum))
    light = system.position[:, None]
    result[filled] = ((light >= low - view.tolerance) & (light <= high + view.tolerance)).all(axis=0)
    return result


def unpierced_faces(view: View, items: Bools, sides: Ints) -> Bools:
    """(f,) the faces of some items (i,) that nothing pierces for certain: those of items that do not cross themselves,
    outside the boxes of others. sides (i,): as of body_sides."""
    crossing = crossing_items(view, np.flatnonzero((items & (sides == 0))[view.face_item]))
    result = (items & ~np.isin(np.arange(len(items)), crossing))[view.face_item]
    face = np.flatnonzero(result)
    item = np.flatnonzero(np.diff(view.item_vertices))
    if len(item) < 2 or not len(face):
        return result
    world = matmul(view.axes.T, view.points)
    starts = view.item_vertices[item]
    box_low, box_high = (f.reduceat(world, starts, axis=1) for f in (np.minimum, np.maximum))
    position, offsets = ragged.take(view.offsets, face)
    corner = world[:, view.corners[position]]
    low, high = (f.reduceat(corner, offsets[:-1], axis=1) for f in (np.minimum, np.maximum))
    which, other = overlapping_boxes(low - view.tolerance, high + view.tolerance, box_low, box_high)
    result[face[which[item[other] != view.face_item[face[which]]]]] = False
    return result


def unlit_faces(view: View, system: LightSystem, items: Bools, unpierced: Bools, pairs: float) -> Bools:
    """(f,) which faces, of those that nothing pierces (f,), a light does not reach at all, items (i,) being in its way:
    those that are unseen in its image, see unseen_faces; none in the light of a lamp in the midst of the scene."""
    if system.windowed:
        return np.zeros_like(unpierced)
    (image,) = light_views(view, system)
    seen = replace(image.view, occludes=items)
    projected = project_faces(seen)
    return unseen_faces(seen, projected, unpierced & (projected.facing != 0), np.zeros_like(unpierced), pairs)


def _volumes(
    view: View, planes: FacePlanes, system: LightSystem, facing: Ints, of_solid: Ints, alone: Ints, caster: Ints
) -> PlaneBundles:
    """The planes of what casters keep dark: first those of their faces, then those of rays through their outlines."""
    face = np.concatenate([of_solid, alone])
    behind = planes.planes[:, face] * -facing[face]
    position, offsets = ragged.take(view.offsets, face)
    owner = ragged.owner(np.diff(offsets))
    sides = np.flatnonzero(view.only_sides(position[: offsets[len(of_solid)]]))
    used = np.concatenate([sides, np.arange(int(offsets[len(of_solid)]), len(position))])
    start = view.points[:, view.corners[position[used]]]
    along = view.points[:, view.corners[view.after(position[used])]] - start
    ray = system.towards(start)
    normal = -cross(along, ray) * facing[face[owner[used]]]
    # A side that the light sees as a point bounds nothing.
    size, distance = (np.sqrt((v * v).sum(axis=0)) for v in (normal, ray))
    kept = size > view.tolerance * distance
    side = planes_of(normal[:, kept], start[:, kept])
    of = np.concatenate([caster, caster[owner[used]][kept]])
    order = np.argsort(of, kind="stable")
    counts = np.bincount(of, minlength=int(caster[-1]) + 1 if len(caster) else 0)
    return PlaneBundles(np.concatenate([behind, side], axis=1)[:, order], ragged.offsets(counts))


# Which things may shadow which faces in one light, and where these pairs are too many.

CASTERS_FIRST = 1 << 8
"""Casters whose partners are looked up first: how many they have says how many casters come next."""

PAIRS_AT_ONCE = 1 << 20
"""About so many pairs of casters and receivers are handled at once."""

EACH = 1 << 5
"""So many pairs every caster and every receiver may have, if that is more in all. Surfaces without more detail than a
picture shows have up to two dozen for each caster."""

SAMPLE, FIRST_OF_SAMPLE = 1 << 8, 1 << 4
"""Casters of an item whose partners tell how many all have, and how many of them are looked at first."""

SURE = 3.0
"""What a sample tells is wrong by more standard errors once in some hundred times."""


@dataclass(frozen=True, eq=False)
class Receivers(LineElements):
    """Faces that shadows may fall on: face (r,) of the view; points (3,c), offsets (r+1,)."""

    face: Ints = field(metadata=EACH_LINE)
    points: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    offsets: Ints

    @classmethod
    def of(cls, view: View, face: Ints) -> Receivers:
        """Some faces of a view."""
        position, offsets = ragged.take(view.offsets, face)
        return cls(face, view.points[:, view.corners[position]], offsets)


def candidates(
    view: View, system: LightSystem, casters: Casters, receivers: Receivers, first: int = CASTERS_FIRST
) -> Iterator[tuple[Ints, Ints]]:
    """Pairs of casters and receivers whose boxes overlap in an image of the light, the caster not behind; each pair
    once, in batches, all of one caster in the same. first: how many casters the first batch is of.

    Source: Glaeser, section 6.3 (bounding rectangles and priorities in the light systems).
    """
    if not len(casters) or not len(receivers.face):
        return
    givers = [boxes.grouped(casters.caster) for boxes in light_boxes(view, system, casters.face)]
    takers = light_boxes(view, system, receivers.face)
    trees = [_Tree.of(boxes, view.tolerance) for boxes in takers]
    low, count = 0, first
    while low < len(casters):
        batch = [tree.partners(boxes, low, low + count) for tree, boxes in zip(trees, givers, strict=True)]
        low += count
        caster, receiver = (np.concatenate([pairs[k] for pairs in batch]) for k in (0, 1))
        if len(batch) > 1:
            key = np.unique(caster * len(receivers.face) + receiver)
            caster, receiver = np.divmod(key, len(receivers.face))
        looked = len(caster)
        if casters.known is not None:
            open_still = np.flatnonzero(~casters.known(casters.item[caster], receivers.face[receiver]))
            caster, receiver = caster[open_still], receiver[open_still]
        yield caster, receiver
        count = int(np.clip(count * PAIRS_AT_ONCE / max(looked, 1), 1, 8 * count))


@dataclass(frozen=True, eq=False)
class _Tree:
    """A tree over boxes in an image of the light."""

    boxes: LightBoxes
    tree: object
    tolerance: float

    @classmethod
    def of(cls, boxes: LightBoxes, tolerance: float) -> _Tree:
        import shapely

        left, right, bottom, top = boxes.box[:4]
        return cls(boxes, shapely.STRtree(shapely.box(left, bottom, right, top), node_capacity=16), tolerance)

    def partners(self, boxes: LightBoxes, low: int, high: int) -> tuple[Ints, Ints]:
        """Pairs of other boxes, with numbers from low to high, and boxes in the tree that they overlap, and do not lie
        behind."""
        import shapely

        begin, end = np.searchsorted(boxes.which, [low, high])
        left, right, bottom, top, nearest = boxes.box[:5, begin:end]
        asked, found = self.tree.query(shapely.box(left, bottom, right, top))  # type: ignore[attr-defined]
        before = np.flatnonzero(nearest[asked] < self.boxes.box[5, found] - self.tolerance)
        return boxes.which[begin + asked[before]], self.boxes.which[found[before]]


def crowds(view: View, system: LightSystem, casters: Casters, receivers: Receivers, pairs: float) -> Ints:
    """(2,k) items whose casters, and items on whose receivers, would throw so many shadows that more than so many pairs
    had to be looked at, and more than EACH for every one of their casters and receivers.

    Told by the partners of SAMPLE casters of an item that might: where few of these have most partners, so that
    chance may have taken too many of such, and where there are not so many, the shadows are not left out.
    """
    items = len(view.item_vertices) - 1
    item = view.face_item[receivers.face]
    own, theirs = (np.bincount(some, minlength=items) for some in (casters.item, item))
    possible = own * theirs.max(initial=0) > np.maximum(pairs, EACH * own)
    chosen = np.flatnonzero(possible[casters.item] & _in_sample(casters.item, own))
    if not len(chosen):
        return np.zeros((2, 0), dtype=np.intp)
    sample = casters.take(chosen)
    keys, sizes = [], []
    for caster, receiver in candidates(view, system, sample, receivers, FIRST_OF_SAMPLE):
        key, size = np.unique(caster * items + item[receiver], return_counts=True)
        keys.append(key)
        sizes.append(size.astype(np.float64))
    caster, on = np.divmod(np.concatenate(keys), items)
    key, which = np.unique(sample.item[caster] * items + on, return_inverse=True)
    of, on = np.divmod(key, items)
    looked = np.bincount(sample.item, minlength=items)[of]
    size = np.concatenate(sizes)
    mean, square = (np.bincount(which, size**power, minlength=len(key)) / looked for power in (1, 2))
    doubt = np.where(looked < own[of], np.sqrt(np.maximum(square - mean * mean, 0.0) / looked), 0.0)
    sure = own[of] * (mean - SURE * doubt)
    many = sure > np.maximum(pairs, EACH * (own[of] + theirs[on]))
    return np.stack([of[many], on[many]])


def _in_sample(item: Ints, own: Ints) -> Bools:
    """(k,) about SAMPLE casters of each item, or all that it has, spread evenly; items come one after the other."""
    first = np.append(True, item[1:] != item[:-1])[: len(item)]
    number = np.arange(len(item))
    place = number - np.maximum.accumulate(np.where(first, number, 0))
    return np.asarray(place % -(-own[item] // SAMPLE) == 0, dtype=np.bool_)


def apart(view: View, casters: Casters, receivers: Receivers, crowded: Ints) -> Iterator[tuple[Casters, Receivers]]:
    """The casters with the receivers that they may shadow where those of items (2,k) are left out."""
    of, on = crowded
    usual = np.flatnonzero(~np.isin(casters.item, of))
    yield (casters if len(usual) == len(casters) else casters.take(usual)), receivers
    item = view.face_item[receivers.face]
    for one in np.unique(of).tolist():
        open_still = np.flatnonzero(~np.isin(item, on[of == one]))
        yield casters.take(np.flatnonzero(casters.item == one)), receivers.take(open_still)

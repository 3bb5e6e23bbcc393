"""Pairs of bodies, faces and boxes: which overlap in the image, and which of two is in front of the other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import in_turn, may_stop
from vectorplot.geometry.component_arrays import cross, dot
from vectorplot.geometry.elementary import arccos
from vectorplot.scene.view import View
from vectorplot.tolerances import AT_APEX
from vectorplot.visibility.painter.image_faces import ImageFaces, image_points
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import EVERYWHERE, ProjectedFaces, newell

# Convex bodies, compared as wholes.


@dataclass(frozen=True, eq=False)
class Bodies:
    """Convex bodies with their outlines in the image.

    item: (b,) which item of the view each is; corners: (2, c) of the outlines; offsets: (b+1,) body k has the outline
    offsets[k] to offsets[k+1]; shown: (s,) image faces that bodies show; first: (b+1,) body k shows the image faces
    shown[first[k]] to shown[first[k+1]]; sphere: (4, b) centres and radii of spheres around them in the view.
    """

    item: Ints
    corners: Floats
    offsets: Ints
    shown: Ints
    first: Ints
    sphere: Floats

    def __len__(self) -> int:
        return len(self.item)


def outlined_items(view: View, projected: ProjectedFaces) -> Bools:
    """(i,) the items that are convex bodies with an outline in the image: closed, and not through the near plane."""
    solid = solid_items(view, projected)
    solid[view.face_item[~np.isfinite(projected.nearest) | (projected.box[1] >= EVERYWHERE)]] = False
    return solid


def convex_bodies(view: View, faces: ImageFaces, items: Ints) -> Bodies:
    """Closed convex items as bodies, with their outlines and the spheres around them.

    Parameters
    ----------
    view : View
        What is seen.
    faces : ImageFaces
        Of the whole scene, those that can be seen.
    items : (b,) array of int
        Closed convex items.

    Returns
    -------
    Bodies
        Left out are bodies whose outline is, by rounding, not one closed polygon.

    Notes
    -----
    Source: Glaeser, sections 5.5 and 6.1.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import visibility
    >>> from vectorplot.geometry import box
    >>> from vectorplot.scene import look
    >>> view = look(vp.Scene((vp.Item("cube", box((2, 2, 2))),)), vp.Camera.view("top"))
    >>> bodies = visibility.convex_bodies(view, visibility.painters_order(view).faces, np.array([0]))
    >>> sorted(bodies.corners.T.tolist()), bodies.sphere[3].round(6).tolist()
    ([[0.0, 0.0], [0.0, 2.0], [2.0, 0.0], [2.0, 2.0]], [1.732051])
    """
    number = np.full(len(view.item_vertices) - 1, -1, dtype=np.intp)
    number[items] = np.arange(len(items))
    owner = number[view.face_item[faces.source]]
    shown = np.flatnonzero(owner >= 0)
    shown = shown[np.argsort(owner[shown], kind="stable")]
    corner, sizes = _outlines(view, number, len(items), faces.source[shown])
    kept = np.flatnonzero(sizes >= 3)
    listed = np.isin(owner[shown], kept)
    counts = np.bincount(owner[shown[listed]], minlength=len(items))[kept]
    return Bodies(
        items[kept],
        view.image[:, corner],
        ragged.offsets(sizes[kept]),
        shown[listed],
        ragged.offsets(counts),
        _spheres(view, items[kept]),
    )


def _outlines(view: View, number: Ints, count: int, shown: Ints) -> tuple[Ints, Ints]:
    """The vertices (c,) of the outlines one after the other, and (count,) how many each has; 0 for a body without a
    closed outline.

    The sides of an outline are those of shown faces that no other shown face shares. All outlines are walked along at
    once, a step at a time.
    """
    position, _ = ragged.take(view.offsets, shown)
    single = view.only_sides(position)
    start, end = view.corners[position[single]], view.corners[view.after(position[single])]
    owner = np.repeat(number[view.face_item[shown]], view.face_sizes[shown])[single]
    sides = np.bincount(owner, minlength=count)
    following = np.full(view.points.shape[1], -1, dtype=np.intp)
    following[start] = end
    first = np.full(count, -1, dtype=np.intp)
    first[owner[::-1]] = start[::-1]
    walking = np.flatnonzero(first >= 0)
    here = first.copy()
    steps: list[tuple[Ints, Ints]] = []
    closed_after = np.zeros(count, dtype=np.intp)
    for step in range(1, int(sides.max(initial=0)) + 1):
        steps.append((walking, here[walking]))
        here[walking] = following[here[walking]]
        home = here[walking] == first[walking]
        closed_after[walking[home]] = step
        walking = walking[~home & (here[walking] >= 0)]
    sizes = np.where((closed_after == sides) & (sides >= 3), sides, 0)
    body = np.concatenate([s[0] for s in steps] or [walking])
    vertex = np.concatenate([s[1] for s in steps] or [walking])
    order = np.argsort(body, kind="stable")
    order = order[sizes[body[order]] > 0]
    return vertex[order], sizes


def _spheres(view: View, items: Ints) -> Floats:
    """(4,n) middle of the box of each item's vertices, and the distance of the farthest one."""
    vertex, offsets = ragged.take(view.item_vertices, items)
    if not len(items):
        return np.zeros((4, 0))
    points = view.points[:, vertex]
    sizes = np.diff(offsets)
    low, high = (extreme.reduceat(points, offsets[:-1], axis=1) for extreme in (np.minimum, np.maximum))
    centre = (low + high) / 2.0
    arm = points - np.repeat(centre, sizes, axis=1)
    radius = np.sqrt(np.maximum.reduceat((arm * arm).sum(axis=0), offsets[:-1]))
    return np.concatenate([centre, radius[None]])


def spheres_apart(bodies: Bodies, first: Ints, second: Ints) -> Bools:
    """(p,) which pairs have spheres without common points: these bodies do not pierce each other.

    Source: Glaeser, section 5.5, figure 9 (soap bubbles).
    """
    one, two = bodies.sphere[:, first], bodies.sphere[:, second]
    arm, reach = one[:3] - two[:3], one[3] + two[3]
    return np.asarray((arm * arm).sum(axis=0) > reach * reach, dtype=np.bool_)


def faces_between(view: View, faces: ImageFaces, bodies: Bodies, nearer: Ints, farther: Ints) -> Bools:
    """(p,) which pairs have a plane of a face that the farther body shows with all of the nearer one beyond it.

    Source: Glaeser, section 5.8 (separating planes); erratum G5-07.
    """
    counts = bodies.first[farther + 1] - bodies.first[farther]
    pair = ragged.owner(counts)
    position, _ = ragged.take(bodies.first, farther)
    face = faces.source[bodies.shown[position]]
    normal, _, first = newell(view, face)
    length = np.sqrt((normal * normal).sum(axis=0))
    normal /= np.where(length > 0.0, length, 1.0)
    vertex, ends = ragged.take(view.item_vertices, bodies.item[nearer[pair]])
    plane = ragged.owner(np.diff(ends))
    arm = view.points[:, vertex] - view.points[:, first[plane]]
    height = (arm * normal[:, plane]).sum(axis=0)
    beyond = (
        np.ones(len(pair), dtype=np.bool_)
        if not len(pair)
        else np.minimum.reduceat(height, ends[:-1]) >= -view.tolerance
    )
    result = np.zeros(len(nearer), dtype=np.bool_)
    result[pair[beyond]] = True
    return result


# How far smooth surfaces bulge over the triangles in their place: of two that touch, triangles pierce each other.

TURNED = 0.5
"""Triangles with a corner at which the surface makes an angle with a larger cosine than this with them have a bulge."""

TRUSTED = 0.3
"""By this part of itself a bulge may be off: it is known by its second derivatives only."""


CONSTANT, ALONG_X, ALONG_Y, SQUARE_X, PRODUCT, SQUARE_Y, SHARE, SHARE_X, SHARE_Y, MOST, TURN, ITEM = range(12)
"""The rows of ImageFaces.bulges: a quadratic function over a linear one of what x and y are more than those of planes;
how much it is at most; the largest angle between normals of the surface and of the face; and the item."""


def with_bulges(view: View, faces: ImageFaces, normals: Floats) -> ImageFaces:
    """Faces in the image that know how far the surfaces in whose place they are bulge over them. normals (3,c): of
    these at the corners of the faces of the view, 0 where there are none.

    Between two corners a surface is taken for the cubic in its tangent planes there, and within a triangle for the
    quadratic function with the same heights in the middles of its sides, or at an apex for a cone.
    Source: Vlachos, Peters, Boyd, Mitchell, Curved PN triangles (2001), boundary curves.
    """
    bulges = np.zeros((ITEM + 1, len(faces)))
    bulges[SHARE] = 1.0
    bulges[ITEM] = view.face_item[faces.source]
    own = np.flatnonzero(view.face_sizes[faces.source] == 3)
    position = view.offsets[faces.source[own]] + np.arange(3)[:, None]
    known = (dot(normals, normals)[position] > 0.0).any(axis=0)
    kept = np.flatnonzero(known & (view.depth[view.corners[position]] > view.near).all(axis=0))
    own, position = own[kept], position[:, kept]
    if not len(own):
        return replace(faces, bulges=bulges)
    points = view.points[:, view.corners[position]]
    places = image_points(view, points.reshape(3, -1)).reshape(points.shape)
    tilted = _in_image(view, points, normals[:, position])
    sides = np.roll(places, -1, axis=1) - places
    area = cross(sides[:, 0], sides[:, 1])
    # At an apex a surface has no normal: it goes on straight from there.
    apex = ~(tilted != 0.0).any(axis=0)
    tilted = np.where(apex, area[:, None], tilted)
    upright = dot(tilted, area[:, None])
    size = np.sqrt(dot(tilted, tilted) * dot(area, area))
    after = np.roll(upright, -1, axis=0)
    safe = (np.abs(upright) > TURNED * size).all(axis=0) & (area[2] != 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        rises, falls = -dot(tilted, sides) / upright, -dot(np.roll(tilted, -1, axis=1), sides) / after
        middle = (rises - falls) / 8.0 * (dot(area, area) / area[2])
    middle = np.where(safe & ~apex & ~np.roll(apex, -1, axis=0), middle, 0.0)
    x0, y0 = faces.planes[:2, own]
    weights = np.zeros((3, 3, len(own)))
    for k in range(3):
        # The side across from a corner bounds where its weight is 0.
        x, y, _ = places[:, (k + 1) % 3]
        along = sides[:, (k + 1) % 3]
        with np.errstate(divide="ignore", invalid="ignore"):
            weights[1, k], weights[2, k] = -along[1] / area[2], along[0] / area[2]
        weights[0, k] = weights[1, k] * (x0 - x) + weights[2, k] * (y0 - y)
    for k in range(3):
        (a, b, c), (d, e, f) = weights[:, k], weights[:, (k + 1) % 3]
        product = np.stack([a * d, a * e + b * d, a * f + c * d, b * e, b * f + c * e, c * f])
        bulges[:SHARE, own] += np.where(safe, 4.0 * middle[k] * product, 0.0)
        straight = np.flatnonzero(apex[k])
        bulges[SHARE:MOST, own[straight]] -= weights[:, k, straight]
    bulges[MOST, own] = np.abs(middle).max(axis=0)
    bulges[TURN, own] = arccos(np.minimum(np.abs(upright) / np.where(size > 0.0, size, 1.0), 1.0)).max(axis=0)
    return replace(faces, bulges=bulges)


def bulge(faces: ImageFaces, face: Ints, x: Floats, y: Floats) -> Floats:
    """(..., p) how far above faces (p,) surfaces are at points x, y (..., p) of the image."""
    assert faces.bulges is not None
    one, right, up, square_x, product, square_y, *share = faces.bulges[:MOST, face]
    x, y = x - faces.planes[0, face], y - faces.planes[1, face]
    height = one + right * x + up * y + square_x * x * x + product * x * y + square_y * y * y
    return np.asarray(height / np.maximum(share[0] + share[1] * x + share[2] * y, AT_APEX))


def may_touch(faces: ImageFaces, first: Ints, second: Ints) -> tuple[Floats, Bools]:
    """(p,) how far surfaces may bulge over pairs of faces at most, and which pairs are of different items whose
    surfaces are parallel somewhere, as far as the turns of their normals tell: others cross if they meet."""
    assert faces.bulges is not None
    most, turn = (faces.bulges[row, first] + faces.bulges[row, second] for row in (MOST, TURN))
    one, two = (
        np.stack([-faces.planes[3, face], -faces.planes[4, face], np.ones(len(face))]) for face in (first, second)
    )
    cosine = dot(one, two) / np.sqrt(dot(one, one) * dot(two, two))
    near = arccos(np.clip(cosine, -1.0, 1.0)) <= turn
    return most, np.asarray(near & (most > 0.0) & (faces.bulges[ITEM, first] != faces.bulges[ITEM, second]))


def _in_image(view: View, points: Floats, normals: Floats) -> Floats:
    """(3,3,n) normals of the images of planes through points of a view with normals (3,3,n), as in image_points."""
    if view.eye is None:
        return normals
    eye = np.array([view.eye[0], view.eye[1], view.eye[2] - view.focus])
    found = normals.copy()
    found[2] += dot(normals, eye[:, None, None] - points) / view.focus
    return found


# Convex outlines in the image, and which of them overlap.

SIZES = np.array([3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 512, 1024, 4096, 1 << 16, 1 << 20])
"""Outlines are held in tables by their number of corners, rounded up to one of these."""

PAIRS_AT_ONCE = 1 << 16
"""Pairs handled at once: few enough for the processor's cache."""


@dataclass(frozen=True, eq=False)
class Table:
    """Outlines of up to k corners, the last one repeated: x, y (k,m), and the lines through corner and next corner, in
    unit normals and constants (k,m), positive inside. Sides shorter than the tolerance are no lines: positive
    everywhere."""

    x: Floats
    y: Floats
    normal_x: Floats
    normal_y: Floats
    constant: Floats

    def distances(self, side: int, row: Ints, x: Floats, y: Floats) -> Floats:
        """(...,p) distances of points (...,p) from one side of each of the outlines row (p,)."""
        result = self.normal_x[side, row] * x
        result += self.normal_y[side, row] * y
        result += self.constant[side, row]
        return np.asarray(result)

    def __len__(self) -> int:
        return len(self.x)


@dataclass(frozen=True, eq=False)
class Outlines:
    """Convex outlines, counter-clockwise, in tables: outline i is row[i] of tables[table[i]]."""

    table: Ints
    row: Ints
    tables: tuple[Table, ...]

    def __len__(self) -> int:
        return len(self.table)

    @classmethod
    def of(cls, points: Floats, offsets: Ints, tolerance: float) -> Outlines:
        """The outlines with the corners (2 or more, c)."""
        sizes = np.diff(offsets)
        rung = np.searchsorted(SIZES, sizes)
        used, table = np.unique(rung, return_inverse=True)
        row = np.empty(len(sizes), dtype=np.intp)
        tables = []
        for number, size in enumerate(SIZES[used].tolist()):
            members = np.flatnonzero(table == number)
            row[members] = np.arange(len(members))
            longest = min(size, int(sizes[members].max()))
            corner = offsets[members] + np.minimum(np.arange(longest)[:, None], sizes[members] - 1)
            tables.append(_table(points[0, corner], points[1, corner], tolerance))
        return cls(table, row, tuple(tables))

    def groups(self, first: Ints, second: Ints) -> Iterator[tuple[Table, Ints, Table, Ints, Ints]]:
        """Pairs of outlines by their tables and in handy numbers: table and rows of the first, of the second, and
        which pairs these are."""
        key = self.table[first] * len(self.tables) + self.table[second]
        for number in np.unique(key).tolist():
            same = np.flatnonzero(key == number) if len(self.tables) > 1 else np.arange(len(key))
            one, two = self.tables[number // len(self.tables)], self.tables[number % len(self.tables)]
            step = max(PAIRS_AT_ONCE * 16 // (len(one) * len(two)), 1)
            for low in range(0, len(same), step):
                part = same[low : low + step]
                yield one, self.row[first[part]], two, self.row[second[part]], part


def _table(x: Floats, y: Floats, tolerance: float) -> Table:
    along_x, along_y = np.roll(x, -1, axis=0) - x, np.roll(y, -1, axis=0) - y
    length = np.hypot(along_x, along_y)
    is_line = length > tolerance
    length = np.where(is_line, length, 1.0)
    normal_x, normal_y = np.where(is_line, -along_y / length, 0.0), np.where(is_line, along_x / length, 0.0)
    constant = np.where(is_line, -(normal_x * x + normal_y * y), 1.0)
    return Table(x, y, normal_x, normal_y, constant)


def overlapping(outlines: Outlines, first: Ints, second: Ints, tolerance: float) -> Bools:
    """(p,) which pairs of outlines overlap by more than a tolerance in every direction.

    Source: separating axes; of two convex polygons that do not overlap one side of one of them separates them.
    """
    result = np.zeros(len(first), dtype=np.bool_)
    for one, row, two, other, part in in_turn(outlines.groups(first, second)):
        near = np.flatnonzero(~_kept_apart(one, row, two, other, tolerance))
        result[part[near]] = ~_kept_apart(two, other[near], one, row[near], tolerance)
    return result


def _kept_apart(one: Table, row: Ints, two: Table, other: Ints, tolerance: float) -> Bools:
    """(p,) whether a side of the first outlines has the second ones on its outer side."""
    x, y = two.x[:, other], two.y[:, other]
    apart = np.zeros(len(row), dtype=np.bool_)
    for side in in_turn(range(len(one))):
        apart |= one.distances(side, row, x, y).max(axis=0) <= tolerance
    return apart


def common_points(
    one: Table, row: Ints, two: Table, other: Ints, tolerance: float
) -> Iterator[tuple[Floats, Floats, Bools]]:
    """The corners of the common parts of pairs of outlines, in several batches: x, y and whether they are there (k,p).

    They are the corners of each that lie in the other, and the points where sides cross.
    """
    x, y = one.x[:, row], one.y[:, row]
    u, v = two.x[:, other], two.y[:, other]
    of_first = [two.distances(side, other, x, y) for side in range(len(two))]
    of_second = [one.distances(side, row, u, v) for side in range(len(one))]
    yield x, y, np.logical_and.reduce([d >= -tolerance for d in of_first])
    yield u, v, np.logical_and.reduce([d >= -tolerance for d in of_second])
    for k in range(len(one)):
        after = (k + 1) % len(one)
        height = of_second[k]
        crossed = (height > 0.0) != (np.roll(height, -1, axis=0) > 0.0)
        start, end = (np.stack([d[at] for d in of_first]) for at in (k, after))
        crossed &= (start > 0.0) != (end > 0.0)
        share = start / np.where(crossed, start - end, 1.0)
        yield x[k] + share * (x[after] - x[k]), y[k] + share * (y[after] - y[k]), crossed


# Which of two faces is in front of the other where their images overlap.

Codes = NDArray[np.int8]

APART, IN_FRONT, BEHIND, STRADDLING, COPLANAR = 0, 1, 2, 3, 4
"""What the first face of a pair does to the second one: nothing, hides it, is hidden by it, both in parts, or lies in
its plane."""

ON_OUTLINE = 0.125
"""A corner counts as inside an outline up to so many tolerances beyond it: far less than what counts in height."""


def face_relations(faces: ImageFaces, first: Ints, second: Ints, tolerance: float) -> Codes:
    """(p,) codes for pairs of faces.

    Both planes are compared at all corners of the common part of the images; their difference is linear, so these tell
    all. A difference counts from a tolerance on, measured across the planes rather than in height. Of faces that stand
    for surfaces of different items that may touch there, these are compared, as far as their bulges are known.
    Source: Glaeser, section 5.5 (intersection of outlines); errata G5-02, G6-06.
    """
    may_stop()
    codes = np.zeros(len(first), dtype=np.int8)
    if not len(first):
        return codes
    named = np.zeros(len(faces), dtype=np.bool_)
    named[first] = named[second] = True
    if not named.all():
        number = np.cumsum(named) - 1
        return face_relations(faces.take(np.flatnonzero(named)), number[first], number[second], tolerance)
    outlines = Outlines.of(faces.points, faces.offsets, tolerance)
    common = np.flatnonzero(overlapping(outlines, first, second, tolerance))
    first, second = first[common], second[common]
    least, most = _span(faces, outlines, first, second, tolerance, False)
    limit = tolerance * np.maximum(faces.steepness[first], faces.steepness[second])
    found = _codes(least, most, limit)
    if faces.bulges is not None:
        reach, curved = may_touch(faces, first, second)
        near = np.flatnonzero(curved & (least <= most) & (least < reach) & (most > -reach))
        span = _span(faces, outlines, first[near], second[near], tolerance, True)
        found[near] = _curved_codes(*span, limit[near] + TRUSTED * reach[near], found[near])
    codes[common] = found
    return codes


def _span(
    faces: ImageFaces, outlines: Outlines, first: Ints, second: Ints, tolerance: float, curved: bool
) -> tuple[Floats, Floats]:
    """The least and the largest height (p,) of faces above others where their images overlap; curved: of the surfaces
    that they stand for."""
    least, most = np.full(len(first), np.inf), np.full(len(first), -np.inf)
    for one, row, two, other, part in in_turn(outlines.groups(first, second)):
        a, b = first[part], second[part]
        for x, y, there in common_points(one, row, two, other, ON_OUTLINE * tolerance):
            above = faces.heights(a, x, y) - faces.heights(b, x, y)
            if curved:
                above += bulge(faces, a, x, y) - bulge(faces, b, x, y)
            least[part] = np.minimum(least[part], np.where(there, above, np.inf).min(axis=0))
            most[part] = np.maximum(most[part], np.where(there, above, -np.inf).max(axis=0))
    return least, most


def _curved_codes(least: Floats, most: Floats, limit: Floats, flat: Codes) -> Codes:
    """(p,) the codes of faces of surfaces that bulge over them, of which flat are those of the faces: where surfaces
    are on one side of each other, or touch, so are faces, wherever these pierce each other."""
    pierce = (most > limit) & (least < -limit)
    return np.where(pierce, flat, np.where(most > -least, IN_FRONT, BEHIND)).astype(np.int8)


def _codes(least: Floats, most: Floats, limit: Floats) -> Codes:
    above, below = most > limit, least < -limit
    return np.select(
        [above & below, above, below, most < least],
        [STRADDLING, IN_FRONT, BEHIND, APART],
        COPLANAR,
    ).astype(np.int8)


def drawn_before(faces: ImageFaces, first: Ints, second: Ints, codes: Codes) -> tuple[Ints, Ints]:
    """The pairs as demands on the order: (k,) faces to be drawn before the others (k,).

    Faces that pierce each other make both demands; of faces in one plane that of lower rank goes first.
    """
    level = codes == COPLANAR
    lower = faces.rank[first] < faces.rank[second]
    first_later = (codes == IN_FRONT) | (codes == STRADDLING) | (level & ~lower)
    second_later = (codes == BEHIND) | (codes == STRADDLING) | (level & lower)
    before = np.concatenate([second[first_later], first[second_later]])
    after = np.concatenate([first[first_later], second[second_later]])
    return before, after


# Which of two convex bodies is in front of the other, decided in one point where that suffices.

UNDECIDED = 5
"""The code of two bodies that may pierce each other, as far as spheres and planes of faces can tell."""


def body_relations(view: View, faces: ImageFaces, bodies: Bodies, first: Ints, second: Ints) -> Codes:
    """(p,) codes for pairs of convex bodies: of face_relations, or UNDECIDED.

    Of bodies that do not pierce each other the one that is nearer in one common point of the images is nearer in all.
    That point is found on the line between the centres, or in the middle of the common part of the outlines.
    Source: Glaeser, section 5.5 (chord test, soap bubbles, separating planes).
    """
    codes = np.zeros(len(first), dtype=np.int8)
    outlines = Outlines.of(bodies.corners, bodies.offsets, view.tolerance)
    x, y, found = _on_chord(outlines, bodies, first, second, view.tolerance)
    others = np.flatnonzero(~found)
    others = others[overlapping(outlines, first[others], second[others], view.tolerance)]
    x[others], y[others] = _middles(outlines, first[others], second[others], view.tolerance)
    common = np.concatenate([np.flatnonzero(found), others])
    a, b = first[common], second[common]
    height, limit = _front_height(faces, bodies, a, x[common], y[common])
    other_height, other_limit = _front_height(faces, bodies, b, x[common], y[common])
    above = height - other_height
    clear = np.abs(above) > view.tolerance * np.maximum(limit, other_limit)
    code = np.where(clear, np.where(above > 0.0, IN_FRONT, BEHIND), UNDECIDED)
    near = np.flatnonzero(clear & ~spheres_apart(bodies, a, b))
    nearer = np.where(code[near] == IN_FRONT, a[near], b[near])
    farther = np.where(code[near] == IN_FRONT, b[near], a[near])
    code[near[~faces_between(view, faces, bodies, nearer, farther)]] = UNDECIDED
    codes[common] = code
    return codes


def _on_chord(
    outlines: Outlines, bodies: Bodies, first: Ints, second: Ints, tolerance: float
) -> tuple[Floats, Floats, Bools]:
    """A common point of both outlines on the line between their centres: x, y (p,), and whether there is one.

    Source: Glaeser, section 5.5 (chord test).
    """
    x, y = np.zeros((2, len(first)))
    found = np.zeros(len(first), dtype=np.bool_)
    centre = np.add.reduceat(bodies.corners, bodies.offsets[:-1], axis=1) / np.diff(bodies.offsets)
    for one, row, two, other, part in in_turn(outlines.groups(first, second)):
        start, end = centre[:, first[part]], centre[:, second[part]]
        leaves = 1.0 - _part_beyond(one, row, end, start)
        enters = _part_beyond(two, other, start, end)
        length = np.hypot(*(end - start))
        found[part] = (leaves - enters) * length > tolerance
        found[part] |= (length <= tolerance) & (leaves > enters)
        x[part], y[part] = start + (leaves + enters) / 2.0 * (end - start)
    return x, y, found


def _part_beyond(table: Table, row: Ints, outer: Floats, inner: Floats) -> Floats:
    """(p,) the parameter at which segments outer -> inner (2,p) enter outlines; inner is inside. 0: outer is too."""
    enters = np.zeros(len(row))
    for side in range(len(table)):
        start = table.distances(side, row, outer[0], outer[1])
        end = table.distances(side, row, inner[0], inner[1])
        crossing = start < 0.0
        enters = np.maximum(enters, np.where(crossing, start / np.where(crossing, start - np.abs(end), 1.0), 0.0))
    return enters


def _middles(outlines: Outlines, first: Ints, second: Ints, tolerance: float) -> tuple[Floats, Floats]:
    """Points (p,) inside the common part of pairs of outlines that overlap: the means of its corners."""
    x, y, count = np.zeros((3, len(first)))
    for one, row, two, other, part in in_turn(outlines.groups(first, second)):
        for u, v, there in common_points(one, row, two, other, ON_OUTLINE * tolerance):
            x[part] += np.where(there, u, 0.0).sum(axis=0)
            y[part] += np.where(there, v, 0.0).sum(axis=0)
            count[part] += there.sum(axis=0)
    count = np.maximum(count, 1.0)
    return x / count, y / count


def _front_height(faces: ImageFaces, bodies: Bodies, which: Ints, x: Floats, y: Floats) -> tuple[Floats, Floats]:
    """Heights of the fronts of bodies above points of the image, and the steepness of the face met there."""
    lowest, steepness = np.full(len(which), np.inf), np.ones(len(which))
    counts = np.diff(bodies.first)[which]
    left = np.arange(len(which))
    for step in range(int(counts.max(initial=0))):
        left = left[counts[left] > step]
        face = bodies.shown[bodies.first[which[left]] + step]
        height = faces.heights(face, x[left], y[left])
        lower = height < lowest[left]
        lowest[left] = np.where(lower, height, lowest[left])
        steepness[left] = np.where(lower, faces.steepness[face], steepness[left])
    return lowest, steepness


# Which boxes overlap in the image: what has to be compared at all.

QUERIES_AT_ONCE = 1 << 15
"""Boxes looked up in the tree at once: their partners are handled before the next ones are looked up."""

FIRST_QUERIES = 1 << 10
"""So many are looked up first, to learn how many partners a box has."""

PARTNERS_AT_ONCE = 1 << 23
"""About so many partners are found at once: where everything lies on everything they would fill the memory."""

PAIRS_AT_MOST = 1 << 25
"""So many pairs may be found at once, half a gigabyte, and no more."""

LOT = 1 << 18
"""Pairs that are few are handed on together, up to about so many: each batch asks anew what its faces are like."""


def box_pairs(box: Floats, tolerance: float) -> Iterator[tuple[Ints, Ints]]:
    """Pairs of boxes, smallest and largest x and y (4 or more, n), that overlap by more than a tolerance; each pair
    once, the smaller number first, in batches."""
    for first, second in boxes_over(box, box, tolerance):
        once = first < second
        yield first[once], second[once]


def pairs_across(box: Floats, field: Ints, tolerance: float) -> Iterator[tuple[Ints, Ints]]:
    """The pairs of box_pairs, but for those of boxes of one field.

    field (n,): a number for each box, -1 for those that make pairs with all.
    """
    yield from _together(_pairs_across(box, field, tolerance))


def _pairs_across(box: Floats, field: Ints, tolerance: float) -> Iterator[tuple[Ints, Ints]]:
    """As pairs_across, field by field."""
    loose = np.flatnonzero(field < 0)
    for first, second in box_pairs(box[:, loose], tolerance):
        yield loose[first], loose[second]
    left, right, bottom, top = box[:4]
    for number in np.unique(field[field >= 0]).tolist():
        own = np.flatnonzero(field == number)
        near = (field < number) & (left < right[own].max()) & (right > left[own].min())
        others = np.flatnonzero(near & (bottom < top[own].max()) & (top > bottom[own].min()))
        for first, second in boxes_over(box[:, others], box[:, own], tolerance):
            one, two = others[first], own[second]
            yield np.minimum(one, two), np.maximum(one, two)


def _together(batches: Iterator[tuple[Ints, Ints]]) -> Iterator[tuple[Ints, Ints]]:
    """The pairs of batches, in fewer of them."""
    held: list[tuple[Ints, Ints]] = []
    count = 0
    for batch in batches:
        held.append(batch)
        count += len(batch[0])
        if count >= LOT:
            yield _joined(held)
            held, count = [], 0
    if held:
        yield _joined(held)


def _joined(batches: list[tuple[Ints, Ints]]) -> tuple[Ints, Ints]:
    return np.concatenate([first for first, _ in batches]), np.concatenate([second for _, second in batches])


def boxes_overlap(box: Floats, a: Ints, b: Ints, tolerance: float) -> Bools:
    """(p,) which pairs of boxes (4 or more, n) overlap by more than a tolerance."""
    wide = np.minimum(box[1, a], box[1, b]) - np.maximum(box[0, a], box[0, b]) > tolerance
    tall = np.minimum(box[3, a], box[3, b]) - np.maximum(box[2, a], box[2, b]) > tolerance
    return np.asarray(wide & tall, dtype=np.bool_)


def boxes_over(box: Floats, others: Floats, tolerance: float) -> Iterator[tuple[Ints, Ints]]:
    """Boxes (4 or more, n), in ascending order, with each of the others (4 or more, m) that it overlaps by more than a
    tolerance, in batches.

    Source: Leutenegger, Lopez and Edgington, STR: a simple and efficient algorithm for R-tree packing (1997).
    """
    import shapely

    (left, right, bottom, top), (left_2, right_2, bottom_2, top_2) = box[:4], others[:4]
    if not len(left) or not len(left_2):
        return
    # Of what lies in a tree only the bounds count: a diagonal has those of its rectangle, and is made sooner.
    diagonals = shapely.linestrings(np.stack([left, bottom, right, top], axis=1).reshape(-1, 2, 2))
    if others is box:
        diagonals_2 = diagonals
    else:
        diagonals_2 = shapely.linestrings(np.stack([left_2, bottom_2, right_2, top_2], axis=1).reshape(-1, 2, 2))
    may_stop()
    tree = shapely.STRtree(diagonals_2, node_capacity=16)
    # Even where all that is looked up lies on all the others, after much that does not.
    most = int(np.clip(PAIRS_AT_MOST // len(left_2), 1, QUERIES_AT_ONCE))
    low, step = 0, min(most, FIRST_QUERIES)
    while low < len(left):
        may_stop()
        first, second = tree.query(diagonals[low : low + step])
        first = first + low
        wide = np.minimum(right[first], right_2[second]) - np.maximum(left[first], left_2[second]) > tolerance
        wide &= np.minimum(top[first], top_2[second]) - np.maximum(bottom[first], bottom_2[second]) > tolerance
        low += step
        step = int(np.clip(PARTNERS_AT_ONCE * step // max(len(first), 1), 1, most))
        yield first[wide], second[wide]


def boxes_of_items(box: Floats, item: Ints, count: int) -> Floats:
    """(4,count) the boxes around all boxes (4 or more, n) of each item (n,); of items without any, inside out."""
    found = np.tile(np.array([[np.inf], [-np.inf]]), (2, count))
    for row in range(4):
        (np.maximum if row % 2 else np.minimum).at(found[row], item, box[row])
    return found

"""Water on a terrain, where it runs, parts and gathers; places by x and y; and where labels fit on level lines."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import positive
from vectorplot.errors import InputError
from vectorplot.features.curve_tracing import SurfaceCurves
from vectorplot.features.mesh_integration import mesh_integral_curves
from vectorplot.features.mesh_lines import NO_FACE, MeshCurves, all_mesh_curves
from vectorplot.features.tangent_fields import SteepestSlope, TurnedField
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import TRIANGLE, Mesh
from vectorplot.geometry.polylines import closed_round
from vectorplot.geometry.vectors import cross, greatest_component, least_component
from vectorplot.geometry.winding import edge_uses
from vectorplot.tolerances import LEAST_DIVISOR, ZERO_OF_EXTENT

# Places of a terrain by their x and y: in which triangles they are, and how high.


def places_on_terrain(mesh: Mesh, places: ArrayLike, what: str = "terrain") -> tuple[Ints, Floats]:
    """Where the vertical lines through given places meet a terrain.

    places: (k, 2) x and y.
    """
    given = np.atleast_2d(np.asarray(places, dtype=np.float64))
    if given.ndim != 2 or given.shape[1] != 2 or not np.isfinite(given).all():
        raise InputError(f"{what}: expected places of two finite numbers, x and y")
    if (np.diff(mesh.offsets) != TRIANGLE).any():
        raise InputError(f"{what}: expected a terrain, a mesh of triangles")
    face, found = Ground(mesh).below(given)
    if (face < 0).any():
        bad = given[int((face < 0).argmax())]
        raise InputError(f"{what}: {bad[0]:g} {bad[1]:g} is not on the terrain")
    return face, found


@dataclass(frozen=True, eq=False)
class Ground:
    """The triangles of a terrain, to be asked again and again what lies above or below places."""

    mesh: Mesh

    def below(self, places: Floats) -> tuple[Ints, Floats]:
        """(k,) the triangles in which places (k,2) are, and (k,3) the points there; -1 and NaN heights beside the
        terrain."""
        from shapely import points

        at = places - self._centre[:2]
        place, face = self._tree.query(points(at), predicate="dwithin", distance=self._slack)
        corners = self._corners[face]
        weights = _weights(corners[..., :2], at[place])
        inside = weights.min(axis=1)
        best = np.lexsort((-inside, place))
        counts = np.bincount(place, minlength=len(at))
        # One of each place that has some.
        first = best[ragged.starts(counts)[counts > 0]]
        size = np.sqrt(np.abs(_area(corners[first, :, :2])))
        first = first[inside[first] >= -self._slack / np.maximum(size, LEAST_DIVISOR)]
        result, height = np.full(len(at), -1, dtype=np.intp), np.full(len(at), np.nan)
        result[place[first]] = face[first]
        height[place[first]] = np.einsum("ij,ij->i", np.maximum(weights[first], 0.0), corners[first, :, 2])
        return result, np.column_stack([places, height + self._centre[2]])

    def near(self, plan: Floats) -> tuple[Ints, Ints]:
        """The segments and the triangles, pair by pair, of a line (k,2) of the plan whose boxes meet."""
        from shapely import linestrings

        line = plan - self._centre[:2]
        segment, face = self._tree.query(linestrings(np.stack([line[:-1], line[1:]], axis=1)))
        return segment, face

    @cached_property
    def _centre(self) -> Floats:
        """About the middle of the terrain: places may be far from the origin."""
        return np.asarray(self.mesh.bounds.mean(axis=0))

    @cached_property
    def _corners(self) -> Floats:
        return np.asarray((self.mesh.vertices - self._centre)[self.mesh.corners].reshape(-1, TRIANGLE, 3))

    @cached_property
    def _slack(self) -> float:
        return ZERO_OF_EXTENT * float(np.ptp(self.mesh.bounds, axis=0).max())

    @cached_property
    def _tree(self) -> Any:
        from shapely import STRtree, box

        x, y = self._corners[..., 0], self._corners[..., 1]
        return STRtree(box(least_component(x), least_component(y), greatest_component(x), greatest_component(y)))


def _area(triangles: Floats) -> Floats:
    """(n,) twice the areas of triangles (n,3,2), with signs."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    one, two = b - a, c - a
    return cross(one, two)


def _weights(triangles: Floats, at: Floats) -> Floats:
    """(n,3) barycentric coordinates; -1 in triangles without an area."""
    whole = _area(triangles)
    parts = np.stack(
        [_area(np.stack([at, triangles[:, (k + 1) % 3], triangles[:, (k + 2) % 3]], axis=1)) for k in range(3)], axis=1
    )
    flat = np.abs(whole) <= LEAST_DIVISOR
    return np.asarray(np.where(flat[:, None], -1.0, parts / np.where(flat, 1.0, whole)[:, None]))


# Water on a terrain: where it runs, what parts it, and where it gathers.

UPHILL = SteepestSlope()
DOWNHILL = TurnedField(UPHILL, np.pi)

NO_BASIN = -1
"""The basin of a hole."""


def water_courses(mesh: Mesh, places: ArrayLike, *, length: float | None = None) -> MeshCurves:
    """The ways of water on a terrain from given places, down where it is steepest.

    Parameters
    ----------
    mesh : Mesh
        Of triangles, none above another.
    places : (k, 2) array_like of float
        x and y of the sources.
    length : float, optional
        How long they are at most; ten times the extent of the terrain where None.

    Returns
    -------
    MeshCurves
        With the number of the source as level. Steepest in every triangle; in valleys they follow the edges, and where
        they meet they are one from there on. They end in pits, on plains, and at borders.

    Raises
    ------
    InputError
        For places beside the terrain.

    Notes
    -----
    Edge cases: no course from a place on a plain.

    Source: Glaeser, sections 9.4 and 9.5, example 1.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, scene, surfaces
    >>> x, y = np.meshgrid(np.arange(9.0), np.arange(9.0), indexing="ij")
    >>> land = scene.terrain_mesh(surfaces.terrain((x - 4) ** 2 + 0.5 * y))
    >>> features.water_courses(land, (6.3, 5.5))[0][-1].tolist()  # into the valley, and out of it
    [4.0, 0.0, 0.0]
    """
    face, points = places_on_terrain(mesh, places, "water")
    return mesh_integral_curves(mesh, DOWNHILL, face, points, length=length, both_ways=False)


def watersheds(mesh: Mesh) -> MeshCurves:
    """The lines on a terrain that part waters: from each saddle one for each rising sector (mostly two), up to summits,
    plains and borders, with the vertex as level. A saddle has ground that rises and falls more than once around it;
    of equal heights the earlier vertex counts as lower, but no line leaves along level ground. A line leaves along
    the steepest edge of the sector and then climbs where it is steepest.
    Source: Cayley, On contour and slope lines (1859); Maxwell, On hills and dales (1870); Banchoff, Critical points and
    curvature for embedded polyhedra (1967). Errors: InputError for faces that are no triangles or lie above others.
    """
    return _from_saddles(mesh, 1.0)


def valley_lines(mesh: Mesh) -> MeshCurves:
    """The lines of a terrain along which waters gather: from the saddles down to the pits.

    mesh: of triangles, none above another; result: see `watersheds`, for the falling ground.
    Source: see `watersheds`.
    Errors: for a mesh of other faces.
    """
    return _from_saddles(mesh, -1.0)


def basins(heights: ArrayLike) -> Ints:
    """To which pit the water of each place of a grid runs.

    Parameters
    ----------
    heights : (m, n) array_like of float
        Those of a Terrain; NaN where there is a hole.

    Returns
    -------
    (m, n) array of int
        The index, row by row, of the pit that is reached by going to the lowest of eight neighbours again and again;
        -1 in holes. A place at the border, or beside a hole, without a lower neighbour is a pit.

    Raises
    ------
    InputError
        For an array that is not (m, n).

    Notes
    -----
    Lowest means steepest, on square cells: diagonal neighbours are farther away. Of places of one height the earlier
    counts as lower.

    Source: O'Callaghan and Mark, The extraction of drainage networks from digital elevation data (1984).

    Examples
    --------
    >>> from vectorplot import features
    >>> features.basins([[3, 2, 3, 2, 1], [3, 1, 4, 2, 0]]).tolist()
    [[6, 6, 6, 9, 9], [6, 6, 6, 9, 9]]
    """
    h = np.array(heights, dtype=np.float64)
    if h.ndim != 2:
        raise InputError("basins: expected rows of heights, all equally long")
    m, n = h.shape
    number = np.arange(h.size, dtype=np.intp).reshape(m, n)
    padded = np.pad(h, 1, constant_values=np.nan)
    steepest, to = np.zeros((m, n)), number.copy()
    for i, j in ((-1, -1), (-1, 0), (-1, 1), (0, -1), (0, 1), (1, -1), (1, 0), (1, 1)):
        other = padded[1 + i : 1 + i + m, 1 + j : 1 + j + n]
        fall = (h - other) / np.hypot(i, j)
        down = (fall > steepest) | ((fall == 0.0) & (steepest == 0.0) & (to == number) & (i * n + j < 0))
        steepest, to = np.where(down, np.maximum(fall, 0.0), steepest), np.where(down, number + i * n + j, to)
    flat = to.ravel()
    # Each round doubles how far everybody looks ahead.
    while True:
        further = flat[flat]
        if (further == flat).all():
            break
        flat = further
    return np.where(np.isnan(h), NO_BASIN, flat.reshape(m, n))


def _from_saddles(mesh: Mesh, sign: float) -> MeshCurves:
    """The lines from saddles into the rising (1) or falling (-1) ground."""
    if (np.diff(mesh.offsets) != TRIANGLE).any():
        raise InputError("watersheds: expected a terrain, a mesh of triangles")
    saddle, towards, face = _branches(mesh, sign)
    if not len(saddle):
        return all_mesh_curves([])
    middle = 0.5 * (mesh.vertices[saddle] + mesh.vertices[towards])
    field = UPHILL if sign > 0.0 else DOWNHILL
    found = mesh_integral_curves(mesh, field, face, middle, both_ways=False)
    return _led_from(found, mesh.vertices[saddle], face, saddle)


def _branches(mesh: Mesh, sign: float) -> tuple[Ints, Ints, Ints]:
    """(k,) saddles, the neighbour of each along which a line leaves it, and a triangle at both."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    count = len(mesh.vertices)
    rank = np.empty(count, dtype=np.intp)
    rank[np.lexsort((np.arange(count), mesh.vertices[:, 2]))] = np.arange(count)
    rank = rank if sign > 0.0 else -rank
    triangles = mesh.corners.reshape(-1, TRIANGLE)
    here = triangles.ravel()
    one, two = np.roll(triangles, -1, axis=1).ravel(), np.roll(triangles, -2, axis=1).ravel()
    above_one, above_two = rank[one] > rank[here], rank[two] > rank[here]
    changes = np.bincount(here, above_one != above_two, count)
    uses = edge_uses(mesh)
    rim = uses.corner[uses.first[uses.count == 1]]
    inner = np.ones(count, dtype=np.bool_)
    inner[mesh.corners[rim]] = inner[mesh.corners[mesh.next_corner[rim]]] = False
    # Around a saddle the ground changes from rising to falling four times, or more.
    row = np.flatnonzero((inner & (changes > 2.0))[here] & (above_one | above_two))
    if not len(row):
        return (np.zeros(0, dtype=np.intp),) * 3
    # Nodes: the rising ends of the edges at saddles; those of one triangle are connected.
    ends = np.stack([here[row] * count + one[row], here[row] * count + two[row]], axis=1)
    rising = np.stack([above_one[row], above_two[row]], axis=1)
    key, node = np.unique(ends[rising], return_inverse=True)
    both = rising.all(axis=1)
    pair = np.searchsorted(key, ends[both])
    graph = coo_array((np.ones(len(pair)), (pair[:, 0], pair[:, 1])), shape=(len(key), len(key)))
    _, part = connected_components(graph, directed=False)
    saddle, neighbour = key // count, key % count
    way = mesh.vertices[neighbour] - mesh.vertices[saddle]
    steep = sign * way[:, 2] / np.hypot(way[:, 0], way[:, 1])
    order = np.lexsort((-steep, part))
    chosen = order[ragged.starts(np.bincount(part))]
    # On a plain the order of the vertices makes saddles where there are none.
    chosen = chosen[steep[chosen] > 0.0]
    owner = np.repeat(row // TRIANGLE, 2).reshape(-1, 2)[rising]
    face = np.zeros(len(key), dtype=np.intp)
    face[node] = owner
    return saddle[chosen], neighbour[chosen], face[chosen]


def _led_from(found: MeshCurves, starts: Floats, face: Ints, level: Ints) -> MeshCurves:
    """The curves, whose levels are the numbers of their starts (k,3), led from these; those that are nothing but the
    way there too."""
    number = found.levels.astype(np.intp)
    sizes = np.diff(found.offsets)
    closed = np.zeros(len(found), dtype=np.bool_)
    first = found.offsets[:-1]
    points = np.insert(found.points, first, starts[number], axis=0)
    faces = np.insert(found.faces, first, face[number])
    # A curve that closes is led on to where it began.
    points_last = found.points[first]
    ends = np.flatnonzero(found.closed)
    offsets = ragged.offsets(sizes + 1)
    if len(ends):
        at = offsets[ends + 1]
        points, faces = np.insert(points, at, points_last[ends], axis=0), np.insert(faces, at, NO_FACE)
        offsets = ragged.offsets(sizes + 1 + found.closed)
    return MeshCurves(points, offsets, closed, faces, level[number].astype(np.float64))


# Where along level lines labels fit: where they are nearly straight, and away from each other.

PARTS = 8
"""Steps along a label, at whose ends lines are looked at."""

STRAIGHTEST = 0.9
"""Chord over length of the part of a line beside a label, at least."""

PLACES = 3
"""Digits in which parts of lines are compared: none is straighter than another by rounding."""

MOST_LABELS = 10_000
"""Labels at most."""


@dataclass(frozen=True, eq=False)
class LabelPlaces:
    """Places of labels on level lines.

    points: (k, 3) their middles, on the lines, in world coordinates; directions: (k, 3) unit vectors along the lines:
    the higher ground is on the left, at the heads of letters; heights: (k,) the level of the line; straightness: (k,)
    chord over length of the part of the line beside the label, 1 where it is straight.
    """

    points: Floats
    directions: Floats
    heights: Floats
    straightness: Floats


def label_places(curves: MeshCurves | SurfaceCurves, length: float, apart: float) -> LabelPlaces:
    """Where labels fit on level lines: the straightest parts first.

    Parameters
    ----------
    curves : MeshCurves or SurfaceCurves
        Such as `mesh_level_lines` and `level_lines` give.
    length : float
        Of a label, in world units.
    apart : float
        How far the middles of labels are apart, at least.

    Returns
    -------
    LabelPlaces
        None on lines that are shorter than a label, and where they turn too much.

    Raises
    ------
    InputError
        For lengths that are not positive.

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> levels = features.mesh_level_lines(geometry.box((8, 2, 2)), [0.5, 1.0])
    >>> features.label_places(levels, length=1.0, apart=3.0).heights.tolist()
    [0.5, 0.5, 0.5]
    """
    length, apart = positive("labels: length", length), positive("labels: distance", apart)
    middles, directions, straight, owner = _windows(curves, length)
    good = straight >= STRAIGHTEST
    middles, directions, straight, owner = middles[good], directions[good], straight[good], owner[good]
    heights = curves.levels[owner]
    free = np.ones(len(straight), dtype=np.bool_)
    chosen: list[int] = []
    # The straightest of all first; parts alike in the order of the lines.
    for k in np.lexsort((np.arange(len(straight)), -straight.round(PLACES))).tolist():
        if free[k] and len(chosen) < MOST_LABELS:
            chosen.append(k)
            free &= ((middles - middles[k]) ** 2).sum(axis=1) >= apart * apart
    return LabelPlaces(middles[chosen], directions[chosen], heights[chosen], straight[chosen])


def _windows(curves: MeshCurves | SurfaceCurves, length: float) -> tuple[Floats, Floats, Floats, Ints]:
    """Parts of the lines as long as a label: their middles (k,3), directions, chord over length (k,), and lines."""
    rounds = closed_round(curves)
    points, offsets = curves.points[rounds.index], rounds.offsets
    after = ragged.following(offsets)
    last = offsets[1:] - 1
    step = np.sqrt(((points[after] - points) ** 2).sum(axis=1))
    step[last] = 0.0
    # Lengths along all lines, one after the other.
    along = np.concatenate([[0.0], np.cumsum(step)[:-1]])
    begin, whole = along[offsets[:-1]], along[last] - along[offsets[:-1]]
    count = np.maximum(np.floor(PARTS * (whole / length - 1.0)).astype(np.intp) + 1, 0)
    count[whole < length] = 0
    line = ragged.owner(count)
    start = begin[line] + ragged.place(count) * (length / PARTS)
    ends = [_at(points, along, start + share * length, last[line], offsets[line]) for share in (0.0, 0.5, 1.0)]
    chord = ends[2] - ends[0]
    size = np.sqrt((chord**2).sum(axis=1))
    return ends[1], chord / np.where(size > 0.0, size, 1.0)[:, None], size / length, line


def _at(points: Floats, along: Floats, where: Floats, last: Ints, first: Ints) -> Floats:
    """(k,3) the points at lengths (k,) along lines with these first and last points."""
    place = np.clip(np.searchsorted(along, where, side="right") - 1, first, np.maximum(last - 1, first))
    gap = along[place + 1] - along[place]
    share: Floats = np.clip((where - along[place]) / np.where(gap > 0.0, gap, 1.0), 0.0, 1.0)
    inner: Bools = gap > 0.0
    share = np.where(inner, share, 0.0)
    return np.asarray(points[place] + share[:, None] * (points[place + 1] - points[place]))

"""The shortest ways on a mesh from place to place, and how far its vertices are."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.integral.on_meshes.triangle_sides import TriangleSides, triangle_sides
from vectorplot.features.integral.on_meshes.windows import (
    NOWHERE,
    Reached,
    Targets,
    Windows,
    all_windows,
    lead_on,
    whole_windows,
)
from vectorplot.features.meshes.mesh_curves import (
    NO_FACE,
    FaceTriangles,
    MeshCurves,
    all_mesh_curves,
    face_triangles,
    without_inner,
)
from vectorplot.features.meshes.nearest_on_mesh import nearest_on_mesh, nearest_triangles
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import USUAL, Budget, part_of, unheard
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import some
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR


def mesh_shortest_paths(
    mesh: Mesh,
    starts: ArrayLike,
    ends: ArrayLike,
    *,
    budget: Budget = USUAL,
    done: Callable[[float], None] = unheard,
) -> MeshCurves:
    """The shortest ways on a mesh from points to other points.

    Parameters
    ----------
    mesh : Mesh
        On which they run; open or closed, of one sheet or more.
    starts, ends : (k, 3) array_like of float
        Points in the world, of which the nearest ones on the mesh count; or one of them.
    budget : Budget
        Its windows count, for each place that ways begin at.
    done : callable
        Is told the part of the work that is done, from 0 to 1, many times each second. What it raises ends the work.

    Returns
    -------
    MeshCurves
        Polylines with the number of the way as level, from start to end: no way on the mesh is shorter. Those between
        one place and itself are left out.

    Raises
    ------
    InputError
        For points that are not three finite numbers each, a mesh without faces, places that the mesh does not join, and
        meshes that need more windows than the budget has, usually twenty million.

    Notes
    -----
    Exact but for rounding: not along edges, but straight across unfolded faces, and through vertices only where more
    than a whole turn is around them, or at a border. Of several shortest ways any is taken. Windows, the parts of edges
    that are reached straight through one and the same unfolded triangles, are led on, the nearest ones first, as far as
    the best way that is known is long; their number grows faster than that of triangles, about with its power 1.5.

    Source: Mitchell, Mount and Papadimitriou, The discrete geodesic problem, 1987.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, geometry
    >>> way = features.mesh_shortest_paths(geometry.box((2, 2, 2)), (0, 0, 0), (2, 2, 2))
    >>> round(float(np.linalg.norm(np.diff(way[0], axis=0), axis=1).sum()) ** 2, 9)
    20.0
    """
    begin, finish = (np.atleast_2d(np.asarray(points, dtype=np.float64)) for points in (starts, ends))
    if begin.shape != finish.shape:
        raise InputError(f"shortest paths: {len(begin)} starts and {len(finish)} ends")
    if not len(begin):
        return all_mesh_curves([])
    faces = face_triangles(mesh)
    sides = triangle_sides(faces)
    from_, to = _placed(faces, begin), _placed(faces, finish)
    places, group = np.unique(from_[0], axis=0, return_inverse=True)
    parts = []
    for number in range(len(places)):
        own = np.flatnonzero(group.ravel() == number)
        source = _of(from_, own[:1])
        told = part_of(done, number, len(places))
        parts.append(_ways(mesh, sides, source, _of(to, own), own, budget.windows, told))
    found = all_mesh_curves(parts)
    found = some(found, np.argsort(found.levels, kind="stable"))
    return without_inner(found, faces.extent)


def mesh_distances(
    mesh: Mesh, points: ArrayLike, *, budget: Budget = USUAL, done: Callable[[float], None] = unheard
) -> Floats:
    """How far the vertices of a mesh are from the nearest of some places, on the mesh.

    Parameters
    ----------
    mesh : Mesh
        With v vertices.
    points : (k, 3) array_like of float
        Points in the world, of which the nearest ones on the mesh count; or one of them.
    budget : Budget
        Its windows count.
    done : callable
        As of `mesh_shortest_paths`.

    Returns
    -------
    (v,) array of float
        The lengths of the shortest ways; inf where there is none. For `mesh_level_lines`, whose lines then are circles
        about the places, as far as what is between vertices is linear.

    Raises
    ------
    InputError
        As of `mesh_shortest_paths`.

    Notes
    -----
    Exact but for rounding, as `mesh_shortest_paths`.

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> (features.mesh_distances(geometry.box((2, 2, 2)), (0, 0, 0)).max() ** 2).round(9).item()
    20.0
    """
    at = np.atleast_2d(np.asarray(points, dtype=np.float64))
    faces = face_triangles(mesh)
    sides = triangle_sides(faces)
    reached, begin = _begun(sides, _placed(faces, at), 0)
    none = Targets(np.zeros(0, dtype=np.intp), np.zeros(0, dtype=np.intp), np.zeros((0, 3)))
    lead_on(sides, begin, reached, none, budget.windows, done)
    return reached.far


Placed = tuple[Floats, Ints, Ints]
"""Places (k,3) on triangles, and in which triangles each is: place (n,), ascending, and triangle (n,)."""


def _placed(faces: FaceTriangles, points: Floats) -> Placed:
    if points.shape[1:] != (3,) or not np.isfinite(points).all():
        raise InputError("shortest paths: points must be three finite numbers each")
    near = nearest_triangles(faces, points)
    first = ragged.starts(np.bincount(near.point, minlength=len(points)))
    feet = near.feet[first]
    # Of places that are equally near to a point the first one counts, with all triangles that it is in.
    here = norm(near.feet - feet[near.point]) <= ZERO_OF_EXTENT * faces.extent
    return feet, near.point[here], near.triangle[here]


def _of(placed: Placed, which: Ints) -> Placed:
    """Some of the places."""
    feet, place, triangle = placed
    order = np.full(len(feet), NOWHERE)
    order[which] = np.arange(len(which))
    kept = order[place] != NOWHERE
    return feet[which], order[place[kept]], triangle[kept]


def _begun(sides: TriangleSides, source: Placed, count: int) -> tuple[Reached, Windows]:
    """What is reached from places along edges alone, of vertices and so many targets, and the first windows."""
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import dijkstra

    feet, place, triangle = source
    own = (3 * triangle[:, None] + np.arange(3)).ravel()
    at = feet[np.repeat(place, 3)]
    vertices = len(sides.points)
    away = norm(at - sides.points[sides.start[own]])
    # Edges without length are none for the search: they count as the shortest ones there are.
    rows = np.concatenate([sides.start, np.full(len(own), vertices)])
    columns = np.concatenate([sides.end, sides.start[own]])
    order = np.lexsort((np.concatenate([sides.lengths, away]), columns, rows))
    pair = np.stack([rows, columns])[:, order]
    single = np.append(True, (np.diff(pair, axis=1) != 0).any(axis=0))
    weights = np.maximum(np.concatenate([sides.lengths, away])[order][single], LEAST_DIVISOR)
    graph = csr_array((weights, pair[:, single]), shape=(vertices + 1, vertices + 1))
    far, before = dijkstra(graph, directed=False, indices=vertices, return_predecessors=True)
    far, before = far[:vertices], before[:vertices].astype(np.intp)
    before = np.where((before == vertices) | (before < 0), NOWHERE, before)
    x, y = sides.in_plane(own, at)
    aside = y > ZERO_OF_EXTENT * sides.lengths[own]
    begin = whole_windows(
        sides, own[aside], x[aside], y[aside], np.zeros(int(aside.sum())), np.full(int(aside.sum()), NOWHERE)
    )
    nowhere = np.full(vertices, NOWHERE)
    none = np.full(count, NOWHERE)
    fresh = sides.passable & np.isfinite(far)
    return Reached(far, nowhere, before, np.full(count, np.inf), none, np.array(none), fresh), begin


def _ways(
    mesh: Mesh,
    sides: TriangleSides,
    source: Placed,
    to: Placed,
    numbers: Ints,
    most: int,
    done: Callable[[float], None],
) -> MeshCurves:
    """The shortest ways from one place to others, with numbers (k,), through so many windows at most."""
    ends, target, triangle = to
    reached, begin = _begun(sides, source, len(ends))
    shared = np.isin(triangle, source[2])
    reached.target_far[target[shared]] = norm(ends - source[0])[target[shared]]
    order = np.lexsort((target, triangle))
    lead_on(sides, begin, reached, Targets(target[order], triangle[order], ends[target[order]]), most, done)
    lost = ~np.isfinite(reached.target_far)
    if lost.any():
        raise InputError(f"shortest paths: the mesh does not join the ends of way {int(numbers[lost.argmax()]) + 1}")
    way, points = _traced(sides, reached, source[0][0], ends)
    # From the source, and no point twice.
    order = np.lexsort((-np.arange(len(way)), way))
    way, points = way[order], points[order]
    last = np.append(way[1:] != way[:-1], True)
    short = norm(np.diff(points, axis=0, append=points[-1:])) <= sides.slack
    kept = last | ~short
    way, points = way[kept], points[kept]
    counts = np.bincount(way, minlength=len(ends))
    long = counts > 1
    points = points[long[way]]
    offsets = ragged.offsets(counts[long])
    middles = 0.5 * (points + points[ragged.following(offsets)])
    inner = np.ones(len(points), dtype=np.bool_)
    inner[offsets[1:] - 1] = False
    face = np.full(len(points), NO_FACE)
    if inner.any():
        face[inner] = nearest_on_mesh(mesh, middles[inner]).faces
    closed = np.zeros(int(long.sum()), dtype=np.bool_)
    return MeshCurves(points, offsets, closed, face, numbers[long].astype(np.float64))


def _traced(sides: TriangleSides, reached: Reached, source: Floats, ends: Floats) -> tuple[Ints, Floats]:
    """The points (n,3) of ways, from their ends back to the source, and the way (n,) of each."""
    none, zero = np.zeros(0, dtype=np.intp), np.zeros(0)
    windows = all_windows([Windows(none, zero, zero, zero, zero, zero, none, none), *reached.found])
    way, point = np.arange(len(ends)), np.array(ends)
    window, vertex = reached.target_window, reached.target_before
    ways, points = [way], [point]
    while len(way):
        own = windows.some(np.maximum(window, 0)) if len(windows) else None
        through = window != NOWHERE
        new = np.where((vertex != NOWHERE)[:, None], sides.points[np.maximum(vertex, 0)], source)
        if own is not None:
            x, y = sides.in_plane(own.side, point)
            with np.errstate(all="ignore"):
                met = np.nan_to_num(own.x + (x - own.x) * own.y / (own.y + y))
            met = np.clip(met, own.low, own.high)
            a, b = sides.points[sides.start[own.side]], sides.points[sides.end[own.side]]
            new = np.where(through[:, None], a + (met / sides.lengths[own.side])[:, None] * (b - a), new)
        ways.append(way)
        points.append(new)
        at, goes_on = np.maximum(vertex, 0), through | (vertex != NOWHERE)
        after = np.where(vertex != NOWHERE, reached.window[at], NOWHERE)
        then = np.where(vertex != NOWHERE, reached.before[at], NOWHERE)
        if own is not None:
            after = np.where(through, own.parent, after)
            then = np.where(through, np.where(own.parent == NOWHERE, own.root, NOWHERE), then)
        way, point, window, vertex = way[goes_on], new[goes_on], after[goes_on], then[goes_on]
    return np.concatenate(ways), np.concatenate(points)

"""Water on a terrain: where it runs, what parts it, and where it gathers."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.integral.on_meshes.mesh_integral_curves import mesh_integral_curves
from vectorplot.features.integral.tangent_fields import SteepestSlope, TurnedField
from vectorplot.features.meshes.mesh_curves import NO_FACE, MeshCurves, all_mesh_curves
from vectorplot.features.terrains.places import places_on_terrain
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import TRIANGLE, Mesh
from vectorplot.geometry.repair.winding import edge_uses

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
    Degenerate: no course from a place on a plain.

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
    """The lines on a terrain that part waters: from the saddles up to the summits.

    Parameters
    ----------
    mesh : Mesh
        Of triangles, none above another.

    Returns
    -------
    MeshCurves
        From each saddle one line for each of the rising ground beside it, two mostly, with the number of the vertex as
        level. They end on summits, on plains, and at borders.

    Raises
    ------
    InputError
        For a mesh of other faces.

    Notes
    -----
    A saddle is a vertex around which the ground rises and falls more than once each; of vertices of one height the
    earlier counts as lower, but no line leaves along level ground. A line leaves it along the steepest edge of the
    rising ground and, from the middle of that on, goes up where it is steepest.

    Source: Cayley, On contour and slope lines (1859); Maxwell, On hills and dales (1870); Banchoff, Critical points and
    curvature for embedded polyhedra (1967), for vertices.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, scene, surfaces
    >>> x, y = np.meshgrid(np.linspace(-2, 2, 33), np.linspace(-1, 1, 17), indexing="ij")
    >>> ridge = features.watersheds(scene.terrain_mesh(surfaces.terrain(x**2 - x**4 / 4 - y**2)))
    >>> len(ridge), sorted(round(float(line[-1, 0])) for line in ridge)  # of the array, whose steps are 1
    (2, [5, 27])
    """
    return _from_saddles(mesh, 1.0)


def valley_lines(mesh: Mesh) -> MeshCurves:
    """The lines of a terrain along which waters gather: from the saddles down to the pits.

    Parameters
    ----------
    mesh : Mesh
        Of triangles, none above another.

    Returns
    -------
    MeshCurves
        As of `watersheds`, for the falling ground.

    Raises
    ------
    InputError
        For a mesh of other faces.

    Notes
    -----
    Source: as of `watersheds`.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, scene, surfaces
    >>> x, y = np.meshgrid(np.linspace(-2, 2, 33), np.linspace(-1, 1, 17), indexing="ij")
    >>> len(features.valley_lines(scene.terrain_mesh(surfaces.terrain(x**2 - x**4 / 4 - y**2))))
    2
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
    # Nodes: the rising ends of the edges at saddles; those of one triangle hang together.
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

"""Limit surfaces of subdivision: of Catmull and Clark's scheme and of Loop's, evaluated exactly, with their meshes.

A cage is refined until every face has one irregular vertex at most. A face with none is a patch of B-splines, bicubic
or a quartic box spline; one with one is a chain of such patches, each half as large as the one before, whose controls
are sums of the same vertices around the face (Stam). The weights of these sums hang on the kinds of the corners only:
faces that are alike share them. They are found by refining unit vectors, not by eigenvectors: every step is a sum of
few terms, the same on every processor.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from enum import IntEnum
from functools import cache, cached_property, lru_cache

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import determinant, matmul
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import cross, dot, norm, summed_by
from vectorplot.geometry.weld import chained
from vectorplot.tolerances import BESIDE_BORDER, LEAST_DIVISOR, LIMIT_OF_LEVELS
from vectorplot.words import unknown

SCHEMES = {"catmull-clark": 4, "loop": 3}
"""The schemes, and how many corners their patches have."""

MOST_PATCHES = 1 << 20
"""Faces of a refined cage at most."""

MOST_FACES_OF_VERTEX = 1 << 10
"""Faces around a vertex of a cage at most: what is done for one of them grows with all of them."""

MOST_LEVELS = 64
"""So deep patches around an irregular vertex are told apart at most."""

MOST_RULES = 256
"""Of so many kinds of patches the weights are kept: a moved, animated or similar cage has the same."""

CHUNK = 1 << 21
"""Weights that are held at a time, about."""


class VertexKind(IntEnum):
    """By which rule a vertex moves."""

    SMOOTH = 0
    """The faces go all around it."""
    BORDER = 1
    """Two sharp edges, or borders, run through it: it stays on their B-spline."""
    CORNER = 2
    """It stays where it is: more or fewer sharp edges end there."""
    DART = 3
    """One sharp edge ends there amid the surface: it moves as if it were smooth."""


# A cage as half-edges, cut along its sharp edges.


@dataclass(frozen=True, eq=False)
class _Net:
    """Faces, cut apart along sharp edges.

    points (n,3), kind (n,) and vertex (n,): where vertices are, how they move, and the numbers by which those that were
    cut apart are one again; of each half-edge (h,): corner, the vertex that it begins at, the half-edges after and
    before it, opposite (-1 at a cut or a border), edge, a number that both sides of a cut have in common, and forward:
    whether it runs along its edge; lined (h,): whether it is part of an edge of the cage; face (h,): its face; source
    (f,): the face of the cage; vertices, edges: how many numbers there are of either.
    """

    points: Floats
    kind: Ints
    vertex: Ints
    corner: Ints
    after: Ints
    before: Ints
    opposite: Ints
    edge: Ints
    forward: Bools
    lined: Bools
    face: Ints
    source: Ints
    vertices: int
    edges: int

    @cached_property
    def end(self) -> Ints:
        """(h,) the vertex at which each half-edge ends."""
        return self.corner[self.after]

    @cached_property
    def is_cut(self) -> Bools:
        """(h,) whether nothing lies beyond it."""
        return self.opposite < 0

    @cached_property
    def faces_around(self) -> Ints:
        """(n,) how many faces each vertex has."""
        return np.bincount(self.corner, minlength=len(self.points))

    @cached_property
    def is_open(self) -> Bools:
        """(n,) whether the faces do not go all around it."""
        result = np.zeros(len(self.points), dtype=np.bool_)
        result[self.corner[self.is_cut]] = True
        return result

    @cached_property
    def sides(self) -> tuple[Ints, Ints]:
        """(h,) the number of its edge where each side of a cut has one of its own; and a half-edge of each number."""
        here = np.arange(len(self.corner))
        first = np.where(self.is_cut, here, np.minimum(here, self.opposite))
        own, number = np.unique(first, return_inverse=True)
        return number.ravel(), own


def _net(cage: Mesh, creases: Ints, values: Floats) -> _Net:
    """The net of a cage with creases (e,2), of points, or other values (v,k), at those vertices that faces have.

    Errors: InputError for a face that comes to a vertex twice, and for creases that are no edges.
    """
    used, corner = np.unique(cage.corners, return_inverse=True)
    corner, after, count = corner.ravel(), cage.next_corner, len(used)
    before, here = np.empty_like(after), np.arange(len(corner))
    before[after] = here
    face, end = cage.corner_face, corner[after]
    order = np.lexsort((corner, face))
    again = np.flatnonzero((np.diff(face[order]) == 0) & (np.diff(corner[order]) == 0))
    if len(again):
        raise InputError(f"subdivision: face {int(face[order[again[0]]]) + 1} comes to a vertex twice")
    low, high = np.minimum(corner, end), np.maximum(corner, end)
    keys, edge, uses = np.unique(low * count + high, return_inverse=True, return_counts=True)
    edge, forward = edge.ravel(), corner == low
    forwards = np.bincount(edge, forward, len(keys))
    sharp = np.ones(len(keys), dtype=np.bool_)
    sharp[(uses == 2) & (forwards == 1.0)] = False
    sharp[_edges_of(creases, used, keys, count)] = True
    opposite = np.full(len(corner), -1)
    order = np.argsort(edge, kind="stable")
    both = order[~sharp[edge[order]]].reshape(-1, 2)
    opposite[both[:, 0]], opposite[both[:, 1]] = both[:, 1], both[:, 0]
    # Half-edges that begin at one vertex belong to one fan where faces between them are joined.
    joined = np.flatnonzero(opposite >= 0)
    fan = np.unique(chained(len(corner), joined, after[opposite[joined]]), return_inverse=True)[1].ravel()
    vertex = np.zeros(int(fan.max(initial=-1)) + 1, dtype=np.intp)
    vertex[fan] = corner
    kind = _kinds(vertex, fan, opposite < 0, np.stack([low, high])[:, np.unique(edge, return_index=True)[1][sharp]])
    return _Net(
        values[vertex],
        kind,
        vertex,
        fan,
        after,
        before,
        opposite,
        edge,
        forward,
        np.ones(len(corner), dtype=np.bool_),
        face,
        np.arange(cage.face_count),
        count,
        len(keys),
    )


def _edges_of(creases: Ints, used: Ints, keys: Ints, count: int) -> Ints:
    """(e,) the numbers of edges, of which these are the keys, by the vertices (e,2) at their ends."""
    known = np.array(np.isin(creases, used).all(axis=1), dtype=np.bool_).reshape(-1)
    ends = np.sort(np.searchsorted(used, np.where(known[:, None], creases, 0)), axis=1)
    key = ends[:, 0] * count + ends[:, 1]
    known &= np.isin(key, keys)
    if not known.all():
        one, two = creases[int(np.argmin(known))].tolist()
        raise InputError(f"subdivision: a crease from vertex {one + 1} to {two + 1}, where the cage has no edge")
    return np.searchsorted(keys, key)


def _kinds(vertex: Ints, fan: Ints, cut: Bools, sharp: Ints) -> Ints:
    """(n,) the kinds of fans of the vertices (n,); fan, cut (h,): of half-edges; sharp (2,e): ends of sharp edges."""
    count = int(vertex.max(initial=-1)) + 1
    ends = np.bincount(sharp.ravel(), minlength=count)[vertex]
    is_open = np.zeros(len(vertex), dtype=np.bool_)
    is_open[fan[cut]] = True
    fans, faces = np.bincount(vertex, minlength=count)[vertex], np.bincount(vertex[fan], minlength=count)[vertex]
    whole = np.bincount(vertex, ~is_open, count)[vertex] > 0.0
    kind = np.full(len(vertex), int(VertexKind.CORNER))
    kind[is_open & (ends == 2) & (faces > 1) & ~whole] = VertexKind.BORDER
    kind[is_open & (ends == 1) & (fans == 1)] = VertexKind.DART
    kind[~is_open & (fans == 1)] = VertexKind.SMOOTH
    return kind


# One step of subdivision, of a whole net.


def _moved(net: _Net, smooth: Floats) -> Floats:
    """(n,3) the vertices after a step, those that are smooth or darts at points (n,3)."""
    p, cut = net.points, np.flatnonzero(net.is_cut)
    start, end = net.corner[cut], net.end[cut]
    beside = summed_by(start, p[end], len(p)) + summed_by(end, p[start], len(p))
    result = smooth.copy()
    border, corner = net.kind == VertexKind.BORDER, net.kind == VertexKind.CORNER
    result[border] = (6.0 * p[border] + beside[border]) / 8.0
    result[corner] = p[corner]
    return result


def _halves(net: _Net) -> tuple[Ints, Ints]:
    """(h,) the numbers of the first and of the second half of the edge of every half-edge."""
    return 2 * net.edge + ~net.forward, 2 * net.edge + net.forward


def _catmull_clark(net: _Net) -> _Net:
    """The net after a step: a quad for every corner of a face.

    Source: Catmull, Clark (1978); Hoppe et al. (1994) and DeRose, Kass, Truong (1998) for sharp edges.
    """
    p, corner, end, face, cut = net.points, net.corner, net.end, net.face, net.is_cut
    n, faces, size = len(p), len(net.source), np.bincount(face, minlength=len(net.source))
    middle = summed_by(face, p[corner], faces) / size[:, None]
    number, own = net.sides
    both = p[corner[own]] + p[end[own]]
    inner = both + (middle[face[own]] + middle[face[net.opposite[own]]])
    on_edges = np.where(cut[own, None], 0.5 * both, 0.25 * inner)
    around = net.faces_around[:, None].astype(np.float64)
    beside = summed_by(corner, p[end], n) + summed_by(corner, middle[face], n)
    moved = _moved(net, (around - 2.0) / around * p + beside / (around * around))
    here, rows = np.arange(len(corner)), len(own)
    first, second = _halves(net)
    inside = 2 * net.edges + here
    quads = np.stack([corner, n + number, n + rows + face, n + number[net.before]], axis=1)
    opposite = np.stack(
        [
            np.where(cut, -1, 4 * net.after[net.opposite] + 3),
            4 * net.after + 2,
            4 * net.before + 1,
            np.where(cut, -1, 4 * net.opposite)[net.before],
        ],
        axis=1,
    )
    yes = np.ones_like(net.forward)
    return _regular(
        4,
        np.concatenate([moved, on_edges, middle]),
        np.concatenate([net.kind, np.where(cut[own], int(VertexKind.BORDER), 0), np.zeros(faces, dtype=np.intp)]),
        np.concatenate([net.vertex, net.vertices + net.edge[own], net.vertices + net.edges + np.arange(faces)]),
        quads.ravel(),
        opposite.ravel(),
        np.stack([first, inside, inside[net.before], second[net.before]], axis=1).ravel(),
        np.stack([net.forward, yes, ~yes, net.forward[net.before]], axis=1).ravel(),
        np.stack([net.lined, ~yes, ~yes, net.lined[net.before]], axis=1).ravel(),
        net.source[face],
        net.vertices + net.edges + faces,
        2 * net.edges + len(corner),
    )


def _loop(net: _Net) -> _Net:
    """The net of triangles after a step: four for every triangle.

    Source: Loop (1987); Hoppe et al. (1994) for sharp edges.
    """
    p, corner, end, face, cut = net.points, net.corner, net.end, net.face, net.is_cut
    n, half_edges = len(p), len(corner)
    number, own = net.sides
    both = p[corner[own]] + p[end[own]]
    across = p[corner[net.before[own]]] + p[corner[net.before[net.opposite[own]]]]
    on_edges = np.where(cut[own, None], 0.5 * both, 0.375 * both + 0.125 * across)
    beta = _loop_weights(net.faces_around)[:, None]
    moved = _moved(net, (1.0 - beta * net.faces_around[:, None]) * p + beta * summed_by(corner, p[end], n))
    first, second = _halves(net)
    inside = 2 * net.edges + np.arange(half_edges)
    at, back = n + number, n + number[net.before]
    corners = np.stack([corner, at, back], axis=1)
    centres = at.reshape(-1, 3)
    place = np.arange(half_edges) % 3
    centre_of = 3 * (half_edges + face) + place
    opposite = np.stack(
        [
            np.where(cut, -1, 3 * net.after[net.opposite] + 2),
            centre_of[net.before],
            np.where(cut, -1, 3 * net.opposite)[net.before],
        ],
        axis=1,
    )
    yes, none = np.ones_like(net.forward), np.zeros(half_edges, dtype=np.bool_)
    return _regular(
        3,
        np.concatenate([moved, on_edges]),
        np.concatenate([net.kind, np.where(cut[own], int(VertexKind.BORDER), 0)]),
        np.concatenate([net.vertex, net.vertices + net.edge[own]]),
        np.concatenate([corners.ravel(), centres.ravel()]),
        np.concatenate([opposite.ravel(), 3 * net.after + 1]),
        np.concatenate([np.stack([first, inside, second[net.before]], axis=1).ravel(), inside[net.after]]),
        np.concatenate([np.stack([net.forward, yes, net.forward[net.before]], axis=1).ravel(), none]),
        np.concatenate([np.stack([net.lined, none, net.lined[net.before]], axis=1).ravel(), none]),
        np.concatenate([net.source[face], net.source]),
        net.vertices + net.edges,
        2 * net.edges + half_edges,
    )


def _regular(
    size: int,
    points: Floats,
    kind: Ints,
    vertex: Ints,
    corner: Ints,
    opposite: Ints,
    edge: Ints,
    forward: Bools,
    lined: Bools,
    source: Ints,
    vertices: int,
    edges: int,
) -> _Net:
    """A net of faces with so many corners each."""
    here = np.arange(len(corner))
    first = here - here % size
    after, before = first + (here + 1) % size, first + (here - 1) % size
    ends = (vertices, edges)
    return _Net(
        points, kind, vertex, corner, after, before, opposite, edge, forward, lined, here // size, source, *ends
    )


@cache
def _loop_weight(faces: int) -> float:
    """What each neighbour of a smooth vertex with so many of them weighs."""
    turned = 0.375 + 0.25 * float(np.cos(2.0 * np.pi / faces))
    return (0.625 - turned * turned) / faces


def _loop_weights(faces: Ints) -> Floats:
    known = np.unique(faces)
    return np.array([_loop_weight(int(n)) for n in known.tolist()])[np.searchsorted(known, faces)]


def _refined_cage(cage: Mesh, scheme: str, creases: Ints, values: Floats) -> _Net:
    """The net of a cage with values (v,k), see _net, refined until its faces have as many corners as the scheme wants
    and one irregular vertex."""
    net, size = _net(cage, creases, values), SCHEMES[scheme]
    most = int(net.faces_around.max(initial=0))
    if most > MOST_FACES_OF_VERTEX:
        raise InputError(f"subdivision: a vertex with {most} faces, expected at most {MOST_FACES_OF_VERTEX}")
    plain = bool((cage.face_sizes == size).all())
    while not plain or _irregular(net, size).reshape(-1, size).sum(axis=1).max(initial=0) > 1:
        if len(net.corner) > MOST_PATCHES:
            raise InputError(f"subdivision: the refined cage has more than {MOST_PATCHES} faces")
        net, plain = (_catmull_clark if size == 4 else _loop)(net), True
    return net


def _irregular(net: _Net, size: int) -> Bools:
    """(h,) whether half-edges begin at a vertex about which the surface is no B-spline."""
    round_ = 4 if size == 4 else 6
    smooth = (net.kind == VertexKind.SMOOTH) & (net.faces_around == round_)
    border = (net.kind == VertexKind.BORDER) & (2 * net.faces_around == round_)
    return np.asarray(~(smooth | border)[net.corner])


# The vertices around a corner of a patch, each as weights of those of a net.


@dataclass(frozen=True, eq=False)
class _Ring:
    """What is around a vertex, counter-clockwise: centre (k,), the ends of its edges (e,k), and of quads the corners
    (n,k) across from it, face by face; closed: whether the faces go all around; own: which of them is the patch's;
    kind: how it moves. k: the vertices that everything is a sum of."""

    centre: Floats
    edges: Floats
    across: Floats
    closed: bool
    own: int
    kind: int

    @property
    def faces(self) -> int:
        """How many there are."""
        return len(self.edges) - (not self.closed)

    def less(self, row: Floats) -> _Ring:
        """The same with a row (k,) taken from every one."""
        return replace(self, centre=self.centre - row, edges=self.edges - row, across=self.across - row)

    def refined(self) -> _Ring:
        """The ring of the same vertex after a step."""
        c, e, n, quads = self.centre, self.edges, self.faces, len(self.across) > 0
        here = np.arange(len(e))
        before, after = (e[here - 1], e[here + 1 - len(e)]) if self.closed else (e[:-1], e[1:])
        if quads:
            faces = (c + (e if self.closed else before) + self.across + after) * 0.25
            sides = (faces, faces[here - 1]) if self.closed else (faces[1:], faces[:-1])
            inner = (c + (e if self.closed else e[1:-1]) + (sides[0] + sides[1])) * 0.25
        else:
            faces = self.across
            beside = before + after if self.closed else e[:-2] + e[2:]
            inner = 0.375 * (c + (e if self.closed else e[1:-1])) + 0.125 * beside
        edges = inner if self.closed else np.concatenate([0.5 * (c + e[:1]), inner, 0.5 * (c + e[-1:])])
        if self.kind == VertexKind.CORNER:
            moved = c
        elif self.kind == VertexKind.BORDER:
            moved = (6.0 * c + (e[0] + e[-1])) / 8.0
        elif quads:
            moved = (n - 2.0) / n * c + (e[:n].sum(axis=0) + faces.sum(axis=0)) / (n * n)
        else:
            beta = _loop_weight(n)
            moved = (1.0 - beta * n) * c + beta * e[:n].sum(axis=0)
        return replace(self, centre=moved, edges=edges, across=faces)

    def limit(self) -> Floats:
        """(k,) the weights of the point of the limit surface that the vertex comes to."""
        ring, last = self, self.centre
        for _ in range(MOST_LEVELS):
            ring = ring.refined()
            if float(np.abs(ring.centre - last).max()) <= LIMIT_OF_LEVELS * LIMIT_OF_LEVELS:
                break
            last = ring.centre
        return ring.centre

    def tangents(self) -> tuple[Floats, Floats]:
        """(k,) two tangents of the limit surface, of a ring that was refined often; towards the ends of the edges of
        the patch, about. Around a smooth vertex those are the first waves of the ends of its edges, other waves having
        no part in them."""
        if not self.closed or self.kind != VertexKind.SMOOTH:
            e = self.edges
            return e[self.own] - self.centre, e[self.own + 1 - len(e) * self.closed] - self.centre
        angle = 2.0 * np.pi / self.faces * (np.arange(self.faces) - self.own)
        turned = (np.cos(angle), np.cos(angle - 2.0 * np.pi / self.faces))
        return matmul(turned[0], self.edges), matmul(turned[1], self.edges)


_Rings = list[_Ring]


def _around_point(edges: Sequence[Floats], across: Sequence[Floats], centre: Floats, closed: bool, own: int) -> _Ring:
    """The ring of a vertex that a step has made."""
    kind = int(VertexKind.SMOOTH if closed else VertexKind.BORDER)
    none = np.zeros((0, len(centre)))
    return _Ring(centre, np.array(edges), np.array(across) if len(across) else none, closed, own, kind)


def _children(rings: _Rings) -> tuple[list[_Rings], _Rings]:
    """The parts of a patch after a step, each given by the rings of its corners: that at each corner, in the
    order of the corners of the patch; and of a triangle the one in its middle."""
    size = len(rings)
    new = [ring.refined() for ring in rings]
    at = [ring.own for ring in new]

    def edge(corner: int, turn: int) -> Floats:
        ring = new[corner % size]
        return np.asarray(ring.edges[(at[corner % size] + turn) % len(ring.edges)])

    centres = [ring.centre for ring in new]
    halves: list[tuple[_Ring, tuple[int, int, int]]] = []
    for k in range(size):
        j = (k + 1) % size
        # Beyond the edge from corner k to corner j there may be nothing.
        closed = new[k].closed or at[k] > 0
        if size == 4:
            inside = new[0].across[at[0]]
            if closed:
                beyond = new[k].across[(at[k] - 1) % len(new[k].across)]
                edges = [inside, centres[k], beyond, centres[j]]
                across = [edge(k, 1), edge(k, -1), edge(j, 2), edge(j, 0)]
                owns = (0, 3, 0)
            else:
                edges, across, owns = [centres[j], inside, centres[k]], [edge(j, 0), edge(k, 1)], (1, 0, 0)
        else:
            across = []
            if closed:
                edges = [edge(k, 1), centres[k], edge(k, -1), edge(j, 2), centres[j], edge(j, 0)]
                owns = (0, 4, 5)
            else:
                edges, owns = [centres[j], edge(j, 0), edge(k, 1), centres[k]], (2, 0, 1)
        halves.append((_around_point(edges, across, edge(k, 0), closed, owns[0]), owns))
    parts = []
    for k in range(size):
        (one, _), (two, owns) = halves[k], halves[k - 1]
        own = [new[k], one, replace(two, own=owns[1])]
        if size == 4:
            on_edges = [edge(c, 0) for c in (3, 0, 1, 2)]
            own.insert(2, _around_point(on_edges, centres, new[0].across[at[0]], True, k))
        # In the order of the corners of the patch.
        parts.append([own[(c - k) % size] for c in range(size)])
    middle = [replace(ring, own=owns[2]) for ring, owns in halves] if size == 3 else []
    return parts, middle


def _places_of_controls() -> Ints:
    """(16,) where the controls of a quad stand among its corners, each with the eight vertices around it behind it."""
    directions = ((0, 0), (1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1))
    result = np.zeros((4, 4), dtype=np.intp)
    for k, (a, b) in enumerate(((0, 0), (1, 0), (1, 1), (0, 1))):
        for place, (x, y) in enumerate(directions):
            for _ in range(k):
                x, y = -y, x
            result[a + x + 1, b + y + 1] = 9 * k + place
    return result.ravel()


_CONTROLS = {
    4: _places_of_controls(),
    3: np.array(
        [7 * k for k in range(3)] + [7 * k + 6 for k in range(3)] + [7 * k + p for k in range(3) for p in (5, 4)]
    ),
}


def _controls(rings: _Rings) -> Floats:
    """(16,k) or (12,k) the controls of a patch without irregular vertices; beyond a border what continues it evenly.

    Of quads those of the grid from -1 to 2, v running first; of triangles the corners, then those across the three
    sides from them, then of each corner the two behind it.
    """
    filled = _filled_quads if len(rings) == 4 else _filled_triangles
    rows = [part for ring in rings for part in (ring.centre[None], filled(ring))]
    return np.asarray(np.concatenate(rows)[_CONTROLS[len(rings)]])


def _filled_quads(ring: _Ring) -> Floats:
    """(8,k) the ends of edges and the corners between them all around a regular vertex, from the patch's first edge."""
    e, d = ring.edges, ring.across
    rows = np.empty((8, e.shape[1]))
    if ring.closed:
        rows[::2], rows[1::2] = e, d
    else:
        rows[:5:2], rows[1:4:2] = e, d
        rows[5], rows[6], rows[7] = 2.0 * e[2] - d[1], 2.0 * ring.centre - e[1], 2.0 * e[0] - d[0]
    return rows[(np.arange(8) + 2 * ring.own) % 8]


def _filled_triangles(ring: _Ring) -> Floats:
    """(6,k) the ends of edges all around a regular vertex, from the patch's first edge."""
    e = ring.edges
    if not ring.closed:
        e = np.array([*e, ring.centre + e[3] - e[2], ring.centre + e[0] - e[1]])
    return e[(np.arange(6) + ring.own) % 6]


# The polynomials that controls are multiplied with.


def _cubics(t: Floats) -> Floats:
    """(3,g,4) the cubic B-splines at parameters (g,), their derivatives and second derivatives."""
    r = 1.0 - t
    values = [r * r * r / 6.0, ((3.0 * t - 6.0) * t * t + 4.0) / 6.0, (((-3.0 * t + 3.0) * t + 3.0) * t + 1.0) / 6.0]
    slopes = [-0.5 * r * r, (1.5 * t - 2.0) * t, (-1.5 * t + 1.0) * t + 0.5, 0.5 * t * t]
    return np.stack(
        [
            np.stack([*values, t * t * t / 6.0], axis=1),
            np.stack(slopes, axis=1),
            np.stack([r, 3.0 * t - 2.0, 1.0 - 3.0 * t, t], axis=1),
        ]
    )


def _quad_basis(u: Floats, v: Floats, jets: int) -> Floats:
    """(g,j,16) the products of B-splines; j: value, derivatives by u and v, second ones by uu, uv, vv."""
    of_u, of_v = _cubics(u), _cubics(v)
    orders = ((0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2))[:jets]
    return np.stack([(of_u[a][:, :, None] * of_v[b][:, None, :]).reshape(-1, 16) for a, b in orders], axis=1)


@cache
def _box_spline() -> tuple[Floats, ...]:
    """Six (25,12): the coefficients of v^i w^j, at 5 i + j, of the quartic box splines on a triangle with the
    coordinates 1 - v - w, v, w; of their derivatives by v and w, and of the second ones by vv, vw, ww.

    Source: Stam (1998), Evaluation of Loop subdivision surfaces, appendix.
    """

    def product(*factors: Floats) -> Floats:
        result = np.zeros((5, 5))
        result[0, 0] = 1.0
        for factor in factors:
            total = np.zeros((5, 5))
            for i, j in np.argwhere(factor):
                total[i:, j:] += factor[i, j] * result[: 5 - i, : 5 - j]
            result = total
        return result

    one = np.zeros((3, 5, 5))
    one[0, 0, 0], one[0, 1, 0], one[0, 0, 1], one[1, 1, 0], one[2, 0, 1] = 1.0, -1.0, -1.0, 1.0, 1.0

    def corner(u: Floats, v: Floats, w: Floats) -> Floats:
        terms = 6.0 * product(u, u, u, u) + 24.0 * (product(u, u, u, v) + product(u, u, u, w))
        terms += 24.0 * (product(u, u, v, v) + product(u, u, w, w)) + 60.0 * product(u, u, v, w)
        terms += 8.0 * (product(u, v, v, v) + product(u, w, w, w)) + 36.0 * (product(u, v, v, w) + product(u, v, w, w))
        terms += product(v, v, v, v) + product(w, w, w, w) + 6.0 * (product(v, v, v, w) + product(v, w, w, w))
        return terms + 12.0 * product(v, v, w, w)

    def across(u: Floats, v: Floats, w: Floats) -> Floats:
        terms = product(v, v, v, v) + product(w, w, w, w) + 6.0 * (product(v, v, v, w) + product(v, w, w, w))
        terms += 12.0 * product(v, v, w, w) + 2.0 * (product(u, v, v, v) + product(u, w, w, w))
        return terms + 6.0 * (product(u, v, v, w) + product(u, v, w, w))

    def behind(u: Floats, v: Floats) -> Floats:
        return product(u, u, u, u) + 2.0 * product(u, u, u, v)

    turned = [(one[k], one[(k + 1) % 3], one[(k + 2) % 3]) for k in range(3)]
    found = [corner(*t) for t in turned] + [across(w, u, v) for u, v, w in turned]
    found += [behind(u, other) for u, v, w in turned for other in (v, w)]
    values = np.stack(found, axis=-1) / 12.0
    powers = np.arange(5.0)[:, None]

    def by_v(c: Floats) -> Floats:
        return np.concatenate([(powers[..., None] * c)[1:], np.zeros((1, 5, 12))])

    def by_w(c: Floats) -> Floats:
        return np.concatenate([(powers * c)[:, 1:], np.zeros((5, 1, 12))], axis=1)

    v, w = by_v(values), by_w(values)
    return tuple(c.reshape(25, 12) for c in (values, v, w, by_v(v), by_w(v), by_w(w)))


def _triangle_basis(v: Floats, w: Floats, jets: int) -> Floats:
    """(g,j,12) the quartic box splines; j: as in _quad_basis."""
    of_v, of_w = (np.stack([np.ones_like(t), t, t * t, t * t * t, t * t * t * t], axis=1) for t in (v, w))
    terms = (of_v[:, :, None] * of_w[:, None, :]).reshape(-1, 25)
    return np.stack([matmul(terms, table) for table in _box_spline()[:jets]], axis=1)


# The rules by which patches are evaluated.


@dataclass(frozen=True, eq=False)
class _Rule:
    """How patches (p,) are evaluated whose corners are alike: index (p,k) the vertices that they are sums of; limit
    (k,) the weights of the irregular corner, if there is one, else zero; controls (l,16 or 12,k) the weights of the
    controls of parts, less these; tangents (2,k) at the irregular corner. A patch without one has a single part."""

    index: Ints
    limit: Floats
    controls: Floats
    tangents: Floats

    @property
    def size(self) -> int:
        """How many corners the patches have."""
        return 4 if self.controls.shape[1] == 16 else 3

    def weights(self, u: Floats, v: Floats, jets: int) -> Floats:
        """(g,j,k) those of points and derivatives at parameters (g,)."""
        basis = _quad_basis if self.size == 4 else _triangle_basis
        if len(self.controls) == 1:
            return matmul(basis(u, v, jets), self.controls[0])
        level, part, local, scale = _parts(self.size, u, v)
        deep = (level < 1) | (3 * level > len(self.controls))
        table = np.where(deep, 0, 3 * (level - 1) + part)
        terms = basis(*local, jets)
        if self.size == 3:
            terms = np.where((part == 2)[:, None, None], _turned(terms), terms)
        terms *= np.stack([np.ones_like(scale), *[scale] * 2, *[scale * scale] * 3][:jets], axis=1)[:, :, None]
        result = np.zeros((len(u), jets, self.controls.shape[2]))
        for row in range(self.controls.shape[1]):
            result += terms[:, :, row, None] * self.controls[table, row][:, None]
        if deep.any():
            result[deep] = 0.0
            result[deep, 1:3] = self.tangents[: jets - 1]
        result[:, 0] += self.limit
        return result


def _parts(size: int, u: Floats, v: Floats) -> tuple[Ints, Ints, tuple[Floats, Floats], Floats]:
    """(g,) how often a patch is halved towards its corner, until parameters (g,) lie in one of the three other parts;
    which of these; the parameters there, and by what derivatives grow; the level is 0 in the corner itself."""
    reach = np.maximum(u, v) if size == 4 else u + v
    mantissa, exponent = np.frexp(reach)
    level = np.where(reach > 0.0, np.maximum(1 - exponent + (mantissa == 0.5), 1), 0)
    scale = np.ldexp(1.0, np.minimum(level, MOST_LEVELS))
    x, y = scale * u, scale * v
    right, up = x > 1.0, y > 1.0
    if size == 4:
        return level, np.where(right, up * 1, 2), (x - right, y - up), scale
    middle = ~right & ~up
    local = np.where(middle, x + y - 1.0, x - right), np.where(middle, 1.0 - x, y - up)
    return level, np.where(middle, 2, up * 1), local, scale


def _turned(terms: Floats) -> Floats:
    """(g,j,12) derivatives by the parameters of a triangle, of those by the parameters of the one in its middle."""
    rows = [terms[:, 0]]
    if terms.shape[1] > 1:
        p, q = terms[:, 1], terms[:, 2]
        rows += [p - q, p]
    if terms.shape[1] > 3:
        pp, pq, qq = terms[:, 3], terms[:, 4], terms[:, 5]
        rows += [pp - 2.0 * pq + qq, pp - pq, pp]
    return np.stack(rows, axis=1)


def _rules(net: _Net, size: int) -> tuple[list[_Rule], list[Ints], Ints]:
    """The rules, the patches (p,) of each, and (f,size) the half-edges of every patch, from its irregular corner on."""
    here = np.arange(len(net.corner)).reshape(-1, size)
    first = _irregular(net, size).reshape(-1, size).argmax(axis=1)
    sides = np.take_along_axis(here, (first[:, None] + np.arange(size)) % size, axis=1)
    turns = _turns(net)
    vertex = net.corner
    alike = np.stack([net.faces_around[vertex], net.is_open[vertex], net.kind[vertex], turns], axis=1)
    kinds, code = np.unique(alike, axis=0, return_inverse=True)
    signatures, of = np.unique(code.reshape(-1)[sides], axis=0, return_inverse=True)
    groups = [np.flatnonzero(of.reshape(-1) == number) for number in range(len(signatures))]
    rules = [
        _rule(net, sides[group], kinds[signature].tolist()) for group, signature in zip(groups, signatures, strict=True)
    ]
    return rules, groups, sides


def _turns(net: _Net) -> Ints:
    """(h,) how many faces lie clockwise of every half-edge up to a cut; 0 where they go all around."""
    turns = np.zeros(len(net.corner), dtype=np.intp)
    here = np.flatnonzero(net.is_open[net.corner] & ~net.is_cut)
    at = here.copy()
    while len(here):
        turns[here] += 1
        at = net.after[net.opposite[at]]
        going = ~net.is_cut[at]
        here, at = here[going], at[going]
    return turns


def _rule(net: _Net, sides: Ints, kinds: list[list[int]]) -> _Rule:
    """That of patches with half-edges (p,size); kinds: faces, whether they are open, kind and turns of each corner."""
    columns: list[Ints] = []
    for side, (faces, is_open, _, turns) in zip(sides.T, kinds, strict=True):
        at = side
        for _ in range(turns if is_open else 0):
            at = net.after[net.opposite[at]]
        columns.append(net.corner[side])
        for place in range(faces):
            columns.append(net.end[at])
            if sides.shape[1] == 4:
                columns.append(net.end[net.after[at]])
            last = net.before[at]
            at = net.opposite[last] if place < faces - 1 else at
        if is_open:
            columns.append(net.corner[last])
    index, of = _distinct(np.stack(columns, axis=1))
    return _Rule(index, *_weights_of_corners(tuple(map(tuple, kinds)), tuple(of.tolist())))


@lru_cache(maxsize=MOST_RULES)
def _weights_of_corners(kinds: tuple[tuple[int, ...], ...], of: tuple[int, ...]) -> tuple[Floats, Floats, Floats]:
    """What a rule has besides its index; kinds: as above; of (c,): which vertex of the index each one is that is met
    around the corners, one after the other."""
    rows, start, first = np.eye(max(of) + 1)[list(of)], list[_Ring](), 0
    for faces, is_open, kind, turns in kinds:
        size = faces * (len(kinds) - 2) + is_open
        around = rows[first + 1 : first + 1 + size]
        edges, across = (around[::2], around[1::2]) if len(kinds) == 4 else (around, around[:0])
        start.append(_Ring(rows[first], edges, across, not is_open, turns if is_open else 0, kind))
        first += size + 1
    if not _is_irregular(start[0]):
        return np.zeros(rows.shape[1]), _controls(start)[None], np.zeros((2, rows.shape[1]))
    limit = start[0].limit()
    at_corner, controls, levels = [ring.less(limit) for ring in start], list[Floats](), 0
    while levels < MOST_LEVELS:
        levels += 1
        parts, middle = _children(at_corner)
        at_corner = parts[0]
        others = parts[1:] if len(start) == 4 else [*parts[1:], middle]
        controls += [_controls(part) for part in others]
        if float(np.abs(at_corner[0].edges).max()) < LIMIT_OF_LEVELS:
            break
    ring, stacked = at_corner[0], np.array(controls)
    if ring.kind == VertexKind.BORDER and ring.faces == 1:
        # Both edges of the patch run along the border: what is across it is seen a little inside.
        none = np.zeros((1, rows.shape[1]), dtype=np.intp)
        beside = _Rule(none, limit, stacked, np.zeros((2, rows.shape[1])))
        inside = np.full(1, BESIDE_BORDER)
        return limit, stacked, beside.weights(inside, inside, 3)[0, 1:]
    return limit, stacked, float(2.0**levels) * np.array(ring.tangents())


def _distinct(index: Ints) -> tuple[Ints, Ints]:
    """The columns of index (p,c) that differ, and (c,) which of them each is: vertices come around several corners."""
    _, place, of = np.unique(index[:FEW], axis=1, return_index=True, return_inverse=True)
    first = place[of.reshape(-1)]
    alike = (index == index[:, first]).all(axis=0)
    kept, number = np.unique(np.where(alike, first, np.arange(len(first))), return_inverse=True)
    return np.ascontiguousarray(index[:, kept]), number.reshape(-1)


FEW = 16
"""So many patches tell which vertices may be the same in all of them."""


def _is_irregular(ring: _Ring) -> bool:
    regular = (4 if len(ring.across) else 6) if ring.closed else (2 if len(ring.across) else 3)
    kind = VertexKind.SMOOTH if ring.closed else VertexKind.BORDER
    return ring.faces != regular or ring.kind != kind


# The limit surface of a cage.


@dataclass(frozen=True, eq=False)
class LimitMesh:
    """A mesh on a limit surface.

    places (w,3): its vertices, on the surface; normals (n,3) there, zero where there is none, those on sharp edges once
    for each side, and vertex (n,), which of the places each stands at; triangles (t,3) of normals; patch (t,) on which
    they lie, parameters (t,3,2) of their corners there, source (t,) the face of the cage; sharp, net (e,2): the places
    at the ends of pieces of borders and creases, and of other edges of the cage.
    """

    places: Floats
    normals: Floats
    vertex: Ints
    triangles: Ints
    patch: Ints
    parameters: Floats
    source: Ints
    sharp: Ints
    net: Ints


@dataclass(frozen=True, eq=False)
class SubdivisionSurface:
    """The limit surface of a cage under a scheme of subdivision.

    Parameters
    ----------
    cage : Mesh
        Its faces are polygons for Catmull and Clark's scheme, triangles for Loop's. Vertices that no face has are left
        out. Edges with one face are borders; those with more than two, or whose faces run along them the same way, are
        creases.
    scheme : {"catmull-clark", "loop"}
        Bicubic B-splines where four quads meet at every vertex, quartic box splines where six triangles do.
    creases : (e, 2) array_like of int
        Edges that stay sharp, by the vertices at their ends, from 0.
    crease_angle_deg : float, optional
        Edges at which the cage turns by more stay sharp too.

    Raises
    ------
    InputError
        For another scheme, faces with four corners or more for Loop's, a face that comes to a vertex twice, creases
        that are no edges, an angle out of range, and cages that are too large.

    Notes
    -----
    Borders and creases are cubic B-splines through the limits of their vertices. A vertex stays where it is that has a
    single face, at which three or more sharp edges end, or at which pieces touch that have no edge in common. Where one
    crease ends it fades out.

    The surface is made of patches: faces of the cage after as many steps, none to two, as leave one irregular vertex to
    a face. Parameters u, v on a patch run from 0 to 1, on triangles with u + v up to 1. Error: points and first
    derivatives are right to rounding; nearer to an irregular vertex than about 1e-8 of its faces they are those of the
    vertex.

    Edge cases: where a smooth border has a single face, and around vertices that stay although faces go all around
    them, there is no normal at the vertex but that beside it. Second derivatives are not bounded there, as on the
    surface.

    Source: Catmull, Clark (1978); Loop (1987); Hoppe et al. (1994), DeRose, Kass, Truong (1998) for creases; Stam
    (1998) for the evaluation.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import geometry
    >>> from vectorplot.surfaces import SubdivisionSurface
    >>> ball = SubdivisionSurface(geometry.box((2, 2, 2)).moved(-1, -1, -1))
    >>> ball.patch_count
    24
    >>> ball.points([0], [0.0], [0.0]).round(9).tolist()
    [[-0.5, -0.5, -0.5]]
    """

    cage: Mesh
    scheme: str = "catmull-clark"
    creases: ArrayLike = ()
    crease_angle_deg: float | None = None

    def __post_init__(self) -> None:
        if self.scheme not in SCHEMES:
            raise unknown("subdivision", self.scheme, tuple(SCHEMES))
        wide = np.flatnonzero(self.cage.face_sizes > 3) if self.scheme == "loop" else np.zeros(0, dtype=np.intp)
        if len(wide):
            corners = int(self.cage.face_sizes[wide[0]])
            cause = f"face {int(wide[0]) + 1} has {corners} corners, loop takes triangles; catmull-clark takes all"
            raise InputError(f"subdivision: {cause}")
        angle = self.crease_angle_deg
        if angle is not None and not 0.0 <= angle <= 180.0:
            raise InputError(f"subdivision: a crease angle of {angle:g} degrees, expected 0 to 180")
        creases = np.asarray(self.creases)
        creases = np.zeros((0, 2), dtype=np.intp) if not creases.size else creases
        if creases.ndim != 2 or creases.shape[1] != 2 or creases.dtype.kind not in "iu":
            raise InputError("subdivision: creases are pairs of vertices, counted from 0")
        object.__setattr__(self, "creases", creases.astype(np.intp))

    @cached_property
    def _middle(self) -> Floats:
        """(3,) what coordinates are less while they are summed."""
        return np.asarray(self.cage.bounds.mean(axis=0))

    @cached_property
    def _net(self) -> _Net:
        points = self.cage.vertices[np.unique(self.cage.corners)] - self._middle
        return _refined_cage(self.cage, self.scheme, self.sharp, points)

    @cached_property
    def _patches(self) -> tuple[list[_Rule], list[Ints], Ints, Ints, Ints]:
        """The rules, the patches of each, the half-edges of patches, and (f,) the rule and the place there of each."""
        rules, groups, sides = _rules(self._net, SCHEMES[self.scheme])
        of, row = np.zeros(len(sides), dtype=np.intp), np.zeros(len(sides), dtype=np.intp)
        for number, group in enumerate(groups):
            of[group], row[group] = number, np.arange(len(group))
        return rules, groups, sides, of, row

    @property
    def patch_count(self) -> int:
        """How many patches there are."""
        return len(self._net.source)

    @property
    def source(self) -> Ints:
        """(f,) the face of the cage that each patch belongs to."""
        return self._net.source

    @property
    def sharp(self) -> Ints:
        """(e,2) the creases, by the vertices at their ends: those given, and those that turn by more than the angle."""
        own = np.asarray(self.creases, dtype=np.intp)
        angle = self.crease_angle_deg
        return own if angle is None else np.concatenate([own, sharp_edges(self.cage, angle)])

    def jets(self, patch: ArrayLike, u: ArrayLike, v: ArrayLike, count: int = 3) -> Floats:
        """Points and derivatives.

        Parameters
        ----------
        patch : (k,) array_like of int
            The numbers of patches, from 0.
        u, v : (k,) array_like of float
            Parameters on them.
        count : {1, 3, 6}
            How many to tell: the point; the derivatives by u and v too; the second ones by uu, uv, vv too.

        Returns
        -------
        (k, count, 3) array of float
            In world units.
        """
        rules, _, _, of, row = self._patches
        number = np.asarray(patch, dtype=np.intp)
        x, y = (np.clip(np.asarray(t, dtype=np.float64), 0.0, 1.0) for t in (u, v))
        result = np.empty((len(number), count, 3))
        for one in np.unique(of[number]).tolist():
            rule, own = rules[one], np.flatnonzero(of[number] == one)
            step = max(1, CHUNK // (count * rule.index.shape[1]))
            for some in (own[k : k + step] for k in range(0, len(own), step)):
                weights, index = rule.weights(x[some], y[some], count), rule.index[row[number[some]]]
                total = np.zeros((len(some), count, 3))
                for k in range(index.shape[1]):
                    total += weights[:, :, k, None] * self._net.points[index[:, k]][:, None]
                result[some] = total
        result[:, 0] += self._middle
        return result

    def points(self, patch: ArrayLike, u: ArrayLike, v: ArrayLike) -> Floats:
        """(k, 3) points, see jets."""
        return self.jets(patch, u, v, 1)[:, 0]

    def normals(self, patch: ArrayLike, u: ArrayLike, v: ArrayLike) -> Floats:
        """(k, 3) unit normals, see jets; zero where there is none."""
        found = self.jets(patch, u, v)
        return _unit(cross(found[:, 1], found[:, 2]))

    def mesh(self, cells: int) -> LimitMesh:
        """The mesh of patches that are each divided into so many cells along every side, 1 or more.

        The vertices of the cage, less those that no face has, come first in places.
        """
        net, sides = self._net, self._patches[2]
        size, patches = SCHEMES[self.scheme], len(net.source)
        a, b, corners, rim = _lattice(size, cells)
        number, own = net.sides
        at_corners, at_edges = (net.corner, len(net.points)), (number, len(own))
        apart = _numbers(at_corners, at_edges, net.forward, sides, cells, rim, len(a))
        at_corners, at_edges = (net.vertex[net.corner], net.vertices), (net.edge, net.edges)
        whole = _numbers(at_corners, at_edges, net.forward, sides, cells, rim, len(a))
        count, u, v = int(apart.max(initial=-1)) + 1, a / cells, b / cells
        normals, vertex = np.zeros((count, 3)), np.zeros(count, dtype=np.intp)
        places = np.zeros((int(whole.max(initial=-1)) + 1, 3))
        vertex[apart] = whole
        for some, (points, by_u, by_v) in self._on_lattice(net.points, u, v, 3):
            places[whole[some]], normals[apart[some]] = points, _unit(cross(by_u, by_v))
        normals[: len(net.points)][(net.kind == VertexKind.CORNER) & ~net.is_open] = 0.0
        along = whole[:, rim].reshape(patches, size, cells + 1)
        ends = np.stack([along[..., :-1], along[..., 1:]], axis=-1)
        return LimitMesh(
            places + self._middle,
            normals,
            vertex,
            apart[:, corners].reshape(-1, 3),
            np.repeat(np.arange(patches), len(corners)),
            np.tile(np.stack([u, v], axis=1)[corners], (patches, 1, 1)),
            np.repeat(net.source, len(corners)),
            _once(ends[net.is_cut[sides]]),
            _once(ends[(net.lined & ~net.is_cut)[sides]]),
        )

    def numbers(self, values: Floats, cells: int) -> Floats:
        """(w,k) what numbers (n,k) at the vertices of the cage, subdivided like its coordinates, are at the places of
        the mesh with so many cells; NaN near those that are NaN."""
        used = np.unique(self.cage.corners)
        net = _refined_cage(self.cage, self.scheme, self.sharp, values[used])
        a, b, _, rim = _lattice(SCHEMES[self.scheme], cells)
        at_corners, at_edges = (net.vertex[net.corner], net.vertices), (net.edge, net.edges)
        whole = _numbers(at_corners, at_edges, net.forward, self._patches[2], cells, rim, len(a))
        result = np.zeros((int(whole.max(initial=-1)) + 1, values.shape[1]))
        for some, (found,) in self._on_lattice(net.points, a / cells, b / cells, 1):
            result[whole[some]] = found
        return result

    def _on_lattice(self, values: Floats, u: Floats, v: Floats, jets: int) -> Iterator[tuple[Ints, list[Floats]]]:
        """Patches (p,), some at a time, and what values (n,k) at the vertices of the net are at parameters (g,) of
        each, and their derivatives: (p,g,k) each."""
        for rule, group in zip(*self._patches[:2], strict=True):
            weights = np.moveaxis(rule.weights(u, v, jets), 1, 0)
            step = max(1, CHUNK // (3 * len(u)))
            for some in (slice(k, k + step) for k in range(0, len(group), step)):
                points = values[rule.index[some]]
                yield group[some], [matmul(one, points) for one in weights]

    def deviations(self) -> Floats:
        """(f,) how far the middles of chords from side to side are off each patch, about."""
        a, b, _, _ = _lattice(SCHEMES[self.scheme], 2)
        points = np.zeros((self.patch_count, len(a), 3))
        for some, (found,) in self._on_lattice(self._net.points, a / 2.0, b / 2.0, 1):
            points[some] = found
        lines = [(0, 1, 2), (3, 4, 5), (6, 7, 8), (0, 3, 6), (1, 4, 7), (2, 5, 8), (0, 4, 8)]
        lines = lines if self.scheme == "catmull-clark" else [(0, 1, 2), (0, 3, 5), (2, 4, 5)]
        off = [norm(points[:, m] - 0.5 * (points[:, s] + points[:, e])) for s, m, e in lines]
        return np.asarray(np.max(off, axis=0))


@dataclass(frozen=True, eq=False)
class LimitPlaces:
    """Where the triangles (t,) of a mesh lie on a limit surface: on which patch (t,) and at which parameters (t,3,2) of
    it their corners do; matrix (4,4): how all was moved since."""

    surface: SubdivisionSurface
    patch: Ints
    parameters: Floats
    matrix: Floats

    @property
    def source(self) -> Ints:
        """(t,) the face of the cage that each triangle belongs to."""
        return self.surface.source[self.patch]

    def above(self, triangle: Ints, weights: Floats) -> tuple[Floats, Floats]:
        """(k,3) the points of the surface over those of triangles with barycentric coordinates (k,3), and the unit
        normals there, zero where there is none."""
        points, by_u, by_v = self._jets(triangle, weights, 3)
        return points + self.matrix[:3, 3], self._normals(by_u, by_v)

    def bends(self, triangle: Ints, weights: Floats, ways: Floats) -> Floats:
        """(k,) how strongly the surface bends towards its normal there, along the tangential parts of directions (k,3);
        NaN where there is no tangent plane."""
        _, by_u, by_v, uu, uv, vv = self._jets(triangle, weights, 6)
        normals = self._normals(by_u, by_v)
        e, f, g, p, q = dot(by_u, by_u), dot(by_u, by_v), dot(by_v, by_v), dot(ways, by_u), dot(ways, by_v)
        with np.errstate(all="ignore"):
            a, b = (g * p - f * q) / (e * g - f * f), (e * q - f * p) / (e * g - f * f)
        return np.asarray(dot(normals, uu) * a * a + 2.0 * dot(normals, uv) * a * b + dot(normals, vv) * b * b)

    def _jets(self, triangle: Ints, weights: Floats, count: int) -> list[Floats]:
        """(k,3) each: points, less where the matrix moves them to, and derivatives."""
        at = (weights[:, :, None] * self.parameters[triangle]).sum(axis=1)
        found = self.surface.jets(self.patch[triangle], at[:, 0], at[:, 1], count)
        return [matmul(found[:, k], self.matrix[:3, :3].T) for k in range(count)]

    def _normals(self, by_u: Floats, by_v: Floats) -> Floats:
        return _unit(cross(by_u, by_v) * np.where(determinant(self.matrix[:3, :3]) < 0.0, -1.0, 1.0))

    def transformed(self, matrix: ArrayLike) -> LimitPlaces:
        """The same under a 4x4 matrix acting on columns; a mirror lists the corners of triangles the other way round,
        as it does in the mesh."""
        m = np.asarray(matrix, dtype=np.float64)
        mirrored = determinant(m[:3, :3]) < 0.0
        parameters = self.parameters[:, ::-1] if mirrored else self.parameters
        return replace(self, parameters=parameters, matrix=matmul(m, self.matrix))


def _unit(vectors: Floats) -> Floats:
    """(...,3) unit vectors; zero for those without length."""
    length = np.sqrt(dot(vectors, vectors))[..., None]
    return np.asarray(vectors / np.where(length > LEAST_DIVISOR, length, np.inf))


def _once(ends: Ints) -> Ints:
    """(e,2) each pair of ends once."""
    ends = np.sort(ends.reshape(-1, 2), axis=1)
    return np.unique(ends, axis=0)


def _lattice(size: int, cells: int) -> tuple[Floats, Floats, Ints, Ints]:
    """The points a, b (n,) of a patch divided into cells, the triangles (t,3) between them, and the points along its
    sides (size * (cells + 1),), side after side."""
    grid_a, grid_b = np.meshgrid(np.arange(cells + 1), np.arange(cells + 1))
    kept = np.ones(grid_a.shape, dtype=np.bool_) if size == 4 else grid_a + grid_b <= cells
    number = np.full(grid_a.shape, -1)
    number[kept] = np.arange(int(kept.sum()))
    a, b = grid_a[kept], grid_b[kept]

    def at(x: Ints, y: Ints) -> Ints:
        return number[y, x]

    inner = (grid_a < cells) & (grid_b < cells) & (kept if size == 4 else grid_a + grid_b < cells)
    x, y = grid_a[inner], grid_b[inner]
    if size == 4:
        low = np.stack([at(x, y), at(x + 1, y), at(x + 1, y + 1)], axis=1)
        high = np.stack([at(x, y), at(x + 1, y + 1), at(x, y + 1)], axis=1)
        corners = np.concatenate([low, high])
    else:
        low = np.stack([at(x, y), at(x + 1, y), at(x, y + 1)], axis=1)
        more = x + y < cells - 1
        x, y = x[more], y[more]
        corners = np.concatenate([low, np.stack([at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)], axis=1)])
    t, full, none = np.arange(cells + 1), np.full(cells + 1, cells), np.zeros(cells + 1, dtype=np.intp)
    sides = [(t, none), (full, t), (cells - t, full), (none, cells - t)]
    if size == 3:
        sides = [(t, none), (cells - t, t), (none, cells - t)]
    return a.astype(np.float64), b.astype(np.float64), corners, np.concatenate([at(*side) for side in sides])


def _numbers(
    vertices: tuple[Ints, int], edges: tuple[Ints, int], forward: Bools, sides: Ints, cells: int, rim: Ints, count: int
) -> Ints:
    """(f,count) the numbers of the points of the lattices of all patches: first those of vertices, then those along
    edges, then the others. vertices, edges: the number (h,) of the one or the other for each half-edge, and how many
    there are; forward (h,): which way points on an edge are counted."""
    inner = np.setdiff1d(np.arange(count), rim)
    result = np.empty((len(sides), count), dtype=np.intp)
    base = vertices[1] + edges[1] * (cells - 1)
    result[:, inner] = base + np.arange(len(sides) * len(inner)).reshape(len(sides), len(inner))
    along, step = rim.reshape(sides.shape[1], cells + 1), np.arange(cells - 1)
    for place, side in zip(along, sides.T, strict=True):
        first = vertices[1] + edges[0][side][:, None] * (cells - 1)
        result[:, place[1:-1]] = first + np.where(forward[side][:, None], step, cells - 2 - step)
        result[:, place[0]] = vertices[0][side]
    return result


def sharp_edges(mesh: Mesh, angle_deg: float) -> Ints:
    """(e,2) the vertices at the ends of the edges of a mesh at which two faces turn by more than an angle."""
    start, end = mesh.corners, mesh.corners[mesh.next_corner]
    key = np.minimum(start, end) * len(mesh.vertices) + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    same = np.flatnonzero(np.diff(key[order]) == 0)
    one, two = order[same], order[same + 1]
    normals = mesh.face_normals
    turn = dot(normals[mesh.corner_face[one]], normals[mesh.corner_face[two]])
    sharp = one[turn < np.cos(np.radians(angle_deg))]
    return np.stack([start[sharp], end[sharp]], axis=1)

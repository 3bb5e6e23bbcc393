"""Smooth surfaces as meshes that know the true normals at their vertices, as fine as is asked for and no finer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.errors import InputError
from vectorplot.features.edge_splitting import LOOKS, NONE, Demand, Edges, Net, Vertices, refined
from vectorplot.features.implicit.implicit_singular_lines import SingularLines, singular_lines, usual_gradient
from vectorplot.features.implicit.polygonize import onto_surface, polygonized, settled_mesh
from vectorplot.features.implicit.singular_set import led_into_singular_set
from vectorplot.features.normal_jumps import cut_where_normals_jump
from vectorplot.features.parametric.holed_triangles import cut_at_holes
from vectorplot.features.parametric.holes import beside_rim_chords, is_known, ways_between
from vectorplot.features.parametric.poles import Pole, poles
from vectorplot.features.tessellation import UNEVEN, grid_numbers
from vectorplot.features.zeros.grid_triangulation import triangulate_surface
from vectorplot.geometry.budget import USUAL as USUAL_BUDGET
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import cross, dot
from vectorplot.surfaces.jumps import jumps
from vectorplot.surfaces.normals import unit_normals
from vectorplot.surfaces.parts import creases
from vectorplot.surfaces.surface import Domain, ImplicitSurface, Surface, is_implicit, is_parametrised
from vectorplot.tolerances.of_parameters import ASIDE_OF_CREASE, ON_BORDER_OF_DOMAIN, TURNED_OVER
from vectorplot.tolerances.of_values import VANISHED_GRADIENT

FEWEST, USUAL, FINEST = (2, 4), 16, 1024
"""Columns, and rows, of the first grid: so many at least for open and for closed surfaces, doubled until they are
enough, or as many as is usual; more where most sides are too coarse even then."""

HALF = 0.5
"""By how many times sides of the first grid may be too coarse, in the mean, so that its diagonals are fine enough."""

MOST = 0.75
"""Part of the sides that are too coarse when all of them are made finer."""

IMPLICIT_CELLS = 32
"""Cells along the longest side of an implicit surface's box."""

TOO_LONG = 3.0
"""Times the length that the slopes at both ends of a side tell: a longer one may lie across a jump of the surface."""

Allowed = Callable[[Floats], Floats]
"""How far (...) triangles may be off a surface at points (..., 3)."""

TURN = np.radians(8.5)
"""By so much the normals at the ends of a side may differ, or flat shades would come out jagged."""

JUMP = np.radians(45.0)
"""Normals that differ by more at neighbouring looks jump, as on creases: finer sides would not help."""

ON_RIM = 1.0
"""The third number of a place on the rim of a hole."""

CLOSE_BY = 1.0 / 128.0
"""Part of the length of a side, both in parts of the domain, by which the places over it may be moved to be nearer."""

STEPS = 5
"""Steps to places that are nearer."""

INSIDE = 0.75
"""In the middle of a triangle the surface may be farther off than over its sides, by a third."""


@dataclass(frozen=True, eq=False)
class Facets:
    """A mesh, and the unit normals (v,3) of the true surface at its vertices, NaN where it has none; complete: whether
    it is as fine as was asked for; sharp (v,): the vertices on sharp edges, with the normal of one side."""

    mesh: Mesh
    normals: Floats
    complete: bool
    sharp: Bools


class AllSidesAlike:
    """What a Demand has that treats all sides of triangles alike, outlines and borders among them."""

    def folds(self, points: Floats, normals: Floats) -> Floats:
        """None."""
        return np.zeros((0, len(points)))

    @property
    def outlines(self) -> int:
        """None."""
        return 0

    def border_excess(self, edges: Edges) -> Floats:
        """(k,n) as Demand: borders are as all sides."""
        return np.zeros(edges.t.shape)


@dataclass(frozen=True)
class Within(AllSidesAlike):
    """Triangles that are no farther from the surface than is allowed, and on which normals turn by no more than TURN,
    or nearly so: along rulings they turn though sides lie on the surface."""

    allowed: Allowed

    def excess(self, edges: Edges) -> Floats:
        """(k,n) as Demand: the larger one of the distances and the turning of the normals, as parts of their limits."""
        far = off_chords(edges) / (INSIDE * self.allowed(edges.at.points))
        return np.asarray(np.maximum(far, turning(edges) / TURN))


def off_chords(edges: Edges) -> Floats:
    """(k,n) how far the surface is from the sides themselves, at the vertices over them."""
    chord = edges.end.points - edges.start.points
    length = np.linalg.norm(chord, axis=-1, keepdims=True)
    way = np.divide(chord, length, out=np.zeros_like(chord), where=length > 0.0)
    arm = edges.at.points - edges.start.points
    along = np.clip((arm * way).sum(axis=-1, keepdims=True), 0.0, length)
    return np.asarray(np.linalg.norm(arm - along * way, axis=-1))


def turning(edges: Edges) -> Floats:
    """(n,) by how much normals turn from end to end, as far as they do so smoothly."""
    nodes = np.stack((edges.start.normals, *edges.at.normals[: len(LOOKS)], edges.end.normals))
    steps = np.arccos(np.clip((nodes[1:] * nodes[:-1]).sum(axis=-1), -1.0, 1.0))
    smooth = np.isfinite(steps) & (steps < JUMP)
    return np.asarray(np.where(smooth, steps, 0.0).sum(axis=0))


def facets(shape: Surface | ImplicitSurface, demand: Demand, most: int = USUAL_BUDGET.facets) -> Facets:
    """Triangles of a smooth surface as fine as the demand says, every vertex on the surface.

    Triangles turn as u to v does; those of an implicit surface are counter-clockwise from where F > 0. Vertices on
    seams and at poles are one; neighbours of different sizes share their vertices.
    Error: the demand is kept at LOOKS of every side, and where it crosses a fold; what is smaller may be missed, and
    where it calls for more than most triangles it is not kept. Sides that lead into a hole end at its rim, and those
    along a rim follow it; cuspidal edges lie on sides, up to their chords.
    Errors: InputError for what is no smooth surface.
    Degenerate: triangles in holes, those without area, and those beneath which the surface jumps are left out.
    Source: Glaeser, section 8.4 (polygonised surfaces).
    """
    if is_parametrised(shape):
        patch = _Patch(shape, tuple(poles(shape)))
        net = _without_jumps(shape, refined(_first_net(shape, demand), patch, demand, most))
        net, turned = cut_where_normals_jump(net, patch)
        return _facets(net, turned | np.isin(net.vertices.places[:, 1], creases(shape)))
    if is_implicit(shape):
        level = _level(shape)
        net = refined(level.net, level, demand, most)
        return _facets(net, np.zeros(len(net.vertices.points), dtype=np.bool_))
    raise InputError(f"a {type(shape).__name__} is no smooth surface")


def _without_jumps(surface: Surface, net: Net) -> Net:
    """The net without triangles with a side along which the surface jumps.

    Only sides that are long beside what the derivatives at both ends make of them are looked at.
    """
    places, points = net.vertices.places, net.vertices.points
    a, b = (x.ravel() for x in (net.triangles, np.roll(net.triangles, -1, axis=1)))
    way = ways_between(surface.domain, places[a, :2], places[b, :2])
    with np.errstate(all="ignore"):
        along_u, along_v = surface.partials(*places[:, :2].T)
        expected = [np.linalg.norm(along_u[k] * way[:, :1] + along_v[k] * way[:, 1:], axis=1) for k in (a, b)]
        long = np.linalg.norm(points[b] - points[a], axis=1) > TOO_LONG * np.maximum(*expected)
    side = np.flatnonzero(long)
    torn = np.zeros(len(a), dtype=np.bool_)
    torn[side] = jumps(surface, places[a][side, :2], places[a][side, :2] + way[side])
    return replace(net, triangles=net.triangles[~torn.reshape(-1, 3).any(axis=1)])


def _facets(net: Net, sharp: Bools) -> Facets:
    triangles = net.triangles[net.vertices.known[net.triangles].all(axis=1)]
    used, corners = np.unique(triangles, return_inverse=True)
    vertices = net.vertices.some(used)
    return Facets(
        Mesh.from_triangles(vertices.points, corners.reshape(-1, 3)), vertices.normals, net.complete, sharp[used]
    )


@dataclass(frozen=True, eq=False)
class _Patch:
    """A parametrised surface between vertices whose places are (u, v), and 1 on the rim of a hole, 0 elsewhere."""

    surface: Surface
    poles: tuple[Pole, ...]

    @cached_property
    def creases(self) -> Floats:
        """The v of sharp edges."""
        return creases(self.surface)

    def __call__(self, start: Vertices, end: Vertices, t: Floats, border: Bools) -> Vertices:
        domain = self.surface.domain
        first, last = self._without_poles(start.places, end.places)
        way = ways_between(domain, first[:, :2], last[:, :2])
        places = np.column_stack([first[:, :2] + t[:, None] * way, np.zeros(len(t))])
        found = self.at(_wrapped(domain, places.copy()))
        # A border between two places on a rim lies along it; what leads over a hole goes round it.
        rim = border & (first[:, 2] == ON_RIM) & (last[:, 2] == ON_RIM)
        rim = np.flatnonzero(rim | (~found.known & start.known & end.known))
        if not len(rim):
            return found
        places[rim, :2], on = beside_rim_chords(self.surface, first[rim, :2], first[rim, :2] + way[rim], t[rim])
        places[rim, 2] = np.where(on, ON_RIM, 0.0)
        moved = self.at(_wrapped(domain, places[rim]))
        for own, new in ((found.places, moved.places), (found.points, moved.points), (found.normals, moved.normals)):
            own[rim] = new
        return found

    def ends(self, start: Vertices, end: Vertices) -> tuple[Vertices, Vertices]:
        """The ends of sides; on the rim of a cap normals are those of the cap for sides that lead into it."""
        sharp = [np.isin(some.places[:, 1], self.creases) for some in (start, end)]
        return self._sided(start, end, sharp[0] & ~sharp[1]), self._sided(end, start, sharp[1] & ~sharp[0])

    def nearer(self, edges: Edges) -> Vertices:
        """(k,n) as Between, found by the method of Gauss and Newton with steps halved where they lead astray."""
        shape = edges.t.shape
        chord = edges.start.points + edges.t[..., None] * (edges.end.points - edges.start.points)
        points = chord.reshape(-1, 3)
        found = Vertices(*(some.reshape(-1, 3) for some in (edges.at.places, edges.at.points, edges.at.normals)))
        size = np.array(self.surface.domain.size)
        first, last = self._without_poles(edges.start.places, edges.end.places)
        way = ways_between(self.surface.domain, first[:, :2], last[:, :2]) / size
        reach = CLOSE_BY * np.tile(np.hypot(*way.T), shape[0])
        from_start, scale = np.zeros((len(points), 2)), np.ones(len(points))
        for _ in range(STEPS):
            step = scale[:, None] * _toward(self.surface, found, points)
            # Along the axes, so that the place stays close by.
            moved = from_start + step
            close = np.hypot(*(moved / size).T) <= reach
            tried = self.at(
                _wrapped(self.surface.domain, np.column_stack([found.places[:, :2] + step, found.places[:, 2]]))
            )
            better = np.linalg.norm(tried.points - points, axis=1) < np.linalg.norm(found.points - points, axis=1)
            better &= close & is_known(self.surface, found.places[:, :2] + step)
            scale = np.where(better, 1.0, 0.5 * scale)
            from_start = np.where(better[:, None], moved, from_start)
            found = Vertices(
                *(
                    np.where(better[:, None], new, old)
                    for new, old in (
                        (tried.places, found.places),
                        (tried.points, found.points),
                        (tried.normals, found.normals),
                    )
                )
            )
        return Vertices(*(some.reshape(*shape, 3) for some in (found.places, found.points, found.normals)))

    def turned(self, corners: Vertices) -> Bools:
        """(t,) as Between."""
        places = corners.places
        found = np.zeros(len(places), dtype=np.bool_)
        if not (places[:, :, 2] == ON_RIM).any():
            return found
        # All of the line that is a pole is one point.
        whole = np.ones(len(places), dtype=np.bool_)
        for pole in self.poles:
            whole &= (places[:, :, pole.axis] != pole.place).all(axis=1)
        _, *ways = self._ways(places[whole])
        one, two = (way / self.surface.domain.size for way in ways)
        longest = np.maximum(np.maximum(dot(one, one), dot(two, two)), dot(two - one, two - one))
        area: Floats = np.asarray(cross(one, two))
        found[whole] = area < TURNED_OVER * longest
        return found

    def inside(self, corners: Vertices) -> Bools:
        """(t,) as Between: of triangles between three places on a rim those with the surface in their middle."""
        found = np.ones(len(corners.places), dtype=np.bool_)
        on_rim = np.flatnonzero((corners.places[:, :, 2] == ON_RIM).all(axis=1))
        if len(on_rim):
            first, one, two = self._ways(corners.places[on_rim])
            found[on_rim] = is_known(self.surface, first + (one + two) / 3.0)
        return found

    def _ways(self, places: Floats) -> tuple[Floats, Floats, Floats]:
        """The first ones of the places (t,3,3) of corners, and the ways (t,2) from there to the two others."""
        first, *others = np.moveaxis(places[:, :, :2], 1, 0)
        one, two = (ways_between(self.surface.domain, first, other) for other in others)
        return first, one, two

    def _sided(self, own: Vertices, other: Vertices, which: Bools) -> Vertices:
        """Vertices, some of them with the normals that they have on the way to others."""
        if not which.any():
            return own
        u, v = own.places[which, :2].T
        normals = own.normals.copy()
        with np.errstate(all="ignore"):
            normals[which] = unit_normals(self.surface, u, v + ASIDE_OF_CREASE * (other.places[which, 1] - v))
        return replace(own, normals=normals)

    def at(self, places: Floats) -> Vertices:
        """The vertices at some places (n,3)."""
        with np.errstate(all="ignore"):
            points = np.array(self.surface.points(places[:, 0], places[:, 1]), dtype=np.float64)
            normals = unit_normals(self.surface, places[:, 0], places[:, 1])
        return Vertices(places, points, normals)

    def _without_poles(self, start: Floats, end: Floats) -> tuple[Floats, Floats]:
        """Places of the ends of sides: all of the line that is a pole is one point, and a side goes straight to it."""
        first, last = start.copy(), end.copy()
        for pole in self.poles:
            for own, other in ((first, end), (last, start)):
                at = own[:, pole.axis] == pole.place
                own[at, 1 - pole.axis] = other[at, 1 - pole.axis]
        return first, last


def _toward(surface: Surface, vertices: Vertices, points: Floats) -> Floats:
    """(n,2) steps in the domain from vertices (n,) of a surface that lead nearest to points (n,3), were it flat."""
    with np.errstate(all="ignore"):
        along_u, along_v = surface.partials(*vertices.places[:, :2].T)
        off = points - vertices.points
        uu, uv, vv = dot(along_u, along_u), dot(along_u, along_v), dot(along_v, along_v)
        u, v = dot(along_u, off), dot(along_v, off)
        steps = np.stack([vv * u - uv * v, uu * v - uv * u], axis=1) / (uu * vv - uv * uv)[:, None]
    finite: Bools = np.asarray(np.isfinite(steps).all(axis=1))
    return np.where(finite[:, None], steps, 0.0)


def _wrapped(domain: Domain, places: Floats) -> Floats:
    """Places moved by whole periods into the domain."""
    starts = (domain.u_start, domain.v_start)
    for axis, (closed, size) in enumerate(zip((domain.closed_u, domain.closed_v), domain.size, strict=True)):
        if closed:
            places[:, axis] -= size * np.floor((places[:, axis] - starts[axis]) / size)
    return places


def _first_net(surface: Surface, demand: Demand) -> Net:
    """A grid that has as few columns and rows as it may, but not so few that something between its lines is missed."""
    domain, patch = surface.domain, _Patch(surface, ())
    columns = _enough(lambda count: _lines(patch, count, across=True), domain.closed_u, demand)
    rows = _enough(lambda count: _lines(patch, count, across=False), domain.closed_v, demand)
    u, v = domain.grid(columns, rows)
    if not patch.at(_on_grid(u, v).reshape(-1, 3)).known.all():
        # Beside a line of the grid along a rim nobody knew on which side the surface is.
        u, v = (_uneven(lines, seed) for seed, lines in enumerate((u, v)))
    # No side of a triangle may lead over a sharp edge.
    sharp = creases(surface)
    near = np.abs(v[:, None] - sharp) <= ON_BORDER_OF_DOMAIN * domain.size[1]
    v = np.sort(np.concatenate([v[~near.any(axis=1)], sharp]))
    rows = len(v) - 1
    places = _on_grid(u, v).reshape(-1, 3)
    number = grid_numbers(surface, columns, rows).ravel()
    vertices = patch.at(places)
    grid = vertices.points.reshape(columns + 1, rows + 1, 3)
    cut, _ = triangulate_surface(grid, closed_u=domain.closed_u, closed_v=domain.closed_v)
    triangles = number[cut]
    triangles = triangles[(triangles != np.roll(triangles, -1, axis=1)).all(axis=1)]
    holed = cut_at_holes(surface, places[:, :2], triangles, vertices.known)
    new = np.column_stack([holed.places[len(places) :], np.full(len(holed.places) - len(places), ON_RIM)])
    vertices.places[holed.on_rim[: len(places)], 2] = ON_RIM
    return Net(vertices.joined(patch.at(_wrapped(domain, new))), holed.triangles)


def _uneven(lines: Floats, seed: int) -> Floats:
    """Lines of a grid, all but the first and the last one moved by up to UNEVEN of the way to the next."""
    # The same numbers every time: a picture made twice is the same.
    moves = np.random.default_rng(seed).uniform(-UNEVEN, UNEVEN, len(lines))
    moves[[0, -1]] = 0.0
    return np.asarray(lines + moves * (lines[1] - lines[0]))


def _on_grid(u: Floats, v: Floats) -> Floats:
    """(m,n,3) the places of a grid, none of them on a rim."""
    return np.stack([*np.meshgrid(u, v, indexing="ij"), np.zeros((len(u), len(v)))], axis=-1)


def _enough(lines: Callable[[int], Edges], closed: bool, demand: Demand) -> int:
    """How many parts of lines of a grid are enough to begin with."""
    count = FEWEST[int(closed)]
    while True:
        sides = lines(count)
        # What lies in a hole is not cut at all.
        inside = sides.start.known | sides.end.known
        excess = np.nan_to_num(demand.excess(sides.some(inside)), nan=2.0).max(axis=0)
        if not len(excess):
            return USUAL
        if count < USUAL:
            if excess.max() <= 1.0:
                return count
            count *= 2
            continue
        most = float(np.quantile(excess, 1.0 - MOST))
        if most <= 1.2 * HALF or count == FINEST:
            return count
        # Distances fall with the square of the length, what turns along rulings with the length itself.
        count = min(int(np.ceil(count * np.sqrt(most / HALF))), FINEST)


def _lines(patch: _Patch, count: int, across: bool) -> Edges:
    """Some lines of a grid in so many parts each, along u (across) or along v."""
    domain = patch.surface.domain
    u, v = domain.grid(*((count, USUAL) if across else (USUAL, count)))
    places = _on_grid(u, v)
    places = places if across else places.swapaxes(0, 1)
    first, last = places[:-1].reshape(-1, 3), places[1:].reshape(-1, 3)
    t = np.repeat(np.array(LOOKS)[:, None], len(first), axis=1)
    at = patch.at((first + t[..., None] * (last - first)).reshape(-1, 3))
    looks = Vertices(*(some.reshape(*t.shape, -1) for some in (at.places, at.points, at.normals)))
    return Edges(patch.at(first), patch.at(last), looks, t, np.full(t.shape, NONE))


def _level(surface: ImplicitSurface) -> _Level:
    """An implicit surface with a mesh to begin with, that ends on its singular lines."""
    mesh = polygonized(surface, IMPLICIT_CELLS)
    lines = singular_lines(surface, mesh)
    if not len(lines):
        mesh = settled_mesh(surface, IMPLICIT_CELLS)[0]
    return _Level(surface, led_into_singular_set(surface, mesh, lines), lines)


@dataclass(frozen=True, eq=False)
class _Level:
    """An implicit surface between vertices, a mesh of it to begin with, and its singular lines; the places of vertices
    are the points."""

    surface: ImplicitSurface
    mesh: Mesh
    lines: SingularLines

    @cached_property
    def net(self) -> Net:
        """The triangles of the mesh."""
        return Net(self.at(self.mesh.vertices), self.mesh.corners.reshape(-1, 3))

    @cached_property
    def least(self) -> float:
        """The length of gradients that are not but for rounding."""
        return VANISHED_GRADIENT * usual_gradient(self.surface, self.mesh.vertices)

    def __call__(self, start: Vertices, end: Vertices, t: Floats, border: Bools) -> Vertices:
        first, last = start.points, end.points
        low, high = np.asarray(self.surface.box, dtype=np.float64)
        fixed = (first == last) & ((first == low) | (first == high))
        length = np.linalg.norm(last - first, axis=1)
        between = first + t[:, None] * (last - first)
        points, _ = onto_surface(self.surface, between, reach=length, fixed=fixed)
        along = np.flatnonzero(np.isnan(start.normals).any(axis=1) & np.isnan(end.normals).any(axis=1))
        on_line, on = self.lines.onto(between[along], HALF * length[along])
        points[along[on]] = on_line[on]
        return self.at(np.clip(points, low, high))

    def ends(self, start: Vertices, end: Vertices) -> tuple[Vertices, Vertices]:
        """The ends of sides as they are."""
        return start, end

    def turned(self, corners: Vertices) -> Bools:
        """None: there are no rims."""
        return np.zeros(len(corners.places), dtype=np.bool_)

    def nearer(self, edges: Edges) -> Vertices:
        """Those over the sides: they were looked for near these."""
        return edges.at

    def inside(self, corners: Vertices) -> Bools:
        """All of them."""
        return np.ones(len(corners.places), dtype=np.bool_)

    def at(self, points: Floats) -> Vertices:
        """The vertices at some points (n,3) of the surface."""
        with np.errstate(all="ignore"):
            slopes = np.asarray(self.surface.gradients(points), dtype=np.float64)
            length = np.linalg.norm(slopes, axis=1, keepdims=True)
            normals = np.where(length > self.least, slopes / length, np.nan)
        return Vertices(points, points, normals)

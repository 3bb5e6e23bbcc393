"""Smooth surfaces as meshes that know the true normals at their vertices, as fine as is asked for and no finer."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any, Protocol, Self, runtime_checkable

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.curve_tracing import Pole, poles
from vectorplot.features.edge_splitting import (
    LOOKS,
    NONE,
    AllSidesAlike,
    Between,
    Criterion,
    Edges,
    Net,
    Vertices,
    divided,
    refined,
    surface_numbers,
)
from vectorplot.features.grid_triangulation import triangulate_surface
from vectorplot.features.hole_rims import cut_at_holes, cut_at_trims
from vectorplot.features.holes import beside_rim_chords, in_domain, is_known, ways_between
from vectorplot.features.implicit_singular_lines import (
    SingularLines,
    default_gradient,
    led_into_singular_set,
    singular_lines,
)
from vectorplot.features.patches import UNEVEN, seam_numbers
from vectorplot.features.polygonization import BOXED, onto_surface, polygonized, settled_from, sides_of
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import USUAL as DEFAULT_BUDGET
from vectorplot.geometry.budget import in_turn
from vectorplot.geometry.chord_refinement import bisected
from vectorplot.geometry.connectivity import edges_of
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import all_components, all_finite, any_component, component_sum, cross, dot, norm
from vectorplot.surfaces.capped_bodies import Capped, Frustum, capped_quadric_of, round_body_of
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import Sphere
from vectorplot.surfaces.stacked import (
    ExactRows,
    StackedSurfaces,
    dimensions_of,
    jumps,
    points_and_normals,
    unit_normals,
    unit_normals_of,
)
from vectorplot.surfaces.surface import (
    Domain,
    FirstJets,
    ImplicitSurface,
    Surface,
    first_jets,
    is_implicit,
    is_parametrised,
)
from vectorplot.surfaces.trimmed import creases, trims_of
from vectorplot.tolerances import (
    ASIDE_OF_CREASE,
    FLAT_COSINE,
    ON_BORDER_OF_DOMAIN,
    SAME_NORMAL_COSINE,
    TURNED_OVER,
    VANISHED_GRADIENT,
)

# Nets of triangles on surfaces with parameters.

FEWEST, USUAL, FINEST = (2, 4), 16, 1024
"""Columns, and rows, of the first grid: so many at least for open and for closed surfaces, doubled until they are
enough, or as many as is usual; more where most sides are too coarse even then."""

HALF = 0.5
"""By how many times sides of the first grid may be too coarse, in the mean, so that its diagonals are fine enough."""

MOST = 0.75
"""Part of the sides that are too coarse when all of them are made finer."""

CLOSE_BY = 1.0 / 128.0
"""Part of the length of a side, both in parts of the domain, by which the places over it may be moved to be nearer."""

ON_RIM = 1.0
"""The third number of a place on the rim of a hole."""

STEPS = 5
"""Steps to places that are nearer."""

TOO_LONG = 3.0
"""Times the length that the slopes at both ends of a side tell: a longer one may lie across a jump of the surface."""


@dataclass(frozen=True, eq=False)
class Patch:
    """A parametrised surface between vertices whose places are (u, v), and 1 on the rim of a hole, 0 elsewhere."""

    surface: Surface
    poles: tuple[Pole, ...]

    @cached_property
    def creases(self) -> Floats:
        """The v of sharp edges."""
        return creases(self.surface)

    def on_crease(self, places: Floats) -> Bools:
        """(n,) which places (n,d) are on sharp edges: where the rim of a hole meets one, its place is next to it."""
        off = np.abs(places[:, 1:2] - self.creases)
        return np.asarray((off <= ON_BORDER_OF_DOMAIN * self.surface.domain.size[1]).any(axis=1), dtype=np.bool_)

    def surface_at(self, places: Floats) -> Surface:
        """What is asked for places (n,d)."""
        return self.surface

    def on(self, places: Floats, numbers: Ints) -> Floats:
        """(s*n,d) places (n,3) on each of some surfaces (s,), by their numbers; there is but one."""
        return places

    def __call__(self, start: Vertices, end: Vertices, t: Floats, border: Bools) -> Vertices:
        """The vertices over parts t of sides, on the surface; border: of sides at its borders."""
        domain = self.surface.domain
        first, last = self._without_poles(start.places, end.places)
        way = ways_between(domain, first[:, :2], last[:, :2])
        places = np.column_stack([first[:, :2] + t[:, None] * way, np.zeros(len(t)), first[:, 3:]])
        found = self.at(_wrapped(domain, places.copy()))
        # A border between two places on a rim lies along it; what leads over a hole goes round it.
        rim = border & (first[:, 2] == ON_RIM) & (last[:, 2] == ON_RIM)
        rim = np.flatnonzero(rim | (~found.known & start.known & end.known))
        if not len(rim):
            return found
        surface = self.surface_at(first[rim])
        places[rim, :2], on = beside_rim_chords(surface, first[rim, :2], first[rim, :2] + way[rim], t[rim])
        places[rim, 2] = np.where(on, ON_RIM, 0.0)
        moved = self.at(_wrapped(domain, places[rim]))
        for own, new in ((found.places, moved.places), (found.points, moved.points), (found.normals, moved.normals)):
            own[rim] = new
        return found

    def ends(self, start: Vertices, end: Vertices) -> tuple[Vertices, Vertices]:
        """The ends of sides; on the rim of a cap normals are those of the cap for sides that lead into it."""
        sharp = [self.on_crease(some.places) for some in (start, end)]
        return self._sided(start, end, sharp[0] & ~sharp[1]), self._sided(end, start, sharp[1] & ~sharp[0])

    def nearer(self, edges: Edges) -> Vertices:
        """(k,n) as Between, found by the method of Gauss and Newton with steps halved where they lead astray. What is
        over a sharp edge stays: a chord of the rim of a cap is nearest to the cap, in which it lies."""
        shape = edges.t.shape
        chord = edges.start.points + edges.t[..., None] * (edges.end.points - edges.start.points)
        points = chord.reshape(-1, 3)
        found = Vertices(*(x.reshape(-1, x.shape[-1]) for x in (edges.at.places, edges.at.points, edges.at.normals)))
        size = np.array(self.surface.domain.size)
        first, last = self._without_poles(edges.start.places, edges.end.places)
        way = ways_between(self.surface.domain, first[:, :2], last[:, :2]) / size
        on_crease = self.on_crease(first) & self.on_crease(last) & (np.abs(way[:, 1]) <= ON_BORDER_OF_DOMAIN)
        reach = CLOSE_BY * np.tile(np.where(on_crease, 0.0, np.hypot(*way.T)), shape[0])
        from_start, scale = np.zeros((len(points), 2)), np.ones(len(points))
        places, here, normals = found.places, found.points, found.normals
        _, along_u, along_v = self._jets(places)
        for _ in range(STEPS):
            step = scale[:, None] * _toward(here, along_u, along_v, points)
            # Along the axes, so that the place stays close by.
            moved = from_start + step
            close = np.hypot(*(moved / size).T) <= reach
            next_places = _wrapped(self.surface.domain, np.column_stack([places[:, :2] + step, places[:, 2:]]))
            tried, *tried_slopes = self._jets(next_places)
            better = norm(tried - points) < norm(here - points)
            better &= close & all_finite(tried) & in_domain(self.surface.domain, places[:, :2] + step)
            scale = np.where(better, 1.0, 0.5 * scale)
            new = better[:, None]
            from_start, places, here = (
                np.where(new, ours, old) for ours, old in ((moved, from_start), (next_places, places), (tried, here))
            )
            along_u, along_v = (
                np.where(new, ours, old) for ours, old in zip(tried_slopes, (along_u, along_v), strict=True)
            )
        led = np.flatnonzero(any_component(from_start != 0.0))
        if len(led):
            normals, partials = normals.copy(), (along_u[led], along_v[led])
            with np.errstate(all="ignore"):
                normals[led] = unit_normals_of(self.surface_at(places[led]), places[led, 0], places[led, 1], partials)
        return Vertices(*(some.reshape(*shape, -1) for some in (places, here, normals)))

    def _jets(self, places: Floats) -> FirstJets:
        """Points and derivatives at some places (n,3)."""
        with np.errstate(all="ignore"):
            return first_jets(self.surface_at(places), places[:, 0], places[:, 1])

    def turned(self, places: Floats) -> Bools:
        """(t,) as Between."""
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

    def inside(self, places: Floats) -> Bools:
        """(t,) as Between: of triangles between three places on a rim those with the surface in their middle."""
        found = np.ones(len(places), dtype=np.bool_)
        on_rim = np.flatnonzero(all_components(places[:, :, 2] == ON_RIM))
        if len(on_rim):
            first, one, two = self._ways(places[on_rim])
            found[on_rim] = is_known(self.surface_at(places[on_rim, 0]), first + (one + two) / 3.0)
        return found

    def _ways(self, places: Floats) -> tuple[Floats, Floats, Floats]:
        """The first ones of the places (t,3,d) of corners, and the ways (t,2) from there to the two others; a corner at
        a pole is straight before the next one."""
        corners = places[:, :, :2].copy()
        for pole in self.poles:
            at_pole, along = corners[:, :, pole.axis] == pole.place, corners[:, :, 1 - pole.axis]
            corners[:, :, 1 - pole.axis] = np.where(at_pole, np.roll(along, -1, axis=1), along)
        first, *others = np.moveaxis(corners, 1, 0)
        one, two = (ways_between(self.surface.domain, first, other) for other in others)
        return first, one, two

    def _sided(self, own: Vertices, other: Vertices, which: Bools) -> Vertices:
        """Vertices, some of them with the normals that they have on the way to others."""
        if not which.any():
            return own
        u, v = own.places[which, :2].T
        normals = own.normals.copy()
        with np.errstate(all="ignore"):
            beside = v + ASIDE_OF_CREASE * (other.places[which, 1] - v)
            normals[which] = unit_normals(self.surface_at(own.places[which]), u, beside)
        return replace(own, normals=normals)

    def at(self, places: Floats) -> Vertices:
        """The vertices at some places (n,3)."""
        with np.errstate(all="ignore"):
            points, normals = points_and_normals(self.surface_at(places), places[:, 0], places[:, 1])
        return Vertices(places, np.array(points, dtype=np.float64), normals)

    def _without_poles(self, start: Floats, end: Floats) -> tuple[Floats, Floats]:
        """Places of the ends of sides: all of the line that is a pole is one point, and a side goes straight to it."""
        first, last = start.copy(), end.copy()
        for pole in self.poles:
            for own, other in ((first, end), (last, start)):
                at = own[:, pole.axis] == pole.place
                own[at, 1 - pole.axis] = other[at, 1 - pole.axis]
        return first, last


def _toward(here: Floats, along_u: Floats, along_v: Floats, points: Floats) -> Floats:
    """(n,2) steps in the domain from points (n,3) of a surface with derivatives by u and by v that lead nearest to
    other points (n,3), were it flat."""
    with np.errstate(all="ignore"):
        off = points - here
        uu, uv, vv = dot(along_u, along_u), dot(along_u, along_v), dot(along_v, along_v)
        u, v = dot(along_u, off), dot(along_v, off)
        steps = np.stack([vv * u - uv * v, uu * v - uv * u], axis=1) / (uu * vv - uv * uv)[:, None]
    finite: Bools = np.asarray(all_finite(steps))
    return np.where(finite[:, None], steps, 0.0)


def _wrapped(domain: Domain, places: Floats) -> Floats:
    """Places moved by whole periods into the domain."""
    starts = (domain.u_start, domain.v_start)
    for axis, (closed, size) in enumerate(zip((domain.closed_u, domain.closed_v), domain.size, strict=True)):
        if closed:
            places[:, axis] -= size * np.floor((places[:, axis] - starts[axis]) / size)
    return places


def first_net(surface: Surface, criterion: Criterion, most: int) -> Net:
    """A grid that has as few columns and rows as it may, but not so few that something between its lines is missed, and
    no more triangles than most."""
    ((columns, rows),) = first_counts(Patch(surface, ()), 1, criterion, most)
    return grid_net(surface, columns, rows)


def first_counts(patch: Patch, surfaces: int, criterion: Criterion, most: int) -> list[tuple[int, int]]:
    """The columns and rows of the first nets of so many surfaces, none with more triangles than most."""
    domain = patch.surface.domain
    columns = _enough(lambda count, own: _lines(patch, count, own, True), domain.closed_u, surfaces, criterion)
    rows = _enough(lambda count, own: _lines(patch, count, own, False), domain.closed_v, surfaces, criterion)
    share = np.minimum(1.0, np.sqrt(most / (2.0 * columns * rows)))
    counts = [np.maximum((share * count).astype(np.intp), np.minimum(count, USUAL)) for count in (columns, rows)]
    return list(zip(*(count.tolist() for count in counts), strict=True))


def grid_net(surface: Surface, columns: int, rows: int) -> Net:
    """The triangles of a grid of so many columns and rows, cut at holes and along sharp edges."""
    domain, patch = surface.domain, Patch(surface, ())
    u, v = domain.grid(columns, rows)
    region = trims_of(surface)
    if region is None and not patch.at(_on_grid(u, v).reshape(-1, 3)).known.all():
        # Beside a line of the grid along a rim nobody knew on which side the surface is.
        u, v = (_uneven(lines, seed) for seed, lines in enumerate((u, v)))
    # No side of a triangle may lead over a sharp edge.
    sharp = creases(surface)
    near = np.abs(v[:, None] - sharp) <= ON_BORDER_OF_DOMAIN * domain.size[1]
    v = np.sort(np.concatenate([v[~near.any(axis=1)], sharp]))
    rows = len(v) - 1
    places = _on_grid(u, v).reshape(-1, 3)
    number = seam_numbers(domain, columns, rows).ravel()
    vertices = patch.at(places)
    grid = vertices.points.reshape(columns + 1, rows + 1, 3)
    if region is not None:
        holed = cut_at_trims(region, u, v)
        number = np.append(number, np.arange(len(number), len(holed.places)))
        holed = replace(holed, triangles=_with_sides(number[holed.triangles]))
    else:
        cut, _ = triangulate_surface(grid, closed_u=domain.closed_u, closed_v=domain.closed_v)
        holed = cut_at_holes(surface, places[:, :2], _with_sides(number[cut]), vertices.known)
    new = np.column_stack([holed.places[len(places) :], np.full(len(holed.places) - len(places), ON_RIM)])
    vertices.places[holed.on_rim[: len(places)], 2] = ON_RIM
    vertices = vertices.joined(patch.at(_on_creases(patch, _wrapped(domain, new))))
    return Net(vertices, _with_poles(vertices.places, holed.triangles, poles(surface)))


def _on_creases(patch: Patch, places: Floats) -> Floats:
    """Places on rims, those next to sharp edges on them: what lies along one from there has the normals of one side all
    the way, or it is not seen how far they turn."""
    row = np.flatnonzero(patch.on_crease(places))
    if not len(row):
        return places
    moved = places[row]
    moved[:, 1] = patch.creases[np.argmin(np.abs(moved[:, 1:2] - patch.creases), axis=1)]
    known = is_known(patch.surface_at(moved), moved[:, :2])
    places[row[known]] = moved[known]
    return places


def _with_sides(triangles: Ints) -> Ints:
    """The triangles without those that have one corner twice."""
    return np.asarray(triangles[(triangles != np.roll(triangles, -1, axis=1)).all(axis=1)])


def _with_poles(places: Floats, triangles: Ints, found: Sequence[Pole]) -> Ints:
    """The triangles (t,3) of places (n,3) with one vertex at each pole. (Holes are cut before: the ways from a pole to
    the corners of its triangles are straight in a domain where each has its own end there.)"""
    for pole in found:
        at_pole = (places[:, pole.axis] == pole.place)[triangles]
        if at_pole.any():
            corners = triangles[at_pole]
            first = corners.min()
            places[first, 2] = places[corners, 2].max()
            triangles = np.where(at_pole, first, triangles)
    return _with_sides(triangles)


def _uneven(lines: Floats, seed: int) -> Floats:
    """Lines of a grid, all but the first and the last one moved by up to UNEVEN of the way to the next."""
    # The same numbers every time: a picture made twice is the same.
    moves = np.random.default_rng(seed).uniform(-UNEVEN, UNEVEN, len(lines))
    moves[[0, -1]] = 0.0
    return np.asarray(lines + moves * (lines[1] - lines[0]))


def _on_grid(u: Floats, v: Floats) -> Floats:
    """(m,n,3) the places of a grid, none of them on a rim."""
    return np.stack([*np.meshgrid(u, v, indexing="ij"), np.zeros((len(u), len(v)))], axis=-1)


def _enough(lines: Callable[[int, Ints], Edges], closed: bool, surfaces: int, criterion: Criterion) -> Ints:
    """(s,) how many parts of lines of the grids of so many surfaces are enough to begin with.

    lines: of so many parts, of some of the surfaces, of one after the other.
    """
    counts = np.full(surfaces, FEWEST[int(closed)])
    going = np.arange(surfaces)
    while len(going):
        left = []
        for count in in_turn(np.unique(counts[going]).tolist()):
            own = going[counts[going] == count]
            sides = lines(count, own)
            # What lies in a hole is not cut at all.
            inside = sides.start.known | sides.end.known
            # Of few parts nothing matters but whether they are enough.
            told = criterion.too_coarse if count < USUAL else criterion.error_ratio
            error_ratio = np.nan_to_num(told(sides.take(inside)), nan=2.0).max(axis=0) if inside.any() else np.zeros(0)
            of = np.repeat(np.arange(len(own)), len(inside) // len(own))[inside]
            counts[own] = [_next_count(count, error_ratio[of == k]) for k in range(len(own))]
            left.append(own[(counts[own] > count) & (np.bincount(of, minlength=len(own)) > 0)])
        going = np.sort(np.concatenate(left))
    return counts


def _next_count(count: int, error_ratio: Floats) -> int:
    """Of how many parts lines are to be seen next, whose sides are too coarse by so many times (n,); the same again
    where so many are enough."""
    if not len(error_ratio):
        return USUAL
    if count < USUAL:
        return count if error_ratio.max() <= 1.0 else 2 * count
    most = float(np.quantile(error_ratio, 1.0 - MOST))
    if most <= 1.2 * HALF or count == FINEST:
        return count
    # Distances fall with the square of the length, what turns along rulings with the length itself.
    return max(count, min(int(np.ceil(count * np.sqrt(most / HALF))), FINEST))


def _lines(patch: Patch, count: int, numbers: Ints, across: bool) -> Edges:
    """Some lines of the grids of some surfaces in so many parts each, along u (across) or along v."""
    domain = patch.surface.domain
    u, v = domain.grid(*((count, USUAL) if across else (USUAL, count)))
    places = _on_grid(u, v)
    places = places if across else places.swapaxes(0, 1)
    first, last = (patch.on(some.reshape(-1, 3), numbers) for some in (places[:-1], places[1:]))
    t = np.repeat(np.array(LOOKS)[:, None], len(first), axis=1)
    at = patch.at((first + t[..., None] * (last - first)).reshape(-1, first.shape[1]))
    looks = Vertices(*(some.reshape(*t.shape, -1) for some in (at.places, at.points, at.normals)))
    return Edges(patch.at(first), patch.at(last), looks, t, np.full(t.shape, NONE))


# Nets of triangles on surfaces given by an equation.

IMPLICIT_CELLS = 32
"""Cells along the longest side of an implicit surface's box."""


def level_net(surface: ImplicitSurface) -> Level:
    """An implicit surface with a mesh to begin with, that ends on its singular lines."""
    mesh = polygonized(surface, IMPLICIT_CELLS)
    lines = singular_lines(surface, mesh)
    if not len(lines):
        mesh = settled_from(surface, mesh, IMPLICIT_CELLS)[0]
    return Level(surface, led_into_singular_set(surface, mesh, lines), lines)


@dataclass(frozen=True, eq=False)
class Level:
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
        return VANISHED_GRADIENT * default_gradient(self.surface, self.mesh.vertices)

    def __call__(self, start: Vertices, end: Vertices, t: Floats, border: Bools) -> Vertices:
        """The vertices over parts t of sides, on the surface; border: of sides at its borders."""
        first, last = start.points, end.points
        sides = sides_of(self.surface)
        fixed = sides.on(first) & sides.on(last)
        fixed[:, :BOXED] &= first == last
        length = np.linalg.norm(last - first, axis=1)
        between = first + t[:, None] * (last - first)
        points, _ = onto_surface(self.surface, between, reach=length, fixed=fixed)
        along = np.flatnonzero(np.isnan(start.normals).any(axis=1) & np.isnan(end.normals).any(axis=1))
        on_line, on = self.lines.onto(between[along], HALF * length[along])
        points[along[on]] = on_line[on]
        return self.at(np.clip(points, *sides.box))

    def ends(self, start: Vertices, end: Vertices) -> tuple[Vertices, Vertices]:
        """The ends of sides as they are."""
        return start, end

    def turned(self, places: Floats) -> Bools:
        """None: there are no rims."""
        return np.zeros(len(places), dtype=np.bool_)

    def nearer(self, edges: Edges) -> Vertices:
        """Those over the sides: they were looked for near these."""
        return edges.at

    def inside(self, places: Floats) -> Bools:
        """All of them."""
        return np.ones(len(places), dtype=np.bool_)

    def at(self, points: Floats) -> Vertices:
        """The vertices at some points (n,3) of the surface."""
        with np.errstate(all="ignore"):
            slopes = np.asarray(self.surface.gradients(points), dtype=np.float64)
            length = np.linalg.norm(slopes, axis=1, keepdims=True)
            normals = np.where(length > self.least, slopes / length, np.nan)
        return Vertices(points, points, normals)


# Triangles cut along lines on which normals turn over, as on cuspidal edges: one across shows the shade of neither.

HALVINGS = 40
"""How often the part of a side on which the normal turns over is halved."""


def cut_where_normals_jump(net: Net, between: Between) -> tuple[Net, Bools]:
    """The net with its triangles cut where the normals at both ends of a side are more than a right angle apart, and
    (v,) which vertices are new: on the line, with the normal of one side of it.

    Sides whose normals only turn so far are cut too, in the middle of the turn.
    Edge cases: sides with an end that has no normal, and those that lead over a hole, stay whole.
    """
    count = len(net.vertices.points)
    edges, sides, uses = edges_of(net.triangles, count)
    start, end = between.ends(net.vertices.take(edges[:, 0]), net.vertices.take(edges[:, 1]))
    with np.errstate(invalid="ignore"):
        which = np.flatnonzero(component_sum(start.normals * end.normals) < 0.0)
    found = _turns(start.take(which), end.take(which), uses[which] == 1, between)
    which, found = which[found.known], found.take(found.known)
    middle = np.full(len(edges), -1, dtype=np.intp)
    middle[which] = count + np.arange(len(which))
    vertices = net.vertices.joined(found)
    triangles, _ = divided(net.triangles, middle[sides], vertices.points)
    return Net(vertices, triangles, net.stopped), np.arange(len(vertices.points)) >= count


def _turns(start: Vertices, end: Vertices, border: Bools, between: Between) -> Vertices:
    """The last vertices on sides with normals less than a right angle from those at the starts."""

    def before(which: Ints, t: Floats) -> Bools:
        there = between(start.take(which), end.take(which), t, border[which])
        with np.errstate(invalid="ignore"):
            return np.asarray((there.normals * start.normals[which]).sum(axis=1) > 0.0)

    last, _ = bisected(before, np.zeros(len(start.points)), np.ones(len(start.points)), HALVINGS)
    return between(start, end, last, border)


AROUND_POLE = 8
"""So many normals are compared at a pole."""


@dataclass(frozen=True, eq=False)
class Facets:
    """A mesh, and the unit normals (v,3) of the true surface at its vertices, NaN where it has none; complete: whether
    it is as fine as was asked for; sharp (v,): the vertices on sharp edges, with the normal of one side."""

    mesh: Mesh
    normals: Floats
    complete: bool
    sharp: Bools


def facets(shape: Surface | ImplicitSurface, criterion: Criterion, most: int = DEFAULT_BUDGET.facets) -> Facets:
    """Triangles of a smooth surface as fine as the criterion, every vertex on the surface; oriented as u to v, or
    counter-clockwise seen from F > 0. Vertices on seams and at poles are one; neighbours of different sizes share
    vertices. The criterion is kept at LOOKS of every side and where it crosses a fold, unless that takes more than
    most triangles. Sides into a hole end at its rim; cuspidal edges lie on sides, up to their chords.
    Edge cases: triangles in holes, without area, across jumps, and folded over in a plane part of a surface with
    borders are left out. Source: Glaeser, section 8.4. Errors: InputError for what is no smooth surface.
    """
    if is_parametrised(shape):
        surface: Surface = standard_forms([shape])[0]
        if shared := _shared_net(surface, criterion):
            return shared.placed(_alone(shared.body, shared.criterion, most))
        return _alone(surface, criterion, most)
    if is_implicit(shape):
        level = level_net(shape)
        net = refined(level.net, level, criterion, most)
        return _facets(net, np.zeros(len(net.vertices.points), dtype=np.bool_))
    raise InputError(f"a {type(shape).__name__} is no smooth surface")


def _alone(surface: Surface, criterion: Criterion, most: int) -> Facets:
    """The facets of a parametrised surface by itself."""
    patch = Patch(surface, tuple(poles(surface)))
    return finished(patch, refined(first_net(surface, criterion, most), patch, criterion, most))


def finished(patch: Patch, net: Net) -> Facets:
    """What comes of a net on a parametrised surface that is fine enough."""
    net, turned = cut_where_normals_jump(_without_jumps(patch.surface, net), patch)
    sharp = turned | patch.on_crease(net.vertices.places)
    apex = _at_apexes(patch, net.vertices.places)
    return _facets(_without_folds(net, sharp), sharp | apex, apex)


def _at_apexes(patch: Patch, places: Floats) -> Bools:
    """(n,) which places are at poles at which the normal depends on the way that leads there, as that of a cone."""
    found = np.zeros(len(places), dtype=np.bool_)
    domain = patch.surface.domain
    starts = (domain.u_start, domain.v_start)
    for pole in patch.poles:
        around = np.empty((AROUND_POLE, 2))
        across = 1 - pole.axis
        around[:, pole.axis] = pole.place
        around[:, across] = starts[across] + domain.size[across] * np.arange(AROUND_POLE) / AROUND_POLE
        normals = unit_normals(patch.surface, around[:, 0], around[:, 1])
        if (dot(normals, normals[:1]) < SAME_NORMAL_COSINE).any():
            found |= np.abs(places[:, pole.axis] - pole.place) <= ON_BORDER_OF_DOMAIN * domain.size[pole.axis]
    return found


def _without_folds(net: Net, sharp: Bools) -> Net:
    """The net without triangles that look against the only normal of all their corners: chords of lines that are bent
    within a plane lead over the corners behind them. sharp (v,): vertices with the normal of one side only.

    Where two triangles lie over a place and one beneath it looks the other way, one is left. Nets without borders keep
    them all: of a closed body nothing is seen that looks away.
    """
    points, normals = net.vertices.points[net.triangles], net.vertices.normals[net.triangles]
    area = cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    against = dot(area[:, None], normals) <= -FLAT_COSINE * norm(area)[:, None]
    either = sharp[net.triangles]
    folded = all_components(against | either) & any_component(against & ~either)
    if not folded.any() or (edges_of(net.triangles, len(sharp))[2] > 1).all():
        return net
    return replace(net, triangles=net.triangles[~folded])


def _without_jumps(surface: Surface, net: Net) -> Net:
    """The net without triangles with a side along which the surface jumps.

    Only sides that are long beside what the derivatives at both ends make of them are looked at.
    """
    places, points = net.vertices.places, net.vertices.points
    a, b = (x.ravel() for x in (net.triangles, np.roll(net.triangles, -1, axis=1)))
    way = ways_between(surface.domain, places[a, :2], places[b, :2])
    with np.errstate(all="ignore"):
        along_u, along_v = surface.partials(*places[:, :2].T)
        expected = [norm(along_u[k] * way[:, :1] + along_v[k] * way[:, 1:]) for k in (a, b)]
        long = norm(points[b] - points[a]) > TOO_LONG * np.maximum(*expected)
    side = np.flatnonzero(long)
    torn = np.zeros(len(a), dtype=np.bool_)
    torn[side] = jumps(surface, places[a][side, :2], places[a][side, :2] + way[side])
    return replace(net, triangles=net.triangles[~any_component(torn.reshape(-1, 3))])


def _facets(net: Net, sharp: Bools, apex: Bools | None = None) -> Facets:
    triangles = net.triangles[net.vertices.known[net.triangles].all(axis=1)]
    used, corners = np.unique(triangles, return_inverse=True)
    vertices = net.vertices.take(used)
    normals = vertices.normals if apex is None else np.where(apex[used, None], np.nan, vertices.normals)
    return Facets(Mesh.from_triangles(vertices.points, corners.reshape(-1, 3)), normals, not net.stopped, sharp[used])


# Facets of many surfaces: those of one family are divided as one, which takes few more calls than one of them.

LOT = 64
"""So many surfaces are divided at once at most, for their arrays all have to be held."""

MANY = 1000
"""Triangles of the first nets in the mean from which on surfaces are divided one after the other: each has enough to
do by itself."""


@runtime_checkable
class Joinable(Criterion, Protocol):
    """A criterion that can be made of several surfaces at once."""

    @property
    def alike(self) -> Hashable:
        """Equal for demands that can be joined."""
        ...

    @classmethod
    def joined(cls, asked: Sequence[Self]) -> Criterion:
        """That of several surfaces, told apart by the numbers of those that places are on."""
        ...


@dataclass(frozen=True, eq=False)
class Patches(Patch):
    """Surfaces of one family over one domain with the same poles and sharp edges, the first one for all in what they
    have in common; the fourth number of a place tells which one it is on."""

    stack: StackedSurfaces

    def surface_at(self, places: Floats) -> Surface:
        """The surface of each place."""
        return ExactRows(self.stack, surface_numbers(places))

    def on(self, places: Floats, numbers: Ints) -> Floats:
        """(s*n,4) places (n,3) on each of some surfaces (s,), by their numbers."""
        return np.column_stack([np.tile(places, (len(numbers), 1)), np.repeat(numbers, len(places))])


def facets_of_all(shapes: Sequence[Any], criterion: Callable[[int], Criterion], most: int) -> list[Facets]:
    """The facets of each of some surfaces, to the last bit those that it has alone.

    criterion: how fine those of a shape have to be, by its number; most: triangles of each. What is no surface of a
    family, such as a user's own function, is divided alone.
    Errors: see facets.
    """
    made: dict[int, Facets] = {}
    families: dict[Hashable, list[int]] = {}
    nets: dict[Hashable, Facets] = {}
    shapes = standard_forms(shapes)
    for number, shape in enumerate(shapes):
        families.setdefault(_family(shape) or number, []).append(number)
    for family in families.values():
        for start in in_turn(range(0, len(family), LOT)):
            batch = family[start : start + LOT]
            asked = [criterion(number) for number in batch]
            shared = [_shared_net(shapes[number], one) for number, one in zip(batch, asked, strict=True)]
            for number, one in zip(batch, shared, strict=True):
                if one is not None:
                    if one.key not in nets:
                        nets[one.key] = _alone(one.body, one.criterion, most)
                    made[number] = one.placed(nets[one.key])
            left = [k for k, one in enumerate(shared) if one is None]
            for own in _joinable([asked[k] for k in left]):
                numbers = [batch[left[k]] for k in own]
                found = _together([shapes[k] for k in numbers], [asked[left[k]] for k in own], most)
                made.update(zip(numbers, found, strict=True))
    return [made[number] for number in range(len(shapes))]


def standard_forms(shapes: Sequence[Any]) -> list[Any]:
    """The shapes, those that are capped cylinders, cones or frusta as placements of one such body of height 1 and
    largest radius 1 for each ratio of radii: with one domain whatever their size, they are one family."""
    bodies: dict[tuple[float, float], Capped] = {}
    found = []
    for shape in shapes:
        quadric = capped_quadric_of(shape)
        if quadric is None or quadric.is_round:
            found.append(shape)
            continue
        body = bodies.setdefault(quadric.radii, Capped(Frustum(*quadric.radii, 1.0)))
        found.append(PlacedSurface(body, quadric.frame, quadric.centre))
    return found


# Balls and rods of which the same is asked, measured by their radii, share one net.

EVENLY = 0.8
"""Part of the largest distance that is allowed on a body which the smallest one has at least where a net is shared."""

SIZES = 8
"""Distances are rounded down to so many sizes between 0 and each power of two, half of which are there twice."""


@dataclass(frozen=True, eq=False)
class _SharedNet:
    """A ball or a rod (points x @ frame + centre of a unit one, body), what is asked of the unit one, and a key: equal
    for those with the same net."""

    body: Surface
    frame: Floats
    centre: Floats
    criterion: AllSidesAlike
    key: Hashable

    def placed(self, net: Facets) -> Facets:
        """The net of the unit body where this one is."""
        turned = self.frame / norm(self.frame)[:, None] * np.sign(dot(self.frame[0], cross(*self.frame[1:])))
        mesh = replace(net.mesh, vertices=matmul(net.mesh.vertices, self.frame) + self.centre)
        return replace(net, mesh=mesh, normals=matmul(net.normals, turned))


def _shared_net(shape: Any, criterion: Criterion) -> _SharedNet | None:
    """The shared net of a ball, or of a rod in its standard form, of which nearly the same is asked everywhere; its
    distances are those at the middle less all by which others in its box can be smaller, as they are convex functions.
    None for other shapes, for ellipsoids and elliptic rods, and where outlines matter."""
    if not isinstance(criterion, AllSidesAlike):
        return None
    form = round_body_of(shape)
    if form is None:
        return None
    body: Surface = Sphere(1.0) if form.is_ball else shape.surface
    frame, centre, low = form.frame, form.centre, -1.0 if form.is_ball else 0.0
    corners = np.array(list(np.ndindex(2, 2, 2))) * (2.0, 2.0, 1.0 - low) + (-1.0, -1.0, low)
    middle = np.array([[0.0, 0.0, 0.5 * (1.0 + low)]])
    allowed = criterion.distances_at(matmul(np.concatenate([middle, corners]), frame) + centre)
    least = 2.0 * float(allowed[0]) - float(allowed.max())
    if not least >= EVENLY * float(allowed.max()) > 0.0:
        return None
    part, power = np.frexp(least / form.radius)
    distance = float(np.ldexp(np.floor(part * SIZES) / SIZES, power))
    return _SharedNet(body, frame, centre, criterion.with_distance(distance), (form.is_ball, type(criterion), distance))


def _family(shape: Any) -> Hashable:
    """Equal for surfaces that can be divided as one, None for others."""
    inner = shape.surface if isinstance(shape, PlacedSurface) else shape
    if isinstance(inner, Capped):
        return Capped, id(inner)
    names = dimensions_of(inner)
    if not names or not is_parametrised(inner) or len(creases(shape)):
        return None
    known = tuple(getattr(inner, name) is None for name in names)
    return type(inner), known, inner.domain, tuple((pole.axis, pole.place) for pole in poles(shape))


def _joinable(asked: Sequence[Criterion]) -> list[list[int]]:
    """The numbers of demands, those together that can be joined."""
    found: dict[Hashable, list[int]] = {}
    for number, one in enumerate(asked):
        key = (type(one), one.alike) if isinstance(one, Joinable) else number
        found.setdefault(key, []).append(number)
    return list(found.values())


def _together(shapes: Sequence[Any], asked: Sequence[Any], most: int) -> list[Facets]:
    """The facets of shapes of one family."""
    if len(shapes) == 1:
        return [_alone(shapes[0], asked[0], most) if is_parametrised(shapes[0]) else facets(shapes[0], asked[0], most)]
    criterion = type(asked[0]).joined(asked)
    single = [Patch(shape, tuple(poles(shape))) for shape in shapes]
    patches = Patches(shapes[0], single[0].poles, StackedSurfaces.of(shapes))
    counts = first_counts(patches, len(shapes), criterion, most)
    first = [grid_net(shape, *count) for shape, count in zip(shapes, counts, strict=True)]
    if sum(len(net.triangles) for net in first) > MANY * len(shapes):
        nets = [refined(*each, most) for each in zip(first, single, asked, strict=True)]
        return [finished(patch, net) for patch, net in zip(single, nets, strict=True)]
    nets = _apart(refined(_as_one(first), patches, criterion, most), len(shapes))
    return [finished(patch, net) for patch, net in zip(single, nets, strict=True)]


def _as_one(nets: Sequence[Net]) -> Net:
    """The nets of several surfaces, the vertices and triangles of one after those of the other."""
    shift = ragged.offsets([len(net.vertices.points) for net in nets])
    vertices = [
        replace(net.vertices, places=np.column_stack([net.vertices.places, np.full(len(net.vertices.points), number)]))
        for number, net in enumerate(nets)
    ]
    parts = zip(*((v.places, v.points, v.normals) for v in vertices), strict=True)
    joined = Vertices(*(np.concatenate(some) for some in parts))
    return Net(joined, np.concatenate([net.triangles + start for net, start in zip(nets, shift[:-1], strict=True)]))


def _apart(net: Net, count: int) -> list[Net]:
    """The nets of each of so many surfaces."""
    of = surface_numbers(net.vertices.places)
    of_triangle = of[net.triangles[:, 0]]
    place = np.empty(len(of), dtype=np.intp)
    found = []
    for number in range(count):
        own = np.flatnonzero(of == number)
        place[own] = np.arange(len(own))
        vertices = net.vertices.take(own)
        vertices = replace(vertices, places=np.ascontiguousarray(vertices.places[:, :3]))
        stopped = (0,) if number in net.stopped else ()
        found.append(Net(vertices, place[net.triangles[of_triangle == number]], stopped))
    return found

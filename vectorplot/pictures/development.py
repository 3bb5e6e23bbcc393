"""The verb develop: bodies and surfaces unfolded into the plane, with the curves on them, to be cut out and folded."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache, cached_property
from itertools import pairwise
from typing import Any, Literal

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import is_curve
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.drawing.finishing import inked
from vectorplot.drawing.formulas import without_formulas_in_strokes
from vectorplot.drawing.layers import layers_by_kind
from vectorplot.drawing.letters import lettered
from vectorplot.drawing.pens import BLACK
from vectorplot.drawing.strokes import chosen
from vectorplot.drawing.title_block import DrawingScale
from vectorplot.errors import InputError, InputWarning
from vectorplot.features.contours_and_isophotes import plane_sections
from vectorplot.features.curve_tracing import Tracing
from vectorplot.features.intersections import mesh_section, surface_intersection
from vectorplot.features.mesh_edge_lines import Faces
from vectorplot.features.mesh_intersections import face_intersections
from vectorplot.features.mesh_lines import mesh_plane_sections, pattern_outline
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import budget_of, in_turn, may_stop, threads_of
from vectorplot.geometry.elementary import arcsin, arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.nets import Net, net_of, of_convex_faces, turned
from vectorplot.geometry.polylines import segments
from vectorplot.geometry.regions import polygons_of
from vectorplot.geometry.solids import zero_distance
from vectorplot.geometry.triangles import PlacedTriangles
from vectorplot.geometry.vectors import component_sum, cross, dot, norm
from vectorplot.geometry.winding import face_barycentres
from vectorplot.io.anything import scene_of
from vectorplot.pictures.options import check_options
from vectorplot.pictures.pipeline import Pipeline, Stage, StageReport, stoppable
from vectorplot.pictures.technical_sheet import MM_PER
from vectorplot.scene.item import Item
from vectorplot.scene.labels import Label
from vectorplot.scene.page import Page
from vectorplot.scene.placement import page_of
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.capped_bodies import Capped
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.surface import Surface, Transposed, is_parametrised, normals, second_jets
from vectorplot.tolerances import (
    COINCIDENT_MM,
    DEVELOPABLE_ANGLE,
    LEAST_DIVISOR,
    LEVEL_STEP_OF_DOMAIN,
    NO_AZIMUTH_SINE,
    UNROLLED_OF_LENGTH,
)
from vectorplot.words import LineKind, check_word

# Developable surfaces of straight lines, unrolled.

NODES = 8
"""Of Gauss and Legendre, in every step along the surface."""

COARSEST, FINEST = 32, 1 << 13
"""So many steps around the surface are the fewest, and the most."""


@dataclass(frozen=True, eq=False)
class Unrolled:
    """The plane development of a surface whose lines u = const. are straight, and along which its tangent plane does
    not turn.

    surface: u runs across the straight lines; along: the v of the curve that is unrolled first, from which they are
    measured; bend: the largest angle, in radians, by which the normal turns along one of them: what is no rounding of
    it is no developable surface.

    The curve v = along goes over into one with the same geodesic curvature, and each straight line keeps its angle with
    it and its lengths. Source: do Carmo, Differential geometry of curves and surfaces, sections 4-2 and 4-4.
    """

    surface: Surface
    along: float
    bend: float

    @classmethod
    def of(cls, surface: Surface) -> Unrolled:
        """That of a surface with straight lines in one direction. Errors: InputError for one that has none, and for one
        that is not developable."""
        for one in (surface, Transposed(surface, surface.domain.transposed)):
            domain = one.domain
            u, v = (grid.ravel() for grid in np.meshgrid(*domain.grid(48, 6), indexing="ij"))
            points = one.points(u, v)
            if not np.isfinite(points).all():
                raise InputError("a surface with holes has no development")
            points = points.reshape(49, 7, 3)
            way = points[:, -1:] - points[:, :1]
            length = np.maximum(norm(way), LEAST_DIVISOR)
            off = norm(cross(points - points[:, :1], way)) / length
            if float((off / length).max()) > DEVELOPABLE_ANGLE:
                continue
            normal = normals(one, u, v).reshape(49, 7, 3)
            size = norm(normal)
            there = size > DEVELOPABLE_ANGLE * size.max()
            unit = normal / np.where(there, size, 1.0)[..., None]
            best = np.argmax(size, axis=1)
            own = unit[np.arange(49), best][:, None]
            sine = np.where(there, norm(cross(unit, own)), 0.0)
            bend = float(sine.max())
            if bend > DEVELOPABLE_ANGLE:
                degrees = float(np.degrees(arcsin(min(bend, 1.0))))
                raise InputError(f"is not developable: its tangent plane turns by {degrees:.3g} degrees along a ruling")
            ends = size.reshape(49, 7)[:, [0, -1]].min(axis=0)
            return cls(one, domain.v_start if ends[0] >= ends[1] else domain.v_end, bend)
        raise InputError("is not developable: it has no straight lines along its parameters")

    def placed(self, u: Floats, v: Floats) -> Floats:
        """(n,2) where the points with parameters (n,) lie in the plane: lengths are kept to 1e-9 and better."""
        nodes, curve, angle = self._curve
        step = np.clip(np.searchsorted(nodes, u, side="right") - 1, 0, len(nodes) - 2)
        way, turned = self._steps(nodes[step], u - nodes[step], angle[step])
        at, turn = curve[step] + way, angle[step] + turned
        foot = np.full(len(u), self.along)
        origin = self.surface.points(u, foot)
        tangent, left = self._frame(u)
        arm = self.surface.points(u, v) - origin
        # Seen from where the normal of the surface points to, whichever of its parameters is u here.
        side = -1.0 if isinstance(self.surface, Transposed) else 1.0
        x, y = dot(arm, tangent), side * dot(arm, left)
        cosine, sine = np.cos(turn), side * np.sin(turn)
        at = at * np.array([1.0, side])
        return np.stack([at[:, 0] + cosine * x - sine * y, at[:, 1] + sine * x + cosine * y], axis=1)

    def _frame(self, u: Floats) -> tuple[Floats, Floats]:
        """(n,3) unit vectors along the curve, and to its left in the surface."""
        foot = np.full(len(u), self.along)
        by_u, by_v = self.surface.partials(u, foot)
        tangent = by_u / np.maximum(norm(by_u), LEAST_DIVISOR)[:, None]
        rest = by_v - dot(by_v, tangent)[:, None] * tangent
        return tangent, rest / np.maximum(norm(rest), LEAST_DIVISOR)[:, None]

    @cached_property
    def _curve(self) -> tuple[Floats, Floats, Floats]:
        """Ends of steps along u, and there the unrolled curve and its direction; twice as many steps move nothing."""
        domain = self.surface.domain
        count, before = COARSEST, None
        while True:
            may_stop()
            nodes = np.linspace(domain.u_start, domain.u_end, count + 1)
            _, turned = self._steps(nodes[:-1], np.diff(nodes), np.zeros(count))
            angle = np.concatenate([[0.0], np.cumsum(turned)])
            way, _ = self._steps(nodes[:-1], np.diff(nodes), angle[:-1])
            curve = np.concatenate([np.zeros((1, 2)), np.cumsum(way, axis=0)])
            if before is not None:
                size = max(float(np.ptp(curve, axis=0).max()), LEAST_DIVISOR)
                if float(norm(curve[::2] - before).max()) <= UNROLLED_OF_LENGTH * size or count >= FINEST:
                    return nodes, curve, angle
            before, count = curve, 2 * count

    def _steps(self, low: Floats, step: Floats, angle: Floats) -> tuple[Floats, Floats]:
        """(n,2) how far the unrolled curve goes from u (n,) in steps (n,), beginning in directions (n,), and (n,) by
        how much it turns."""
        x, weight, within = _rule()
        at = low[:, None] + step[:, None] * x
        speed, rate = (values.reshape(at.shape) for values in self._turning(at.ravel()))
        direction = angle[:, None] + step[:, None] * (rate[:, None, :] * within).sum(axis=2)
        ways = [step * (speed * weight * wave(direction)).sum(axis=1) for wave in (np.cos, np.sin)]
        return np.stack(ways, axis=1), step * (rate * weight).sum(axis=1)

    def _turning(self, u: Floats) -> tuple[Floats, Floats]:
        """(n,) how fast the curve runs at u (n,), and how fast it turns in the surface."""
        foot = np.full(len(u), self.along)
        _, by_u, by_v, uu, _, _ = second_jets(self.surface, u, foot)
        normal = cross(by_u, by_v)
        normal = normal / np.maximum(norm(normal), LEAST_DIVISOR)[:, None]
        square = np.maximum(component_sum(by_u * by_u), LEAST_DIVISOR)
        return np.sqrt(square), dot(normal, cross(by_u, uu)) / square


@cache
def _rule() -> tuple[Floats, Floats, Floats]:
    """Places and weights (k,) of Gauss and Legendre between 0 and 1, and (k,k) what the values there are to be
    multiplied with for the integrals from 0 to each of the places."""
    x, weight = np.polynomial.legendre.leggauss(NODES)
    values = np.polynomial.legendre.legvander(x, NODES)
    degree = np.arange(NODES)
    # Of Legendre's polynomials: their coefficients in what goes through the values, and their integrals.
    coefficients = (degree + 0.5)[:, None] * weight * values[:, :NODES].T
    lower = np.column_stack([-np.ones(NODES), values[:, : NODES - 1]])
    integrals = (values[:, 1:] - lower) / (2.0 * degree + 1.0)
    return 0.5 * (1.0 + x), 0.5 * weight, 0.5 * matmul(integrals, coefficients)


GAP_MM = 6.0
"""Between pieces on the page."""

TAB_ANGLES = (60.0, 30.0, 15.0)
"""At the feet of tabs, in degrees: the next one where there is no room for the one before."""

RIM_PLACES = 64
"""On a rim, which tell whether two pieces have it in common."""

TOOTH, FEWEST_TEETH = 1.5, 8
"""The feet of teeth along curved rims, in heights of tabs, and how many of them a rim has at the least."""

WIDEST_FOOT = 0.4
"""Of the length of an edge, what each slanting side of its tab takes at most."""

LETTERS_MM = 2.5
"""The height of numbers at edges."""

MOST_NUMBERS = 2000
"""So many edges get numbers."""

PROPORTION = 1.4
"""Of a page as large as its pieces, width to height, as far as these leave a choice."""

SAME_WAY = math.pi / 2.0 / 4096.0
"""Straight lines with a smaller angle between them run in one direction."""

STARTS, STEPS = (96, 16), 16
"""Places on a surface from which points of it are looked for, by so many steps."""

MOST_POINTS = 1 << 13
"""On a side of an unrolled surface."""

PENS = {
    "cut": Pen(0.35, BLACK),
    "mountain fold": Pen(0.18, BLACK, (3.0, 1.5)),
    "valley fold": Pen(0.18, BLACK, (0.8, 1.2)),
}
"""What draws the lines along which paper is cut and folded; letters and curves have the pens of drawings."""


# What is drawn of a piece: segments, and what they are.


@dataclass(frozen=True, eq=False)
class Strokes2D:
    """Polylines in the planes of pieces, in mm: points (n,2), offsets (m+1,), layer (m,): a layer of PENS by its place,
    or that of letters behind them, or one more for curves; kind (m,): of curves; piece (m,)."""

    points: Floats
    offsets: Ints
    layer: Ints
    kind: Ints
    piece: Ints

    @classmethod
    def of_segments(cls, ends: Floats, layer: int, piece: Ints, kind: LineKind = LineKind.CURVE) -> Strokes2D:
        """Those of segments (m,2,2) of pieces (m,)."""
        count = len(ends)
        return cls(
            ends.reshape(-1, 2), 2 * np.arange(count + 1), np.full(count, layer), np.full(count, int(kind)), piece
        )

    @classmethod
    def joined(cls, parts: Sequence[Strokes2D]) -> Strokes2D:
        """One after the other."""
        sizes = np.concatenate([np.zeros(0, dtype=np.intp), *(np.diff(part.offsets) for part in parts)])
        none = np.zeros(0, dtype=np.intp)
        columns = [
            np.concatenate([none, *(getattr(part, name) for part in parts)]) for name in ("layer", "kind", "piece")
        ]
        points = np.concatenate([np.zeros((0, 2)), *(part.points for part in parts)])
        return cls(points, ragged.offsets(sizes), *columns)


CUT, MOUNTAIN, VALLEY, NUMBER, CURVE = range(5)
"""The layers of strokes."""


@dataclass(frozen=True, eq=False)
class Developed:
    """An item in the plane: its strokes, how many pieces it has, and polygons (k,) of shapely that they cover with the
    piece of each; one, other (e,2,2): sides, with what they bound to their left, that belong together, and their
    pieces; gap: how far apart in mm are corners that count as one; rims, of_rim: curved sides (n,2), with what they
    bound to their left, that belong to one of another piece, and their pieces."""

    name: str
    strokes: Strokes2D
    count: int
    areas: Any
    piece: Ints
    one: Floats
    other: Floats
    of_one: Ints
    of_other: Ints
    gap: float
    rims: tuple[Floats, ...] = ()
    of_rim: tuple[int, ...] = ()


# Polyhedra.


def _of_mesh(
    item: Item,
    others: Sequence[Item],
    labels: Sequence[Label],
    crease_angle_deg: float,
    tolerance: float,
    tracing: Tracing,
) -> Developed:
    """The net of a polyhedron with the curves and the labels on it."""
    net = net_of(item.mesh, tolerance)
    mesh = net.mesh
    corners = net.corners
    piece = net.piece[mesh.corner_face]
    after = corners[mesh.next_corner]
    paired = np.zeros(len(mesh.corners), dtype=np.bool_)
    paired[net.first], paired[net.second] = True, True
    apart = ~net.joined
    one, two = net.first[apart], net.second[apart]
    cut = np.concatenate([one, two, np.flatnonzero(~paired)])
    bent = net.joined & (np.abs(net.angle) > math.radians(crease_angle_deg))
    parts = [_sides(corners, after, piece, cut, CUT)]
    for layer, which in ((MOUNTAIN, bent & (net.angle > 0.0)), (VALLEY, bent & (net.angle < 0.0))):
        parts.append(_sides(corners, after, piece, net.first[which], layer))
    parts += _curves_on_mesh(item, net, others, tracing)
    parts += _labels_on_mesh(net, labels)
    sides = np.stack([corners, after], axis=1)
    areas = polygons_of(corners.T, mesh.offsets)
    strokes = Strokes2D.joined(parts)
    count = int(net.piece.max()) + 1
    return Developed(
        item.name, strokes, count, areas, net.piece, sides[one], sides[two], piece[one], piece[two], net.gap
    )


def _sides(corners: Floats, after: Floats, piece: Ints, which: Ints, layer: int) -> Strokes2D:
    return Strokes2D.of_segments(np.stack([corners[which], after[which]], axis=1), layer, piece[which])


def _curves_on_mesh(item: Item, net: Net, others: Sequence[Item], tracing: Tracing) -> Iterator[Strokes2D]:
    """Sections, patterns, and where other items meet the polyhedron."""
    mesh = net.mesh

    def on_faces(start: Floats, end: Floats, faces: Ints, kind: LineKind) -> Strokes2D:
        ends = np.stack([net.placed(start, faces), net.placed(end, faces)], axis=1)
        return Strokes2D.of_segments(ends, CURVE, net.piece[faces], kind)

    for section in item.curves.sections:
        found = mesh_plane_sections(mesh, section.normal, section.offsets)
        pairs = segments(found)
        yield on_faces(found.points[pairs[:, 0]], found.points[pairs[:, 1]], found.faces[pairs[:, 0]], section.kind)
    for pattern in item.patterns:
        outline = pattern_outline(item.mesh, pattern.face, pattern.points)
        middle = face_barycentres(item.mesh)[pattern.face]
        level = dot(mesh.face_normals, item.mesh.face_normals[pattern.face])
        away = norm(face_barycentres(mesh) - middle) + (1.0 - level) * max(
            float(np.ptp(mesh.bounds, axis=0).max()), 1.0
        )
        face = np.full(len(outline), int(np.argmin(away)))
        yield on_faces(outline, np.roll(outline, -1, axis=0), face, LineKind.PATTERN)
    for other in others:
        if isinstance(other.shape, Mesh):
            yield _met(mesh, of_convex_faces(other.shape), on_faces)
        elif is_parametrised(other.shape):
            met = mesh_section(other.shape, mesh, tracing=tracing)
            pairs, points = segments(met.curves), met.curves.points
            faces = met.faces[pairs[:, 0]]
            yield on_faces(points[pairs[:, 0]], points[pairs[:, 1]], faces, LineKind.INTERSECTION)


def _labels_on_mesh(net: Net, labels: Sequence[Label]) -> Iterator[Strokes2D]:
    """The letters of labels at points of the polyhedron, each on the first of the faces that it is on."""
    mesh, at = net.mesh, _points_of(labels)
    label, face = PlacedTriangles(mesh).faces_at(at, zero_distance(np.concatenate([mesh.vertices, at])))
    first = np.lexsort((face, label))[np.diff(np.sort(label), prepend=-1) > 0]
    label, face = label[first], face[first]
    level = _level(mesh.face_normals[face])
    origins = net.placed(at[label], face)
    ways = net.placed(at[label] + level, face) - origins
    for number, origin, way, piece in zip(label.tolist(), origins, ways, net.piece[face].tolist(), strict=True):
        yield _letters(labels[number], origin, way, piece)


def _points_of(labels: Sequence[Label]) -> Floats:
    """(l,3) the points that labels name."""
    return np.array([label.at for label in labels], dtype=np.float64).reshape(-1, 3)


def _level(normals: Floats) -> Floats:
    """(n,3) directions that are level in planes with these normals (n,3), to the right as one looks at them from
    outside; along x in planes that are level."""
    way = np.stack([-normals[:, 1], normals[:, 0], np.zeros(len(normals))], axis=1)
    length = norm(way)[:, None]
    return np.where(length > NO_AZIMUTH_SINE, way / np.maximum(length, LEAST_DIVISOR), (1.0, 0.0, 0.0))


def _letters(label: Label, origin: Floats, way: Floats, piece: int) -> Strokes2D:
    """The letters of a label about a point of a piece, along a way there."""
    turn = math.degrees(float(arctan2(way[1], way[0])))
    try:
        plain = without_formulas_in_strokes(label.text)
        how: dict[str, Any] = {"size_mm": label.capitals_mm, "rotation_deg": turn}
        text = lettered(plain, origin, align="centre", level="middle", **how).strokes
    except InputError as error:
        raise InputError(f"label {label.name or repr(label.text)}: {error.cause}") from None
    return _polylines([text[k] for k in range(len(text))], NUMBER, piece, LineKind.LABEL)


def _met(mesh: Mesh, other: Mesh, on_faces: Callable[[Floats, Floats, Ints, LineKind], Strokes2D]) -> Strokes2D:
    """Where the faces of another mesh meet those of one."""
    points = np.concatenate([mesh.vertices, other.vertices])
    middle = (points.min(axis=0) + points.max(axis=0)) / 2.0
    size = max(float(np.ptp(points, axis=0).max()), LEAST_DIVISOR)
    corners = np.concatenate([mesh.corners, other.corners + len(mesh.vertices)])
    offsets = ragged.offsets(np.concatenate([mesh.face_sizes, other.face_sizes]))
    inner, facing = np.zeros(len(corners), dtype=np.bool_), np.ones(len(offsets) - 1, dtype=np.int8)
    faces = Faces(np.ascontiguousarray(((points - middle) / size).T), corners, offsets, inner, facing)
    part = np.repeat([0, 1], [mesh.face_count, other.face_count])
    found = face_intersections(faces, part, zero_distance(points) / size)
    own = np.where(found.one < mesh.face_count, found.one, found.two)
    return on_faces(found.start.T * size + middle, found.end.T * size + middle, own, LineKind.INTERSECTION)


# Smooth surfaces.


def _of_surface(
    item: Item, others: Sequence[Item], labels: Sequence[Label], tolerance: float, tracing: Tracing
) -> Developed:
    """A developable surface unrolled, each of its parts a piece, with the curves and the labels on it."""
    parts: list[Strokes2D] = []
    areas, one, other, of_one = [], [], [], []
    rims: list[tuple[int, Floats, Floats]] = []
    smooth = _smooth_parts(item.shape)
    for number, surface in enumerate(smooth):
        may_stop()
        unrolled = Unrolled.of(surface)
        domain = unrolled.surface.domain
        sides = [
            _side(unrolled, tolerance, u, v)
            for u, v in (
                ((domain.u_start, domain.u_end), (domain.v_start,) * 2),
                ((domain.u_end,) * 2, (domain.v_start, domain.v_end)),
                ((domain.u_end, domain.u_start), (domain.v_end,) * 2),
                ((domain.u_start,) * 2, (domain.v_end, domain.v_start)),
            )
        ]
        ring = np.concatenate([side[:-1] for side in sides])
        arm = ring - ring[0]
        if float((arm[:, 0] * np.roll(arm[:, 1], -1) - arm[:, 1] * np.roll(arm[:, 0], -1)).sum()) < 0.0:
            sides = [side[::-1] for side in sides]
            ring = ring[::-1]
        closed = domain.closed_u and norm(sides[1] - sides[3][::-1]).max() <= COINCIDENT_MM
        shown = [
            side
            for k, side in enumerate(sides)
            if not (closed and k % 2) and norm(np.diff(side, axis=0)).sum() > COINCIDENT_MM
        ]
        if domain.closed_u and not closed:
            one.append(sides[1][[0, -1]])
            other.append(sides[3][[0, -1]])
            of_one.append(number)
        parts.append(_polylines(shown, CUT, number))
        for side, v in ((sides[0], domain.v_start), (sides[2], domain.v_end)):
            if len(smooth) > 1 and norm(np.diff(side, axis=0)).sum() > COINCIDENT_MM:
                u = np.linspace(domain.u_start, domain.u_end, RIM_PLACES, endpoint=False)
                rims.append((number, side, unrolled.surface.points(u, np.full(RIM_PLACES, v))))
        areas.append(ring)
        parts += _curves_on_surface(item, unrolled, others, tracing, tolerance, number)
        parts += _labels_on_surface(unrolled, labels, tolerance, number)
    sizes = [len(ring) for ring in areas]
    polygons = polygons_of(np.concatenate(areas).T, ragged.offsets(sizes))
    pieces = np.array(of_one, dtype=np.intp)
    first, last = (np.array(ends, dtype=np.float64).reshape(-1, 2, 2) for ends in (one, other))
    strokes, numbers = Strokes2D.joined(parts), np.arange(len(areas))
    glued = _rims_with_others(rims)
    return Developed(
        *(item.name, strokes, len(areas), polygons, numbers, first, last, pieces, pieces, 0.0),
        rims=tuple(side for _, side in glued),
        of_rim=tuple(number for number, _ in glued),
    )


def _rims_with_others(rims: Sequence[tuple[int, Floats, Floats]]) -> list[tuple[int, Floats]]:
    """The rims, each a piece, its side in the plane and places on it in space, that a later piece has too."""
    middles = [(places.mean(axis=0), float(norm(places - places.mean(axis=0)).mean())) for _, _, places in rims]

    def alike(k: int, m: int) -> bool:
        (one, size), (two, other) = middles[k], middles[m]
        return rims[k][0] < rims[m][0] and float(norm(two - one)) + abs(other - size) <= COINCIDENT_MM

    return [(rims[k][0], rims[k][1]) for k in range(len(rims)) if any(alike(k, m) for m in range(len(rims)))]


def _smooth_parts(shape: Any) -> list[Surface]:
    """A surface, or the mantle and the caps of a body."""
    if isinstance(shape, Capped):
        return list(shape.parts)
    if isinstance(shape, PlacedSurface) and isinstance(shape.surface, Capped):
        return [replace(shape, surface=part) for part in shape.surface.parts]
    return [shape]


def _side(unrolled: Unrolled, tolerance: float, u: tuple[float, float], v: tuple[float, float]) -> Floats:
    """(n,2) the points of a straight line in the parameters, its chords within the tolerance; of a ruling two."""
    if u[0] == u[1]:
        return unrolled.placed(np.array(u), np.array(v))
    count = 32
    while True:
        way = np.linspace(0.0, 1.0, 2 * count + 1)
        points = unrolled.placed(u[0] + way * (u[1] - u[0]), v[0] + way * (v[1] - v[0]))
        off = norm(points[1::2] - (points[:-2:2] + points[2::2]) / 2.0)
        if float(off.max()) <= tolerance or count >= MOST_POINTS:
            return points
        count *= 2


def _polylines(lines: Sequence[Floats], layer: int, piece: int, kind: LineKind = LineKind.CURVE) -> Strokes2D:
    count = len(lines)
    points = np.concatenate([np.zeros((0, 2)), *lines])
    whole = np.full(count, piece)
    offsets = ragged.offsets([len(line) for line in lines])
    return Strokes2D(points, offsets, np.full(count, layer), np.full(count, int(kind)), whole)


def _curves_on_surface(
    item: Item, unrolled: Unrolled, others: Sequence[Item], tracing: Tracing, tolerance: float, piece: int
) -> Iterator[Strokes2D]:
    """Parameter lines, curves, sections, and where other items meet the surface."""
    surface, lines = unrolled.surface, item.curves
    domain, swapped = surface.domain, isinstance(surface, Transposed)
    across, along = (lines.rows, lines.columns) if swapped else (lines.columns, lines.rows)
    us, vs = domain.grid(max(across, 1), max(along, 1))
    us, vs = us[0 if not domain.closed_u else 1 : -1][: 0 if across < 2 else None], vs[1:-1][: 0 if along < 2 else None]
    if across > 1 and not domain.closed_u:
        us = us[1:]
    straight = [_side(unrolled, tolerance, (u, u), (domain.v_start, domain.v_end)) for u in us.tolist()]
    round_ones = [_side(unrolled, tolerance, (domain.u_start, domain.u_end), (v, v)) for v in vs.tolist()]
    yield _polylines([*straight, *round_ones], CURVE, piece, LineKind.PARAMETER)
    for path in lines.paths:
        t = np.linspace(path.start, path.end, MOST_POINTS + 1)
        u, v = np.moveaxis(np.asarray(path.function.values(t)), -1, 0)
        ends = np.stack([np.stack([u, v], axis=1)[:-1], np.stack([u, v], axis=1)[1:]], axis=1)
        yield _within(unrolled, ends[..., ::-1] if swapped else ends, LineKind.CURVE, piece)
    for section in lines.sections:
        found = plane_sections(surface, section.normal, section.offsets, tracing=tracing)
        yield _within(unrolled, _ends(found, np.stack([found.u, found.v], axis=1)), section.kind, piece)
    for other in others:
        if isinstance(other.shape, Mesh):
            curves = mesh_section(surface, other.shape, tracing=tracing).curves
            ends = _ends(curves, np.stack([curves.u, curves.v], axis=1))
            yield _within(unrolled, ends, LineKind.INTERSECTION, piece)
        elif is_parametrised(other.shape):
            for part in _smooth_parts(other.shape):
                met = surface_intersection(surface, part, tracing=tracing)
                yield _within(unrolled, _ends(met, met.one), LineKind.INTERSECTION, piece)


def _labels_on_surface(
    unrolled: Unrolled, labels: Sequence[Label], tolerance: float, piece: int
) -> Iterator[Strokes2D]:
    """The letters of labels at points no farther than a tolerance from the surface."""
    surface, at = unrolled.surface, _points_of(labels)
    if not len(at):
        return
    u, v = (grid.ravel() for grid in np.meshgrid(*surface.domain.grid(*STARTS), indexing="ij"))
    start = np.argmin(norm(surface.points(u, v) - at[:, None]), axis=1)
    u, v = u[start], v[start]
    domain = surface.domain
    low, high = (domain.u_start, domain.v_start), (domain.u_end, domain.v_end)
    for _ in range(STEPS):
        step_u, step_v = _in_parameters(surface, u, v, at - surface.points(u, v))
        u, v = np.clip(u + step_u, low[0], high[0]), np.clip(v + step_v, low[1], high[1])
    near = norm(surface.points(u, v) - at) <= tolerance
    # Level is what leads to the right as one looks at the normal, also where u and v have changed places.
    normal = normals(surface, u, v) * (-1.0 if isinstance(surface, Transposed) else 1.0)
    level = _level(normal / np.maximum(norm(normal), LEAST_DIVISOR)[:, None])
    step_u, step_v = _in_parameters(surface, u, v, level)
    least = min(domain.u_end - domain.u_start, domain.v_end - domain.v_start)
    small = LEVEL_STEP_OF_DOMAIN * least / np.maximum(np.maximum(np.abs(step_u), np.abs(step_v)), LEAST_DIVISOR)
    origins = unrolled.placed(u, v)
    back = unrolled.placed(np.clip(u - small * step_u, low[0], high[0]), np.clip(v - small * step_v, low[1], high[1]))
    ahead = unrolled.placed(np.clip(u + small * step_u, low[0], high[0]), np.clip(v + small * step_v, low[1], high[1]))
    for number in np.flatnonzero(near).tolist():
        yield _letters(labels[number], origins[number], ahead[number] - back[number], piece)


def _in_parameters(surface: Surface, u: Floats, v: Floats, ways: Floats) -> tuple[Floats, Floats]:
    """(n,) the steps in u and in v that lead along the tangential parts of ways (n,3) from places."""
    along_u, along_v = surface.partials(u, v)
    uu, uv, vv = dot(along_u, along_u), dot(along_u, along_v), dot(along_v, along_v)
    du, dv = dot(ways, along_u), dot(ways, along_v)
    whole = np.maximum(uu * vv - uv * uv, LEAST_DIVISOR)
    return (vv * du - uv * dv) / whole, (uu * dv - uv * du) / whole


def _ends(curves: Any, places: Floats) -> Floats:
    """(s,2,2) the parameters at both ends of the segments of curves, known at their points (n,2)."""
    return places[segments(curves)]


def _within(unrolled: Unrolled, ends: Floats, kind: LineKind, piece: int) -> Strokes2D:
    """Segments (s,2,2) in the parameters, which may run on over the seam, in the plane; at the seam they are cut."""
    domain = unrolled.surface.domain
    ends = ends[np.isfinite(ends).all(axis=(1, 2))]
    if domain.closed_u and len(ends):
        period = domain.u_end - domain.u_start
        # Where a curve closes it may have gone around.
        ends[:, 1, 0] += period * np.rint((ends[:, 0, 0] - ends[:, 1, 0]) / period)
        low = np.minimum(ends[:, 0, 0], ends[:, 1, 0])
        seam = domain.u_start + period * (np.floor((low - domain.u_start) / period) + 1.0)
        way = ends[:, 1, 0] - ends[:, 0, 0]
        over = (seam - low < np.abs(way)) & (seam > low)
        part = np.where(over, (seam - ends[:, 0, 0]) / np.where(way != 0.0, way, 1.0), 0.0)
        middle = ends[:, 0] + part[:, None] * (ends[:, 1] - ends[:, 0])
        ends = np.concatenate(
            [
                ends[~over],
                np.stack([ends[over, 0], middle[over]], axis=1),
                np.stack([middle[over], ends[over, 1]], axis=1),
            ]
        )
        # The middle of a segment tells in which turn it is.
        turn = np.floor((ends[..., 0].mean(axis=1) - domain.u_start) / period) * period
        u = np.clip(ends[..., 0] - turn[:, None], domain.u_start, domain.u_end)
        ends = np.stack([u, ends[..., 1]], axis=2)
    u, v = ends[..., 0].ravel(), ends[..., 1].ravel()
    flat = unrolled.placed(u, v).reshape(-1, 2, 2)
    return Strokes2D.of_segments(flat, CURVE, np.full(len(flat), piece), kind)


# What is added: tabs to glue, and numbers at the sides that belong together.


def _tabbed(made: Developed, height: float) -> tuple[Developed, int]:
    """The same with tabs along sides, at one of each two that belong together, and how many have none, for there is no
    room beside either. Sides shorter than the height of a tab get none."""
    rest = np.flatnonzero(norm(made.one[:, 1] - made.one[:, 0]) >= height)
    for angle in TAB_ANGLES:
        made, glued = _with_tabs(made, rest, height, angle)
        rest = rest[~glued]
    missing = 0
    for rim, piece in zip(made.rims, made.of_rim, strict=True):
        made, complete = _with_teeth(made, rim, piece, height)
        missing += not complete
    return made, len(rest) + missing


def _with_teeth(made: Developed, rim: Floats, piece: int, height: float) -> tuple[Developed, bool]:
    """The same with teeth along a curved rim (n,2) of a piece, as many as have room; and whether these are all."""
    import shapely

    along = np.concatenate([[0.0], np.cumsum(norm(np.diff(rim, axis=0)))])
    count = max(FEWEST_TEETH, math.ceil(float(along[-1]) / (TOOTH * height)))
    feet = float(along[-1]) * np.arange(count + 1) / count
    places = np.stack([np.interp(feet, along, column) for column in rim.T], axis=1)
    sides = np.stack([places[:-1], places[1:]], axis=1)
    for angle in TAB_ANGLES:
        teeth = _tabs(sides, height, angle)
        # Feet are chords: the half of a tooth that is next to them may lie on the piece.
        upper = shapely.polygons(np.concatenate([(teeth[:, :2] + teeth[:, :1:-1]) / 2.0, teeth[:, 2:]], axis=1))
        own = made.areas[made.piece == piece]
        tooth, area = shapely.STRtree(own).query(upper, predicate="intersects")
        over = np.zeros(count, dtype=np.bool_)
        over[tooth[shapely.area(shapely.intersection(upper[tooth], own[area])) > COINCIDENT_MM * height]] = True
        one, two = shapely.STRtree(upper).query(upper, predicate="intersects")
        one, two = one[one < two], two[one < two]
        over[two[shapely.area(shapely.intersection(upper[one], upper[two])) > COINCIDENT_MM * height]] = True
        if not over.any():
            break
    kept = np.flatnonzero(~over)
    inner = [rim[(along > low) & (along < high)] for low, high in pairwise(feet.tolist())]
    lines = [np.concatenate([side[:1], between, side[1:]]) for side, between in zip(sides, inner, strict=True)]
    strokes = [_without_segments(made.strokes, rim[None, [0, -1]], np.array([piece]))]
    strokes.append(_polylines([lines[k] for k in kept.tolist()], MOUNTAIN, piece))
    strokes.append(_polylines([lines[k] for k in np.flatnonzero(over).tolist()], CUT, piece))
    strokes.append(_polylines(list(teeth[kept][:, [1, 2, 3, 0]]), CUT, piece))
    areas = np.concatenate([made.areas, shapely.polygons(teeth[kept])])
    pieces = np.concatenate([made.piece, np.full(len(kept), piece)])
    return replace(made, strokes=Strokes2D.joined(strokes), areas=areas, piece=pieces), not over.any()


def _with_tabs(made: Developed, pairs: Ints, height: float, angle: float) -> tuple[Developed, Bools]:
    """The same with tabs along some pairs of sides, where there is room for such with this angle at their feet; and at
    which (n,) there is."""
    import shapely

    count = len(pairs)
    if not count:
        return made, np.zeros(0, dtype=np.bool_)
    sides = np.concatenate([made.one[pairs], made.other[pairs]])
    of = np.concatenate([made.of_one[pairs], made.of_other[pairs]])
    tabs = _tabs(sides, height, angle)
    polygons = shapely.polygons(tabs)
    tab, area = shapely.STRtree(made.areas).query(polygons, predicate="intersects")
    same = of[tab] == made.piece[area]
    tab, area = tab[same], area[same]
    common = shapely.area(shapely.intersection(polygons[tab], made.areas[area]))
    blocked = np.zeros(len(sides), dtype=np.bool_)
    blocked[tab[common > COINCIDENT_MM * height]] = True
    chosen = np.where(blocked[:count], np.arange(count) + count, np.arange(count))
    chosen = chosen[~blocked[chosen]]
    one, two = shapely.STRtree(polygons[chosen]).query(polygons[chosen], predicate="intersects")
    some = (one < two) & (of[chosen[one]] == of[chosen[two]])
    one, two = one[some], two[some]
    deep = shapely.area(shapely.intersection(polygons[chosen[one]], polygons[chosen[two]])) > COINCIDENT_MM * height
    chosen = np.delete(chosen, np.unique(two[deep]))
    feet = Strokes2D.of_segments(sides[chosen], MOUNTAIN, of[chosen])
    rims = Strokes2D(
        tabs[chosen][:, [1, 2, 3, 0]].reshape(-1, 2),
        4 * np.arange(len(chosen) + 1),
        np.full(len(chosen), CUT),
        np.full(len(chosen), int(LineKind.CURVE)),
        of[chosen],
    )
    strokes = _without_segments(made.strokes, sides[chosen], of[chosen])
    strokes = Strokes2D.joined([strokes, feet, rims])
    areas = np.concatenate([made.areas, polygons[chosen]])
    piece = np.concatenate([made.piece, of[chosen]])
    return replace(made, strokes=strokes, areas=areas, piece=piece), np.isin(np.arange(count), chosen % count)


def _tabs(sides: Floats, height: float, angle: float) -> Floats:
    """(n,4,2) trapezoids to the right of sides (n,2,2), with this angle at their feet."""
    way = sides[:, 1] - sides[:, 0]
    length = np.maximum(norm(way), LEAST_DIVISOR)[:, None]
    along = way / length
    right = np.stack([along[:, 1], -along[:, 0]], axis=1)
    slope = math.tan(math.radians(angle))
    high = np.minimum(height, WIDEST_FOOT * length * slope)
    foot = high / slope
    start, end = sides[:, 0], sides[:, 1]
    return np.stack([start, end, end - foot * along + high * right, start + foot * along + high * right], axis=1)


def _without_segments(strokes: Strokes2D, sides: Floats, of: Ints) -> Strokes2D:
    """The strokes without those that are cut along sides (n,2,2) of pieces (n,)."""
    first, last = strokes.points[strokes.offsets[:-1]], strokes.points[strokes.offsets[1:] - 1]
    own = np.column_stack([first, last, strokes.piece])
    gone = np.column_stack([sides[:, 0], sides[:, 1], of])
    _, number = np.unique(np.concatenate([own, gone]), axis=0, return_inverse=True)
    kept = ~np.isin(number.ravel()[: len(own)], number.ravel()[len(own) :]) | (strokes.layer != CUT)
    position, offsets = ragged.take(strokes.offsets, kept)
    return Strokes2D(strokes.points[position], offsets, strokes.layer[kept], strokes.kind[kept], strokes.piece[kept])


def _numbered(made: Developed) -> Developed:
    """The same with equal numbers inside of sides that belong together."""
    lines: list[Strokes2D] = []
    for number in in_turn(range(min(len(made.one), MOST_NUMBERS))):
        for side, piece in ((made.one[number], made.of_one[number]), (made.other[number], made.of_other[number])):
            (x, y), length = side[1] - side[0], float(norm(side[1] - side[0]))
            size = min(LETTERS_MM, length / 3.0)
            middle = side.mean(axis=0) + 0.5 * size * np.array([-y, x]) / max(length, LEAST_DIVISOR)
            turn = math.degrees(float(arctan2(y, x)))
            text = lettered(str(number + 1), middle, size_mm=size, align="centre", rotation_deg=turn).strokes
            lines.append(_polylines([text[k] for k in range(len(text))], NUMBER, int(piece), LineKind.LABEL))
    return replace(made, strokes=Strokes2D.joined([made.strokes, *lines]))


# The pieces on a page.


@dataclass(frozen=True, eq=False)
class Layout:
    """Where pieces lie: turns (p,2): cosine and sine; shifts (p,2); size (2,): of what they take together."""

    turns: Floats
    shifts: Floats
    size: Floats


def _laid_out(strokes: Strokes2D, count: int, width: float | None) -> Layout:
    """The pieces, each lying on its longer side, in rows below one another, not wider than a width if one is given."""
    points, piece = strokes.points, np.repeat(strokes.piece, np.diff(strokes.offsets))
    turns = _directions(strokes, points, piece, count)
    turns = np.stack([turns[:, 0], -turns[:, 1]], axis=1)
    low, high = _boxes(points, piece, turns)
    # What stands is laid down.
    upright = (high - low)[:, 1] > (high - low)[:, 0] + COINCIDENT_MM
    turns[upright] = np.stack([-turns[upright, 1], turns[upright, 0]], axis=1)
    low, high = _boxes(points, piece, turns)
    sizes = high - low
    total = float((sizes + GAP_MM).prod(axis=1).sum())
    limit = max(float(sizes[:, 0].max()), math.sqrt(PROPORTION * total)) if width is None else width
    shifts, x, y, row, reach = np.zeros((count, 2)), 0.0, 0.0, 0.0, 0.0
    for k in np.lexsort((np.arange(count), -sizes[:, 1])).tolist():
        wide, tall = sizes[k].tolist()
        if x > 0.0 and x + wide > limit:
            x, y, row = 0.0, y + row + GAP_MM, 0.0
        shifts[k] = np.array([x, -y - tall]) - low[k]
        row, reach = max(row, tall), max(reach, x + wide)
        x += wide + GAP_MM
    return Layout(turns, shifts + np.array([0.0, y + row]), np.array([reach, y + row]))


def _boxes(points: Floats, piece: Ints, turns: Floats) -> tuple[Floats, Floats]:
    """(p,2) the smallest and the largest coordinates of pieces that are turned."""
    low, high = (np.full((len(turns), 2), end) for end in (np.inf, -np.inf))
    lying = turned(turns[piece], points)
    np.minimum.at(low, piece, lying)
    np.maximum.at(high, piece, lying)
    return low, high


def _directions(strokes: Strokes2D, points: Floats, piece: Ints, count: int) -> Floats:
    """(p,2) along which the cuts and folds of each piece run, or across which, with the greatest length in all."""
    straight = (np.diff(strokes.offsets) == 2) & (strokes.layer < NUMBER)
    first = strokes.offsets[:-1][straight]
    way, of = points[first + 1] - points[first], strokes.piece[straight]
    length = norm(way)
    quarter = 0.5 * math.pi
    angle = np.mod(arctan2(way[:, 1], way[:, 0]), quarter)
    # A direction and the one a little below a quarter of a turn from it are the same.
    bin_ = np.mod(np.rint(angle / SAME_WAY), round(quarter / SAME_WAY))
    keys, number = np.unique(np.stack([of, bin_], axis=1), axis=0, return_inverse=True)
    total = np.bincount(number.ravel(), length, len(keys)).round(6)
    order = np.lexsort((keys[:, 1], -total, keys[:, 0]))
    lead = order[np.concatenate([np.ones(min(len(order), 1), dtype=np.bool_), np.diff(keys[order, 0]) > 0])]
    found = np.tile([1.0, 0.0], (count, 1))
    some = np.flatnonzero(np.isin(number.ravel(), lead))
    found[of[some]] = way[some] / np.maximum(length[some], LEAST_DIVISOR)[:, None]
    return found


@stoppable
def development(
    scene: object,
    *,
    page: Page | str | None = None,
    scale: str = "1:1",
    unit: Literal["mm", "cm", "m", "in"] = "mm",
    tabs_mm: float = 0.0,
    numbers: bool = False,
    crease_angle_deg: float = 25.0,
    tolerance_mm: float = 0.02,
    budget: float = 1.0,
    jobs: int | None = None,
    progress: Callable[[str, float], None] | None = None,
    explain: Callable[[StageReport], None] | None = None,
) -> Drawing:
    """The developments of bodies and surfaces on a page, in true size, with the curves that lie on them.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, surface, or several of these
        What is developed, see `io.scene_of`: polyhedra, open or closed, and developable surfaces, bodies with caps
        among them. Curves in space, annotations, camera and lights do not count.
    page : Page or str, optional
        Or its name or size; where None a page as large as the pieces, with a margin.
    scale : str
        Lengths on paper to lengths in space, such as "1:2".
    unit : {"mm", "cm", "m", "in"}
        What a unit of the world is.
    tabs_mm : float
        The width of tabs to glue, along one of each two sides that belong together, as far as there is room; none where
        0.
    numbers : bool
        Sides that belong together have equal numbers.
    crease_angle_deg : float
        Polyhedra are folded along sharper edges; others are not drawn.
    tolerance_mm : float
        How far chords of curves may be off, and how far apart corners of polyhedra may come to lie that count as one:
        so meshes of developable surfaces unroll as a whole.
    budget : float
        How many times the usual work on curves of smooth surfaces is allowed.
    jobs : int, optional
        As in draw.
    progress, explain : callable, optional
        As in draw.

    Returns
    -------
    Drawing
        Layers cut, mountain fold and valley fold, seen from outside; label, the numbers; and those of the curves, by
        kind: sections, parameter lines, patterns, and where items meet.

    Raises
    ------
    InputError
        See `io.scene_of`.
        Where nothing in the scene is developable; for pieces that do not fit the page.

    Warns
    -----
    InputWarning
        For meshes that are developable but for some hundredths of a mm, with how much; for sides without room for a
        tab; for surfaces that are not developable, with why, and polyhedra of too many faces: these are left out.

    Notes
    -----
    A polyhedron is unfolded along a spanning tree of its faces. Those of rings around the lowest face, of flat, long
    and level edges are tried, and the net is taken that has the fewest pieces, then the shortest cuts; no two faces of
    a piece overlap. Lengths are kept to 1e-9 of the size; a smooth surface is unrolled along a curve by the integral of
    its geodesic curvature.

    Edge cases: items that meet are developed whole, the curve that they have in common on both.

    Source: Schlickenrieder (1997), Nets of polyhedra; do Carmo, Differential geometry of curves and surfaces.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry
    >>> net = vp.development(geometry.box((20, 20, 20)))
    >>> round(net.width_mm), round(net.height_mm), [layer.name for layer in net.layers]
    (100, 80, ['cut', 'mountain fold'])
    """
    told = dict(locals())
    check_options(told)
    check_word("unit", unit, MM_PER)
    factor = DrawingScale.of(scale).factor * MM_PER[unit]
    allowed = budget_of(budget)
    given = scene_of(scene).scaled(factor)
    pipeline = Pipeline(
        [Stage("develop", "asked for"), Stage("layout", "on a page")], explain, progress, threads_of(jobs)
    )
    tracing = Tracing(tolerance=tolerance_mm, budget=allowed)
    made = pipeline.run("develop", _developed, given, crease_angle_deg, tolerance_mm, tracing)
    without = 0
    for k, one in enumerate(made):
        if tabs_mm:
            made[k], missing = _tabbed(one, tabs_mm)
            without += missing
        made[k] = _numbered(made[k]) if numbers else made[k]
    if without:
        warnings.warn(f"tabs: {without} sides have no room for one", InputWarning, stacklevel=3)
    gap = max(one.gap for one in made)
    pipeline.measured("develop", "mm", lambda: gap)
    for one in made:
        if one.gap > COINCIDENT_MM:
            text = f"{one.name}: developed as if corners up to {one.gap:.2g} mm apart were one"
            warnings.warn(text, InputWarning, stacklevel=3)
    return pipeline.run("layout", _drawing, made, given, page)


def _labels_in_space(scene: Scene) -> list[Label]:
    """Those with letters at points."""
    return [label for label in scene.labels if isinstance(label.at, tuple) and label.text.strip()]


def _developed(scene: Scene, crease_angle_deg: float, tolerance: float, tracing: Tracing) -> list[Developed]:
    """All items that are bodies or surfaces."""
    bodies = [
        item
        for item in scene.items
        if not is_curve(item.shape) and not (isinstance(item.shape, Mesh) and not item.mesh.face_count)
    ]
    if not bodies:
        raise InputError("there is nothing to develop: no polyhedra and no surfaces")
    made: list[Developed] = []
    left_out: list[str] = []
    labels = _labels_in_space(scene)
    for item in in_turn(bodies):
        others = [other for other in bodies if other is not item]
        try:
            if isinstance(item.shape, Mesh):
                made.append(_of_mesh(item, others, labels, crease_angle_deg, tolerance, tracing))
            elif is_parametrised(item.shape):
                made.append(_of_surface(item, others, labels, tolerance, tracing))
            else:
                raise InputError("an implicit surface has no development; a mesh of it may have one")
        except InputError as error:
            left_out.append(f"{item.name}: {error.cause}")
    if not made:
        raise InputError(left_out[0])
    for text in left_out:
        warnings.warn(f"{text}; it is left out", InputWarning, stacklevel=4)
    return made


def _drawing(made: Sequence[Developed], scene: Scene, page: Page | str | None) -> Drawing:
    """The pieces on their page."""
    first = ragged.offsets([one.count for one in made])
    strokes = Strokes2D.joined(
        [
            replace(one.strokes, piece=one.strokes.piece + start)
            for one, start in zip(made, first[:-1].tolist(), strict=True)
        ]
    )
    item = ragged.owner([len(one.strokes.piece) for one in made])
    sheet = None if page is None else page_of(page, scene, None, True)
    width = None if sheet is None else sheet.width_mm - 2.0 * sheet.margin_mm
    layout = _laid_out(strokes, int(first[-1]), width)
    of_point = np.repeat(strokes.piece, np.diff(strokes.offsets))
    if sheet is None:
        margin = Page().margin_mm
        wide, high = (layout.size + 2.0 * margin).tolist()
        sheet = Page(wide, high, margin)
    room = np.array([sheet.width_mm, sheet.height_mm]) - 2.0 * sheet.margin_mm
    if (layout.size > room + COINCIDENT_MM).any():
        (wide, high), (w, h) = layout.size.tolist(), room.tolist()
        raise InputError(f"the pieces take {wide:.0f} x {high:.0f} mm, the page has {w:.0f} x {h:.0f} mm for them")
    points = turned(layout.turns[of_point], strokes.points)
    points += layout.shifts[of_point] + sheet.margin_mm + (room - layout.size) / 2.0
    paths = Paths(
        points,
        strokes.offsets,
        np.zeros(len(strokes.piece), dtype=np.bool_),
        strokes.kind,
        item,
        np.zeros(len(strokes.piece), dtype=np.intp),
        np.column_stack([points, np.zeros(len(points))]),
    )
    layers = [Layer(name, pen, (chosen(paths, strokes.layer == k),)) for k, (name, pen) in enumerate(PENS.items())]
    layers += layers_by_kind(chosen(paths, strokes.layer >= NUMBER))
    drawn = inked(tuple(layer for layer in layers if any(map(len, layer.marks))), "none", np.eye(4))
    names = tuple(one.name for one in made)
    return Drawing(sheet.width_mm, sheet.height_mm, drawn, names, scene.title, np.eye(4))

"""Bodies of OpenCASCADE as boundary representations: the surfaces of their faces, their trims, and their edges."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats
from vectorplot.curves.splines import SplineCurve
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import may_stop
from vectorplot.geometry.vectors import dot, norm
from vectorplot.io.opencascade import Numbers, explored, occ
from vectorplot.surfaces.brep import BrepEdges, BrepFace, Plane, TurnedCircle, TurnedLine
from vectorplot.surfaces.parameter_regions import bounds_of_many, parameter_regions
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.splines import SplineSurface
from vectorplot.surfaces.stacked import unit_normals
from vectorplot.surfaces.surface import Domain, OverDomain, Transposed, second_jets
from vectorplot.surfaces.swept import Screw, Swept
from vectorplot.tolerances import CAD_EDGE_OFF_FACE, PIECES_OFF_EDGE, RING_OPEN

ROUND_ROWS = 128
"""Rows of a whole circle as cubic pieces: these are off it by 1.5e-8 of its radius."""

SPLINE_ROWS, FEWEST_ROWS = 16, 33
"""Rows for each polynomial of a spline, and for other curves at least."""

MOST_ROWS = 1 << 13
"""Rows of one edge, at most."""

AROUND_TRIMS = 1.0 / 32.0
"""Part of what trims measure by which the domain goes on beyond them, where the surface does: so ends of the domain are
no tangents of curves."""


TANGENT_COSINE = float(np.cos(np.radians(1.0)))
"""Faces that meet at a smaller angle are tangent to each other."""


class NotMapped(Exception):
    """A body with a face or an edge that has no counterpart here: why."""


@dataclass(frozen=True, eq=False)
class BodyFaces:
    """The faces of a body and its edges, of unknown kinds; at their rows normals (n,3) out of the body, and mean
    curvatures (n,) along these."""

    faces: tuple[BrepFace, ...]
    edges: BrepEdges
    normals: Floats
    bending: Floats


@dataclass(eq=False)
class _Use:
    """An edge in the ring of a face: its curve in u and v, and its number; whether it runs the other way in the ring;
    degenerate: whether it is a point."""

    edge: int
    face: int
    flat_curve: Any
    backwards: bool
    degenerate: bool
    places: Floats = field(default_factory=lambda: np.zeros((0, 2)))
    turns: Floats = field(default_factory=lambda: np.zeros((0, 2)))

    @property
    def is_line(self) -> bool:
        """Whether it is straight in u and v."""
        return _type(self.flat_curve) == "Line"

    def read(self, rows: int) -> None:
        """Its rows."""
        start, end = self.flat_curve.FirstParameter(), self.flat_curve.LastParameter()
        self.places, self.turns = _rows(self.flat_curve, start, end, rows, 2)

    def pieces(self) -> Floats:
        """(k,4,2) cubic pieces as they run in the ring."""
        own = np.array([0, -1]) if self.is_line else np.arange(len(self.places))
        start, end = self.places[own[:-1]], self.places[own[1:]]
        if self.is_line:
            third = (end - start) / 3.0
            pieces = np.stack([start, start + third, end - third, end], axis=1)
        else:
            leaving, arriving = self.turns[:-1] / 3.0, self.turns[1:] / 3.0
            pieces = np.stack([start, start + leaving, end - arriving, end], axis=1)
        return pieces[::-1, ::-1] if self.backwards else pieces


@dataclass(eq=False)
class _Face:
    """A face: its surface for a domain, how far that reaches by itself (2,2), its periods, 0 where it has none."""

    make: Callable[[Domain], PlacedSurface]
    ends: Floats
    periods: Floats
    flat: bool
    turned: bool
    rings: list[list[_Use]]


def _type(adaptor: Any) -> str:
    """What a curve or a surface is."""
    return str(adaptor.GetType()).split("_")[-1]


def body_faces(shape: Any) -> BodyFaces:
    """The faces and edges of a shape of OpenCASCADE.

    Errors: NotMapped where a surface has no counterpart, and where edges do not lie on their faces.
    """
    numbers, curves, faces = Numbers(), dict[int, Any](), list[_Face]()
    for face in explored(shape, "FACE"):
        may_stop()
        faces.append(_face(face, len(faces), numbers, curves))
    uses = [use for face in faces for ring in face.rings for use in ring]
    rows = dict[int, int]()
    for use in uses:
        count = 2 if use.is_line else _count(use.flat_curve)
        if not use.degenerate:
            count = max(count, _count(curves[use.edge]))
        rows[use.edge] = max(rows.get(use.edge, 2), count)
    points = {edge: _closed(*_fine_rows(curve, edge, rows)) for edge, curve in curves.items()}
    for use in uses:
        use.read(rows[use.edge])
    return _together(_trimmed(faces, [_seams(face, rows) for face in faces]), faces, points, curves)


def _face(face: Any, number: int, numbers: Numbers, curves: dict[int, Any]) -> _Face:
    """A face with the edges of its rings, whose curves in space are added by their numbers."""
    orientations = occ("TopAbs").TopAbs_Orientation
    forward = occ("TopoDS").TopoDS
    cast = getattr(forward, "Face_s", None) or forward.Face
    turned = face.Orientation() == orientations.TopAbs_REVERSED
    face = cast(face.Oriented(orientations.TopAbs_FORWARD))
    tool, adaptors = occ("BRep").BRep_Tool, occ("BRepAdaptor")
    surface = adaptors.BRepAdaptor_Surface(face, False)
    rings = list[list[_Use]]()
    for wire in explored(face, "WIRE"):
        ring, walker = list[_Use](), occ("BRepTools").BRepTools_WireExplorer(wire, face)
        while walker.More():
            edge = walker.Current()
            way = edge.Orientation()
            if way not in (orientations.TopAbs_FORWARD, orientations.TopAbs_REVERSED):
                raise NotMapped("an edge inside of a face")
            of, point = numbers.of(edge), tool.Degenerated_s(edge)
            if not point and of not in curves:
                curves[of] = adaptors.BRepAdaptor_Curve(edge)
            flat = adaptors.BRepAdaptor_Curve2d(edge, face)
            ring.append(_Use(of, number, flat, way == orientations.TopAbs_REVERSED, bool(point)))
            walker.Next()
        if len(ring) != sum(1 for _ in explored(wire, "EDGE")):
            raise NotMapped("edges that make no ring")
        if ring:
            rings.append(ring)
    ends = np.array(
        [
            (surface.FirstUParameter(), surface.FirstVParameter()),
            (surface.LastUParameter(), surface.LastVParameter()),
        ]
    )
    periods = np.array(
        [surface.UPeriod() if surface.IsUPeriodic() else 0.0, surface.VPeriod() if surface.IsVPeriodic() else 0.0]
    )
    make, ends = _surface(surface, ends)
    return _Face(make, ends, periods, _type(surface) == "Plane", turned, rings)


# Curves as rows of points and slopes.


def _count(curve: Any) -> int:
    """How many rows a curve takes."""
    kind = _type(curve)
    if kind == "Line":
        return 2
    span = curve.LastParameter() - curve.FirstParameter()
    if kind in ROUND[1:]:
        return max(9, int(np.ceil(ROUND_ROWS * span / (2.0 * np.pi))) + 1)
    pieces = curve.NbKnots() - 1 if kind == "BSplineCurve" else 1
    return int(min(max(FEWEST_ROWS, 1 + SPLINE_ROWS * pieces), MOST_ROWS))


def _rows(curve: Any, start: float, end: float, rows: int, dimensions: int) -> tuple[Floats, Floats]:
    """(n,d) the points of a curve at evenly spaced parameters, and the derivatives by the number of the row."""
    if not (np.isfinite([start, end]).all() and start < end and max(abs(start), abs(end)) < ENDLESS):
        raise NotMapped("an edge without end")
    t, step, kind = np.linspace(start, end, rows), (end - start) / (rows - 1), _type(curve)
    if kind == "Line":
        line = curve.Line()
        way = np.array(line.Direction().Coord())
        return np.array(line.Location().Coord()) + t[:, None] * way, np.tile(way * step, (rows, 1))
    if kind in ROUND[1:]:
        conic = getattr(curve, kind)()
        x, y = (np.array(axis.Direction().Coord()) for axis in (conic.XAxis(), conic.YAxis()))
        a, b = (conic.Radius(),) * 2 if kind == "Circle" else (conic.MajorRadius(), conic.MinorRadius())
        cosine, sine = np.cos(t)[:, None], np.sin(t)[:, None]
        points = np.array(conic.Location().Coord()) + a * cosine * x + b * sine * y
        return points, step * (b * cosine * y - a * sine * x)
    gp, name = occ("gp"), "" if dimensions == 3 else "2d"
    point, slope = getattr(gp, f"gp_Pnt{name}")(), getattr(gp, f"gp_Vec{name}")()
    points, slopes = np.empty((rows, dimensions)), np.empty((rows, dimensions))
    for row, at in enumerate(t.tolist()):
        curve.D1(at, point, slope)
        points[row], slopes[row] = point.Coord(), slope.Coord()
    return points, step * slopes


def _fine_rows(curve: Any, edge: int, rows: dict[int, int]) -> tuple[Floats, Floats]:
    """The rows of an edge in space, so many that cubic pieces between them are near it: their number is put in rows."""
    start, end = curve.FirstParameter(), curve.LastParameter()
    found = _rows(curve, start, end, rows[edge], 3)
    while _type(curve) not in ROUND and 2 * rows[edge] < MOST_ROWS:
        twice = 2 * rows[edge] - 1
        points, slopes = found
        finer = _rows(curve, start, end, twice, 3)
        between = 0.5 * (points[:-1] + points[1:]) + 0.125 * (slopes[:-1] - slopes[1:])
        off = float(norm(between - finer[0][1::2]).max())
        if off <= PIECES_OFF_EDGE * float(np.ptp(points, axis=0).max()):
            break
        rows[edge], found = twice, finer
    return found


ROUND = ("Line", "Circle", "Ellipse")
"""Curves of which it is known how many rows they take."""

ENDLESS = 1e50
"""Larger parameters stand for infinite ones."""


def _closed(points: Floats, slopes: Floats) -> tuple[Floats, Floats]:
    """The rows, the last point exactly the first one where both are one to within rounding."""
    size = float(np.ptp(points, axis=0).max())
    if float(norm(points[-1] - points[0])) <= RING_OPEN * size:
        points = np.concatenate([points[:-1], points[:1]])
    return points, slopes


# Surfaces.


def _frame(position: Any) -> tuple[Floats, Floats]:
    """The axes (3,3) as rows, and the origin (3,), of a coordinate system."""
    axes = [position.XDirection(), position.YDirection(), position.Direction()]
    return np.array([axis.Coord() for axis in axes]), np.array(position.Location().Coord())


def _surface(surface: Any, ends: Floats) -> tuple[Callable[[Domain], PlacedSurface], Floats]:
    """What makes the surface over a domain, and how far (2,2) that may reach. Errors: NotMapped."""
    kind = _type(surface)
    if kind == "Plane":
        axes, origin = _frame(surface.Plane().Position())
        return lambda domain: PlacedSurface(Plane(domain), axes, origin), ends
    if kind in ("Cylinder", "Cone", "Sphere", "Torus"):
        shape = getattr(surface, kind)()
        axes, origin = _frame(shape.Position())
        if kind == "Cylinder":
            make: Callable[[Domain], Any] = partial(TurnedLine, radius=shape.Radius())
        elif kind == "Cone":
            sine, cosine = np.sin(shape.SemiAngle()), np.cos(shape.SemiAngle())
            make = partial(TurnedLine, radius=shape.RefRadius(), growth=float(sine), rise=float(cosine))
        elif kind == "Sphere":
            make = partial(TurnedCircle, major=0.0, minor=shape.Radius())
        else:
            make = partial(TurnedCircle, major=shape.MajorRadius(), minor=shape.MinorRadius())
        return lambda domain: PlacedSurface(make(domain), axes, origin), ends
    try:
        found = _spline(surface, kind, ends)
    except InputError as error:
        raise NotMapped(str(error)) from None
    if found is None:
        raise NotMapped(f"a face on what OpenCASCADE calls {kind}")
    return found, ends


def _spline(surface: Any, kind: str, ends: Floats) -> Callable[[Domain], PlacedSurface] | None:
    """What makes a surface of splines over a domain; None for what is none."""
    if kind in ("BSplineSurface", "BezierSurface"):
        spline = _spline_surface(surface, kind)
        return lambda domain: PlacedSurface(OverDomain(spline, domain), np.eye(3))
    if kind not in ("SurfaceOfExtrusion", "SurfaceOfRevolution"):
        return None
    curve = _spline_curve(surface.BasisCurve())
    if curve is None:
        return None
    if kind == "SurfaceOfExtrusion":
        return partial(_extruded, curve, np.array(surface.Direction().Coord()))
    axis = surface.AxeOfRevolution()
    up, origin = np.array(axis.Direction().Coord()), np.array(axis.Location().Coord())
    across = np.cross(up, np.eye(3)[np.argmin(np.abs(up))])
    across /= norm(across)
    axes = np.array([across, np.cross(up, across), up])
    meridian = SplineCurve(matmul(np.asarray(curve.controls) - origin, axes.T), curve.knots, curve.order, curve.weights)
    round_ = Swept(meridian, Screw(), 0.0, 2.0 * np.pi)
    return lambda domain: PlacedSurface(Transposed(round_, domain, embedded=True), axes, origin)


def _extruded(curve: SplineCurve, way: Floats, domain: Domain) -> PlacedSurface:
    """The surface that a curve sweeps along a way, v the length."""
    low, high = domain.v_start, domain.v_end
    controls, weights = np.asarray(curve.controls), curve.weights
    grid = np.stack([controls + low * way, controls + high * way], axis=1)
    both = None if weights is None else np.stack([np.asarray(weights)] * 2, axis=1)
    spline = SplineSurface(grid, curve.knots, [low, low, high, high], curve.order, 2, both)
    return PlacedSurface(OverDomain(spline, domain), np.eye(3))


def _spline_curve(curve: Any) -> SplineCurve | None:
    """The spline that a curve is; None for what is none."""
    kind = _type(curve)
    if kind not in ("BSplineCurve", "BezierCurve"):
        return None
    spline = (curve.BSpline() if kind == "BSplineCurve" else curve.Bezier()).Copy()
    if kind == "BezierCurve":
        knots = np.repeat([0.0, 1.0], spline.Degree() + 1)
    else:
        if spline.IsPeriodic():
            spline.SetNotPeriodic()
        knots = _knots(spline.NbKnots(), spline.Knot, spline.Multiplicity)
    count = range(1, spline.NbPoles() + 1)
    controls = np.array([spline.Pole(k).Coord() for k in count])
    weights = np.array([spline.Weight(k) for k in count]) if spline.IsRational() else None
    return SplineCurve(controls, knots, spline.Degree() + 1, weights)


def _spline_surface(surface: Any, kind: str) -> SplineSurface:
    """The spline that a surface is."""
    spline = (surface.BSpline() if kind == "BSplineSurface" else surface.Bezier()).Copy()
    if kind == "BezierSurface":
        knots = [np.repeat([0.0, 1.0], degree + 1) for degree in (spline.UDegree(), spline.VDegree())]
    else:
        if spline.IsUPeriodic():
            spline.SetUNotPeriodic()
        if spline.IsVPeriodic():
            spline.SetVNotPeriodic()
        knots = [
            _knots(spline.NbUKnots(), spline.UKnot, spline.UMultiplicity),
            _knots(spline.NbVKnots(), spline.VKnot, spline.VMultiplicity),
        ]
    many_u, many_v = range(1, spline.NbUPoles() + 1), range(1, spline.NbVPoles() + 1)
    controls = np.array([[spline.Pole(i, j).Coord() for j in many_v] for i in many_u])
    rational = spline.IsURational() or spline.IsVRational()
    weights = np.array([[spline.Weight(i, j) for j in many_v] for i in many_u]) if rational else None
    return SplineSurface(controls, knots[0], knots[1], spline.UDegree() + 1, spline.VDegree() + 1, weights)


def _knots(count: int, knot: Callable[[int], float], many: Callable[[int], int]) -> Floats:
    """The knots, each as often as it counts."""
    numbers = range(1, count + 1)
    return np.repeat([knot(k) for k in numbers], [many(k) for k in numbers])


# Trims.


def _seams(face: _Face, rows: dict[int, int]) -> Bools:
    """(2,) whether a face closes smoothly along u and along v: an edge comes twice in it, at a smooth place."""
    closed = np.zeros(2, dtype=np.bool_)
    known = dict[int, _Use]()
    for use in (use for ring in face.rings for use in ring if not use.degenerate):
        other = known.setdefault(use.edge, use)
        if other is use:
            continue
        middle = rows[use.edge] // 2
        both = np.stack([other.places[middle], use.places[middle]])
        low, high = both.min(axis=0), both.max(axis=0)
        room = np.maximum(high - low, 1.0)
        surface = face.make(_domain(low - room, high + room, face.ends))
        one, two = unit_normals(surface, both[:, 0], both[:, 1])
        if float(dot(one, two)) >= TANGENT_COSINE:
            closed[int(np.argmax(np.abs(both[1] - both[0])))] = True
    return closed


def _domain(low: Floats, high: Floats, ends: Floats, closed: Sequence[bool] = (False, False)) -> Domain:
    """That from low to high (2,), no farther than ends (2,2), but in directions that are closed."""
    low = np.where(closed, low, np.maximum(low, ends[0]))
    high = np.where(closed, high, np.minimum(high, ends[1]))
    return Domain(
        float(low[0]), float(high[0]), float(low[1]), float(high[1]), closed_u=bool(closed[0]), closed_v=bool(closed[1])
    )


def _trimmed(faces: Sequence[_Face], closed: Sequence[Bools]) -> list[BrepFace]:
    """Faces over domains around their rings, within these. Errors: NotMapped for rings that do not close."""
    if not all(face.rings for face in faces):
        raise NotMapped("a face without edges")
    if not faces:
        return []
    loops = [[_loop(ring) for ring in face.rings] for face in faces]
    domains = [_domain_around(*one) for one in zip(faces, closed, bounds_of_many(loops), strict=True)]
    regions = parameter_regions(domains, loops, filled=False).apart()
    if not all(region.leaves_anything for region in regions):
        raise NotMapped("a face of which its edges leave nothing")
    return [
        BrepFace(face.make(domain), region, face.flat, face.turned)
        for face, domain, region in zip(faces, domains, regions, strict=True)
    ]


def _domain_around(face: _Face, closed: Bools, bounds: Floats) -> Domain:
    """That around the rings of a face, which reach from bounds[0] to bounds[1] in u and v."""
    may_stop()
    low, high = bounds
    size = high - low
    room = AROUND_TRIMS * size
    # No more than once round.
    periodic = face.periods > 0.0
    room = np.where(periodic, np.clip(0.5 * (face.periods - size), 0.0, room), room)
    ends = face.ends.copy()
    ends[:, periodic] = np.array([[-np.inf], [np.inf]])
    # Where edges are points, as poles and apices, there is nothing beyond.
    for use in (use for ring in face.rings for use in ring if use.degenerate):
        axis = int(np.argmin(np.ptp(use.places, axis=0)))
        value = float(use.places[0, axis])
        side = int(abs(value - high[axis]) < abs(value - low[axis]))
        room_end = ends[side, axis]
        ends[side, axis] = max(value, room_end) if side == 0 else min(value, room_end)
    begin, end = low - room, high + room
    begin = np.where(closed, low, begin)
    end = np.where(closed, np.where(periodic, low + face.periods, high), end)
    return _domain(begin, end, ends, closed.tolist())


def _loop(ring: Sequence[_Use]) -> Floats:
    """(k,4,2) the pieces of a ring, which end exactly where the next ones begin. Errors: NotMapped where they do not
    end there at all."""
    parts = [use.pieces() for use in ring]
    pieces = np.concatenate(parts).copy()
    size = float(np.ptp(pieces.reshape(-1, 2), axis=0).max())
    start, end = pieces[:, 0], pieces[:, 3]
    after = np.roll(start, -1, axis=0)
    if (norm(after - end) > RING_OPEN * size).any():
        raise NotMapped("edges that make no ring")
    pieces[:, 3] = after
    return pieces


# Bodies.


def _together(
    made: Sequence[BrepFace], faces: Sequence[_Face], points: dict[int, tuple[Floats, Floats]], curves: dict[int, Any]
) -> BodyFaces:
    """The body of faces; edges that are seams of a face are left out."""
    uses = list[_Use]()
    for face, known in zip(faces, made, strict=True):
        own = [use for ring in face.rings for use in ring if not use.degenerate]
        domain = known.surface.domain
        twice = np.bincount([use.edge for use in own], minlength=1) > 1
        closes = domain.closed_u or domain.closed_v
        uses += [use for use in own if not (closes and twice[use.edge] and _is_seam(use, own, domain))]
    if not uses:
        return _no_edges(made)
    used, edge = np.unique([use.edge for use in uses], return_inverse=True)
    sizes = np.array([len(use.places) for use in uses])
    owner = np.array([use.face for use in uses])
    edges = BrepEdges(
        np.zeros(len(used), dtype=np.intp),
        np.array([_type(curves[k]) == "Line" for k in used.tolist()]),
        edge.ravel().astype(np.intp),
        owner,
        ragged.offsets(sizes),
        np.concatenate([points[use.edge][0] for use in uses]),
        np.concatenate([points[use.edge][1] for use in uses]),
        np.concatenate([use.places for use in uses]),
        np.concatenate([use.turns for use in uses]),
    )
    normals, bending = np.empty_like(edges.points), np.empty(len(edges.points))
    off = np.empty(len(edges.points))
    order = np.argsort(owner, kind="stable")
    for number in np.unique(owner).tolist():
        may_stop()
        begin, end = np.searchsorted(owner[order], [number, number + 1])
        which = order[begin:end]
        rows = ragged.ranges(edges.offsets[which], sizes[which])
        surface, sign = made[number].surface, -1.0 if made[number].turned else 1.0
        u, v = edges.places[rows].T
        with np.errstate(all="ignore"):
            off[rows] = norm(surface.points(u, v) - edges.points[rows])
            normals[rows] = sign * np.nan_to_num(unit_normals(surface, u, v))
            _, along_u, along_v, *second = second_jets(surface, u, v)
            bending[rows] = mean_curvatures((along_u, along_v), second, normals[rows])
    extent = float(norm(np.ptp(edges.points, axis=0)))
    if not float(off.max()) <= CAD_EDGE_OFF_FACE * extent:
        raise NotMapped("an edge that does not lie on its face")
    return BodyFaces(tuple(made), edges, normals, bending)


def mean_curvatures(first: Sequence[Floats], second: Sequence[Floats], normals: Floats) -> Floats:
    """(k,) the mean curvatures of surfaces, positive where they bend towards unit normals (k,3).

    first (k,3): derivatives by u and by v; second (k,3): by u twice, by u and v, by v twice. Not finite where there is
    no tangent plane.
    """
    along_u, along_v = first
    e, f, g = dot(along_u, along_u), dot(along_u, along_v), dot(along_v, along_v)
    second_u, mixed, second_v = (dot(part, normals) for part in second)
    with np.errstate(all="ignore"):
        return np.asarray((e * second_v - 2.0 * f * mixed + g * second_u) / (2.0 * (e * g - f * f)))


def _is_seam(use: _Use, others: Sequence[_Use], domain: Domain) -> bool:
    """Whether an edge comes a whole round away in its face again."""
    two = next(one for one in others if one.edge == use.edge and one is not use)
    away = np.abs(use.places[0] - two.places[0]) / domain.size
    closed = np.array([domain.closed_u, domain.closed_v])
    return bool((closed & (away > 0.5)).any())


def _no_edges(made: Sequence[BrepFace]) -> BodyFaces:
    """A body without edges, such as a ball or a ring."""
    none, rows = np.zeros(0, dtype=np.intp), np.zeros((0, 3))
    flat = np.zeros((0, 2))
    edges = BrepEdges(none, np.zeros(0, dtype=np.bool_), none, none, np.zeros(1, dtype=np.intp), rows, rows, flat, flat)
    return BodyFaces(tuple(made), edges, rows, np.zeros(0))

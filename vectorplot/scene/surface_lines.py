"""Which lines are drawn on a smooth surface besides its contour and its borders."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import number, parameter_range, positive
from vectorplot.curves.derivatives import NumericFunction, Range, numeric_function
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import determinant, matmul
from vectorplot.geometry.elementary import cbrt, log
from vectorplot.geometry.mesh_cuts import moved_planes
from vectorplot.geometry.vectors import norm
from vectorplot.tolerances import OFF_REGULAR_GRID, ROUNDING
from vectorplot.words import LineKind

if TYPE_CHECKING:
    from vectorplot.features.curve_tracing import SurfaceCurves
    from vectorplot.features.mesh_lines import MeshCurves
    from vectorplot.features.tangent_fields import TangentField


# Integral curves that an item asks for: of fields of directions, geodesics and shortest ways.

MOST_STARTS = 10_000
"""The largest number of points that curves of one field are asked for through."""

MOST_PAIRS = 100
"""The largest number of pairs of places that geodesics are asked for between."""

USUAL_APART = 1.0 / 24.0
"""Part of the extent of a shape that neighbours are apart where nothing is said."""


class PointsOf(NamedTuple):
    """What lines on one sort of shape begin with: so many numbers a point, a start and its direction, and what these
    numbers are."""

    points: int
    starts: int
    what: str


ON_SURFACES = PointsOf(2, 3, "u v on a surface")
ON_MESHES = PointsOf(3, 6, "x y z on a polyhedron")


@dataclass(frozen=True)
class FieldLines:
    """Lines of a surface or a mesh that follow a field of directions: through given points, or evenly all over it.

    Parameters
    ----------
    field : TangentField
        Such as PrincipalDirections() of the room features.
    apart : float, optional
        How far neighbours are from each other, in world units; a twenty-fourth of the extent of the shape where None.
    through : tuple of (float, float), or of (float, float, float)
        Parameters u, v of points on a surface, or points in the world, of which the nearest ones on a mesh count; where
        there are some, the lines through these are drawn and no others.
    length : float, optional
        How long the lines through given points are to each side of these at most, in world units; ten times the extent
        of the shape where None.

    Raises
    ------
    InputError
        For a distance or a length that is not positive, a length without points, points that are not two finite numbers
        each, or three each, more than 10000 of them.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import features, scene
    >>> lines = scene.FieldLines(features.SteepestSlope(), apart=0.25)
    >>> bool(vp.SurfaceLines(integral=(lines,)))
    True
    """

    field: TangentField
    apart: float | None = None
    through: tuple[tuple[float, ...], ...] = ()
    length: float | None = None

    def __post_init__(self) -> None:
        if self.apart is not None:
            positive("field lines: distance", self.apart)
        object.__setattr__(self, "through", _rows("field lines", self.through, ON_SURFACES.points, ON_MESHES.points))
        if self.length is not None:
            positive("field lines: length", self.length)
            if not self.through:
                raise InputError("field lines: a length is for lines through given points")

    def transformed(self, matrix: Floats, larger: float) -> FieldLines:
        """The lines of the shape under a 4x4 matrix acting on columns that makes lengths so many times larger."""
        apart = None if self.apart is None else larger * self.apart
        length = None if self.length is None else larger * self.length
        return replace(self, apart=apart, through=_moved(self.through, matrix), length=length)


@dataclass(frozen=True)
class NamedVectors:
    """The vectors of a field of the item that lines belong to, for VectorField: the parts NAME.x, NAME.y and NAME.z.

    Parameters
    ----------
    name : str
        Of the field.

    Raises
    ------
    InputError
        Where it is called: which item's they are is known where lines are drawn.

    Examples
    --------
    >>> from vectorplot.features import VectorField
    >>> from vectorplot.scene import FieldLines, NamedVectors
    >>> FieldLines(VectorField(NamedVectors("velocity"))).field.function.name
    'velocity'
    """

    name: str

    def __call__(self, points: Floats) -> Floats:
        """InputError: which item's they are is not known here."""
        raise InputError(f"field lines: vectors of the field {self.name!r} are of meshes that have it")


@dataclass(frozen=True)
class FieldContours:
    """Lines of a mesh along which a field of its item has one value; they are of the kind section.

    Parameters
    ----------
    name : str
        Of a field with numbers at the vertices.
    values : int or tuple of float
        About so many round values, or these.

    Raises
    ------
    InputError
        For no values or more than 10000, and values that are not finite.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot.scene import FieldContours, Fields
    >>> square = vp.Mesh.from_polygons([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)], [(0, 1, 2, 3)])
    >>> heat = Fields(square, {"heat": np.array([0.0, 2.0, 2.0, 0.0])})
    >>> lines = vp.SurfaceLines(contours=(FieldContours("heat", (1.0,)),))
    >>> drawing = vp.draw(vp.Item("S", square, fields=heat, curves=lines), "top", lines="section")
    >>> sum(len(layer.strokes[0]) for layer in drawing.layers)
    1
    """

    name: str
    values: int | tuple[float, ...] = 12

    def __post_init__(self) -> None:
        if isinstance(self.values, int):
            if not 1 <= self.values <= MAX_LINES:
                raise InputError(f"contours: {self.values} of them, expected 1 to {MAX_LINES}")
            return
        object.__setattr__(self, "values", _numbers("contours", self.values))
        if not self.values:
            raise InputError("contours: expected a value or more")

    def levels(self, numbers: Floats) -> tuple[float, ...]:
        """The values of a field whose numbers (n,) are these."""
        if not isinstance(self.values, int):
            return self.values
        known = numbers[np.isfinite(numbers)]
        return round_heights(float(known.min()), float(known.max()), self.values) if len(known) else ()


@dataclass(frozen=True)
class GeodesicLines:
    """Geodesics of a surface or a mesh, from given points in given directions.

    Parameters
    ----------
    starts : tuple of (float, float, float), or of six float
        On a surface parameters u, v, and the angle in radians from the direction in which u grows, counter-clockwise
        about the normals; for a mesh points in the world, of which the nearest ones on it count, and directions.
    length : float, optional
        How long they are at most, in world units; ten times the extent of the shape where None.

    Raises
    ------
    InputError
        For a length that is not positive, starts that are not three finite numbers each, or six each, more than 10000
        of them.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import scene
    >>> bool(vp.SurfaceLines(integral=(scene.GeodesicLines(((0.0, 0.0, 1.0),), length=20.0),)))
    True
    """

    starts: tuple[tuple[float, ...], ...]
    length: float | None = None

    def __post_init__(self) -> None:
        if self.length is not None:
            positive("geodesics: length", self.length)
        object.__setattr__(self, "starts", _rows("geodesics", self.starts, ON_SURFACES.starts, ON_MESHES.starts))

    def transformed(self, matrix: Floats, larger: float) -> GeodesicLines:
        """The lines of the shape under a 4x4 matrix acting on columns that makes lengths so many times larger."""
        length, starts = None if self.length is None else larger * self.length, self.starts
        if starts and len(starts[0]) == ON_MESHES.starts:
            points = _moved(tuple(row[:3] for row in starts), matrix)
            ways = matmul(np.array(starts)[:, 3:], matrix[:3, :3].T)
            starts = tuple((*point, *way) for point, way in zip(points, ways.tolist(), strict=True))
        return replace(self, length=length, starts=starts)


@dataclass(frozen=True)
class ShortestPaths:
    """The shortest ways on a mesh from one point to another.

    Parameters
    ----------
    ends : tuple of six float
        Two points in the world, of which the nearest ones on the mesh count, for each way.

    Raises
    ------
    InputError
        For ends that are not six finite numbers each, more than 10000 of them.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import scene
    >>> bool(vp.SurfaceLines(integral=(scene.ShortestPaths(((0, 0, 0, 1, 1, 1),)),)))
    True
    """

    ends: tuple[tuple[float, ...], ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "ends", _rows("shortest paths", self.ends, ON_MESHES.starts, ON_MESHES.starts))

    def transformed(self, matrix: Floats, larger: float) -> ShortestPaths:
        """The ways on the mesh under a 4x4 matrix acting on columns."""
        ends = [_moved(tuple(row[k : k + 3] for row in self.ends), matrix) for k in (0, 3)]
        return ShortestPaths(tuple((*one, *two) for one, two in zip(*ends, strict=True)))


@dataclass(frozen=True)
class GeodesicsBetween:
    """Geodesics of a surface from one place to another, the shortest ones.

    Parameters
    ----------
    pairs : tuple of (float, float, float, float)
        Parameters u, v of where each begins, and those of where it ends.
    most : int
        How many from each place to the other.
    length : float, optional
        How long they are at most, in world units; three times the extent of the surface where None.

    Raises
    ------
    InputError
        For a length or a number that is not positive, pairs that are not four finite numbers each, more than 100 of
        them.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import scene
    >>> bool(vp.SurfaceLines(integral=(scene.GeodesicsBetween(((0.0, 0.0, 1.0, 0.5),)),)))
    True
    """

    pairs: tuple[tuple[float, ...], ...]
    most: int = 1
    length: float | None = None

    def __post_init__(self) -> None:
        if self.length is not None:
            positive("geodesics: length", self.length)
        if not 1 <= self.most <= MOST_PAIRS:
            raise InputError(f"geodesics between places: {self.most} of them, expected 1 to {MOST_PAIRS}")
        if len(self.pairs) > MOST_PAIRS:
            raise InputError(f"geodesics between places: {len(self.pairs)} pairs, expected at most {MOST_PAIRS}")
        object.__setattr__(self, "pairs", _rows("geodesics between places", self.pairs, 4, 4))

    def transformed(self, matrix: Floats, larger: float) -> GeodesicsBetween:
        """The lines of the surface under a 4x4 matrix acting on columns that makes lengths so many times larger."""
        return self if self.length is None else replace(self, length=larger * self.length)


@dataclass(frozen=True, eq=False)
class KnownCurves:
    """Curves on a surface or a mesh that are known already, and are only to be drawn.

    curves: on the shape of their item, in world coordinates.
    """

    curves: SurfaceCurves | MeshCurves

    def transformed(self, matrix: Floats, larger: float) -> KnownCurves:
        """The same curves under a 4x4 matrix acting on columns."""
        points = matmul(self.curves.points, matrix[:3, :3].T) + matrix[:3, 3]
        return KnownCurves(replace(self.curves, points=points))


IntegralLines = FieldLines | GeodesicLines | GeodesicsBetween | ShortestPaths | KnownCurves


def check_points(lines: IntegralLines, on: PointsOf) -> None:
    """Nothing, where lines begin at points of the sort of shape they are on. Errors: InputError where not."""
    if isinstance(lines, GeodesicsBetween | KnownCurves):
        return
    if isinstance(lines, FieldLines):
        name, rows, width = "field lines", lines.through, on.points
    elif isinstance(lines, ShortestPaths):
        name, rows, width = "shortest paths", lines.ends, ON_MESHES.starts
    else:
        name, rows, width = "geodesics", lines.starts, on.starts
    if rows and len(rows[0]) != width:
        raise InputError(f"{name}: expected points {on.what}, {width} numbers each, got {len(rows[0])}")


def _rows(name: str, rows: tuple[tuple[float, ...], ...], width: int, other: int) -> tuple[tuple[float, ...], ...]:
    """The rows, of one width or the other, as numbers."""
    if len(rows) > MOST_STARTS:
        raise InputError(f"{name}: {len(rows)} points, expected at most {MOST_STARTS}")
    try:
        values = np.array(rows, dtype=np.float64).reshape(len(rows), -1 if rows else width)
    except (TypeError, ValueError):
        values = np.full((1, 0), np.nan)
    if values.shape[1] not in (width, other) or not np.isfinite(values).all():
        widths = f"{width}" if width == other else f"{width}, or {other},"
        raise InputError(f"{name}: expected {widths} finite numbers for each point")
    return tuple(tuple(row) for row in values.tolist())


def _moved(points: tuple[tuple[float, ...], ...], matrix: Floats) -> tuple[tuple[float, ...], ...]:
    """Points in space under a matrix (4,4); parameters as they are."""
    if not points or len(points[0]) != ON_MESHES.points:
        return points
    return tuple(map(tuple, (matmul(np.array(points), matrix[:3, :3].T) + matrix[:3, 3]).tolist()))


# Lines that a terrain asks for: water, watersheds, valleys and roads.

Pair = tuple[float, float]

MOST_SOURCES = 10_000
"""Places that water is asked to run from, at most."""


@dataclass(frozen=True)
class WaterCourses:
    """The ways of water from given places, down where it is steepest.

    Parameters
    ----------
    places : tuple of (float, float)
        x and y of the sources, in world coordinates.

    Raises
    ------
    InputError
        For places that are not pairs of finite numbers, more than 10000 of them.

    Notes
    -----
    See `water_courses` of the room features.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import scene
    >>> bool(vp.SurfaceLines(terrain=(scene.WaterCourses(((3.0, 4.0),)),)))
    True
    """

    places: tuple[Pair, ...]

    def __post_init__(self) -> None:
        object.__setattr__(self, "places", _pairs("water", self.places))

    def transformed(self, matrix: Floats) -> WaterCourses:
        """The same places under a 4x4 matrix acting on columns that keeps verticals. Errors: InputError for others."""
        return replace(self, places=_points_moved("water", self.places, matrix))


@dataclass(frozen=True)
class Watersheds:
    """The lines that part waters, from saddles up to summits; or valley lines, from saddles down to pits.

    Parameters
    ----------
    valleys : bool
        Whether they are valley lines.

    Notes
    -----
    See `watersheds` and `valley_lines` of the room features.

    Examples
    --------
    >>> from vectorplot import scene
    >>> scene.Watersheds().valleys
    False
    """

    valleys: bool = False

    def transformed(self, matrix: Floats) -> Watersheds:
        """The same."""
        return self


@dataclass(frozen=True)
class Roads:
    """The roads of constant slope between two places: to the left of the steepest way up, and to its right.

    Parameters
    ----------
    start, end : (float, float)
        x and y, in world coordinates.

    Raises
    ------
    InputError
        For places that are not two finite numbers.

    Notes
    -----
    See `roads` of the room features.

    Examples
    --------
    >>> from vectorplot import scene
    >>> scene.Roads((0, 0), (3, 4)).end
    (3.0, 4.0)
    """

    start: Pair
    end: Pair

    def __post_init__(self) -> None:
        start, end = _pairs("road", (self.start, self.end))
        object.__setattr__(self, "start", start)
        object.__setattr__(self, "end", end)

    def transformed(self, matrix: Floats) -> Roads:
        """The same places under a 4x4 matrix acting on columns that keeps verticals. Errors: InputError for others."""
        return Roads(*_points_moved("road", (self.start, self.end), matrix))


@dataclass(frozen=True)
class Serpentine:
    """A road with hairpin bends between two places, of at most a given slope.

    Parameters
    ----------
    start, end : (float, float)
        x and y, in world coordinates.
    slope_deg : float
        The largest slope of its legs, in degrees.
    radius, width : float, optional
        Of the bends, and how far from the straight line of the plan they begin at most, in world units; a thirtieth of
        the distance of the ends, and all of it, where None.

    Raises
    ------
    InputError
        For places that are not two finite numbers, a slope that is not between 0 and 90 degrees, a radius or a width
        that is not positive.

    Notes
    -----
    See `serpentine` of the room features.

    Examples
    --------
    >>> from vectorplot import scene
    >>> scene.Serpentine((0, 0), (3, 4), slope_deg=7).end
    (3.0, 4.0)
    """

    start: Pair
    end: Pair
    slope_deg: float
    radius: float | None = None
    width: float | None = None

    def __post_init__(self) -> None:
        start, end = _pairs("serpentine", (self.start, self.end))
        object.__setattr__(self, "start", start)
        object.__setattr__(self, "end", end)
        if not 0.0 < number("serpentine: slope", self.slope_deg) < 90.0:
            raise InputError(f"serpentine: slope {self.slope_deg:g}, expected an angle between 0 and 90 degrees")
        for name in ("radius", "width"):
            if getattr(self, name) is not None:
                positive(f"serpentine: {name}", getattr(self, name))

    def transformed(self, matrix: Floats) -> Serpentine:
        """The same places under a 4x4 matrix acting on columns that keeps verticals, with lengths as areas of the plan
        grow. Errors: InputError for others."""
        scale = float(np.sqrt(abs(determinant(matrix[:2, :2]))))
        radius, width = (None if size is None else scale * size for size in (self.radius, self.width))
        start, end = _points_moved("serpentine", (self.start, self.end), matrix)
        return Serpentine(start, end, self.slope_deg, radius, width)


TerrainLines = WaterCourses | Watersheds | Roads | Serpentine


def _pairs(name: str, pairs: tuple[Pair, ...]) -> tuple[Pair, ...]:
    if len(pairs) > MOST_SOURCES:
        raise InputError(f"{name}: {len(pairs)} places, expected at most {MOST_SOURCES}")
    try:
        values = np.array(pairs, dtype=np.float64)
    except (TypeError, ValueError):
        values = np.full((1, 0), np.nan)
    if values.ndim != 2 or values.shape[1] != 2 or not np.isfinite(values).all():
        raise InputError(f"{name}: expected two finite numbers for each place, x and y")
    return tuple((x, y) for x, y in values.tolist())


def _points_moved(name: str, pairs: tuple[Pair, ...], matrix: Floats) -> tuple[Pair, ...]:
    if matrix[:2, 2].any() or matrix[2, :2].any():
        raise InputError(f"{name}: a terrain that is tilted has no places x and y any more")
    return tuple((x, y) for x, y in (matmul(np.array(pairs), matrix[:2, :2].T) + matrix[:2, 3]).tolist())


Vector = tuple[float, float, float]

MAX_LINES = 10_000
"""The largest number of lines of one sort on one item."""


def _numbers(name: str, values: tuple[float, ...]) -> tuple[float, ...]:
    """The values, each one once."""
    try:
        result = tuple(float(value) for value in values)
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected numbers") from None
    if len(result) > MAX_LINES:
        raise InputError(f"{name}: {len(result)} of them, expected at most {MAX_LINES}")
    if not np.isfinite(result).all():
        raise InputError(f"{name}: expected finite numbers")
    return tuple(dict.fromkeys(result))


@dataclass(frozen=True)
class Section:
    """Parallel planes, in world coordinates: the points whose height along the normal is one of the offsets.

    Parameters
    ----------
    normal : (float, float, float)
        In world coordinates, of any length but zero, kept with length 1.
    offsets : (k,) tuple of float
        Distances from the origin along the normal, in world units.
    slices : bool
        Whether pictures are painted slice by slice between them.
    index : bool
        Whether the lines are of the kind index, those that are drawn heavier, instead of section.
    numbered : bool
        Whether the offsets stand on the lines, which are interrupted, where they are straight enough.

    Raises
    ------
    InputError
        For a normal without length, numbers that are not finite, more than MAX_LINES offsets.

    Notes
    -----
    Edge cases: an offset that is given several times counts once.

    Source: Glaeser, sections 5.3 and 9.3.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Section((0, 0, 2), (1, 2))
    Section(normal=(0.0, 0.0, 1.0), offsets=(1.0, 2.0), slices=False, index=False)
    """

    normal: Vector
    offsets: tuple[float, ...]
    slices: bool = False
    index: bool = False
    numbered: bool = field(default=False, repr=False)

    def __post_init__(self) -> None:
        normal = np.array(self.normal, dtype=np.float64)
        if normal.shape != (3,) or not np.isfinite(normal).all() or not normal.any():
            raise InputError("sections: expected a normal of three finite numbers, not all zero")
        # Divided by the largest first: squares of very long normals would overflow. A unit vector stays what it is.
        if abs(norm(normal / np.abs(normal).max()) * np.abs(normal).max() - 1.0) > ROUNDING:
            normal /= np.abs(normal).max()
            normal /= norm(normal)
        x, y, z = normal.tolist()
        object.__setattr__(self, "normal", (x, y, z))
        object.__setattr__(self, "offsets", _numbers("sections", self.offsets))

    def transformed(self, matrix: Floats) -> Section:
        """The same planes under a 4x4 matrix acting on columns.

        Parameters
        ----------
        matrix : (4, 4) array of float
            Rows 0 to 2: rotation, scale and translation.

        Returns
        -------
        Section
            In the moved planes.

        Raises
        ------
        InputError
            Where numbers leave their range.

        Examples
        --------
        >>> import numpy as np
        >>> import vectorplot as vp
        >>> vp.Section((0, 0, 1), (1, 2)).transformed(np.diag([1.0, 1.0, 3.0, 1.0]))
        Section(normal=(0.0, 0.0, 1.0), offsets=(3.0, 6.0), slices=False, index=False)
        """
        normals, offsets = moved_planes(np.array([self.normal]), np.array(self.offsets), matrix)
        x, y, z = normals[0].tolist()
        return replace(self, normal=(x, y, z), offsets=tuple(offsets.tolist()))

    @property
    def kind(self) -> LineKind:
        """What its lines are."""
        return LineKind.INDEX if self.index else LineKind.SECTION


@dataclass(frozen=True)
class SurfacePath:
    """A curve on a parametrised surface; made by path_on_surface.

    function: gives u and v at t; start, end: the range of t.
    """

    function: NumericFunction
    start: float
    end: float


def _each_plane_once(sections: tuple[Section, ...]) -> tuple[Section, ...]:
    """The sections without the planes that those before them have, or index lines, whichever way the normals point;
    those between slices stay."""
    seen: set[tuple[Vector, float]] = set()
    index = {(section.normal, d) for section in sections if section.index for d in section.offsets}
    kept = []
    for section in sections:
        x, y, z = section.normal
        back = (-x, -y, -z)
        taken = seen if section.index else seen | index
        new = tuple(d for d in section.offsets if (section.normal, d) not in taken and (back, -d) not in taken)
        seen.update((section.normal, d) for d in new)
        if section.slices or not section.offsets:
            kept.append(section)
        elif new:
            kept.append(replace(section, offsets=new))
    return tuple(kept)


def path_on_surface(function: Callable[..., Any], start: float, end: float) -> SurfacePath:
    """The curve on a surface with the parameters function(t) = (u, v), start <= t <= end.

    Edge cases: where it leaves the surface, or is not finite, the curve is interrupted.
    Source: Glaeser, section 8.2, equation 9.
    """
    first, last = parameter_range("path", start, end)
    return SurfacePath(numeric_function(function, 2, (Range(first, last, False),)), first, last)


@dataclass(frozen=True)
class SurfaceLines:
    """The lines that an item asks for.

    Parameters
    ----------
    columns, rows : int
        Into how many parts lines u = const. and v = const. divide the surface, 0 for no lines.
    isophotes : tuple of float
        The cosines of the angle between normal and light along them.
    light : int, optional
        Which light of the scene isophotes are of, None for the first one, or, in a scene without, one from the upper
        left of the eye.
    sections : tuple of Section
        Families of plane sections, of which one at most cuts the item into slices.
    smooth : bool
        Those of a polyhedron are drawn as smooth curves through their points.
    along_edges : bool
        Isophotes of a polyhedron are its edges between lighter and darker faces.
    paths : tuple of SurfacePath
        Curves u(t), v(t) on a parametrised surface.
    integral : tuple of FieldLines, GeodesicLines, GeodesicsBetween and ShortestPaths
        Integral curves of a parametrised surface, or a polyhedron.
    terrain : tuple of WaterCourses, Watersheds, Roads and Serpentine
        Lines of a terrain, a mesh of triangles of which none is above another.
    detail : float
        How much there is of suggestive contours, ridges, valleys and apparent ridges: of twice the detail lines may be
        half as clear and half as long.
    contours : tuple of FieldContours
        Lines of a polyhedron along which a field of its item has one value.
    smooth_contours : bool
        The polyhedron is taken for a smooth shape: its contour runs across faces, where the average normals at its
        vertices are at right angles to the view, instead of along edges; at creases it is as ever.

    Raises
    ------
    InputError
        For a detail that is not finite and positive.
        For counts below 0 or above MAX_LINES, cosines that are not between -1 and 1, a light below 0, two families of
        slices.

    Notes
    -----
    Edge cases: planes and angles that are given several times count once.

    Source: Glaeser, sections 5.3, 8.2 and 9.3.

    Examples
    --------
    >>> import vectorplot as vp
    >>> lines = vp.SurfaceLines(columns=12, rows=6, isophotes=(-0.5, 0.0, 0.5))
    >>> bool(lines), bool(vp.SurfaceLines())
    (True, False)
    """

    columns: int = 0
    rows: int = 0
    isophotes: tuple[float, ...] = ()
    light: int | None = None
    sections: tuple[Section, ...] = ()
    smooth: bool = False
    along_edges: bool = False
    paths: tuple[SurfacePath, ...] = ()
    integral: tuple[IntegralLines, ...] = ()
    terrain: tuple[TerrainLines, ...] = ()
    detail: float = 1.0
    contours: tuple[FieldContours, ...] = ()
    smooth_contours: bool = False

    def __post_init__(self) -> None:
        if not 0.0 < self.detail < np.inf:
            raise InputError(f"a detail of {self.detail:g}: expected a number that is finite and positive")
        for word, count in (("columns", self.columns), ("rows", self.rows)):
            if not 0 <= count <= MAX_LINES or count != int(count):
                raise InputError(f"parameter lines: {count} {word}, expected a whole number from 0 to {MAX_LINES}")
        cosines = _numbers("isophotes", self.isophotes)
        if any(abs(cosine) > 1.0 for cosine in cosines):
            bad = next(cosine for cosine in cosines if abs(cosine) > 1.0)
            raise InputError(f"isophotes: {bad:g} is no cosine, expected -1 to 1")
        if self.light is not None and self.light < 0:
            raise InputError(f"isophotes: there is no light {self.light}, lights are counted from 0")
        object.__setattr__(self, "isophotes", cosines)
        object.__setattr__(self, "sections", _each_plane_once(tuple(self.sections)))
        if sum(section.slices for section in self.sections) > 1:
            raise InputError("slices: an item is cut into slices in one direction only")

    def transformed(self, matrix: Floats) -> SurfaceLines:
        """The lines of the item under a 4x4 matrix acting on columns.

        Parameters
        ----------
        matrix : (4, 4) array of float
            Rows 0 to 2: rotation, scale and translation.

        Returns
        -------
        SurfaceLines
            Sections lie in the moved planes, distances on the surface are larger by the cube root of what volumes are
            larger by.

        Raises
        ------
        InputError
            Where numbers leave their range.

        Examples
        --------
        >>> import numpy as np
        >>> import vectorplot as vp
        >>> lines = vp.SurfaceLines(columns=4, sections=(vp.Section((0, 0, 1), (1,)),))
        >>> lines.transformed(np.diag([2.0, 2.0, 2.0, 1.0])).sections[0].offsets
        (2.0,)
        """
        larger = linear_growth(matrix)
        integral = tuple(one.transformed(matrix, larger) for one in self.integral)
        terrain = tuple(one.transformed(matrix) for one in self.terrain)
        sections = tuple(one.transformed(matrix) for one in self.sections)
        return replace(self, sections=sections, integral=integral, terrain=terrain)

    @property
    def slices(self) -> Section | None:
        """The planes between the slices of the item, or None."""
        return next((section for section in self.sections if section.slices and section.offsets), None)

    def __bool__(self) -> bool:
        asked = (self.columns, self.rows, self.isophotes, self.sections, self.paths, self.integral, self.terrain)
        return any(map(bool, (*asked, self.contours)))


def linear_growth(matrix: Floats) -> float:
    """How many times longer lengths become, on average, under a matrix (4,4) that acts on columns."""
    with np.errstate(over="ignore"):
        return float(cbrt(abs(determinant(matrix[:3, :3]))))


NO_LINES = SurfaceLines()
"""Only contour and borders."""


def even_cosines(count: int) -> tuple[float, ...]:
    """Cosines of isophotes, evenly spaced between -1 and 1, both left out.

    Parameters
    ----------
    count : int
        How many, 1 to 10000.

    Returns
    -------
    tuple of float
        Ascending.

    Raises
    ------
    InputError
        For counts below 1 or above 10000.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import scene
    >>> scene.even_cosines(9)
    (-0.8, -0.6, -0.4, -0.2, 0.0, 0.2, 0.4, 0.6, 0.8)
    >>> lines = vp.SurfaceLines(isophotes=scene.even_cosines(3))
    """
    if not 1 <= count <= MAX_LINES:
        raise InputError(f"isophotes: {count} of them, expected 1 to {MAX_LINES}")
    return tuple((2 * k - count - 1) / (count + 1) for k in range(1, count + 1))


DEFAULT_COUNT = 20
"""Level lines between the lowest and the highest point, about."""


DEFAULT_EVERY = 5
"""Which of them are index lines."""


def round_heights(low: float, high: float, count: int = DEFAULT_COUNT) -> tuple[float, ...]:
    """Round heights for level lines, evenly spaced between two heights.

    Parameters
    ----------
    low, high : float
        In world units.
    count : int
        About how many: the step is 1, 2 or 5 times a power of ten.

    Returns
    -------
    tuple of float
        The multiples of the step that are more than low and less than high, ascending.

    Raises
    ------
    InputError
        For heights that are not finite, and counts below 1 or above 10000.

    Notes
    -----
    Edge cases: none where both heights are the same.

    Examples
    --------
    >>> from vectorplot import scene
    >>> scene.round_heights(3.0, 61.0, 10)
    (5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0)
    """
    low, high = number("level lines: height", low), number("level lines: height", high)
    if not 1 <= count <= MAX_LINES:
        raise InputError(f"level lines: {count} of them, expected 1 to {MAX_LINES}")
    if not low < high:
        return ()
    power = int(np.floor(math.log10((high - low) / count)))
    # The last of the four is the first of the next power of ten.
    numerators = np.array([1.0, 2.0, 5.0, 10.0])
    best = int(np.abs(log(numerators * 10.0**power * count / (high - low))).argmin())
    step = float(numerators[best])
    first, last = (np.floor(height / step / 10.0**power) for height in (low, high))
    found = times_power_of_ten(step * np.arange(first, last + 2.0), power)
    return tuple(found[(found > low) & (found < high)].tolist())


def with_index_lines(section: Section, every: int) -> tuple[Section, ...]:
    """The planes of a section, every k-th of them a section of index lines, see `level_sections`; these alone are
    numbered, where the section is."""
    if every < 0:
        raise InputError(f"index lines: every {every}, expected 0 or more")
    if not every or not section.offsets:
        return (section,)
    levels = np.array(sorted(section.offsets))
    index = _index_numbers(levels) % every == 0
    heavy = replace(section, offsets=tuple(levels[index].tolist()), index=True)
    parts = heavy, replace(section, offsets=tuple(levels[~index].tolist()), numbered=False)
    return tuple(part for part in parts if part.offsets)


def _index_numbers(levels: Floats) -> Floats:
    """(n,) the number of each level: how many steps it is from zero, or its place, from 1."""
    place = np.arange(1.0, len(levels) + 1.0)
    if len(levels) < 2:
        return place
    step = (levels[-1] - levels[0]) / (len(levels) - 1)
    number = levels / step
    even = np.abs(number - np.round(number)).max() <= OFF_REGULAR_GRID
    return np.asarray(np.round(number) if even else place)


LARGEST_POWER = 300
"""The powers of ten up to this one, and down to its negative, are numbers of full precision."""


def times_power_of_ten(values: Floats, power: int) -> Floats:
    """The values times a power of ten, rounded once where that power is a number; powers beyond LARGEST_POWER in two
    steps."""
    if abs(power) > LARGEST_POWER:
        half = LARGEST_POWER if power > 0 else -LARGEST_POWER
        return times_power_of_ten(times_power_of_ten(values, half), power - half)
    return np.asarray(values * 10.0**power if power >= 0 else values / 10.0**-power)

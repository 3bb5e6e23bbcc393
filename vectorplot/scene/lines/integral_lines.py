"""Integral curves that an item asks for: of fields of directions, geodesics and shortest ways."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.parameters import positive
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul

if TYPE_CHECKING:
    # What runs along fields is loaded when they are traced.
    from vectorplot.features.integral.tangent_fields import TangentField
    from vectorplot.features.meshes.mesh_curves import MeshCurves
    from vectorplot.features.parametric.surface_curves import SurfaceCurves

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

    Parameters
    ----------
    curves : SurfaceCurves or MeshCurves
        On the shape of their item, in world coordinates.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import features, geometry, scene
    >>> cube = geometry.box((2, 2, 2))
    >>> found = features.evenly_spaced_mesh_curves(cube, features.SteepestSlope(), 0.5)
    >>> item = vp.Item("cube", cube, curves=vp.SurfaceLines(integral=(scene.KnownCurves(found),)))
    >>> len(vp.draw(item, lines="integral").layers) > 0
    True
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

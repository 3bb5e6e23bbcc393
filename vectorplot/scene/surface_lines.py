"""Which lines are drawn on a smooth surface besides its contour and its borders."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.derivatives import NumericFunction, Range, numeric_function
from vectorplot.curves.parameters import parameter_range
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import determinant
from vectorplot.geometry.cuts.half_spaces import moved_planes
from vectorplot.geometry.elementary import cbrt
from vectorplot.geometry.vectors import norm
from vectorplot.scene.lines.integral_lines import IntegralLines
from vectorplot.scene.terrains.terrain_lines import TerrainLines
from vectorplot.tolerances.of_numbers import ROUNDING
from vectorplot.words import LineKind

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
    Degenerate: an offset that is given several times counts once.

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

    Parameters
    ----------
    function : NumericFunction
        Gives u and v at t.
    start, end : float
        The range of t.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.scene import path_on_surface
    >>> path = path_on_surface(lambda t: (t, 0.5 * t), 0.0, 6.0)
    >>> path.start, path.end
    (0.0, 6.0)
    >>> vp.SurfaceLines(paths=(path,)).paths == (path,)
    True
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

    Parameters
    ----------
    function : callable
        function(t) gives u and v, for a number or an array of them.
    start, end : float
        The range of t.

    Returns
    -------
    SurfacePath
        For the paths of SurfaceLines.

    Raises
    ------
    InputError
        For a range that is empty or not finite; naming the function, when it raises, returns complex numbers or the
        wrong shape.

    Notes
    -----
    Degenerate: where it leaves the surface, or is not finite, the curve is interrupted.

    Source: Glaeser, section 8.2, equation 9.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot.scene import path_on_surface
    >>> from vectorplot.surfaces import Torus
    >>> knot = path_on_surface(lambda t: (2 * t, 3 * t), 0.0, 2 * np.pi)
    >>> torus = vp.Item("torus", Torus(3.0, 1.0), curves=vp.SurfaceLines(paths=(knot,)))
    >>> len(torus.curves.paths)
    1
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
    Degenerate: planes and angles that are given several times count once.

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
        return any(map(bool, asked))


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

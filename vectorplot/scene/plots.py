"""Items made at once of what people have: grids of coordinates, functions of two variables, curves with a thickness."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.curves.curve import Curve
from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_repair import repaired, without_stutter
from vectorplot.scene.item import Item
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.surfaces.graphs import graph as graph_surface
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.swept import tube as tube_surface
from vectorplot.tolerances import COMPUTED
from vectorplot.words import DRAWN, LineKind

DIVISIONS = 20
"""Parts that the lines on a graph divide each side of it into where nothing is said."""


def surface(x: ArrayLike, y: ArrayLike, z: ArrayLike, colour: str = "gray", name: str = "surface") -> Item:
    """The faces between the points of a grid, as an item that shows the lines of the grid.

    Parameters
    ----------
    x, y : (m, n) array_like of float
        Coordinates of the points; where the grid is a rectangle also (n,) and (m,).
    z : (m, n) array_like of float
        Heights. Where a coordinate is not finite there is a hole.
    colour, name : str
        Of the item.

    Returns
    -------
    Item
        A Mesh of quadrangles. Points that meet, as along the seam of a cylinder and in poles, are one.

    Raises
    ------
    InputError
        For arrays that do not fit together, and where there is no face.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> turn, height = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, 13), [0.0, 1.0])
    >>> can = vp.surface(np.cos(turn), np.sin(turn), height)
    >>> len(can.mesh.vertices), can.mesh.face_count
    (24, 12)
    """
    heights = np.asarray(z, dtype=np.float64)
    across, up = (np.asarray(one, dtype=np.float64) for one in (x, y))
    if heights.ndim == 2 and across.shape == heights.shape[1:] and up.shape == heights.shape[:1]:
        across, up = np.meshgrid(across, up)
    if heights.ndim != 2 or across.shape != heights.shape or up.shape != heights.shape:
        grid = (*up.shape, *across.shape) if up.ndim == across.ndim == 1 else across.shape
        given = f"x, y and z of shapes {across.shape}, {up.shape}, {heights.shape}"
        raise InputError(f"surface: {given} are no grid: expected z {grid}, a row for each y")
    points = np.stack([across, up, heights], axis=-1).reshape(-1, 3)
    number = np.arange(heights.size).reshape(heights.shape)
    faces = np.stack([number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]], axis=-1).reshape(-1, 4)
    there = np.asarray(np.isfinite(points).all(axis=1), dtype=np.bool_)
    faces = faces[there[faces].all(axis=1)]
    points = np.where(there[:, None], points, 0.0)
    corners = faces.ravel()
    mesh, _ = repaired(Mesh(points, corners, np.arange(0, len(corners) + 1, 4)), COMPUTED)
    mesh, _ = without_stutter(mesh)
    if not mesh.face_count:
        raise InputError("surface: there is no face between the points")
    return Item(name, mesh, colour, lines=(*DRAWN, LineKind.EDGES.word))


def graph(
    function: Callable[..., Any],
    x: Sequence[float] = (-1.0, 1.0),
    y: Sequence[float] = (-1.0, 1.0),
    colour: str = "gray",
    name: str = "graph",
) -> Item:
    """The smooth surface z = function(x, y) above a rectangle, as an item that shows lines x = const. and y = const.

    Parameters
    ----------
    function : callable
        Takes arrays x, y (n,) and returns (n,) or one number.
    x, y : sequence of float
        From and to; of more numbers the first and the last one, the lines dividing the side into as many parts.
    colour, name : str
        Of the item.

    Returns
    -------
    Item
        A Graph with parameter lines.

    Raises
    ------
    InputError
        For an empty range, and as `surfaces.graph`.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> waves = vp.graph(lambda x, y: np.sin(x) * np.cos(y), (0, 6), np.linspace(0, 6, 31))
    >>> waves.curves.columns, waves.curves.rows
    (20, 30)
    """
    ranges = [np.asarray(one, dtype=np.float64).ravel() for one in (x, y)]
    if min(map(len, ranges)) < 2:
        raise InputError("graph: expected where x and y begin, and where they end")
    columns, rows = (DIVISIONS if len(one) == 2 else len(one) - 1 for one in ranges)
    ends = [(float(one[0]), float(one[-1])) for one in ranges]
    shape = graph_surface(function, Domain(*ends[0], *ends[1]))
    return Item(name, shape, colour, curves=SurfaceLines(columns=columns, rows=rows))


def tube(curve: Curve | ArrayLike, radius: float, colour: str = "gray", name: str = "tube") -> Item:
    """The tube about a curve, as an item.

    Parameters
    ----------
    curve : Curve or (n, 3) array_like of float
        In the middle; a smooth loop gives a ring. Of points the cubic spline through them, a loop where the last is the
        first one.
    radius : float
        In world units.
    colour, name : str
        Of the item.

    Returns
    -------
    Item
        A smooth surface with open ends, see `surfaces.tube`.

    Raises
    ------
    InputError
        For a radius that is not positive and finite, and a curve that stands still or has gaps.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.curves import Helix
    >>> spring = vp.tube(Helix(radius=3, rise=0.4, end=20), 0.5, "blue")
    >>> spring.name, spring.hides
    ('tube', True)
    """
    return Item(name, tube_surface(curve, radius), colour)

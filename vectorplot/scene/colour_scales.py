"""Colours by numbers, boxes with ticks, and the numbers that a mesh carries at vertices and faces."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_cuts import nothing_beside
from vectorplot.geometry.triangles import PlacedTriangles
from vectorplot.scene.labels import DEFAULT_SIZE_MM, capital_height
from vectorplot.words import check_colour, unknown

# What a picture shows besides its scene to be read as a chart: colours that are numbers, a box with ticks.

MOST_STEPS = 100
"""Of colours."""

BAR_LETTERS_MM = 2.5
"""The height of capitals at bars where nothing is said."""


@dataclass(frozen=True)
class Colouring:
    """The colours of all bodies by a number at every point, and the bar beside the picture that says which is which.

    Parameters
    ----------
    by : str or callable
        x, y, z (or height), slope, curvature, the name of a field of items, or a formula in x, y and z, such as "x*y";
        or by(points), which gives (n,) numbers for points (n, 3).
    colour_map : str
        viridis, heat, diverging, land or gray, or the name of one of matplotlib, if that is installed.
    steps : int
        How many colours, 2 to 100.
    label : str, optional
        At the bar: what by says where None. What stands between dollars is a formula.
    low, high : float, optional
        The numbers of the first and the last colour: the least and the largest that there are where None. What is
        beyond has the nearest of the colours.
    at : tuple of float
        Classes in place of steps: the limits between them, ascending, with the outer ones; each class has a colour.
    logarithmic : bool
        Equal ratios of numbers, which are positive then, have equal steps. What is not positive is below all.
    under, over : str, optional
        Colours of what is below low, or the first limit, and above high, or the last one.
    is_lit : bool
        Colours are shaded by the lights; otherwise they are those of the bar everywhere.
    size_mm : float or str
        Height of the capitals of the numbers at the bar, or their size of type as in "8pt"; the bar grows with them.

    Raises
    ------
    InputError
        For counts out of range, limits that do not ascend, colours that are none, and ends that are not positive
        on a logarithmic scale.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> from vectorplot.scene import Colouring
    >>> block = vp.Scene((vp.Item("block", box((3, 2, 1))),), colouring=Colouring("z", steps=12))
    >>> vp.paint(block, page="A5").width_mm
    148.0
    """

    by: str | Callable[[Floats], Floats]
    colour_map: str = "viridis"
    steps: int = 24
    label: str | None = None
    low: float | None = None
    high: float | None = None
    at: tuple[float, ...] = ()
    logarithmic: bool = False
    under: str | None = None
    over: str | None = None
    is_lit: bool = True
    size_mm: float | str = BAR_LETTERS_MM

    def __post_init__(self) -> None:
        if not (2 <= self.steps <= MOST_STEPS and float(self.steps).is_integer()):
            raise InputError(f"a colouring of {self.steps} steps: expected 2 to {MOST_STEPS}")
        object.__setattr__(self, "at", tuple(float(limit) for limit in self.at))
        if self.at and not (2 <= len(self.at) <= MOST_STEPS + 1 and all(np.diff(self.at) > 0.0)):
            raise InputError(f"classes of a colouring: expected 2 to {MOST_STEPS + 1} ascending limits, got {self.at}")
        if self.at and not (self.low is None and self.high is None):
            raise InputError("a colouring in classes has its ends in their limits")
        ends = [*self.at, *(end for end in (self.low, self.high) if end is not None)]
        if not all(np.isfinite(ends)):
            raise InputError("the ends of a colouring: expected finite numbers")
        if self.low is not None and self.high is not None and not self.low < self.high:
            raise InputError(f"a colouring from {self.low:g} to {self.high:g}: the ends do not ascend")
        if self.logarithmic and any(end <= 0.0 for end in ends):
            raise InputError("a logarithmic colouring begins above 0")
        for colour in (self.under, self.over):
            if colour is not None:
                check_colour(colour, "colouring: ")
        try:
            object.__setattr__(self, "size_mm", capital_height(self.size_mm))
        except InputError as error:
            raise InputError(f"colouring: {error.cause}") from None

    @property
    def capitals_mm(self) -> float:
        """The height of the capitals of the numbers at the bar."""
        return capital_height(self.size_mm)

    @property
    def title(self) -> str:
        """What stands above the bar."""
        if self.label is not None:
            return self.label
        return self.by if isinstance(self.by, str) else ""


@dataclass(frozen=True)
class ScaleBar:
    """A bar below the picture that is as long as a length in it; in parallel projections.

    Parameters
    ----------
    unit : str
        What stands behind the number.
    length : float, optional
        In units of the world: a round one, about a quarter of the picture, where None.
    size_mm : float or str
        Height of the capitals, or their size of type as in "8pt".

    Raises
    ------
    InputError
        For a length and a size that are not finite and positive.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.geometry import box
    >>> block = vp.Scene((vp.Item("block", box((30, 20, 10))),), scale_bar=vp.ScaleBar("nm"))
    >>> [layer.name for layer in vp.draw(block, "front").layers][-1]
    'scale bar'
    """

    unit: str = ""
    length: float | None = None
    size_mm: float | str = BAR_LETTERS_MM

    def __post_init__(self) -> None:
        if self.length is not None and not 0.0 < self.length < float("inf"):
            raise InputError(f"a scale bar of {self.length:g}: expected a length that is finite and positive")
        try:
            object.__setattr__(self, "size_mm", capital_height(self.size_mm))
        except InputError as error:
            raise InputError(f"scale bar: {error.cause}") from None

    @property
    def capitals_mm(self) -> float:
        """The height of the capitals."""
        return capital_height(self.size_mm)


@dataclass(frozen=True)
class BoxAxes:
    """A box around the scene: grids on its three far sides, numbers and names along its outer edges.

    Parameters
    ----------
    names : three str
        Of the axes.
    size_mm : float or str
        Height of the capitals of the names, or their size of type as in "10pt"; numbers have three quarters of it.

    Raises
    ------
    InputError
        For a size that is not positive, and names that are not three.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.scene import BoxAxes
    >>> from vectorplot.surfaces import Sphere
    >>> drawing = vp.draw(vp.Scene((vp.Item("ball", Sphere()),), box=BoxAxes(("a", "b", "c"))))
    >>> "box" in drawing.items[1]
    True
    """

    names: tuple[str, str, str] = ("x", "y", "z")
    size_mm: float | str = DEFAULT_SIZE_MM

    def __post_init__(self) -> None:
        if len(self.names) != 3 or not all(isinstance(name, str) for name in self.names):
            raise InputError("box: expected three names")
        try:
            object.__setattr__(self, "size_mm", capital_height(self.size_mm))
        except InputError as error:
            raise InputError(f"box: {error.cause}") from None

    @property
    def capitals_mm(self) -> float:
        """The height of the capitals of the names."""
        return capital_height(self.size_mm)


# Numbers that a file has at the vertices and on the faces of a mesh.

AXES = ("x", "y", "z")


@dataclass(frozen=True, eq=False)
class Fields:
    """Numbers at the vertices and on the faces of a mesh, by their names.

    Parameters
    ----------
    mesh : Mesh
        As the file has it; what is drawn may be repaired, cut and divided since.
    at_vertices : mapping of str to (v,) array of float
        A number for every vertex, linear in the triangles between them; NaN: none.
    on_faces : mapping of str to (f,) array of float
        A number for every face; NaN: none.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot.scene import Fields
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (4, 0, 0), (0, 4, 0)], [(0, 1, 2)])
    >>> heat = Fields(triangle, {"heat": np.array([0.0, 8.0, 0.0])})
    >>> heat.names, heat.at("heat", np.array([(0.0, 0.0, 0.0), (1.0, 1.0, 0.0)])).tolist()
    (('heat',), [0.0, 2.0])
    """

    mesh: Mesh
    at_vertices: Mapping[str, Floats]
    on_faces: Mapping[str, Floats] = field(default_factory=dict)

    @classmethod
    def of(cls, mesh: Mesh, at_vertices: Mapping[str, Any], on_faces: Mapping[str, Any]) -> Fields | None:
        """The fields of arrays by their names; None where there are none.

        Arrays (n, k) of vectors become NAME, their lengths, and NAME.x, NAME.y and NAME.z, or NAME.1 and so on. What is
        not of numbers, or not as many as there are vertices or faces, is passed over; what is infinite is NaN.
        """
        found = [_numbers(given, n) for given, n in ((at_vertices, len(mesh.vertices)), (on_faces, mesh.face_count))]
        return cls(mesh, *found) if any(found) else None

    @property
    def names(self) -> tuple[str, ...]:
        """Of all of them, those at vertices first."""
        return tuple(dict.fromkeys([*self.at_vertices, *self.on_faces]))

    def is_on_faces(self, name: str) -> bool:
        """Whether the field of this name has a number for every face; one at vertices goes before."""
        return name not in self.at_vertices

    def at(self, name: str, points: Floats) -> Floats:
        """The numbers of a field at points of the mesh.

        name: one of the names; points (n,3): on the mesh, nearly; result: (n,) NaN where there is none. Points off the
        mesh have that of a triangle above or below them, along the axis in which the mesh is thinnest; NaN where there
        is none of these.
        """
        values = self.on_faces[name] if self.is_on_faces(name) else self.at_vertices[name]
        result = np.full(len(points), np.nan)
        left = np.arange(len(points))
        if not self.is_on_faces(name) and len(self.mesh.vertices):
            from scipy.spatial import cKDTree

            far, nearest = cKDTree(self.mesh.vertices).query(points)
            same = far <= nothing_beside(self.mesh.vertices)
            result[same] = values[nearest[same]]
            left = np.flatnonzero(~same)
        place, corners, weights, face = PlacedTriangles(self.mesh).places(points[left])
        if self.is_on_faces(name):
            result[left[place]] = values[face]
        else:
            # A corner without a number that weighs nothing does not matter.
            result[left[place]] = np.where(weights > 0.0, weights * values[corners], 0.0).sum(axis=1)
        return result

    def vectors(self, name: str) -> Callable[[Floats], Floats]:
        """What gives vectors (n,3) at points (n,3) of the mesh: NAME.x, NAME.y, NAME.z, NaN where there are none.

        Errors: InputError for a name that has not these parts.
        """
        parts = [f"{name}.{axis}" for axis in AXES]
        if not all(part in self.names for part in parts):
            known = [one.removesuffix(".x") for one in self.names if one.endswith(".x")]
            raise unknown("field of vectors", name, known)
        return lambda points: np.stack([self.at(part, points) for part in parts], axis=1)

    def transformed(self, matrix: ArrayLike) -> Fields:
        """The fields on the mesh under a 4x4 matrix acting on columns: the same numbers."""
        return replace(self, mesh=self.mesh.transformed(matrix))


def _numbers(given: Mapping[str, Any], count: int) -> dict[str, Floats]:
    found: dict[str, Floats] = {}
    for name, array in given.items():
        values = np.asarray(array)
        if values.dtype.kind not in "fiub" or values.ndim not in (1, 2) or len(values) != count:
            continue
        values = np.where(np.isfinite(values), values, np.nan).astype(np.float64)
        if values.ndim == 1 or values.shape[1] == 1:
            found[str(name)] = values.reshape(-1)
            continue
        found[str(name)] = np.linalg.norm(values, axis=1)
        parts = AXES if values.shape[1] == len(AXES) else [str(k + 1) for k in range(values.shape[1])]
        found |= {f"{name}.{part}": values[:, k] for k, part in enumerate(parts)}
    return found

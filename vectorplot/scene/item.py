"""Items of a scene: shapes, how they are drawn, patterns on faces, and normals of the smooth surface behind a mesh."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Bools, Floats
from vectorplot.curves.curve import Curve
from vectorplot.geometry.algebra import determinant, inverse_matrix, matmul
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.mesh_cuts import HalfSpaces
from vectorplot.geometry.rotations import Movable
from vectorplot.geometry.triangles import PlacedTriangles
from vectorplot.geometry.vectors import norm
from vectorplot.scene.colour_scales import Fields
from vectorplot.scene.face_looks import FaceLooks
from vectorplot.scene.hatching import Hatching
from vectorplot.scene.material import Material
from vectorplot.scene.surface_lines import NO_LINES, SurfaceLines, linear_growth
from vectorplot.surfaces.placed_surface import placed_shape
from vectorplot.surfaces.surface import ImplicitSurface, Surface, is_parametrised
from vectorplot.tolerances import ZERO_OF_EXTENT
from vectorplot.words import OWN_LINE_WORDS, check_colour, line_words

if TYPE_CHECKING:
    from vectorplot.surfaces.brep import Brep
    from vectorplot.surfaces.subdivision import LimitPlaces

# The normals of the smooth surface that a mesh was made of.


@dataclass(frozen=True, eq=False)
class SurfaceNormals:
    """What a smooth surface tells of its normals, at the vertices of a mesh close to it.

    Parameters
    ----------
    mesh : Mesh
        As it was made of the surface; what is painted may be divided and cut since.
    at_vertices : (v, 3) array of float
        Unit normals; zero where the surface has none.
    on_edge : (v,) array of bool
        Those on sharp edges, with the normal of one side of them.
    places : LimitPlaces, optional
        Where its triangles lie on a limit surface of subdivision, which tells of all that is between vertices.
    bounds : (2, 3) array of float, optional
        The smallest and largest coordinates of the surface, where they are known better than by its vertices.

    Notes
    -----
    Source: Glaeser, section 8.4 (polygonised surfaces and their normals).

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot.scene import SurfaceNormals
    >>> triangle = vp.Mesh.from_triangles([(1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 1, 2)])
    >>> of_ball = SurfaceNormals(triangle, triangle.vertices, np.zeros(3, dtype=bool))
    >>> of_ball.transformed(np.diag([2.0, 1.0, 1.0, 1.0])).at_vertices[0].tolist()
    [1.0, 0.0, 0.0]
    """

    mesh: Mesh
    at_vertices: Floats
    on_edge: Bools
    places: LimitPlaces | None = None
    bounds: Floats | None = None

    def transformed(self, matrix: ArrayLike) -> SurfaceNormals:
        """The normals of the surface under a 4x4 matrix acting on columns; bounds stay known if axes stay axes."""
        linear = np.asarray(matrix, dtype=np.float64)[:3, :3]
        # The adjugate turns normals as the inverse does, and mirrors them as faces are.
        turned = matmul(self.at_vertices, inverse_matrix(linear) * abs(determinant(linear)))
        length = norm(turned)[:, None]
        turned /= np.where(length > 0.0, length, 1.0)
        places = None if self.places is None else self.places.transformed(matrix)
        bounds = None if self.bounds is None else _moved_box(self.bounds, np.asarray(matrix, dtype=np.float64))
        return SurfaceNormals(self.mesh.transformed(matrix), turned, self.on_edge, places, bounds)

    def has_faces_of(self, mesh: Mesh) -> bool:
        """Whether the faces are those of a mesh of triangles, one by one; along sharp edges they may be taken apart, so
        that each side has normals of its own."""
        own = self.mesh
        if not mesh.is_triangular or len(own.corners) != len(mesh.corners):
            return False
        return bool((own.vertices[own.corners] == mesh.vertices[mesh.corners]).all())

    @cached_property
    def triangles(self) -> PlacedTriangles:
        """The triangles of the mesh: what was divided and cut since is looked up in them, item after item."""
        return PlacedTriangles(self.mesh)


def _moved_box(bounds: Floats, matrix: Floats) -> Floats | None:
    """The box (2,3) of what fills a box, under a matrix (4,4) that takes axes to axes; None for any other matrix."""
    linear = matrix[:3, :3]
    along = np.abs(linear) > ZERO_OF_EXTENT * np.abs(linear).max()
    if (along.sum(axis=0) != 1).any() or (along.sum(axis=1) != 1).any():
        return None
    ends = matmul(bounds, np.where(along, linear, 0.0).T) + matrix[:3, 3]
    return np.array([ends.min(axis=0), ends.max(axis=0)])


@dataclass(frozen=True, eq=False)
class Pattern:
    """A coloured polygon lying on a face.

    Parameters
    ----------
    name : str
        What messages call it.
    colour : str
        The name of a palette, a plain colour or #rrggbb.
    face : int
        An index from 0.
    points : (k, 2) array of float
        In the face's own coordinates: origin at its barycentre, x along its first edge, y to the left of it.

    Raises
    ------
    InputError
        For unknown colours.

    Notes
    -----
    Source: Glaeser, section 6.5.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> window = vp.Pattern("window", "blue", 0, np.array([(-1.0, -1.0), (1.0, -1.0), (0.0, 1.0)]))
    >>> window.points.shape
    (3, 2)
    """

    name: str
    colour: str
    face: int
    points: Floats

    def __post_init__(self) -> None:
        check_colour(self.colour, f"pattern {self.name}: ")


@dataclass(frozen=True, eq=False)
class Item(Movable["Item"]):
    """A shape in the scene, and how it is drawn.

    Parameters
    ----------
    name : str
        What messages and files call it.
    shape : Mesh, Surface, ImplicitSurface, Curve or Brep
        A polyhedron, a smooth surface, a curve in space, or a body known by its faces.
    colour : str
        The name of a palette, a plain colour or #rrggbb.
    material : Material
        How its surface takes light.
    patterns : tuple of Pattern
        Coloured polygons on its faces.
    lines : tuple of str, optional
        The words of the kinds to draw (None: what the drawing asks for).
    occludes : bool, optional
        Whether it hides what is behind it (None: unless its material is transparent).
    curves : SurfaceLines
        Which lines there are on a smooth surface.
    group : str
        A name that items share which stay together in the painter's order.
    hatch : Hatching, optional
        How its faces are hatched (None: as the drawing asks for).
    place : (str, int), optional
        The file and the line, from 1, where it is described, for messages about it.
    cut_by : tuple of HalfSpaces
        What was cut away of it; its borders on them are edges of cuts.
    is_cut_face : bool
        It is what a cut shows of another item: its sections are hatches, and it meets others only where that one does.
    fields : Fields, optional
        Numbers at its vertices and on its faces, by which it can be coloured.
    normals : SurfaceNormals, optional
        Of the smooth surface that a mesh was made of: it is shaded by them.
    default_lines : tuple of str, optional
        The words of the kinds to draw where neither lines nor the drawing say any (None: those of all things).
    drawn_edges : (e, 2, 3) array of float, optional
        The ends of those edges of a polyhedron that are drawn, none of the others (None: all).
    added_edges : (e, 2, 3) array of float, optional
        The ends of segments that are drawn as creases of a polyhedron besides its edges.
    tangent_edges : (e, 2, 3) array of float, optional
        The ends of those edges of a polyhedron that are drawn as tangent edges, besides drawn_edges: the faces of the
        part that it stands for meet there without a crease.
    face_looks : FaceLooks, optional
        Colours and materials of single faces (None: all have those of the item).
    exact : Brep, optional
        The body whose triangles the polyhedron is: the verb draw takes lines from its surfaces.

    Raises
    ------
    InputError
        For unknown colours and kinds of lines.

    Examples
    --------
    >>> import vectorplot as vp
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> pane = vp.Item("pane", triangle, "cyan", vp.Material("transparent"), lines=("contour", "boundary"))
    >>> pane.hides
    False
    """

    name: str
    shape: Mesh | Surface | ImplicitSurface | Curve | Brep
    colour: str = "gray"
    material: Material = field(default_factory=Material)
    patterns: tuple[Pattern, ...] = ()
    lines: tuple[str, ...] | None = None
    occludes: bool | None = None
    curves: SurfaceLines = NO_LINES
    group: str = ""
    hatch: Hatching | None = None
    place: tuple[str, int] | None = None
    cut_by: tuple[HalfSpaces, ...] = ()
    is_cut_face: bool = False
    fields: Fields | None = None
    normals: SurfaceNormals | None = None
    default_lines: tuple[str, ...] | None = None
    drawn_edges: Floats | None = None
    added_edges: Floats | None = None
    tangent_edges: Floats | None = None
    face_looks: FaceLooks | None = None
    exact: Brep | None = None

    def __post_init__(self) -> None:
        check_colour(self.colour, f"{self.name}: ")
        if is_parametrised(self.shape):
            from vectorplot.surfaces.function_surface import completed, with_derivatives

            own = not type(self.shape).__module__.startswith("vectorplot.")
            shape = completed(self.shape, self.name) if own else with_derivatives(self.shape)
            object.__setattr__(self, "shape", shape)
        if self.lines is not None:
            object.__setattr__(self, "lines", line_words(self.lines, OWN_LINE_WORDS))
        if self.default_lines is not None:
            object.__setattr__(self, "default_lines", line_words(self.default_lines, OWN_LINE_WORDS))

    def transformed(self, matrix: ArrayLike) -> Item:
        """The item under a 4x4 matrix acting on columns, with what lies on it.

        Parameters
        ----------
        matrix : (4, 4) array_like of float
            Rows 0 to 2: rotation, scale and translation.

        Returns
        -------
        Item
            Its sections are in the moved planes; distances on it, and patterns, are larger by the cube root of what its
            volume is larger by.

        Raises
        ------
        InputError
            For a matrix that cannot be inverted.

        Examples
        --------
        >>> import vectorplot as vp
        >>> from vectorplot.surfaces import Sphere
        >>> ball = vp.Item("ball", Sphere(1.0)).scaled(2.0).moved(5.0, 0.0, 0.0)
        >>> vp.Scene((ball,)).bounds.round(9).tolist()
        [[3.0, -2.0, -2.0], [7.0, 2.0, 2.0]]
        """
        shape = placed_shape(self.shape, matrix)
        m = np.asarray(matrix, dtype=np.float64)
        larger = linear_growth(m)
        patterns = tuple(replace(one, points=larger * one.points) for one in self.patterns) if larger != 1.0 else None
        curves = self.curves.transformed(m) if self.curves else self.curves
        cut_by = tuple(region.transformed(m) for region in self.cut_by)
        patterns = self.patterns if patterns is None else patterns
        fields = None if self.fields is None else self.fields.transformed(m)
        normals = None if self.normals is None else self.normals.transformed(m)
        looks = None if self.face_looks is None else self.face_looks.transformed(m)
        exact = None
        if self.exact is not None and self.exact.mesh is self.shape and isinstance(shape, Mesh):
            exact = self.exact.transformed(m, shape)
        listed = (self.drawn_edges, self.added_edges, self.tangent_edges)
        edges, added, tangent = (None if ends is None else matmul(ends, m[:3, :3].T) + m[:3, 3] for ends in listed)
        return replace(
            self,
            shape=shape,
            curves=curves,
            patterns=patterns,
            cut_by=cut_by,
            fields=fields,
            normals=normals,
            drawn_edges=edges,
            added_edges=added,
            tangent_edges=tangent,
            face_looks=looks,
            exact=exact,
        )

    @property
    def hides(self) -> bool:
        """Whether it hides what is behind it."""
        return self.material.word != "transparent" if self.occludes is None else self.occludes

    @property
    def casts_shadow(self) -> bool:
        """Whether it stops light, as far as it has faces."""
        return self.hides and self.material.opacity >= 1.0

    @property
    def dims_light(self) -> bool:
        """Whether light goes through it, but not all of it."""
        return self.material.is_clear and self.material.opacity > 0.0

    @property
    def mesh(self) -> Mesh:
        """The polyhedron; of a smooth surface or a curve a mesh without vertices and faces."""
        return self.shape if isinstance(self.shape, Mesh) else _NO_MESH

    @property
    def surface_bounds(self) -> Floats | None:
        """(2,3) how far the surface reaches that the polyhedron stands for, where that is known; else None."""
        if self.normals is None or self.normals.bounds is None or not self.normals.has_faces_of(self.mesh):
            return None
        return self.normals.bounds


_NO_MESH = Mesh(np.zeros((0, 3)), np.zeros(0, dtype=np.intp), np.zeros(1, dtype=np.intp))

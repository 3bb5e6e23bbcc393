"""What stands in a picture: items, lights, and how one looks at them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve
from vectorplot.errors import InputError
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.cuts.half_spaces import HalfSpaces
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.motions.movable import Movable
from vectorplot.scene.cuts.cut import Cut
from vectorplot.scene.extent import in_range, smooth_bounds
from vectorplot.scene.hatching import Hatching
from vectorplot.scene.naming.labels import Label
from vectorplot.scene.naming.scales import BoxAxes, Colouring
from vectorplot.scene.surface_lines import NO_LINES, SurfaceLines, linear_growth
from vectorplot.surfaces.balls import ball_of, bounds_of_balls
from vectorplot.surfaces.capped_quadrics import bounds_of_capped_quadrics, capped_quadric_of
from vectorplot.surfaces.placed import placed_shape
from vectorplot.surfaces.surface import ImplicitSurface, Surface
from vectorplot.words import MATERIALS, OWN_LINE_WORDS, check_colour, line_words, unknown_material

OPACITY_OF_TRANSPARENT = 0.5
"""The opacity of what is transparent where nothing else is said."""


@dataclass(frozen=True, init=False)
class Material:
    """How a surface takes light.

    Parameters
    ----------
    word : str
        normal, metallic, shiny (or reflecting), mat (or matte), wood, plastic, transparent or mirror.
    opacity : float, optional
        0 (clear) to 1; that of what is transparent a half where none is given, else 1.
    refraction : float
        The constant sin(alpha)/sin(beta) of Snell's law, positive.

    Raises
    ------
    InputError
        For other words and numbers out of range.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Material("transparent")
    Material(word='transparent', opacity=0.5, refraction=1.0)
    >>> vp.Material("reflecting").word
    'shiny'
    """

    word: str
    opacity: float
    refraction: float

    def __init__(self, word: str = "normal", opacity: float | None = None, refraction: float = 1.0) -> None:
        if word not in MATERIALS:
            raise unknown_material(word)
        if opacity is None:
            opacity = OPACITY_OF_TRANSPARENT if word == "transparent" else 1.0
        if not 0.0 <= opacity <= 1.0:
            raise InputError(f"material {word}: an opacity of {opacity:g}: expected 0 to 1")
        if not 0.0 < refraction < np.inf:
            raise InputError(f"material {word}: a refraction of {refraction:g}: expected a positive, finite number")
        object.__setattr__(self, "word", MATERIALS[word])
        object.__setattr__(self, "opacity", float(opacity))
        object.__setattr__(self, "refraction", float(refraction))

    @property
    def is_mirror(self) -> bool:
        """Whether one sees other things in it."""
        return self.word == "mirror"

    @property
    def is_clear(self) -> bool:
        """Whether one sees through it."""
        return self.word == "transparent" or self.opacity < 1.0


@dataclass(frozen=True)
class Light:
    """A light source at a point, or with parallel rays coming from the direction ``position``.

    Parameters
    ----------
    position : (float, float, float)
        The point in world coordinates, or the direction that parallel rays come from.
    parallel : bool
        Whether its rays are parallel.
    intensity : float, optional
        0 to 1 (None: 1 / sqrt(l) in a scene with l lights).
    name : str
        What messages call it.
    colour : str
        white, a palette or #rrggbb.
    fading : bool
        The light of a lamp becomes weaker with the square of the distance.

    Raises
    ------
    InputError
        For unknown colours and intensities out of range.

    Examples
    --------
    >>> import vectorplot as vp
    >>> sun = vp.Light((1, -1, 2), parallel=True, intensity=0.8, name="SUN")
    >>> sun.colour
    'white'
    """

    position: tuple[float, float, float]
    parallel: bool = False
    intensity: float | None = None
    name: str = ""
    colour: str = "white"
    fading: bool = False

    def __post_init__(self) -> None:
        check_colour(self.colour, f"light {self.name}: " if self.name else "light: ")
        if self.intensity is not None and not 0.0 <= self.intensity <= 1.0:
            raise InputError(f"light {self.name}: an intensity of {self.intensity:g}: expected 0 to 1")


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
    shape : Mesh, Surface, ImplicitSurface or Curve
        A polyhedron, a smooth surface or a curve in space.
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
    shape: Mesh | Surface | ImplicitSurface | Curve
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

    def __post_init__(self) -> None:
        check_colour(self.colour, f"{self.name}: ")
        if self.lines is not None:
            object.__setattr__(self, "lines", line_words(self.lines, OWN_LINE_WORDS))

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
        return replace(self, shape=shape, curves=curves, patterns=patterns, cut_by=cut_by)

    @property
    def hides(self) -> bool:
        """Whether it hides what is behind it."""
        return self.material.word != "transparent" if self.occludes is None else self.occludes

    @property
    def mesh(self) -> Mesh:
        """The polyhedron; of a smooth surface or a curve a mesh without vertices and faces."""
        return self.shape if isinstance(self.shape, Mesh) else _NO_MESH


_NO_MESH = Mesh(np.zeros((0, 3)), np.zeros(0, dtype=np.intp), np.zeros(1, dtype=np.intp))


@dataclass(frozen=True)
class Page:
    """The sheet of paper, in mm.

    Parameters
    ----------
    width_mm, height_mm : float
        The sides; A4 where nothing is said.
    margin_mm : float
        What stays empty along every side.

    Raises
    ------
    InputError
        For sides that are not finite and positive, a margin that is not finite or negative, and one that leaves nothing
        of the page.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.Page().landscape
    Page(width_mm=297.0, height_mm=210.0, margin_mm=10.0)
    """

    width_mm: float = 210.0
    height_mm: float = 297.0
    margin_mm: float = 10.0

    def __post_init__(self) -> None:
        sizes = (self.width_mm, self.height_mm, self.margin_mm)
        if not all(np.isfinite(sizes)) or min(self.width_mm, self.height_mm) <= 0.0 or self.margin_mm < 0.0:
            raise InputError(f"page {self.width_mm:g}x{self.height_mm:g} mm, margin {self.margin_mm:g} mm: not a page")
        if 2.0 * self.margin_mm >= min(self.width_mm, self.height_mm):
            raise InputError(f"a margin of {self.margin_mm:g} mm leaves nothing of the page")

    @property
    def room(self) -> tuple[float, float]:
        """Width and height in mm of what is inside the margin."""
        return self.width_mm - 2.0 * self.margin_mm, self.height_mm - 2.0 * self.margin_mm

    def around(self, width_mm: float, height_mm: float) -> Page:
        """The sheet that a picture of some size comes on: this one, however small the picture.

        Parameters
        ----------
        width_mm, height_mm : float
            The sides of the picture, without the margin around it.

        Returns
        -------
        Page
            The sheet; pages that fit their pictures are cut to them.

        Raises
        ------
        InputError
            Where the sheet is to be cut, for sides that are not finite.

        Examples
        --------
        >>> import vectorplot as vp
        >>> vp.Page(100, 80).around(20, 30)
        Page(width_mm=100, height_mm=80, margin_mm=10.0)
        """
        return self

    @property
    def landscape(self) -> Page:
        """The same sheet lying on its longer side."""
        long, short = max(self.width_mm, self.height_mm), min(self.width_mm, self.height_mm)
        return Page(long, short, self.margin_mm)


@dataclass(frozen=True, eq=False)
class Scene(Movable["Scene"]):
    """Items in the order of the file, lights, and what the file says about camera, page and background.

    Parameters
    ----------
    items : tuple of Item
        In the order of the file.
    lights : tuple of Light
        The lights in the scene.
    camera : Camera, optional
        What the file says about it (None: nothing).
    page : Page, optional
        What the file says about it (None: nothing).
    background : str, optional
        The colour that the file names (None: none).
    title : str
        What the scene is called.
    labels : tuple of Label
        Names in the picture.
    colouring : Colouring, optional
        Colours of all bodies by a number, and the bar that explains them.
    box : BoxAxes, optional
        A box with ticks around all items.
    cuts : tuple of Cut
        What is cut away where the scene is drawn, painted or rendered.

    Raises
    ------
    InputError
        For an unknown background.

    Examples
    --------
    >>> import vectorplot as vp
    >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
    >>> scene = vp.Scene((vp.Item("triangle", triangle),), title="A triangle")
    >>> scene
    <Scene 'A triangle': 1 items, 0 lights>
    >>> scene.bounds.tolist()
    [[0.0, 0.0, 0.0], [1.0, 1.0, 0.0]]
    """

    items: tuple[Item, ...]
    lights: tuple[Light, ...] = ()
    camera: Camera | None = None
    page: Page | None = None
    background: str | None = None
    title: str = ""
    labels: tuple[Label, ...] = ()
    colouring: Colouring | None = None
    box: BoxAxes | None = None
    cuts: tuple[Cut, ...] = ()

    def __post_init__(self) -> None:
        if self.background is not None:
            check_colour(self.background, "background: ")

    def __len__(self) -> int:
        return len(self.items)

    def transformed(self, matrix: ArrayLike) -> Scene:
        """The scene with its items, labels and cuts under a 4x4 matrix acting on columns; lights, camera and page stay.

        Parameters
        ----------
        matrix : (4, 4) array_like of float
            Rows 0 to 2: rotation, scale and translation.

        Returns
        -------
        Scene
            With all items moved.

        Raises
        ------
        InputError
            For a matrix that cannot be inverted.

        Examples
        --------
        >>> import vectorplot as vp
        >>> triangle = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)])
        >>> vp.Scene((vp.Item("triangle", triangle),)).turned("x", 90).bounds.tolist()
        [[0.0, 0.0, 0.0], [1.0, 0.0, 1.0]]
        """
        labels = tuple(label.transformed(matrix) for label in self.labels)
        cuts = tuple(cut.transformed(matrix) for cut in self.cuts)
        return replace(self, items=tuple(item.transformed(matrix) for item in self.items), labels=labels, cuts=cuts)

    def __repr__(self) -> str:
        return f"<Scene {self.title!r}: {len(self.items)} items, {len(self.lights)} lights>"

    @cached_property
    def vertices(self) -> Floats:
        """(v,3) the vertices of all polyhedra, one item after the other."""
        shapes = [item.mesh.vertices for item in self.items]
        return shapes[0] if len(shapes) == 1 else np.concatenate([np.zeros((0, 3)), *shapes])

    @cached_property
    def bounds(self) -> Floats:
        """(2,3) smallest and largest coordinates over all items; zeros for an empty scene.

        Errors: InputError, with the item's name, for a surface without a finite point.
        """
        smooth = [(item.name, item.shape) for item in self.items if not isinstance(item.shape, Mesh)]
        balls = [ball_of(shape) for _, shape in smooth]
        bodies = [capped_quadric_of(shape) for _, shape in smooth]
        many = bounds_of_balls([ball for ball in balls if ball]), bounds_of_capped_quadrics([b for b in bodies if b])
        boxes = np.concatenate(many)
        if in_range(boxes).all():
            known = zip(smooth, balls, bodies, strict=True)
            smooth = [named for named, ball, body in known if ball is None and body is None]
        others = (_bounds(name, shape) for name, shape in smooth)
        corners = np.concatenate([self.vertices, boxes.reshape(-1, 3), *others])
        if not len(corners):
            return np.zeros((2, 3))
        return np.array([corners.min(axis=0), corners.max(axis=0)])


def _bounds(name: str, shape: Surface | ImplicitSurface | Curve) -> Floats:
    try:
        return smooth_bounds(shape)
    except InputError as error:
        raise InputError(f"{name}: {error.cause}") from None

"""What stands in a picture: items, lights, and how one looks at them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve
from vectorplot.errors import InputError
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.motions.movable import Movable
from vectorplot.scene.cuts.cut import Cut
from vectorplot.scene.cuts.explosion import Explosion
from vectorplot.scene.depth_cue import DepthCue
from vectorplot.scene.extent import bounds_of_surfaces, in_range, smooth_bounds
from vectorplot.scene.item import Item
from vectorplot.scene.light import Exposure, Light, check_exposure
from vectorplot.scene.naming.labels import Label
from vectorplot.scene.naming.scales import BoxAxes, Colouring
from vectorplot.scene.pages.inks import Inks
from vectorplot.scene.pages.page import Page
from vectorplot.surfaces.quadric_bodies.balls import ball_of, bounds_of_balls
from vectorplot.surfaces.quadric_bodies.capped_quadrics import bounds_of_capped_quadrics, capped_quadric_of
from vectorplot.surfaces.surface import ImplicitSurface, Surface, is_parametrised
from vectorplot.words import check_colour


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
    exposure : float or {"fitted"}
        What the intensities of all lights are taken times; fitted: so that the brightest face is as bright as a light
        can make it.
    depth_cue : DepthCue, optional
        How lines tell how far away they are (None: not at all).
    inks : Inks, optional
        The style, the pens and the dashes that the scene is drawn with.
    explosion : Explosion, optional
        Parts are moved apart where the scene is shown, before it is cut.
    exaggeration : float
        What heights in it were multiplied with: those that pictures write, on level lines, beside boxes and colour
        bars, are divided by it. Scene files say nothing of it.

    Raises
    ------
    InputError
        For an unknown background.
    TypeError
        For what is no tuple of items.

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
    exposure: Exposure = 1.0
    depth_cue: DepthCue | None = None
    inks: Inks | None = None
    explosion: Explosion | None = None
    exaggeration: float = 1.0

    def __post_init__(self) -> None:
        # The first one tells: a scene may have a million items, and is made anew by every stage.
        if not isinstance(self.items, tuple | list) or not all(isinstance(item, Item) for item in self.items[:1]):
            given = self.items[0] if isinstance(self.items, tuple | list) else self.items
            kind = type(given).__name__
            raise TypeError(f"a scene is made of Items, as vp.Scene((vp.Item('part', shape),)), not of a {kind}")
        if self.background is not None:
            check_colour(self.background, "background: ")
        check_exposure(self.exposure)

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
        items = tuple(item.transformed(matrix) for item in self.items)
        apart = None if self.explosion is None else self.explosion.transformed(matrix)
        return replace(self, items=items, labels=labels, cuts=cuts, explosion=apart)

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
        corners = np.concatenate([self.vertices, boxes.reshape(-1, 3), _bounds(smooth).reshape(-1, 3)])
        if not len(corners):
            return np.zeros((2, 3))
        return np.array([corners.min(axis=0), corners.max(axis=0)])


def _bounds(named: Sequence[tuple[str, Surface | ImplicitSurface | Curve]]) -> Floats:
    """(n,2,3) the bounds of smooth shapes with their names; those of parametrised surfaces found together."""
    surfaces = [shape for _, shape in named if is_parametrised(shape)]
    alone = [(name, shape) for name, shape in named if not is_parametrised(shape)]
    together = [np.zeros((0, 2, 3))]
    try:
        together.append(bounds_of_surfaces(surfaces))
    except InputError:
        # One by one they tell which.
        alone = list(named)
    return np.concatenate([*together, *(_bounds_of_one(name, shape)[None] for name, shape in alone)])


def _bounds_of_one(name: str, shape: Surface | ImplicitSurface | Curve) -> Floats:
    try:
        return smooth_bounds(shape)
    except InputError as error:
        raise InputError(f"{name}: {error.cause}") from None

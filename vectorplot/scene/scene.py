"""The value Scene: items, lights, how one looks at them; scenes put together, and surfaces cut off or empty."""

from __future__ import annotations

import warnings
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.rotations import Movable
from vectorplot.scene.colour_scales import BoxAxes, Colouring, ScaleBar
from vectorplot.scene.cuts import Cut, Explosion
from vectorplot.scene.extent import bounds_of_surfaces, in_range, smooth_bounds
from vectorplot.scene.item import Item
from vectorplot.scene.labels import Label, Measures, renamed
from vectorplot.scene.light import Exposure, Light, check_exposure
from vectorplot.scene.page import Page, SheetSettings
from vectorplot.scene.pens import DepthCue, PenOverrides
from vectorplot.surfaces.capped_bodies import ball_of, bounds_of_balls, bounds_of_capped_quadrics, capped_quadric_of
from vectorplot.surfaces.surface import ImplicitSurface, Surface, is_implicit, is_parametrised
from vectorplot.words import check_colour

if TYPE_CHECKING:
    from vectorplot.surfaces.brep import Brep

# What stands in a picture: items, lights, and how one looks at them.


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
    inks : PenOverrides, optional
        The style, the pens and the dashes that the scene is drawn with.
    explosion : Explosion, optional
        Parts are moved apart where the scene is shown, before it is cut.
    measures : Measures, optional
        How the measures of dimensions are written (None: with six digits).
    exaggeration : float
        What heights in it were multiplied with: those that pictures write, on level lines, beside boxes and colour
        bars, are divided by it. Of scene files it is that of their terrains.
    scale_bar : ScaleBar, optional
        A bar below the picture that is as long as a length in it.
    sheet : SheetSettings, optional
        What its technical sheet is like, where nothing else is asked for.

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
    inks: PenOverrides | None = None
    explosion: Explosion | None = None
    measures: Measures | None = None
    exaggeration: float = 1.0
    scale_bar: ScaleBar | None = None
    sheet: SheetSettings | None = None

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
        """(2,3) smallest and largest coordinates over all items; zeros for an empty scene. Parts of CAD systems reach
        as far as their surfaces do, and not only their triangles.

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
        told = [box for item in self.items if (box := item.surface_bounds) is not None]
        corners = np.concatenate([self.vertices, boxes.reshape(-1, 3), _bounds(smooth).reshape(-1, 3), *told])
        if not len(corners):
            return np.zeros((2, 3))
        return np.array([corners.min(axis=0), corners.max(axis=0)])


def _bounds(named: Sequence[tuple[str, Surface | ImplicitSurface | Curve | Brep]]) -> Floats:
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


def _bounds_of_one(name: str, shape: Surface | ImplicitSurface | Curve | Brep) -> Floats:
    try:
        return smooth_bounds(shape)
    except InputError as error:
        raise InputError(f"{name}: {error.cause}") from None


# Several scenes as one, whose items have names of their own.


def renamed_labels(scene: Scene, items: Sequence[Item]) -> tuple[Label, ...]:
    """The labels of a scene whose items have other names now."""
    names = {old.name: new.name for old, new in zip(reversed(scene.items), reversed(items), strict=True)}
    return tuple(renamed(label, names) for label in scene.labels)


def renamed_cuts(scene: Scene, items: Sequence[Item]) -> tuple[Cut, ...]:
    """The cuts of a scene whose items have other names now: each goes through these items alone."""
    named = [[new.name for old, new in zip(scene.items, items, strict=True) if c.is_for(old.name)] for c in scene.cuts]
    return tuple(replace(cut, items=tuple(names)) for cut, names in zip(scene.cuts, named, strict=True))


def together(scenes: Sequence[Scene]) -> Scene:
    """All items and lights; cuts go through the items of their own scenes; what there can be only one of is that of the
    first scene that has it."""
    if len(scenes) == 1:
        return scenes[0]
    items = _told_apart([item for scene in scenes for item in scene.items])
    ends = np.cumsum([len(scene) for scene in scenes]).tolist()
    parts = list(zip(scenes, ends, strict=True))
    return Scene(
        items,
        tuple(light for scene in scenes for light in scene.lights),
        next((scene.camera for scene in scenes if scene.camera), None),
        next((scene.page for scene in scenes if scene.page), None),
        next((scene.background for scene in scenes if scene.background), None),
        next((scene.title for scene in scenes if scene.title), ""),
        tuple(chain(*(renamed_labels(scene, items[end - len(scene) : end]) for scene, end in parts))),
        next((scene.colouring for scene in scenes if scene.colouring), None),
        next((scene.box for scene in scenes if scene.box), None),
        cuts=tuple(chain(*(renamed_cuts(scene, items[end - len(scene) : end]) for scene, end in parts))),
        exposure=next((scene.exposure for scene in scenes if scene.exposure != 1.0), 1.0),
        depth_cue=next((scene.depth_cue for scene in scenes if scene.depth_cue), None),
        inks=next((_inks(scene, items[end - len(scene) : end]) for scene, end in parts if scene.inks), None),
        explosion=next((scene.explosion for scene in scenes if scene.explosion), None),
        measures=next((scene.measures for scene in scenes if scene.measures), None),
        exaggeration=next((scene.exaggeration for scene in scenes if scene.exaggeration != 1.0), 1.0),
        scale_bar=next((scene.scale_bar for scene in scenes if scene.scale_bar), None),
        sheet=next((scene.sheet for scene in scenes if scene.sheet), None),
    )


def _inks(scene: Scene, items: Sequence[Item]) -> PenOverrides | None:
    """The pens of a scene whose items have other names now."""
    names = {old.name: new.name for old, new in zip(reversed(scene.items), reversed(items), strict=True)}
    return None if scene.inks is None else scene.inks.renamed(names)


def _told_apart(items: Sequence[Item]) -> tuple[Item, ...]:
    """The items, those whose names came before with numbers behind them."""
    count: Counter[str] = Counter()
    taken = {item.name for item in items}
    result = []
    for item in items:
        count[item.name] += 1
        name = item.name
        if count[item.name] > 1:
            number = count[item.name]
            while f"{item.name} {number}" in taken:
                number += 1
            count[item.name], name = number, f"{item.name} {number}"
            taken.add(name)
        result.append(item if name == item.name else replace(item, name=name))
    return tuple(result)


# Items whose surfaces run to infinity, or are empty: what is shown of them ends somewhere, or is nothing.


def tell_what_is_cut_off(scene: Scene) -> None:
    """An InputWarning, with the name of the item, for every surface that is cut off because it runs to infinity."""
    for item in scene.items:
        if not isinstance(item.shape, Mesh) and (text := _cut_off(item.shape)):
            warnings.warn(f"{item.name}: {text}", InputWarning, stacklevel=3)


def tell_of_empty_surface(item: Item, stacklevel: int) -> None:
    """An InputWarning, with its name, for an implicit surface of which no triangles were found, unless it is cut."""
    if is_implicit(item.shape) and not item.cut_by:
        text = f"{item.name}: the surface has no points in its box: nothing of it is shown"
        warnings.warn(text, InputWarning, stacklevel=stacklevel)


def _cut_off(shape: Any) -> str:
    """Where a surface is cut off, in its own coordinates; nothing where it is not."""
    from vectorplot.surfaces.function_surface import FunctionSurface
    from vectorplot.surfaces.graphs import Graph, PolarGraph

    while not isinstance(shape, Graph | PolarGraph | FunctionSurface) and hasattr(shape, "surface"):
        shape = shape.surface
    if isinstance(shape, PolarGraph):
        shape = shape.plane
    if not isinstance(shape, Graph | FunctionSurface):
        return ""
    function, names = (shape.heights, "z") if isinstance(shape, Graph) else (shape.function, "xyz")
    if function.limits is None:
        return ""
    ranges = [
        f"{name} from {low:.4g} to {high:.4g}"
        for name, low, high in zip(names, *function.limits, strict=True)
        if np.isfinite(low)
    ]
    return f"runs to infinity: shown is {', '.join(ranges)}"

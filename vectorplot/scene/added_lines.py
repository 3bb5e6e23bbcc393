"""Lines that are added to scenes: sections, level lines, isophotes, their lights, and the lines drawn by default."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import is_curve
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.rotations import axis_frame
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import (
    DEFAULT_COUNT,
    DEFAULT_EVERY,
    MAX_LINES,
    Section,
    SurfaceLines,
    Vector,
    round_heights,
    with_index_lines,
)
from vectorplot.scene.view import View
from vectorplot.tolerances import ROUNDING, ZERO_OF_EXTENT

# Lines that are added to whatever a scene holds: plane sections and level lines through the whole of it, isophotes.


def with_lines(
    scene: Scene,
    *,
    sections: Sequence[Section] = (),
    isophotes: Sequence[float] = (),
    detail: float = 1.0,
    smooth_contours: bool = False,
) -> Scene:
    """The scene with further lines on all its polyhedra and surfaces, beside those that they ask for.

    Parameters
    ----------
    scene : Scene
        Its curves stay as they are.
    sections : sequence of Section
        Planes in world coordinates, such as `even_sections` and `round_sections` give.
    isophotes : sequence of float
        Cosines of the angle between normal and light, such as `even_cosines` gives.
    detail : float
        How many times the detail that items ask for there is of suggestive contours, ridges, valleys and apparent
        ridges.
    smooth_contours : bool
        All polyhedra are taken for smooth shapes, with contours across their faces.

    Returns
    -------
    Scene
        Of items that say which kinds of lines they have, with these kinds too.

    Raises
    ------
    InputError
        For more than 10000 planes in all, and as in SurfaceLines.

    Warns
    -----
    InputWarning
        Where all planes of a direction are beside the scene.

    Notes
    -----
    Edge cases: planes and angles that are given several times count once.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene
    >>> box = vp.Scene((vp.Item("box", geometry.box((1, 1, 3))),))
    >>> lined = scene.with_lines(box, sections=(scene.even_sections(box, (0, 0, 1), 5),))
    >>> lined.items[0].curves.sections[0].offsets
    (0.5, 1.0, 1.5, 2.0, 2.5)
    """
    planes = sum(len(section.offsets) for section in sections)
    if planes > MAX_LINES:
        raise InputError(f"sections: {planes} of them, expected at most {MAX_LINES}")
    added = SurfaceLines(sections=tuple(sections), isophotes=tuple(isophotes), detail=detail)
    added = replace(added, smooth_contours=smooth_contours)
    if not added and detail == 1.0 and not smooth_contours:
        return scene
    for normal in dict.fromkeys(section.normal for section in sections if section.offsets and _surfaces(scene).items):
        low, high = _extent_along(_surfaces(scene), normal)
        ours = [section for section in sections if section.normal == normal]
        if not any(low <= offset <= high for section in ours for offset in section.offsets):
            times = heights_times(scene, ours[0])
            reach = f"it reaches from {low / times:.6g} to {high / times:.6g} along their normal"
            warnings.warn(f"sections: all planes are beside the scene: {reach}", InputWarning, stacklevel=2)
    return replace(scene, items=tuple(item if is_curve(item.shape) else _with(item, added) for item in scene.items))


def without_level_lines(scene: Scene, normal: Vector = (0.0, 0.0, 1.0)) -> Scene:
    """The scene without the level lines that its items ask for, for others in their place.

    normal: (float, float, float) what heights are measured along, of any length but zero.
    """
    up = Section(normal, ()).normal
    return replace(scene, items=tuple(_without_levels(item, up) for item in scene.items))


def with_numbers(scene: Scene) -> Scene:
    """A scene with numbers on its index lines; where no item has any, on all sections but those between slices."""
    sections = [section for item in scene.items for section in item.curves.sections]
    index = any(section.index for section in sections)

    def numbered(item: Item) -> Item:
        own = tuple(
            replace(section, numbered=section.numbered or section.index or not (index or section.slices))
            for section in item.curves.sections
        )
        return replace(item, curves=replace(item.curves, sections=own))

    return replace(scene, items=tuple(map(numbered, scene.items)))


def _without_levels(item: Item, up: Vector) -> Item:
    ways = (up, (-up[0], -up[1], -up[2]))
    levels = [section for section in item.curves.sections if section.normal in ways and not section.slices]
    if not any(section.index for section in levels):
        return item
    kept = tuple(section for section in item.curves.sections if section not in levels)
    return replace(item, curves=replace(item.curves, sections=kept))


def _with(item: Item, added: SurfaceLines) -> Item:
    own = item.curves
    reaching = tuple(one for section in added.sections if (one := _reaching(section, item)).offsets)
    sections, isophotes = (*own.sections, *reaching), (*own.isophotes, *added.isophotes)
    kinds = line_kinds(added)
    lines, usual = (
        None if words is None else tuple(dict.fromkeys((*words, *kinds))) for words in (item.lines, item.default_lines)
    )
    smooth = own.smooth_contours or added.smooth_contours
    detail = own.detail * added.detail
    curves = replace(own, sections=sections, isophotes=isophotes, detail=detail, smooth_contours=smooth)
    return replace(item, curves=curves, lines=lines, default_lines=usual)


def _reaching(section: Section, item: Item) -> Section:
    """Those planes of a section that an item is not beside: smooth surfaces are searched for every one."""
    low, high = _extent_along(Scene((item,)), section.normal)
    return replace(section, offsets=tuple(offset for offset in section.offsets if low <= offset <= high))


def line_kinds(lines: SurfaceLines) -> tuple[str, ...]:
    """The words of the kinds that sections and isophotes are of."""
    isophote = (*(["isophote"] if lines.isophotes else []), *(["section"] if lines.contours else []))
    return tuple(dict.fromkeys((*isophote, *(section.kind.word for section in lines.sections if section.offsets))))


def even_sections(scene: Scene, normal: Vector, count: int) -> Section:
    """Parallel planes that divide the extent of a whole scene evenly.

    Parameters
    ----------
    scene : Scene
        Its polyhedra and surfaces count, its curves do not.
    normal : (float, float, float)
        Of the planes, of any length but zero.
    count : int
        How many, 1 to 10000.

    Returns
    -------
    Section
        From item to item the same planes.

    Raises
    ------
    InputError
        For counts below 1 or above 10000, a normal without length, and for a scene without extent along it.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene
    >>> box = vp.Scene((vp.Item("box", geometry.box((1, 1, 3))),))
    >>> scene.even_sections(box, (0, 0, 1), 2)
    Section(normal=(0.0, 0.0, 1.0), offsets=(1.0, 2.0), slices=False, index=False)
    """
    if not 1 <= count <= MAX_LINES:
        raise InputError(f"sections: {count} of them, expected 1 to {MAX_LINES}")
    section = Section(normal, ())
    solid = _surfaces(scene)
    low, high = _extent_along(solid, section.normal)
    if not high - low > least_extent(solid.bounds, low, high):
        raise InputError("sections: the scene has no extent along their normal")
    return replace(section, offsets=evenly_between(low, high, count))


def round_sections(
    scene: Scene, normal: Vector = (0.0, 0.0, 1.0), count: int = DEFAULT_COUNT, every: int = DEFAULT_EVERY
) -> tuple[Section, ...]:
    """Level lines at round heights through a whole scene, every k-th an index line.

    Parameters
    ----------
    scene : Scene
        Its polyhedra and surfaces count, its curves do not.
    normal : (float, float, float)
        What heights are measured along, of any length but zero.
    count : int
        About how many, 1 to 10000: the step is 1, 2 or 5 times a power of ten.
    every : int
        k; 0 for no index lines.

    Returns
    -------
    tuple of Section
        The index lines, and the others.

    Raises
    ------
    InputError
        See `round_heights` and `level_sections`, and for a scene without extent along the normal.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, scene
    >>> box = vp.Scene((vp.Item("box", geometry.box((1, 1, 3))),))
    >>> index, others = scene.round_sections(box, count=6)
    >>> index.offsets, others.offsets
    ((2.5,), (0.5, 1.0, 1.5, 2.0))
    """
    if not 1 <= count <= MAX_LINES:
        raise InputError(f"level lines: {count} of them, expected 1 to {MAX_LINES}")
    section = Section(normal, ())
    solid = _surfaces(scene)
    low, high = _extent_along(solid, section.normal)
    if not high - low > least_extent(solid.bounds, low, high):
        raise InputError("level lines: the scene has no extent along their normal")
    times = heights_times(scene, section)
    heights = round_heights(low / times, high / times, count)
    return with_index_lines(replace(section, offsets=tuple(times * height for height in heights)), every)


def heights_times(scene: Scene, section: Section) -> float:
    """What heights along the normal of a section were multiplied with in a scene."""
    return scene.exaggeration if abs(section.normal[2]) == 1.0 else 1.0


def evenly_between(low: float, high: float, count: int) -> tuple[float, ...]:
    """So many heights that divide what is between two heights evenly."""
    return tuple(low + (high - low) * k / (count + 1) for k in range(1, count + 1))


def least_extent(bounds: Floats, low: float, high: float) -> float:
    """Heights within bounds (2,3) that differ by no more than this are the same by rounding."""
    return max(ZERO_OF_EXTENT * float(np.ptp(bounds, axis=0).max()), ROUNDING * max(abs(low), abs(high)))


def _surfaces(scene: Scene) -> Scene:
    """The items that planes cut in lines."""
    return Scene(tuple(item for item in scene.items if not is_curve(item.shape)))


def _extent_along(scene: Scene, normal: Vector) -> tuple[float, float]:
    """The lowest and the highest point along a unit normal."""
    if np.count_nonzero(normal) == 1:
        heights = matmul(scene.bounds, np.array(normal))
    else:
        turn = np.eye(4)
        turn[:3, :3] = axis_frame(normal)
        heights = scene.transformed(turn).bounds[:, 2]
    return float(heights.min()), float(heights.max())


# The light that the isophotes of an item are of.

UPPER_LEFT = (-1.0, 1.0, 1.0)
"""The light of a scene without one: from the eye's upper left, in the axes of the view."""


def curve_light(scene: Scene, view: View, item: Item) -> Light:
    """The light that an item names, else the first one of the scene, else one from the eye's upper left.

    Errors: InputError, with the item's name, for a light that the scene does not have.
    """
    number = item.curves.light
    if not scene.lights and number is None:
        return default_light(view)
    if (number or 0) >= len(scene.lights):
        raise InputError(f"{item.name}: isophotes of light {number}: the scene has {len(scene.lights)} lights")
    return scene.lights[number or 0]


def lamps_of(scene: Scene, view: View) -> tuple[Light, ...]:
    """The lights of a scene that shine, or where it has none one from the eye's upper left."""
    return shining(scene.lights) if scene.lights else (default_light(view),)


def shining(lights: Sequence[Light]) -> tuple[Light, ...]:
    """Those of some lights that are not out."""
    return tuple(light for light in lights if light.intensity != 0.0)


def default_light(view: View) -> Light:
    """The light of a scene that has none: from the eye's upper left."""
    x, y, z = (matmul(view.axes.T, np.array(UPPER_LEFT))).tolist()
    return Light((x, y, z), parallel=True)


# What is drawn of things where nobody asks for kinds of lines.


def with_default_lines(scene: Scene) -> Scene:
    """The scene with the lines that are usual for its items as their own, where they have none of their own."""
    if all(item.default_lines is None for item in scene.items):
        return scene
    return replace(scene, items=tuple(map(_with_own_default, scene.items)))


def _with_own_default(item: Item) -> Item:
    return replace(item, lines=item.default_lines) if item.lines is None else item

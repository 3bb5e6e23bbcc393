"""Terrains as scenes: heights of level lines, the lines that are drawn, colours by height, the light of maps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from math import cos, radians, sin

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.curves.curve import number
from vectorplot.errors import InputError
from vectorplot.features.grid_triangulation import mesh_of_grid
from vectorplot.geometry.mesh import TRIANGLE, Mesh
from vectorplot.geometry.mesh_cuts import level_bands
from vectorplot.scene.extent import check_range
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import (
    DEFAULT_EVERY,
    NO_LINES,
    Section,
    SurfaceLines,
    round_heights,
    with_index_lines,
)
from vectorplot.surfaces.terrains import Terrain, exaggerated, terrain

# Heights of level lines: round ones, and every fifth of them heavier.


UP = (0.0, 0.0, 1.0)


def level_sections(heights: Sequence[float], every: int = DEFAULT_EVERY) -> tuple[Section, ...]:
    """Level lines, with every k-th of them an index line: of a kind of its own, and heavier.

    Parameters
    ----------
    heights : (n,) sequence of float
        In world units.
    every : int
        k; 0 for no index lines.

    Returns
    -------
    tuple of Section
        For the sections of SurfaceLines: the index lines, and the others.

    Raises
    ------
    InputError
        For a number below 0, and as in Section.

    Notes
    -----
    Index lines are those whose heights are multiples of k steps, where the heights are multiples of one step; else
    every k-th from the k-th one on.

    Examples
    --------
    >>> from vectorplot import scene
    >>> index, others = scene.level_sections([90, 100, 110, 120, 130, 140, 150, 160], every=5)
    >>> index.offsets, len(others.offsets)
    ((100.0, 150.0), 6)
    """
    return with_index_lines(Section(UP, tuple(heights)), every)


# What is drawn for a terrain: its outlines, its borders and its level lines.

TERRAIN_LINES = ("contour", "boundary", "section", "index")
"""What is drawn of a terrain: its edges are none of its own."""

MOST_DRAWN = 1 << 19
"""Heights of a terrain of which a mesh is made, at most: about a million triangles."""


def terrain_mesh(given: Terrain) -> Mesh:
    """The triangles over the cells of a terrain.

    Parameters
    ----------
    given : Terrain
        Triangles with a corner in a hole are not there: holes have borders.

    Returns
    -------
    Mesh
        Two triangles a cell, cut along the diagonal that suits the neighbourhood better; seen from above
        counter-clockwise.

    Raises
    ------
    InputError
        For more than 2^19 heights (see `thinned_terrain`), where holes leave no triangle, and for sizes out of range.

    Notes
    -----
    Source: Glaeser, sections 8.4 and 9.5, example 1.

    Examples
    --------
    >>> from vectorplot import scene, surfaces
    >>> scene.terrain_mesh(surfaces.terrain([[0, 1, 0], [1, 3, 1], [0, 1, 0]])).face_count
    8
    """
    if given.heights.size > MOST_DRAWN:
        m, n = given.heights.shape
        raise InputError(f"terrain: {m} by {n} heights, expected at most {MOST_DRAWN} in all; take fewer of them")
    mesh = mesh_of_grid(given.points)
    if not mesh.face_count:
        raise InputError("terrain: holes leave nothing of it")
    check_range(mesh.bounds)
    return mesh


def terrain_scene(
    given: Terrain | ArrayLike,
    *,
    levels: int = 20,
    every: int = DEFAULT_EVERY,
    name: str = "terrain",
    exaggeration: float = 1.0,
) -> Scene:
    """The scene that shows a terrain: its outlines, its borders, and level lines at round heights.

    Parameters
    ----------
    given : Terrain or (m, n) array_like of float
        An array is taken as by `terrain`.
    levels : int
        About how many level lines; 0 for none.
    every : int
        Every so many of them is an index line; 0 for none.
    name : str
        Of the item, and the title.
    exaggeration : float
        Heights are drawn times this; level lines and numbers are those of the heights as they are given.

    Returns
    -------
    Scene
        With one item.

    Raises
    ------
    InputError
        See `terrain_mesh`; for an exaggeration that is not positive and finite.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import scene
    >>> hill = scene.terrain_scene([[0, 1, 0], [1, 3, 1], [0, 1, 0]])
    >>> len(vp.draw(hill).layers) > 0, hill.items[0].curves.sections[0].offsets
    (True, (1.0, 2.0))
    """
    land = given if isinstance(given, Terrain) else terrain(np.ma.asarray(given))
    heights = round_heights(*land.relief, levels) if levels else ()
    drawn = land if exaggeration == 1.0 else exaggerated(land, exaggeration)
    sections = level_sections([exaggeration * height for height in heights], every) if heights else ()
    shape, lines = terrain_mesh(drawn), SurfaceLines(sections=sections)
    item = Item(name, shape, "green", default_lines=TERRAIN_LINES, curves=lines)
    return Scene((item,), title=name, exaggeration=exaggeration)


# Terrains coloured by their heights, and the light of maps.

MOST_TINTS = 100
"""Bands of heights, at most."""

TINTS = ("#6f9f6a", "#a5c183", "#e2dda6", "#d8b67c", "#b88a5a", "#99745a", "#c8c1ba", "#ffffff")
"""Colours of maps from the lowest ground to the highest."""


def hill_light(azimuth_deg: float = 315.0, altitude_deg: float = 45.0) -> Light:
    """The parallel light of shaded maps.

    Parameters
    ----------
    azimuth_deg : float
        Where it comes from, clockwise from north, the direction of y: north-west where nothing is said.
    altitude_deg : float
        How high it stands above the horizon, more than 0 and at most 90.

    Returns
    -------
    Light
        Named SUN.

    Raises
    ------
    InputError
        For other altitudes, and angles that are not finite.

    Examples
    --------
    >>> from vectorplot import scene
    >>> [round(part, 6) for part in scene.hill_light().position]
    [-0.5, 0.5, 0.707107]
    """
    azimuth, altitude = number("hill light: azimuth", azimuth_deg), number("hill light: altitude", altitude_deg)
    if not 0.0 < altitude <= 90.0:
        raise InputError(f"hill light: an altitude of {altitude:g} degrees: expected more than 0, and at most 90")
    flat, turn = cos(radians(altitude)), radians(azimuth)
    return Light((flat * sin(turn), flat * cos(turn), sin(radians(altitude))), parallel=True, name="SUN")


def tinted(
    name: str,
    mesh: Mesh,
    heights: Sequence[float],
    colours: Sequence[str] = TINTS,
    *,
    curves: SurfaceLines = NO_LINES,
) -> tuple[Item, ...]:
    """The bands of a terrain between given heights, each an item with a colour of its own.

    Parameters
    ----------
    name : str
        The items are called after it and counted from 1, from the lowest band.
    mesh : Mesh
        Of triangles; cut along its level lines.
    heights : (n,) sequence of float
        Between the bands.
    colours : sequence of str
        As #rrggbb, from the lowest band to the highest; what is between them is mixed.
    curves : SurfaceLines
        Lines of each of the bands.

    Returns
    -------
    tuple of Item
        Without those that nothing belongs to. Their borders are level lines, of the kind boundary.

    Raises
    ------
    InputError
        For a mesh of other faces, heights that are not finite or more than 99, and colours that are not #rrggbb.

    Notes
    -----
    Bands are bodies of their own: in pictures they are shaded as any other, and hide each other.

    Examples
    --------
    >>> from vectorplot import scene, surfaces
    >>> hill = scene.terrain_mesh(surfaces.terrain([[0, 1, 0], [1, 3, 1], [0, 1, 0]]))
    >>> [(item.name, item.colour) for item in scene.tinted("HILL", hill, [1.0, 2.0], ["#000000", "#ffffff"])]
    [('HILL1', '#000000'), ('HILL2', '#808080'), ('HILL3', '#ffffff')]
    """
    levels = np.unique(np.asarray(heights, dtype=np.float64).ravel())
    if not np.isfinite(levels).all() or len(levels) >= MOST_TINTS:
        raise InputError(f"tints: expected fewer than {MOST_TINTS} finite heights")
    if (np.diff(mesh.offsets) != TRIANGLE).any():
        raise InputError("tints: expected a terrain, a mesh of triangles")
    mixed = _mixed(colours, len(levels) + 1)
    cut = level_bands(mesh.vertices, mesh.vertices[:, 2], mesh.corners.reshape(-1, TRIANGLE), levels)
    # A level line is level, to the last digit.
    cut = replace(cut, points=np.column_stack([cut.points[:, :2], cut.values]))
    lines = ("contour", "boundary", "section")
    parts = ((k, cut.mesh(k)) for k in range(len(mixed)))
    return tuple(
        Item(f"{name}{k + 1}", part, mixed[k], lines=lines, curves=curves) for k, part in parts if part.face_count
    )


def _mixed(colours: Sequence[str], count: int) -> list[str]:
    """So many colours, evenly from the first to the last one."""
    try:
        given = np.array([[int(colour[k : k + 2], 16) for k in (1, 3, 5)] for colour in colours], dtype=np.float64)
    except (ValueError, TypeError, IndexError):
        given = np.zeros((0, 3))
    if not len(given) or any(len(colour) != len("#rrggbb") or colour[0] != "#" for colour in colours):
        raise InputError("tints: expected colours as #rrggbb")
    place = np.linspace(0.0, len(given) - 1.0, count)
    parts = np.stack([np.interp(place, np.arange(len(given)), given[:, k]) for k in range(3)], axis=1)
    # Halves are rounded up: the mean of black and white is 80.
    return [f"#{r:02x}{g:02x}{b:02x}" for r, g, b in np.floor(parts + 0.5).astype(int).tolist()]

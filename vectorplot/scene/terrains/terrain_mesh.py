"""What is drawn for a terrain: its outlines, its borders and its level lines."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.errors import InputError
from vectorplot.features.zeros.grid_triangulation import mesh_of_grid
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.extent import check_range
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.scene.terrains.level_lines import USUAL_EVERY, level_sections, round_heights
from vectorplot.surfaces.terrains.terrain import Terrain, exaggerated, terrain

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
    every: int = USUAL_EVERY,
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
        As of `terrain_mesh`; for an exaggeration that is not positive and finite.

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
    item = Item(name, shape, "green", usual_lines=TERRAIN_LINES, curves=lines)
    return Scene((item,), title=name, exaggeration=exaggeration)

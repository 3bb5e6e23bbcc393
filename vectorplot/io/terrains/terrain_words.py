"""Terrains of scene files: heights on a grid, or scattered points."""

from __future__ import annotations

from typing import Any

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.scenes.scene_slots import Family, Slot, read_family, read_number, read_numbers, read_whole
from vectorplot.io.scenes.scene_splines import read_points, read_rows
from vectorplot.io.scenes.scene_words import Words
from vectorplot.scene.terrains.terrain_mesh import terrain_mesh
from vectorplot.surfaces.terrains.terrain import densified_terrain, exaggerated, terrain, terrain_of_points

SCATTERED_CELLS = (40.0, 40.0)
"""Cells of the grid over scattered points where nothing else is said."""


def read_terrain_mesh(words: Words, at: int, owner: str) -> tuple[Mesh, int]:
    """The terrain whose slots stand at a word, and the word behind them."""
    return read_family(words, at, owner, "terrain", {"terrain": TERRAIN})


def _build(
    *,
    heights: Floats | None,
    points: Floats | None,
    x: tuple[float, float] | None,
    y: tuple[float, float] | None,
    cells: tuple[float, float] | None,
    densified: int,
    exaggeration: float,
) -> Mesh:
    if heights is not None and points is None:
        if cells is not None:
            raise InputError("terrain: 'cells' are for points")
        # Rows are written from south to north, each from west to east.
        land = terrain(heights.T, x, y)
    elif points is not None and heights is None:
        if x is not None or y is not None:
            raise InputError("terrain: 'x' and 'y' are for heights")
        columns, rows = SCATTERED_CELLS if cells is None else cells
        land = terrain_of_points(points, int(columns), int(rows))
    else:
        raise InputError("terrain: expected 'heights' or 'points'")
    if densified != 1:
        land = densified_terrain(land, densified)
    return terrain_mesh(exaggerated(land, exaggeration))


_PAIR: Any = Slot(read_numbers(2))

TERRAIN = Family(
    {
        "heights": Slot(read_rows),
        "points": Slot(read_points),
        "x": _PAIR,
        "y": _PAIR,
        "cells": _PAIR,
        "densified": Slot(read_whole, 1),
        "exaggeration": Slot(read_number, 1.0),
    },
    ("heights",),
    _build,
)
"""What stands behind the word terrain."""

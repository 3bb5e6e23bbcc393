"""Smooth surfaces, curves in space and terrains of scene files: which shape, and where it stands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve
from vectorplot.curves.placed_curves import PlacedCurve
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.rotations import axis_frame
from vectorplot.geometry.solids import IDENTITY
from vectorplot.io.named_shapes import CURVES, SURFACES, read_points, read_rows
from vectorplot.io.scene_words import Words
from vectorplot.io.shape_arguments import Family, Slot, read_family, read_number, read_numbers, read_whole
from vectorplot.io.surface_line_words import AXES, CurveDraft
from vectorplot.io.terrain_files import land_of_file
from vectorplot.scene.added_lines import evenly_between, least_extent
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.surface_lines import Section, SurfaceLines, Vector, round_heights, with_index_lines
from vectorplot.scene.terrains import terrain_mesh
from vectorplot.surfaces.placed_surface import PlacedImplicit, PlacedSurface
from vectorplot.surfaces.surface import ImplicitSurface, Surface, is_implicit, is_parametrised
from vectorplot.surfaces.terrains import Terrain, densified_terrain, exaggerated, terrain, terrain_of_points
from vectorplot.words import nearest

# Smooth surfaces of scene files: which one, and where it stands; loaded where a file has one.

HOLE_GRID = 16
"""Cells of the grid, in each direction of its box, on which the equation of an implicit surface is tried out."""


def read_surface(words: Words, at: int, owner: str) -> tuple[Surface | ImplicitSurface, int]:
    """The surface whose name stands at a word, and the word behind its slots."""
    name = words.words[at]
    if name not in SURFACES:
        if not name:
            words.fail(at, f"{owner}expected the name of a surface ({', '.join(SURFACES)}), got {words.shown(at)}")
        near = nearest(name, list(SURFACES))
        expected = f"'{near}'" if near else f"one of {', '.join(SURFACES)}"
        words.fail(at, f"{owner}unknown surface {words.shown(at)}, expected {expected}")
    return read_family(words, at + 1, owner, name, SURFACES)


def placed_surface(shape: Surface | ImplicitSurface, placement: Sequence[float]) -> Surface | ImplicitSurface:
    """The surface under a placement (twelve numbers, rows of a matrix and a shift)."""
    if tuple(placement) == IDENTITY:
        return shape
    rows = np.array(placement).reshape(3, 4)
    if is_parametrised(shape):
        return PlacedSurface(shape, rows[:, :3].T, rows[:, 3])
    assert is_implicit(shape)
    return PlacedImplicit(shape, rows[:, :3].T, rows[:, 3])


def checked_bounds(shape: Surface | ImplicitSurface) -> Floats:
    """(2,3) the bounds of a surface.

    Errors: InputError for a surface without a finite point, and for an equation that has no value in its box.
    """
    bounds = smooth_bounds(shape)
    if is_implicit(shape):
        x, y, z = np.linspace(bounds[0], bounds[1], HOLE_GRID + 1).T
        points = np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1)
        if not np.isfinite(shape.values(points)).any():
            raise InputError("the equation has no value anywhere in its box")
    return bounds


def curves_of(
    draft: CurveDraft, shape: Mesh | Surface | ImplicitSurface, bounds: Floats, times: float | None = None
) -> SurfaceLines:
    """The lines that a draft asks for on a surface or a polyhedron that stands in its place, within bounds (2,3);
    times: what the heights of a terrain are multiplied with, before which those of its level lines are round."""
    sections: tuple[Section, ...] = ()
    for planes in draft.planes:
        offsets = planes.offsets
        if times is not None and not offsets and not planes.slices and planes.normal == AXES["z"]:
            low, high = (bounds[:, 2] / times).tolist()
            offsets = tuple(times * height for height in round_heights(low, high, planes.count))
        offsets = offsets or even_offsets(shape, bounds, planes.normal, planes.count)
        sections += with_index_lines(
            Section(planes.normal, offsets, planes.slices, numbered=planes.numbered), planes.every
        )
    return replace(draft.lines, sections=sections)


def even_offsets(
    shape: Mesh | Surface | ImplicitSurface, bounds: Floats, normal: Vector, count: int
) -> tuple[float, ...]:
    """Heights along a normal that divide the extent of a surface, of an implicit one that of its box, evenly.

    Errors: InputError for a shape that lies in one such plane.
    """
    if normal in AXES.values():
        heights = matmul(bounds, normal)
    elif isinstance(shape, Mesh):
        heights = matmul(shape.vertices, normal)
    elif is_parametrised(shape):
        heights = smooth_bounds(PlacedSurface(shape, axis_frame(normal).T))[:, 2]
    else:
        heights = matmul(np.stack(np.meshgrid(*bounds.T, indexing="ij"), axis=-1), normal)
    low, high = float(heights.min()), float(heights.max())
    if not high - low > least_extent(bounds, low, high):
        raise InputError("sections: the surface has no extent along their normal")
    return evenly_between(low, high, count)


# Curves in space as items of scene files: which one, and where it stands; loaded where a file has one.

_FORMULAS = "curve"
"""The family whose word may be left out: formulas stand right behind the kind."""


def read_space_curve(words: Words, at: int, owner: str) -> tuple[Curve, int]:
    """The curve whose name, or whose formulas, stand at a word, and the word behind its slots."""
    name = words.words[at]
    if name in CURVES:
        return read_family(words, at + 1, owner, name, CURVES)
    if name.startswith('"') or words.is_number(at) or name in CURVES[_FORMULAS].slots:
        return read_family(words, at, owner, _FORMULAS, CURVES)
    known = ", ".join(word for word in CURVES if word != _FORMULAS)
    near = nearest(name, list(CURVES)) if name else None
    expected = f"'{near}'" if near else f"three formulas in quotes or one of {known}"
    words.fail(at, f"{owner}curve: expected {expected}, got {words.shown(at)}")


def placed_curve(curve: Curve, placement: Sequence[float]) -> Curve:
    """The curve under a placement (twelve numbers, rows of a matrix and a shift).

    Errors: InputError for a curve without a finite point.
    """
    if tuple(placement) != IDENTITY:
        rows = np.array(placement).reshape(3, 4)
        curve = PlacedCurve(curve, rows[:, :3].T, rows[:, 3])
    smooth_bounds(curve)
    return curve


# Terrains of scene files: heights on a grid, or scattered points.

SCATTERED_CELLS = (40.0, 40.0)
"""Cells of the grid over scattered points where nothing else is said."""


TERRAIN_SUFFIXES = (".asc", ".xyz")
"""Of the files of heights that a scene may name."""


def read_terrain_mesh(words: Words, at: int, owner: str, path: Path | None = None) -> tuple[tuple[Mesh, float], int]:
    """The terrain whose slots stand at a word, or of a file of heights, what its heights are multiplied with, and the
    word behind them."""
    if path is not None:
        slots = {name: TERRAIN.slots[name] for name in ("densified", "exaggeration")}
        of_file = Family(slots, (), partial(_of_file, land_of_file(path)))
        return read_family(words, at, owner, "terrain", {"terrain": of_file})
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
) -> tuple[Mesh, float]:
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
    return terrain_mesh(exaggerated(land, exaggeration)), exaggeration


def _of_file(land: Terrain, *, densified: int, exaggeration: float) -> tuple[Mesh, float]:
    land = land if densified == 1 else densified_terrain(land, densified)
    return terrain_mesh(exaggerated(land, exaggeration)), exaggeration


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

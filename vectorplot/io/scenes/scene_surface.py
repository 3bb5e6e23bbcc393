"""Smooth surfaces of scene files: which one, and where it stands; loaded where a file has one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.bodies.solids import IDENTITY
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.rotations import axis_frame
from vectorplot.io.scenes.items.scene_curves import AXES, CurveDraft
from vectorplot.io.scenes.scene_families import SURFACES
from vectorplot.io.scenes.scene_slots import read_family
from vectorplot.io.scenes.scene_words import Words
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.lines.added_lines import evenly_between, least_extent
from vectorplot.scene.surface_lines import Section, SurfaceLines, Vector
from vectorplot.scene.terrains.level_lines import with_index_lines
from vectorplot.surfaces.placed_surface import PlacedImplicit, PlacedSurface
from vectorplot.surfaces.surface import ImplicitSurface, Surface, is_implicit, is_parametrised
from vectorplot.words import nearest

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


def curves_of(draft: CurveDraft, shape: Mesh | Surface | ImplicitSurface, bounds: Floats) -> SurfaceLines:
    """The lines that a draft asks for on a surface or a polyhedron that stands in its place, within bounds (2,3)."""
    sections: tuple[Section, ...] = ()
    for planes in draft.planes:
        offsets = planes.offsets or even_offsets(shape, bounds, planes.normal, planes.count)
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

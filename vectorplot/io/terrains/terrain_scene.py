"""A file, or an array, of heights -> a scene."""

from __future__ import annotations

import math
import warnings
from pathlib import Path

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError, InputWarning
from vectorplot.io.meshes.mesh_file import shown
from vectorplot.io.terrains.read_terrain import read_terrain
from vectorplot.scene.scene import Scene
from vectorplot.scene.terrains.level_lines import times_power_of_ten
from vectorplot.scene.terrains.terrain_mesh import MOST_DRAWN, terrain_scene
from vectorplot.surfaces.terrains.terrain import Terrain, terrain, thinned_terrain

LOWEST = 1.0 / 30.0
"""Heights less than this part of the width of their terrain would be seen as a plain: they are exaggerated."""

HIGHEST = 3.0
"""Heights of more than this many times it are in other units, or a needle: they are reduced."""

USUAL = 1.0 / 8.0
"""What heights are made then, about."""


def scene_of_heights(path: Path, exaggeration: float | None) -> Scene:
    """The scene of a file of heights; what was left out of it, or made higher, is said in one InputWarning each.

    exaggeration: None for 1 where that shows something.
    Errors: InputError with the file.
    """
    try:
        land, step = thinned_terrain(read_terrain(path), MOST_DRAWN)
        if step > 1:
            _say(path, f"every {_ordinal(step)} height each way is taken, {' x '.join(map(str, land.heights.shape))}")
        factor = exaggeration
        if factor is None:
            factor = usual_exaggeration(land)
            if factor != 1.0:
                _say(path, _drawn(factor, "an exaggeration of 1"))
        return terrain_scene(land, name=path.stem, exaggeration=factor)
    except InputError as error:
        raise (error if error.file else InputError(error.cause, file=shown(path))) from None
    except MemoryError:
        raise InputError("too large for the memory", file=shown(path)) from None


def scene_of_array(heights: Floats) -> Scene:
    """The scene of an array of heights (m,n), a step of 1 between them; what was made higher or lower is said in an
    InputWarning.

    Errors: InputError as of `terrain` and `terrain_scene`.
    """
    land = terrain(np.ma.asarray(heights))
    factor = usual_exaggeration(land)
    if factor != 1.0:
        warnings.warn(_drawn(factor, "vp.surface(x, y, z)"), InputWarning, stacklevel=4)
    return terrain_scene(land, exaggeration=factor)


def usual_exaggeration(land: Terrain) -> float:
    """1, or the 1, 2 or 5 times a power of ten with which the heights of a terrain are an eighth of its width, about,
    where they are much less or more."""
    low, high = land.relief
    if not (high - low) * max(land.size) < np.inf:
        raise InputError(f"heights from {low:g} to {high:g}: too far apart to be drawn")
    part = (high - low) / max(land.size)
    if part == 0.0 or LOWEST <= part <= HIGHEST:
        return 1.0
    wanted = USUAL / part
    power = int(np.floor(math.log10(wanted)))
    numerator = max(k for k in (1, 2, 5) if k * 10.0**power <= wanted or k == 1)
    return float(times_power_of_ten(np.array(float(numerator)), power))


def _drawn(factor: float, instead: str) -> str:
    """That heights are scaled, and what leaves them as they are."""
    return f"heights are drawn {factor:g} times as high ({instead} leaves them as they are)"


def _say(path: Path, what: str) -> None:
    warnings.warn(f"{shown(path)}: {what}", InputWarning, stacklevel=4)


def _ordinal(step: int) -> str:
    return {2: "2nd", 3: "3rd"}.get(step, f"{step}th")

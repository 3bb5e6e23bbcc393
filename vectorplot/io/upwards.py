"""Which way is up in a file of meshes: a hint where it seems to be y."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.errors import InputError
from vectorplot.geometry.rotations import upright_turn
from vectorplot.geometry.vectors import norm
from vectorplot.io.meshes.mesh_file import shown
from vectorplot.scene.scene import Scene

EITHER_WAY = (".obj",)
"""Formats in which programs with y upwards write as often as those with z upwards."""

SLENDER = 1.25
"""What is so many times longer along y than along x and z stands on its end, if z is up, seldom on purpose."""


def upwards_hint(path: str, scene: Scene) -> str | None:
    """A line that says how to stand a file up that seems to have y upwards; None for others, and where the scene has a
    camera of its own. The reader of glb files, in which y is up, stands them up."""
    suffix = Path(path).suffix.lower()
    if scene.camera is not None or not len(scene):
        return None
    x, y, z = np.ptp(scene.bounds, axis=0).tolist()
    if suffix in EITHER_WAY and y > SLENDER * max(x, z):
        return f"{shown(Path(path))}: longest along y: if y is up in it, --up y stands it up"
    return None


def stood_up(scene: Scene, up: ArrayLike) -> Scene:
    """The scene turned on the shortest way so that a direction points upwards, along z. Errors: InputError for none."""
    way = np.asarray(up, dtype=np.float64)
    length = float(norm(way))
    if not 0.0 < length < np.inf:
        raise InputError("up: expected a direction")
    matrix = np.eye(4)
    # Columns: the way back of points as rows.
    matrix[:3, :3] = upright_turn(way)
    return scene.transformed(matrix)

"""Items whose surfaces run to infinity, or are empty: what is shown of them ends somewhere, or is nothing."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np

from vectorplot.errors import InputWarning
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.function_surface import FunctionSurface
from vectorplot.surfaces.graphs.graph import Graph, PolarGraph
from vectorplot.surfaces.surface import is_implicit


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

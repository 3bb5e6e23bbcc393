"""Shadows of what is transparent: light that is dimmed and coloured."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals import Decals, joined_decals
from vectorplot.effects.shadows import cast_shadows
from vectorplot.geometry.mesh import Bools
from vectorplot.scene.scene import Item, Light, Scene
from vectorplot.scene.view import View
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces

CLEAR_LEVEL = 1 << 20
"""The level of these shadows: they come after all other decals of a face."""


def is_clear(item: Item) -> bool:
    """Whether light goes through an item, but not all of it."""
    return item.material.is_clear and item.material.opacity > 0.0


def clear_shadows(
    view: View,
    scene: Scene,
    lights: Sequence[Light],
    *,
    receivers: Bools | None = None,
    projected: ProjectedFaces | None = None,
) -> Decals:
    """The shadows of the transparent items of a scene that do not occlude: decals of the items' colours and opacities,
    each with one light, to be drawn after the shadows of what is not transparent.

    receivers, errors and degenerate cases as of cast_shadows. Source: Glaeser, section 6.6.
    """
    groups: dict[tuple[str, float], Bools] = {}
    for number, item in enumerate(scene.items):
        if is_clear(item) and not view.occludes[number]:
            same = (item.colour, item.material.opacity)
            groups.setdefault(same, np.zeros(len(scene.items), dtype=np.bool_))[number] = True
    if not groups:
        return joined_decals()
    projected = project_faces(view) if projected is None else projected
    return joined_decals(*(_of_group(view, lights, items, *key, receivers, projected) for key, items in groups.items()))


def _of_group(
    view: View,
    lights: Sequence[Light],
    items: Bools,
    colour: str,
    opacity: float,
    receivers: Bools | None,
    projected: ProjectedFaces,
) -> Decals:
    """The shadows of items of one colour and opacity."""
    shadows = cast_shadows(view, lights, casters=items, receivers=receivers, projected=projected)
    count = np.zeros(len(shadows), dtype=np.intp)
    return Decals(
        shadows.points,
        shadows.offsets,
        shadows.face,
        count + int(FillKind.CLEAR_SHADOW),
        count,
        np.log2(shadows.lacking).astype(np.intp),
        count,
        count + CLEAR_LEVEL,
        (colour,),
        count,
        np.full(len(shadows), opacity),
    )

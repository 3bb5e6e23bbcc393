"""Shadows of what is transparent: light that is dimmed and coloured.

In them half of what their light would give is left, in the colour of what dims it, as far as that is opaque.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.arrays import Bools, Ints
from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals.decal_polygons import Decals, joined_decals, no_decals
from vectorplot.effects.decals.face_frames import FaceFrames
from vectorplot.effects.decals.united_decals import disjoint_decals
from vectorplot.effects.shadows.missing_shadows import tell_missing_shadows
from vectorplot.effects.shadows.shadow_decals import cast_within
from vectorplot.effects.shadows.shadow_grades import Shadows
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import USUAL, Budget
from vectorplot.geometry.regions import corners_of, polygons_of, unions, without_holes, without_splinters
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces

CLEAR_LEVEL = 1 << 20
"""The level of these shadows: they come after all other decals of a face."""


def is_clear(item: Item) -> bool:
    """Whether light goes through an item, but not all of it."""
    return item.material.is_clear and item.material.opacity > 0.0


def transparent_shadows(
    view: View,
    scene: Scene,
    lights: Sequence[Light],
    shadows: Decals | None = None,
    *,
    receivers: Bools | None = None,
    projected: ProjectedFaces | None = None,
    budget: Budget = USUAL,
) -> Decals:
    """The shadows of the transparent items of a scene that do not occlude: decals of the items' colours and opacities,
    each with one light, to be drawn after the shadows of what is not transparent.

    shadows: those; where they keep a light away nothing dims it, and where they keep others away those lack, too.
    Things of one colour and opacity dim a light once. They fall on opaque items only. receivers, errors and degenerate
    cases as of cast_shadows; an InputWarning names the items for which the budget did not do.
    Source: Glaeser, section 6.6.
    """
    groups: dict[tuple[str, float], Bools] = {}
    for number, item in enumerate(scene.items):
        if is_clear(item) and not view.occludes[number]:
            same = (item.colour, item.material.opacity)
            groups.setdefault(same, np.zeros(len(scene.items), dtype=np.bool_))[number] = True
    if not groups:
        return joined_decals()
    projected = project_faces(view) if projected is None else projected
    dark = no_decals() if shadows is None else shadows.of(np.flatnonzero(shadows.kind == FillKind.SHADOW))
    # Light goes through what is transparent, and leaves no shadow on it.
    opaque = np.array([item.material.opacity >= 1.0 for item in scene.items], dtype=np.bool_)[view.face_item]
    shown = opaque if receivers is None else receivers & opaque
    found = []
    for (colour, opacity), items in groups.items():
        found_here = cast_within(view, lights, budget.pairs, casters=items, receivers=shown, projected=projected)
        tell_missing_shadows(scene.items, lights, found_here.left_out)
        cast = found_here.shadows
        here = dark.of(np.flatnonzero(np.isin(dark.face, cast.face)))
        found.append(_dimmed(view, cast, disjoint_decals(view, here), colour, opacity))
    return joined_decals(*found)


def _dimmed(view: View, cast: Shadows, dark: Decals, colour: str, opacity: float) -> Decals:
    """Where things of one colour and opacity throw shadows of single lights, cut along disjoint dark ones."""
    import shapely

    if not len(cast):
        return no_decals()
    dark = dark.of(np.argsort(dark.face, kind="stable"))
    frames = FaceFrames.of(view, cast.face)
    polygons = polygons_of(frames.flat(cast.points, _owner(cast.offsets)), cast.offsets)
    _, leader, group = np.unique(
        np.stack([cast.face, cast.lacking], axis=1), axis=0, return_index=True, return_inverse=True
    )
    region = unions(polygons, group.ravel(), view.tolerance)
    face, light = cast.face[leader], cast.lacking[leader]
    others = polygons_of(FaceFrames.of(view, dark.face).flat(dark.points, _owner(dark.offsets)), dark.offsets)
    first, last = (np.searchsorted(dark.face, face, side=side) for side in ("left", "right"))
    mine = ragged.owner(last - first)
    other = np.arange(len(mine)) - np.repeat(np.cumsum(last - first) - last, last - first)
    bright = region.copy()
    covered = np.flatnonzero(last > first)
    if len(covered):
        around = unions(others[other], np.searchsorted(covered, mine), view.tolerance)
        bright[covered] = shapely.difference(region[covered], around, grid_size=view.tolerance)
    still = np.flatnonzero(dark.lights_lacking[other] & light[mine] == 0)
    mine, other = mine[still], other[still]
    inner = shapely.intersection(region[mine], others[other], grid_size=view.tolerance)
    every = np.concatenate([bright, inner])
    number = np.concatenate([np.arange(len(region)), mine])
    lacking = np.concatenate([light, light[mine] | dark.lights_lacking[other]])
    parts, of = without_splinters(every, view.tolerance)
    parts, of = without_holes(parts, of)
    flat, offsets = corners_of(parts)
    lead = leader[number[of]]
    none = np.zeros(len(of), dtype=np.intp)
    return Decals(
        frames.lifted(flat, np.repeat(lead, np.diff(offsets))),
        offsets,
        cast.face[lead],
        none + int(FillKind.CLEAR_SHADOW),
        none,
        np.frexp(light[number[of]])[1].astype(np.intp) - 1,
        none,
        none + CLEAR_LEVEL,
        (colour,),
        lacking[of],
        np.full(len(of), opacity),
    )


def _owner(offsets: Ints) -> Ints:
    return ragged.owner(np.diff(offsets))

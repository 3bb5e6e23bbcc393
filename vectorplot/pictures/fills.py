"""The polygons of a painted picture: how finely surfaces are cut, colours, order, hatching, and the paper."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import is_curve
from vectorplot.drawing.fills import Colours, FillKind, Fills
from vectorplot.drawing.painted_fills import Overlay, fills_on_page, shown_faces, stacked
from vectorplot.errors import InputWarning
from vectorplot.features.edge_splitting import Allowed, Criterion, Within
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import Budget, unresolved
from vectorplot.geometry.component_arrays import dot
from vectorplot.geometry.mesh_cuts import level_bands
from vectorplot.geometry.projections import Projection
from vectorplot.pictures.pipeline import Pipeline
from vectorplot.pictures.plan import has_surfaces, may_have_bands
from vectorplot.scene.page import Page
from vectorplot.scene.placement import Placement, allowed_in_space
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import Section
from vectorplot.scene.view import View, view_of
from vectorplot.shading.facet_resolution import (
    SHORTEST_MM,
    FacetedScene,
    faceted,
    picture_fineness,
    refined,
    shade_error,
)
from vectorplot.shading.painted_colours import (
    Lighting,
    colours_of,
    corner_shades_of,
    opacities,
    painted_normals,
    smooth_faces,
)
from vectorplot.shading.palettes import palette as shades_of
from vectorplot.shading.shaded_faces import Shades, at_corners, exposed_scene, plane_numbers, view_normals
from vectorplot.tolerances import SAME_SHADE, SIDE_BY_SIDE_MM
from vectorplot.visibility.painter.height_fields import known_orders
from vectorplot.visibility.painter.image_faces import ImageFaces, view_points
from vectorplot.visibility.painter.painters_order import Painted, painters_order, picture_layers, side_by_side
from vectorplot.visibility.painter.unseen import unseen_faces
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces

if TYPE_CHECKING:
    from vectorplot.effects.decals import Decals
    from vectorplot.effects.reflection_fills import Moved


# The paper of a painted picture.

PAPER = "white"
"""The colour of the paper where the scene names none."""


def paper(scene: Scene) -> Colours:
    """(1,3) the colour of the paper."""
    return np.asarray(shades_of(scene.background or PAPER)[-1:])


def background(scene: Scene, page: Page) -> tuple[Fills, ...]:
    """A sheet of the scene's own colour, if it names one."""
    if scene.background is None:
        return ()
    return (Fills.whole_page(page.width_mm, page.height_mm, paper(scene)[0]),)


# What is painted, and how finely.

OUTLINES_OFF = 3.0
"""So many tolerances outlines of faces may be off those of the surface, or off their convex hulls: sides are compared
with the surface in a few places only."""


@dataclass(frozen=True, eq=False)
class VisiblePolygons:
    """What is painted: a scene without smooth surfaces, its view, its faces in the image, the polygons of the picture
    back to front, and where the picture goes; smooth (i,): the items whose faces stand for those of smooth surfaces."""

    scene: Scene
    view: View
    projected: ProjectedFaces
    faces: ImageFaces
    placement: Placement
    smooth: Bools


def without_unseen_facets(
    faceted: FacetedScene, view: View, projected: ProjectedFaces, painted: Painted, budget: Budget
) -> ImageFaces:
    """The polygons without those of smooth surfaces that are wholly covered; all of them where the budget does not do
    to find these."""
    smooth = smooth_items(faceted)
    pieces = np.bincount(painted.faces.source, minlength=view.face_count)
    unseen = unseen_faces(view, projected, (pieces > 0) & smooth[view.face_item], pieces > 1, budget.pairs)
    return painted.faces.take(np.flatnonzero(~unseen[painted.faces.source]))


def smooth_items(faceted: FacetedScene) -> Bools:
    """(i,) the items whose faces stand for those of a smooth surface."""
    return np.array([normals is not None for normals in faceted.normals], dtype=np.bool_)


def fineness(
    pipeline: Pipeline, shown: Scene, projection: Projection, casts: bool, allowed: Allowed, tolerance_mm: float
) -> Callable[[int], Criterion]:
    """What a picture asks of the triangles of the items that it shows; all else as in picture_fineness."""
    in_glass = None
    if pipeline.calls_for("refraction"):
        from vectorplot.effects.glass import items_in_glass

        in_glass = items_in_glass(shown, projection)
    return picture_fineness(shown, projection, casts, allowed, tolerance_mm, in_glass)


def off_surfaces(seen: VisiblePolygons, tolerance_mm: float) -> Floats:
    """(i,) how far outlines of the faces of items may be off those of the surfaces that they stand for, in the view."""
    view = seen.view
    off = np.where(seen.smooth, OUTLINES_OFF * tolerance_mm / seen.placement.scale, 0.0)
    if view.eye is None:
        return off
    nearest = np.full(len(off), view.focus)
    item = np.searchsorted(view.item_vertices, np.arange(view.points.shape[1]), side="right") - 1
    np.minimum.at(nearest, item, view.depth)
    return np.asarray(off * np.maximum(nearest, view.near) / view.focus)


def finer(seen: VisiblePolygons, lighting: Lighting, budget: Budget, tolerance_mm: float) -> VisiblePolygons:
    """The same with polygons so small that shades on them are off by no more than is allowed, or as many as may be."""
    faces = seen.faces
    shortest, error = SHORTEST_MM / seen.placement.scale, shade_error(tolerance_mm)
    points, offsets, parent = refined(
        seen.view, lighting, faces.points, faces.offsets, faces.source, shortest, budget.facets, error
    )
    if len(parent) == len(faces):
        return seen
    found = ImageFaces(points, offsets, faces.planes[:, parent], faces.source[parent], faces.rank[parent])
    return replace(seen, faces=found)


def shades_of_faces(seen: VisiblePolygons, lighting: Lighting) -> Shades:
    """What every light gives to the corners of the polygons."""
    faces = seen.faces
    points = view_points(seen.view, faces.points)
    return corner_shades_of(seen.view, lighting, points, faces.offsets, faces.source)


# How far the colours of painted polygons are from those of the surfaces they show.

MOST = 4096
"""So many polygons are measured at most, evenly among all."""

FARTHEST = 0.5
"""What is seen over the middle of a side is no farther away than this part of it."""

STEPS = 255.0
"""Of a colour, from its darkest to its brightest shade."""


CORNER_BYTES, GRADIENT_BYTES = 12, 145
"""What a corner of a band takes in SVG, and a triangle with a gradient."""

WORTH_BANDS = 1.2
"""Bands have steps, and are larger in PDF and PostScript: they are to be smaller by such a factor in SVG."""


def shade_error_steps(seen: VisiblePolygons, lighting: Lighting) -> float | None:
    """By how many of 255 steps the linear shading of polygons is off the light that the surface has where it is seen,
    in the middles of their sides, at most; None where all polygons have one shade each.

    Over triangles that are off a surface one sees other places of it than those that they were made for: how far these
    are apart is told by the tangent planes at the corners of a triangle, and what that makes by the shades there.
    """
    faces = seen.faces
    smooth = np.flatnonzero(smooth_faces(seen.view, lighting.normals)[faces.source])
    smooth = smooth[:: 1 + len(smooth) // MOST]
    if not len(smooth):
        return None
    position, offsets = ragged.take(faces.offsets, smooth)
    points = faces.points[:, position]
    after = ragged.following(offsets)
    both = np.concatenate([points, 0.5 * (points + points[:, after])], axis=1)
    ends = np.concatenate([offsets, offsets[-1] + offsets[1:]])
    source = np.tile(faces.source[smooth], 2)
    shade = np.atleast_2d(corner_shades_of(seen.view, lighting, view_points(seen.view, both), ends, source).total)
    corner, middle = np.split(shade, 2, axis=-1)
    off = np.abs(middle - 0.5 * (corner + corner[..., after])).max(axis=0)
    return float(STEPS * max(off.max(), _moved(seen, lighting, np.unique(faces.source[smooth])).max(initial=0.0)))


def _moved(seen: VisiblePolygons, lighting: Lighting, source: Ints) -> Floats:
    """How far shades in the middles of sides of faces (n,) of smooth surfaces are off those that are seen there,
    because the faces are off the surfaces."""
    view = seen.view
    source = source[seen.smooth[view.face_item[source]]]
    if not len(source):
        return np.zeros(0)
    position, offsets = ragged.take(view.offsets, source)
    after = ragged.following(offsets)
    points, normals = view.points[:, view.corners[position]], lighting.normals[:, position]
    shade = np.atleast_2d(corner_shades_of(view, lighting, points, offsets, source).total)
    side, half = points[:, after] - points, 0.5 * (normals + normals[:, after])
    # The height of a cubic in both tangent planes over the middle of its chord.
    height = (dot(normals[:, after], side) - dot(normals, side)) / 8.0
    ray = np.array([0.0, 0.0, 1.0])[:, None] if view.eye is None else view.eye[:, None] - points - 0.5 * side
    with np.errstate(divide="ignore", invalid="ignore"):
        along = height * dot(half, half) / dot(half, ray) * dot(ray, side) / dot(side, side)
    part = np.minimum(np.abs(np.nan_to_num(along)), FARTHEST)
    return np.asarray(part * np.abs(shade[..., after] - shade).max(axis=0))


# Smooth surfaces in steps of shade, cut along the lines of equal shade between them.

SPACE = 3
"""Coordinates of a point; shades come behind them."""


PLAIN_STEPS, FINEST_BORDERS = 64, 0.2
"""Of fewer shades than so many the borders are seen as lines: they are made finer in proportion, to such a part."""


def border_tolerance_mm(tolerance_mm: float, shades: int) -> float:
    """How far polygons may be off on the page so that borders between so many shades look smooth."""
    return tolerance_mm * min(max(shades / PLAIN_STEPS, FINEST_BORDERS), 1.0)


def posterized(seen: VisiblePolygons, lighting: Lighting, shade: Floats) -> tuple[VisiblePolygons, Floats, Ints]:
    """What is seen with polygons of smooth surfaces cut where the palette goes from one shade to the next, and the
    shades (n,) or (3,n) of the corners then: of each of these polygons one, that of its entry of the palette; and (m,)
    the polygon that each is a part of.

    shade: at the corners of the polygons as they are, linear between these. In coloured light red, green and blue have
    steps of their own. Polygons with one shade stay as they are.
    """
    size = lighting.smooth_size
    faces, shades = seen.faces, np.atleast_2d(shade)
    smooth = np.flatnonzero(smooth_faces(seen.view, lighting.normals)[faces.source])
    if size is None or not len(smooth):
        return seen, shade, np.arange(len(faces))
    position, offsets = ragged.take(faces.offsets, smooth)
    points, corners = _welded(faces.points[:, position].T, shades[:, position].T)
    levels, owner = (np.arange(size - 1) + 0.5) / size, smooth
    steps: list[Floats] = []
    for channel in range(len(shades)):
        fans, of = ragged.fans(offsets)
        fans = corners[fans]
        full = _full(points[fans])
        owner, steps = owner[of[full]], [step[of[full]] for step in steps]
        found = level_bands(points, points[:, SPACE + channel], fans[full], levels)
        source = found.source
        points, corners, offsets = found.points, found.corners, found.offsets
        owner, steps = owner[source], [*(step[source] for step in steps), found.band / size]
    kept = np.setdiff1d(np.arange(len(faces)), smooth)
    position, ends = ragged.take(faces.offsets, kept)
    number = np.concatenate([kept, owner])
    order = np.argsort(number, kind="stable")
    every = np.concatenate([faces.points[:, position], points[corners, :SPACE].T], axis=1)
    sizes = np.diff(offsets)
    flat = np.concatenate([shades[:, position], np.repeat(np.array(steps), sizes, axis=1)], axis=1)
    position, starts = ragged.take(np.concatenate([ends, ends[-1] + offsets[1:]]), order)
    parent = number[order]
    cut = ImageFaces(every[:, position], starts, faces.planes[:, parent], faces.source[parent], faces.rank[parent])
    result = flat[:, position]
    return replace(seen, faces=cut), result[0] if shade.ndim == 1 else result, parent


def _welded(points: Floats, shades: Floats) -> tuple[Floats, Ints]:
    """(k,3+s) the different points among (n,3) with their shades (n,s), equal but for rounding; and the number of each:
    so that neighbours are cut in the same points."""
    key = np.column_stack([points, np.rint(shades / SAME_SHADE)])
    _, first, number = np.unique(key, axis=0, return_index=True, return_inverse=True)
    return np.column_stack([points, shades])[first], number.reshape(-1)


def _full(corners: Floats) -> np.ndarray:
    """(t,) triangles (t,3,k) no two corners of which are in one place."""
    after = np.roll(corners, -1, axis=1)
    return np.asarray((corners[..., :SPACE] != after[..., :SPACE]).any(axis=2).all(axis=1), dtype=np.bool_)


# The polygons of a picture in their colours, with all that lies on them and is seen in them.


def coloured(
    pipeline: Pipeline,
    seen: VisiblePolygons,
    lighting: Lighting,
    page: Page,
    aura_mm: float,
    tolerance_mm: float,
    budget: Budget,
    reflections: int,
    cast: Callable[[VisiblePolygons], Decals] | None = None,
    united: Ints | None = None,
) -> Overlay:
    """The polygons of the picture, as of finer, in their colours, with all that lies on them and is seen in them;
    after: the polygon whose steps of shade they are, -1 for what lies on such, is seen in them, or is paper; cast:
    their shadows, where more throws some than these polygons; united (f,): faces of the view with one number may become
    one polygon where they follow each other (None: those of one plane)."""
    split = None
    if cast is None and pipeline.calls_for("surface bands"):
        split = pipeline.run("layers", _layers, seen, lighting, tolerance_mm)
    rest = seen if split is None else replace(seen, faces=seen.faces.take(np.flatnonzero(~split.banded)))
    shades = pipeline.run("shades", shades_of_faces, rest, lighting).total
    pipeline.measured("shades", "of 255", shade_error_steps, seen, lighting)
    rest, shades, whole = posterized(rest, lighting, shades)
    aura = aura_mm / seen.placement.scale
    in_bands = None if split is None else split.faces_of(seen)
    decals, lighting = _decals(pipeline, seen, lighting, aura, tolerance_mm, budget, cast, in_bands)
    laid = _laid(rest, lighting, decals)
    overlays = _overlays(pipeline, rest, lighting, decals, aura, tolerance_mm, budget, reflections)
    plane = (lighting.plane if united is None else united)[rest.faces.source]
    if split is not None:
        plane = split.unit[~split.banded]
    painted = pipeline.run("fills", _fills, pipeline, rest, lighting, shades, laid, overlays, page, plane)
    # A face comes before all that lies on it.
    if split is not None:
        from vectorplot.effects.decals import joined_decals
        from vectorplot.pictures.banded_surfaces import banded_surfaces

        on_faces = joined_decals(*decals)
        mine = np.flatnonzero(split.banded)
        faces, layer, place = seen.faces.take(mine), split.layer[mine], seen.placement
        bands, off = pipeline.run(
            "surface bands", banded_surfaces, seen.view, lighting, faces, layer, on_faces, place, tolerance_mm
        )
        # Facets are off what they stand for, and colours what their band is.
        own = replace(seen, faces=faces)
        pipeline.measured("surface bands", "of 255", lambda: off + (shade_error_steps(own, lighting) or 0.0))
        # What lies on a face comes right after it; paper comes first.
        leader = np.maximum.accumulate(np.where(painted.after >= 0, np.arange(len(painted.after)), -1))
        below = -1 - int(split.layer.max(initial=0))
        after = np.where(leader >= 0, -split.layer[~split.banded][painted.after[leader]], below)
        return stacked([bands, replace(painted, after=after)])
    is_face = (painted.after >= 0) & (np.diff(painted.after, prepend=-1) != 0)
    return replace(painted, after=np.where(is_face, np.append(whole, -1)[painted.after], -1))


@dataclass(frozen=True, eq=False)
class _Split:
    """Which polygons (n,) are painted in bands, the layers that they are in, and numbers, alike for those that follow
    each other in one plane."""

    banded: Bools
    layer: Ints
    unit: Ints

    def faces_of(self, seen: VisiblePolygons) -> Bools:
        """(f,) the faces of the view that are painted in bands."""
        found = np.zeros(seen.view.face_count, dtype=np.bool_)
        found[seen.faces.source[self.banded]] = True
        return found


def _layers(seen: VisiblePolygons, lighting: Lighting, tolerance_mm: float) -> _Split | None:
    """The layers of what is seen, and what of it may be painted in bands of equal shade; None where nothing may,
    where too much lies on one another, and where bands would not make a clearly smaller file than gradients do."""
    from vectorplot.effects.decals import no_decals
    from vectorplot.pictures.banded_surfaces import banded_surfaces

    view, faces = seen.view, seen.faces
    banded = seen.smooth[view.face_item] & smooth_faces(view, lighting.normals)
    banded = (banded & np.array([may_have_bands(item) for item in seen.scene.items])[view.shown_item])[faces.source]
    if not banded.any():
        return None
    plane = np.where(banded, -1, lighting.plane[faces.source])
    new = np.append(True, banded[1:] | (plane[1:] != plane[:-1]))[: len(plane)]
    unit = np.cumsum(new) - 1
    layer = picture_layers(faces, unit, view.tolerance)
    if layer is None:
        return None
    mine = np.flatnonzero(banded)
    unshadowed, _ = banded_surfaces(
        view, lighting, faces.take(mine), layer[mine], no_decals(), seen.placement, tolerance_mm
    )
    corners = len(unshadowed.fills.points)
    smaller = WORTH_BANDS * CORNER_BYTES * corners < GRADIENT_BYTES * len(mine)
    return _Split(banded, layer, unit) if smaller else None


def _decals(
    pipeline: Pipeline,
    seen: VisiblePolygons,
    lighting: Lighting,
    aura: float,
    tolerance_mm: float,
    budget: Budget,
    cast: Callable[[VisiblePolygons], Decals] | None,
    in_bands: Bools | None,
) -> tuple[tuple[Decals, ...], Lighting]:
    """The polygons that lie on faces, in the order in which they are painted; on those in bands (f,) shadows of one
    light may overlap."""
    scene, view, projected = seen.scene, seen.view, seen.projected
    found: list[Decals] = []
    off = off_surfaces(seen, tolerance_mm)
    if pipeline.calls_for("shadows"):
        from vectorplot.effects.scene_decals import scene_shadows

        def own(seen: VisiblePolygons) -> Decals:
            items, lights = scene.items, scene.lights
            return scene_shadows(seen.view, items, lights, projected, aura, off, budget, overlapping=in_bands)

        found.append(pipeline.run("shadows", cast or own, seen))
    if pipeline.calls_for("mirror light"):
        from vectorplot.effects.scene_decals import scene_mirror_light

        shines = partial(scene_mirror_light, off=off)
        lit, doubles = pipeline.run("mirror light", shines, scene, view, projected, lighting, found[0])
        found.append(lit)
        lighting = replace(lighting, doubles=doubles)
    if pipeline.calls_for("patterns"):
        from vectorplot.effects.decals import joined_decals
        from vectorplot.effects.scene_decals import scene_patterns

        found.append(pipeline.run("patterns", scene_patterns, scene, view, lighting, joined_decals(*found[:1])))
    if pipeline.calls_for("transparent shadows"):
        from vectorplot.effects.shadows import transparent_shadows

        clear = partial(transparent_shadows, projected=projected, budget=budget)
        found.append(pipeline.run("transparent shadows", clear, view, scene, scene.lights, found[0] if found else None))
    return tuple(found), lighting


def _laid(seen: VisiblePolygons, lighting: Lighting, decals: tuple[Decals, ...]) -> tuple[Overlay, ...]:
    """What lies on the polygons of the picture."""
    if not decals:
        return ()
    from vectorplot.effects.scene_decals import decal_fills

    return tuple(decal_fills(seen.view, lighting, some, seen.faces, seen.placement) for some in decals)


def _overlays(
    pipeline: Pipeline,
    seen: VisiblePolygons,
    lighting: Lighting,
    decals: tuple[Decals, ...],
    aura: float,
    tolerance_mm: float,
    budget: Budget,
    reflections: int,
) -> tuple[Overlay, ...]:
    """What polygons of the picture show, painted right after them and what lies on them.

    aura: the width of soft borders of shadows in the image; reflections: as in draw.
    """
    found = []
    if pipeline.calls_for("reflections"):
        from vectorplot.effects.mirrors import mirrors
        from vectorplot.effects.reflection_fills import double_decals, reflection_fills

        shown = mirrors(seen.scene, seen.view, seen.projected)
        borders = aura if pipeline.calls_for("shadows") else None
        off = off_surfaces(seen, tolerance_mm)

        def decals_of(double: View, moved: Moved, there: Lighting, which: Bools) -> tuple[Decals, ...]:
            return double_decals(seen.scene, seen.view, double, moved, there, which, borders, off, budget)

        found.append(
            pipeline.run(
                "reflections",
                reflection_fills,
                seen.view,
                lighting,
                shown,
                decals_of,
                seen.faces,
                seen.placement,
                paper(seen.scene)[0],
                reflections,
            )
        )
    if pipeline.calls_for("refraction"):
        from vectorplot.effects.glass import glass_fills

        found.append(
            pipeline.run(
                "refraction",
                glass_fills,
                seen.scene,
                seen.view,
                seen.projected,
                lighting,
                seen.faces,
                seen.placement,
                tolerance_mm,
                decals,
            )
        )
    return tuple(found)


def _fills(
    pipeline: Pipeline,
    seen: VisiblePolygons,
    lighting: Lighting,
    shades: Floats,
    laid: tuple[Overlay, ...],
    overlays: tuple[Overlay, ...],
    page: Page,
    plane: Ints,
) -> Overlay:
    """The polygons of the picture on the page, with what lies on them and what is painted between them. plane (n,):
    polygons that follow each other with one number may become one."""
    view, faces = seen.view, seen.faces
    item = view.face_item[faces.source]
    opacity = opacities(seen.scene.items)[view.shown_item[faces.source]]
    fills = fills_on_page(
        view,
        faces.points,
        faces.offsets,
        seen.placement,
        colours=colours_of(view, lighting, np.repeat(faces.source, np.diff(faces.offsets)), shades),
        opacity=opacity,
        item=item,
        kind=np.where(opacity < 1.0, int(FillKind.GLASS), int(FillKind.FACE)),
    )
    if pipeline.calls_for("reflections"):
        from vectorplot.effects.mirrors import mirrors
        from vectorplot.effects.reflection_fills import silvered

        panes = np.isin(faces.source, mirrors(seen.scene, view, seen.projected).face)
        fills, laid = silvered(fills, panes, paper(seen.scene)[0], laid)
    if pipeline.calls_for("refraction"):
        from vectorplot.effects.glass import refracting_items, tinted

        clear = refracting_items(seen.scene, view, seen.projected)[item]
        fills, both = tinted(fills, clear, opacity, paper(seen.scene)[0], (*laid, *overlays))
        laid, overlays = both[: len(laid)], both[len(laid) :]
    with_decals = stacked(
        [Overlay(fills, np.arange(len(fills))), *(laid if pipeline.calls_for("visible fills") else ())]
    )
    if not pipeline.calls_for("visible fills"):
        from vectorplot.drawing.fill_visibility import flattened

        world = seen.placement.page_from_world
        with_decals = flattened(fills, laid, world, plane)
    every, below = stacked([with_decals, *overlays]), background(seen.scene, page)
    return Overlay(Fills.joined(*below, every.fills), np.concatenate([np.full(len(below), -1), every.after]))


# What is said about the order of a painted picture: groups, slices, cycles.

MOST_NAMES = 5
"""So many items of a cycle are named."""


def group_names(scene: Scene) -> list[str]:
    """The groups of what is painted: lines that belong together have no order."""
    return sorted({item.group for item in scene.items if not is_curve(item.shape)} - {""})


def tell_groups(pipeline: Pipeline, scene: Scene, painted: Painted) -> None:
    """Tell the listener which groups stay together, and which do not."""
    names = group_names(scene)
    undone = [names[k] for k in painted.undone]
    if kept := [name for name in names if name not in undone]:
        pipeline.tell("groups", f"{', '.join(kept)}: ordered as wholes, then within", len(kept))
    if undone:
        pipeline.tell("groups undone", f"{', '.join(undone)}: something else comes between", len(undone))


def tell_slices(pipeline: Pipeline, scene: Scene, sliced: Mapping[int, Section], painted: Painted) -> None:
    """Tell the listener which items are painted slice by slice, and which are not."""
    for number, planes in sliced.items():
        name = scene.items[number].name
        if number in painted.ribbons:
            count = painted.ribbons[number]
            pipeline.tell("ribbons", f"{name}: in {len(planes.offsets) + 1} slices, ribbon by ribbon", count)
        else:
            pipeline.tell("ribbons undone", f"{name}: something else is in front of it or behind it", 0)


def tell_cyclic_overlaps(pipeline: Pipeline, scene: Scene, painted: Painted) -> None:
    """Say which items were cut because no order of whole faces was right."""
    if len(painted) > painted.uncut:
        names = _names(scene, painted.cycles)
        pipeline.tell("cut", f"{names}: they pierce one another, or overlap in circles", len(painted) - painted.uncut)


def warn_of_guesses(scene: Scene, painted: Painted) -> None:
    """An InputWarning for all items parts of which may be painted in a wrong order, and for all around which that is
    so."""
    _warn(scene, painted.guessed, "what pierces it, or itself, takes too many cuts, and is in order by depth alone")
    _warn(scene, painted.crowded, "too many faces overlap; they, and what overlaps them, are in order by depth alone")


def warn_of_single_polygons(scene: Scene, items: Ints) -> None:
    """An InputWarning for transparent items that are blended polygon by polygon in parts."""
    _warn(scene, items, "too much that is transparent lies on one another; polygons are blended one by one, with seams")


def _warn(scene: Scene, items: Ints, text: str) -> None:
    """One InputWarning about some items, if there are any."""
    if len(items):
        warnings.warn(f"{_names(scene, items)}: {unresolved(text)}", InputWarning, stacklevel=4)


def _names(scene: Scene, items: Ints) -> str:
    """The names of some items, the first MOST_NAMES of them."""
    names = ", ".join(scene.items[number].name for number in items[:MOST_NAMES].tolist())
    return f"{names} and {len(items) - MOST_NAMES} more" if len(items) > MOST_NAMES else names


# The faces of a scene in the painter's order, and what is seen of them on a page.


@dataclass(frozen=True, eq=False)
class OrderedFaces:
    """The faces of a scene, with triangles in place of smooth surfaces, back to front: their view and their faces in
    the image, and the polygons that are painted."""

    facets: FacetedScene
    view: View
    projected: ProjectedFaces
    faces: ImageFaces


def ordered_faces(
    pipeline: Pipeline,
    scene: Scene,
    shown: Scene,
    projection: Projection,
    criterion: Callable[[], Callable[[int], Criterion]],
    budget: Budget,
) -> OrderedFaces:
    """The faces of a scene back to front. shown: what of it is painted; criterion: how fine triangles have to be, as of
    faceted, which is asked for where there are any.

    Warns: InputWarning for items that may be in a wrong order.
    """
    # Bodies that are painted as wholes are not among what is shown.
    if pipeline.calls_for("facets") and has_surfaces(shown):
        facets = pipeline.run("facets", faceted, shown, criterion(), budget)
    else:
        facets = FacetedScene.of_meshes(shown)
    facets = replace(facets, scene=with_clear_items(facets.scene))
    view = pipeline.run("look", view_of, facets.scene, projection)
    projected = pipeline.run("faces", project_faces, view)
    known, groups = known_orders(shown, view), _groups(scene)
    sliced = {number: planes for number, item in enumerate(scene.items) if (planes := item.curves.slices)}
    normals = _normals_at_corners(facets, view)
    painted = pipeline.run(
        "order",
        painters_order,
        view,
        projected,
        known=known,
        sliced=sliced,
        group=groups,
        normals=normals,
        budget=budget,
    )
    warn_of_guesses(scene, painted)
    tell_slices(pipeline, scene, sliced, painted)
    tell_cyclic_overlaps(pipeline, scene, painted)
    tell_groups(pipeline, scene, painted)
    faces = painted.faces
    if pipeline.calls_for("unseen facets") and smooth_items(facets).any():
        faces = pipeline.run("unseen facets", without_unseen_facets, facets, view, projected, painted, budget)
    return OrderedFaces(facets, view, projected, faces)


def seen_on_page(
    pipeline: Pipeline, ordered: OrderedFaces, placement: Placement, budget: Budget
) -> tuple[VisiblePolygons, Ints]:
    """What is seen of faces back to front on a page, and the numbers (f,) of the planes of the view.

    Warns: InputWarning for transparent items with too much on one another.
    """
    facets, view, projected, faces = ordered.facets, ordered.view, ordered.projected, ordered.faces
    if pipeline.calls_for("transparent sheets"):
        from vectorplot.visibility.painter.transparent_sheets import connected_parts, in_sheets

        item = view.face_item[faces.source]
        opacity = opacities(facets.scene.items)[view.shown_item[faces.source]]
        sheet, width = np.where(opacity < 1.0, item, -1), SIDE_BY_SIDE_MM / placement.scale
        if pipeline.calls_for("refraction"):
            from vectorplot.effects.glass import refracting_items

            # What is seen in them is mixed, and opaque: nothing of them is blended.
            sheet = np.where(refracting_items(facets.scene, view, projected)[item], -1, sheet)
        part = connected_parts(view, faces, sheet)
        most = budget.pairs
        sheets = pipeline.run("transparent sheets", in_sheets, faces, sheet, part, opacity, width, view.tolerance, most)
        warn_of_single_polygons(facets.scene, sheets.single)
        faces = sheets.faces
    plane = plane_numbers(view)
    faces = faces.take(side_by_side(faces, _planes_of(facets.scene, view, faces, plane), view.tolerance))
    shown = shown_faces(faces, placement)
    return VisiblePolygons(facets.scene, view, projected, shown, placement, smooth_items(facets)), plane


def _normals_at_corners(facets: FacetedScene, view: View) -> Floats | None:
    """(3,c) the normals of surfaces at the corners of the faces of a view, 0 at apexes, those of their faces for
    polyhedra; None where no surface can touch another item."""
    if len(facets.normals) < 2 or all(normals is None for normals in facets.normals):
        return None
    apex = np.zeros(view.points.shape[1], dtype=np.bool_)
    for item, own in enumerate(facets.normals):
        if own is not None:
            part = slice(view.item_vertices[item], view.item_vertices[item + 1])
            apex[part] = (own.at_vertices == 0.0).all(axis=1)
    return np.where(apex[view.corners], 0.0, at_corners(view, view_normals(view, facets.normals, 0.0)))


def with_clear_items(scene: Scene) -> Scene:
    """The scene in which light goes through whatever one can see through."""
    clear = [item.material.is_clear for item in scene.items]
    if not any(see and item.hides for see, item in zip(clear, scene.items, strict=True)):
        return scene
    items = (replace(item, occludes=item.hides and not see) for see, item in zip(clear, scene.items, strict=True))
    return replace(scene, items=tuple(items))


def _planes_of(scene: Scene, view: View, faces: ImageFaces, plane: Ints) -> Ints:
    """(n,) the planes of painted polygons, -1 for those of transparent items, which stand together as sheets."""
    clear = opacities(scene.items)[view.shown_item[faces.source]] < 1.0
    return np.where(clear, -1, plane[faces.source])


def _groups(scene: Scene) -> Ints | None:
    """(i,) the number of each item's group, -1 for none; None where there are no groups."""
    names = group_names(scene)
    number = {"": -1, **{name: k for k, name in enumerate(names)}}
    return np.array([number.get(item.group, -1) for item in scene.items], dtype=np.intp) if names else None


@dataclass(frozen=True, eq=False)
class FacePainter:
    """How the faces of a scene are painted on a page: pipeline, and what its stages are to do; casts: whether lights
    throw shadows; the rest as in paint."""

    pipeline: Pipeline
    scene: Scene
    projection: Projection
    sheet: Page
    fit: bool
    casts: bool
    smooth: bool
    fills: str
    palette: int
    crease_angle_deg: float
    aura_mm: float
    tolerance_mm: float
    budget: Budget
    reflections: int

    @property
    def steps(self) -> int | None:
        """In how many steps smooth surfaces are shaded; None for gradients."""
        return self.palette if self.fills == "visible" else None

    @cached_property
    def allowed(self) -> Allowed:
        """How far triangles may be off smooth surfaces."""
        return allowed_in_space(self.scene, self.projection, self.sheet, self.fit, self._fine_mm)

    @property
    def _fine_mm(self) -> float:
        return self.tolerance_mm if self.steps is None else border_tolerance_mm(self.tolerance_mm, self.steps)

    def ordered(self, shown: Scene) -> OrderedFaces:
        """The faces of what is shown of the scene, back to front."""

        def criterion() -> Callable[[int], Criterion]:
            # Where each triangle has one shade they have to be so small that nobody sees it.
            if not self.smooth or self.fills == "erasing":
                return lambda _: Within(self.allowed)
            return fineness(self.pipeline, shown, self.projection, self.casts, self.allowed, self._fine_mm)

        return ordered_faces(self.pipeline, self.scene, shown, self.projection, criterion, self.budget)

    def seen(self, ordered: OrderedFaces, placement: Placement) -> tuple[VisiblePolygons, Lighting]:
        """What is seen of faces on the page, and how they are lit."""
        seen, plane = seen_on_page(self.pipeline, ordered, placement, self.budget)
        given, here = exposed_scene(seen.view, seen.scene)
        seen = replace(seen, scene=given)
        normals, items, true = np.full((3, len(seen.view.corners)), np.nan), self.scene.items, ordered.facets.normals
        if self.smooth and self.fills == "painted":
            normals = painted_normals(seen.view, items, here, true, plane, self.crease_angle_deg)
        elif self.smooth and self.fills == "visible":
            # Pens have no gradients: smooth surfaces have steps, meshes and planes one shade for each of their faces.
            normals = painted_normals(seen.view, items, (), true, plane, 0.0)
        lighting = Lighting(items, here, normals, plane, self.palette, smooth_size=self.steps)
        if self.fills != "erasing":
            seen = finer(seen, lighting, self.budget, self.tolerance_mm)
        return seen, lighting

    def coloured(
        self,
        seen: VisiblePolygons,
        lighting: Lighting,
        cast: Callable[[VisiblePolygons], Decals] | None = None,
        united: Ints | None = None,
    ) -> Overlay:
        """As of coloured."""
        how = (seen.placement.page, self.aura_mm, self.tolerance_mm, self.budget, self.reflections)
        return coloured(self.pipeline, seen, lighting, *how, cast, united)

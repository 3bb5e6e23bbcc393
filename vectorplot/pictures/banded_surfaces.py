"""Smooth surfaces painted in bands of equal shade: their facets by layers of the picture, those of a layer as regions
between isophotes."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.painted_fills import Overlay
from vectorplot.effects.decals import Decals, Laid, laid
from vectorplot.effects.scene_decals import shown_decals
from vectorplot.geometry import ragged
from vectorplot.geometry.mesh import TRIANGLE
from vectorplot.geometry.weld import distinct_points
from vectorplot.scene.placement import Placement
from vectorplot.scene.view import View
from vectorplot.shading.painted_colours import Lighting, shading_normals
from vectorplot.shading.palettes import COLOUR_MAP
from vectorplot.shading.shade_bands import (
    ChartMesh,
    FacetPlaces,
    ShadedPlaces,
    band_widths,
    half_band_steps,
    mesh_bands,
    palette_reaches,
)
from vectorplot.shading.shaded_faces import item_colours
from vectorplot.tolerances import LEAST_DIVISOR, SAME_AREA, SAME_CORNER_NORMAL, SHADOW_CORNER_MM
from vectorplot.visibility.painter.image_faces import ImageFaces, view_points

ROUND = np.pi / 2.0
"""On a ball lit from the eye shades change by so much a radius in the mean."""


def banded_surfaces(
    view: View,
    lighting: Lighting,
    faces: ImageFaces,
    layer: Ints,
    shadows: Decals,
    placement: Placement,
    tolerance_mm: float,
) -> tuple[Overlay, float]:
    """Facets of smooth surfaces, and the shadows on them, in bands of equal shade: those of a layer come after minus
    its number; and by how many of 255 steps colours within bands are off those of the bands, at most.

    faces: as they are seen; layer (n,) as of picture_layers.
    """
    decals = shown_decals(view, lighting, shadows)
    parts = laid(view, decals, faces.points, faces.offsets, faces.source)
    net = _net(view, lighting, faces, layer, decals, parts, placement)
    materials = {item.material: item for item in lighting.items}
    number = {material: k for k, material in enumerate(materials)}
    look = np.array([number[item.material] for item in lighting.items], dtype=np.intp)[net.item]
    reach = palette_reaches(lighting.items, net.item)
    steps = np.ones(len(net.item))
    shaded = ShadedPlaces(
        FacetPlaces(), look, view, list(materials.values()), lighting.lights, placement, steps, np.zeros(len(net.item))
    )
    steps, loose_mm = band_widths(reach, _radii(shaded, net), tolerance_mm)
    bands = mesh_bands(replace(shaded, steps=steps, loose_mm=loose_mm), net.mesh, net.lacking, net.coated)
    fills = Fills.flat(
        np.ascontiguousarray(bands.page.T),
        bands.offsets,
        item_colours(lighting.items, net.item[bands.chart], bands.shade, COLOUR_MAP),
        points3d=view.world_of(bands.points),
        item=net.item[bands.chart],
        kind=FillKind.BAND,
    )
    return Overlay(fills, -net.layer[bands.chart]), half_band_steps(reach, steps)


def _radii(shaded: ShadedPlaces, net: _Net) -> Floats:
    """(k,) the radii in mm of balls on which shades change as much a mm as on all of an item, of charts."""
    mesh = net.mesh
    triangles = mesh.triangles[net.lacking[mesh.triangles[:, 0]] == 0]
    shade = shaded.levels(mesh.chart, mesh.place, np.zeros(len(mesh), dtype=np.intp))[triangles]
    a, b, c = shaded.on_page(mesh.place[:3])[:, triangles.T].transpose(1, 0, 2)
    u, v = b - a, c - a
    rise, other = shade[:, 1] - shade[:, 0], shade[:, 2] - shade[:, 0]
    item = net.item[mesh.chart[triangles[:, 0]]]
    rows = np.hypot(*(rise * v - other * u)), np.abs(u[0] * v[1] - u[1] * v[0])
    change, area = (np.bincount(item, row, minlength=int(net.item.max(initial=-1)) + 1) for row in rows)
    return np.asarray(ROUND * area / np.maximum(change, LEAST_DIVISOR))[net.item]


# Facets on charts: what one layer shows of one item.


@dataclass(frozen=True, eq=False)
class _Net:
    """A mesh on charts, by charts, the lights that its nodes lack (n,), and which triangles are coated (t,), as in
    mesh_bands; item and layer (k,) of the charts, which are painted in their order."""

    mesh: ChartMesh
    lacking: Ints
    coated: Bools
    item: Ints
    layer: Ints


def _net(
    view: View,
    lighting: Lighting,
    faces: ImageFaces,
    layer: Ints,
    decals: Decals,
    parts: Laid,
    placement: Placement,
) -> _Net:
    """Facets with parts of decals, their shadows, on charts. On each chart there is once more what is next to it on
    nearer layers, under these: so nothing from behind is seen where one layer ends and the next begins."""
    owner, item = ragged.owner(np.diff(faces.offsets)), view.face_item[faces.source]
    points = view_points(view, faces.points)
    places = np.concatenate([points, shading_normals(view, lighting, points, faces.source[owner])])
    node = _nodes(faces.points, places[3:])
    facet, on = _with_neighbours(owner, node, layer)
    farthest, items = int(layer.max(initial=0)), int(item.max(initial=0)) + 1
    names, chart = np.unique((farthest - on) * items + item[facet], return_inverse=True)
    order = np.argsort(chart, kind="stable")
    facet, chart = facet[order], chart[order]
    inside = _apart_from_farther(owner, node, layer)[facet] & (on[order] == layer[facet])
    # What is lit, and of what is dark that which is next to it: shadows lie on it.
    lit = _beside_bright(node, faces.offsets, facet, chart, _dark(faces, parts)[facet])
    bright, _, of_bright = _mesh(faces.points, faces.offsets, places, node, facet[lit], chart[lit])
    low, high = (np.searchsorted(parts.piece, facet, side=side) for side in ("left", "right"))
    part, on_part = ragged.ranges(low, high - low), np.repeat(chart, high - low)
    lacking = decals.lights_lacking[parts.decal]
    flat, offsets, node = _shadow_corners(parts, lacking, placement)
    owner = ragged.owner(np.diff(offsets))
    points = view_points(view, flat)
    places = np.concatenate([points, shading_normals(view, lighting, points, decals.face[parts.decal[owner]])])
    dim, source, of_dim = _mesh(flat, offsets, places, node, part, on_part)
    triangles = np.concatenate([bright.triangles, dim.triangles + len(bright)])
    mesh = ChartMesh(
        np.concatenate([bright.chart, dim.chart]),
        np.concatenate([bright.place, dim.place], axis=1),
        np.concatenate([bright.covered, dim.covered]),
        triangles,
    )
    order = np.argsort(mesh.chart[triangles[:, 0]], kind="stable")
    coated = np.concatenate([inside[lit][of_bright], np.repeat(inside, high - low)[of_dim]])[order]
    lacks = np.concatenate([np.zeros(len(bright), dtype=np.intp), lacking[owner[source]]])
    return _Net(replace(mesh, triangles=triangles[order]), lacks, coated, names % items, farthest - names // items)


def _nodes(points: Floats, normals: Floats) -> Ints:
    """(c,) numbers of corners (3,c) with normals (3,c): alike where both are."""
    number = distinct_points(np.ascontiguousarray(points.T))[1]
    if not len(number):
        return number
    order = np.argsort(number, kind="stable")
    starts = np.flatnonzero(np.diff(number[order], prepend=-1))
    low, high = (extreme.reduceat(normals[:, order], starts, axis=1) for extreme in (np.minimum, np.maximum))
    several = np.flatnonzero(((high - low).max(axis=0) > SAME_CORNER_NORMAL)[number])
    rows = np.column_stack([number[several], np.rint(normals[:, several] / SAME_CORNER_NORMAL).T])
    found = number.copy()
    found[several] = len(number) + np.unique(rows, axis=0, return_inverse=True)[1].reshape(-1)
    return found


def _shadow_corners(parts: Laid, lacking: Ints, placement: Placement) -> tuple[Floats, Ints, Ints]:
    """Corners (3,c) of the image and offsets of parts of decals that lack lights (n,), and numbers (c,) of corners,
    alike for those in one place for want of the same lights; without corners at which no part turns, and without ways
    that lead there and back again."""
    page, offsets = placement.on_page(parts.points[:2]), parts.offsets
    rows = np.column_stack([np.rint(page / SHADOW_CORNER_MM), lacking[ragged.owner(np.diff(offsets))]])
    node, corner = distinct_points(rows)[1], np.arange(len(page))
    while True:
        own, before, after = node[corner], ragged.preceding(offsets), ragged.following(offsets)
        start, end = page[corner[before]], page[corner[after]]
        way, arm = (end - start).T, (page[corner] - start).T
        turns = np.abs(way[0] * arm[1] - way[1] * arm[0]) > SHADOW_CORNER_MM * np.hypot(*way)
        turns |= (np.diff(offsets) == TRIANGLE)[ragged.owner(np.diff(offsets))]
        back = (own == own[before]) | (own[before] == own[after])
        kept = (np.bincount(own, turns & ~back)[own] > 0.0) & ~back
        if kept.all():
            return parts.points[:, corner], offsets, own
        corner, offsets = corner[kept], ragged.offsets(kept)[offsets]


def _with_neighbours(owner: Ints, node: Ints, layer: Ints) -> tuple[Ints, Ints]:
    """Facets, and the layers that they are painted on: all of them on their own (n,), and on those of facets behind
    them with which they have corners in common. owner, node (c,) of corners."""
    count = int(layer.max(initial=0)) + 1
    keys = node * count + layer[owner]
    known = np.unique(keys)
    begin = np.searchsorted(known, keys, side="right")
    behind = np.searchsorted(known, (node + 1) * count) - begin
    farther = known[ragged.ranges(begin, behind)] % count
    facet, on = np.divmod(np.unique(np.repeat(owner, behind) * count + farther), count)
    return np.concatenate([np.arange(len(layer)), facet]), np.concatenate([layer, on])


def _apart_from_farther(owner: Ints, node: Ints, layer: Ints) -> Bools:
    """(n,) the facets that have no corner in common with one of a layer behind theirs."""
    farthest = np.zeros(int(node.max(initial=-1)) + 1, dtype=np.intp)
    np.maximum.at(farthest, node, layer[owner])
    return np.asarray(np.bincount(owner, farthest[node] > layer[owner], minlength=len(layer)) == 0.0)


def _dark(faces: ImageFaces, parts: Laid) -> Bools:
    """(n,) the facets that one part of a decal covers, or several that do not overlap."""
    whole, covered = (np.abs(_signed_areas(shapes.points, shapes.offsets)) for shapes in (faces, parts))
    largest = np.zeros(len(whole))
    np.maximum.at(largest, parts.piece, covered)
    together = np.bincount(parts.piece, covered, minlength=len(whole))
    return (largest >= (1.0 - SAME_AREA) * whole) | (np.abs(together - whole) <= SAME_AREA * whole)


def _signed_areas(points: Floats, offsets: Ints) -> Floats:
    """(n,) the areas of polygons of the image, negative for those wound clockwise."""
    after = ragged.following(offsets)
    first = points[:2, np.repeat(offsets[:-1], np.diff(offsets))]
    (x, y), (u, v) = points[:2] - first, points[:2, after] - first
    return np.bincount(ragged.owner(np.diff(offsets)), x * v - y * u, minlength=len(offsets) - 1) / 2.0


def _beside_bright(node: Ints, offsets: Ints, facet: Ints, chart: Ints, dark: Bools) -> Bools:
    """(e,) the facets (e,) on charts (e,) that are not dark (e,), or have a corner in common with one that is not."""
    corner, ends = ragged.take(offsets, facet)
    entry = ragged.owner(np.diff(ends))
    keys = chart[entry] * (int(node.max(initial=0)) + 1) + node[corner]
    found = np.zeros(len(facet), dtype=np.bool_)
    found[entry[np.isin(keys, keys[~dark[entry]])]] = True
    return found


def _mesh(
    points: Floats, offsets: Ints, places: Floats, node: Ints, which: Ints, chart: Ints
) -> tuple[ChartMesh, Ints, Ints]:
    """Some of the polygons with corners (3,c) of the image, places (6,c) and numbers node (c,), on charts, as a mesh;
    (n,) the corner of each of its nodes, and (t,) of which of these polygons each triangle is. Polygons on one chart
    have nodes in common where their numbers are."""
    corner, ends = ragged.take(offsets, which)
    owner = ragged.owner(np.diff(ends))
    keys = chart[owner] * (int(node.max(initial=0)) + 1) + node[corner]
    _, first, number = np.unique(keys, return_index=True, return_inverse=True)
    fans, of = ragged.fans(ends)
    backwards = _signed_areas(points, offsets)[which] < 0.0
    fans = np.where(backwards[of][:, None], fans[:, ::-1], fans)
    triangles = number[fans]
    full = (triangles != np.roll(triangles, 1, axis=1)).all(axis=1)
    fans, triangles, of = fans[full], triangles[full], of[full]
    # Where a side is there twice one way, triangles lie on each other.
    sides = triangles * len(first) + np.roll(triangles, -1, axis=1)
    _, same, often = np.unique(sides, return_inverse=True, return_counts=True)
    alone = (often[same.reshape(-1, 3)] > 1).any(axis=1)
    triangles[alone] = len(first) + np.arange(3 * int(alone.sum())).reshape(-1, 3)
    source = np.concatenate([first, fans[alone].ravel()])
    own = chart[owner[source]]
    covered = np.zeros(len(own), dtype=np.bool_)
    return ChartMesh(own, places[:, corner[source]], covered, triangles), corner[source], of

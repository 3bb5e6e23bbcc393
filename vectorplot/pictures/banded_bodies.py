"""Balls, rods and other quadric bodies painted as wholes: in bands of equal shade within their outlines."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.drawing.painted_fills import Overlay, stacked
from vectorplot.geometry import ragged
from vectorplot.geometry.polygon_cuts import clipped_by_convex
from vectorplot.geometry.projections import Projection
from vectorplot.pictures.plan import is_whole
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.page import Page
from vectorplot.scene.placement import Placement, field_of_vision, fitted_picture
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import NOTHING, View, view_of
from vectorplot.shading.facet_resolution import without_curved_mirror
from vectorplot.shading.palettes import COLOUR_MAP
from vectorplot.shading.shade_bands import (
    Margin,
    ShadeBands,
    ShadedCharts,
    band_widths,
    half_band_steps,
    palette_reaches,
    shade_bands,
)
from vectorplot.shading.shaded_faces import exposed_scene, item_colours, view_eye
from vectorplot.visibility.painter.body_order import BodyCuts, BodyOrder, body_order
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.quadrics.clearances import clearance_of
from vectorplot.visibility.quadrics.visible_parts import (
    Charts,
    QuadricBodies,
    image_boxes,
    quadric_bodies,
    visible_parts,
    with_overlaps,
)

OVERLAP = 2.0
"""So many tolerances mantles go on under flat ends, which are painted on them, so that nothing is seen between them."""

COVERED_MM = 0.4
"""What is hidden by one body, so far within its outline, is not painted: more than a pixel of a screen."""

GRAIN, LEAST_GRAIN_MM = 0.7, 0.35
"""Circles and shadows of a radius cannot be missed by triangles of such a part of it; those of a radius of less than
half a millimetre may be."""


@dataclass(frozen=True, eq=False)
class WholeBodies:
    """The bodies of a scene in the painter's order: scene: what is painted of it; rest: the same with the nearest and
    the farthest point of each body in its place, and view: of that; solids: all bodies as they are; boxes (4,n) in the
    image; charts of what the eye sees."""

    scene: Scene
    rest: Scene
    view: View
    solids: QuadricBodies
    ordered: BodyOrder
    boxes: Floats
    charts: Charts

    @property
    def bodies(self) -> QuadricBodies:
        """Those that are in order, rods without their parts in balls."""
        return self.ordered.bodies

    @property
    def places(self) -> Ints:
        """(n,) of all bodies in their order, 0 for those that are hidden in others."""
        place = np.zeros(len(self.bodies), dtype=np.intp)
        place[self.ordered.order] = np.arange(len(self.ordered.order))
        return place

    def placement(self, page: Page, fit: bool, beside: Floats, faces: ImageFaces | None = None) -> Placement:
        """The place of a picture of the bodies, of places beside them (n,3) in the world, and of faces in the image."""
        view, others = self.view, self.view.points_of(beside)
        corners = np.stack([self.boxes[:2].ravel(), self.boxes[2:].ravel()])
        if faces is not None:
            corners = np.concatenate([corners, faces.points[:2]], axis=1)
        if not fit or view.reaches_too_far(view.points, view.in_image_plane(corners), others):
            return field_of_vision(view, page, fit)
        return fitted_picture(view, page, np.concatenate([corners, view.image_of(others)], axis=1))


@dataclass(frozen=True, eq=False)
class Shade:
    """What things that are no bodies keep dark of charts: a margin as of a light, and how narrow shadows may be."""

    margin: Margin
    narrowest: float


def whole_bodies(shown: Scene, projection: Projection) -> WholeBodies | None:
    """The bodies of a scene, as in has_bodies, in the painter's order; None where they cannot be painted as wholes:
    where they pierce each other but for balls and rods in these, where the eye is in one or near it, or sees a mantle
    all around."""
    scene = replace(shown, items=tuple(without_curved_mirror(item) for item in shown.items))
    some = [number for number, item in enumerate(scene.items) if is_whole(item)]
    bodies = quadric_bodies(projection, [scene.items[number].shape for number in some], some)
    if bodies is None or not len(bodies):
        return None
    every = np.arange(len(bodies))
    along = np.repeat([[0.0], [0.0], [1.0]], len(bodies), axis=1)
    extremes = np.concatenate([bodies.support(along, every), bodies.support(-along, every)], axis=1)
    if projection.eye is not None and not (projection.depth_of(extremes) > projection.near).all():
        return None
    boxes = image_boxes(bodies, projection)
    ordered = body_order(bodies, boxes, projection.tolerance)
    charts = None if ordered is None else visible_parts(ordered.bodies)
    if ordered is None or charts is None:
        return None
    shown_bodies = np.zeros(len(bodies), dtype=np.bool_)
    shown_bodies[ordered.order] = True
    items = list(scene.items)
    for number, ends in zip(some, projection.world_of(extremes).reshape(2, -1, 3).transpose(1, 0, 2), strict=True):
        items[number] = replace(items[number], shape=replace(NOTHING, vertices=ends))
    rest = replace(scene, items=tuple(items))
    charts = charts.take(shown_bodies[charts.body])
    return WholeBodies(scene, rest, view_of(rest, projection), bodies, ordered, boxes, charts)


def banded_fills(
    whole: WholeBodies,
    placement: Placement,
    casts: bool,
    tolerance_mm: float,
    place: Ints,
    shades: Sequence[Shade | None] = (),
) -> tuple[Overlay, float]:
    """The bodies in bands of equal shade, by their places (n,) in the painter's order, as far as the picture shows
    them, and how far their outlines are off on the page, in mm; casts: whether lights cast shadows; shades: for each
    light what else keeps it away."""
    view, bodies = whole.view, whole.bodies
    mm = millimetres(whole, placement)
    charts = with_overlaps(whole.charts, (OVERLAP * tolerance_mm * mm / bodies.sizes[2])[whole.charts.body])
    scene, lights = exposed_scene(view, whole.scene)
    item = bodies.item[charts.body]
    steps, loose = _widths(scene.items, whole, placement, tolerance_mm)
    cuts = _margins(whole.ordered.cuts, charts)
    # Of one item for each material shades are asked.
    looks = {item.material: item for item in scene.items}
    number = {material: k for k, material in enumerate(looks)}
    look = np.array([number[one.material] for one in scene.items], dtype=np.intp)[item]
    sight = view_eye(view)
    hidden = clearance_of(whole.solids, charts.body, Light(sight[:3], parallel=sight[3] == 0.0))
    deep = COVERED_MM * mm

    def cover(chart: Ints, points: Floats) -> Ints:
        return hidden.stopping(chart, points, deep)

    shadows: list[tuple[int, Margin]] = []
    if casts:
        shining = [number for number, light in enumerate(lights) if light.intensity != 0.0]
        shadows = [(number, clearance_of(whole.solids, charts.body, lights[number])) for number in shining]
    least = _grain(whole, bool(shadows))
    for light, shade in enumerate(shades if casts else ()):
        if shade is not None and lights[light].intensity != 0.0:
            shadows.append((light, shade.margin))
            least = np.minimum(least, GRAIN * shade.narrowest)
    grain = np.maximum(least, LEAST_GRAIN_MM * mm)[charts.body]
    shaded = ShadedCharts(
        charts, look, view, list(looks.values()), lights, placement, steps, loose, grain, cuts, shadows, cover
    )
    bands, off_mm = shade_bands(shaded, tolerance_mm)
    return _fills(whole, scene.items, item, bands, placement, place), off_mm


def band_error_steps(whole: WholeBodies, placement: Placement, tolerance_mm: float) -> float | None:
    """By how many of 255 steps colours within bands are off those of the bands, at most."""
    items = whole.scene.items
    steps, _ = _widths(items, whole, placement, tolerance_mm)
    return half_band_steps(palette_reaches(items, whole.bodies.item[whole.charts.body]), steps)


def _grain(whole: WholeBodies, casts: bool) -> Floats:
    """(n,) of bodies how small the circles of their cuts are, and of shadows, where there are any, the bodies."""
    cuts, solids = whole.ordered.cuts, whole.solids
    found = np.full(len(solids), np.inf)
    np.minimum.at(found, cuts.body, GRAIN * cuts.radius)
    if casts:
        least = np.where(solids.is_ball, solids.sizes.min(axis=0), solids.sizes[:2].min(axis=0))
        found = np.minimum(found, GRAIN * float(least.min()))
    return found


def millimetres(whole: WholeBodies, placement: Placement) -> Floats:
    """(n,) how long a millimetre of the page is, in the view, at the depth of each body."""
    view, centre = whole.view, whole.bodies.centre
    near = np.ones(centre.shape[1]) if view.eye is None else view.focus / view.depth_of(centre)
    return np.asarray(1.0 / (near * placement.scale))


def _widths(
    items: Sequence[Item], whole: WholeBodies, placement: Placement, tolerance_mm: float
) -> tuple[Floats, Floats]:
    """As of band_widths, of each chart."""
    bodies, charts = whole.bodies, whole.charts
    radius = (bodies.sizes[0] / millimetres(whole, placement))[charts.body]
    return band_widths(palette_reaches(items, bodies.item[charts.body]), radius, tolerance_mm)


def _margins(cuts: BodyCuts, charts: Charts) -> list[Margin]:
    """The cuts of bodies as margins: of each body one after the other."""
    order = np.argsort(cuts.body, kind="stable")
    turn = ragged.place(np.unique(cuts.body[order], return_counts=True)[1])
    found: list[Margin] = []
    for number in range(int(turn.max(initial=-1)) + 1):
        own = cuts.take(order[turn == number])
        place = np.full(int(max(charts.body.max(initial=-1), own.body.max())) + 1, -1, dtype=np.intp)
        place[own.body] = np.arange(len(own))
        found.append(_Cut(own, place[charts.body]))
    return found


@dataclass(frozen=True, eq=False)
class _Cut:
    """One cut of each of some bodies; of_chart (n,): its number, -1 for charts without."""

    cuts: BodyCuts
    of_chart: Ints

    def __call__(self, chart: Ints, points: Floats) -> Floats:
        """As in Margin; without a cut everything is inside."""
        number = self.of_chart[chart]
        some = np.flatnonzero(number >= 0)
        found = np.ones(len(chart))
        cut = number[some]
        normal = self.cuts.normal[:, cut]
        x, y, z = points[:, some]
        found[some] = self.cuts.height[cut] - (normal[0] * x + normal[1] * y + normal[2] * z)
        return found


def _fills(
    whole: WholeBodies, items: Sequence[Item], item: Ints, bands: ShadeBands, placement: Placement, place: Ints
) -> Overlay:
    found = Fills.flat(
        np.ascontiguousarray(bands.page.T),
        bands.offsets,
        item_colours(items, item[bands.chart], bands.shade, COLOUR_MAP),
        points3d=whole.view.world_of(bands.points),
        item=item[bands.chart],
        kind=FillKind.BAND,
    )
    found = found if placement.whole else _inside(found, placement)
    of_item = np.zeros(len(items), dtype=np.intp)
    of_item[whole.bodies.item] = place
    return stacked([Overlay(found, of_item[found.item])])


def _inside(fills: Fills, placement: Placement) -> Fills:
    """The parts of flat polygons inside the margin of the page."""
    page = placement.page
    low = np.array([page.margin_mm, page.margin_mm])
    high = np.array([page.width_mm, page.height_mm]) - page.margin_mm
    first = fills.offsets[:-1]
    least, most = (extreme.reduceat(fills.points, first) for extreme in (np.minimum, np.maximum))
    inside = ((least >= low) & (most <= high)).all(axis=1)
    cut = np.flatnonzero(~inside & ((least < high) & (most > low)).all(axis=1))
    some = fills.take(cut)
    frame = np.array([[low[0], high[0], high[0], low[0]], [low[1], low[1], high[1], high[1]]])
    points, offsets, of = clipped_by_convex(
        np.concatenate([some.points.T, some.points3d.T]),
        some.offsets,
        np.tile(frame, (1, len(cut))),
        np.arange(0, 4 * len(cut) + 1, 4),
    )
    parts = Fills.flat(
        np.ascontiguousarray(points[:2].T),
        offsets,
        some.colours[some.offsets[of]],
        points3d=np.ascontiguousarray(points[2:].T),
        item=some.item[of],
        kind=some.kind[of],
    )
    whole = np.flatnonzero(inside)
    order = np.argsort(np.concatenate([whole, cut[of]]), kind="stable")
    return Fills.joined(fills.take(whole), parts).take(order)

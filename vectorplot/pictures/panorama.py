"""What is seen all round from a place becomes strokes on a page."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.drawing import NO_CURVE, Drawing, Layer, Paths
from vectorplot.drawing.labels import NO_ITEM, seen_labels
from vectorplot.drawing.layers import layers_asked, line_list, shown_items, sorted_layers
from vectorplot.drawing.letters import lettered
from vectorplot.drawing.pens import Pens, Style, pen_rules, style_of_scene
from vectorplot.drawing.strokes import chosen, concatenated
from vectorplot.errors import InputError
from vectorplot.features.terrain_water import places_on_terrain
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.budget import threads_of
from vectorplot.geometry.camera import MOST_STRIPS, Camera, Panorama
from vectorplot.geometry.elementary import arctan, arctan2, tan
from vectorplot.geometry.mesh import TRIANGLE, Mesh
from vectorplot.geometry.projections import projection_of
from vectorplot.io.anything import scene_of
from vectorplot.pictures.lines import OutputStyle, lines_in_place
from vectorplot.pictures.options import check_options
from vectorplot.pictures.pipeline import Pipeline, StageReport, stoppable
from vectorplot.pictures.plan import plan_panorama
from vectorplot.pictures.prepared_scene import with_face_looks
from vectorplot.scene.added_lines import with_default_lines
from vectorplot.scene.annotations import LabelAnchors, label_anchors, spread
from vectorplot.scene.exploded import shown_apart
from vectorplot.scene.page import Page
from vectorplot.scene.placement import Placement, field_of_vision, fitted_picture, page_of
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look, without_seams
from vectorplot.tolerances import LEAST_DIVISOR
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces
from vectorplot.words import DRAWN, LineKind, line_kinds


@stoppable
def panorama(
    scene: object,
    place: Panorama | Sequence[float],
    *,
    page: Page | str | None = None,
    width: float | str | None = None,
    lines: str | Iterable[str] | None = None,
    crease_angle_deg: float = 25.0,
    style: Style | str | None = None,
    pens: Pens | None = None,
    dashes: str | Mapping[str, str] | Iterable[str] | None = None,
    background: str | None = None,
    layers: str | None = None,
    unplotted: str | Iterable[str] = "",
    curves: str = "bezier",
    tolerance_mm: float = 0.02,
    title: str = "",
    frame: bool = False,
    longest_mm: float | None = None,
    shortest_mm: float | None = None,
    reflections: int = 1,
    budget: float = 1.0,
    jobs: int | None = None,
    progress: Callable[[str, float], None] | None = None,
    explain: Callable[[StageReport], None] | None = None,
) -> Drawing:
    """What is seen of a scene all round from a place, unrolled: bearings along the page, elevations up it.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, surface, curve, or several of these
        See `draw`.
    place : Panorama or sequence of float
        From where, and which part of the round; or only the eye, or x and y on a terrain.
    page, width, lines, crease_angle_deg : see draw
        Items' own lines come first, as there.
    style, pens, dashes, background, layers, unplotted : see draw
        Of a style that shows hidden lines none of them are here.
    curves, tolerance_mm, title, frame, longest_mm, shortest_mm, reflections : see draw
        Lines of smooth surfaces leave as curves, straight ones, which are none here, as polylines.
    budget, jobs, progress, explain : see draw
        Progress is told for each quarter of the round.

    Returns
    -------
    Drawing
        The visible lines in strips that fill the page, below each strip its bearings: a tick every five degrees, and
        the names of the winds; above it the labels of the scene that are seen, as strokes, each with a line to its
        place. Its page_from_world is that of the flat sheet: no matrix unrolls the world.

    Raises
    ------
    InputError
        See `draw` and `Panorama`; for a place of x and y where there is no terrain, and a wireframe.

    Notes
    -----
    Hidden lines are found exactly, by a camera for every quarter of the round; the visible parts are unrolled then, and
    divided until they are within half of the tolerance. Bearings are compass bearings, clockwise from y; the horizon,
    elevation 0, is the height of the eye. Edge cases: what is just above or below the eye, beyond the elevations asked
    for, is not there.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.scene import terrain_scene
    >>> hill = terrain_scene([[2, 3, 2], [3, 1, 3], [2, 3, 2]])
    >>> round_about = vp.panorama(hill, vp.Panorama((1.0, 1.0), above=0.5, strips=1), page="300x100")
    >>> sum(len(strokes) for layer in round_about.layers for strokes in layer.strokes) > 10
    True
    """
    check_options(locals())
    given = scene_of(scene) if lines is not None else with_default_lines(scene_of(scene))
    given = shown_apart(given)
    chosen, own = style_of_scene(given.inks, style)
    if chosen.look != "plain":
        raise InputError(f"panorama: a picture in the style {chosen.look} shows all lines, and a panorama those seen")
    finish = OutputStyle(
        look=chosen.look,
        hidden="none",
        layers=layers_asked(layers, chosen),
        rules=(*chosen.rules, *own, *pen_rules(pens, dashes)),
        background=chosen.background if background is None else background,
        curved_mm=tolerance_mm if curves == "bezier" else None,
        longest_mm=longest_mm,
        title=title,
        frame=frame,
        unplotted=line_list(unplotted),
        shortest_mm=shortest_mm,
    )
    threads = threads_of(jobs)
    round_about = place if isinstance(place, Panorama) else Panorama(tuple(place))
    kinds = line_kinds(DRAWN if lines is None else lines)
    seamless = with_face_looks(without_seams(given))
    eye = eye_of(round_about, seamless)
    sheet = page_of(page, seamless, width)
    pipeline = Pipeline(plan_panorama(), explain, progress, threads)
    anchors = label_anchors(seamless)
    trace = partial(
        _seen_by,
        seamless,
        anchors,
        kinds=kinds,
        crease_angle_deg=crease_angle_deg,
        tolerance_mm=tolerance_mm,
        budget=budget,
        reflections=reflections,
    )
    strokes, marks, names, placement = pipeline.run(
        "panorama",
        panorama_on_page,
        *(round_about, eye, sheet, tolerance_mm, anchors, trace, pipeline.fraction("panorama")),
    )
    named, shown = _names_and_colours(seamless), shown_items(seamless, strokes, np.append(eye, 1.0))
    found = pipeline.run("layers", sorted_layers, strokes, *named, finish.layers, finish.rules, (), shown)
    inks, letters = finish.inked(pipeline, found, placement), finish.letters(found)
    written = (Layer("bearings", letters, (marks,)), *([Layer("label", letters, (names,))] if len(names) else []))
    drawing = finish.drawing((*inks, *written), placement, seamless, letters)
    return finish.of_pens(pipeline, drawing)


def _names_and_colours(scene: Scene) -> tuple[list[str], list[str]]:
    return [item.name for item in scene.items], [item.colour for item in scene.items]


def _seen_by(
    scene: Scene,
    anchors: LabelAnchors,
    camera: Camera,
    page: Page,
    *,
    kinds: frozenset[LineKind],
    crease_angle_deg: float,
    tolerance_mm: float,
    budget: float,
    reflections: int,
) -> tuple[Paths, Ints]:
    """The visible lines of a scene on a page that the picture of a camera fills, and which labels it shows."""
    view = look(scene, camera)
    faces = project_faces(view)
    placement = replace(field_of_vision(view, page, fit=False), page=page)
    lines = lines_in_place(
        scene,
        view,
        faces,
        placement,
        kinds,
        crease_angle_deg=crease_angle_deg,
        tolerance_mm=tolerance_mm,
        budget=budget,
        reflections=reflections,
    )
    return lines, _labels_seen(scene, anchors, view, faces, placement)


def _labels_seen(scene: Scene, anchors: LabelAnchors, view: View, faces: ProjectedFaces, placement: Placement) -> Ints:
    """(k,) the labels, by their numbers, that a picture shows and nothing hides; those of the page are none."""
    there = np.flatnonzero(np.isfinite(anchors.points).all(axis=1))
    numbered = tuple(replace(anchors.labels[k], name=str(k)) for k in there.tolist())
    courses = tuple(anchors.courses[k] for k in there.tolist())
    seen = seen_labels(
        scene, view, faces, placement, LabelAnchors(numbered, anchors.points[there], courses), False, 1.0
    )
    shown = [int(label.name) for label, hidden in zip(seen.anchors.labels, seen.hidden_by, strict=True) if not hidden]
    return np.array(shown, dtype=np.intp)


# The lines that are seen from a place all round, by bearing and elevation.

WIDEST_DEG = 90.0
"""Of one camera: from its middle to its sides 45 degrees, and no line is larger there than twice."""


MOST_HALVINGS = 24
"""Of a line that passes just above or below the eye."""


Trace = Callable[[Camera, Page], tuple[Paths, Ints]]
"""The visible lines that a camera sees on a page that its picture fills, as straight parts of two points; and which of
the places of labels."""


def lines_all_round(
    given: Panorama, eye: Floats, radius_mm: float, trace: Trace, done: Callable[[float], None] | None = None
) -> tuple[Paths, Ints]:
    """The lines that are seen, and which labels.

    Lines are straight parts of two points: bearings and elevations in radians; parts of lines of the world that are
    curves there are not divided yet.

    radius_mm: how long a radian is on the page, for what is only drawn as well as it is seen.
    """
    first, last = np.radians(given.bearings_deg)
    count = int(np.ceil(given.width_deg / WIDEST_DEG))
    half = 0.5 * (last - first) / count
    steepest = np.radians(max(abs(given.lowest_deg), abs(given.highest_deg)))
    # A cone of one elevation is highest in the picture at its sides.
    top, side = float(tan(steepest) / np.cos(half)), float(tan(half))
    page = Page(2.0 * radius_mm * side, 2.0 * radius_mm * top, 0.0)
    found, named, curves = [Paths.empty()], [np.zeros(0, dtype=np.intp)], 0
    for number in range(count):
        bearing = first + (2 * number + 1) * half
        ahead = np.array([np.sin(bearing), np.cos(bearing), 0.0])
        # Far from the origin a unit would be lost in rounding.
        target = eye + max(1.0, float(np.abs(eye).max())) * ahead
        camera = Camera(tuple(eye), tuple(target), up=(0.0, 0.0, 1.0), fov_deg=float(np.degrees(2.0 * arctan(top))))
        seen, names = trace(camera, page)
        named.append(names)
        seen = replace(seen, curve=np.where(seen.curve == NO_CURVE, NO_CURVE, seen.curve + curves))
        curves = max(curves, int(seen.curve.max(initial=NO_CURVE)) + 1)
        found.append(_unrolled(seen, eye, ahead, bearing))
        if done is not None:
            done((number + 1) / count)
    return concatenated(tuple(found)), np.unique(np.concatenate(named))


def _unrolled(seen: Paths, eye: Floats, ahead: Floats, middle: float) -> Paths:
    """The strokes of one camera, by bearing and elevation. middle: the bearing ahead."""
    return replace(
        seen,
        points=bearings_and_elevations(seen.points3d - eye, ahead, middle),
        directions=np.full_like(seen.directions, np.nan),
        handles=np.full_like(seen.handles, np.nan),
    )


def bearings_and_elevations(ways: Floats, ahead: Floats, middle: float) -> Floats:
    """(k,2) of ways (k,3) from the eye, of which those ahead have the bearing middle."""
    right = np.array([ahead[1], -ahead[0], 0.0])
    level = np.hypot(ways[:, 0], ways[:, 1])
    bearing = middle + arctan2(matmul(ways, right), matmul(ways, ahead))
    return np.stack([bearing, arctan2(ways[:, 2], level)], axis=1)


def with_chords(lines: Paths, eye: Floats, apart: float) -> Paths:
    """Lines by bearing and elevation in parts that are so short that none is off its line by more than apart, in
    radians.

    The parts are halved where one sees their middles, as often as needed.
    """
    done = [Paths.empty()]
    for _ in range(MOST_HALVINGS):
        if not len(lines):
            break
        ways = (lines.points3d - eye).reshape(-1, 2, 3)
        flat = lines.points.reshape(-1, 2, 2)
        far = np.linalg.norm(ways, axis=2)
        share = far[:, 0] / np.maximum(far.sum(axis=1), LEAST_DIVISOR)
        middle = ways[:, 0] + share[:, None] * (ways[:, 1] - ways[:, 0])
        seen = _between(middle, flat)
        off = np.linalg.norm(seen - flat.mean(axis=1), axis=1)
        fine: Bools = ~(off > apart) | ~np.isfinite(seen).all(axis=1)
        done.append(chosen(lines, fine))
        flat, ways, middle, seen = flat[~fine], ways[~fine], middle[~fine], seen[~fine]
        lines = chosen(lines, np.repeat(np.flatnonzero(~fine), 2))
        if len(lines):
            both = np.stack([flat[:, 0], seen, seen, flat[:, 1]], axis=1).reshape(-1, 2)
            solid = np.stack([ways[:, 0], middle, middle, ways[:, 1]], axis=1).reshape(-1, 3) + eye
            lines = replace(lines, points=both, points3d=solid)
    return concatenated((*done, lines))


def _between(middle: Floats, flat: Floats) -> Floats:
    """(k,2) bearing and elevation of ways (k,3) between the ends (k,2,2) of parts: of its bearings the one there."""
    turn = 2.0 * np.pi
    bearing = arctan2(middle[:, 0], middle[:, 1])
    bearing += turn * np.round((flat[:, :, 0].mean(axis=1) - bearing) / turn)
    return np.stack([bearing, arctan2(middle[:, 2], np.hypot(middle[:, 0], middle[:, 1]))], axis=1)


# Where the eye of a panorama is that stands on a terrain.

DEFAULT_ABOVE = 1.0 / 500.0
"""How high an eye is above a terrain where nothing is said, by the width of the scene."""


def eye_of(given: Panorama, scene: Scene) -> Floats:
    """(3,) the eye of a panorama in a scene: as it is given, or above the highest triangle at its place.

    Errors: InputError where there is no triangle of a polyhedron at the place.
    """
    if len(given.place) > 2:
        return np.array(given.place)
    heights = []
    cause = "panorama: nothing to stand on: give the place a height"
    for item in scene.items:
        if isinstance(item.shape, Mesh) and item.shape.face_count and (np.diff(item.shape.offsets) == TRIANGLE).all():
            try:
                heights.append(places_on_terrain(item.shape, given.place, "panorama")[1][0, 2])
            except InputError as error:
                cause = error.cause
    if not heights:
        raise InputError(cause)
    above = DEFAULT_ABOVE * float(np.ptp(scene.bounds, axis=0)[:2].max()) if given.above is None else given.above
    return np.array([*given.place, max(heights) + above])


# A panorama on its page: strips of it, one below the other, each with its bearings.

LETTERS_MM = 2.5
"""The height of the capitals of bearings."""


SCALE_MM = 7.0
"""What the bearings below a strip take of the page, and the gap to the next one."""


NAME_LINE_MM, NAME_GAP_MM, NAMES_APART = 3.0, 0.8, 1.6
"""How far the lines of names go on above a strip, what is between these and what is named or written, and how far names
are apart in heights of their capitals."""

TICKS_MM = (1.0, 1.6, 2.2)
"""Of every fifth degree, of every fifteenth, and of those with a name."""


LARGER = 1.25
"""A panorama is traced again where it comes out so many times larger than it was taken for."""


PART_OF_TOLERANCE = 0.4
"""Chords take so much of the tolerance, or a half where the panorama comes out larger by a quarter."""


LEAST_RADIANS = 1.0 / 500.0
"""What is seen is taken for as high as this at least: of a plain one sees a line."""


DEFAULT_RADIANS = 0.2
"""How high what is seen is taken for before it is known."""


WINDS = ("N", "NE", "E", "SE", "S", "SW", "W", "NW")
"""Every eighth of the round."""


@dataclass(frozen=True, eq=False)
class Strips:
    """Where a panorama is on the page: each strip begins at left_mm, and its horizon is at horizons_mm (n,); a radian
    is radius_mm long; low, high: the elevations at the lower and the upper side of strips."""

    page: Page
    radius_mm: float
    left_mm: float
    horizons_mm: Floats
    low: float
    high: float


def panorama_on_page(
    given: Panorama,
    eye: Floats,
    sheet: Page,
    tolerance_mm: float,
    anchors: LabelAnchors,
    trace: Trace,
    done: Callable[[float], None] | None = None,
) -> tuple[Paths, Paths, Paths, Placement]:
    """The lines that are seen from a place all round as strokes on the page, the marks of its bearings, names of what
    is seen, and the place of the flat picture that they are.

    sheet: that the panorama is fitted to, as pictures of cameras are; trace: what a camera sees on a page.
    """
    width = float(np.radians(given.width_deg))
    low, high = np.radians(given.lowest_deg), np.radians(given.highest_deg)
    radius, rooms = _strips(given, sheet, width, 0.0, DEFAULT_RADIANS).radius_mm, _name_rooms(anchors)
    while True:
        seen, which = lines_all_round(given, eye, radius, trace, done)
        lines = _within(with_chords(seen, eye, PART_OF_TOLERANCE * tolerance_mm / radius), 1, low, high)
        names = _names(given, eye, anchors, which, low, high)
        lowest, highest = _extent(lines)
        highest = max(highest, float(names.elevations.max(initial=highest)))
        above = float(rooms[names.which].max(initial=0.0))
        found = _strips(given, sheet, width, lowest, highest, above)
        if found.radius_mm <= LARGER * radius:
            break
        radius = found.radius_mm
    first, part = float(np.radians(given.bearings_deg[0])), width / len(found.horizons_mm)
    strokes = [Paths.empty()]
    for number, horizon in enumerate(found.horizons_mm):
        start = first + number * part
        own = _within(lines, 0, start, start + part)
        points = found.radius_mm * (own.points - (start, 0.0)) + (found.left_mm, horizon)
        strokes.append(replace(own, points=points))
    written = _names_above(names, anchors, found, first, part)
    return concatenated(tuple(strokes)), _scales(given, found), written, _flat(found.page)


def _flat(page: Page) -> Placement:
    """The place of a picture whose world is the page itself."""
    corner = np.array([page.width_mm, page.height_mm, 0.0])
    above = projection_of(Camera.view("top", target=tuple((0.5 * corner).tolist())), np.stack([0.0 * corner, corner]))
    image = above.image_of(above.points_of(np.stack([0.0 * corner, corner])))
    whole = fitted_picture(above, Page(page.width_mm, page.height_mm, 0.0), image)
    return replace(whole, page=page)


def _extent(lines: Paths) -> tuple[float, float]:
    """The lowest and the highest elevation of lines, the horizon where there are none."""
    if not len(lines):
        return 0.0, LEAST_RADIANS
    low, high = float(lines.points[:, 1].min()), float(lines.points[:, 1].max())
    return low, max(high, low + LEAST_RADIANS)


def _radius(strips: int, sheet: Page, width: float, height: float, around: float) -> float:
    """How long a radian may be on a sheet; around: what is above and below each strip in mm."""
    across, up = sheet.room
    return min(strips * across / width, max(up / strips - around, 0.0) / height)


def _strips(given: Panorama, sheet: Page, width: float, low: float, high: float, above: float = 0.0) -> Strips:
    """The strips, as many as are asked for, or as many as make the picture largest; above: what names take above each
    of them, in mm."""
    around = SCALE_MM + above
    counts = (given.strips,) if given.strips else range(1, MOST_STRIPS + 1)
    radius, fewest = max((_radius(count, sheet, width, high - low, around), -count) for count in counts)
    count = -fewest
    if not radius > 0.0 or not math.isfinite(radius):
        radius, count = sheet.room[0] / width, given.strips or 1
    each = radius * (high - low) + around
    page = sheet.around(radius * width / count, count * each)
    left = 0.5 * (page.width_mm - radius * width / count)
    top = 0.5 * (page.height_mm + count * each)
    horizons = np.asarray(top - above - each * np.arange(count) - radius * high, dtype=np.float64)
    return Strips(page, radius, left, horizons, low, high)


def _within(lines: Paths, axis: int, low: float, high: float) -> Paths:
    """What straight parts of two points have between two values of a coordinate; what lies on the higher one only
    stays out where it runs along it."""
    ends = lines.points.reshape(-1, 2, 2)
    values = ends[:, :, axis]
    start, rise = values[:, 0], values[:, 1] - values[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        at = np.stack([(low - start) / rise, (high - start) / rise], axis=1)
    level = rise == 0.0
    inside: Bools = (start >= low) & (start < high)
    at[level] = np.where(inside[level, None], (0.0, 1.0), (2.0, 2.0))
    begin = np.clip(at.min(axis=1), 0.0, 1.0)
    end = np.clip(at.max(axis=1), 0.0, 1.0)
    kept = np.flatnonzero((end > begin) & (at.min(axis=1) < 1.0) & (at.max(axis=1) > 0.0))
    share = np.stack([begin, end], axis=1)[kept][:, :, None]
    parts = chosen(lines, kept)
    ends, solid = parts.points.reshape(-1, 2, 2), parts.points3d.reshape(-1, 2, 3)
    points, space = (each[:, :1] + share * (each[:, 1:] - each[:, :1]) for each in (ends, solid))
    return replace(parts, points=points.reshape(-1, 2), points3d=space.reshape(-1, 3))


# Names of what is seen, above the strips.


@dataclass(frozen=True, eq=False)
class Names:
    """Labels that are seen all round: which (n,), their bearings and elevations (n,) in radians."""

    which: Ints
    bearings: Floats
    elevations: Floats


def _names(given: Panorama, eye: Floats, anchors: LabelAnchors, which: Ints, low: float, high: float) -> Names:
    """Those of the labels, which a camera has seen, that are within a panorama."""
    first, last = np.radians(given.bearings_deg)
    seen = bearings_and_elevations(anchors.points[which] - eye, np.array([0.0, 1.0, 0.0]), 0.0)
    bearing = first + np.mod(seen[:, 0] - first, 2.0 * np.pi)
    kept = (bearing < last) & (seen[:, 1] >= low) & (seen[:, 1] <= high)
    return Names(which[kept], bearing[kept], seen[kept, 1])


def _name_rooms(anchors: LabelAnchors) -> Floats:
    """(l,) how much room labels take above a strip, upright, with their lines."""
    long = [
        float(np.ptp(lettered(label.text, size_mm=label.capitals_mm).bounds[:, 0])) if label.text else 0.0
        for label in anchors.labels
    ]
    return np.array(long, dtype=np.float64) + NAME_LINE_MM + 4.0 * NAME_GAP_MM


def _names_above(names: Names, anchors: LabelAnchors, strips: Strips, first: float, part: float) -> Paths:
    """Names above their strips, upright and apart, each with a line to what it names."""
    lines: list[Floats] = []
    for number, horizon in enumerate(strips.horizons_mm.tolist()):
        own = np.flatnonzero((names.bearings - first >= number * part) & (names.bearings - first < (number + 1) * part))
        if not len(own):
            continue
        labels = [anchors.labels[k] for k in names.which[own].tolist()]
        x = strips.left_mm + strips.radius_mm * (names.bearings[own] - first - number * part)
        y = horizon + strips.radius_mm * names.elevations[own]
        foot = horizon + strips.radius_mm * strips.high + NAME_LINE_MM
        apart = NAMES_APART * max(label.capitals_mm for label in labels)
        rows = zip(labels, x.tolist(), y.tolist(), spread(x, apart).tolist(), strict=True)
        for label, at, height, aside in rows:
            lines.append(np.array([(at, height + NAME_GAP_MM), (aside, foot)]))
            how: dict[str, Any] = {"align": "left", "level": "middle", "rotation_deg": 90.0}
            text = lettered(label.text, (aside, foot + NAME_GAP_MM), size_mm=label.capitals_mm, **how)
            lines += [text.strokes[k] for k in range(len(text.strokes))]
    return _marks(lines)


def _scales(given: Panorama, strips: Strips) -> Paths:
    """Below each strip a line with a tick every five degrees, and the names of the winds."""
    first, last = given.bearings_deg
    count = len(strips.horizons_mm)
    part = (last - first) / count
    lines: list[Floats] = []
    for number, horizon in enumerate(strips.horizons_mm):
        start = first + number * part
        foot = horizon + strips.radius_mm * strips.low - 0.5
        right = strips.left_mm + strips.radius_mm * math.radians(part)
        lines.append(np.array([(strips.left_mm, foot), (right, foot)]))
        for degree in range(5 * math.ceil(round(start / 5.0, 6)), math.floor(round(start + part, 6)) + 1, 5):
            x = strips.left_mm + strips.radius_mm * math.radians(degree - start)
            named = degree % 45 == 0
            long = TICKS_MM[2 if named else 1 if degree % 15 == 0 else 0]
            lines.append(np.array([(x, foot), (x, foot - long)]))
            if named:
                name = WINDS[degree // 45 % 8]
                text = lettered(name, (x, foot - TICKS_MM[2] - 0.8), size_mm=LETTERS_MM, align="centre", level="top")
                lines += [text.strokes[k] for k in range(len(text.strokes))]
    return _marks(lines)


def _marks(lines: Sequence[Floats]) -> Paths:
    """Lines on the page (k,2) as strokes of letters."""
    total = len(lines)
    points = np.concatenate([np.zeros((0, 2)), *lines])
    none = np.zeros(total, dtype=np.intp)
    return Paths(
        points,
        ragged.offsets([len(line) for line in lines]),
        np.zeros(total, dtype=np.bool_),
        np.full(total, int(LineKind.LABEL)),
        none + NO_ITEM,
        none,
        np.column_stack([points, np.zeros(len(points))]),
    )

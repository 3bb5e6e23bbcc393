"""The verb render: a scene becomes pixels, hidden parts found by a depth buffer."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.draw import chart_of, labels_in_place, lines_in_place, seen_part, with_smooth_surfaces
from vectorplot.drawing.strokes.finishing import chain_lines_dashed
from vectorplot.errors import InputError, InputWarning
from vectorplot.features.facets import Within
from vectorplot.geometry.budget import budget_of
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.cameras.projection import CoordinateSystem
from vectorplot.geometry.cameras.unit_projection import projection_of
from vectorplot.geometry.chunks import threads_of
from vectorplot.io.anything import scene_of
from vectorplot.plan import (
    StageReport,
    Walk,
    accuracy_of_render,
    casts_shadow,
    chosen_shadows,
    dims_light,
    plan_render,
    with_accuracy,
)
from vectorplot.scene.naming.annotations import annotation_points, only_annotations
from vectorplot.scene.naming.label_anchors import LabelAnchors, label_anchors
from vectorplot.scene.placement import Placement, allowed_in_space
from vectorplot.scene.point_of_view import camera_of
from vectorplot.scene.scene import Light, Page, Scene
from vectorplot.scene.seamless_scene import without_seams
from vectorplot.scene.twins import without_twins
from vectorplot.scene.unbounded_items import tell_what_is_cut_off
from vectorplot.scene.view import View, view_of
from vectorplot.shading.depth.coplanar import coplanar_faces
from vectorplot.shading.light.face_shades import view_lights
from vectorplot.shading.light.faceted import FacetedScene, faceted
from vectorplot.shading.light.lighting import Blocked, Lighting, lighting_of
from vectorplot.shading.light.palettes import palette
from vectorplot.shading.raster.image import Image
from vectorplot.shading.raster.png import Bytes
from vectorplot.shading.raster.scene_pixels import Picture, opaque_buffer, picture_of, shaded, with_glass, with_mirrors
from vectorplot.shading.raster.scene_triangles import SceneTriangles, scene_triangles
from vectorplot.shading.raster.screen import (
    LARGEST_RASTER_PIXELS,
    LARGEST_SIDE_PIXELS,
    picture_placement,
    pixel_system,
    raster_size,
)
from vectorplot.shading.raster.supersampling import averaged, averaged_light
from vectorplot.shading.shadows.map_settings import MapSettings
from vectorplot.tolerances.of_numbers import LARGEST_VIEW
from vectorplot.visibility.painter.image_faces import outer_sides
from vectorplot.words import LineKind, check_word, line_kinds

if TYPE_CHECKING:
    from vectorplot.drawing.drawing import Paths
    from vectorplot.drawing.fills import Fills
    from vectorplot.drawing.lettering.scene_labels import SceneLabels
    from vectorplot.effects.scales.coloured_scene import ColourBar
    from vectorplot.shading.shadows.seen_region import SeenRegion

SIZE = (800, 600)
"""Columns and rows of a picture if nobody says otherwise."""

SAMPLES = 2
"""Along each side of a pixel, unless told otherwise."""

PIXELS_PER_MM = 96.0 / 25.4
"""How large a millimetre of letters is, as on screens."""

BAR_SAMPLES = 4
"""Along each side of a pixel of a colour bar."""

AROUND_BOX = 0.04
"""Part of a picture that stays free around the places of the numbers of a box."""

LETTER_PIXELS = 1.25
"""The width of the strokes of letters."""

MOST_SAMPLES = 8
"""Along each side of a pixel."""

FACET_PIXELS = 0.2
"""Triangles are off a smooth surface by no more than this part of a pixel."""

LINE_PIXELS = 0.02
"""Lines over a picture are off smooth curves by no more than this part of a pixel."""

BAND_PIXELS = 1 << 22
"""So many pixels are in memory at a time."""

EXACT_POINTS_AT_ONCE = 1 << 20
"""Exact shadows look at all triangles for every portion of points."""

BACKGROUND = "white"
"""The colour behind the scene where neither the scene nor the user names one."""


def render(
    scene: object,
    camera: Camera | str | None = None,
    *,
    size: tuple[int, int] = SIZE,
    fit: bool = True,
    lights: Sequence[Light] | None = None,
    shadows: Literal["auto", "none", "buffer", "trapezoid", "exact"] = "auto",
    shadow_size: int = 1024,
    shadow_bits: int = 32,
    shadow_casters: Literal["all", "away"] = "all",
    shadow_focus: float | None = None,
    samples: int | None = None,
    crease_angle_deg: float = 25.0,
    lines: str | Iterable[str] = (),
    background: str | None = None,
    budget: float = 1.0,
    jobs: int | None = None,
    progress: Callable[[str, float], None] | None = None,
    explain: Callable[[StageReport], None] | None = None,
) -> Image:
    """The scene as a picture of pixels: shaded faces, and smooth surfaces with their true normals.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, surface, curve, or several of these
        What is shown, as of `io.scene_of`.
    camera : Camera or str, optional
        As of draw.
    size : (int, int)
        Columns and rows, in pixels.
    fit : bool
        The picture fills the raster, otherwise the camera's field of vision is its height.
    lights : sequence of Light, optional
        In place of those of the scene.
    shadows : {"auto", "none", "buffer", "trapezoid", "exact"}
        Of these lights, found with shadow buffers, plain ones or such that show most of what is near the eye, or
        exactly; auto: as the view calls for.
    shadow_size : int
        Shadow buffers have shadow_size x shadow_size texels.
    shadow_bits : int
        The bits of each texel.
    shadow_casters : {"all", "away"}
        All faces, or, where all items that cast shadows are closed, only those that turn away from the light, whose
        depths need no margin.
    shadow_focus : float, optional
        A buffer of what is near the eye grows, to four times its side at most, until what is in focus gets such a part
        of the texels of a square one; between 0 and 1.
    samples : int, optional
        Every pixel is the mean light of samples x samples ones, 8 x 8 at most (None: 2 x 2, where there is room for so
        many).
    crease_angle_deg : float
        Faces that meet at less look round; 0 to 180 degrees.
    lines : str or iterable of str
        Words of LineKind, or one text with commas between them, drawn over the picture with exact hidden lines.
    background : str, optional
        A palette, a plain colour or #rrggbb.
    budget : float
        As of draw, for lines and triangles.
    jobs : int, optional
        As of draw.
    progress : callable, optional
        progress(stage, fraction) is called while it works.
    explain : callable, optional
        explain(report) is called while it works, with a StageReport.

    Returns
    -------
    Image
        The pixels, and the title of the scene.

    Raises
    ------
    TypeError
        For what is nothing of that kind.
    InputError
        As of `io.scene_of`.
        For unknown words and colours, impossible cameras, and sizes out of range; for a budget that is not finite and
        positive, and for lights without a direction or too far away.

    Warns
    -----
    InputWarning
        Names what the scene has and pixels do not show: patterns and refraction.

    Notes
    -----
    Degenerate: an empty scene gives the background. Where the scene reaches behind the eye, or more than 60 degrees off
    the principal ray, a fitted picture shows the camera's field of vision. A scene without lights is lit from the eye's
    upper left, which casts no shadows; nor do items that do not occlude. Transparent ones dim and colour light.

    Source: Glaeser, sections 4.5, 6.4, 7.3, 8.5 and 8.6; Martin and Tan; Ressler.

    Examples
    --------
    >>> import vectorplot as vp
    >>> corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> tetrahedron = vp.Mesh.from_triangles(corners, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])
    >>> scene = vp.Scene((vp.Item("tetrahedron", tetrahedron, "blue"),), title="Tetrahedron")
    >>> vp.render(scene, size=(60, 40), background="#ffffff")
    <Image 'Tetrahedron': 60 x 40 pixels>
    """
    kinds = line_kinds(lines)
    samples = _usual_samples(size) if samples is None else samples
    _check_whole(columns=size[0], rows=size[1], samples=samples, shadow_size=shadow_size)
    _check(size, shadows, samples, crease_angle_deg)
    settings = MapSettings(shadow_size, shadow_bits, shadow_casters, shadow_focus)
    budget_of(budget)
    threads = threads_of(jobs)
    given = scene_of(scene)
    chart = chart_of(given, camera)
    given, camera, bar = (given, camera, None) if chart is None else (chart.scene, chart.camera, chart.bar)
    whole, size = size, _left_of_bar(size, bar)
    anchors = label_anchors(given)
    scene = without_seams(given if lights is None else replace(given, lights=tuple(lights)))
    _check_lights(scene.lights)
    tell_what_is_cut_off(scene)
    camera = camera_of(camera, scene)
    scene = seen_part(scene, camera, explain, progress)
    how, why = chosen_shadows(scene, camera, size, fit) if shadows == "auto" else (shadows, "")
    said = accuracy_of_render(FACET_PIXELS, how, shadow_size)
    stages = with_accuracy(plan_render(scene, how, bool(kinds), why), said)
    walk = Walk(stages, explain, progress, threads)
    _tell_what_is_missing(walk, scene, kinds)
    fine = (size[0] * samples, size[1] * samples)
    projection = projection_of(camera, scene.bounds)
    facets = FacetedScene(scene, (None,) * len(scene.items))
    if walk.calls_for("facets"):
        demand = Within(allowed_in_space(scene, projection, Page(*fine, 0.0), fit, FACET_PIXELS))
        shown = without_twins(scene)
        facets = walk.run("facets", faceted, shown, lambda number: demand, budget_of(budget))
    view = walk.run("look", view_of, facets.scene, projection)
    triangles = walk.run("triangles", scene_triangles, view, facets.normals, crease_angle_deg)
    placement = picture_placement(view, *fine, fit, annotation_points(scene))
    if chart is not None and fit:
        placement = chart.around(placement, view, placement.page, AROUND_BOX)
    system = pixel_system(placement)
    here = view_lights(view, scene.lights)
    region = _region(triangles, system, fine, how) if walk.calls_for("shadows") else None
    maps = _Maps(triangles, here, how, settings, region, outer_sides(view))
    lighting = _lighting(walk, scene, view, maps)
    opacity = np.array([item.material.opacity for item in scene.items])
    mirror = np.array([item.material.is_mirror for item in scene.items], dtype=np.bool_)
    paper = palette(background or scene.background or BACKGROUND)[-1].astype(np.float64)
    coplanar = walk.run("coplanar", coplanar_faces, view)
    picture = picture_of(triangles, system, fine, lighting, opacity, mirror, outer_sides(view), coplanar, paper)
    if how == "exact":
        picture = replace(picture, points_at_once=EXACT_POINTS_AT_ONCE)
    pixels = _pixels(walk, picture, samples)
    found = None
    if walk.calls_for("lines"):
        how_far = walk.fraction("lines")
        found = walk.run("lines", _lines, scene, placement, view, crease_angle_deg, budget, kinds, how_far)
        found = chain_lines_dashed(found, placement.page_from_world, samples * PIXELS_PER_MM)
    if walk.calls_for("labels"):
        beside = (scene, placement, view, crease_angle_deg, budget)
        found, labels = walk.run("labels", _with_labels, anchors, found, samples, *beside)
        pixels = _with_blanks(pixels, labels.blanks(palette(background or scene.background or BACKGROUND)[-1:]))
        pixels = _with_lines(pixels, labels.strokes, samples * LETTER_PIXELS)
    if found is not None:
        pixels = _with_lines(pixels, found, float(samples))
    averages = walk.run("average", averaged_light, pixels, samples)
    return Image(averages if bar is None else _beside_bar(averages, bar, whole, paper), scene.title)


def _left_of_bar(size: tuple[int, int], bar: ColourBar | None) -> tuple[int, int]:
    """Columns and rows that a colour bar leaves of a picture."""
    if bar is None:
        return size
    from vectorplot.effects.scales.colour_bar import strip_mm

    return max(1, size[0] - round(strip_mm(size[0] / PIXELS_PER_MM) * PIXELS_PER_MM)), size[1]


def _beside_bar(pixels: Bytes, bar: ColourBar, size: tuple[int, int], paper: Floats) -> Bytes:
    """The pixels of a picture with those of a colour bar to the right of them, on paper (3,)."""
    from vectorplot.backends.raster import painted
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.effects.scales.colour_bar import with_colour_bar

    rows, columns = pixels.shape[:2]
    width, height = columns / PIXELS_PER_MM, rows / PIXELS_PER_MM
    drawing = with_colour_bar(Drawing(width, height, ()), bar, size[0] / PIXELS_PER_MM - width)
    blank = np.broadcast_to(np.rint(paper).astype(np.uint8), (BAR_SAMPLES * rows, BAR_SAMPLES * size[0], 3))
    fine = averaged(painted(blank, drawing), BAR_SAMPLES)
    return np.concatenate([pixels, np.rint(fine[:, columns:]).astype(np.uint8)], axis=1)


def _tell_what_is_missing(walk: Walk, scene: Scene, kinds: frozenset[LineKind]) -> None:
    """Say what paint would show of the scene, and a picture of pixels does not."""
    missing = []
    if any(item.patterns for item in scene.items) and LineKind.PATTERN not in kinds:
        missing.append("patterns (their outlines come with lines of the kind pattern)")
    if any(item.material.is_clear and item.material.refraction != 1.0 for item in scene.items):
        missing.append("refraction")
    if missing:
        warnings.warn(f"not rendered: {', '.join(missing)}; the verb paint shows them", InputWarning, stacklevel=3)
    if scene.lights and any(item.material.is_mirror for item in scene.items):
        walk.tell("left out", "light that mirrors throw back: the verb paint shows it", 0)


def _usual_samples(size: tuple[int, int]) -> int:
    """Along each side of a pixel where nobody says how many."""
    fine = (size[0] * SAMPLES, size[1] * SAMPLES)
    return SAMPLES if max(fine) <= LARGEST_SIDE_PIXELS and fine[0] * fine[1] <= LARGEST_RASTER_PIXELS else 1


def _check(size: tuple[int, int], shadows: str, samples: int, crease_angle_deg: float) -> None:
    check_word("shadows", shadows, ("auto", "none", "buffer", "trapezoid", "exact"))
    if not 1 <= samples <= MOST_SAMPLES:
        raise InputError(f"{samples} samples: expected 1 to {MOST_SAMPLES}")
    if not 0.0 <= crease_angle_deg <= 180.0:
        raise InputError(f"a crease angle of {crease_angle_deg:g} degrees: expected 0 to 180")
    raster_size(*size)
    raster_size(size[0] * samples, size[1] * samples)


def _check_whole(**counts: int) -> None:
    for name, count in counts.items():
        if not float(count).is_integer():
            raise InputError(f"{name} {count:g}: expected a whole number")


def _check_lights(lights: Sequence[Light]) -> None:
    for number, light in enumerate(lights):
        name = f"light {light.name or number}"
        # NaN is not smaller.
        if not all(abs(coordinate) < LARGEST_VIEW for coordinate in light.position):
            raise InputError(f"{name}: a place or direction of {light.position} is out of range")
        if light.parallel and not any(light.position):
            raise InputError(f"{name}: its rays have no direction")


@dataclass(frozen=True, eq=False)
class _Maps:
    """How shadows of some triangles are found: by which way, with what maps, tapered for what is seen (None: not).
    sides (i,): of items that are closed, as of outer_sides."""

    triangles: SceneTriangles
    lights: tuple[Light, ...]
    shadows: str
    settings: MapSettings
    region: SeenRegion | None
    sides: Ints

    def of_items(self, casts: Bools) -> tuple[Blocked, ...]:
        """For every light what it does not reach as items (i,) stand before it."""
        triangles = self.triangles
        shown = casts[triangles.item]
        if self.shadows == "exact":
            from vectorplot.shading.shadows.shadow_rays import exact_shadows

            number = np.where(shown, np.cumsum(shown) - 1, -1)
            return exact_shadows(self.lights, triangles.points, triangles.corners[shown], number)
        from vectorplot.shading.shadows.shadow_buffer import shadow_buffers

        side, corners = self.sides[triangles.item[shown]], triangles.corners[shown]
        settings = self.settings
        if settings.casting == "away":
            # Which way a face turns is known of closed bodies only.
            settings = settings if (side != 0).all() else replace(settings, casting="all")
            corners = np.where((side < 0)[:, None], corners[:, ::-1], corners)
        return shadow_buffers(self.lights, triangles.points, corners, settings, self.region)

    def of_clear_items(self, scene: Scene) -> tuple[tuple[str, float, tuple[Blocked, ...]], ...]:
        """The same for what light comes through: colours and opacities, and what is dimmed by things that have them."""
        groups: dict[tuple[str, float], Bools] = {}
        for number, item in enumerate(scene.items):
            if dims_light(item):
                same = (item.colour, item.material.opacity)
                groups.setdefault(same, np.zeros(len(scene.items), dtype=np.bool_))[number] = True
        return tuple((colour, opacity, self.of_items(casts)) for (colour, opacity), casts in groups.items())


def _lighting(walk: Walk, scene: Scene, view: View, maps: _Maps) -> Lighting:
    """The lights and their shadows, as far as the plan has any."""
    blocked: tuple[Blocked, ...] = ()
    clear: tuple[tuple[str, float, tuple[Blocked, ...]], ...] = ()
    if walk.calls_for("shadows"):
        casts = np.array([casts_shadow(item) for item in scene.items], dtype=np.bool_)
        blocked = walk.run("shadows", maps.of_items, casts)
    if walk.calls_for("transparent shadows"):
        clear = walk.run("transparent shadows", maps.of_clear_items, scene)
    return lighting_of(view, scene.items, maps.lights, blocked, clear)


def _region(
    triangles: SceneTriangles, system: CoordinateSystem, size: tuple[int, int], shadows: str
) -> SeenRegion | None:
    """What is seen, for shadow maps that are tapered for it; None for others."""
    if shadows != "trapezoid":
        return None
    from vectorplot.shading.shadows.seen_region import region_in_picture

    return region_in_picture(system, *size, triangles.points, triangles.corners)


def _pixels(walk: Walk, picture: Picture, samples: int) -> Bytes:
    """(rows, columns, 3) the finer picture, made in bands."""
    result = np.zeros((picture.rows, picture.columns, 3), dtype=np.uint8)
    step = max(1, BAND_PIXELS // (picture.columns * samples)) * samples
    tops = range(0, picture.rows, step)
    for number, top in enumerate(tops):
        bottom = min(top + step, picture.rows)
        band = walk.repetition(("depth", "shading", "mirrors", "transparency"), number, len(tops))
        buffer = band.run("depth", opaque_buffer, picture, top, bottom)
        colours = band.run("shading", shaded, picture, buffer)
        if band.calls_for("mirrors"):
            colours = band.run("mirrors", with_mirrors, picture, buffer, colours)
        if band.calls_for("transparency"):
            colours = band.run("transparency", with_glass, picture, buffer, colours)
        result[top:bottom] = np.rint(colours)
    return result


def _lines(
    scene: Scene,
    placement: Placement,
    view: View,
    crease_angle_deg: float,
    budget: float,
    kinds: frozenset[LineKind],
    progress: Callable[[float], None] | None = None,
) -> Paths:
    """The visible lines of a scene on the page whose millimetres are the pixels of its picture; of no kinds those of
    annotations."""
    scene = scene if kinds else only_annotations(scene)
    return lines_in_place(
        scene,
        *with_smooth_surfaces(scene, view, None),
        placement,
        kinds,
        crease_angle_deg=crease_angle_deg,
        tolerance_mm=LINE_PIXELS,
        budget=budget,
        progress=progress,
    )


def _with_labels(
    anchors: LabelAnchors,
    found: Paths | None,
    samples: int,
    scene: Scene,
    placement: Placement,
    view: View,
    crease_angle_deg: float,
    budget: float,
) -> tuple[Paths | None, SceneLabels]:
    """The lines of a picture, ending before its letters, and its labels; without lines these keep off contours."""
    outlines = frozenset({LineKind.CONTOUR, LineKind.BOUNDARY})
    beside = _lines(scene, placement, view, crease_angle_deg, budget, outlines) if found is None else found
    seen = with_smooth_surfaces(scene, view, None)
    labels = labels_in_place(scene, *seen, placement, anchors, beside, mm=samples * PIXELS_PER_MM)
    return found and labels.interrupted(found, placement.page_from_world), labels


def _with_blanks(pixels: Bytes, blanks: Fills) -> Bytes:
    """The picture with polygons over it."""
    from vectorplot.backends.raster import painted
    from vectorplot.drawing.drawing import Drawing, Layer, Pen

    rows, columns = pixels.shape[:2]
    return painted(pixels, Drawing(float(columns), float(rows), (Layer("blank", Pen(), (blanks,)),)))


def _with_lines(pixels: Bytes, found: Paths, width: float) -> Bytes:
    """The picture with lines of some width in pixels over it."""
    from vectorplot.backends.raster import painted
    from vectorplot.drawing.drawing import Drawing
    from vectorplot.drawing.layers import layers_by_kind
    from vectorplot.drawing.strokes.finishing import long_strokes

    rows, columns = pixels.shape[:2]
    layers = layers_by_kind(long_strokes(found))
    return painted(
        pixels,
        Drawing(
            float(columns),
            float(rows),
            tuple(replace(layer, pen=replace(layer.pen, width_mm=width)) for layer in layers),
        ),
    )

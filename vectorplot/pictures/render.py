"""The verb render: a scene becomes pixels, hidden parts found by a depth buffer."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from vectorplot.drawing.drawing import Pen
from vectorplot.drawing.finishing import chain_lines_dashed, long_strokes, with_dashes
from vectorplot.drawing.layers import overlaid_pens
from vectorplot.drawing.pens import Pens, Style, check_targets, scaled_pen
from vectorplot.errors import InputWarning
from vectorplot.features.edge_splitting import Within
from vectorplot.geometry.budget import budget_of, threads_of
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.projections import projection_of
from vectorplot.io.anything import scene_of
from vectorplot.pictures.facet_errors import facet_error
from vectorplot.pictures.lines import LineOverlay, places_beside_faces
from vectorplot.pictures.options import SHADOWS, check_options
from vectorplot.pictures.pipeline import Pipeline, StageReport, stoppable
from vectorplot.pictures.pixels import (
    PIXELS_PER_MM,
    ShadowMaps,
    check_lights,
    check_whole,
    default_samples,
    default_shadow_size,
    pixels_beside_bar,
    pixels_in_bands,
    pixels_left_of_bar,
    raster_page,
    scene_lighting,
    tapered_for,
)
from vectorplot.pictures.plan import accuracy_of_render, chosen_shadows, plan_render, with_accuracy
from vectorplot.pictures.prepared_scene import Paper, prepared_scene, tell_what_leaves_page
from vectorplot.pictures.promises import RENDERING, promised
from vectorplot.scene.light import Exposure, Light
from vectorplot.scene.pens import DepthCue
from vectorplot.scene.placement import allowed_in_space
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import view_of, without_coincident
from vectorplot.shading.depth_buffers import coplanar_faces
from vectorplot.shading.facet_resolution import FacetedScene, faceted
from vectorplot.shading.image import Image, averaged_light
from vectorplot.shading.map_settings import MapSettings
from vectorplot.shading.palettes import palette
from vectorplot.shading.quadric_pixels import bodies_in_pixels, pixel_bodies, with_extents
from vectorplot.shading.scene_pixels import picture_of
from vectorplot.shading.screen import picture_placement, pixel_system, raster_size, scene_triangles
from vectorplot.shading.shaded_faces import exposed_scene
from vectorplot.visibility.painter.image_faces import outer_sides
from vectorplot.visibility.quadrics.visible_parts import image_boxes
from vectorplot.words import LineKind, check_word, line_kinds

if TYPE_CHECKING:
    pass

SIZE = (800, 600)
"""Columns and rows of a picture if nobody says otherwise."""

LETTER_PIXELS, FAINT = 1.25, 0.5
"""The width of the strokes of letters, and part of it that those of what is hidden have."""

FACET_PIXELS = 0.2
"""Triangles are off a smooth surface by no more than this part of a pixel."""

LINE_PIXELS = 0.02
"""Lines over a picture are off smooth curves by no more than this part of a pixel."""

EXACT_POINTS_AT_ONCE = 1 << 20
"""Exact shadows look at all triangles for every portion of points."""

BACKGROUND = "white"
"""The colour behind the scene where neither the scene nor the user names one."""


@stoppable
def render(
    scene: object,
    camera: Camera | str | None = None,
    *,
    size: tuple[int, int] = SIZE,
    margin_pixels: float | None = None,
    fit: bool = True,
    lights: Sequence[Light] | None = None,
    exposure: Exposure | None = None,
    shadows: Literal["auto", "none", "buffer", "trapezoid", "perspective", "exact"] = "auto",
    shadow_size: int | None = None,
    shadow_bits: int = 32,
    shadow_casters: Literal["all", "away"] = "all",
    shadow_focus: float | None = None,
    samples: int | None = None,
    reflections: int = 1,
    transparency: Literal["blended", "sparse"] = "blended",
    crease_angle_deg: float = 25.0,
    lines: str | Iterable[str] = (),
    style: Style | str | None = None,
    pens: Pens | None = None,
    dashes: str | Mapping[str, str] | Iterable[str] | None = None,
    depth_cue: DepthCue | str | None = None,
    background: str | None = None,
    shortest_mm: float | None = None,
    off_by: float | str | None = None,
    within: float | str | None = None,
    budget: float = 1.0,
    jobs: int | None = None,
    progress: Callable[[str, float], None] | None = None,
    explain: Callable[[StageReport], None] | None = None,
) -> Image:
    """The scene as a picture of pixels: shaded faces, and smooth surfaces with their true normals.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, surface, curve, or several of these
        What is shown, see `io.scene_of`.
    camera : Camera or str, optional
        See draw.
    size : (int, int)
        Columns and rows, in pixels.
    margin_pixels : float, optional
        How many pixels stay free on each side of a picture that fits, as mm of a page do in draw (None: 3 of 100 of the
        shorter side).
    fit : bool
        The picture fills the raster but for its margin, otherwise the camera's field of vision is its height.
    lights : sequence of Light, optional
        In place of those of the scene.
    exposure : float or {"fitted"}, optional
        See paint.
    shadows : {"auto", "none", "buffer", "trapezoid", "perspective", "exact"}
        Of these lights, found with shadow buffers, plain ones or two kinds that show most of what is near the eye, or
        exactly; auto: as the view calls for.
    shadow_size : int, optional
        Shadow buffers have shadow_size x shadow_size texels (None: the power of two no less than the longer side
        of the picture, 256 to 4096).
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
    reflections : int
        See draw: so often mirrors are followed from one to the other, for faces and for lines.
    transparency : {"blended", "sparse"}
        Transparent items are mixed with what is behind them, or set every second, third or fourth pixel, whichever
        comes nearest to their opacity.
    crease_angle_deg : float
        Faces that meet at less look round; 0 to 180 degrees.
    lines : str or iterable of str
        Words of LineKind, or one text with commas between them, drawn over the picture with exact hidden lines.
    style : Style or str, optional
        See draw, without wireframes: its pens, dashes and paper.
    pens : str, Pen, mapping or iterable of str, optional
        See draw, for lines over the picture, 96 pixels an inch; without them lines are a pixel wide.
    dashes : str, mapping or iterable of str, optional
        See draw, for the same lines.
    depth_cue : DepthCue or str, optional
        See draw, for lines over the picture.
    background : str, optional
        A palette, a plain colour or #rrggbb.
    shortest_mm : float, optional
        Lines that are shorter when they are joined are left out, at 96 pixels to the inch; none where None.
    off_by : float or str, optional
        The error that the picture is to keep, pixels, or a text such as "0.2px": number of samples is chosen for it,
        and what was reached is measured.
    within : float or str, optional
        The time that the picture may take, seconds or a text such as "0.5s" or "300ms": it gets as accurate as that
        allows.
    budget : float
        See draw, for lines and triangles.
    jobs : int, optional
        See draw.
    progress : callable, optional
        progress(stage, fraction) is called while it works; what it raises stops the work, amid a stage too.
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
        See `io.scene_of`.
        For unknown words and colours, impossible cameras, and sizes and margins out of range; for a budget that is not
        finite and positive, and for lights without a direction or too far away.

    Warns
    -----
    InputWarning
        Names what the scene has and pixels do not show: patterns and refraction; and implicit surfaces that have no
        points in their boxes.

    Notes
    -----
    Edge cases: an empty scene gives the background. Where the scene reaches behind the eye, or more than 60 degrees off
    the principal ray, a fitted picture shows the camera's field of vision, and what is beside it in the margin. A scene
    without lights is lit from the eye's upper left, which casts no shadows; nor do items that do not occlude.
    Transparent ones dim and colour light.

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
    told = dict(locals())
    check_options(told)
    if off_by is not None or within is not None:
        return promised(render, RENDERING, told)
    check_word("shadows", shadows, SHADOWS["render"])
    kinds = line_kinds(lines)
    samples = default_samples(size) if samples is None else samples
    check_whole(columns=size[0], rows=size[1])
    for times in (1, samples):
        raster_size(size[0] * times, size[1] * times)
    texels = default_shadow_size(size) if shadow_size is None else shadow_size
    check_whole(shadow_size=texels)
    tapered: Literal["trapezoid", "perspective"] = "perspective" if shadows == "perspective" else "trapezoid"
    settings = MapSettings(texels, shadow_bits, shadow_casters, shadow_focus, tapered)
    budget_of(budget)
    threads = threads_of(jobs)
    given = scene_of(scene)
    chosen = overlaid_pens(given.inks, style, pens, dashes)
    sheet = Paper(raster_page(size, margin_pixels, 1.0 / PIXELS_PER_MM), fit)
    prepared = prepared_scene(
        given, camera, sheet, explain, progress, lights=lights, exposure=exposure, depth_cue=depth_cue
    )
    seen, bar = prepared.scene, prepared.bar
    names = tuple(item.name for item in seen.items)
    over = chosen if bar is None else replace(chosen, rules=bar.with_pens(chosen.rules))
    check_targets(over.rules, names)
    check_lights(seen.lights)
    paper = palette(background or over.background or seen.background or BACKGROUND)[-1:]
    whole, size = size, pixels_left_of_bar(size, bar)
    how, why = chosen_shadows(seen, prepared.camera, size, fit) if shadows == "auto" else (shadows, "")
    said = accuracy_of_render(FACET_PIXELS, how, texels)
    pipeline = Pipeline(
        with_accuracy(plan_render(seen, how, bool(kinds), why, reflections), said), explain, progress, threads
    )
    _tell_what_is_missing(pipeline, seen, kinds)
    fine, page = (size[0] * samples, size[1] * samples), raster_page(size, margin_pixels, samples)
    projection = projection_of(prepared.camera, seen.bounds)
    facets, bodies = FacetedScene.of_meshes(seen), None
    if pipeline.calls_for("facets"):
        shown, criterion = without_coincident(seen), Within(allowed_in_space(seen, projection, page, fit, FACET_PIXELS))
        if not pipeline.calls_for("mirrors"):
            bodies = bodies_in_pixels(shown.items, projection)
            shown = shown if bodies is None else with_extents(shown, bodies, projection)
        facets = pipeline.run("facets", faceted, shown, lambda number: criterion, budget_of(budget))
    view = pipeline.run("look", view_of, facets.scene, projection)
    triangles = pipeline.run("triangles", scene_triangles, view, facets.normals, crease_angle_deg)
    beside = places_beside_faces(seen, view, None, page, fit, kinds, LINE_PIXELS, budget)
    if bodies is not None:
        triangles = triangles.take(~np.isin(triangles.item, bodies.item))
        left, right, low, high = image_boxes(bodies, projection)
        corners = projection.in_image_plane(np.array([[left, right], [low, high]]).reshape(2, -1))
        beside = np.concatenate([beside, projection.world_of(corners)])
    placement = picture_placement(view, page, fit, beside)
    if fit:
        placement = prepared.around(placement, view, page, samples * PIXELS_PER_MM)
    pipeline.measured("facets", "samples", facet_error, facets, view, placement)
    system = pixel_system(placement)
    (seen, here), sides = exposed_scene(view, seen), outer_sides(view)
    region = tapered_for(triangles, bodies, system, fine, how) if pipeline.calls_for("shadows") else None
    lighting = scene_lighting(pipeline, seen, view, ShadowMaps(triangles, here, how, settings, region, sides, bodies))
    if lighting.blocked and how != "exact":
        from vectorplot.pictures.pixels import wrong_shadows

        pipeline.measured("shadows", "% wrong", wrong_shadows, seen, triangles, bodies, lighting)
    opacity = np.array([item.material.opacity for item in seen.items])
    mirror = np.array([item.material.is_mirror for item in seen.items], dtype=np.bool_)
    coplanar = pipeline.run("coplanar", coplanar_faces, view)
    behind = paper[0].astype(np.float64)
    picture = picture_of(triangles, system, fine, lighting, opacity, mirror, sides, coplanar, behind)
    if bodies is not None:
        picture = replace(picture, bodies=pixel_bodies(bodies, projection, system, *fine))
    if transparency == "sparse":
        from vectorplot.effects.windows import sparseness

        picture = replace(picture, every=sparseness(opacity), door=samples)
    if how == "exact":
        picture = replace(picture, points_at_once=EXACT_POINTS_AT_ONCE)
    pixels = pixels_in_bands(pipeline, picture, samples, reflections)
    mm = samples * PIXELS_PER_MM
    drawn_by = (crease_angle_deg, LINE_PIXELS, budget, None if shortest_mm is None else shortest_mm * mm, reflections)
    overlay, found = LineOverlay(seen, view, None, placement, *drawn_by), None
    if pipeline.calls_for("lines"):
        found = pipeline.run("lines", overlay.found, kinds, pipeline.fraction("lines"))
        found = chain_lines_dashed(found, placement.page_from_world, mm)
    if pipeline.calls_for("labels"):
        from vectorplot.pictures.pixels import with_blanks, with_lines

        labels = pipeline.run("labels", overlay.labels, prepared.anchors, found, mm=mm)
        tell_what_leaves_page(labels)
        found = found and labels.interrupted(found, placement.page_from_world)
        letters = scaled_pen(over.letters(Pen(LETTER_PIXELS / PIXELS_PER_MM)), mm)
        pixels = with_lines(with_blanks(pixels, labels.blanks(paper)), labels.strokes, letters)
        pixels = with_lines(pixels, labels.faint, scaled_pen(letters, FAINT))
    if found is not None:
        from vectorplot.pictures.pixels import with_layers

        layers = over.layers(long_strokes(found), names, float(samples), mm)
        layers = with_dashes(layers, placement.page_from_world)
        pixels = with_layers(pixels, overlay.cued(layers, pipeline, seen.depth_cue, paper[0].tolist()))
    averages = pipeline.run("average", averaged_light, pixels, samples)
    return Image(pixels_beside_bar(averages, bar, whole, behind), seen.title)


def _tell_what_is_missing(pipeline: Pipeline, scene: Scene, kinds: frozenset[LineKind]) -> None:
    """Say what paint would show of the scene, and a picture of pixels does not."""
    missing = []
    if any(item.patterns for item in scene.items) and LineKind.PATTERN not in kinds:
        missing.append("patterns (their outlines come with lines of the kind pattern)")
    if any(item.material.is_clear and item.material.refraction != 1.0 for item in scene.items):
        missing.append("refraction")
    if scene.scale_bar is not None:
        missing.append("a scale bar")
    if missing:
        warnings.warn(f"not rendered: {', '.join(missing)}; the verb paint shows them", InputWarning, stacklevel=3)
    if scene.lights and any(item.material.is_mirror for item in scene.items):
        pipeline.tell("left out", "light that mirrors throw back: the verb paint shows it", 0)

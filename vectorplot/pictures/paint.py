"""The verb paint: a scene becomes filled polygons, painted back to front; hidden lines by erasing."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Literal

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Drawing, Layer, Paths
from vectorplot.drawing.fills import Colours, FillKind, Fills
from vectorplot.drawing.layers import letter_pen, overlaid_pens
from vectorplot.drawing.painted_fills import fills_on_page, placement_of_faces
from vectorplot.drawing.pens import Pens, Style, check_targets
from vectorplot.errors import InputError
from vectorplot.geometry.budget import budget_of, threads_of
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.projections import projection_of
from vectorplot.io.anything import scene_of
from vectorplot.pictures.facet_errors import outline_error
from vectorplot.pictures.fills import (
    FacePainter,
    VisiblePolygons,
    paper,
)
from vectorplot.pictures.fills import background as background_of
from vectorplot.pictures.lines import PEN, LineOverlay, places_beside_faces
from vectorplot.pictures.options import SHADOWS, check_letters, check_options
from vectorplot.pictures.pipeline import Pipeline, StageReport, stoppable
from vectorplot.pictures.plan import (
    accuracy_of_paint,
    has_banded_surfaces,
    has_bodies,
    plan_bodies,
    plan_paint,
    plan_surface_bands,
    with_accuracy,
)
from vectorplot.pictures.prepared_scene import Legend, Paper, prepared_scene, room_for_labels, titled
from vectorplot.pictures.promises import PAINTING, promised
from vectorplot.scene.added_lines import with_default_lines
from vectorplot.scene.light import Exposure, Light
from vectorplot.scene.page import Page
from vectorplot.scene.pens import DepthCue, depth_cue_of
from vectorplot.scene.placement import FittedPage, page_of
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, without_coincident
from vectorplot.shading.palettes import PALETTE_SIZE, shaded_colours
from vectorplot.shading.shaded_faces import item_colours
from vectorplot.words import ON_THINGS, LineKind, check_word, line_kinds

# Blank polygons with the visible lines on them: hidden lines by erasing.


def erased(
    pipeline: Pipeline, seen: VisiblePolygons, scene: Scene, ruler: LineOverlay, kinds: frozenset[LineKind], size: int
) -> Fills:
    """Blank polygons, and the lines of the scene on them."""
    from vectorplot.drawing.painted_fills import erased_fills, line_fills

    view, faces = seen.view, seen.faces
    blank = fills_on_page(
        view,
        faces.points,
        faces.offsets,
        seen.placement,
        colours=np.repeat(paper(scene), faces.points.shape[1], axis=0),
        opacity=np.ones(len(faces)),
        item=view.face_item[faces.source],
        kind=np.full(len(faces), int(FillKind.BACKGROUND)),
    )
    drawn = pipeline.run("outlines", _coloured_strokes, scene, ruler, kinds, size)
    lines = Fills.joined(*(line_fills(strokes, ink) for strokes, ink in drawn))
    return pipeline.run("erasing", erased_fills, blank, lines, PEN.width_mm)


def _coloured_strokes(
    scene: Scene, ruler: LineOverlay, kinds: frozenset[LineKind], size: int
) -> list[tuple[Paths, Colours]]:
    """The visible lines of a scene, and their inks (m,3): the middle shades of the palettes of items, and of those of
    patterns."""
    from vectorplot.drawing.strokes import chosen
    from vectorplot.shading.illumination import MIDDLE

    strokes = ruler.strokes(scene, kinds)
    plain = chosen(strokes, strokes.kind != LineKind.PATTERN)
    found = [(plain, item_colours(scene.items, plain.item, np.full(len(plain), MIDDLE), size))]
    colours = dict.fromkeys(pattern.colour for item in scene.items for pattern in item.patterns)
    for colour in colours if (strokes.kind == LineKind.PATTERN).any() else ():
        items = (replace(i, patterns=tuple(p for p in i.patterns if p.colour == colour)) for i in scene.items)
        strokes = ruler.strokes(replace(scene, items=tuple(items)), kinds)
        own = chosen(strokes, strokes.kind == LineKind.PATTERN)
        found.append((own, shaded_colours((colour,), np.zeros_like(own.item), np.full(len(own), MIDDLE), size)))
    return found


# The verb paint: a scene becomes filled polygons on a page, painted back to front.


@stoppable
def paint(
    scene: object,
    camera: Camera | str | None = None,
    *,
    page: Page | str | None = None,
    width: float | str | None = None,
    fit: bool = True,
    lights: Sequence[Light] | None = None,
    exposure: Exposure | None = None,
    shadows: Literal["auto", "none"] = "auto",
    aura_mm: float = 0.0,
    palette: int = PALETTE_SIZE,
    smooth: bool = True,
    reflections: int = 1,
    fills: Literal["painted", "visible", "erasing"] = "painted",
    lines: str | Iterable[str] = (),
    crease_angle_deg: float = 25.0,
    style: Style | str | None = None,
    pens: Pens | None = None,
    dashes: str | Mapping[str, str] | Iterable[str] | None = None,
    depth_cue: DepthCue | str | None = None,
    background: str | None = None,
    tolerance_mm: float = 0.02,
    title: str = "",
    frame: bool = False,
    text: Literal["strokes", "real"] = "strokes",
    shortest_mm: float | None = None,
    font: str | None = None,
    off_by: float | str | None = None,
    within: float | str | None = None,
    budget: float = 1.0,
    jobs: int | None = None,
    progress: Callable[[str, float], None] | None = None,
    explain: Callable[[StageReport], None] | None = None,
) -> Drawing:
    """The scene as filled polygons on a page, each painted over those behind it.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, surface, curve, or several of these
        What is painted, as of `io.scene_of`.
    camera : Camera or str, optional
        As in draw.
    page : Page or str, optional
        As in draw.
    width : float or str, optional
        As in draw.
    fit : bool
        The picture fills the page but for its margin; otherwise the page centre is the target and the page height the
        camera's picture height.
    lights : sequence of Light, optional
        In place of those of the scene.
    exposure : float or {"fitted"}, optional
        What the intensities of all lights are taken times; fitted: so that the brightest face that is seen is as bright
        as lights can make it, wherever shadows fall. Where None, that of the scene.
    shadows : {"auto", "none"}
        Whether lights cast any.
    aura_mm : float
        The width of their soft borders in mm.
    palette : int
        How many shades every colour has; 2 to 256.
    smooth : bool
        Smooth surfaces, meshes that look round and planes on which the light varies are shaded from corner to corner;
        otherwise every plane has one shade.
    reflections : int
        As in draw: so often mirrors are followed from one to the other, for polygons and for lines.
    fills : {"painted", "visible", "erasing"}
        Polygons painted one over the other, or only what is seen of each, for pens, which cannot paint over things,
        with transparent ones as sparse lines; or blank, with the visible lines on them: hidden lines by erasing.
    lines : str or iterable of str
        Words of LineKind, or one text with commas between them, drawn on top with exact hidden lines, or on blank
        polygons (none: all kinds).
    crease_angle_deg : float
        Sharper edges are creases, and meshes look round where faces meet at less; 0 to 180 degrees.
    style : Style or str, optional
        As in draw, without wireframes: its pens, dashes and paper.
    pens : str, Pen, mapping or iterable of str, optional
        As in draw, for lines on top.
    dashes : str, mapping or iterable of str, optional
        As in draw, for the same lines.
    depth_cue : DepthCue or str, optional
        As in draw, for lines on top; with blank polygons, whose lines have the shades of items, only none.
    background : str, optional
        The colour of the paper, in place of that of the scene.
    tolerance_mm : float
        How many mm the sides of polygons may be off smooth surfaces and refracted lines; shades along their sides may
        be off by two steps of 255 at 0.02 mm, and in proportion by one to eight.
    title : str
        Letters in the middle of the lower margin.
    frame : bool
        A rectangle in the middle of the margin, which ends before the title.
    text : {"strokes", "real"}
        As in draw.
    shortest_mm : float, optional
        Lines that are shorter when they are joined are left out; none where None.
    font : str, optional
        As in draw.
    off_by : float or str, optional
        The error that the picture is to keep, mm, a text such as "0.01mm", or
        with the error of shades, in steps of 255, "0.01mm,4shades": tolerance_mm is chosen for it,
        and what was reached is measured.
    within : float or str, optional
        The time that the picture may take, seconds or a text such as "0.5s" or "300ms": it gets as accurate as that
        allows.
    budget : float
        As in draw, for lines and triangles.
    jobs : int, optional
        As in draw.
    progress : callable, optional
        progress(stage, fraction) is called while it works; what it raises stops the work, amid a stage too.
    explain : callable, optional
        explain(report) is called while it works, with a StageReport.

    Returns
    -------
    Drawing
        The page in mm: a layer of fills, and where lines are asked for those of the lines on top.

    Raises
    ------
    TypeError
        For what is nothing of that kind.
    InputError
        As of `io.scene_of`.
        For unknown words and colours, impossible cameras, and widths and counts out of range; for a tolerance or a
        budget that is not finite and positive.

    Warns
    -----
    InputWarning
        For what the budget did not do; for implicit surfaces that have no points in their boxes.

    Notes
    -----
    Edge cases: an empty scene gives an empty page. Where the scene reaches behind the eye, or more than 60 degrees off
    the principal ray, a fitted picture shows the camera's field of vision. A scene without lights is lit from the eye's
    upper left, which casts no shadows.

    Source: Glaeser, chapters 4.5, 5 and 6.

    Examples
    --------
    >>> import vectorplot as vp
    >>> corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> tetrahedron = vp.Mesh.from_triangles(corners, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])
    >>> scene = vp.Scene((vp.Item("tetrahedron", tetrahedron, "blue"),))
    >>> drawing = vp.paint(scene, lights=[vp.Light((3, -1, 4))], lines="contour")
    >>> [layer.name for layer in drawing.layers]
    ['fills', 'visible', 'contour']
    """
    told = dict(locals())
    check_options(told)
    check_letters(font, text)
    if off_by is not None or within is not None:
        return promised(paint, PAINTING, told)
    check_word("shadows", shadows, SHADOWS["paint"])
    if fills == "erasing" and depth_cue_of(depth_cue) is not None:
        raise InputError("depth_cue does not go with fills that are erasing, whose lines have the shades of items")
    budget_of(budget)
    threads = threads_of(jobs)
    given, kinds = scene_of(scene), line_kinds(lines)
    if fills == "erasing" and LineKind.OUTLINE in kinds:
        raise InputError("lines: an outline does not go with fills that are erasing, whose lines are those of items")
    if fills == "erasing" and not kinds:
        given = with_default_lines(given)
    chosen = overlaid_pens(given.inks, style, pens, dashes)
    if fills == "erasing" and (style is not None or pens is not None or dashes is not None):
        raise InputError("style, pens and dashes do not go with fills that are erasing, whose lines are those of items")
    sheet = page_of(page, given, width, fit)
    subject = prepared_scene(
        given,
        camera,
        Paper(sheet, fit),
        explain,
        progress,
        lights=lights,
        exposure=exposure,
        background=chosen.background if background is None else background,
        depth_cue=depth_cue,
    )
    scene, bar = subject.scene, subject.bar
    names = tuple(item.name for item in scene.items)
    over = chosen if bar is None else replace(chosen, rules=bar.with_pens(chosen.rules))
    check_targets(over.rules, names)
    legend = Legend(sheet, bar, scene.scale_bar, text)
    sheet = legend.room
    stages = with_accuracy(plan_paint(scene, shadows, fills, kinds, reflections), accuracy_of_paint(tolerance_mm))
    if smooth and fills == "painted" and subject.chart is None and not aura_mm:
        stages = plan_surface_bands(stages) if has_banded_surfaces(scene) else stages
        stages = plan_bodies(stages) if has_bodies(scene) else stages
    pipeline = Pipeline(stages, explain, progress, threads)
    projection = projection_of(subject.camera, scene.bounds)
    # Lines belong to each item, polygons to what is seen.
    shown = scene if kinds or fills == "erasing" else without_coincident(scene)

    drawn = kinds or line_kinds(ON_THINGS if fills == "erasing" else ())
    casts, limits = shadows != "none" and bool(scene.lights), budget_of(budget)
    painter = FacePainter(
        pipeline,
        scene,
        projection,
        sheet,
        fit,
        casts,
        smooth,
        fills,
        palette,
        crease_angle_deg,
        aura_mm,
        tolerance_mm,
        limits,
        reflections,
    )
    among = None
    if pipeline.calls_for("bodies"):
        from vectorplot.pictures.bodies_among_faces import painted_bodies

        def beside_bodies(view: View) -> Floats:
            return places_beside_faces(scene, view, None, sheet, fit, drawn, tolerance_mm, budget)

        among = painted_bodies(painter, shown, beside_bodies)
    if among is not None:
        view, placement, polygons = among
        drawn_by = (crease_angle_deg, tolerance_mm, budget, shortest_mm, reflections, True)
        ruler = LineOverlay(scene, view, None, placement, *drawn_by)
    else:
        ordered = painter.ordered(shown)
        beside = places_beside_faces(scene, ordered.view, None, sheet, fit, drawn, tolerance_mm, budget)
        placement = placement_of_faces(ordered.view, ordered.faces, sheet, fit, beside)
        if fit:
            placement = subject.around(placement, ordered.view, sheet)
        pipeline.measured("facets", "mm", outline_error, ordered.facets, ordered.view, placement)
        seen, lighting = painter.seen(ordered, placement)
        drawn_by = (crease_angle_deg, tolerance_mm, budget, shortest_mm, reflections, True)
        ruler = LineOverlay(scene, seen.view, seen.projected, placement, *drawn_by)
        if pipeline.calls_for("erasing"):
            polygons = erased(pipeline, seen, scene, ruler, kinds or line_kinds(ON_THINGS), palette)
        else:
            painted = painter.coloured(seen, lighting)
            polygons = painted.fills
        for stage in ("order", "shadows"):
            pipeline.measured(stage, "mm", lambda: seen.view.tolerance * placement.scale)
    page, world = placement.page, placement.page_from_world
    if pipeline.calls_for("visible fills"):
        from vectorplot.drawing.fill_visibility import visible_shades

        curved = np.array([normals is not None for normals in ordered.facets.normals], dtype=np.bool_) & smooth
        polygons = pipeline.run("visible fills", visible_shades, painted, curved, world)
    if pipeline.calls_for("screen door"):
        from vectorplot.effects.windows import screened

        polygons = pipeline.run("screen door", screened, polygons, PEN.width_mm, world)
    layers: tuple[Layer, ...] = (Layer("fills", PEN, (polygons,)),)
    found = (
        pipeline.run("lines", ruler.found, kinds, pipeline.fraction("lines")) if pipeline.calls_for("lines") else None
    )
    labels = None
    if pipeline.calls_for("labels"):
        labels = pipeline.run("labels", ruler.labels, subject.anchors, found, text)
        found = found and labels.interrupted(found, world)
        from vectorplot.drawing.fill_visibility import cut_out

        blanks = labels.blanks(paper(scene))
        polygons = cut_out(polygons, blanks, world) if fills == "visible" else Fills.joined(polygons, blanks)
        layers = (replace(layers[0], marks=(polygons,)),)
    if found is not None:
        lines_ = over.layers(found, names)
        layers += ruler.layers(lines_, pipeline, scene.depth_cue, paper(scene)[0].tolist())
    letters = over.letters(letter_pen(layers))
    if labels is not None:
        layers = labels.on_top(layers, False, None, world, letters)
        layers, placement = room_for_labels(layers, placement, labels, sheet)
        if isinstance(sheet, FittedPage):
            page, world = placement.page, placement.page_from_world
            layers = (replace(layers[0], marks=(*background_of(scene, page), *layers[0].marks)), *layers[1:])
    layers = titled(layers, placement, title, frame, over.border(letters), text=text)
    drawing = Drawing(page.width_mm, page.height_mm, layers, names, scene.title, world)
    drawing = drawing if font is None else replace(drawing, font=font)
    return legend.around(drawing, scene.background)

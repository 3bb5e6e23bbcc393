"""The verb draw: a scene becomes strokes on a page."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING, Literal

import numpy as np

from vectorplot.arrays import Bools
from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.drawing.drawn_lines import fitted_lines, strokes_on_page
from vectorplot.drawing.hatching.hatch_layers import hatch_layers
from vectorplot.drawing.layers import FRAME_PEN, letter_pen
from vectorplot.drawing.pens.paper import pen_scale, sheet_layer
from vectorplot.drawing.pens.pen_rules import PenRule, Pens, frame_pen, pen_of, pen_rules, scaled_pen
from vectorplot.drawing.pens.sorted_layers import layer_words, line_list, not_plotted, sorted_layers
from vectorplot.drawing.pens.style_file import style_of
from vectorplot.drawing.pens.styles import Style
from vectorplot.drawing.strokes.finishing import inked
from vectorplot.drawing.strokes.shared_kinds import with_shared_kinds
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.budget import Budget, budget_of, line_each
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.chunks import threads_of
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.anything import scene_of
from vectorplot.plan import StageReport, Walk, accuracy_of_draw, plan_cuts, plan_draw, plan_hatching, with_accuracy
from vectorplot.scene.fitted_pages import FittedPage
from vectorplot.scene.hatching import Hatching, Stippling
from vectorplot.scene.naming.label_anchors import LabelAnchors, label_anchors
from vectorplot.scene.placement import Placement, fitted_picture, mm_per_image
from vectorplot.scene.point_of_view import camera_of, page_of
from vectorplot.scene.scene import Page, Scene
from vectorplot.scene.seamless_scene import without_seams
from vectorplot.scene.unbounded_items import tell_what_is_cut_off
from vectorplot.scene.view import View, look, view_of
from vectorplot.tolerances.of_extent import FINEST_CHORD_OF_EXTENT
from vectorplot.visibility.cut_edges import with_kinds_of_cuts
from vectorplot.visibility.framing import frame_of, in_frame
from vectorplot.visibility.polyhedra.hidden_lines import Visibility, counted_parts, visible_parts, with_whole_lines
from vectorplot.visibility.polyhedra.lines import (
    Lines,
    edge_lines,
    intersection_lines,
    joined_lines,
    mesh_curve_lines,
    pattern_lines,
)
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.polyhedra.pairs import Segments
from vectorplot.visibility.projected_faces import ProjectedFaces, project_faces
from vectorplot.words import DRAWN, TEXT_WORDS, WIRES, LineKind, check_colour, check_word, line_kinds

if TYPE_CHECKING:
    from vectorplot.drawing.lettering.scene_labels import SceneLabels
    from vectorplot.effects.scales.coloured_scene import ColourBar
    from vectorplot.effects.scales.scaled_scene import Scaled
    from vectorplot.visibility.quadrics.closed_forms import ClosedForms, Seen
    from vectorplot.visibility.smooth.tracing.meetings import SmoothSheet
    from vectorplot.visibility.smooth.tracing.traced import TracedScene

LARGER = 1.25
"""Curves are traced anew where they come out so many times larger on the page than they were taken for."""

SHORTEST_MM = 1.0
"""To parts shorter than this no stroke is cut: it would be dots."""


def draw(
    scene: object,
    camera: Camera | str | None = None,
    *,
    page: Page | str | None = None,
    width: float | str | None = None,
    fit: bool = True,
    lines: str | Iterable[str] | None = None,
    crease_angle_deg: float = 25.0,
    style: Style | str = "plain",
    hidden: Literal["none", "dashed", "solid"] | None = None,
    pens: Pens | None = None,
    dashes: str | Mapping[str, str] | Iterable[str] | None = None,
    scale_pens: bool = False,
    thin_ends: bool = False,
    background: str | None = None,
    halo_mm: float = 0.0,
    hatch: Hatching | Stippling | None = None,
    layers: str | None = None,
    unplotted: str | Iterable[str] = "",
    curves: Literal["bezier", "polyline"] = "bezier",
    tolerance_mm: float = 0.02,
    title: str = "",
    frame: bool = False,
    text: Literal["strokes", "real"] = "strokes",
    longest_mm: float | None = None,
    budget: float = 1.0,
    jobs: int | None = None,
    progress: Callable[[str, float], None] | None = None,
    explain: Callable[[StageReport], None] | None = None,
) -> Drawing:
    """The scene as strokes on a page, hidden lines found by geometry.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, surface, curve, or several of these
        What is drawn, as of `io.scene_of`.
    camera : Camera or str, optional
        Or the name of a main view, such as "front" or "iso"; where None that of the scene, else default_camera.
    page : Page or str, optional
        Or its name or size, such as "A4", "A5 landscape" or "200x150"; where None that of the scene, else A4. Of "fit"
        the latter, cut to the picture and its margin.
    width : float or str, optional
        In mm, or with its unit, such as "8cm" (mm, cm, in, pt): the page is as wide, and as high as its picture is
        then; of page it has the margin.
    fit : bool
        The picture fills the page but for its margin; otherwise the page centre is the target and the page height the
        camera's picture height.
    lines : str or iterable of str, optional
        Words of LineKind, or one text with commas between them, DRAWN or WIRES where None; an item's own come first.
    crease_angle_deg : float
        Sharper edges are creases; 0 to 180 degrees.
    style : Style or str
        plain, plotter, book, draft, blueprint, or a file that ends in .toml; or a wireframe: nothing hides anything,
        all lines have the middle shades of their items' palettes (wireframe), or go by their depth (depth-cue), on a
        sheet in the scene's background or the darkest gray.
    hidden : {"none", "dashed", "solid"}, optional
        Hidden lines are left out, dashed, or solid on a layer of their own; as the style says where None.
    pens : str, Pen, mapping or iterable of str, optional
        What draws lines by kind, by item and by both, before what the style says: WIDTH, COLOUR or WIDTH:COLOUR, as in
        "contour=0.5:black,hidden=0.18:gray,house=red,house.crease=0.2"; widths in mm, or with their unit (1.4pt). What
        no kind and no item stands before is for all lines.
    dashes : str, mapping or iterable of str, optional
        DASH,GAP in mm, or with their units, by kind, item and both, as in "hidden=3,1"; or none.
    scale_pens : bool
        Widths and dashes are those on A4, and in proportion to it on other pages.
    thin_ends : bool
        Lines that converge, as in the apex of a cone, stop early in turn, before their ink makes a blot.
    background : str, optional
        The colour of the paper, drawn on a layer that is not plotted; as the style says where None.
    halo_mm : float
        Lines end so many mm beside what is in front of them.
    hatch : Hatching or Stippling, optional
        How visible faces are hatched, or stippled, where their items do not say it themselves; not at all where None.
    layers : str, optional
        What shares a layer: kind, object or colour, or several of these with commas between them; as the style says
        where None.
    unplotted : str or iterable of str
        The names of layers that plotters skip; kinds, items and colours of which the picture shows nothing may be among
        them.
    curves : {"bezier", "polyline"}
        Strokes of smooth curves are fitted with cubic Béziers and elliptic arcs, or stay polylines.
    tolerance_mm : float
        How many mm strokes of smooth curves may be off the true curves; their points are exact but for the ends of
        dashes, straight lines are so whatever it is.
    title : str
        Letters in the middle of the lower margin.
    frame : bool
        A rectangle in the middle of the margin, which ends before the title.
    text : {"strokes", "real"}
        Letters of labels and titles are strokes of the pen; or texts, set in fonts by what reads the file.
    longest_mm : float, optional
        Longer strokes leave in equal parts that are no longer, for plotters that stutter on them; 1 mm or more.
    budget : float
        How many times the usual work on smooth surfaces is allowed (see geometry.budget).
    jobs : int, optional
        On how many threads the stages that go over chunks work; where None, on all processors. The result is the same.
    progress : callable, optional
        progress(stage, fraction) is called while it works.
    explain : callable, optional
        explain(report) is called while it works, with a StageReport.

    Returns
    -------
    Drawing
        The page in mm with its layers, the names of the items, and the matrix page_from_world.

    Raises
    ------
    InputError
        As of `io.scene_of`.
        For unknown words and layers, impossible cameras, and widths and angles out of range; for a tolerance or a
        budget that is not finite and positive; for hidden lines, a halo, a hatching or layers other than by kind in a
        wireframe, which has colours of its own.
    TypeError
        For what is nothing of that kind.

    Warns
    -----
    InputWarning
        Where a picture shows so little of the scene that the tolerance cannot be kept, and what the budget did not do
        for.

    Notes
    -----
    Degenerate: an empty scene gives an empty page. Where the scene reaches behind the eye, or more than 60 degrees off
    the principal ray, a fitted picture shows the camera's field of vision, on a whole page.

    Source: Glaeser, sections 2.1, 4.4 and 7.2.

    Examples
    --------
    >>> import vectorplot as vp
    >>> corners = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    >>> tetrahedron = vp.Mesh.from_triangles(corners, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])
    >>> scene = vp.Scene((vp.Item("tetrahedron", tetrahedron),))
    >>> drawing = vp.draw(scene, vp.Camera((4, 3, 2)), page=vp.Page(100, 80), hidden="solid")
    >>> drawing.width_mm, drawing.height_mm
    (100, 80)
    >>> [layer.name for layer in drawing.layers if len(layer.strokes[0])]
    ['contour', 'hidden']
    """
    chosen = style_of(style)
    asked = pen_rules(pens, dashes)
    hidden = chosen.hidden if hidden is None else hidden
    layers = chosen.layers if layers is None else layers
    _check_options(hidden, layers, curves, halo_mm, crease_angle_deg, tolerance_mm)
    _check_longest(longest_mm)
    check_word("text", text, TEXT_WORDS)
    allowed, threads = budget_of(budget), threads_of(jobs)
    shown = chosen.look
    others = {"halo_mm": halo_mm > 0.0, "hatch": hatch is not None, "layers": layers != "kind", "pens": bool(asked)}
    _check_style(shown, hidden=hidden != "none", **others)
    kinds = line_kinds((DRAWN if shown == "plain" else WIRES) if lines is None else lines)
    given = scene_of(scene)
    chart = chart_of(given, camera)
    given, camera, bar = (given, camera, None) if chart is None else (chart.scene, chart.camera, chart.bar)
    rules = (*(() if bar is None else bar.pens), *asked)
    anchors, scene = label_anchors(given), without_seams(given)
    tell_what_is_cut_off(scene)
    camera = camera_of(camera, scene)
    scene = seen_part(scene, camera, explain, progress)
    sheet, strip = left_of_bar(page_of(page, scene, width, fit), bar)
    smooth = curves == "bezier" and any(not isinstance(item.shape, Mesh) for item in scene.items)
    planned = plan_draw(scene, kinds, hidden, halo_mm, shown)
    if shown == "plain":
        planned = plan_hatching(scene, hatch, planned)
    stages = with_accuracy(planned, accuracy_of_draw(tolerance_mm, smooth))
    walk = Walk(stages, explain, progress, threads)
    view = walk.run("look", look, scene, camera)
    faces = walk.run("faces", project_faces, view)
    solid = solid_items(view, faces)
    straight = _straight_lines(walk, scene, view, faces, solid, kinds, crease_angle_deg)
    forms = _closed_forms(walk, scene, view, kinds)
    sheets = _sheets(walk, scene, view, forms)
    balls = () if forms is None else (forms.reached,)
    reached = np.concatenate([view.points, *balls, *(sheet.vertices.T for sheet in sheets)], axis=1)
    scale = mm_per_image(view, reached, sheet, fit)
    while True:
        # Chords take one half of the tolerance, Béziers through their ends the other.
        tolerance = 0.5 * tolerance_mm / scale
        every = _lines_and_chords(walk, scene, view, sheets, forms, kinds, straight, tolerance, allowed)
        bounded = frame_of(view, every, sheet, fit)
        framed = _behind_balls(walk, view, forms, walk.run("frame", in_frame, view, every, bounded))
        seen = _visibility(walk, view, faces, solid, framed)
        placement = bounded or fitted_lines(view, framed, seen, sheet)
        if bounded is None and not len(seen) and walk.calls_for("hatching"):
            # Without lines the picture is that of the faces.
            placement = fitted_picture(view, sheet, view.image_of(reached))
        if (
            every is straight
            or not len(seen)
            or placement.scale <= LARGER * scale
            or tolerance < FINEST_CHORD_OF_EXTENT
        ):
            break
        # Little of the scene is drawn, and that larger than thought.
        scale = placement.scale
    if walk.calls_for("halo"):
        from vectorplot.effects.halos import halo

        seen = walk.run("halo", halo, view, framed, seen, halo_mm / placement.scale)
    page, world = placement.page, placement.page_from_world
    strokes = walk.run("strokes", strokes_on_page, view, framed, seen, placement)
    labels = None
    if walk.calls_for("labels"):
        labels = walk.run(
            "labels", labels_in_place, scene, view, faces, placement, anchors, strokes, hidden, shown, text
        )
        strokes = labels.interrupted(strokes, world)
    hatches = Paths.empty()
    if walk.calls_for("hatching"):
        from vectorplot.painting.hatched import hatched

        done = walk.fraction("hatching")
        filled = partial(hatched, crease_angle_deg=crease_angle_deg, tolerance_mm=tolerance_mm, budget=allowed)
        trace = partial(
            lines_in_place,
            view=view,
            faces=faces,
            placement=placement,
            kinds=frozenset(),
            crease_angle_deg=crease_angle_deg,
            tolerance_mm=tolerance_mm,
            budget=budget,
        )
        hatches = walk.run("hatching", filled, scene, placement, hatch, trace, progress=done)
        hatches = hatches if labels is None else labels.interrupted(hatches, world)
    names = tuple(item.name for item in scene.items)
    paper = chosen.background if background is None else background
    if paper is not None:
        check_colour(paper, "background: ")
    if shown == "plain":
        drawn_by = (*chosen.rules, *rules)
        found = walk.run("layers", _layers, scene, strokes, hatches, hatch, layers, drawn_by)
    else:
        from vectorplot.effects.wireframe import wire_layers

        scene = scene if paper is None else replace(scene, background=paper)
        found = walk.run("layers", wire_layers, scene, view, strokes, page, shown)
    if scale_pens:
        found = tuple(replace(layer, pen=scaled_pen(layer.pen, pen_scale(page))) for layer in found)
    curved = tolerance_mm if curves == "bezier" else None
    inks = walk.run("pen", inked, found, hidden, world, curved, longest_mm, thin_ends)
    drawn_by = (*chosen.rules, *rules) if shown == "plain" else ()
    letters = pen_of(drawn_by, letter_pen(found), int(LineKind.LABEL), False, "")
    if labels is not None:
        inks = labels.on_top(inks, layers == "kind" and shown == "plain", longest_mm, world, letters)
    if labels is not None and isinstance(sheet, FittedPage):
        from vectorplot.drawing.lettering.room_for_labels import with_room

        inks, placement = with_room(inks, placement, labels.boxes)
        page, world = placement.page, placement.page_from_world
    border = frame_pen(drawn_by, replace(FRAME_PEN, colour=letters.colour))
    inks = titled(inks, placement, title, frame, border, longest_mm, text)
    if paper is not None and shown == "plain":
        inks = (sheet_layer(paper, page), *inks)
    inks = not_plotted(inks, line_list(unplotted), (*names, *(item.colour for item in scene.items)))
    drawing = Drawing(page.width_mm, page.height_mm, inks, names, scene.title, world)
    return beside_bar(drawing, bar, strip, paper, longest_mm)


def chart_of(scene: Scene, camera: Camera | str | None) -> Scaled | None:
    """The scene with what its colouring and its box ask for, if it has one."""
    if scene.colouring is None and scene.box is None:
        return None
    from vectorplot.effects.scales.scaled_scene import scaled

    return scaled(scene, camera)


def left_of_bar(sheet: Page, bar: ColourBar | None) -> tuple[Page, float]:
    """The part of a sheet that a colour bar leaves, and the width of the strip that it takes."""
    if bar is None:
        return sheet, 0.0
    from vectorplot.effects.scales.colour_bar import narrower

    rest = narrower(sheet)
    return rest, sheet.width_mm - rest.width_mm


def beside_bar(
    drawing: Drawing, bar: ColourBar | None, strip: float, paper: str | None, longest_mm: float | None = None
) -> Drawing:
    """The drawing with a colour bar in a strip (mm) beside it; paper: the colour of that, where it has one."""
    if bar is None:
        return drawing
    from vectorplot.effects.scales.colour_bar import with_colour_bar
    from vectorplot.shading.light.palettes import palette

    shade = None if paper is None else "#{:02x}{:02x}{:02x}".format(*palette(paper)[-1].tolist())
    return with_colour_bar(drawing, bar, strip, shade, longest_mm)


def seen_part(
    scene: Scene,
    camera: Camera,
    explain: Callable[[StageReport], None] | None,
    progress: Callable[[str, float], None] | None,
) -> Scene:
    """What cuts, and the camera's near and far plane, leave of a scene."""
    walk = Walk(plan_cuts(scene, camera), explain, progress)
    if walk.calls_for("cuts"):
        from vectorplot.effects.cutting.cut_scenes import cut_scene

        scene = walk.run("cuts", cut_scene, scene, camera)
    if walk.calls_for("near and far"):
        from vectorplot.effects.cuts import between_planes

        scene = walk.run("near and far", between_planes, scene, camera)
    return scene


def with_smooth_surfaces(scene: Scene, view: View, faces: ProjectedFaces | None) -> tuple[View, ProjectedFaces]:
    """The view of a scene, and its faces in the image, in the projection of a view of it that has triangles in place of
    smooth surfaces: the same where there are none. faces: of that view, where they are known."""
    if not all(isinstance(item.shape, Mesh) for item in scene.items):
        view, faces = view_of(scene, view), None
    view = replace(view, occludes=np.array([item.hides for item in scene.items], dtype=np.bool_))
    return view, project_faces(view) if faces is None else faces


def lines_in_place(
    scene: Scene,
    view: View,
    faces: ProjectedFaces,
    placement: Placement,
    kinds: frozenset[LineKind],
    *,
    crease_angle_deg: float,
    tolerance_mm: float,
    budget: float,
    progress: Callable[[float], None] | None = None,
) -> Paths:
    """The visible parts of the lines of a scene, as they come, where a picture of it already has its place on the page.

    view: of the scene, in the projection of the picture; progress(fraction) is called while it works. All else as of
    draw.
    """
    told = None if progress is None else lambda stage, fraction: progress(fraction)
    walk = Walk(plan_draw(scene, kinds, "none", 0.0), None, told)
    solid = solid_items(view, faces)
    straight = _straight_lines(walk, scene, view, faces, solid, kinds, crease_angle_deg)
    tolerance = 0.5 * tolerance_mm / placement.scale
    forms = _closed_forms(walk, scene, view, kinds)
    sheets = _sheets(walk, scene, view, forms)
    every = _lines_and_chords(walk, scene, view, sheets, forms, kinds, straight, tolerance, budget_of(budget))
    # Lines may reach too far where what the picture was fitted to does not.
    cut = not placement.whole or view.reaches_too_far(every.start, every.end)
    framed = walk.run("frame", in_frame, view, every, placement if cut else None)
    framed = _behind_balls(walk, view, forms, framed)
    seen = _visibility(walk, view, faces, solid, framed)
    return walk.run("strokes", strokes_on_page, view, framed, seen, placement)


def _straight_lines(
    walk: Walk,
    scene: Scene,
    view: View,
    faces: ProjectedFaces,
    solid: Bools,
    kinds: frozenset[LineKind],
    crease_angle_deg: float,
) -> Lines:
    """The lines of polyhedra."""
    found = []
    if walk.calls_for("edges"):
        backs = ~solid if walk.calls_for("visible lines") else np.ones(len(solid), dtype=np.bool_)
        found.append(walk.run("edges", edge_lines, scene, view, faces, kinds, crease_angle_deg, backs))
    if walk.calls_for("intersections"):
        found.append(walk.run("intersections", intersection_lines, scene, view, faces, kinds, solid))
    if walk.calls_for("patterns"):
        found.append(walk.run("patterns", pattern_lines, scene, view, kinds))
    if walk.calls_for("lines on meshes"):
        found.append(walk.run("lines on meshes", mesh_curve_lines, scene, view, kinds, crease_angle_deg))
    return with_kinds_of_cuts(scene, view, with_shared_kinds(view, joined_lines(found)), kinds)


def titled(
    layers: tuple[Layer, ...],
    placement: Placement,
    title: str,
    frame: bool,
    pen: Pen = FRAME_PEN,
    longest_mm: float | None = None,
    text: str = "strokes",
) -> tuple[Layer, ...]:
    """The layers of a drawing, and one with a title and a frame where these are wanted; pen, text: of its letters."""
    if not title and not frame:
        return layers
    from vectorplot.drawing.lettering.titles import with_title

    return with_title(layers, placement, title, frame, pen, longest_mm, text)


def labels_in_place(
    scene: Scene,
    view: View,
    faces: ProjectedFaces,
    placement: Placement,
    anchors: LabelAnchors,
    strokes: Paths,
    hidden: str = "none",
    style: str = "plain",
    text: str = "strokes",
    *,
    mm: float = 1.0,
) -> SceneLabels:
    """The labels of a scene where a picture of it has its place on the page.

    anchors: what they name in the scene as it was given; strokes: of the picture; hidden, style, text: as of draw; mm:
    how long a millimetre is in units of the page.
    """
    from vectorplot.drawing.lettering.scene_labels import labels_on_page, seen_labels

    seen = seen_labels(scene, view, faces, placement, anchors, style != "plain", mm)
    return labels_on_page(seen, placement, strokes, hidden, text, mm)


def _check_options(
    hidden: str, layers: str, curves: str, halo_mm: float, crease_angle_deg: float, tolerance_mm: float
) -> None:
    check_word("hidden", hidden, ("none", "dashed", "solid"))
    layer_words(layers)
    check_word("curves", curves, ("bezier", "polyline"))
    if not 0.0 <= halo_mm < np.inf:
        raise InputError(f"a halo of {halo_mm:g} mm: expected a width that is finite and not negative")
    if not 0.0 <= crease_angle_deg <= 180.0:
        raise InputError(f"a crease angle of {crease_angle_deg:g} degrees: expected 0 to 180")
    if not 0.0 < tolerance_mm < np.inf:
        raise InputError(f"a tolerance of {tolerance_mm:g} mm: expected a length that is finite and positive")


def _check_longest(longest_mm: float | None) -> None:
    if longest_mm is not None and not longest_mm >= SHORTEST_MM:
        raise InputError(f"longest strokes of {longest_mm:g} mm: expected {SHORTEST_MM:g} mm or more")


def _check_style(style: str, **others: bool) -> None:
    """InputError for an unknown style, and for options, by their names, that wireframes leave nothing to do."""
    check_word("style", style, ("plain", "wireframe", "depth-cue"))
    for name, given in others.items():
        if given and style != "plain":
            raise InputError(f"{name} does not go with the style {style}, which shows all lines, in colours of its own")


def _closed_forms(walk: Walk, scene: Scene, view: View, kinds: frozenset[LineKind]) -> ClosedForms | None:
    """The spheres and ellipsoids of the scene, if it has any, and their lines as they are seen among them."""
    if not walk.calls_for("balls"):
        return None
    from vectorplot.visibility.quadrics.closed_forms import closed_forms

    hidden_too = not walk.calls_for("visible lines")
    return walk.run("balls", closed_forms, scene, view, kinds, _seen_among_balls(walk, "balls", view), hidden_too)


def _seen_among_balls(walk: Walk, stage: str, view: View) -> Seen:
    """What becomes of the arcs on balls: all of them, the visible parts, or all parts counted."""
    from vectorplot.visibility.quadrics import hidden_arcs

    if walk.calls_for("all lines"):
        return lambda bodies, arcs, sides: hidden_arcs.whole_arcs(arcs)
    done = walk.fraction(stage)
    if walk.calls_for("visible lines"):
        return partial(hidden_arcs.visible_arcs, progress=done)
    return partial(hidden_arcs.counted_arcs, items=len(view.occludes), progress=done)


def _behind_balls(walk: Walk, view: View, forms: ClosedForms | None, lines: Lines) -> Lines:
    """The lines cut where spheres and ellipsoids begin or end to hide them, if there are any."""
    if forms is None or not walk.calls_for("behind balls"):
        return lines
    from vectorplot.visibility.quadrics.closed_forms import lines_behind

    seen = _seen_among_balls(walk, "behind balls", view)
    over = lines.kind == LineKind.CENTRE
    cut = walk.run("behind balls", lines_behind, view, forms, lines.some(~over), seen)
    return joined_lines((cut, lines.some(over))) if over.any() else cut


def _sheets(walk: Walk, scene: Scene, view: View, forms: ClosedForms | None) -> tuple[SmoothSheet, ...]:
    """The smooth surfaces of the scene that are not drawn in closed form, if it has any."""
    if not walk.calls_for("curves"):
        return ()
    from vectorplot.visibility.smooth.tracing.traced import scene_sheets

    return scene_sheets(scene, view, frozenset() if forms is None else forms.items)


def _lines_and_chords(
    walk: Walk,
    scene: Scene,
    view: View,
    sheets: tuple[SmoothSheet, ...],
    forms: ClosedForms | None,
    kinds: frozenset[LineKind],
    lines: Lines,
    tolerance: float,
    budget: Budget,
) -> Lines:
    """The lines and the curves of smooth surfaces, cut where one of these begins to hide them or ends, if they hide;
    those of balls as they are seen among these."""
    if not walk.calls_for("curves"):
        return lines
    from vectorplot.visibility.smooth.smooth_lines import cut_lines_and_chords, whole_lines_and_chords

    if tolerance < FINEST_CHORD_OF_EXTENT:
        text = "the picture shows so small a part of the scene that smooth curves are off by more than the tolerance"
        warnings.warn(text, InputWarning, stacklevel=3)
    tolerance = max(tolerance, FINEST_CHORD_OF_EXTENT)
    done = walk.fraction("curves")
    traced = walk.run("curves", _all_curves, scene, view, sheets, forms, kinds, tolerance, budget, done)
    if not sheets or not walk.calls_for("smooth surfaces"):
        _say(traced.doubts)
        return with_kinds_of_cuts(scene, view, whole_lines_and_chords(view, traced, lines), kinds)
    done = walk.fraction("smooth surfaces")
    cut, unsure = walk.run("smooth surfaces", cut_lines_and_chords, view, traced, lines, tolerance, budget, done)
    _say([*traced.doubts, *((scene.items[item].name, text) for item, text in unsure)])
    cut = replace(cut, behind=np.where(cut.kind == LineKind.CENTRE, 0, cut.behind))
    cut = with_kinds_of_cuts(scene, view, cut, kinds)
    return cut if not walk.calls_for("visible lines") else cut.some(cut.behind == 0)


def _say(doubts: Iterable[tuple[str, str]]) -> None:
    """An InputWarning for each item, or items, of which something is in doubt, given by name."""
    for line in line_each(doubts):
        warnings.warn(line, InputWarning, stacklevel=4)


def _all_curves(
    scene: Scene,
    view: View,
    sheets: tuple[SmoothSheet, ...],
    forms: ClosedForms | None,
    kinds: frozenset[LineKind],
    tolerance: float,
    budget: Budget,
    done: Callable[[float], None],
) -> TracedScene:
    """The curves of sheets, the arcs of what is drawn in closed form, and the curves in which the latter meet that are
    no arcs."""
    from vectorplot.visibility.smooth.tracing.traced import traced_scene, tracing_of

    traced = traced_scene(scene, view, sheets, kinds, tolerance, budget, done)
    if forms is None:
        return traced
    from vectorplot.visibility.quadrics.conic_curves import conic_curves

    traced = traced.joined(conic_curves(view, forms.arcs, forms.behind, tolerance))
    if not len(forms.traced) and not len(forms.in_faces):
        return traced
    from vectorplot.visibility.quadrics.traced_meetings import traced_meetings

    met, doubts = traced_meetings(scene, view, forms, kinds, tracing_of(view, tolerance, budget))
    return replace(traced.joined(met), doubts=(*traced.doubts, *doubts))


def _visibility(walk: Walk, view: View, faces: ProjectedFaces, solid: Bools, lines: Lines) -> Visibility:
    if walk.calls_for("all lines"):
        from vectorplot.effects.wireframe import all_lines

        return walk.run("all lines", all_lines, lines)
    over = lines.kind == LineKind.CENTRE
    if over.any():
        rest = _visibility(walk, view, faces, solid, lines.some(~over))
        return with_whole_lines(rest, over)
    segments = Segments(lines.start, lines.end)
    if walk.calls_for("visible lines"):
        return walk.run("visible lines", visible_parts, view, faces, solid, segments, walk.fraction("visible lines"))
    seen = walk.run("counted lines", counted_parts, view, faces, solid, segments, walk.fraction("counted lines"))
    return replace(seen, hidden_by=seen.hidden_by + lines.behind[seen.segment])


def _layers(
    scene: Scene,
    strokes: Paths,
    hatches: Paths,
    hatch: Hatching | Stippling | None,
    layers: str,
    rules: Sequence[PenRule],
) -> tuple[Layer, ...]:
    """The layers of lines, and those of strokes that hatch faces."""
    how = [hatch if item.hatch is None else item.hatch for item in scene.items]
    names, colours = [item.name for item in scene.items], [item.colour for item in scene.items]
    behind = hatch_layers(hatches, how, colours if "colour" in layer_words(layers) else None)
    return sorted_layers(strokes, names, colours, layers, rules, behind)

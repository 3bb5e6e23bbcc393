"""The verb draw: a scene becomes strokes on a page, hatching included."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from functools import partial
from typing import Literal

from vectorplot.drawing.drawing import Drawing, Paths
from vectorplot.drawing.layers import layer_words, layers_asked, line_list, pen_scale
from vectorplot.drawing.pens import Pens, Style, pen_rules, style_of_scene
from vectorplot.drawing.stroke_curves import rounding_error_mm, with_round_polygons
from vectorplot.geometry.budget import budget_of, threads_of
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.anything import scene_of
from vectorplot.pictures.line_sources import LineSources, traceable
from vectorplot.pictures.lines import (
    OutputStyle,
    chord_error_mm,
    fit_error_mm,
    labels_in_place,
    lines_in_place,
    placed_lines,
    with_outline,
)
from vectorplot.pictures.options import check_letters, check_look, check_options
from vectorplot.pictures.pipeline import Pipeline, StageReport, stoppable
from vectorplot.pictures.plan import accuracy_of_draw, plan_arcs, plan_draw, plan_hatching, with_accuracy
from vectorplot.pictures.prepared_scene import Legend, Paper, prepared_scene
from vectorplot.pictures.promises import DRAWING, promised
from vectorplot.scene.added_lines import with_default_lines
from vectorplot.scene.hatching import Hatching, Stippling
from vectorplot.scene.page import Page
from vectorplot.scene.pens import DepthCue, depth_cue_of
from vectorplot.scene.placement import Placement, page_of
from vectorplot.scene.view import look
from vectorplot.visibility.projected_faces import project_faces
from vectorplot.words import DRAWN, WIRES, line_kinds

# The strokes that hatch faces of a scene, on a picture of it that has its place.


def hatched_in_place(
    shapes: LineSources,
    placement: Placement,
    hatch: Hatching | Stippling | None,
    crease_angle_deg: float,
    tolerance_mm: float,
    budget: float,
    reflections: int,
) -> Paths:
    """The strokes in what is seen of a scene's faces, as they come. hatch and all else as in draw."""
    from vectorplot.pictures.hatching import hatched

    pipeline = shapes.pipeline
    trace = partial(
        lines_in_place,
        view=shapes.view,
        faces=shapes.faces,
        placement=placement,
        kinds=frozenset(),
        crease_angle_deg=crease_angle_deg,
        tolerance_mm=tolerance_mm,
        budget=budget,
    )
    filled = partial(
        hatched,
        crease_angle_deg=crease_angle_deg,
        tolerance_mm=tolerance_mm,
        budget=budget_of(budget),
        reflections=reflections,
        progress=pipeline.fraction("hatching"),
    )
    return pipeline.run("hatching", filled, shapes.scene, placement, hatch, trace)


# The verb draw: a scene becomes strokes on a page.


@stoppable
def draw(
    scene: object,
    camera: Camera | str | None = None,
    *,
    page: Page | str | None = None,
    width: float | str | None = None,
    fit: bool = True,
    lines: str | Iterable[str] | None = None,
    crease_angle_deg: float = 25.0,
    style: Style | str | None = None,
    hidden: Literal["none", "dashed", "solid"] | None = None,
    pens: Pens | None = None,
    dashes: str | Mapping[str, str] | Iterable[str] | None = None,
    scale_pens: bool = False,
    thin_ends: bool = False,
    depth_cue: DepthCue | str | None = None,
    background: str | None = None,
    halo_mm: float = 0.0,
    reflections: int = 1,
    hatch: Hatching | Stippling | None = None,
    layers: str | None = None,
    unplotted: str | Iterable[str] = "",
    curves: Literal["bezier", "polyline", "arcs"] = "bezier",
    tolerance_mm: float = 0.02,
    title: str = "",
    frame: bool = False,
    text: Literal["strokes", "real"] = "strokes",
    font: str | None = None,
    longest_mm: float | None = None,
    shortest_mm: float | None = None,
    off_by: float | str | None = None,
    within: float | str | None = None,
    budget: float = 1.0,
    jobs: int | None = None,
    progress: Callable[[str, float], None] | None = None,
    explain: Callable[[StageReport], None] | None = None,
) -> Drawing:
    """The scene as strokes on a page, hidden lines found by geometry.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, surface, curve, or several of these
        What is drawn, see `io.scene_of`.
    camera : Camera or str, optional
        Or the name of a main view, such as "front" or "iso"; where None that of the scene, else default_camera.
    page : Page or str, optional
        Or its name or size, such as "A4", "A5 landscape" or "200x150"; where None that of the scene, else A4. Of "fit"
        the latter, cut to the picture and its margin.
    width : float or str, optional
        In mm, or with its unit, such as "8cm" (mm, cm, in, pt, bp), or a width of LaTeX, such as "0.8\\\\linewidth":
        the page is as wide, and as high as its picture is then; of page it has the margin.
    fit : bool
        The picture fills the page but for its margin; otherwise the page centre is the target and the page height the
        camera's picture height.
    lines : str or iterable of str, optional
        Words of LineKind, or one text with commas between them, DRAWN or WIRES where None; an item's own come first.
    crease_angle_deg : float
        Sharper edges are creases; 0 to 180 degrees.
    style : Style or str, optional
        Where None what the scene says, else plain. One of plain, plotter, book, draft, blueprint, or a file that ends
        in .toml; or a wireframe: nothing hides anything, all lines have the middle shades of their items' palettes
        (wireframe), or go by their depth (depth-cue), on a sheet in the scene's background or the darkest gray.
    hidden : {"none", "dashed", "solid"}, optional
        Hidden lines are left out, dashed, or solid on a layer of their own; as the style says where None.
    pens : str, Pen, mapping or iterable of str, optional
        What draws lines by kind, by item and by both, before what style and scene say: WIDTH, COLOUR or WIDTH:COLOUR,
        as in "contour=0.5:black,hidden=0.18:gray,house=red,house.crease=0.2"; widths in mm, or with their unit. What
        no kind and no item stands before is for all lines.
    dashes : str, mapping or iterable of str, optional
        DASH,GAP in mm, or with their units, by kind, item and both, as in "hidden=3,1"; or none.
    scale_pens : bool
        Widths and dashes are those on A4, and in proportion to it on other pages.
    thin_ends : bool
        Lines that converge, as in the apex of a cone, stop early in turn, before their ink makes a blot.
    depth_cue : DepthCue or str, optional
        Strokes are thinner (width) or paler (shade) the farther away they are, in five steps or so many as stand behind
        the word, as in "width,8" or "width,shade,3"; or none. Each step of a layer is a layer with a pen of its own.
        Where None as the scene says.
    background : str, optional
        The colour of the paper, drawn on a layer that is not plotted; as the style says where None.
    halo_mm : float
        Lines end so many mm beside what is in front of them.
    reflections : int
        How often lines are followed from plane mirror to plane mirror, 0 to 8: with 0 mirrors are plain faces, with 1
        they show what stands before them, with 2 mirrors that they show do so too. Balls and other round mirrors
        show lines too, but none that others show. Such lines have the kind `reflected`.
    hatch : Hatching or Stippling, optional
        How visible faces are hatched, or stippled, where their items do not say it themselves; not at all where None.
    layers : str, optional
        What shares a layer: kind, object or colour, that of the face where it has its own, or several of these with
        commas between them; as the style says where None. Or pen: all that a pen draws, hatching, letters and frame
        among it, the pens those of the style's layers, or of words beside it, as in "colour,pen". Strokes of one pen
        are joined wherever their ends meet.
    unplotted : str or iterable of str
        The names of layers that plotters skip; kinds, items and colours of which the picture shows nothing may be among
        them.
    curves : {"bezier", "polyline", "arcs"}
        Strokes of smooth curves are fitted with cubic Béziers and elliptic arcs, or stay polylines. With "arcs"
        polygons of meshes that stand for circles are arcs too, of ellipses where they are seen from the side.
    tolerance_mm : float
        How many mm strokes of smooth curves may be off the true curves; their points are exact but for the ends of
        dashes, straight lines are so whatever it is.
    title : str
        Letters in the middle of the lower margin.
    frame : bool
        A rectangle in the middle of the margin, which ends before the title.
    text : {"strokes", "real"}
        Letters of labels and titles are strokes of the pen; or texts, set in fonts by what reads the file.
    font : str, optional
        The family of fonts of texts, which PDF, PostScript and PNG hold then; or a file of a font, which SVG holds.
    longest_mm : float, optional
        Longer strokes leave in equal parts that are no longer, for plotters that stutter on them; 1 mm or more.
    shortest_mm : float, optional
        Lines and hatching strokes that are shorter when they are joined are left out; where None specks: open ones
        below 0.05 mm that go on in no other stroke. Dots of stipplings, dashes and letters stay, and with 0 all.
    off_by : float or str, optional
        The error that the picture is to keep, mm, or a text with its unit such as "0.01mm": tolerance_mm is
        chosen for it, and what was reached is measured.
    within : float or str, optional
        The time that the picture may take, seconds or a text such as "0.5s" or "300ms": it gets as accurate as that
        allows.
    budget : float
        How many times the usual work on smooth surfaces is allowed (see geometry.budget).
    jobs : int, optional
        On how many threads the stages that go over chunks work; where None, on all processors. The result is the same.
    progress : callable, optional
        progress(stage, fraction) is called while it works; what it raises stops the work, amid a stage too.
    explain : callable, optional
        explain(report) is called while it works, with a StageReport.

    Returns
    -------
    Drawing
        The page in mm with its layers, the names of the items, and the matrix page_from_world.

    Raises
    ------
    InputError
        See `io.scene_of`.
        For unknown words and layers, impossible cameras, and widths and angles out of range; for a tolerance or a
        budget that is not finite and positive; for hidden lines, a halo, a hatching, a depth cue or layers other than
        by kind in a wireframe, which has colours of its own.
    TypeError
        For what is nothing of that kind.

    Warns
    -----
    InputWarning
        Where a picture shows so little of the scene that the tolerance cannot be kept, and what the budget did not do
        for; for implicit surfaces that have no points in their boxes.

    Notes
    -----
    Edge cases: an empty scene gives an empty page. Where the scene reaches behind the eye, or more than 60 degrees off
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
    told = dict(locals())
    check_options(told)
    check_letters(font, text)
    if off_by is not None or within is not None:
        return promised(draw, DRAWING, told)
    given = scene_of(scene) if lines is not None else with_default_lines(scene_of(scene))
    chosen, own = style_of_scene(given.inks, style)
    asked = pen_rules(pens, dashes)
    hidden = chosen.hidden if hidden is None else hidden
    layers = layers_asked(layers, chosen)
    layer_words(layers)
    allowed, threads = budget_of(budget), threads_of(jobs)
    others = {"halo_mm": halo_mm > 0.0, "hatch": hatch is not None, "layers": layers != "kind", "pens": bool(asked)}
    others["depth_cue"] = depth_cue_of(depth_cue) is not None
    check_look(chosen.look, hidden=hidden != "none", **others)
    kinds = line_kinds((DRAWN if chosen.look == "plain" else WIRES) if lines is None else lines)
    sheet = page_of(page, given, width, fit)
    paper = Paper(sheet, fit, pen_scale(sheet) if scale_pens else 1.0)
    prepared = prepared_scene(given, camera, paper, explain, progress, depth_cue=depth_cue)
    seen, bar = prepared.scene, prepared.bar
    if any(item.exact is not None for item in seen.items):
        from vectorplot.scene.exact_bodies import exact_bodies

        seen = exact_bodies(seen, kinds, hatch)
    legend = Legend(sheet, bar, seen.scale_bar, text)
    sheet = legend.room
    rules = (*chosen.rules, *own, *asked)
    finish = OutputStyle(
        look=chosen.look,
        hidden=hidden,
        layers=layers,
        rules=rules if bar is None else bar.with_pens(rules),
        background=chosen.background if background is None else background,
        curved_mm=None if curves == "polyline" else tolerance_mm,
        longest_mm=longest_mm,
        title=title,
        frame=frame,
        unplotted=line_list(unplotted),
        text=text,
        thin_ends=thin_ends,
        scale_pens=scale_pens,
        shortest_mm=shortest_mm,
    )
    planned = plan_draw(seen, kinds, hidden, halo_mm, finish.look, reflections, bends=True)
    planned = plan_hatching(seen, hatch, planned) if finish.plain else planned
    planned = plan_arcs(planned) if curves == "arcs" else planned
    smooth = curves != "polyline" and any(not isinstance(item.shape, Mesh) for item in seen.items)
    pipeline = Pipeline(with_accuracy(planned, accuracy_of_draw(tolerance_mm, smooth)), explain, progress, threads)
    view = pipeline.run("look", look, seen, prepared.camera)
    faces = pipeline.run("faces", project_faces, view)
    shapes = traceable(pipeline, seen, view, faces, kinds, crease_angle_deg, allowed)
    placed = placed_lines(shapes, sheet, fit, tolerance_mm, allowed, reflections, hidden)
    placement = prepared.around(placed.placement, view, sheet)
    strokes = replace(placed, placement=placement).with_halo(halo_mm).strokes()
    for stage in ("visible lines", "counted lines"):
        pipeline.measured(stage, "mm", lambda: view.tolerance * placement.scale)
    pipeline.measured("curves", "mm", chord_error_mm, strokes)
    labels = None
    if pipeline.calls_for("labels"):
        beside = (prepared.anchors, strokes, hidden, finish.look, text)
        labels = pipeline.run("labels", labels_in_place, seen, view, faces, placement, *beside)
        strokes = labels.interrupted(strokes, placement.page_from_world)
    strokes = with_outline(strokes, shapes, placement, tolerance_mm, allowed)
    hatches = Paths.empty()
    if pipeline.calls_for("hatching"):
        hatches = hatched_in_place(shapes, placement, hatch, crease_angle_deg, tolerance_mm, budget, reflections)
        hatches = hatches if labels is None else labels.interrupted(hatches, placement.page_from_world)
    found = finish.layered(pipeline, seen, view, strokes, hatches, hatch, placement.page)
    letters, cue = finish.letters(found), seen.depth_cue
    if cue is not None and finish.plain:
        found = finish.cued(pipeline, found, view, cue, placement)
    inks = finish.inked(pipeline, found, placement)
    if pipeline.calls_for("arcs"):
        inks = pipeline.run("arcs", with_round_polygons, inks, tolerance_mm)
        pipeline.measured("arcs", "mm", rounding_error_mm, inks)
    if labels is not None:
        inks, placement = finish.labelled(inks, placement, labels, letters, sheet)
    drawing = legend.around(finish.drawing(inks, placement, seen, letters), finish.background, longest_mm)
    drawing = finish.of_pens(pipeline, drawing if font is None else replace(drawing, font=font))
    pipeline.measured("pen", "mm", fit_error_mm, drawing.layers)
    return drawing

"""What is seen all round from a place becomes strokes on a page."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from vectorplot.drawing.drawing import Drawing, Layer, Paths
from vectorplot.drawing.layers import shown_items
from vectorplot.drawing.pen_layers import line_list, sorted_layers
from vectorplot.drawing.pens import Pens, Style, pen_rules, style_of_scene
from vectorplot.effects.panoramas import eye_of, panorama_on_page
from vectorplot.errors import InputError
from vectorplot.geometry.budget import threads_of
from vectorplot.geometry.camera import Camera, Panorama
from vectorplot.io.anything import scene_of
from vectorplot.pictures.lines import OutputStyle, lines_in_place
from vectorplot.pictures.options import check_options
from vectorplot.pictures.pipeline import Pipeline, StageReport
from vectorplot.pictures.plan import plan_panorama
from vectorplot.pictures.prepared_scene import with_face_looks
from vectorplot.scene.added_lines import with_default_lines
from vectorplot.scene.exploded import shown_apart
from vectorplot.scene.page import Page
from vectorplot.scene.placement import field_of_vision, page_of
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import look, without_seams
from vectorplot.visibility.projected_faces import project_faces
from vectorplot.words import DRAWN, LineKind, line_kinds


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
    curves, tolerance_mm, title, frame, longest_mm : see draw
        Lines of smooth surfaces leave as curves, straight ones, which are none here, as polylines.
    budget, jobs, progress, explain : see draw
        Progress is told for each quarter of the round.

    Returns
    -------
    Drawing
        The visible lines in strips that fill the page, below each strip its bearings: a tick every five degrees, and
        the names of the winds. Its page_from_world is that of the flat sheet: no matrix unrolls the world.

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
        layers=chosen.layers if layers is None else layers,
        rules=(*chosen.rules, *own, *pen_rules(pens, dashes)),
        background=chosen.background if background is None else background,
        curved_mm=tolerance_mm if curves == "bezier" else None,
        longest_mm=longest_mm,
        title=title,
        frame=frame,
        unplotted=line_list(unplotted),
    )
    threads = threads_of(jobs)
    round_about = place if isinstance(place, Panorama) else Panorama(tuple(place))
    kinds = line_kinds(DRAWN if lines is None else lines)
    seamless = with_face_looks(without_seams(given))
    eye = eye_of(round_about, seamless)
    sheet = page_of(page, seamless, width)
    pipeline = Pipeline(plan_panorama(), explain, progress, threads)
    trace = partial(
        _seen_by,
        seamless,
        kinds=kinds,
        crease_angle_deg=crease_angle_deg,
        tolerance_mm=tolerance_mm,
        budget=budget,
    )
    strokes, marks, placement = pipeline.run(
        "panorama", panorama_on_page, round_about, eye, sheet, tolerance_mm, trace, pipeline.fraction("panorama")
    )
    named, shown = _names_and_colours(seamless), shown_items(seamless, strokes, np.append(eye, 1.0))
    found = pipeline.run("layers", sorted_layers, strokes, *named, finish.layers, finish.rules, (), shown)
    inks, letters = finish.inked(pipeline, found, placement), finish.letters(found)
    return finish.drawing((*inks, Layer("bearings", letters, (marks,))), placement, seamless, letters)


def _names_and_colours(scene: Scene) -> tuple[list[str], list[str]]:
    return [item.name for item in scene.items], [item.colour for item in scene.items]


def _seen_by(
    scene: Scene,
    camera: Camera,
    page: Page,
    *,
    kinds: frozenset[LineKind],
    crease_angle_deg: float,
    tolerance_mm: float,
    budget: float,
) -> Paths:
    """The visible lines of a scene on a page that the picture of a camera fills."""
    view = look(scene, camera)
    placement = replace(field_of_vision(view, page, fit=False), page=page)
    return lines_in_place(
        scene,
        view,
        project_faces(view),
        placement,
        kinds,
        crease_angle_deg=crease_angle_deg,
        tolerance_mm=tolerance_mm,
        budget=budget,
    )

"""Scenes as text in the scene language, with every digit."""

from __future__ import annotations

from collections.abc import Iterable
from json import dumps

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.curves.curve import is_curve
from vectorplot.errors import InputError
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.scenes.items.scene_hatching import hatch_text
from vectorplot.io.scenes.reserved_words import RESERVED
from vectorplot.io.scenes.scene_words import bare_word
from vectorplot.io.scenes.statements.ink_statements import ink_texts
from vectorplot.scene.cuts.cut import Cut
from vectorplot.scene.item import Item, Pattern
from vectorplot.scene.light import Light
from vectorplot.scene.material import FINISH_WORDS, Material
from vectorplot.scene.naming.labels import Along, AtVertex, BesidePoint, Label, OnCurve, OnPage
from vectorplot.scene.naming.scales import Colouring
from vectorplot.scene.pages.fitted_pages import FittedPage, PageOfWidth
from vectorplot.scene.pages.page import Page
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import NO_LINES
from vectorplot.surfaces.surface import is_implicit, is_parametrised
from vectorplot.words import COLOURS


def write_scene(scene: Scene) -> str:
    """A scene as a text in the scene language, with every digit.

    Parameters
    ----------
    scene : Scene
        What is written.

    Returns
    -------
    str
        ASCII, a line or more for every item; what is no bare word of the language is quoted.

    Raises
    ------
    InputError
        For what the language lacks, naming the item: a surface of a function in Python, lines of its own on a curve.

    Notes
    -----
    parse_scene gives an equal scene back, to the last bit; angles of surfaces to rounding. Every polyhedron is written
    by its vertices and faces, numbered from 1, surfaces by their words.

    Source: Glaeser, section 3.6; erratum G3-16.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import io
    >>> text = io.write_scene(vp.Scene((), title="Nothing", page=vp.Page(100, 80, margin_mm=5)))
    >>> print(text, end="")
    title "Nothing"
    page 100x80 margin 5
    >>> io.parse_scene(text).title
    'Nothing'
    """
    blocks: list[str] = []
    if scene.title:
        blocks.append(f"title {dumps(scene.title)}")
    if scene.background is not None:
        blocks.append(f"background {_colour(scene.background)}")
    if scene.exposure != 1.0:
        blocks.append(f"exposure {scene.exposure if scene.exposure == 'fitted' else format(scene.exposure, '.17g')}")
    if scene.depth_cue is not None:
        blocks.append(f"depth_cue {' '.join(scene.depth_cue.by)} {scene.depth_cue.steps}")
    if scene.colouring is not None:
        blocks.append(_colouring(scene.colouring))
    if scene.box is not None:
        blocks.append(f"box_axes names {' '.join(map(dumps, scene.box.names))} size {scene.box.size_mm:.17g}")
    if scene.page is not None:
        blocks.append(_page(scene.page))
    if scene.camera is not None:
        blocks.append(_camera(scene.camera))
    blocks.extend(_light(light) for light in scene.lights)
    blocks.extend(_item(item, scene.lights) for item in scene.items)
    blocks.extend(map(_label, scene.labels))
    blocks.extend(_cut(cut) for cut in scene.cuts if cut.items != ())
    if scene.explosion is not None:
        blocks.append(f"explode {_numbers(scene.explosion.way)} {scene.explosion.factor:.17g}")
    if scene.inks is not None:
        blocks.extend(ink_texts(scene.inks))
    return "".join(block + "\n" for block in blocks)


def _name(text: str) -> str:
    return text if bare_word(text) and text not in RESERVED else dumps(text)


def _colouring(own: Colouring) -> str:
    if not isinstance(own.by, str):
        raise InputError("colours by a function of Python have no words")
    called = "" if own.label is None else f" called {dumps(own.label)}"
    return f"colour_by {dumps(own.by)} map {dumps(own.colour_map)} steps {own.steps}{called}"


def _colour(text: str) -> str:
    return text if text in COLOURS else dumps(text)


def _numbers(values: Iterable[float]) -> str:
    return " ".join(repr(float(value)) for value in values)


def _list(points: Floats) -> str:
    """Points with commas between them, one a line."""
    return " ,\n  ".join(" ".join(map(repr, point)) for point in points.tolist())


def _page(page: Page) -> str:
    if isinstance(page, PageOfWidth):
        return f"page width {page.width_mm!r} margin {page.margin_mm!r}"
    fit = " fit" if isinstance(page, FittedPage) else ""
    return f"page {page.width_mm!r}x{page.height_mm!r}{fit} margin {page.margin_mm!r}"


def _camera(camera: Camera) -> str:
    words = [f"camera eye {_numbers(camera.eye)} target {_numbers(camera.target)}"]
    if camera.up is not None:
        words.append(f"up {_numbers(camera.up)}")
    words.append(f"twist {float(camera.twist_deg)!r} field_of_vision {float(camera.fov_deg)!r}")
    if camera.parallel:
        words.append("parallel")
    if camera.height is not None:
        words.append(f"height {float(camera.height)!r}")
    words.extend(f"{name} {float(depth)!r}" for name, depth in (("near", camera.near), ("far", camera.far)) if depth)
    return " ".join(words)


def _light(light: Light) -> str:
    words = ["light", *([_name(light.name)] if light.name else [])]
    words.append(f"{'direction' if light.parallel else 'position'} {_numbers(light.position)}")
    if light.intensity is not None:
        words.append(f"intensity {float(light.intensity)!r}")
    if light.colour != "white":
        words.append(f"colour {_colour(light.colour)}")
    if light.fading:
        words.append("fading")
    return " ".join(words)


def _cut(cut: Cut) -> str:
    conditions = []
    for plane in cut.planes:
        terms = [f"{factor:+.17g}{axis}" for factor, axis in zip(plane.normal, "xyz", strict=True) if factor]
        conditions.append(f"{' '.join(terms)} {'=' if plane.to_eye else '>'} {plane.offset!r}")
    words = ["cut", dumps(", ".join(conditions)), *([cut.away] if cut.away != "gone" else [])]
    hatch = [*([] if cut.spacing_mm is None else [f"spacing {cut.spacing_mm:.17g}"]), f"angle {cut.angle_deg:.17g}"]
    items = [] if cut.items is None else ["of", *map(dumps, cut.items)]
    return " ".join([*words, *([f"colour {_colour(cut.colour)}"] if cut.colour else []), *hatch, *items])


def _label(label: Label) -> str:
    at = label.at
    if isinstance(at, AtVertex):
        place = f"vertex {_name(at.item)} {at.vertex + 1}"
    elif isinstance(at, (Along, OnCurve)):
        place = f"{'on' if isinstance(at, OnCurve) else 'along'} {_name(at.item)} {float(at.part)!r}"
    elif isinstance(at, OnPage):
        place = f"page {_numbers((at.x_mm, at.y_mm))}"
    else:
        place = f"at {_numbers(at.point if isinstance(at, BesidePoint) else at)}"
    words = [
        "label",
        _name(label.name) if label.name else '""',
        dumps(label.text),
        place,
        f"size {float(label.size_mm)!r}",
    ]
    words += [f"place {label.place}", *([f"hidden {label.hidden}"] if label.hidden else []), f"mark {label.mark}"]
    return " ".join(words)


def _item(item: Item, lights: tuple[Light, ...]) -> str:
    colour = item.colour if item.colour in COLOURS else f"colour {dumps(item.colour)}"
    form = ["general"] if isinstance(item.shape, Mesh) else []
    words = [_name(item.name), colour, *form, *_material(item.material)]
    words.append(f"occludes {'yes' if item.hides else 'no'}")
    if item.group:
        words.append(f"group {_name(item.group)}")
    if item.hatch is not None:
        words.append(hatch_text(item.hatch))
    lines = item.usual_lines if item.lines is None else item.lines
    if lines is not None:
        words.append(f"lines {', '.join(lines) or 'none'}")
    return " ".join(words) + _shape(item, lights) + _edges(item) + _patterns(item.patterns)


def _edges(item: Item) -> str:
    """The list of the edges to be drawn; parts of edges that a cut left are none of the language."""
    if item.drawn_edges is None or not isinstance(item.shape, Mesh):
        return ""
    number = {tuple(vertex): k + 1 for k, vertex in enumerate(item.shape.vertices.tolist())}
    ends = [[number.get(tuple(end)) for end in edge] for edge in item.drawn_edges.tolist()]
    return "\nedges " + (" , ".join(f"{one} {two}" for one, two in ends if one and two) or "none")


def _shape(item: Item, lights: tuple[Light, ...]) -> str:
    if item.curves and is_curve(item.shape):
        raise InputError(f"{item.name}: the scene language has lines of its own for surfaces and polyhedra only")
    if isinstance(item.shape, Mesh) and item.curves == NO_LINES:
        return _mesh(item.shape)
    from vectorplot.io.scenes.scene_surface_writer import curve_text, lines_text, surface_text

    shape = item.shape
    try:
        if isinstance(shape, Mesh):
            if item.curves.columns or item.curves.rows or item.curves.paths:
                raise InputError("parameter lines and curves u(t), v(t) are for surfaces only")
            return _mesh(shape) + lines_text(item.curves, lights)
        if is_parametrised(shape) or is_implicit(shape):
            return f"\nsurface {surface_text(shape)}{lines_text(item.curves, lights)}"
        if is_curve(shape):
            return f"\n{curve_text(shape)}"
        raise InputError(f"the scene language has no word for a {type(shape).__name__}")
    except InputError as error:
        raise InputError(f"{item.name}: {error.cause}") from None


def _material(material: Material) -> list[str]:
    own = [(name, getattr(material, name)) for name in FINISH_WORDS]
    finish = [f"{name} {value!r}" for name, value in own if value is not None]
    words = [material.word, *finish, f"opacity {float(material.opacity)!r}"]
    if material.refraction != 1.0:
        words.append(f"refraction {float(material.refraction)!r}")
    return words


def _mesh(mesh: Mesh) -> str:
    vertices = _list(mesh.vertices) if len(mesh.vertices) else "none"
    polygons = mesh.polygons()
    faces = " ,\n  ".join(" ".join(str(corner + 1) for corner in polygon) for polygon in polygons) or "none"
    text = f"\nvertices\n  {vertices}\nfaces\n  {faces}"
    if mesh.present is not None:
        text += "\nremoved_faces " + " , ".join(str(face + 1) for face in np.flatnonzero(~mesh.present).tolist())
    return text


def _patterns(patterns: tuple[Pattern, ...]) -> str:
    if not patterns:
        return ""
    rows = [
        f"\n  face {p.face + 1} polygon {dumps(p.name)} {_colour(p.colour)}\n  {_list(np.asarray(p.points))}"
        for p in patterns
    ]
    return "\npatterns" + "".join(rows)

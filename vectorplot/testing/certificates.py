"""Certificates of drawings: what hides which part of which line, for a checker that knows nothing of this package."""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.backends.json import json_bytes, plain
from vectorplot.drawing.drawing import Drawing
from vectorplot.drawing.finishing import DASH_MM
from vectorplot.drawing.pens import Style, style_of_scene
from vectorplot.geometry import ragged
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.anything import scene_of
from vectorplot.pictures.options import check_look
from vectorplot.pictures.prepared_scene import Paper, prepared_scene
from vectorplot.scene.added_lines import with_default_lines
from vectorplot.scene.item import Item
from vectorplot.scene.page import Page
from vectorplot.scene.placement import page_of
from vectorplot.scene.view import View, look
from vectorplot.testing import check_certificate as checker
from vectorplot.tolerances import CERTIFIED_MM, ROUNDING
from vectorplot.visibility.polyhedra.lines import kinds_of
from vectorplot.words import DRAWN, LineKind, line_kinds

if TYPE_CHECKING:
    from vectorplot.save import Destination

SIZE_MM = 0.01
"""Parts of lines that are shorter are not looked at."""

STRETCHED = 2.0
"""Gaps between dashes are no more than so many times as long as they are meant to be."""


@dataclass(frozen=True, eq=False)
class Certificate:
    """What proves a drawing.

    Parameters
    ----------
    content : dict
        As it stands in its file, see `docs/for_tests.md`.
    unproved : tuple of str
        What cannot be proved of the drawing, a few words each; empty where all of it can be.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, testing
    >>> cube = geometry.box((2, 2, 2))
    >>> certificate = testing.certificate(cube, vp.draw(cube))
    >>> [len(one["triangles"]) for one in certificate.content["items"]]
    [12]
    """

    content: dict[str, Any]
    unproved: tuple[str, ...] = ()

    def __bytes__(self) -> bytes:
        """The file: JSON in ASCII, an item, the claims of a stroke, or a hidden part of a line in a line each."""
        head = {key: value for key, value in self.content.items() if not isinstance(value, list) or key in _HEAD}
        rows = {key: value for key, value in self.content.items() if key not in head}
        tables = [f'"{key}": [{",".join(chr(10) + json.dumps(row) for row in value)}]' for key, value in rows.items()]
        return (json.dumps(head)[:-1] + ",\n" + ",\n".join(tables) + "}\n").encode("ascii")

    def save(self, path: Destination) -> None:
        """Write the file, whole or not at all.

        Parameters
        ----------
        path : str, path or file object
            The file, or an open one.

        Raises
        ------
        InputError
            For what is neither.
        OSError
            Where the file cannot be written.

        Examples
        --------
        >>> import os, tempfile
        >>> import vectorplot as vp
        >>> from vectorplot import geometry, testing
        >>> cube = geometry.box((2, 2, 2))
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     testing.certificate(cube, vp.draw(cube)).save(os.path.join(folder, "cube.json"))
        ...     os.listdir(folder)
        ['cube.json']
        """
        from vectorplot.save import format_for, put

        format_for(path, "json")
        put(path, bytes(self))


_HEAD = ("page_from_world", "window_mm", "not_certified", "clear")


def certificate(
    scene: object,
    drawing: Drawing,
    camera: Camera | str | None = None,
    *,
    page: Page | str | None = None,
    lines: str | Iterable[str] | None = None,
    crease_angle_deg: float = 25.0,
    style: Style | str | None = None,
    hidden: Literal["none", "dashed", "solid"] | None = None,
    size_mm: float = SIZE_MM,
    width_mm: float = CERTIFIED_MM,
) -> Certificate:
    """What hides each hidden stroke of a drawing, and each part of a line of its meshes that it does not show.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, or several of these
        What is drawn.
    drawing : Drawing
        What `draw` made of it, or something else did.
    camera : Camera or str, optional
        As in `draw`.
    page : Page or str, optional
        As in `draw`; its margin counts, within which all lines are.
    lines : str or iterable of str, optional
        As in `draw`.
    crease_angle_deg : float
        As in `draw`.
    style : Style or str, optional
        As in `draw`.
    hidden : {"none", "dashed", "solid"}, optional
        As in `draw`; where neither this nor the style says it, hidden lines are dashed if there are any.
    size_mm : float
        Parts of lines that are shorter are not looked at; in mm on the page.
    width_mm : float
        Beside the outlines of what is in front strips of this width are left open; in mm on the page.

    Returns
    -------
    Certificate
        With the meshes in the world, the camera's matrix, and what hides what.

    Raises
    ------
    InputError
        See `draw`; for the style of a wireframe, in which nothing hides anything.

    Notes
    -----
    It is found without the hidden-line engine of this package, and shows right drawings right: whether this one is,
    `check_certificate.py` says, see `docs/for_tests.md`. Smooth surfaces are not certified, nor are strokes of other
    kinds than contour, boundary, crease, edges, intersection, pattern, section and isophote; a drawing with a halo, or
    thin ends, shows less than its lines.

    Source: Glaeser, section 7.2 (what a convex face hides of a segment is one interval).

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, testing
    >>> cube = geometry.box((2, 2, 2))
    >>> made = testing.certificate(cube, vp.draw(cube, "iso"), "iso")
    >>> made.unproved, len(made.content["hidden_lines"])
    ((), 6)
    """
    given = scene_of(scene) if lines is not None else with_default_lines(scene_of(scene))
    chosen, _ = style_of_scene(given.inks, style)
    check_look(chosen.look, certificate=True)
    kinds = line_kinds(DRAWN if lines is None else lines)
    paper = Paper(Page(drawing.width_mm, drawing.height_mm, 0.0), fit=True)
    prepared = prepared_scene(given, camera, paper, None, None)
    view, items = look(prepared.scene, prepared.camera), prepared.scene.items
    triangles, owner = _triangles(view)
    world, first = prepared.scene.vertices, view.item_vertices
    found = json.loads(json_bytes(drawing))
    hidden = chosen.hidden if hidden is None else hidden
    if hidden == "none" and any(stroke["hidden_by"] for stroke in found["strokes"]):
        hidden = "dashed"
    margin = float(page_of(page, given).margin_mm)
    gap = max((layer.pen.dash_mm[1] for layer in drawing.layers if layer.pen.dash_mm), default=DASH_MM[1])
    partial = _broken(drawing)
    said = [f"that {partial} are complete"] if partial else []
    content: dict[str, Any] = {
        "format": checker.FORMATS[1],
        "version": 1,
        "page_from_world": found["page_from_world"],
        "window_mm": [[margin, margin], [drawing.width_mm - margin, drawing.height_mm - margin]],
        "size_mm": float(size_mm),
        "width_mm": float(width_mm),
        "crease_angle_deg": float(crease_angle_deg),
        "hidden_gap_mm": {"none": None, "solid": 0.0, "dashed": STRETCHED * max(gap, DASH_MM[1])}[hidden],
        "not_certified": said + [line for item in items for line in _not_certified(item, kinds)],
        "items": [
            {
                "name": item.name,
                "hides": bool(view.occludes[number]),
                "smooth": not isinstance(item.shape, Mesh),
                "lines": [] if partial else _complete(item, kinds),
                "vertices": plain(world[first[number] : first[number + 1]]),
                "triangles": (triangles[owner == number] - first[number]).tolist(),
            }
            for number, item in enumerate(items)
        ],
    }
    strange = {stroke["kind"] for stroke in found["strokes"]} - {"edges", *checker.EDGE_KINDS, *checker.FACE_KINDS}
    said = [*content["not_certified"], *(f"strokes of the kind {kind}" for kind in sorted(strange))]
    return Certificate({**content, **_claims(checker.model_of(found, content))}, tuple(said))


def _triangles(view: View) -> tuple[Ints, Ints]:
    """(t,3) the faces of a view as triangles, and the item (t,) of each: those around the first corner of each of the
    convex parts."""
    count = view.face_sizes - 2
    corner, step = np.repeat(view.offsets[:-1], count), ragged.place(count)
    return view.corners[np.stack([corner, corner + step + 1, corner + step + 2], axis=1)], view.face_item.repeat(count)


def _broken(drawing: Drawing) -> str:
    """Which visible lines of a drawing have gaps that nothing hides; empty where none have."""
    seen = [
        (layer.pen, paths.kind) for layer in drawing.layers for paths in layer.strokes if (paths.hidden_by == 0).any()
    ]
    dashed = any(pen.dash_mm is not None and any(pen.dash_mm) for pen, _ in seen)
    lettered = any((kind == LineKind.LABEL).any() for _, kind in seen) or any(layer.texts for layer in drawing.layers)
    return " and ".join(["dashed lines"] * dashed + ["lines beside labels"] * lettered)


def _complete(item: Item, kinds: frozenset[LineKind]) -> list[str]:
    """The kinds of lines of which all on an item are drawn."""
    own = {kind.word for kind in kinds_of(item, kinds)} & {*checker.EDGE_KINDS}
    if item.drawn_edges is not None or item.cut_by or item.is_cut_face or LineKind.GHOST in kinds_of(item, kinds):
        return []
    return sorted(own - {"contour"} if item.curves.smooth_contours else own)


def _not_certified(item: Item, kinds: frozenset[LineKind]) -> list[str]:
    """What cannot be proved of a drawing because of an item, a few words each."""
    if not isinstance(item.shape, Mesh):
        return [f"what {item.name} shows and hides, which is a smooth shape"]
    left = {kind.word for kind in kinds_of(item, kinds)} & {*checker.EDGE_KINDS} - {*_complete(item, kinds)}
    return [f"that each {', '.join(sorted(left))} of {item.name} is there"] if left and item.mesh.face_count else []


def _claims(model: checker.Model) -> dict[str, Any]:
    """The strokes that are clear, and what hides each of the others, and of each part of a line that is not drawn."""
    owner = model.strokes.owner
    segment = np.stack([owner, np.arange(len(owner)) - np.searchsorted(owner, owner)], axis=1)
    dark = np.flatnonzero(model.hidden[owner])
    strokes = _rows(segment[dark], _hidden(model, checker.take(model.strokes, dark)))
    lines = _rows(model.ends[model.wanted], _hidden(model, checker.take(model.sides, model.wanted)))
    return {"clear": np.flatnonzero(~model.hidden).tolist(), "hidden_strokes": strokes, "hidden_lines": lines}


def _rows(names: Ints, parts: checker.Parts) -> list[list[Any]]:
    """Parts of segments with names (n,2): two numbers, from where to where, and by which triangle each is hidden."""
    columns = zip(*names[parts.line].T.tolist(), *(column.tolist() for column in parts[1:]), strict=True)
    return [list(row) for row in columns]


def _hidden(model: checker.Model, lines: checker.Segments) -> checker.Parts:
    """The parts of segments that triangles hide, by as few of these as possible, one after the other.

    Of all that begin before the part so far ends the one that ends last goes on (the greedy cover of an interval).
    """
    parts = checker.joined(checker.hidden_parts(lines, model.of, 0.0, 2.0 * checker.STRICT_MM))
    if not len(parts.line):
        return parts
    parts = checker.take(parts, np.lexsort((parts.low, parts.line)))
    shift = 4.0 * np.arange(len(lines.owner) + 1)
    key, last = parts.low + shift[parts.line], np.searchsorted(parts.line, np.arange(len(lines.owner)), side="right")
    best = _last_maximum(parts.high + shift[parts.line])
    line = np.unique(parts.line)
    reach = np.full(len(line), -1.0)
    found = []
    while len(line):
        at = np.searchsorted(key, reach + shift[line], side="right") - 1
        # Where nothing goes on, the next part begins.
        goes_on = (at >= 0) & (parts.line[at] == line)
        chosen = best[np.maximum(at, 0)]
        goes_on &= parts.high[chosen] > reach + ROUNDING
        chosen = np.where(goes_on, chosen, at + 1)
        kept = chosen < last[line]
        line, reach, chosen, goes_on = line[kept], reach[kept], chosen[kept], goes_on[kept]
        low = np.where(goes_on, np.maximum(reach, parts.low[chosen]), parts.low[chosen])
        found.append(checker.Parts(line, low, parts.high[chosen], parts.by[chosen]))
        reach = np.maximum(reach, parts.high[chosen])
    return checker.joined(found)


def _last_maximum(values: Floats) -> Ints:
    """(n,) where the largest of the values up to each stands."""
    running = np.maximum.accumulate(values)
    new = np.ones(len(values), dtype=np.bool_)
    new[1:] = running[1:] > running[:-1]
    return np.maximum.accumulate(np.where(new, np.arange(len(values)), 0))


def assert_certified(
    scene: object,
    drawing: Drawing,
    camera: Camera | str | None = None,
    *,
    page: Page | str | None = None,
    lines: str | Iterable[str] | None = None,
    crease_angle_deg: float = 25.0,
    style: Style | str | None = None,
    hidden: Literal["none", "dashed", "solid"] | None = None,
    size_mm: float = SIZE_MM,
    width_mm: float = CERTIFIED_MM,
) -> dict[str, int]:
    """How much was compared, where a drawing is proved; otherwise an AssertionError that names what is wrong.

    Parameters
    ----------
    scene : Scene, path, Item, Mesh, or several of these
        What is drawn.
    drawing : Drawing
        What is checked.
    camera : Camera or str, optional
        As in `draw`.
    page : Page or str, optional
        As in `draw`; its margin counts, within which all lines are.
    lines : str or iterable of str, optional
        As in `draw`.
    crease_angle_deg : float
        As in `draw`.
    style : Style or str, optional
        As in `draw`.
    hidden : {"none", "dashed", "solid"}, optional
        As in `draw`; where neither this nor the style says it, hidden lines are dashed if there are any.
    size_mm : float
        In mm, see `certificate`.
    width_mm : float
        In mm, see `certificate`.

    Returns
    -------
    dict
        The numbers of strokes, triangles, lines of meshes that have to be drawn or hidden, and named triangles.

    Raises
    ------
    AssertionError
        With what is wrong: places on the page, and how long the worst is; or with what cannot be proved.
    InputError
        See `certificate`.

    Notes
    -----
    Unlike `assert_drawing_is_right` it samples nothing: every stroke is compared with all triangles, and every contour,
    crease and border has to be there. A certificate is made of the scene, and checked by `check_certificate.py`, which
    knows nothing of this package.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot import geometry, testing
    >>> cube = geometry.box((2, 2, 2))
    >>> testing.assert_certified(cube, vp.draw(cube, "iso", hidden="solid"), "iso", hidden="solid")["lines"]
    12
    """
    how = {"page": page, "lines": lines, "crease_angle_deg": crease_angle_deg, "style": style, "hidden": hidden}
    made = certificate(scene, drawing, camera, **how, size_mm=size_mm, width_mm=width_mm)  # type: ignore[arg-type]
    wrong, unproven, counts = checker.check(json.loads(json_bytes(drawing)), made.content)
    assert not wrong, "; ".join(wrong)
    assert not unproven, f"not proven: {'; '.join(unproven)}"
    return counts

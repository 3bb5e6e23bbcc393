"""Arrows and axes: curves in space, hidden like any others, and labels at them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.curve import Curve, is_curve
from vectorplot.curves.families.line import Line
from vectorplot.curves.parameters import vector
from vectorplot.errors import InputError
from vectorplot.scene.item import Item
from vectorplot.scene.naming.labels import USUAL_SIZE_MM, Label, OnCurve
from vectorplot.scene.scene import Scene

OWN_LINES = ("label", "centre")
"""What annotations are drawn as."""

PLACES = 17
"""On each annotation, which say how far it reaches."""

MOST_TICKS = 1000
"""On one axis."""


def arrow(start: ArrayLike, end: ArrayLike, text: str = "", *, name: str = "", size_mm: float = USUAL_SIZE_MM) -> Scene:
    """A straight arrow in space, with a text at its tip.

    Parameters
    ----------
    start, end : (3,) array_like of float
        In the world; the tip is at the end.
    text : str
        What it is called.
    name : str
        Of the item; arrow and the text where none is given.
    size_mm : float
        Of the letters.

    Returns
    -------
    Scene
        A thin line, hidden like any other curve, and a label with an arrowhead, to be drawn together with others.

    Raises
    ------
    InputError
        For an arrow without length.

    Examples
    --------
    >>> import vectorplot as vp
    >>> from vectorplot.surfaces import Sphere
    >>> drawing = vp.draw([Sphere(1.0), vp.arrow((0, 0, 1), (0, 0, 2), "n")])
    >>> drawing.items
    ('sphere', 'arrow n')
    """
    item = thin_line(name or f"arrow {text}".strip(), Line.through(start, end))
    return Scene((item,), labels=(Label(text, OnCurve(item.name), item.name, size_mm, mark="arrow"),))


def axes(
    length: float | Sequence[float] = 1.0,
    *,
    origin: ArrayLike = (0.0, 0.0, 0.0),
    names: Sequence[str] = ("x", "y", "z"),
    ticks: float | None = None,
    size_mm: float = USUAL_SIZE_MM,
) -> Scene:
    """Three coordinate axes with their names, and numbers at ticks.

    Parameters
    ----------
    length : float or three of them
        Of the axes from the origin, in world units.
    origin : (3,) array_like of float
        Where they begin.
    names : three str
        At their tips.
    ticks : float, optional
        The step between ticks; without one there are none.
    size_mm : float
        Of the names; numbers have two thirds of it.

    Returns
    -------
    Scene
        Thin lines, hidden like any other curves, and their labels, to be drawn together with others.

    Raises
    ------
    InputError
        For lengths and a step that are not positive, and more than a thousand ticks.

    Examples
    --------
    >>> import vectorplot as vp
    >>> [label.text for label in vp.axes(2.5, ticks=1).labels]
    ['x', '1', '2', 'y', '1', '2', 'z', '1', '2']
    """
    base = vector("axes: origin", origin)
    lengths = [float(one) for one in (length if isinstance(length, Sequence) else [length] * 3)]
    if len(lengths) != 3 or len(names) != 3 or not all(0.0 < one < np.inf for one in lengths):
        raise InputError("axes: expected one positive length or three, and three names")
    if ticks is not None and not (ticks > 0.0 and max(lengths) <= MOST_TICKS * ticks):
        raise InputError(f"axes: ticks every {ticks:g}: expected a positive step, and at most {MOST_TICKS} of them")
    items, labels = [], []
    for way, one, text in zip(np.eye(3), lengths, names, strict=True):
        item = thin_line(f"axis {text}", Line.through(base, base + one * way))
        items.append(item)
        labels.append(Label(text, OnCurve(item.name), item.name, size_mm, mark="arrow"))
        steps = np.arange(1, int(one / ticks) + 1) if ticks else np.zeros(0)
        # The last tick would lie under the arrowhead.
        for at in (steps * (ticks or 0.0)).tolist():
            if at < 0.95 * one:
                place = OnCurve(item.name, at / one)
                labels.append(Label(f"{at:g}", place, f"{item.name} {at:g}", size_mm * 2.0 / 3.0, mark="tick"))
    return Scene(tuple(items), labels=tuple(labels))


def is_annotation(item: Item) -> bool:
    """Whether an item is a line of an axis, a dimension, a leader or a centre line: pictures show it as they show
    labels, whatever other lines they have."""
    return is_curve(item.shape) and item.lines is not None and len(item.lines) == 1 and item.lines[0] in OWN_LINES


def only_annotations(scene: Scene) -> Scene:
    """The scene, of which only annotations have lines."""
    items = (item if is_annotation(item) else replace(item, lines=()) for item in scene.items)
    return replace(scene, items=tuple(items))


def annotation_points(scene: Scene) -> Floats:
    """(n,3) places on the annotations of a scene, their ends among them."""
    shapes = [item.shape for item in scene.items if is_annotation(item)]
    found = [shape.points(np.linspace(shape.start, shape.end, PLACES)) for shape in shapes if is_curve(shape)]
    return np.concatenate([np.zeros((0, 3)), *found])


def leader_tips(scene: Scene) -> dict[str, Floats]:
    """(3,) what each leader of a scene points at, by the name of its item: the start of a line that has its only
    arrowhead there."""
    marks = [one.at for one in scene.labels if one.mark == "arrow" and isinstance(one.at, OnCurve)]
    heads = Counter(at.item for at in marks)
    curves = {item.name: item.shape for item in scene.items if is_annotation(item) and is_curve(item.shape)}
    names = [at.item for at in marks if at.part == 0.0 and heads[at.item] == 1]
    return {name: curves[name].points(np.array(curves[name].start)) for name in names if name in curves}


def thin_line(name: str, curve: Curve, group: str = "") -> Item:
    """A curve that is drawn as leaders are; group: of the lines that belong together."""
    return Item(name, curve, "black", lines=("label",), group=group or name)

"""Arrows, axes, dimensions and angles: curves in space, hidden like any others, and labels at them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.curves.circle import Circle
from vectorplot.curves.curve import Curve
from vectorplot.curves.line import Line
from vectorplot.curves.parameters import vector
from vectorplot.errors import InputError
from vectorplot.geometry.vectors import cross, normalize
from vectorplot.scene.naming.labels import USUAL_SIZE_MM, Along, Label, OnCurve
from vectorplot.scene.scene import Item, Scene

BEYOND, SHORT = 0.15, 0.05
"""How far extension lines go on beyond the dimension line, and how far from the thing they begin, as parts of the way
between."""

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
    item = _thin(name or f"arrow {text}".strip(), Line.through(start, end))
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
        item = _thin(f"axis {text}", Line.through(base, base + one * way))
        items.append(item)
        labels.append(Label(text, OnCurve(item.name), item.name, size_mm, mark="arrow"))
        steps = np.arange(1, int(one / ticks) + 1) if ticks else np.zeros(0)
        # The last tick would lie under the arrowhead.
        for at in (steps * (ticks or 0.0)).tolist():
            if at < 0.95 * one:
                place = OnCurve(item.name, at / one)
                labels.append(Label(f"{at:g}", place, f"{item.name} {at:g}", size_mm * 2.0 / 3.0, mark="tick"))
    return Scene(tuple(items), labels=tuple(labels))


def dimension(
    start: ArrayLike, end: ArrayLike, offset: ArrayLike, text: str | None = None, *, size_mm: float = USUAL_SIZE_MM
) -> Scene:
    """A dimension line beside two points, with extension lines, arrowheads and its measure.

    Parameters
    ----------
    start, end : (3,) array_like of float
        Between which points is measured.
    offset : (3,) array_like of float
        From these points to the dimension line.
    text : str, optional
        What it says: the distance of the points where nothing is given.
    size_mm : float
        Of the letters.

    Returns
    -------
    Scene
        Thin lines, hidden like any other curves, and their labels, to be drawn together with others.

    Raises
    ------
    InputError
        For points in one place, and an offset without length.

    Notes
    -----
    The look is that of ISO 129-1: arrowheads of 20 degrees, the measure above the line.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.dimension((0, 0, 0), (3, 4, 0), (0, 0, -1)).labels[-1].text
    '5'
    """
    one, other, off = (vector("dimension: a point", point) for point in (start, end, offset))
    long = float(np.linalg.norm(other - one))
    if not long > 0.0 or not np.any(off):
        raise InputError("dimension: two different points and an offset are needed")
    said = f"{long:g}" if text is None else text
    lines = [
        Line.through(one + SHORT * off, one + (1.0 + BEYOND) * off),
        Line.through(other + SHORT * off, other + (1.0 + BEYOND) * off),
        Line.through(one + off, other + off),
    ]
    names = [f"extension {said} 1", f"extension {said} 2", f"dimension {said}"]
    items = tuple(map(_thin, names, lines))
    return Scene(items, labels=_measured(items[2].name, said, size_mm))


def angle(
    vertex: ArrayLike,
    one: ArrayLike,
    other: ArrayLike,
    radius: float,
    text: str | None = None,
    *,
    size_mm: float = USUAL_SIZE_MM,
) -> Scene:
    """The arc of an angle, with arrowheads and its measure.

    Parameters
    ----------
    vertex : (3,) array_like of float
        Of the angle.
    one, other : (3,) array_like of float
        Points on its sides.
    radius : float
        Of the arc, in world units.
    text : str, optional
        What it says: the angle in degrees where nothing is given.
    size_mm : float
        Of the letters.

    Returns
    -------
    Scene
        A thin arc, hidden like any other curve, and its labels, to be drawn together with others.

    Raises
    ------
    InputError
        For sides in one line, and a radius that is not positive.

    Examples
    --------
    >>> import vectorplot as vp
    >>> vp.angle((0, 0, 0), (1, 0, 0), (1, 1, 0), radius=0.5).labels[-1].text
    '45°'
    """
    middle = vector("angle: vertex", vertex)
    first, second = (normalize(vector("angle: a point", point) - middle) for point in (one, other))
    axis = cross(first, second)
    sine, cosine = float(np.linalg.norm(axis)), float(first @ second)
    if not sine > 0.0 or not 0.0 < radius < np.inf:
        raise InputError("angle: two sides that are not in one line, and a positive radius are needed")
    begins = _angle_on(Circle(middle, radius, axis), middle, first)
    arc = Circle(middle, radius, axis, begins, begins + float(np.arctan2(sine, cosine)))
    said = f"{np.degrees(np.arctan2(sine, cosine)):.4g}°" if text is None else text
    item = _thin(f"angle {said}", arc)
    return Scene((item,), labels=_measured(item.name, said, size_mm))


def _measured(name: str, said: str, size_mm: float) -> tuple[Label, ...]:
    """Arrowheads at both ends of a curve, and a text along it."""
    ends = [
        Label("", OnCurve(name, part), f"{name} end {k}", size_mm, mark="arrow") for k, part in enumerate((0.0, 1.0))
    ]
    return (*ends, Label(said, Along(name), name, size_mm, "above"))


def _thin(name: str, curve: Curve) -> Item:
    """A curve that is drawn as leaders are."""
    return Item(name, curve, "black", lines=("label",))


def _angle_on(circle: Circle, middle: Floats, way: Floats) -> float:
    """The parameter of a circle in a direction from its middle."""
    right, left = (circle.points(np.array(at)) - middle for at in (0.0, 0.5 * np.pi))
    return float(np.arctan2(way @ left, way @ right))

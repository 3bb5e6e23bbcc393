"""Which items of a scene are drawn in closed form, and the parts of their lines that are seen among them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import is_curve
from vectorplot.errors import InputError
from vectorplot.geometry.boxes import overlapping_boxes
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import dot
from vectorplot.scene.curve_light import curve_light
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.scene import Item, Scene
from vectorplot.scene.view import View
from vectorplot.surfaces.balls import Ball, ball_of
from vectorplot.tolerances.of_values import HOMOTHETIC
from vectorplot.visibility.polyhedra.hidden_lines import Visibility
from vectorplot.visibility.polyhedra.lines import Lines, kinds_of
from vectorplot.visibility.quadrics.arcs import Arcs, OwnSides, beyond_near, joined_arcs
from vectorplot.visibility.quadrics.bodies.balls import Balls, balls_of
from vectorplot.visibility.quadrics.conic_curves import ConicArcs
from vectorplot.visibility.quadrics.lines.ball_arcs import ball_arcs
from vectorplot.visibility.quadrics.lines.ball_meetings import (
    are_homothetic,
    balls_with_balls,
    balls_with_faces,
    overlapping_balls,
)
from vectorplot.words import LineKind

Seen = Callable[[Balls, Arcs, OwnSides], Visibility]
"""What becomes of arcs: the visible parts, or all of them counted."""


@dataclass(frozen=True, eq=False)
class ClosedForms:
    """The balls of a scene, and the parts of arcs on them that are seen among them; behind (n,): by how many items each
    is hidden."""

    balls: Balls
    arcs: Arcs
    behind: Ints

    def __len__(self) -> int:
        return len(self.arcs)

    @property
    def items(self) -> frozenset[int]:
        """The items that are drawn in closed form."""
        return frozenset(self.balls.item.tolist())

    @property
    def reached(self) -> Floats:
        """(3,k) points of the view that enclose the balls."""
        balls = self.balls
        corners = [balls.centre + balls.reach * sign for sign in _CORNERS]
        return np.concatenate([balls.sight.points_of_view(some).T for some in corners], axis=1)


CURVE_PIECES = 256
"""Boxes around a curve in space, in the search for balls that it may lie on."""

BOX_SLACK = 0.01
"""Boxes are made larger by this part on every side: a curve may bulge between the points looked at."""

_CORNERS = np.where(np.array(list(np.ndindex(2, 2, 2))) == 1, 1.0, -1.0)


def closed_forms(scene: Scene, view: View, kinds: frozenset[LineKind], seen: Seen) -> ClosedForms:
    """The spheres and ellipsoids of a scene of which all lines that are asked for are conics, and these lines.

    The others are smooth surfaces like any other: those with the eye inside, with curves of their own, isophotes of
    ellipsoids and of lamps inside, ellipsoids that meet others of another form, and all that meet surfaces which are no
    balls themselves.
    """
    balls = _balls(scene, view, kinds)
    wants = np.array([LineKind.INTERSECTION in kinds_of(item, kinds) for item in scene.items], dtype=np.bool_)
    one, two = overlapping_balls(balls)
    balls, one, two = _apart(scene, view, balls, one, two, wants)

    def asked(item: Item, kind: LineKind) -> bool:
        return kind in kinds_of(item, kinds)

    parts = ball_arcs(scene, view, balls, asked)
    parts.append(balls_with_balls(balls, one, two, wants[balls.item]))
    parts.append(balls_with_faces(view, balls, wants))
    arcs, sides = beyond_near(balls.sight, *joined_arcs(parts))
    found = seen(balls, arcs, sides)
    chosen = arcs.some(found.segment)
    span = chosen.high - chosen.low
    low, high = chosen.low + found.low * span, np.where(found.high < 1.0, chosen.low + found.high * span, chosen.high)
    return ClosedForms(balls, replace(chosen, low=low, high=high), found.hidden_by)


def lines_behind(view: View, forms: ClosedForms, lines: Lines, seen: Seen) -> Lines:
    """Lines beyond the near plane, cut where balls begin or end to hide them, and what is seen of them; the arcs on the
    balls themselves as they are."""
    own = np.zeros(len(lines), dtype=np.bool_)
    if lines.chords is not None:
        curves = lines.chords.curves
        conic = np.array([isinstance(family, ConicArcs) for family in curves.families] + [False])
        chord = lines.chords.chord
        own[chord >= 0] = conic[curves.family[curves.owner[chord[chord >= 0]]]]
    others = np.flatnonzero(~own)
    sight = forms.balls.sight
    start, end = sight.points(lines.start[:, others].T), sight.points(lines.end[:, others].T)
    count = len(others)
    arcs = Arcs(
        start,
        end - start,
        np.zeros_like(start),
        np.zeros(count),
        np.ones(count),
        np.ones(count, dtype=np.bool_),
        lines.kind[others],
        lines.item[others],
        np.full((count, 2), -1, dtype=np.intp),
        lines.side[others],
    )
    none = np.zeros(0, dtype=np.intp)
    found = seen(forms.balls, arcs, OwnSides(none, np.zeros((0, 4)), none))
    kept = np.flatnonzero(own)
    which = np.concatenate([kept, others[found.segment]])
    low = np.concatenate([np.zeros(len(kept)), found.low])
    high = np.concatenate([np.ones(len(kept)), found.high])
    cut = lines.cut(view, which, low, high)
    hidden = np.concatenate([np.zeros(len(kept), dtype=np.intp), found.hidden_by])
    return replace(cut, behind=cut.behind + hidden)


def _balls(scene: Scene, view: View, kinds: frozenset[LineKind]) -> Balls:
    """The items of which all that is wanted has a closed form, by themselves."""
    found = [(number, ball) for number, item in enumerate(scene.items) if (ball := ball_of(item.shape))]
    which = np.array([number for number, _ in found], dtype=np.intp)
    balls = balls_of(view, scene.items, which, [ball for _, ball in found])
    outside = np.ones(len(balls), dtype=np.bool_)
    if balls.sight.central and len(balls):
        distance = np.sqrt(dot(balls.eye, balls.eye)) - 1.0
        outside = distance * balls.reach.min(axis=1) > balls.tolerance
    usual = np.array(
        [_is_conic(scene, view, scene.items[number], ball, kinds) for number, ball in found], dtype=np.bool_
    )
    return balls.some(np.flatnonzero(outside & usual))


def _is_conic(scene: Scene, view: View, item: Item, ball: Ball, kinds: frozenset[LineKind]) -> bool:
    """Whether all lines that an item asks for are conics."""
    lines = item.curves
    if not lines:
        return True
    wanted = kinds_of(item, kinds)
    if lines.paths and LineKind.CURVE in wanted:
        return False
    if not lines.isophotes or LineKind.ISOPHOTE not in wanted:
        return True
    product = ball.frame @ ball.frame.T
    square = float(product[0, 0])
    if np.abs(product - square * np.eye(3)).max() > HOMOTHETIC * square:
        return False
    light = curve_light(scene, view, item)
    return light.parallel or float(np.sum((np.asarray(light.position) - ball.centre) ** 2)) > square


def _apart(scene: Scene, view: View, balls: Balls, one: Ints, two: Ints, wants: Bools) -> tuple[Balls, Ints, Ints]:
    """The balls of which all intersections that are wanted are conics, and the pairs of these that overlap."""
    asked = wants[balls.item]
    pairs = np.flatnonzero(asked[one] | asked[two])
    meeting = _meets_others(scene, view, balls, wants)
    meeting[one[pairs]] |= (odd := ~are_homothetic(balls, one[pairs], two[pairs])[0])
    meeting[two[pairs]] |= odd
    while True:
        # What meets such a ball is one too: their curve is traced on both.
        joined = pairs[meeting[one[pairs]] != meeting[two[pairs]]]
        if not len(joined):
            break
        meeting[one[joined]] = meeting[two[joined]] = True
    number = np.cumsum(~meeting) - 1
    both = ~meeting[one] & ~meeting[two]
    return balls.some(np.flatnonzero(~meeting)), number[one[both]], number[two[both]]


def _meets_others(scene: Scene, view: View, balls: Balls, wants: Bools) -> Bools:
    """(n,) which balls may have an intersection that is wanted with a smooth surface that is not among them, or carry
    a curve that is an item: chords of one that lies on a ball are inside of it."""
    mine = frozenset(balls.item.tolist())
    others = [number for number, item in enumerate(scene.items) if number not in mine and _is_smooth(item)]
    result = np.zeros(len(balls), dtype=np.bool_)
    if not others or not len(balls):
        return result
    boxes = [_boxes(scene.items[number]) for number in others]
    low, high = (np.concatenate(column, axis=1) for column in zip(*boxes, strict=True))
    owner = np.repeat(np.array(others, dtype=np.intp), [box[0].shape[1] for box in boxes])
    turned = view.axes * view.scale
    centre = balls.sight.points_of_view(balls.centre) @ turned + view.centre
    frame = balls.sight.vectors(balls.frame) @ turned
    reach = np.sqrt((frame * frame).sum(axis=1))
    ball, box = overlapping_boxes((centre - reach).T, (centre + reach).T, low, high)
    beside = np.maximum(np.maximum(low[:, box].T - centre[ball], centre[ball] - high[:, box].T), 0.0)
    near = np.sqrt(dot(beside, beside)) <= np.linalg.norm(frame[ball], ord=2, axis=(1, 2))
    ball, box = ball[near], box[near]
    carries = np.array([is_curve(item.shape) for item in scene.items], dtype=np.bool_)
    result[ball[carries[owner[box]] | wants[owner[box]] | wants[balls.item[ball]]]] = True
    return result


def _is_smooth(item: Item) -> bool:
    return not isinstance(item.shape, Mesh)


def _boxes(item: Item) -> tuple[Floats, Floats]:
    """Smallest and largest coordinates (3,k) of boxes of the world around a smooth shape, piece by piece of a curve."""
    if is_curve(item.shape):
        points = item.shape.points(np.linspace(item.shape.start, item.shape.end, CURVE_PIECES + 1))
        low, high = np.minimum(points[:-1], points[1:]), np.maximum(points[:-1], points[1:])
        good = np.isfinite(low).all(axis=1) & np.isfinite(high).all(axis=1)
        low, high = low[good], high[good]
    else:
        try:
            low, high = (side[None] for side in smooth_bounds(item.shape))  # type: ignore[arg-type]
        except InputError as error:
            raise InputError(f"{item.name}: {error.cause}") from None
    slack = BOX_SLACK * (high - low).max(axis=1, initial=0.0, keepdims=True)
    return (low - slack).T, (high + slack).T

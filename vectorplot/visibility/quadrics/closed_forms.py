"""Which items of a scene are drawn in closed form, and the parts of their lines that are seen among them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.curves.curve import is_curve
from vectorplot.errors import InputError
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.boxes import overlapping_boxes
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import dot
from vectorplot.scene.added_lines import curve_light
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.surfaces.capped_bodies import Ball, ball_of, capped_quadric_of
from vectorplot.tolerances import HOMOTHETIC
from vectorplot.visibility.polyhedra.hidden_lines import Visibility
from vectorplot.visibility.polyhedra.lines import Lines, items_wanting, kinds_of
from vectorplot.visibility.quadrics.bodies import balls_of, capped_bodies_of
from vectorplot.visibility.quadrics.body_intersections import (
    are_bodies_apart,
    are_homothetic,
    balls_with_balls,
    balls_with_faces,
    capped_at_faces,
    circles_on_one_axis,
    meet_inside_balls,
    near_capped,
    on_one_axis,
    overlapping_balls,
)
from vectorplot.visibility.quadrics.body_lines import (
    are_round,
    ball_arcs,
    capped_arcs,
    capped_isophotes,
    capped_sections,
)
from vectorplot.visibility.quadrics.conic_arcs import Arcs, ConicArcs, OwnSides, beyond_near, joined_arcs
from vectorplot.visibility.quadrics.occlusion_volumes import Bodies, own_bodies
from vectorplot.words import FEATURE_KINDS, LineKind

Seen = Callable[[Bodies, Arcs, OwnSides], Visibility]
"""What becomes of arcs: the visible parts, or all of them counted."""


@dataclass(frozen=True, eq=False)
class ClosedForms:
    """The bodies of a scene, and the parts of arcs on them that are seen among them; behind (n,): by how many items
    each is hidden; traced (p,2): pairs of bodies that meet in other curves; in_faces (q,2): bodies that meet the faces
    of items in such, and these items."""

    bodies: Bodies
    arcs: Arcs
    behind: Ints
    traced: Ints
    in_faces: Ints

    def __len__(self) -> int:
        return len(self.arcs)

    @property
    def items(self) -> frozenset[int]:
        """The items that are drawn in closed form."""
        return frozenset(self.bodies.item.tolist())

    @property
    def reached(self) -> Floats:
        """(3,k) points of the view that enclose the bodies."""
        low, high = self.bodies.reach[:, 0], self.bodies.reach[:, 1]
        corners = [np.where(pick, high, low) for pick in _CORNERS]
        return np.concatenate([self.bodies.sight.points_of_view(some).T for some in corners], axis=1)


CURVE_PIECES = 256
"""Boxes around a curve in space, in the search for balls that it may lie on."""

BOX_SLACK = 0.01
"""Boxes are made larger by this part on every side: a curve may bulge between the points looked at."""

_CURVED_KINDS = frozenset(FEATURE_KINDS) - {LineKind.SUGGESTIVE}
"""Those lines of curvature that ellipsoids have, which are convex; spheres have none."""

_CORNERS = np.array(list(np.ndindex(2, 2, 2)), dtype=np.bool_)


def closed_forms(
    scene: Scene, view: View, kinds: frozenset[LineKind], seen: Seen, hidden_too: bool = False
) -> ClosedForms:
    """The bodies of a scene of which all lines that are asked for are conics and straight, and these lines.

    Bodies are spheres and ellipsoids, and frusta and parts of balls between caps. The others are smooth surfaces like
    any other: those with the eye inside, with curves of their own, with isophotes but those of spheres without a lamp
    inside and of round capped bodies in parallel light, and all that meet surfaces which are no bodies themselves.
    Ellipsoids that meet others of another form, and capped bodies that meet anything but a ball on their axis, do so in
    curves that are traced.
    hidden_too: whether hidden lines are asked for too; otherwise what two capped bodies have in common inside of a ball
    that hides, as the bonds of an atom do, is left out.
    """
    bodies = _bodies(scene, view, kinds)
    wants = items_wanting(LineKind.INTERSECTION, scene, kinds)
    bodies, met = _apart(scene, view, bodies, wants, hidden_too)

    def asked(item: Item, kind: LineKind) -> bool:
        return kind in kinds_of(item, kinds)

    wanting = wants[bodies.item]
    parts = ball_arcs(scene, view, bodies.balls, asked)
    parts.append(balls_with_balls(bodies.balls, *met.balls, wanting[: len(bodies.balls)]))
    parts.append(balls_with_faces(view, bodies.balls, wants))
    count, items = len(bodies.balls), [scene.items[k] for k in bodies.capped.item.tolist()]
    parts += capped_arcs(bodies.capped, count, items, asked)
    parts += capped_sections(view, bodies.capped, count, items, asked)
    parts += capped_isophotes(scene, view, bodies.capped, count, items, asked)
    parts.append(circles_on_one_axis(bodies, *met.on_axis, wanting))
    arcs, sides = beyond_near(bodies.sight, *joined_arcs(parts))
    found = seen(bodies, arcs, sides)
    chosen = arcs.take(found.segment)
    span = chosen.high - chosen.low
    low, high = chosen.low + found.low * span, np.where(found.high < 1.0, chosen.low + found.high * span, chosen.high)
    return ClosedForms(bodies, replace(chosen, low=low, high=high), found.hidden_by, met.traced, met.in_faces)


def lines_behind(view: View, forms: ClosedForms, lines: Lines, seen: Seen) -> Lines:
    """Lines beyond the near plane, cut where bodies begin or end to hide them, and what is seen of them; the arcs on
    the bodies themselves as they are."""
    own, curve = np.zeros(len(lines), dtype=np.bool_), np.full(len(lines), -1)
    if lines.chords is not None:
        curves = lines.chords.curves
        conic = np.array([isinstance(family, ConicArcs) for family in curves.families] + [False])
        chord = lines.chords.chord
        curve[chord >= 0] = curves.owner[chord[chord >= 0]]
        own = conic[np.append(curves.family, -1)[curve]]
    others = np.flatnonzero(~own)
    sight = forms.bodies.sight
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
        np.zeros(count),
    )
    none = np.zeros(0, dtype=np.intp)
    sides = OwnSides(none, np.zeros((0, 4)), none)
    if lines.chords is not None:
        bodies, sides = own_bodies(forms.bodies, lines.chords.curves, curve[others])
        arcs = replace(arcs, own=bodies)
    found = seen(forms.bodies, arcs, sides)
    kept = np.flatnonzero(own)
    which = np.concatenate([kept, others[found.segment]])
    low = np.concatenate([np.zeros(len(kept)), found.low])
    high = np.concatenate([np.ones(len(kept)), found.high])
    cut = lines.cut(view, which, low, high)
    hidden = np.concatenate([np.zeros(len(kept), dtype=np.intp), found.hidden_by])
    return replace(cut, behind=cut.behind + hidden)


def _bodies(scene: Scene, view: View, kinds: frozenset[LineKind]) -> Bodies:
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
    balls = balls.take(np.flatnonzero(outside & usual))
    ends = [(number, body) for number, item in enumerate(scene.items) if (body := capped_quadric_of(item.shape))]
    simple = [(number, body) for number, body in ends if _has_simple_lines(scene, view, scene.items[number], kinds)]
    which = np.array([number for number, _ in simple], dtype=np.intp)
    capped = capped_bodies_of(view, scene.items, which, [body for _, body in simple])
    lit = np.array([_has_isophotes(scene.items[number], kinds) for number, _ in simple], dtype=np.bool_)
    return Bodies(balls, capped.take(~capped.has_eye_inside & (~lit | are_round(capped))))


def _has_simple_lines(scene: Scene, view: View, item: Item, kinds: frozenset[LineKind]) -> bool:
    """Whether an item asks for lines that are straight or conics on any capped body that is round."""
    if _has_own_curves(item, kinds):
        return False
    return not _has_isophotes(item, kinds) or curve_light(scene, view, item).parallel


def _has_own_curves(item: Item, kinds: frozenset[LineKind]) -> bool:
    lines, wanted = item.curves, kinds_of(item, kinds)
    return bool((lines.paths and LineKind.CURVE in wanted) or (lines.integral and LineKind.INTEGRAL in wanted))


def _has_isophotes(item: Item, kinds: frozenset[LineKind]) -> bool:
    return bool(item.curves.isophotes) and LineKind.ISOPHOTE in kinds_of(item, kinds)


def _is_conic(scene: Scene, view: View, item: Item, ball: Ball, kinds: frozenset[LineKind]) -> bool:
    """Whether all lines that an item asks for are conics."""
    if kinds_of(item, kinds) & _CURVED_KINDS and not _is_sphere(ball):
        return False
    if _has_own_curves(item, kinds):
        return False
    if not _has_isophotes(item, kinds):
        return True
    if not _is_sphere(ball):
        return False
    light, square = curve_light(scene, view, item), float(matmul(ball.frame[0], ball.frame[0]))
    return light.parallel or float(np.sum((np.asarray(light.position) - ball.centre) ** 2)) > square


def _is_sphere(ball: Ball) -> bool:
    product = matmul(ball.frame, ball.frame.T)
    square = float(product[0, 0])
    return bool(np.abs(product - square * np.eye(3)).max() <= HOMOTHETIC * square)


Pairs = tuple[Ints, Ints]


@dataclass(frozen=True, eq=False)
class _Met:
    """Which bodies meet: pairs of balls, in circles; balls and, numbered by themselves, capped bodies on whose axes
    they are; traced (p,2) all other pairs; in_faces (q,2): capped bodies, and items with faces that they meet."""

    balls: Pairs
    on_axis: Pairs
    traced: Ints
    in_faces: Ints


def _apart(scene: Scene, view: View, bodies: Bodies, wants: Bools, hidden_too: bool) -> tuple[Bodies, _Met]:
    """The bodies that meet no other surfaces where that is wanted, and which of them meet."""
    count, asked = len(bodies.balls), wants[bodies.item]
    one, two = overlapping_balls(bodies.balls)
    first, second = near_capped(bodies, asked)
    axial = first < count
    axial[axial] = on_one_axis(bodies, first[axial], second[axial] - count)
    ball, capped = first[axial], second[axial]
    first, second = first[~axial], second[~axial]
    if not hidden_too:
        flat = np.flatnonzero(first >= count)
        inside = np.zeros(len(first), dtype=np.bool_)
        inside[flat] = meet_inside_balls(bodies, first[flat] - count, second[flat] - count, ball, capped - count)
        first, second = first[~inside], second[~inside]
    apart = are_bodies_apart(bodies, first, second)
    first, second = first[~apart], second[~apart]
    body, face = capped_at_faces(view, bodies.capped)
    item = view.face_item[face]
    wanted = asked[count + body] | wants[item]
    in_faces = np.unique(np.stack([count + body[wanted], item[wanted]], axis=1), axis=0)
    both = asked[one] | asked[two]
    one, two = one[both], two[both]
    alike = are_homothetic(bodies.balls, one, two)[0]
    meeting = _meets_others(scene, view, bodies, wants)
    if meeting.any():
        met_on_axis = ~are_bodies_apart(bodies, ball, capped)
        ball, capped = ball[met_on_axis], capped[met_on_axis]
    traced = np.stack([np.concatenate([one[~alike], first]), np.concatenate([two[~alike], second])], axis=1)
    one, two = one[alike], two[alike]
    pairs = np.concatenate([np.stack([one, two]), np.stack([ball, capped]), traced.T], axis=1)
    while True:
        # What meets such a body is one too: their curve is traced on both.
        linked = pairs[:, meeting[pairs[0]] != meeting[pairs[1]]]
        if not linked.size:
            break
        meeting[linked] = True
    number = np.cumsum(~meeting) - 1
    left = int((~meeting[:count]).sum())
    kept, inner = ~meeting[one] & ~meeting[two], ~meeting[ball] & ~meeting[capped]
    in_faces = in_faces[~meeting[in_faces[:, 0]]]
    met = _Met(
        (number[one[kept]], number[two[kept]]),
        (number[ball[inner]], number[capped[inner]] - left),
        number[traced[~meeting[traced].any(axis=1)]],
        np.stack([number[in_faces[:, 0]], in_faces[:, 1]], axis=1),
    )
    return bodies.take(~meeting), met


def _meets_others(scene: Scene, view: View, bodies: Bodies, wants: Bools) -> Bools:
    """(n,) which bodies may have an intersection that is wanted with a smooth surface that is not among them, or carry
    a curve that is an item: chords of one that lies on a body are inside of it."""
    mine = frozenset(bodies.item.tolist())
    others = [number for number, item in enumerate(scene.items) if number not in mine and _is_smooth(item)]
    result = np.zeros(len(bodies), dtype=np.bool_)
    if not others or not len(bodies):
        return result
    boxes = [_boxes(scene.items[number]) for number in others]
    low, high = (np.concatenate(column, axis=1) for column in zip(*boxes, strict=True))
    owner = np.repeat(np.array(others, dtype=np.intp), [box[0].shape[1] for box in boxes])
    own_low, own_high, longest = _world_boxes(view, bodies)
    body, box = overlapping_boxes(own_low.T, own_high.T, low, high)
    centre = 0.5 * (own_low + own_high)
    beside = np.maximum(np.maximum(low[:, box].T - centre[body], centre[body] - high[:, box].T), 0.0)
    near = np.sqrt(dot(beside, beside)) <= longest[body]
    body, box = body[near], box[near]
    carries = np.array([is_curve(item.shape) for item in scene.items], dtype=np.bool_)
    result[body[carries[owner[box]] | wants[owner[box]] | wants[bodies.item[body]]]] = True
    return result


def _world_boxes(view: View, bodies: Bodies) -> tuple[Floats, Floats, Floats]:
    """Smallest and largest coordinates (n,3) of bodies in the world, and (n,) how far they reach from the middle of
    these at most."""
    turned = view.axes * view.scale
    centre = matmul(bodies.sight.points_of_view(bodies.balls.centre), turned) + view.centre
    frame = matmul(bodies.sight.vectors(bodies.balls.frame), turned)
    reach = np.sqrt((frame * frame).sum(axis=1))
    farthest = np.linalg.norm(frame, ord=2, axis=(1, 2)) if len(frame) else np.zeros(0)
    capped, every = bodies.capped, np.arange(len(bodies.capped))
    sides = []
    for axis in np.concatenate([-np.eye(3), np.eye(3)]):
        direction = np.broadcast_to(bodies.sight.vectors(matmul(axis, view.axes.T)), (len(capped), 3))
        points = matmul(bodies.sight.points_of_view(capped.farthest(every, direction)), turned) + view.centre
        sides.append(matmul(points, np.abs(axis)))
    low, high = np.stack(sides[:3], axis=1), np.stack(sides[3:], axis=1)
    diagonal = 0.5 * np.sqrt(dot(high - low, high - low))
    return (
        np.concatenate([centre - reach, low]),
        np.concatenate([centre + reach, high]),
        np.concatenate([farthest, diagonal]),
    )


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

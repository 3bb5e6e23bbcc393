"""The lines on spheres and ellipsoids: contours, parameter lines, isophotes and plane sections, all of them conics."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import determinant
from vectorplot.geometry.vectors import cross, dot
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.visibility.quadrics.bodies.seen_balls import Balls
from vectorplot.visibility.quadrics.conic_arcs import Arcs, OwnSides, arcs_on
from vectorplot.visibility.quadrics.lines.asked_lines import Wants, cosines, lamps, section_planes, wanting
from vectorplot.words import LineKind

Found = tuple[Arcs, OwnSides]


def ball_arcs(scene: Scene, view: View, balls: Balls, wants: Wants) -> list[Found]:
    """The lines that items with balls ask for; wants(item, kind) tells."""
    items = [scene.items[k] for k in balls.item.tolist()]
    return [
        _contours(balls, wanting(items, wants, LineKind.CONTOUR)),
        *_parameter_lines(balls, items, wanting(items, wants, LineKind.PARAMETER)),
        _isophotes(scene, view, balls, items, wanting(items, wants, LineKind.ISOPHOTE)),
        *(
            _sections(view, balls, items, wanting(items, wants, kind), kind)
            for kind in (LineKind.SECTION, LineKind.INDEX)
        ),
    ]


def on_balls(
    balls: Balls,
    circles: tuple[Floats, Floats, Floats],
    kind: LineKind,
    ball: Ints,
    span: tuple[float, float] = (0.0, 2.0 * np.pi),
) -> Found:
    """Circles of balls (n,), in the picture where the ball shows."""
    own = np.stack([ball, np.full_like(ball, -1)], axis=1)
    low, high = np.full(len(ball), span[0]), np.full(len(ball), span[1])
    arcs = arcs_on(circles, (low, high), kind, balls.item[ball], own)
    return arcs, own_sides(balls, ball)


def own_sides(balls: Balls, ball: Ints) -> OwnSides:
    """What balls (n,), or others that are equal to them, hide of arcs (n,) on them."""
    hiding = np.flatnonzero(np.isin(balls.same, balls.same[balls.hides])[ball])
    return OwnSides(hiding, balls.polar_planes(ball[hiding]), ball[hiding])


def _contours(balls: Balls, which: Ints) -> Found:
    """The contours, which no part of their own ball hides; of equal balls that of the first one."""
    which = which[np.sort(np.unique(balls.same[which], return_index=True)[1])]
    middle, first, second = balls.contours(which)
    # Where it runs counter-clockwise in the picture its ball is on the left.
    outward = cross(first, second)
    sight = middle if balls.sight.central else np.broadcast_to([0.0, 0.0, 1.0], middle.shape)
    side = np.where(dot(outward, sight) > 0.0, 1, -1)
    own = np.stack([which, np.full_like(which, -1)], axis=1)
    low, high = np.zeros(len(which)), np.full(len(which), 2.0 * np.pi)
    arcs = arcs_on((middle, first, second), (low, high), LineKind.CONTOUR, balls.item[which], own, side)
    none = np.zeros(0, dtype=np.intp)
    return arcs, OwnSides(none, np.zeros((0, 4)), none)


def _parameter_lines(balls: Balls, items: Sequence[Item], which: Ints) -> list[Found]:
    """Meridians, from pole to pole, and circles of latitude."""
    columns = np.array([items[k].curves.columns for k in which.tolist()], dtype=np.intp)
    ball, angle = np.repeat(which, columns), 2.0 * np.pi * ragged.place(columns) / np.repeat(columns, columns)
    frame = balls.frame[ball]
    equator = np.cos(angle)[:, None] * frame[:, 0] + np.sin(angle)[:, None] * frame[:, 1]
    quarter = 0.5 * np.pi
    circles = (balls.centre[ball], equator, frame[:, 2])
    meridians = on_balls(balls, circles, LineKind.PARAMETER, ball, (-quarter, quarter))
    rows = np.array([items[k].curves.rows for k in which.tolist()], dtype=np.intp)
    inner = np.maximum(rows - 1, 0)
    ball = np.repeat(which, inner)
    latitude = np.pi * (ragged.place(inner) + 1) / np.repeat(rows, inner) - quarter
    frame = balls.frame[ball]
    radius = np.cos(latitude)[:, None]
    middle = balls.centre[ball] + np.sin(latitude)[:, None] * frame[:, 2]
    circles = (middle, radius * frame[:, 0], radius * frame[:, 1])
    return [meridians, on_balls(balls, circles, LineKind.PARAMETER, ball)]


def _isophotes(scene: Scene, view: View, balls: Balls, items: Sequence[Item], which: Ints) -> Found:
    """The isophotes of spheres: circles about the direction of the light."""
    counts, cosine = cosines(items, which)
    which, counts = which[counts > 0], counts[counts > 0]
    direction, place, far_away = lamps(scene, view, balls.sight, items, which)
    away = far_away[:, None]
    towards = np.where(away, direction, place - balls.centre[which])
    distance = np.sqrt(dot(towards, towards)) / balls.reach[which, 0]
    # In the frame of the unit sphere, which a mirrored one turns inside out.
    s = np.einsum("ni,nij->nj", towards, balls.inverse[which])
    s /= np.sqrt(dot(s, s))[:, None]
    turned = np.sign(determinant(balls.frame[which])) * (-1.0)
    owner = ragged.owner(counts)
    cosine = cosine * turned[owner]
    far, near_by = away[owner, 0], distance[owner]
    with np.errstate(all="ignore"):
        root = np.sqrt(np.maximum(near_by * near_by - 1.0 + cosine * cosine, 0.0))
        height = np.where(far, cosine, (1.0 - cosine * cosine + cosine * root) / near_by)
        # Inside a ball a lamp lights nothing outside of it.
        there = far | (near_by * near_by - 1.0 + cosine * cosine >= 0.0)
    kept = np.flatnonzero(there & (np.abs(height) < 1.0))
    ball = which[owner[kept]]
    return on_balls(balls, balls.circles(ball, s[owner[kept]], height[kept]), LineKind.ISOPHOTE, ball)


def _sections(view: View, balls: Balls, items: Sequence[Item], which: Ints, kind: LineKind) -> Found:
    """The sections of a kind with planes."""
    ball, normal, point = section_planes(view, balls.sight, items, which, kind)
    return plane_circles(balls, ball, normal, point, kind)


def plane_circles(balls: Balls, ball: Ints, normal: Floats, point: Floats, kind: LineKind) -> Found:
    """The circles in which planes through points (n,3), with normals (n,3), meet balls (n,); none where they do not, or
    touch."""
    kept, s, height = unit_planes(balls, ball, normal, point)
    return on_balls(balls, balls.circles(ball[kept], s, height), kind, ball[kept])


def unit_planes(balls: Balls, ball: Ints, normal: Floats, point: Floats) -> tuple[Ints, Floats, Floats]:
    """Which planes meet the balls, and as planes s.unit = height of the unit sphere: unit (k,3), height (k,)."""
    s = np.einsum("nij,nj->ni", balls.frame[ball], normal)
    size = np.sqrt(dot(s, s))
    height = dot(point - balls.centre[ball], normal)
    touching = balls.tolerance * np.sqrt(dot(normal, normal))
    kept = np.flatnonzero(np.abs(height) < size - touching)
    return kept, s[kept] / size[kept, None], height[kept] / size[kept]

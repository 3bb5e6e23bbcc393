"""Traced curves at the poles of a surface: borders of the domain that are a single point in space."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.zeros.zero_manifold import ZeroManifold
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.components import all_finite
from vectorplot.geometry.vectors import norm
from vectorplot.surfaces.surface import Domain, Surface
from vectorplot.tolerances.of_extent import ZERO_OF_EXTENT
from vectorplot.tolerances.of_parameters import BORDER_SEEN_FROM
from vectorplot.tolerances.of_values import NODE_OF_VALUES

STRAIGHT = -0.9999
"""Cosine of the directions of two curves into a pole from which on they are one curve."""

ALONG_A_LINE = "f touches zero along a line"
"""How the doubt of a manifold about touching places begins."""


@dataclass(frozen=True)
class Pole:
    """A border of the domain that is a single point: axis 0 for u = place, 1 for v = place; inwards 1 or -1."""

    axis: int
    place: float
    inwards: float
    size: float


def poles(surface: Surface) -> list[Pole]:
    """The poles of a surface, at most four."""
    domain = surface.domain
    lows, highs = (domain.u_start, domain.v_start), (domain.u_end, domain.v_end)
    found = []
    for axis, closed in enumerate((domain.closed_u, domain.closed_v)):
        for place, inwards in () if closed else ((lows[axis], 1.0), (highs[axis], -1.0)):
            along = np.linspace(lows[1 - axis], highs[1 - axis], 17)
            near = _points(surface, axis, along, place)
            away = _points(surface, axis, along, place + inwards * 0.1 * domain.size[axis])
            # A border with holes is no point, however little else is known.
            if np.isfinite(near).all() and _spread(near) <= ZERO_OF_EXTENT * _spread(np.concatenate([near, away])):
                found.append(Pole(axis, place, inwards, domain.size[axis]))
    return found


def _points(surface: Surface, axis: int, along: Floats, place: float) -> Floats:
    across = np.full_like(along, place)
    return surface.points(across, along) if axis == 0 else surface.points(along, across)


def _spread(points: Floats) -> float:
    """The diagonal of the box around points, those in holes left out."""
    return float(norm(np.ptp(points[all_finite(points)], axis=0)))


def through_poles(surface: Surface, found: ZeroManifold) -> ZeroManifold:
    """The branches of a manifold, those that end at a pole led to it, those that go straight on through it joined.

    Where the condition is zero at a pole but no curve leads there, the pole is an isolated point.
    """
    own = poles(surface)
    if not own:
        return found
    lines = [found.points[a:b].copy() for a, b in zip(found.offsets[:-1], found.offsets[1:], strict=True)]
    closed, turns = found.closed.tolist(), list(found.turns)
    isolated, nodes, touching = (_away(own, p) for p in (found.isolated, found.nodes, found.touching))
    for pole in own:
        # A ring around a pole, nearer than the first step from it, is the pole itself.
        kept = [k for k, line in enumerate(lines) if not _is_at(pole, line).all()]
        lines, closed, turns = [lines[k] for k in kept], [closed[k] for k in kept], [turns[k] for k in kept]
        ends = [(k, side) for k, c in enumerate(closed) for side in (0, -1) if not c and _is_at(pole, lines[k][side])]
        for k, side in ends:
            lines[k][side, pole.axis] = pole.place
        if not ends and _is_zero_at(pole, found):
            isolated = np.concatenate([isolated, _middle(pole, surface.domain)])
        if len(ends) > 2:
            nodes = np.concatenate([nodes, _middle(pole, surface.domain)])
        lines, closed, turns = _joined(surface, pole, ends, lines, closed, turns)
    # What is said of places along a line holds for those away from poles.
    alone = len(found.touching) > 0 and not len(touching)
    doubts = tuple(text for text in found.doubts if not (alone and text.startswith(ALONG_A_LINE)))
    sizes = [len(line) for line in lines]
    return replace(
        found,
        points=np.concatenate([np.zeros((0, 2)), *lines]),
        offsets=ragged.offsets(sizes),
        closed=np.array(closed, dtype=np.bool_),
        turns=np.array(turns, dtype=np.intp).reshape(-1, 2),
        isolated=isolated,
        nodes=nodes,
        touching=touching,
        doubts=doubts,
    )


def _away(own: list[Pole], points: Floats) -> Floats:
    """The points (k,2) that are at none of the poles: the condition is zero all along them."""
    for pole in own:
        points = points[~_is_at(pole, points)]
    return points


def _is_at(pole: Pole, points: Floats) -> Bools:
    """(...,) whether points (..., 2) are the pole."""
    return np.asarray(np.abs(points[..., pole.axis] - pole.place) <= 8.0 * BORDER_SEEN_FROM * pole.size)


def _is_zero_at(pole: Pole, found: ZeroManifold) -> bool:
    """Whether the condition comes down to zero at the pole, with one sign around it."""
    w = np.moveaxis(found.grid[..., 2], pole.axis, 0)
    border, inner = (w[0], w[1]) if pole.inwards > 0.0 else (w[-1], w[-2])
    one_sign = (inner > 0.0).all() or (inner < 0.0).all()
    scale = np.nanmax(np.abs(w), initial=0.0)
    return bool(one_sign and (np.abs(border) <= NODE_OF_VALUES * scale).all())


def _middle(pole: Pole, domain: Domain) -> Floats:
    """(1,2) parameters of the pole."""
    result = np.array([domain.u_start + domain.size[0] / 2.0, domain.v_start + domain.size[1] / 2.0])
    result[pole.axis] = pole.place
    return result[None]


Lines = list[Floats]


def _joined(
    surface: Surface, pole: Pole, ends: list[tuple[int, int]], lines: Lines, closed: list[bool], turns: list[Ints]
) -> tuple[Lines, list[bool], list[Ints]]:
    """The branches, with pairs of ends that arrive at the pole from opposite directions made one."""
    if len(ends) < 2:
        return lines, closed, turns
    at = np.array([lines[k][side] for k, side in ends])
    ways = surface.partials(at[:, 0], at[:, 1])[pole.axis] * pole.inwards
    with np.errstate(invalid="ignore", divide="ignore"):
        ways = ways / np.linalg.norm(ways, axis=1, keepdims=True)
    cosines = np.where(np.isfinite(matmul(ways, ways.T)), matmul(ways, ways.T), 1.0)
    np.fill_diagonal(cosines, 1.0)
    open_ends = {end: end for end in ends}
    lines, closed = list(lines), list(closed)
    while cosines.min() <= STRAIGHT:
        i, j = np.unravel_index(np.argmin(cosines), cosines.shape)
        cosines[[i, j]] = cosines[:, [i, j]] = 1.0
        (a, side_a), (b, side_b) = open_ends[ends[i]], open_ends[ends[j]]
        if a == b:
            closed[a] = True
            continue
        first = lines[a] if side_a == -1 else lines[a][::-1]
        second = lines[b] if side_b == 0 else lines[b][::-1]
        lines[a], lines[b] = np.concatenate([first, second]), second[:0]
        # The free ends of both are now the two ends of a.
        free_a, free_b = (a, -1 - side_a), (b, -1 - side_b)
        for original, now in list(open_ends.items()):
            if now == free_a:
                open_ends[original] = (a, 0)
            elif now == free_b:
                open_ends[original] = (a, -1)
    kept = [k for k, line in enumerate(lines) if len(line)]
    return [lines[k] for k in kept], [closed[k] for k in kept], [turns[k] for k in kept]

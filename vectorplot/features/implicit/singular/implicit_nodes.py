"""Where curves on an implicit surface cross, shrink to points, or meet a singular point of the surface."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.features.implicit.curve_band import Band
from vectorplot.features.implicit.implicit_mesh import ImplicitMesh
from vectorplot.features.implicit.implicit_refinement import CurveInSpace
from vectorplot.features.implicit.implicit_sides import sides_of
from vectorplot.features.implicit.polygonize import checked_values, onto_surface
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul, pseudo_inverse, symmetric_eigen
from vectorplot.geometry.chord_refinement import Traces
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.repair.weld import close_points, one_each
from vectorplot.geometry.vectors import norm
from vectorplot.surfaces.surface import ImplicitSurface, hessians
from vectorplot.tolerances.of_extent import CRITICAL_SETTLED, SECOND_DIFFERENCE_IN_SPACE
from vectorplot.tolerances.of_numbers import LEAST_DIVISOR
from vectorplot.tolerances.of_values import (
    FIRM_DIRECTION,
    NODE_IN_SPACE,
    RANK_OF_BENDING,
    SHALLOW_NODE,
    VANISHED_GRADIENT,
    VANISHED_VALUE,
)

ROUND_NODE = 4.0
"""Times the finest triangles: how far from a node the curve is led into it."""

ROUND_SINGULAR = 1.5
"""Times the longest side of the mesh: how far from a singular point of the surface the curve is led into it."""

ROUNDS = 24
"""Steps of Newton's method for critical points."""

MOST_ALONE = 64
"""Nodes or isolated points that are believed at most."""


@dataclass(frozen=True, eq=False)
class SpecialPoints:
    """nodes (n,3) where branches cross, with radii (n,) around which the curve is led into them; isolated (i,3) points;
    near (float): how near to these curves are noise; unclear (k,3): places that could not be told."""

    nodes: Floats
    radii: Floats
    isolated: Floats
    near: float
    unclear: Floats


def special_points(curve: CurveInSpace, own: ImplicitMesh, band: Band) -> SpecialPoints:
    """The special points of a curve, from the triangles of its band that are still open at the finest resolution."""
    corners = own.mesh.vertices[own.mesh.corners.reshape(-1, 3)]
    longest = float(norm(corners - np.roll(corners, 1, axis=1)).max())
    singular = _met_by(curve, isolated_singular_points(curve.surface, own, longest))
    triangles = band.nodes.points[band.triangles[band.open]]
    near = np.zeros((0, 3))
    if not len(triangles):
        return SpecialPoints(singular, np.full(len(singular), ROUND_SINGULAR * longest), near, 0.0, near)
    finest = float(np.median(np.linalg.norm(triangles - np.roll(triangles, 1, axis=1), axis=2).max(axis=1)))
    middles = triangles.mean(axis=1)
    middles = middles[_apart(middles, singular, 2.0 * ROUND_SINGULAR * longest)]
    heads = one_each(middles, 3.0 * finest)
    found, settled, ratio = _critical(curve, middles[heads], 10.0 * finest)
    zero = settled & (np.abs(curve.values(found)) <= NODE_IN_SPACE * curve.size)
    crossing, point = zero & (ratio < -SHALLOW_NODE), zero & (ratio > SHALLOW_NODE)
    nodes, isolated = _distinct(found[crossing], finest), _distinct(found[point], finest)
    if len(nodes) + len(isolated) > MOST_ALONE:
        return SpecialPoints(singular, np.full(len(singular), ROUND_SINGULAR * longest), near, 0.0, found)
    radii = np.concatenate([np.full(len(singular), ROUND_SINGULAR * longest), np.full(len(nodes), ROUND_NODE * finest)])
    unclear = found[~crossing & ~point]
    return SpecialPoints(np.concatenate([singular, nodes]), radii, isolated, ROUND_NODE * finest, unclear)


def isolated_singular_points(surface: ImplicitSurface, own: ImplicitMesh, reach: float) -> Floats:
    """(k,3) singular points of the surface on none of its singular lines, and those in which these end."""
    found = singular_points(surface, own.mesh, reach)
    sides = sides_of(surface)
    for _, lines in own.lines.kinds:
        found = found[_apart(found, lines.points, reach)]
        open_ = ~lines.closed
        ends = lines.points[np.concatenate([lines.offsets[:-1][open_], lines.offsets[1:][open_] - 1])]
        inside = sides.has(ends) & ~sides.on(ends).any(axis=1)
        found = _distinct(np.concatenate([found, ends[inside]]), 0.5 * reach)
    return found


def _met_by(curve: CurveInSpace, points: Floats) -> Floats:
    """Those of the points (k,3) that the curve passes, as far as the condition tells: where it is about normals it has
    no value at a singular point, and holds next to it."""
    return points[~(np.abs(curve.values(points)) > NODE_IN_SPACE * curve.size)]


def singular_points(surface: ImplicitSurface, mesh: Mesh, reach: float) -> Floats:
    """(k,3) points of the surface in which the gradient of F vanishes, such as the apex of a cone.

    They are looked for from the vertices where the gradient is small, by Newton's method.
    """
    with np.errstate(all="ignore"):
        steep = np.linalg.norm(surface.gradients(mesh.vertices), axis=1)
        usual = float(np.nanmedian(steep)) if np.isfinite(steep).any() else 0.0
        flat = mesh.vertices[~(steep > 0.2 * usual)]
        if not len(flat):
            return np.zeros((0, 3))
        start = flat[one_each(flat, 0.5 * reach)]
        x = start.copy()
        for _ in range(ROUNDS):
            bends = np.nan_to_num(hessians(surface, x))
            step = (
                matmul(pseudo_inverse(bends, rcond=RANK_OF_BENDING), np.nan_to_num(surface.gradients(x))[..., None])
            )[..., 0]
            x = x - step * np.minimum(1.0, reach / np.maximum(np.linalg.norm(step, axis=1), LEAST_DIVISOR))[:, None]
        flatness = np.nan_to_num(np.linalg.norm(surface.gradients(x), axis=1), nan=np.inf)
        on = np.abs(checked_values(surface, x)) <= VANISHED_VALUE * usual * reach
    stays = np.linalg.norm(x - start, axis=1) <= 4.0 * reach
    found = _distinct(x[on & stays & sides_of(surface).has(x) & (flatness <= VANISHED_GRADIENT * usual)], 0.5 * reach)
    return found if len(found) <= MOST_ALONE else found[:0]


def _critical(curve: CurveInSpace, start: Floats, reach: float) -> tuple[Floats, Bools, Floats]:
    """Critical points (k,3) of g on the surface near start (k,3), which were found, and the ratio (k,) of the smaller
    to the larger principal second derivative of g there: negative at saddles."""
    x, ratio = start.copy(), np.zeros(len(start))
    settled = np.zeros(len(start), dtype=np.bool_)
    step = np.zeros((len(start), 3))
    for _ in range(ROUNDS):
        if not len(x):
            break
        slope, bend, frame = _second_order(curve, x)
        with np.errstate(all="ignore"):
            values, vectors = symmetric_eigen(np.nan_to_num(bend))
            largest = np.abs(values).max(axis=1, keepdims=True)
            # Along a direction in which g hardly bends there is nothing to be found.
            firm = np.abs(values) > FIRM_DIRECTION * largest
            along = np.einsum("kij,ki->kj", vectors, slope)
            move = np.where(firm, -along / np.where(firm, values, 1.0), 0.0)
            step = np.einsum("kij,kj,kil->kl", vectors, move, frame)
            length = np.linalg.norm(step, axis=1)
            step *= np.minimum(1.0, reach / np.maximum(length, LEAST_DIVISOR))[:, None]
            ratio = (
                np.where(values[:, 0] * values[:, 1] < 0.0, -1.0, 1.0)
                * np.abs(values).min(axis=1)
                / np.maximum(largest[:, 0], LEAST_DIVISOR)
            )
        x = onto_surface(curve.surface, x + np.nan_to_num(step), reach=reach)[0]
        settled = np.isfinite(length) & (length <= CRITICAL_SETTLED * curve.extent + 10.0 * curve.noise)
    settled &= np.linalg.norm(x - start, axis=1) <= 2.0 * reach
    return x, settled, ratio


def _second_order(curve: CurveInSpace, x: Floats) -> tuple[Floats, Floats, Floats]:
    """Slopes (k,2) and second derivatives (k,2,2) of g along the surface, in frames (k,2,3) of the tangent planes."""
    normal, slope = curve.slopes(x)
    axis = np.eye(3)[np.argmin(np.abs(normal), axis=1)]
    first = np.cross(normal, axis)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    frame = np.stack([first, np.cross(normal, first)], axis=1)
    h = SECOND_DIFFERENCE_IN_SPACE * curve.extent + 100.0 * curve.noise
    with np.errstate(all="ignore"):
        change = [
            (curve.condition.gradients(x + h * frame[:, k]) - curve.condition.gradients(x - h * frame[:, k]))
            / (2.0 * h)
            for k in (0, 1)
        ]
        own = np.einsum("kjl,ikl->kij", frame, np.stack(change))
        gradient = curve.surface.gradients(x)
        across = (curve.condition.gradients(x) * normal).sum(axis=1) / np.linalg.norm(gradient, axis=1)
        curved = np.einsum("kil,klm,kjm->kij", frame, hessians(curve.surface, x), frame)
    bend = (own + own.transpose(0, 2, 1)) / 2.0 - across[:, None, None] * curved
    return np.einsum("kil,kl->ki", frame, slope), np.asarray(bend), frame


def joined_at_nodes(lines: Traces, closed: Bools, special: SpecialPoints) -> tuple[Traces, Bools]:
    """Polylines led into the nodes near which they pass, and through them as straight as possible.

    closed (m,): which polylines are. Curves that lie near an isolated point as a whole are dropped.
    """
    points = lines.points
    node = np.full(len(points), -1)
    for k, (place, radius) in enumerate(zip(special.nodes, special.radii, strict=True)):
        node[np.linalg.norm(points - place, axis=1) < radius] = k
    for place in special.isolated:
        node[(np.linalg.norm(points - place, axis=1) < special.near) & (node < 0)] = len(special.nodes)
    starts = np.append(0, lines.ends + 1)
    line = ragged.owner(np.diff(starts))
    touched = np.bincount(line[node >= 0], minlength=len(closed)) > 0
    if not touched.any():
        return lines, closed
    whole = [points[a:b] for a, b, t in zip(starts[:-1], starts[1:], touched, strict=True) if not t]
    flags = closed[~touched].tolist()
    pieces: list[Floats] = []
    ends: list[tuple[int, int]] = []
    for k in np.flatnonzero(touched).tolist():
        run = slice(starts[k], starts[k + 1])
        cut_pieces, cut_ends = _cut(points[run], node[run], bool(closed[k]), special.nodes)
        pieces += cut_pieces
        ends += cut_ends
    joined, rings = _through(pieces, np.array(ends, dtype=np.intp).reshape(-1, 2))
    parts = [part for part in whole + joined if len(part) > 1]
    flags = [f for f, part in zip(flags + rings, whole + joined, strict=True) if len(part) > 1]
    if not parts:
        return Traces(points[:0], lines.last[:0]), closed[:0]
    is_last = np.zeros(sum(len(part) for part in parts), dtype=np.bool_)
    is_last[np.cumsum([len(part) for part in parts]) - 1] = True
    return Traces(np.concatenate(parts), is_last), np.array(flags, dtype=np.bool_)


def _cut(points: Floats, node: Ints, closed: bool, nodes: Floats) -> tuple[list[Floats], list[tuple[int, int]]]:
    """The pieces of a polyline outside the nodes' neighbourhoods (node (p,) >= 0), led into them; and for each the
    nodes at its two ends, or -1."""
    if closed:
        shift = int(np.argmax(node >= 0))
        turn = (np.arange(len(points)) + shift) % (len(points) - 1)
        turn[-1] = shift % (len(points) - 1)
        points, node = points[turn], node[turn]
    outside = node < 0
    begins = np.flatnonzero(outside & ~np.concatenate([[False], outside[:-1]]))
    stops = np.flatnonzero(outside & ~np.concatenate([outside[1:], [False]])) + 1
    pieces, ends = [], []
    for a, b in zip(begins, stops, strict=True):
        before = int(node[a - 1]) if a > 0 else -1
        after = int(node[b]) if b < len(node) else -1
        before, after = (k if k < len(nodes) else -1 for k in (before, after))
        parts = [points[a:b]]
        if before >= 0:
            parts.insert(0, nodes[before : before + 1])
        if after >= 0:
            parts.append(nodes[after : after + 1])
        pieces.append(np.concatenate(parts))
        ends.append((before, after))
    return pieces, ends


def _through(pieces: list[Floats], ends: Ints) -> tuple[list[Floats], list[bool]]:
    """The pieces joined in pairs at their nodes, the straightest pairs first; and which of the results are closed."""
    mate = {}
    for node in np.unique(ends[ends >= 0]):
        here = [(int(k), int(side)) for k, side in np.argwhere(ends == node)]
        inward = np.array(
            [
                pieces[k][min(1, len(pieces[k]) - 1)] - pieces[k][0]
                if side == 0
                else pieces[k][-min(2, len(pieces[k]))] - pieces[k][-1]
                for k, side in here
            ]
        )
        inward /= np.maximum(np.linalg.norm(inward, axis=1, keepdims=True), LEAST_DIVISOR)
        if len(here) % 2:
            continue
        cosine = matmul(inward, inward.T)
        np.fill_diagonal(cosine, np.inf)
        free = set(range(len(here)))
        for flat in np.argsort(cosine, axis=None, kind="stable"):
            i, j = divmod(int(flat), len(here))
            if i != j and i in free and j in free:
                free -= {i, j}
                mate[here[i]], mate[here[j]] = here[j], here[i]
    return _chained(pieces, mate)


def _chained(pieces: list[Floats], mate: dict[tuple[int, int], tuple[int, int]]) -> tuple[list[Floats], list[bool]]:
    """The pieces one after the other along mate, which links their ends (piece, side); closed ones repeat their first
    point."""
    used: set[int] = set()
    lines, rings = [], []
    loose = [k for k in range(len(pieces)) if (k, 0) not in mate] + [
        k for k in range(len(pieces)) if (k, 1) not in mate
    ]
    for first in loose + list(range(len(pieces))):
        if first in used:
            continue
        # Enter at the loose end.
        entry: tuple[int, int] | None = (first, 1 if (first, 1) not in mate and (first, 0) in mate else 0)
        parts: list[Floats] = []
        while entry is not None and entry[0] not in used:
            used.add(entry[0])
            own = pieces[entry[0]] if entry[1] == 0 else pieces[entry[0]][::-1]
            parts.append(own if not parts else own[1:])
            entry = mate.get((entry[0], 1 - entry[1]))
        lines.append(np.concatenate(parts))
        rings.append(entry is not None)
    return lines, rings


def _distinct(points: Floats, distance: float) -> Floats:
    """(k,3) the points, those within a distance of one another as one."""
    return points[np.unique(close_points(points, distance))] if len(points) else points


def _apart(points: Floats, others: Floats, distance: float) -> Ints:
    """Indices of the points (k,3) further than a distance from all others."""
    kept = np.ones(len(points), dtype=np.bool_)
    for other in others:
        kept &= np.linalg.norm(points - other, axis=1) > distance
    return np.flatnonzero(kept)

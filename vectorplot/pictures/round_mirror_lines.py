"""The lines that curved convex mirrors show: each point where light from it is reflected to the eye.

What is seen so seems to be behind the mirror, as far as light travels, and hides there as it does on the way: see
bent_lines. A line is drawn as far as the mirror reaches and nothing stands before it.
"""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.effects.round_mirrors import RoundMirror, inside_outline, met_by_sight
from vectorplot.errors import InputWarning
from vectorplot.geometry.budget import in_turn, unresolved
from vectorplot.geometry.component_arrays import dot
from vectorplot.geometry.mesh import Mesh
from vectorplot.pictures.bent_lines import FACETS, Seeming, seeming, things_of
from vectorplot.pictures.line_sources import LineSources, traceable
from vectorplot.pictures.pipeline import Pipeline
from vectorplot.pictures.plan import plan_draw
from vectorplot.pictures.reflected_lines import Depth, Doubles, Window, nothing_of, shown_doubles
from vectorplot.scene.added_lines import default_light
from vectorplot.scene.annotations import is_annotation
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, view_of
from vectorplot.visibility.polyhedra.lines import Lines, joined_lines, straight_lines
from vectorplot.visibility.projected_faces import project_faces
from vectorplot.words import LineKind

OUTLINE = 4.0
"""What is no more tolerances of chords inside of the outline of a mirror is left out: it would be in the outline."""

SMALLER = 2.0
"""Convex mirrors show things smaller than they are, at least so many times if they are farther off than it is wide."""

EVERYWHERE = np.array([-np.inf, np.inf, -np.inf, np.inf])
"""The window of an image without borders: smallest and largest x, smallest and largest y."""


def round_reflections(shapes: LineSources, window: Window | None, how: Depth) -> Lines:
    """What curved mirrors show of the lines of a scene, where it seems to be.

    Warns: InputWarning for mirrors of other shapes, and where there are more than the budget allows.
    """
    view, items = shapes.view, shapes.scene.items
    how = replace(how, scene=replace(how.scene, lights=how.scene.lights or (default_light(view),)))
    smooth = [k for k, one in enumerate(items) if one.material.is_mirror and not isinstance(one.shape, Mesh)]
    mirrors = {k: RoundMirror.of(view, items[k].shape) for k in smooth if not is_annotation(items[k])}
    found, looked_into = list[Lines](), 0
    for number, mirror in zip(in_turn(mirrors), mirrors.values(), strict=True):
        if mirror is None:
            text = "a mirror of this shape shows no lines: balls, ellipsoids, and cylinders and cones with ends do"
            warnings.warn(f"{items[number].name}: {text}", InputWarning, stacklevel=2)
        elif looked_into == how.most:
            text = unresolved("there are mirrors that are not looked into for lines")
            warnings.warn(text, InputWarning, stacklevel=2)
            break
        else:
            found.append(_reflections(shapes, number, mirror, window, how))
            looked_into += 1
    return joined_lines(found)


def _reflections(shapes: LineSources, number: int, mirror: RoundMirror, window: Window | None, how: Depth) -> Lines:
    """What the mirror that an item is shows of all others."""
    view, others = shapes.view, _without(how.scene, number)
    box, seen_in = _box(view, how.corners[number], window)
    if (box[::2] > box[1::2]).any():
        return joined_lines([])
    shown = seeming(things_of(shapes, others, how, SMALLER * FACETS), mirror, box, seen_in, how)
    doubles = _doubles(view, mirror, shown, how)
    on = _on_mirror(mirror, doubles)
    if not len(on):
        return joined_lines([])
    bare = replace(others, items=tuple(replace(item, lines=()) for item in others.items))
    seen_from = view_of(bare, view)
    pipeline = Pipeline(plan_draw(bare, frozenset(), "none", 0.0), None, None)
    faces, angle = project_faces(seen_from), how.crease_angle_deg
    before = traceable(pipeline, bare, seen_from, faces, frozenset(), angle, how.budget)
    return shown_doubles(before, doubles, on, window, how)


def _without(scene: Scene, number: int) -> Scene:
    """The scene with nothing in the place of one item, and of annotations."""
    gone = (nothing_of(one) if k == number or is_annotation(one) else one for k, one in enumerate(scene.items))
    return replace(scene, items=tuple(gone))


def _box(view: View, corners: Floats, window: Window | None) -> tuple[Floats, Window | None]:
    """The box (4,) of the image in which a box (8,3) of the world is, as far as it is in a window, and as one."""
    points = view.points_of(corners)
    box = EVERYWHERE.copy()
    if not (view.depth_of(points) <= view.near).any():
        x, y = view.image_of(points)
        box = np.array([x.min(), x.max(), y.min(), y.max()])
    if window is not None:
        (left, low), (right, high) = window
        box = np.array([max(box[0], left), min(box[1], right), max(box[2], low), min(box[3], high)])
    return box, (box[[0, 2]], box[[1, 3]]) if np.isfinite(box).all() else None


def _doubles(view: View, mirror: RoundMirror, shown: Seeming, how: Depth) -> Doubles:
    """What is seen of lines where it seems to be, and where the mirror shows it."""
    seen = shown.seen(how.hidden)
    start, end = shown.lines.ends(shown.view, seen.segment, seen.low, seen.high)
    some = shown.lines.take(seen.segment)
    here, there = (met_by_sight(mirror, view, side) for side in (start, end))
    nearer = np.stack([_part_of_way(view, *ends) for ends in ((here, start), (there, end))])
    none = np.zeros(len(seen), dtype=np.intp)
    found = Doubles(start, end, here, there, nearer, some.item, some.smooth, seen.hidden_by, none)
    inside = [inside_outline(mirror, view, side) for side in (here, there)]
    return found.take(np.maximum(*inside) > OUTLINE * how.tolerance)


def _part_of_way(view: View, near: Floats, far: Floats) -> Floats:
    """(n,) after which part of the way from the eye to points (3,n) others on it are; 1 for parallel rays."""
    if view.eye is None:
        return np.ones(near.shape[1])
    one, other = (side - view.eye[:, None] for side in (near, far))
    return np.asarray(np.sqrt(dot(one, one) / dot(other, other)))


def _on_mirror(mirror: RoundMirror, doubles: Doubles) -> Lines:
    """Where the mirror shows doubles between its ends, as lines on it; the item of each is the number of its double."""
    start, end = doubles.here, doubles.there
    one, other = mirror.heights(start), mirror.heights(end)
    low, high = np.zeros(len(doubles)), np.ones(len(doubles))
    # A ball has no ends; what is seen at its poles is on it but for rounding.
    whole = mirror.is_round and mirror.low == -1.0 and mirror.high == 1.0
    for limit, side in () if whole else ((mirror.low, 1.0), (mirror.high, -1.0)):
        a, b = side * (one - limit), side * (other - limit)
        share = a / np.where(a != b, a - b, 1.0)
        low = np.where((a < 0.0) & (b >= 0.0), np.maximum(low, share), low)
        high = np.where((a >= 0.0) & (b < 0.0), np.minimum(high, share), high)
        high = np.where((a < 0.0) & (b < 0.0), -1.0, high)
    kept = np.flatnonzero(low < high)
    way = (end - start)[:, kept]
    ends = start[:, kept] + low[kept] * way, start[:, kept] + high[kept] * way
    return straight_lines(*ends, np.full(len(kept), int(LineKind.REFLECTED)), kept, np.zeros_like(kept))

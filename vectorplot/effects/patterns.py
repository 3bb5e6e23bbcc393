"""Patterns: coloured polygons on faces, and what shadows make of them."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.drawing.fills import FillKind
from vectorplot.effects.decals import Decals, joined_decals, no_decals
from vectorplot.features.mesh_lines import face_frames
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.convex_polygons import convex_faces
from vectorplot.geometry.polygon_cuts import clipped_by_convex
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.visibility.projected_faces import newell


def pattern_decals(scene: Scene, view: View) -> Decals:
    """The patterns of all items as convex polygons on faces of the view, cut at the faces' borders; those of one face
    are levels 0, 1, ... in file order. Patterns on absent faces, beside their face, or without area are left out;
    one that crosses itself is reported by an InputWarning.
    Errors: InputError for a pattern on a face that does not exist or has no area. Source: Glaeser, section 6.5, figures
    9 and 10; erratum G6-09.
    """
    parts = [_item_patterns(view, number, item) for number, item in enumerate(scene.items) if item.patterns]
    return joined_decals(*(part for part in parts if len(part)))


def _item_patterns(view: View, number: int, item: Item) -> Decals:
    mesh, patterns = item.mesh, item.patterns
    owner = np.array([pattern.face for pattern in patterns], dtype=np.intp)
    offsets = ragged.offsets([len(pattern.points) for pattern in patterns])
    flat = np.concatenate([pattern.points for pattern in patterns]).T / view.scale
    flat, offsets, source = _convex_parts(flat, offsets, view.tolerance)
    origin, along, left = face_frames(mesh, owner)
    frame = np.stack([view.points_of(origin), matmul(view.axes, along.T), matmul(view.axes, left.T)])
    faces, face_source = _faces_of(view, number, item)
    # Every part against every face of the view that is its face, or a piece of it.
    order = np.argsort(face_source, kind="stable")
    first, last = (np.searchsorted(face_source[order], owner[source], side=side) for side in ("left", "right"))
    part = ragged.owner(last - first)
    step = ragged.place(last - first)
    face = faces[order[first[part] + step]]
    points, ends, which = _clipped_in_frame(view, flat, offsets, part, face, frame[:, :, source])
    chosen = source[part[which]]
    colours = tuple(dict.fromkeys(pattern.colour for pattern in patterns))
    colour = np.array([colours.index(pattern.colour) for pattern in patterns], dtype=np.intp)
    zero = np.zeros(len(which), dtype=np.intp)
    return Decals(points, ends, face[which], zero + FillKind.PATTERN, zero, zero - 1, colour[chosen], chosen, colours)


def _convex_parts(flat: Floats, offsets: Ints, tolerance: float) -> tuple[Floats, Ints, Ints]:
    """Polygons (2,c) cut into convex ones, all turned counter-clockwise: points, offsets, and the polygon of each."""
    sizes = np.diff(offsets)
    some = np.flatnonzero(sizes >= 3)
    position, starts = ragged.take(offsets, some)
    raised = np.concatenate([flat[:, position], np.zeros((1, len(position)))])
    cut = convex_faces(raised, np.arange(len(position)), starts, tolerance)
    points = raised[:2, cut.corners]
    after = points[:, ragged.following(cut.offsets)]
    first = np.repeat(cut.offsets[:-1], np.diff(cut.offsets))
    arm, beyond = points - points[:, first], after - points[:, first]
    area = np.add.reduceat(arm[0] * beyond[1] - arm[1] * beyond[0], cut.offsets[:-1]) if len(first) else np.zeros(0)
    full = np.flatnonzero(area)
    position, ends = ragged.take(cut.offsets, full)
    turned = np.repeat(area[full] < 0.0, np.diff(ends))
    backwards = np.repeat(cut.offsets[full] + cut.offsets[full + 1] - 1, np.diff(ends)) - position
    return points[:, np.where(turned, backwards, position)], ends, some[cut.source[full]]


def _faces_of(view: View, number: int, item: Item) -> tuple[Ints, Ints]:
    """The faces of the view that an item has, and the face of its mesh that each one is (a piece of)."""
    mesh = item.mesh
    here = np.arange(mesh.face_count) if mesh.present is None else np.flatnonzero(mesh.present)
    position, offsets = ragged.take(mesh.offsets, here)
    low, high = view.item_vertices[number : number + 2]
    pieces = convex_faces(view.points[:, low:high], mesh.corners[position], offsets, view.tolerance)
    return np.flatnonzero(view.face_item == number), here[pieces.source]


def _clipped_in_frame(
    view: View, flat: Floats, offsets: Ints, part: Ints, face: Ints, frame: Floats
) -> tuple[Floats, Ints, Ints]:
    """Parts (2,c) in the frames (3,3,n), axes first, of their faces, clipped by faces of the view: points (3,c') of the
    view, offsets, and which pair of part and face each polygon comes from."""
    position, starts = ragged.take(offsets, part)
    corner, borders = ragged.take(view.offsets, face)
    origin, along, left = (np.repeat(row, np.diff(borders), axis=1) for row in frame[:, :, part])
    arm = view.points[:, view.corners[corner]] - origin
    border = np.stack([(arm * along).sum(axis=0), (arm * left).sum(axis=0)])
    cut, ends, which = clipped_by_convex(flat[:, position], starts, border, borders, tolerance=view.tolerance)
    origin, along, left = (np.repeat(row, np.diff(ends), axis=1) for row in frame[:, :, part[which]])
    return origin + cut[0] * along + cut[1] * left, ends, which


def patterns_in_shadows(view: View, patterns: Decals, shadows: Decals, dark: Bools, lights: int) -> Decals:
    """The patterns, and on them their parts in the shadow, which lack as many lights. dark (f,): faces turned away from
    all lights, whose patterns lack all. Levels begin above those of shadows: a whole pattern, its parts of grade 1,
    2, ..., then the next pattern. Source: Glaeser, section 6.5.
    """
    if not len(patterns):
        return patterns
    grades = int(shadows.grade.max(initial=0)) + 1
    ground = int(shadows.level.max(initial=-1)) + 1
    whole = Decals(
        patterns.points,
        patterns.offsets,
        patterns.face,
        patterns.kind,
        np.where(dark[patterns.face], lights, patterns.grade),
        patterns.light,
        patterns.colour,
        ground + patterns.level * grades,
        patterns.colours,
        np.where(dark[patterns.face], (1 << lights) - 1, 0),
    )
    return joined_decals(whole, in_shadows(view, whole, shadows))


def in_shadows(view: View, patterns: Decals, shadows: Decals) -> Decals:
    """The parts of patterns that lie in shadows, in the level of their pattern plus the grade of the shadow; lacking
    says which lights they lack. Parts of what light falls on by way of mirrors keep their light."""
    shadow = np.flatnonzero(shadows.kind == FillKind.SHADOW)
    shadow = shadow[np.argsort(shadows.face[shadow], kind="stable")]
    faces = shadows.face[shadow]
    first, last = (np.searchsorted(faces, patterns.face, side=side) for side in ("left", "right"))
    pattern = ragged.owner(last - first)
    if not len(pattern):
        return no_decals()
    step = ragged.place(last - first)
    shade = shadow[first[pattern] + step]
    flat = _flattened(view, patterns)[:, ragged.take(patterns.offsets, pattern)[0]]
    borders = ragged.offsets(np.diff(patterns.offsets)[pattern])
    position, starts = ragged.take(shadows.offsets, shade)
    laid = np.concatenate([_flattened(view, shadows), shadows.points])[:, position]
    cut, ends, which = clipped_by_convex(laid, starts, flat, borders, tolerance=view.tolerance)
    pattern, shade = pattern[which], shade[which]
    return Decals(
        np.ascontiguousarray(cut[2:]),
        ends,
        patterns.face[pattern],
        patterns.kind[pattern],
        shadows.grade[shade],
        np.where(patterns.kind[pattern] == FillKind.LIGHT, patterns.light[pattern], shadows.light[shade]),
        patterns.colour[pattern],
        patterns.level[pattern] + shadows.grade[shade],
        patterns.colours,
        None if shadows.lacking is None else shadows.lacking[shade],
    )


def _flattened(view: View, decals: Decals) -> Floats:
    """(2,c) the two coordinates of the corners of decals in which their faces appear largest."""
    normal, _, _ = newell(view, decals.face)
    largest = np.repeat(np.abs(normal).argmax(axis=0), np.diff(decals.offsets))
    corner = np.arange(decals.points.shape[1])
    return np.stack([decals.points[(largest + 1) % 3, corner], decals.points[(largest + 2) % 3, corner]])

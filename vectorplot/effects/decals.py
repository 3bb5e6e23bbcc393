"""Polygons that lie on faces: shadows, patterns and what else is painted right after the face it lies on."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import may_stop
from vectorplot.geometry.clipping import Polygons, cut_polygons
from vectorplot.geometry.mesh import next_positions
from vectorplot.geometry.polygon_cuts import clipped_by_convex
from vectorplot.geometry.polylines import EACH_LINE, EACH_POINT, joined, take, with_points
from vectorplot.geometry.records import IN_COLUMNS
from vectorplot.geometry.regions import corners_of, polygons_of, triangles_of, unions, without_holes, without_splinters
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import image_points
from vectorplot.visibility.projected_faces import newell


@dataclass(frozen=True, eq=False)
class Decals:
    """Polygons on faces of a View, painted right after their face. points (3,c) in the view's coordinates, on the
    planes of their faces; face (m,); kind (m,): FillKind values; grade (m,): how many lights are lacking, 0 for no
    shadow; light (m,): which light, -1 for several or none; colour (m,): index into colours, -1 for the face's own;
    level (m,): order on one face, smaller first; lacking (m,): bit k for light k that does not get there at all;
    opacity (m,).
    """

    points: Floats = field(metadata=EACH_POINT | IN_COLUMNS)
    offsets: Ints
    face: Ints = field(metadata=EACH_LINE)
    kind: Ints = field(metadata=EACH_LINE)
    grade: Ints = field(metadata=EACH_LINE)
    light: Ints = field(metadata=EACH_LINE)
    colour: Ints = field(metadata=EACH_LINE)
    level: Ints = field(metadata=EACH_LINE)
    colours: tuple[str, ...] = ()
    lacking: Ints | None = field(default=None, metadata=EACH_LINE)
    opacity: Floats | None = field(default=None, metadata=EACH_LINE)

    def __len__(self) -> int:
        return len(self.offsets) - 1

    def __repr__(self) -> str:
        return f"<Decals: {len(self)} polygons on {len(np.unique(self.face))} faces>"

    def of(self, decals: Ints) -> Decals:
        """Some of the decals, in the order asked for.

        decals: (k,) their numbers.
        """
        return take(self, decals)

    def parts(self, decals: Ints, points: Floats, offsets: Ints) -> Decals:
        """Polygons each of which is a part of one of the decals.

        decals: (k,) of which decal each is a part; points: (3, c) their corners, in the view's coordinates; offsets:
        (k+1,) polygon i has the points offsets[i] to offsets[i+1].
        """
        # Not through of: each of many parts of a decal would have all its corners first.
        anywhere = np.zeros(points.shape[1], dtype=np.intp)
        return replace(with_points(self, anywhere, decals, offsets), points=points)

    @property
    def lights_lacking(self) -> Ints:
        """(m,) the lights that do not get there, bit k for light k."""
        if self.lacking is not None:
            return self.lacking
        return np.where(self.light >= 0, np.left_shift(1, np.maximum(self.light, 0)), 0)

    @property
    def opacities(self) -> Floats:
        """(m,) how much of the face each covers, 0 to 1."""
        return np.ones(len(self)) if self.opacity is None else self.opacity

    @property
    def painting_order(self) -> Ints:
        """(m,) the decals by faces, and on each face by level, otherwise as they are."""
        return np.lexsort((self.level, self.face))


def no_decals() -> Decals:
    """No decals at all."""
    none = np.zeros(0, dtype=np.intp)
    return Decals(np.zeros((3, 0)), np.zeros(1, dtype=np.intp), none, none, none, none, none, none)


def joined_decals(*decals: Decals) -> Decals:
    """All decals one after the other; colours of the same name become one."""
    if not decals:
        return no_decals()
    colours = tuple(dict.fromkeys(name for d in decals for name in d.colours))
    number = {name: k for k, name in enumerate(colours)}
    renamed = [np.array([*(number[name] for name in d.colours), -1], dtype=np.intp)[d.colour] for d in decals]
    return joined(
        [
            replace(d, colour=colour, colours=colours, lacking=d.lights_lacking, opacity=d.opacities)
            for d, colour in zip(decals, renamed, strict=True)
        ]
    )


# Faces as planes of their own, in which regions on them can be united and cut.


@dataclass(frozen=True, eq=False)
class FaceFrames:
    """Frames of faces (n,), in any order: origin (3,n) a corner of each; along, left (3,n) unit vectors across its
    normal, so that what turns left in its plane is wound as the face."""

    origin: Floats
    along: Floats
    left: Floats

    @classmethod
    def of(cls, view: View, face: Ints) -> FaceFrames:
        """The frames of faces of a view, which have an area."""
        normal, _, first = newell(view, face)
        normal /= np.sqrt((normal * normal).sum(axis=0))
        axis = np.eye(3)[:, np.argmin(np.abs(normal), axis=0)]
        along = np.cross(axis, normal, axis=0)
        along /= np.sqrt((along * along).sum(axis=0))
        return cls(view.points[:, first], along, np.cross(normal, along, axis=0))

    def flat(self, points: Floats, owner: Ints) -> Floats:
        """(2,c) points (3,c) of the view in the frames owner (c,)."""
        arm = points - self.origin[:, owner]
        return np.stack([(arm * self.along[:, owner]).sum(axis=0), (arm * self.left[:, owner]).sum(axis=0)])

    def lifted(self, flat: Floats, owner: Ints) -> Floats:
        """(3,c) points of the view, of points (2,c) of the frames owner (c,)."""
        x, y = flat
        return np.asarray(self.origin[:, owner] + x * self.along[:, owner] + y * self.left[:, owner])


# Decals in convex parts: what is shaded from corner to corner has to be convex.


def convex_decals(view: View, decals: Decals, chosen: Bools) -> Decals:
    """The decals, those on chosen faces (f,) that are not convex cut into triangles."""
    may_stop()
    which = np.flatnonzero(chosen[decals.face] & (np.diff(decals.offsets) > 3))
    if not len(which):
        return decals
    some = decals.of(which)
    frames = FaceFrames.of(view, some.face)
    owner = ragged.owner(np.diff(some.offsets))
    flat = frames.flat(some.points, owner)
    bent = np.flatnonzero(_bent(flat, some.offsets, view.tolerance))
    if not len(bent):
        return decals
    polygons = polygons_of(flat, some.offsets)[bent]
    parts, of = triangles_of(polygons)
    corners, offsets = corners_of(parts)
    of = bent[of]
    cut = some.parts(of, frames.lifted(corners, np.repeat(of, np.diff(offsets))), offsets)
    rest = np.ones(len(decals), dtype=np.bool_)
    rest[which[bent]] = False
    return joined_decals(decals.of(np.flatnonzero(rest)), cut)


def _bent(flat: Floats, offsets: Ints, tolerance: float) -> Bools:
    """(m,) polygons (2,c) that turn both ways."""
    may_stop()
    along = flat[:, next_positions(offsets, np.arange(flat.shape[1]))] - flat
    after = along[:, next_positions(offsets, np.arange(flat.shape[1]))]
    turn = along[0] * after[1] - along[1] * after[0]
    slack = tolerance * (np.hypot(*along) + np.hypot(*after))
    left, right = (np.logical_or.reduceat(way, offsets[:-1]) for way in (turn > slack, turn < -slack))
    return np.asarray(left & right, dtype=np.bool_)


# Decals on what is painted of their faces.


@dataclass(frozen=True, eq=False)
class Laid:
    """Parts of decals in the image: points (3,c), see ImageFaces; offsets (n+1,); decal (n,) which decal each part is
    of; piece (n,) the painted polygon that it lies on, ascending, and for each the decals in the order of painting."""

    points: Floats
    offsets: Ints
    decal: Ints
    piece: Ints

    def __len__(self) -> int:
        return len(self.decal)


def laid(view: View, decals: Decals, points: Floats, offsets: Ints, source: Ints) -> Laid:
    """Decals clipped with the painted polygons that are their faces, or parts of these.

    points (2 or more, c), offsets (p+1,) and source (p,): convex polygons of the image and their faces in the view, as
    of Painted.faces; or doubles in a mirror, with mirrored decals.
    """
    may_stop()
    shape, offset, which = _in_front(view, decals)
    order = np.argsort(source, kind="stable")
    first, last = (np.searchsorted(source[order], decals.face[which], side=side) for side in ("left", "right"))
    pair = ragged.owner(last - first)
    step = ragged.place(last - first)
    piece = order[first[pair] + step]
    corner, starts = ragged.take(offset, pair)
    border, borders = ragged.take(offsets, piece)
    cut, ends, kept = clipped_by_convex(
        image_points(view, shape[:, corner]), starts, points[:2, border], borders, tolerance=view.tolerance
    )
    decal, piece = which[pair[kept]], piece[kept]
    order = np.lexsort((decal, decals.level[decal], piece))
    position, ends = ragged.take(ends, order)
    return Laid(cut[:, position], ends, decal[order], piece[order])


def _in_front(view: View, decals: Decals) -> tuple[Floats, Ints, Ints]:
    """The decals cut off at the near plane: points, offsets, and which decal each one is."""
    if view.eye is None or not len(decals):
        return decals.points, decals.offsets, np.arange(len(decals))
    beyond = view.depth_of(decals.points) - view.near
    if not (beyond < 0.0).any():
        return decals.points, decals.offsets, np.arange(len(decals))
    cut, _ = cut_polygons(Polygons(decals.points.T, decals.offsets), beyond)
    full = np.flatnonzero(np.diff(cut.offsets))
    return np.ascontiguousarray(cut.points.T), np.append(cut.offsets[full], len(cut.points)), full


# Decals that overlap, united: for what cannot be painted over, as on plotters and in transparent layers.


def united_decals(view: View, decals: Decals) -> Decals:
    """The decals with those of each face that are alike (kind, lights, colour, level) as one region, cut into simple
    polygons where it has holes.

    Regions move by less than a few tolerances. Edge cases: regions narrower than a few tolerances are left out.
    """
    if not len(decals):
        return decals
    frames = FaceFrames.of(view, decals.face)
    region, leader = _regions(decals, frames, view.tolerance)
    return _listed(decals, frames, region, leader, view.tolerance)


def disjoint_decals(view: View, decals: Decals) -> Decals:
    """The same, each without what decals of higher levels on its face cover."""
    import shapely

    if not len(decals):
        return decals
    frames = FaceFrames.of(view, decals.face)
    region, leader = _regions(decals, frames, view.tolerance)
    faces, face = np.unique(decals.face[leader], return_inverse=True)
    level = decals.level[leader]
    above: Any = np.full(len(faces), shapely.Polygon(), dtype=object)
    for height in np.unique(level)[::-1].tolist():
        here = np.flatnonzero(level == height)
        own = region[here]
        region[here] = shapely.difference(own, above[face[here]], grid_size=view.tolerance)
        covered, of = np.unique(face[here], return_inverse=True)
        number = np.concatenate([of, np.arange(len(covered))])
        above[covered] = unions(np.concatenate([own, above[covered]]), number, view.tolerance)
    return _listed(decals, frames, region, leader, view.tolerance)


def _regions(decals: Decals, frames: FaceFrames, tolerance: float) -> tuple[Any, Ints]:
    """The union of the decals that are alike, in the frames of their faces, and for each the first of its decals."""
    import shapely

    may_stop()
    sizes = np.diff(decals.offsets)
    owner = ragged.owner(sizes)
    rings = shapely.linearrings(frames.flat(decals.points, owner).T, indices=owner)
    columns = (decals.face, decals.kind, decals.level, decals.lights_lacking, decals.light, decals.colour)
    _, leader, group = np.unique(
        np.stack([*columns, decals.opacities], axis=1), axis=0, return_index=True, return_inverse=True
    )
    return unions(shapely.polygons(rings), group, tolerance), leader


def _listed(decals: Decals, frames: FaceFrames, region: Any, leader: Ints, tolerance: float) -> Decals:
    """Regions, in the frames of the decals that lead them, as decals without holes."""
    may_stop()
    parts, of = without_splinters(region, tolerance)
    parts, of = without_holes(parts, leader[of])
    flat, offsets = corners_of(parts)
    return decals.parts(of, frames.lifted(flat, np.repeat(of, np.diff(offsets))), offsets)

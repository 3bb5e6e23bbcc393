"""By how many items single points are hidden."""

from __future__ import annotations

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.budget import USUAL
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.extent import smooth_bounds
from vectorplot.scene.placement import box_corners
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.tolerances import AROUND_OF_EXTENT, NEAR_SURFACE_OF_EXTENT, TOUCHING_OF_EXTENT
from vectorplot.visibility.polyhedra.occluders import face_occluders
from vectorplot.visibility.projected_faces import ProjectedFaces

AROUND, ASKEW = 16, 0.1
"""What hides a point hides so many around it in the image, the first of them in a direction that few edges have."""

_DIRECTIONS = np.array([way for way in np.ndindex(3, 3, 3) if way != (1, 1, 1)], dtype=np.float64).T - 1.0

NEARBY = 2.5 * NEAR_SURFACE_OF_EXTENT * _DIRECTIONS / np.sqrt((_DIRECTIONS**2).sum(axis=0))
"""(3,26) steps in the view, where the scene is 2 wide: of a point that is so near to a surface one of them leads to its
other side, for no direction is more than 28 degrees off all of them."""


def points_hidden_by(scene: Scene, view: View, faces: ProjectedFaces, points: Floats) -> Ints:
    """(n,) how many items hide each of some points.

    points: (3, n) in the view's coordinates, before the near plane; result: (n,) 0 for visible points.
    """
    hides = items_before(scene, view, faces, points)
    covered = np.flatnonzero(hides.any(axis=1))
    if len(covered):
        angle = ASKEW + np.arange(AROUND) * (2.0 * np.pi / AROUND)
        ring = AROUND_OF_EXTENT * np.stack([np.cos(angle), np.sin(angle), np.zeros(AROUND)])
        near = np.concatenate([ring, NEARBY], axis=1)
        around = (points[:, covered, None] + near[:, None]).reshape(3, -1)
        beside = items_before(scene, view, faces, around).reshape(len(covered), near.shape[1], -1)
        hides[covered] &= beside.all(axis=1)
    return np.asarray(hides.sum(axis=1), dtype=np.intp)


def items_before(scene: Scene, view: View, faces: ProjectedFaces, points: Floats) -> Bools:
    """(n, items) which items are before points (3,n) in the view's coordinates; what ends exactly before a point in the
    image is."""
    items = len(scene.items)
    return _by_faces(view, faces, points, items) | _by_sheets(scene, view, points, items)


def _by_faces(view: View, faces: ProjectedFaces, points: Floats, items: int) -> Bools:
    """(n, items) which polyhedra hide points."""
    hides = np.zeros((points.shape[1], items), dtype=np.bool_)
    point, face = _near_boxes(view, faces, points)
    if not len(point):
        return hides
    which, number = np.unique(face, return_inverse=True)
    occluders = face_occluders(view, faces, which)
    count = np.diff(occluders.offsets)[number]
    pair, plane = ragged.owner(count), ragged.ranges(occluders.offsets[number], count)
    normal = occluders.planes[:, plane]
    height = (normal[:3] * points[:, point[pair]]).sum(axis=0) - normal[3]
    # The first plane is that of the face itself: what lies in it is not hidden. The others are its borders.
    first = ragged.place(count) < occluders.behind[number][pair]
    outside = np.where(first, height <= TOUCHING_OF_EXTENT, height < -view.tolerance)
    hidden = np.bincount(pair, outside, minlength=len(point)) == 0
    hides[point[hidden], view.face_item[face[hidden]]] = True
    return hides


def _near_boxes(view: View, faces: ProjectedFaces, points: Floats) -> tuple[Ints, Ints]:
    """Pairs of a point and a face that hides and whose box in the image it lies in."""
    import shapely

    image, depth = view.image_of(points), view.depth_of(points)
    able = np.flatnonzero(view.occludes[view.face_item] & (faces.facing != 0)) if len(faces) else np.zeros(0, np.intp)
    low, high = image.min(axis=1, initial=np.inf), image.max(axis=1, initial=-np.inf)
    left, right, bottom, top = faces.box
    reach = (left[able] <= high[0]) & (right[able] >= low[0]) & (bottom[able] <= high[1]) & (top[able] >= low[1])
    able = able[reach]
    tree = shapely.STRtree(shapely.points(image.T))
    number, point = tree.query(shapely.box(left[able], bottom[able], right[able], top[able]))
    before = faces.nearest[able[number]] <= depth[point]
    return point[before], able[number[before]]


def _by_sheets(scene: Scene, view: View, points: Floats, items: int) -> Bools:
    """(n, items) which smooth surfaces hide points."""
    near = [number for number, item in enumerate(scene.items) if _may_hide(item.shape, item.hides, view, points)]
    if not near:
        return np.zeros((points.shape[1], items), dtype=np.bool_)
    from vectorplot.visibility.smooth.rays import Samples, counts_in_front, targets_of
    from vectorplot.visibility.smooth.scene_curves import scene_sheets
    from vectorplot.visibility.smooth.sheets import Sheets

    sheets = Sheets(scene_sheets(scene, view, frozenset(range(items)) - frozenset(near)))
    count = points.shape[1]
    nothing, nowhere = np.full(count, -1), np.full((count, 3), np.nan)
    no = np.zeros(count, dtype=np.bool_)
    samples = Samples(points.T, nothing, nowhere, nothing[:, None], nowhere[:, None], no, no)
    counts, _ = counts_in_front(view, sheets, targets_of(view, sheets), samples, USUAL.pairs)
    return np.asarray(counts.table(count, items) > 0, dtype=np.bool_)


def _may_hide(shape: object, hides: bool, view: View, points: Floats) -> bool:
    """Whether a surface hides, and the image of the box around it has some of the points in it."""
    from vectorplot.surfaces.surface import is_implicit, is_parametrised

    if isinstance(shape, Mesh) or not hides or not (is_parametrised(shape) or is_implicit(shape)):
        return False
    corners = view.points_of(box_corners(smooth_bounds(shape)))
    if (view.depth_of(corners) <= view.near).any():
        return True
    box, image = view.image_of(corners), view.image_of(points)
    low, high = box.min(axis=1)[:, None], box.max(axis=1)[:, None]
    return bool(((image >= low) & (image <= high)).all(axis=0).any())

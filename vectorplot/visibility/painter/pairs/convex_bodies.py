"""Convex bodies, compared as wholes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.scene.view import View
from vectorplot.visibility.painter.image_faces import ImageFaces
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.projected_faces import EVERYWHERE, ProjectedFaces, newell


@dataclass(frozen=True, eq=False)
class Bodies:
    """Convex bodies with their outlines in the image.

    Parameters
    ----------
    item : (b,) array of int
        Which item of the view each is.
    corners : (2, c) array of float
        Of the outlines.
    offsets : (b+1,) array of int
        Body k has the outline offsets[k] to offsets[k+1].
    shown : (s,) array of int
        Image faces that bodies show.
    first : (b+1,) array of int
        Body k shows the image faces shown[first[k]] to shown[first[k+1]].
    sphere : (4, b) array of float
        Centres and radii of spheres around them in the view.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import visibility
    >>> from vectorplot.geometry import box
    >>> from vectorplot.scene import look
    >>> view = look(vp.Scene((vp.Item("cube", box((2, 2, 2))),)), vp.Camera((6, 5, 4)))
    >>> bodies = visibility.convex_bodies(view, visibility.painters_order(view).faces, np.array([0]))
    >>> len(bodies), bodies.offsets.tolist(), bodies.first.tolist()
    (1, [0, 6], [0, 3])
    """

    item: Ints
    corners: Floats
    offsets: Ints
    shown: Ints
    first: Ints
    sphere: Floats

    def __len__(self) -> int:
        return len(self.item)


def outlined_items(view: View, projected: ProjectedFaces) -> Bools:
    """(i,) the items that are convex bodies with an outline in the image: closed, and not through the near plane."""
    solid = solid_items(view, projected)
    solid[view.face_item[~np.isfinite(projected.nearest) | (projected.box[1] >= EVERYWHERE)]] = False
    return solid


def convex_bodies(view: View, faces: ImageFaces, items: Ints) -> Bodies:
    """Closed convex items as bodies, with their outlines and the spheres around them.

    Parameters
    ----------
    view : View
        What is seen.
    faces : ImageFaces
        Of the whole scene, those that can be seen.
    items : (b,) array of int
        Closed convex items.

    Returns
    -------
    Bodies
        Left out are bodies whose outline is, by rounding, not one closed polygon.

    Notes
    -----
    Source: Glaeser, sections 5.5 and 6.1.

    Examples
    --------
    >>> import numpy as np
    >>> import vectorplot as vp
    >>> from vectorplot import visibility
    >>> from vectorplot.geometry import box
    >>> from vectorplot.scene import look
    >>> view = look(vp.Scene((vp.Item("cube", box((2, 2, 2))),)), vp.Camera.view("top"))
    >>> bodies = visibility.convex_bodies(view, visibility.painters_order(view).faces, np.array([0]))
    >>> sorted(bodies.corners.T.tolist()), bodies.sphere[3].round(6).tolist()
    ([[0.0, 0.0], [0.0, 2.0], [2.0, 0.0], [2.0, 2.0]], [1.732051])
    """
    number = np.full(len(view.item_vertices) - 1, -1, dtype=np.intp)
    number[items] = np.arange(len(items))
    owner = number[view.face_item[faces.source]]
    shown = np.flatnonzero(owner >= 0)
    shown = shown[np.argsort(owner[shown], kind="stable")]
    corner, sizes = _outlines(view, number, len(items), faces.source[shown])
    kept = np.flatnonzero(sizes >= 3)
    listed = np.isin(owner[shown], kept)
    counts = np.bincount(owner[shown[listed]], minlength=len(items))[kept]
    return Bodies(
        items[kept],
        view.image[:, corner],
        ragged.offsets(sizes[kept]),
        shown[listed],
        ragged.offsets(counts),
        _spheres(view, items[kept]),
    )


def _outlines(view: View, number: Ints, count: int, shown: Ints) -> tuple[Ints, Ints]:
    """The vertices (c,) of the outlines one after the other, and (count,) how many each has; 0 for a body without a
    closed outline.

    The sides of an outline are those of shown faces that no other shown face shares. All outlines are walked along at
    once, a step at a time.
    """
    position, _ = ragged.take(view.offsets, shown)
    single = view.only_sides(position)
    start, end = view.corners[position[single]], view.corners[view.after(position[single])]
    owner = np.repeat(number[view.face_item[shown]], view.face_sizes[shown])[single]
    sides = np.bincount(owner, minlength=count)
    following = np.full(view.points.shape[1], -1, dtype=np.intp)
    following[start] = end
    first = np.full(count, -1, dtype=np.intp)
    first[owner[::-1]] = start[::-1]
    walking = np.flatnonzero(first >= 0)
    here = first.copy()
    steps: list[tuple[Ints, Ints]] = []
    closed_after = np.zeros(count, dtype=np.intp)
    for step in range(1, int(sides.max(initial=0)) + 1):
        steps.append((walking, here[walking]))
        here[walking] = following[here[walking]]
        home = here[walking] == first[walking]
        closed_after[walking[home]] = step
        walking = walking[~home & (here[walking] >= 0)]
    sizes = np.where((closed_after == sides) & (sides >= 3), sides, 0)
    body = np.concatenate([s[0] for s in steps] or [walking])
    vertex = np.concatenate([s[1] for s in steps] or [walking])
    order = np.argsort(body, kind="stable")
    order = order[sizes[body[order]] > 0]
    return vertex[order], sizes


def _spheres(view: View, items: Ints) -> Floats:
    """(4,n) middle of the box of each item's vertices, and the distance of the farthest one."""
    vertex, offsets = ragged.take(view.item_vertices, items)
    if not len(items):
        return np.zeros((4, 0))
    points = view.points[:, vertex]
    sizes = np.diff(offsets)
    low, high = (extreme.reduceat(points, offsets[:-1], axis=1) for extreme in (np.minimum, np.maximum))
    centre = (low + high) / 2.0
    arm = points - np.repeat(centre, sizes, axis=1)
    radius = np.sqrt(np.maximum.reduceat((arm * arm).sum(axis=0), offsets[:-1]))
    return np.concatenate([centre, radius[None]])


def spheres_apart(bodies: Bodies, first: Ints, second: Ints) -> Bools:
    """(p,) which pairs have spheres without common points: these bodies do not pierce each other.

    Source: Glaeser, section 5.5, figure 9 (soap bubbles).
    """
    one, two = bodies.sphere[:, first], bodies.sphere[:, second]
    arm, reach = one[:3] - two[:3], one[3] + two[3]
    return np.asarray((arm * arm).sum(axis=0) > reach * reach, dtype=np.bool_)


def faces_between(view: View, faces: ImageFaces, bodies: Bodies, nearer: Ints, farther: Ints) -> Bools:
    """(p,) which pairs have a plane of a face that the farther body shows with all of the nearer one beyond it.

    Source: Glaeser, section 5.8 (separating planes); erratum G5-07.
    """
    counts = bodies.first[farther + 1] - bodies.first[farther]
    pair = ragged.owner(counts)
    position, _ = ragged.take(bodies.first, farther)
    face = faces.source[bodies.shown[position]]
    normal, _, first = newell(view, face)
    length = np.sqrt((normal * normal).sum(axis=0))
    normal /= np.where(length > 0.0, length, 1.0)
    vertex, ends = ragged.take(view.item_vertices, bodies.item[nearer[pair]])
    plane = ragged.owner(np.diff(ends))
    arm = view.points[:, vertex] - view.points[:, first[plane]]
    height = (arm * normal[:, plane]).sum(axis=0)
    beyond = (
        np.ones(len(pair), dtype=np.bool_)
        if not len(pair)
        else np.minimum.reduceat(height, ends[:-1]) >= -view.tolerance
    )
    result = np.zeros(len(nearer), dtype=np.bool_)
    result[pair[beyond]] = True
    return result

"""Planes that keep two shapes apart: whoever looks from one side sees the shape on that side in front.

They are found in space, so they hold for every eye and every lamp until one of the shapes moves.
Source: Glaeser, sections 5.5 and 5.8; errata G5-05 to G5-07.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.errors import InputError
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.mesh import Mesh
from vectorplot.tolerances import LEAST_DIVISOR, THINNEST_BOX, ZERO_OF_EXTENT

NOT_FOUND, FIRST_ABOVE, FIRST_BELOW, USE_SPHERES = 0, 1, -1, 2
"""What is known of a pair: nothing; the first shape on the side the plane's normal points to, or on the other one;
spheres around both have no common points."""

PRODUCTS_AT_ONCE = 1 << 20
"""Points against planes at once."""

Infos = NDArray[np.int8]


def own_box(points: ArrayLike) -> Floats:
    """The box around points.

    Parameters
    ----------
    points : (n, 3) array_like of float
        One or more.

    Returns
    -------
    (8, 3) array of float
        Corner k has the largest x where k is odd, y where k & 2, z where k & 4.

    Raises
    ------
    InputError
        For no points, or such that are not finite.

    Notes
    -----
    Taken of a shape before it is turned, and turned with it, it fits closer than one along the axes taken later.

    Edge cases: a flat box is widened, to both sides alike, so that every side has a plane.

    Source: Glaeser, section 5.8, figure 13.

    Examples
    --------
    >>> from vectorplot import textbook
    >>> textbook.own_box([(0, 0, 0), (1, 2, 3)])[[0, 1, 2, 4]].tolist()
    [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]]
    """
    p = np.asarray(points, dtype=np.float64)
    if p.ndim != 2 or p.shape[1:] != (3,) or not len(p) or not np.isfinite(p).all():
        raise InputError("a box needs points of three finite coordinates")
    low, high = p.min(axis=0), p.max(axis=0)
    least = THINNEST_BOX * float((high - low).max())
    pad = np.maximum(least - (high - low), 0.0) / 2.0
    ends = np.stack([low - pad, high + pad])
    bits = np.arange(8)
    return np.stack([ends[(bits >> axis) & 1, axis] for axis in range(3)], axis=1)


@dataclass(frozen=True, eq=False)
class Surroundings:
    """What is around shapes: boxes, spheres, points and planes.

    Parameters
    ----------
    boxes : (n, 8, 3) array of float
        See own_box, turned or not.
    spheres : (n, 4) array of float
        Centre and radius.
    points : (v, 3) array of float
        The vertices of all shapes.
    offsets : (n+1,) array of int
        Shape k has the points offsets[k] to offsets[k+1].
    planes : (f, 4) array of float
        Unit normal outwards and constant, of the faces of the convex ones.
    plane_offsets : (n+1,) array of int
        Shape k has the planes plane_offsets[k] to plane_offsets[k+1].

    Notes
    -----
    Source: Glaeser, section 5.8.

    Examples
    --------
    >>> from vectorplot import geometry, textbook
    >>> around = textbook.Surroundings.of([geometry.box((2, 2, 2)), geometry.box((1, 1, 1))])
    >>> len(around), around.spheres[0].round(6).tolist(), around.plane_offsets.tolist()
    (2, [1.0, 1.0, 1.0, 1.732051], [0, 6, 12])
    """

    boxes: Floats
    spheres: Floats
    points: Floats
    offsets: Ints
    planes: Floats
    plane_offsets: Ints

    def __len__(self) -> int:
        return len(self.boxes)

    @classmethod
    def of(cls, shapes: Sequence[Mesh], boxes: Sequence[ArrayLike] | None = None) -> Surroundings:
        """What is around meshes.

        shapes: n of them; boxes: their own boxes, if these are known; result: in the same order.
        Errors: for a mesh without vertices.
        """
        around = [own_box(s.vertices) if boxes is None else np.asarray(boxes[k]) for k, s in enumerate(shapes)]
        middles = [box.mean(axis=0) for box in around]
        radii = [np.sqrt(((s.vertices - m) ** 2).sum(axis=1).max()) for s, m in zip(shapes, middles, strict=True)]
        planes = [_outer_planes(shape) for shape in shapes]
        return cls(
            np.reshape(around, (-1, 8, 3)),
            np.column_stack([np.reshape(middles, (-1, 3)), radii]),
            np.concatenate([np.zeros((0, 3)), *(s.vertices for s in shapes)]),
            ragged.offsets([len(s.vertices) for s in shapes]),
            np.concatenate([np.zeros((0, 4)), *planes]),
            ragged.offsets([*map(len, planes)]),
        )


def _outer_planes(mesh: Mesh) -> Floats:
    """(f,4) planes of the faces of a convex mesh; none of one that is not convex."""
    area = mesh.area_vectors
    size = np.sqrt((area * area).sum(axis=1))
    wide = np.flatnonzero(size > 0.0)
    normal = area[wide] / size[wide, None]
    constant = (normal * mesh.vertices[mesh.corners[mesh.offsets[wide]]]).sum(axis=1)
    limit = ZERO_OF_EXTENT * float(np.ptp(mesh.vertices, axis=0).max(initial=0.0))
    for low in range(0, len(wide), max(PRODUCTS_AT_ONCE // max(len(mesh.vertices), 1), 1)):
        part = slice(low, low + max(PRODUCTS_AT_ONCE // len(mesh.vertices), 1))
        if (matmul(normal[part], mesh.vertices.T) - constant[part, None] > limit).any():
            return np.zeros((0, 4))
    return np.column_stack([normal, constant])


@dataclass(frozen=True, eq=False)
class Separations:
    """What keeps pairs of shapes apart.

    info: (p,) 0 where nothing is known; planes: (p, 4) unit normal and constant, NaN where there is none; spheres: (p,
    2, 4) of both shapes.
    Source: Glaeser, sections 5.5 and 5.8; errata G5-05 to G5-07.
    """

    info: Infos
    planes: Floats
    spheres: Floats

    def exchanged(self) -> Separations:
        """The same with first and second exchanged."""
        info = np.where(np.abs(self.info) == 1, -self.info, self.info).astype(np.int8)
        return Separations(info, self.planes, self.spheres[:, ::-1])

    def nearer(self, eye: ArrayLike) -> Infos:
        """Which shape of each pair is in front.

        eye: (3,) the eye, or (x, y, z, 0) for a direction towards it; result: (p,) 1 where the first shape is in front,
        -1 where the second is, 0 where neither can be told to be.
        Source: Glaeser, section 5.5, figure 9; erratum G5-03.
        """
        place = np.asarray(eye, dtype=np.float64)
        finite = len(place) == 3
        constant = np.where(np.isnan(self.planes[:, 3]), 0.0, self.planes[:, 3])
        side = matmul(np.nan_to_num(self.planes[:, :3]), place[:3]) - (constant if finite else 0.0)
        by_plane = np.sign(side) * np.where(np.abs(self.info) == 1, self.info, 0)
        power = spheres_power(self.spheres.reshape(-1, 4), place).reshape(-1, 2)
        by_spheres = np.sign(power[:, 1] - power[:, 0])
        return np.where(self.info == USE_SPHERES, by_spheres, by_plane).astype(np.int8)


def spheres_power(spheres: Floats, eye: ArrayLike) -> Floats:
    """The power of the eye with respect to spheres, d^2 - r^2.

    Parameters
    ----------
    spheres : (n, 4) array of float
        Centre and radius.
    eye : (3,) or (4,) array_like of float
        The eye, or (x, y, z, 0) for a direction towards it.

    Returns
    -------
    (n,) array of float
        For a direction the distance of the centre from a far plane. Disjoint spheres are drawn by falling power.

    Notes
    -----
    The plane of equal power lies between two disjoint spheres, whatever their radii.

    Source: Glaeser, section 5.5, figure 9; erratum G5-03.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import textbook
    >>> textbook.spheres_power(np.array([(0, 0, 0, 1.0), (3, 0, 0, 1.5)]), eye=(5, 0, 0)).tolist()
    [24.0, 1.75]
    """
    place = np.asarray(eye, dtype=np.float64)
    if len(place) == 4:
        return np.asarray(-(matmul(spheres[:, :3], place[:3])))
    arm = spheres[:, :3] - place
    return np.asarray((arm * arm).sum(axis=1) - spheres[:, 3] ** 2)


def separations(around: Surroundings, first: Ints, second: Ints, *, tolerance: float = ZERO_OF_EXTENT) -> Separations:
    """What keeps shapes apart, pair by pair.

    Parameters
    ----------
    around : Surroundings
        Of n shapes.
    first, second : (p,) array of int
        Numbers of shapes.
    tolerance : float
        A plane counts where no point is beyond it by more than this times the size of the two.

    Returns
    -------
    Separations
        Spheres, else the plane of a side of either box, else that of a face of either shape if it is convex, else
        nothing.

    Notes
    -----
    Of several sides the one with the widest gap is taken. Exchange of a pair exchanges the answer.

    Edge cases: shapes that touch are apart.

    Source: Glaeser, section 5.8; errata G5-06, G5-07.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import geometry, textbook
    >>> shapes = [geometry.box((1, 1, 1), placement=(1, 0, 0, x, 0, 1, 0, 0, 0, 0, 1, 0)) for x in (0, 1, 9)]
    >>> found = textbook.separations(textbook.Surroundings.of(shapes), np.array([0, 0]), np.array([1, 2]))
    >>> found.info.tolist(), found.planes[0].tolist()
    ([-1, 2], [1.0, 0.0, 0.0, 1.0])
    """
    low, high = np.minimum(first, second), np.maximum(first, second)
    spheres = np.stack([around.spheres[low], around.spheres[high]], axis=1)
    arm, reach = spheres[:, 0, :3] - spheres[:, 1, :3], spheres[:, :, 3].sum(axis=1)
    info = np.where((arm * arm).sum(axis=1) > reach * reach, USE_SPHERES, NOT_FOUND).astype(np.int8)
    planes = np.full((len(low), 4), np.nan)
    limit = tolerance * reach
    for search in (_between_boxes, _between_faces):
        for one, two, sign in ((low, high, FIRST_BELOW), (high, low, FIRST_ABOVE)):
            open_pairs = np.flatnonzero(info == NOT_FOUND)
            found, plane = search(around, one[open_pairs], two[open_pairs], limit[open_pairs])
            planes[open_pairs[found]], info[open_pairs[found]] = plane[found], sign
    result = Separations(info, planes, spheres)
    back, turned = first > second, result.exchanged()
    return Separations(
        np.where(back, turned.info, info), planes, np.where(back[:, None, None], turned.spheres, spheres)
    )


def separations_after_moves(
    before: Separations, around: Surroundings, first: Ints, second: Ints, moved: Bools
) -> Separations:
    """What keeps the same pairs apart after some shapes have moved: only their pairs are looked at again.

    first, second: (p,) numbers of shapes; moved: (n,) which of the shapes have moved.
    Source: Glaeser, section 5.8.
    """
    if not len(before.info) == len(first) == len(second):
        raise InputError(f"{len(first)} pairs need as many separations, not {len(before.info)}")
    anew = np.flatnonzero(moved[first] | moved[second])
    found = separations(around, first[anew], second[anew])
    info, planes, spheres = before.info.copy(), before.planes.copy(), before.spheres.copy()
    info[anew], planes[anew], spheres[anew] = found.info, found.planes, found.spheres
    return Separations(info, planes, spheres)


def _between_boxes(around: Surroundings, one: Ints, two: Ints, limit: Floats) -> tuple[Bools, Floats]:
    """Which pairs have a side of the first one's box with the second one's box beyond it, and (p,4) its plane."""
    box = around.boxes[one]
    edges = np.stack([box[:, 1] - box[:, 0], box[:, 2] - box[:, 0], box[:, 4] - box[:, 0]], axis=1)
    normal = edges / np.maximum(np.linalg.norm(edges, axis=2), LEAST_DIVISOR)[:, :, None]
    normal = np.concatenate([-normal, normal], axis=1)
    constant = np.concatenate(
        [np.einsum("pak,pk->pa", normal[:, :3], box[:, 0]), np.einsum("pak,pk->pa", normal[:, 3:], box[:, 7])], axis=1
    )
    gap = np.einsum("pak,pck->pac", normal, around.boxes[two]).min(axis=2) - constant
    best, pick = gap.argmax(axis=1), np.arange(len(one))
    found = gap[pick, best] >= -limit
    return found, np.column_stack([normal[pick, best], constant[pick, best]])


def _between_faces(around: Surroundings, one: Ints, two: Ints, limit: Floats) -> tuple[Bools, Floats]:
    """Which pairs have a face of the first shape with all of the second one beyond it, and (p,4) its plane."""
    best, plane = np.full(len(one), -np.inf), np.zeros((len(one), 4))
    counts = np.diff(around.plane_offsets)[one]
    sizes = counts * np.diff(around.offsets)[two]
    for low, high in ragged.batches(sizes, PRODUCTS_AT_ONCE):
        part = np.arange(low, high)
        pair, face = _listed(around.plane_offsets, one[part])
        if not len(face):
            continue
        which, point = _listed(around.offsets, two[part][pair])
        height = (around.planes[face[which], :3] * around.points[point]).sum(axis=1) - around.planes[face[which], 3]
        starts = np.searchsorted(which, np.arange(len(face)))
        gap = np.minimum.reduceat(height, starts)
        order = np.lexsort((gap, pair))
        last = order[np.append(pair[order][1:] != pair[order][:-1], True)]
        best[part[pair[last]]], plane[part[pair[last]]] = gap[last], around.planes[face[last]]
    return best >= -limit, plane


def _listed(offsets: Ints, which: Ints) -> tuple[Ints, Ints]:
    """All members of some groups, one group after the other: the place in which of each, and the member."""
    sizes: Any = np.diff(offsets)[which]
    owner = ragged.owner(sizes)
    start = np.repeat(offsets[which] - ragged.starts(sizes), sizes)
    return owner, start + np.arange(len(owner))

"""Items that cover a plane once, as graphs of functions do: their painter's order without a comparison."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.rotations import axis_frame
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.surfaces.graphs.graph import vertical
from vectorplot.visibility.painter.plans import Plan, largest_plan
from vectorplot.visibility.painter.precedence import Precedence
from vectorplot.visibility.projected_faces import newell

FEWEST = 64
"""Of items with fewer faces it is not worth asking for a plan."""

LOOKS = 256
"""So many faces are asked first whether all of an item may be turned to one side."""

STEPS = 64
"""Steps of the search for a direction to which they are turned."""

LEAST_MEAN = 0.1
"""The mean of unit normals of a shape that is closed, or nearly so, is no longer than this."""

MARGIN = 0.05
"""In each step the worst of the normals comes to be turned so far to the direction: the cosine of some 87 degrees."""


def known_orders(scene: Scene, view: View) -> dict[int, Precedence]:
    """For every item with FEWEST faces or more that all show the same side along some direction, and there cover
    nothing twice, what has to be drawn before what.

    scene: with the shapes that the faces of the view stand for. The directions that are tried are that of the height
    of graphs, the axes of the world, and where the faces show to in the mean.
    """
    found = {}
    first = np.searchsorted(view.face_item, np.arange(len(scene.items) + 1))
    for number in np.flatnonzero(np.diff(first) >= FEWEST).tolist():
        face = np.arange(first[number], first[number + 1])
        for direction in _directions(scene, view, number, face):
            order = field_order(view, face, direction)
            if order is not None:
                found[number] = order
                break
    return found


def _directions(scene: Scene, view: View, number: int, face: Ints) -> Iterator[Floats]:
    """Directions (3,) of the view along which all faces of an item may show the same side."""
    own = vertical(scene.items[number].shape)
    if own is not None:
        yield matmul(view.axes, own)
        return
    some = face[:: -(-len(face) // LOOKS)]
    normal, longest, _ = newell(view, some)
    for direction in (*view.axes.T[::-1], _all_along(normal)):
        if direction is not None and _side(direction, normal, view.tolerance * longest):
            yield direction


def _all_along(normal: Floats) -> Floats | None:
    """(3,) a unit vector along which all of some normals (3,n) are turned to, if there is one and it is found.

    Source: Agmon, The relaxation method for linear inequalities (1954).
    """
    length = np.sqrt((normal * normal).sum(axis=0))
    unit = normal[:, length > 0.0] / length[length > 0.0]
    mean = unit.mean(axis=1) if unit.shape[1] else np.zeros(3)
    for _ in range(STEPS):
        size = float(np.sqrt(matmul(mean, mean)))
        # Of closed shapes nothing is left in the mean.
        if size < LEAST_MEAN:
            return None
        mean /= size
        along = matmul(mean, unit)
        worst = int(along.argmin())
        if along[worst] > 0.0:
            break
        mean += (MARGIN - along[worst]) * unit[:, worst]
    return mean


def field_order(view: View, face: Ints, direction: Floats) -> Precedence | None:
    """What has to be drawn before what of some consecutive faces (f,) of a view; None if they do not all show the same
    side along a direction (3,), or their plan across it overlaps itself. A few faces whose borders cross in it are left
    out.

    A plane along the direction through a side of two faces has the eye on one side: the face on the other side goes
    first. So wherever the eye is, and whatever the heights are; gaps of the plan, which sight lines cross as well, are
    filled.
    Source: Glaeser, section 5.4, figure 7; De Floriani, Falcidieno, Nagy and Pienovi, On sorting triangles in a
    Delaunay tessellation (1991).
    """
    frame = axis_frame(direction)
    normal, longest, _ = newell(view, face)
    frame[1:] *= _side(frame[2], normal, view.tolerance * longest)
    if not frame[1:].any():
        return None
    corners = view.corners[view.offsets[face[0]] : view.offsets[face[-1] + 1]]
    found = largest_plan(matmul(frame[:2], view.points), corners, ragged.offsets(view.face_sizes[face]))
    if found is None:
        return None
    plan, kept = found
    before, after = _across_sides(plan, view, frame[:2])
    return Precedence(np.append(face[kept], np.full(plan.count - len(kept), -1)), before, after)


def _side(direction: Floats, normal: Floats, zero: Floats) -> int:
    """1 if all faces with normals (3,f) show their outside along a direction (3,), or are edge-on, as far as zero (f,)
    tells, -1 if they show their inside, 0 if they differ."""
    along = matmul(direction, normal)
    if not (np.abs(along) > zero).any():
        return 0
    return int((along >= -zero).all()) - int((along <= zero).all())


def _across_sides(plan: Plan, view: View, frame: Floats) -> tuple[Ints, Ints]:
    """What has to be drawn before what of a plan, whose directions are the rows of frame (2,3).

    Sides that the eye sees end-on in the plan are crossed by no sight line.
    """
    way = plan.end - plan.start
    toward = matmul(frame, view.eye[:, None]) - plan.start if view.eye is not None else frame[:, 2:]
    turn = way[0] * toward[1] - way[1] * toward[0]
    limit = view.tolerance * np.hypot(*toward)
    on_left, on_right = turn > limit, turn < -limit
    return (
        np.concatenate([plan.right[on_left], plan.left[on_right]]),
        np.concatenate([plan.left[on_left], plan.right[on_right]]),
    )

"""What counts as zero: hidden lines of tessellated bodies whose vertices are a little off."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from vectorplot.accuracy.approximation import Approximation, Study, Way, decades
from vectorplot.arrays import Bools, Floats, Ints
from vectorplot.geometry.budget import unheard
from vectorplot.geometry.cameras.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.repair.winding import edge_uses
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.testing.rays.sight import visible_by_rays
from vectorplot.tolerances.of_extent import CLEARANCE_OF_EXTENT
from vectorplot.tolerances.of_measuring import SMALLEST_ZERO, VERTEX_NOISE_OF_EXTENT
from vectorplot.visibility.polyhedra.hidden_lines import visible_parts
from vectorplot.visibility.polyhedra.occluders import solid_items
from vectorplot.visibility.polyhedra.pairs import Segments
from vectorplot.visibility.projected_faces import project_faces

SEED = 1
"""Of the noise."""

SHARES = (0.21, 0.47, 0.83)
"""Edges are asked at these places, none of which is on the border of what touches them."""

CELLS = 6
"""Cells along every edge of a box."""

CAMERA = Camera(eye=(9.0, -12.0, 7.0), target=(1.0, 1.0, 1.0))

BOXES = (
    ((0, 0, 0), (2, 2, 2)),
    ((2, 0, 0), (3, 2, 1)),
    ((0.5, 0.5, 2), (1.5, 1.5, 2.01)),
    ((2.2, -2, 0), (2.8, -1, 2)),
)
"""A box, one beside it and a thin one on it that touch it, and one before them."""


def tessellated(low: tuple[float, ...], high: tuple[float, ...]) -> Mesh:
    """A box whose sides are CELLS x CELLS cells of two triangles each, their vertices shared."""
    n = CELLS
    corners: list[Floats] = []
    square = np.stack(np.meshgrid(np.arange(n), np.arange(n), indexing="ij"), axis=-1).reshape(-1, 2)
    cell = np.array([(0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0, 1)])
    plane = (square[:, None] + cell).reshape(-1, 3, 2)
    for axis in range(3):
        for level, turn in ((0, -1), (n, 1)):
            place = np.insert(plane, axis, level, axis=2) if axis != 1 else np.insert(plane, 1, level, axis=2)[:, ::-1]
            corners.append(place[:, ::turn])
    every = np.concatenate(corners).reshape(-1, 3)
    lattice, index = np.unique(every, axis=0, return_inverse=True)
    start, size = np.asarray(low, dtype=np.float64), np.subtract(high, low)
    return Mesh.from_triangles(start + lattice / n * size, index.reshape(-1, 3))


def bodies(noise: float) -> list[Mesh]:
    """The boxes, their vertices off by so much at most."""
    random = np.random.default_rng(SEED)
    found = []
    for low, high in BOXES:
        mesh = tessellated(low, high)
        off = noise * random.uniform(-1.0, 1.0, mesh.vertices.shape)
        found.append(Mesh(mesh.vertices + off, mesh.corners, mesh.offsets))
    return found


def scene_of(meshes: Sequence[Mesh]) -> Scene:
    """The meshes as items."""
    return Scene(tuple(Item(f"box {number + 1}", mesh) for number, mesh in enumerate(meshes)))


def edges_of(meshes: Sequence[Mesh]) -> Ints:
    """(e,2) the vertices of all edges, those of the meshes one after the other."""
    found, first = [], 0
    for mesh in meshes:
        corner = edge_uses(mesh).corner[edge_uses(mesh).first]
        found.append(first + np.stack([mesh.corners[corner], mesh.corners[mesh.next_corner[corner]]], axis=1))
        first += len(mesh.vertices)
    return np.concatenate(found)


def seen(view: View, edges: Ints) -> Bools:
    """(e,s) which edges are visible at their SHARES."""
    faces = project_faces(view)
    segments = Segments(view.points[:, edges[:, 0]], view.points[:, edges[:, 1]])
    parts = visible_parts(view, faces, solid_items(view, faces), segments, unheard)
    found = np.zeros((len(edges), len(SHARES)), dtype=np.bool_)
    for k, share in enumerate(SHARES):
        found[parts.segment[(parts.low <= share) & (share <= parts.high)], k] = True
    return found


def _study() -> Study:
    meshes = bodies(0.0)
    clean = scene_of(meshes)
    extent = float(np.ptp(clean.bounds, axis=0).max())
    view, edges = look(scene_of(bodies(VERTEX_NOISE_OF_EXTENT * extent)), CAMERA), edges_of(meshes)
    ends = clean.vertices[edges]
    share = np.array(SHARES)[:, None]
    points = (ends[:, None, 0] * (1.0 - share) + ends[:, None, 1] * share).reshape(-1, 3)
    sight = visible_by_rays(clean, CAMERA, points)
    truth, sure = (x.reshape(len(edges), -1) for x in (sight.hidden_by == 0, sight.clearance > CLEARANCE_OF_EXTENT))

    def error(found: Bools) -> float:
        return 100.0 * float((found != truth)[sure].mean())

    ways = (Way("snapped", lambda tolerance: seen(replace(view, tolerance=tolerance), edges)),)
    return Study(ways, error, lambda found: int(found.sum()))


SNAPPING = Approximation(
    name="snapping",
    title="What counts as zero",
    about="Four boxes, tessellated, three of them touching, with vertices off by 1e-10 of the extent. The error is "
    "how many places on edges are visible where rays on the true boxes find them hidden, or the other way round. What "
    "counts as zero must exceed the noise and be smaller than what is to be seen; the package takes 1e-9.",
    knob="zero, as part of half the extent",
    values=decades(-2, -14, 13),
    limits=(SMALLEST_ZERO, 0.1),
    unit="% of the places",
    counts="visible places",
    study=_study,
)

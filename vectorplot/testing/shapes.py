"""Shapes that hidden-line programs get wrong, as scenes."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import cbrt
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import cross, dot, norm, normalize
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.testing.curved_meshes import bumpy_icosphere, grid_graph, moebius_strip, torus_mesh

BOX_FACES = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
"""Faces of a box whose corner k has x, y, z at their upper end where bit 0, 1, 2 of k is set: bottom and top first."""


def box(low: ArrayLike, high: ArrayLike) -> Mesh:
    """The box between two opposite corners."""
    ends = np.array([low, high], dtype=np.float64)
    bits = np.arange(8)
    corners = np.stack([ends[(bits >> axis) & 1, axis] for axis in range(3)], axis=1)
    return Mesh.from_polygons(corners, BOX_FACES)


def prism(base: ArrayLike, low: float, high: float) -> Mesh:
    """The upright prism over a polygon (k,2) that runs counter-clockwise, convex or not."""
    plane = np.asarray(base, dtype=np.float64)
    count = len(plane)
    vertices = np.concatenate([np.c_[plane, np.full(count, low)], np.c_[plane, np.full(count, high)]])
    sides = [[k, (k + 1) % count, (k + 1) % count + count, k + count] for k in range(count)]
    return Mesh.from_polygons(vertices, [list(range(count))[::-1], [k + count for k in range(count)], *sides])


def without(mesh: Mesh, *faces: int) -> Mesh:
    """The same mesh; some faces only close it in the mind."""
    present = np.ones(mesh.face_count, dtype=np.bool_)
    present[list(faces)] = False
    return Mesh(mesh.vertices, mesh.corners, mesh.offsets, present)


def rotation(random: np.random.Generator) -> Floats:
    """A random rotation (3,3)."""
    a, b, c = random.normal(size=(3, 3)).T
    x = normalize(a)
    y = normalize(b - dot(x, b) * x)
    if dot(cross(x, y), c) < 0.0:
        x, y = y, x
    return np.stack([x, y, cross(x, y)], axis=1)


def scene_of(**shapes: Mesh) -> Scene:
    """A scene of named shapes."""
    return Scene(tuple(Item(name, shape) for name, shape in shapes.items()))


def numbered(shapes: list[Mesh]) -> Scene:
    """A scene of shapes that are called BODY1, BODY2, and so on."""
    return scene_of(**{f"BODY{k + 1}": shape for k, shape in enumerate(shapes)})


def touching_boxes() -> Scene:
    """Two boxes that share a face, and one that stands on both."""
    return scene_of(LEFT=box((0, 0, 0), (1, 1, 1)), RIGHT=box((1, 0, 0), (2, 1, 1)), TOP=box((0.5, 0, 1), (1.5, 1, 2)))


def nine_touching_cubes(noise: float = 1e-10, seed: int = 0) -> Scene:
    """Three by three cubes side by side, their coordinates disturbed by noise."""
    random = np.random.default_rng(seed)
    cubes = [box((x, y, 0), (x + 1, y + 1, 1)) for y in range(3) for x in range(3)]
    return numbered(
        [Mesh(c.vertices + random.uniform(-noise, noise, (8, 3)), c.corners, c.offsets, c.present) for c in cubes]
    )


def box_on_table() -> Scene:
    """A box whose bottom lies in a table's top."""
    return scene_of(TABLE=box((-2, -1.5, -0.2), (2, 1.5, 0)), BOX=box((-0.5, -0.4, 0), (0.6, 0.5, 0.8)))


def cyclic_bars() -> Scene:
    """Three bars, each in front of the next and behind the one before, seen along z."""
    bar = box((-2.0, -0.2, -0.1), (2.0, 0.2, 0.1))
    bars = []
    for k in range(3):
        turn, tilt = 2.0 * np.pi * k / 3.0, np.radians(12.0)
        c, s, a, b = np.cos(turn), np.sin(turn), np.cos(tilt), np.sin(tilt)
        about_z = np.array([[c, -s, 0, 0], [s, c, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
        about_y = np.array([[a, 0, b, 0], [0, 1, 0, -1.0], [-b, 0, a, 0], [0, 0, 0, 1]])
        bars.append(bar.transformed(matmul(about_z, about_y)))
    return numbered(bars)


def interpenetrating_boxes() -> Scene:
    """Two boxes that pierce each other askew."""
    turn = np.eye(4)
    turn[:3, :3] = rotation(np.random.default_rng(3))
    return scene_of(
        FIRST=box((-1, -1, -1), (1, 1, 1)), SECOND=box((-1.6, -0.5, -0.4), (1.6, 0.5, 0.4)).transformed(turn)
    )


def coincident_faces() -> Scene:
    """A plate twice in the same place, and a smaller one in its plane."""
    plate = Mesh.from_polygons([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [[0, 1, 2, 3]])
    small = Mesh.from_polygons(plate.vertices * 0.5, [[0, 1, 2, 3]])
    return scene_of(PLATE=plate, AGAIN=plate, SMALL=small, BELOW=box((-0.2, -0.2, -1), (0.2, 0.2, -0.5)))


def edge_on_plate() -> Scene:
    """A plate in the plane y = 0, which a camera in that plane sees edge-on, before a box."""
    plate = Mesh.from_polygons([(-1, 0, -1), (-1, 0, 1), (0, 0, 1), (0, 0, -1)], [[0, 1, 2, 3]])
    return scene_of(PLATE=plate, BOX=box((0.5, -0.5, -0.5), (1.5, 0.5, 0.5)))


def t_junction() -> Scene:
    """A wall whose long edge meets two short ones in a vertex that it does not have, before a box."""
    vertices = [(-1, 0, -1), (1, 0, -1), (1, 0, 0), (-1, 0, 0), (0, 0, 0), (1, 0, 1), (0, 0, 1), (-1, 0, 1)]
    wall = Mesh.from_polygons(vertices, [[0, 1, 2, 3], [3, 4, 6, 7], [4, 2, 5, 6]])
    return scene_of(WALL=wall, BOX=box((-0.5, 1, -0.5), (0.5, 2, 0.5)))


def open_mesh() -> Scene:
    """A box that lacks its top face: a mesh with a border, both sides of its faces to be seen."""
    return scene_of(OPEN=Mesh.from_polygons(box((0, 0, 0), (2, 1, 1)).vertices, [BOX_FACES[0], *BOX_FACES[2:]]))


def sliver() -> Scene:
    """A triangle a hundred million times longer than wide, and a box half behind it."""
    needle = Mesh.from_triangles([(-1, 0, 0), (1, 0, 0), (0, 0, 2e-8)], [[0, 1, 2]])
    return scene_of(NEEDLE=needle, BOX=box((-0.5, 1, -0.5), (0.5, 2, 0.5)))


def non_manifold_edge() -> Scene:
    """Three leaves on one spine, and two cubes that share an edge."""
    angles = np.radians([20.0, 140.0, 250.0])
    tips = [(np.cos(a), np.sin(a), z) for a in angles for z in (0.0, 1.0)]
    book = Mesh.from_polygons([(0, 0, 0), (0, 0, 1), *tips], [[0, 2, 3, 1], [0, 4, 5, 1], [0, 6, 7, 1]])
    first, second = box((2, 0, 0), (3, 1, 1)), box((3, 1, 0), (4, 2, 1))
    cubes = np.concatenate([first.vertices, second.vertices])
    welded, index = np.unique(cubes, axis=0, return_inverse=True)
    faces = [[int(index.ravel()[k + shift]) for k in face] for shift in (0, 8) for face in BOX_FACES]
    return scene_of(BOOK=book, CUBES=Mesh.from_polygons(welded, faces))


def hollow_tube(order: int = 12) -> Scene:
    """A tube along x without its end faces, which one looks through to a box behind it."""
    angle = 2.0 * np.pi * np.arange(order) / order
    upright = prism(np.c_[np.cos(angle), np.sin(angle)], -1.5, 1.5)
    tube = without(Mesh(upright.vertices[:, [2, 0, 1]], upright.corners, upright.offsets), 0, 1)
    return scene_of(TUBE=tube, BOX=box((-4, -0.5, -0.5), (-3, 0.5, 0.5)))


def honeycomb(rings: int = 7) -> Scene:
    """The first 161 cells of a hexagonal comb (7 rings have 169), open at both ends, neighbours sharing their walls."""
    centres = [
        (np.sqrt(3.0) * (q + r / 2.0), 1.5 * r)
        for q in range(-rings, rings + 1)
        for r in range(-rings, rings + 1)
        if abs(q + r) <= rings
    ]
    angle = np.radians(60.0 * np.arange(6) + 30.0)
    hexagon = np.c_[np.cos(angle), np.sin(angle)]
    cells = [without(prism(hexagon + centre, 0.0, 1.0), 0, 1) for centre in sorted(centres)[:161]]
    return numbered(cells)


def random_convex_solids(count: int = 12, seed: int = 0) -> Scene:
    """Hulls of random points on spheres, scattered so that some pierce each other."""
    from scipy.spatial import ConvexHull

    random = np.random.default_rng(seed)
    solids = []
    for _ in range(count):
        points = random.normal(size=(int(random.integers(5, 16)), 3))
        points = points / norm(points)[:, None] * random.uniform(0.3, 1.0)
        hull = ConvexHull(points)
        faces = hull.simplices.copy()
        a, b, c = (points[faces[:, k]] for k in range(3))
        inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), hull.equations[:, :3]) < 0.0
        faces[inward] = faces[inward][:, ::-1]
        solids.append(Mesh.from_triangles(points + random.uniform(-2.0, 2.0, 3), faces))
    return numbered(solids)


def rotated_boxes(count: int = 30, seed: int = 0) -> Scene:
    """Boxes of many sizes turned and scattered at random; the density does not depend on their number."""
    random = np.random.default_rng(seed)
    room = 1.2 * cbrt(count)
    boxes = []
    for _ in range(count):
        half = random.uniform(0.15, 0.6, 3)
        place = np.eye(4)
        place[:3, :3] = rotation(random)
        place[:3, 3] = random.uniform(-room, room, 3)
        boxes.append(box(-half, half).transformed(place))
    return numbered(boxes)


def l_prisms() -> Scene:
    """L- and U-shaped prisms, with faces that are not convex, in and out of each other's notches."""
    ell = prism([(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)], 0.0, 1.0)
    cup = prism([(0, 0), (3, 0), (3, 2), (2, 2), (2, 1), (1, 1), (1, 2), (0, 2)], 0.0, 0.7)
    away = np.eye(4)
    away[:3, 3] = (1.2, 1.3, 0.1)
    return scene_of(ELL=ell, CUP=cup.transformed(away), PIN=box((1.1, 1.05, 0.2), (1.15, 1.25, 2.0)))


def hollow_bodies() -> Scene:
    """Boxes and a cup without some of their faces, with something inside or behind the holes."""
    angle = 2.0 * np.pi * np.arange(9) / 9
    cup = prism(np.c_[0.8 * np.cos(angle) + 4.0, 0.8 * np.sin(angle)], 0.0, 1.2)
    return scene_of(
        TRAY=without(box((0, 0, 0), (2, 1, 0.6)), 1),
        BALL=box((0.3, 0.3, 0.1), (0.6, 0.6, 0.9)),
        CUP=without(cup, 1),
        FRAME=without(box((0, 2, 0), (1, 3, 1)), 2, 3),
        SHED=without(box((2, 2, 0), (3, 3, 1)), 1, 2, 4),
    )


def hard_shapes() -> dict[str, Scene]:
    """Small scenes of every family by its name, each made anew.

    Returns
    -------
    dict of str to Scene
        Touching and cutting boxes, coincident faces, open, twisted and hollow meshes: what hidden lines go wrong on.

    Examples
    --------
    >>> from vectorplot import testing
    >>> shapes = testing.hard_shapes()
    >>> shapes["cyclic bars"]
    <Scene '': 3 items, 0 lights>
    """
    return {
        "touching boxes": touching_boxes(),
        "nine touching cubes": nine_touching_cubes(),
        "box on table": box_on_table(),
        "cyclic bars": cyclic_bars(),
        "interpenetrating boxes": interpenetrating_boxes(),
        "coincident faces": coincident_faces(),
        "edge-on plate": edge_on_plate(),
        "T-junction": t_junction(),
        "open mesh": open_mesh(),
        "Moebius strip": scene_of(STRIP=moebius_strip()),
        "sliver": sliver(),
        "non-manifold edge": non_manifold_edge(),
        "hollow tube": hollow_tube(),
        "torus mesh": scene_of(TORUS=torus_mesh()),
        "bumpy icosphere": scene_of(BALL=bumpy_icosphere(2)),
        "honeycomb": honeycomb(),
        "grid graph": scene_of(GRAPH=grid_graph(12)),
        "random convex solids": random_convex_solids(),
        "rotated boxes": rotated_boxes(),
        "L-shaped prisms": l_prisms(),
        "hollow bodies": hollow_bodies(),
    }

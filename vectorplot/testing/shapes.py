"""Shapes that hidden-line programs get wrong, as scenes, and curved shapes as meshes of any size."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from vectorplot.arrays import Floats, Ints
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import cbrt
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import cross, dot, norm, normalize
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene

# Curved shapes as meshes, of any size.


def quads(rows: int, columns: int) -> Ints:
    """(r,4) corners of the cells of a grid of vertices, row after row, counter-clockwise in (column, row)."""
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    return np.stack([first, first + 1, first + 1 + columns, first + columns], axis=1)


def mesh_of_quads(vertices: Floats, cells: Ints) -> Mesh:
    """The mesh of quadrangles (q,4)."""
    return Mesh(vertices, cells.ravel(), np.arange(0, cells.size + 1, 4))


def torus_mesh(around: int = 24, across: int = 12, major: float = 2.0, minor: float = 0.8) -> Mesh:
    """A torus about z of around times across quadrangles, which are all but planar."""
    u, v = np.meshgrid(
        2.0 * np.pi * np.arange(around) / around, 2.0 * np.pi * np.arange(across) / across, indexing="ij"
    )
    radius = major + minor * np.cos(v)
    points = np.stack([radius * np.cos(u), radius * np.sin(u), minor * np.sin(v)], axis=-1).reshape(-1, 3)
    i, j = np.divmod(np.arange(around * across), across)
    i1, j1 = (i + 1) % around, (j + 1) % across
    return mesh_of_quads(points, np.stack([i * across + j, i1 * across + j, i1 * across + j1, i * across + j1], axis=1))


def moebius_strip(steps: int = 24) -> Mesh:
    """A strip with one side and one border: its faces cannot be listed counter-clockwise from outside."""
    angle = 2.0 * np.pi * np.arange(steps) / steps
    sides = []
    for width in (-0.5, 0.5):
        radius = 1.5 + width * np.cos(angle / 2.0)
        sides.append(np.stack([radius * np.cos(angle), radius * np.sin(angle), width * np.sin(angle / 2.0)], axis=1))
    k = np.arange(steps)
    after = (k + 1) % steps
    swap = after < k
    low, high = np.where(swap, after + steps, after), np.where(swap, after, after + steps)
    # A strip of quadrangles would not be planar.
    triangles = np.concatenate([np.stack([k, low, high], axis=1), np.stack([k, high, k + steps], axis=1)])
    return Mesh.from_triangles(np.concatenate(sides), triangles)


def grid_graph(cells: int = 40) -> Mesh:
    """The graph of a function over a square, cells times cells pairs of triangles: an open mesh that hides itself."""
    line = np.linspace(-1.0, 1.0, cells + 1)
    y, x = np.meshgrid(line, line, indexing="ij")
    z = 0.25 * np.sin(6.0 * x) * np.cos(5.0 * y + x)
    cell = quads(cells + 1, cells + 1)
    return Mesh.from_triangles(
        np.stack([x, y, z], axis=-1).reshape(-1, 3), np.concatenate([cell[:, :3], cell[:, [0, 2, 3]]])
    )


def icosahedron() -> tuple[Floats, Ints]:
    """Vertices on the unit sphere and triangles, counter-clockwise from outside."""
    golden = (1.0 + np.sqrt(5.0)) / 2.0
    flat = [(0.0, a, b) for a in (-1.0, 1.0) for b in (-golden, golden)]
    vertices = np.array([(*p[shift:], *p[:shift]) for shift in range(3) for p in flat])
    near = np.linalg.norm(vertices[:, None] - vertices[None], axis=2) < 2.1
    i, j, k = np.nonzero(near[:, :, None] & near[None, :, :] & near[:, None, :])
    outside = np.einsum("ij,ij->i", np.cross(vertices[i], vertices[j]), vertices[k]) > 1.0
    kept = outside & (i < j) & (i < k)
    return vertices / norm(vertices[0]), np.stack([i, j, k], axis=1)[kept]


def bumpy_icosphere(halvings: int = 3, bump: float = 0.15) -> Mesh:
    """A sphere with bumps, of 20 times 4 to the power of halvings triangles (5: 20,480; 8: 1.3 million)."""
    vertices, triangles = icosahedron()
    for _ in range(halvings):
        sides = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
        key, index = np.unique(sides.min(axis=1) * len(vertices) + sides.max(axis=1), return_inverse=True)
        first, second = np.divmod(key, len(vertices))
        middle = vertices[first] + vertices[second]
        ab, bc, ca = (index.reshape(3, -1) + len(vertices)).astype(np.intp)
        vertices = np.concatenate([vertices, middle / norm(middle)[:, None]])
        a, b, c = triangles.T
        parts = ([a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca])
        triangles = np.stack([np.stack(part, axis=1) for part in parts], axis=1).reshape(-1, 3)
    waves = np.sin(5.0 * vertices[:, 0]) * np.sin(4.0 * vertices[:, 1] + 1.0) * np.cos(6.0 * vertices[:, 2])
    return Mesh.from_triangles(vertices * (1.0 + bump * waves)[:, None], triangles)


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

"""Random scenes of the sorts that painters get wrong."""

from __future__ import annotations

import numpy as np

from vectorplot.geometry.mesh import Mesh
from vectorplot.scene.scene import Scene
from vectorplot.testing.shapes import box, numbered, prism, rotation, torus_mesh


def placed(shape: Mesh, random: np.random.Generator, room: float = 1.5, turned: bool = True) -> Mesh:
    turn = np.eye(4)
    if turned:
        turn[:3, :3] = rotation(random)
    turn[:3, 3] = random.uniform(-room, room, 3)
    return shape.transformed(turn)


def triangle_soup(random: np.random.Generator) -> Scene:
    """Triangles of all sizes through one another."""
    shapes = []
    for _ in range(14):
        corners = random.normal(size=(3, 3)) * random.uniform(0.2, 1.2) + random.uniform(-1, 1, 3)
        shapes.append(Mesh.from_triangles(corners, [[0, 1, 2]]))
    return numbered(shapes)


def soup_in_one_mesh(random: np.random.Generator) -> Scene:
    """The same, but as one item, with slivers and triangles that share corners."""
    points = random.uniform(-1, 1, (12, 3)) * (1.0, 1.0, random.choice([1.0, 1e-3]))
    triangles = np.array([random.choice(12, 3, replace=False) for _ in range(14)])
    return numbered([Mesh.from_triangles(points, triangles)])


def on_a_floor(random: np.random.Generator) -> Scene:
    """Boxes that stand on one large floor and on one another, some with common planes."""
    shapes = [Mesh.from_polygons([(-6, -6, 0), (6, -6, 0), (6, 6, 0), (-6, 6, 0)], [[0, 1, 2, 3]])]
    grid = random.permutation(25)[:9]
    for cell in grid.tolist():
        x, y, height = 2.0 * (cell % 5) - 5.0, 2.0 * (cell // 5) - 5.0, float(random.integers(1, 4)) / 2.0
        shapes.append(box((x, y, 0), (x + random.choice([1.0, 2.0]), y + 2.0, height)))
        if random.random() < 0.5:
            shapes.append(box((x + 0.25, y + 0.25, height), (x + 0.75, y + 1.0, height + 0.5)))
    return numbered(shapes)


def tori(random: np.random.Generator) -> Scene:
    """Rings through and around one another, and a bar through them."""
    rings = [placed(torus_mesh(14, 8, 2.0, 0.5), random, 1.5) for _ in range(3)]
    return numbered([*rings, placed(box((-4, -0.3, -0.3), (4, 0.3, 0.3)), random, 0.5)])


def piercing_boxes(random: np.random.Generator) -> Scene:
    """Boxes of which most pierce others."""
    return numbered([placed(box((0, 0, 0), random.uniform(0.3, 1.6, 3)), random, 1.0) for _ in range(10)])


def aligned_boxes(random: np.random.Generator) -> Scene:
    """Boxes with corners on a lattice: they touch, overlap, share planes, and some are the same."""
    shapes = []
    for _ in range(12):
        low = random.integers(0, 4, 3)
        shapes.append(box(low.tolist(), (low + random.integers(1, 3, 3)).tolist()))
    return numbered(shapes)


def plates(random: np.random.Generator) -> Scene:
    """Thin plates stacked in a few planes, some in the same one."""
    shapes = []
    for _ in range(12):
        x, y = random.uniform(-1, 1, 2)
        w, h = random.uniform(0.2, 1.2, 2)
        z = float(random.choice([0.0, 0.5, 0.5 + 1e-4, 1.0]))
        shapes.append(Mesh.from_polygons([(x, y, z), (x + w, y, z), (x + w, y + h, z), (x, y + h, z)], [[0, 1, 2, 3]]))
    return numbered(shapes)


def concave(random: np.random.Generator) -> Scene:
    """Prisms over polygons that are not convex, open ones among them, and single such polygons."""
    ell = [(0, 0), (2, 0), (2, 1), (1, 1), (1, 2), (0, 2)]
    angle = np.arange(10) * np.pi / 5.0
    star = np.c_[np.cos(angle), np.sin(angle)] * np.where(np.arange(10) % 2, 0.4, 1.0)[:, None]
    shapes = [placed(prism(base, 0.0, 0.6), random) for base in (ell, star, ell)]
    opened = prism(star, 0.0, 1.0)
    shapes.append(placed(Mesh.from_polygons(opened.vertices, opened.polygons()[1:]), random))
    shapes.append(placed(Mesh.from_polygons(np.c_[star, np.zeros(10)], [list(range(10))]), random))
    shapes.append(placed(Mesh.from_polygons(np.c_[np.array(ell), np.zeros(6)], [list(range(6))]), random))
    return numbered(shapes)


STREWN = {
    make.__name__: make
    for make in (
        triangle_soup,
        soup_in_one_mesh,
        on_a_floor,
        tori,
        piercing_boxes,
        aligned_boxes,
        plates,
        concave,
    )
}

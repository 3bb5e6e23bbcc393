"""The painter's order: run with ``pytest tests/bench/bench_painter.py -s``."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.backends.svg import svg_bytes
from vectorplot.drawing.fill_visibility import visible_fills
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.convex_polygons import hull_mesh
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polygon_cuts import clipped_by_convex
from vectorplot.pictures.paint import paint
from vectorplot.scene.item import Item
from vectorplot.scene.placement import default_camera
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View, look
from vectorplot.speed.results import cpu_seconds
from vectorplot.testing.shapes import box, bumpy_icosphere, numbered, rotated_boxes, rotation
from vectorplot.textbook.orders import graph_order, graph_triangles, ring_order, sliced_meridian, sphere_order
from vectorplot.visibility.painter.height_fields import known_orders
from vectorplot.visibility.painter.image_faces import drawn_faces, image_faces
from vectorplot.visibility.painter.painters_order import painters_order
from vectorplot.visibility.painter.priority_tests import convex_bodies, outlined_items
from vectorplot.visibility.projected_faces import project_faces

pytestmark = pytest.mark.bench


def view_of(scene: Scene) -> View:
    return look(scene, default_camera(scene))


def growth(sizes: list[int], times: list[float]) -> str:
    slope = np.polyfit(np.log(sizes), np.log(times), 1)[0]
    last = np.log(times[-1] / times[-2]) / np.log(sizes[-1] / sizes[-2])
    return f"  growth exponent {slope:.2f} over all, {last:.2f} at the end"


def ordered(name: str, views: dict[int, View], beat: str) -> None:
    print(f"\n{name} (to beat: {beat})")
    times = []
    for size, view in views.items():
        painted = painters_order(view)
        times.append(cpu_seconds(lambda v=view: painters_order(v)))
        print(f"  {size:>9,}: {painted.uncut:>9,} faces drawn as {len(painted):>9,}: {times[-1]:7.3f} s")
    print(growth(list(views), times))


def test_boxes_as_wholes() -> None:
    views = {count: view_of(rotated_boxes(count)) for count in (1000, 5000, 20000)}
    ordered("rotated boxes", views, "2 s at 20,000, exponent 1.3")


def test_convex_bodies_of_many_faces() -> None:
    views = {}
    for side in (10, 17, 27):
        random = np.random.default_rng(0)
        place = np.stack(np.meshgrid(*[np.arange(side)] * 3), axis=-1).reshape(-1, 3) * 1.2
        points = random.normal(size=(len(place), 12, 3))
        points *= 0.5 / np.linalg.norm(points, axis=2)[..., None]
        views[side**3] = view_of(numbered([hull_mesh(p + q) for p, q in zip(points, place, strict=True)]))
    ordered("convex hulls of 20 faces", views, "2.9 s at 20,000")


def test_faces_of_a_mesh() -> None:
    views = {20 * 4**level: view_of(Scene((Item("S", bumpy_icosphere(level)),))) for level in (5, 6, 7)}
    ordered("bumpy sphere, triangles", views, "4 s at 320,000, exponent 1.1")


def test_boxes_through_one_another() -> None:
    random = np.random.default_rng(1)
    shapes = []
    for _ in range(500):
        place = np.eye(4)
        place[:3, :3], place[:3, 3] = rotation(random), random.uniform(-5.0, 5.0, 3)
        shapes.append(box((0, 0, 0), random.uniform(0.3, 1.3, 3)).transformed(place))
    view = view_of(numbered(shapes))
    painted = painters_order(view)
    print(f"\n500 boxes through one another: {painted.uncut} faces drawn as {len(painted)}: ", end="")
    print(f"{cpu_seconds(lambda: painters_order(view)):.3f} s (to beat: 1.7 s, 1,482 to 3,096)")


def test_solids_by_the_power_of_their_spheres() -> None:
    print("\nsolids by power of spheres, checked (to beat: .44 s at 20,000)")
    sizes, times = [], []
    for side in (10, 17, 27):
        random = np.random.default_rng(0)
        place = np.stack(np.meshgrid(*[np.arange(side)] * 3), axis=-1).reshape(-1, 3) * 2.0
        view = view_of(
            numbered([box(p, p + s) for p, s in zip(place, random.uniform(0.2, 1.1, place.shape), strict=True)])
        )
        projected = project_faces(view)
        faces = image_faces(view, drawn_faces(view, projected))
        bodies = convex_bodies(view, faces, np.flatnonzero(outlined_items(view, projected)))
        assert sphere_order(view, faces, bodies) is not None
        sizes.append(len(bodies))
        times.append(cpu_seconds(lambda v=view, f=faces, b=bodies: sphere_order(v, f, b)))
        print(f"  {sizes[-1]:>9,}: {times[-1]:7.3f} s")
    print(growth(sizes, times))


def test_graphs_and_rings_without_a_comparison() -> None:
    print("\ngraphs: triangles and their order (to beat: .5 s at 1000 x 1000)")
    sizes, times = [], []
    for cells in (250, 500, 1000):
        line = np.linspace(-1.0, 1.0, cells + 1)
        sizes.append(2 * cells * cells)
        times.append(cpu_seconds(lambda x=line, n=cells: (graph_triangles(n, n), graph_order(x, x, (0.3, -3.0, 2.0)))))
        print(f"  {sizes[-1]:>9,}: {times[-1]:7.3f} s")
    print(growth(sizes, times))
    meridian = sliced_meridian(np.stack([2.0 + np.sin(np.linspace(0, 20, 600)), np.linspace(0, 5, 600)], axis=1))
    took = cpu_seconds(lambda: ring_order(meridian, 1000, (5.0, 4.0, 3.0)))
    print(f"  {1000 * (len(meridian) - 1):>9,} faces in rings: {took:7.3f} s")


def test_graphs_in_pictures() -> None:
    print("\ngraphs as meshes: known and painted (to beat: .5 s at 1000 x 1000; 4 s for 400 x 400 as SVG)")
    sizes, times = [], []
    for cells in (250, 500, 1000):
        scene = Scene((Item("G", waves(cells)),))
        view = view_of(scene)
        sizes.append(2 * cells * cells)
        times.append(cpu_seconds(lambda s=scene, v=view: known_orders(s, v)))
        print(f"  {sizes[-1]:>9,}: {times[-1]:7.3f} s")
    print(growth(sizes, times))
    scene = Scene((Item("G", waves(400)),))
    view = view_of(scene)
    print(f"  400 x 400 compared: {cpu_seconds(lambda: painters_order(view), 1):7.3f} s, ", end="")
    print(f"known: {cpu_seconds(lambda: painters_order(view, known=known_orders(scene, view))):7.3f} s, ", end="")
    print(f"painted and written: {cpu_seconds(lambda: svg_bytes(paint(scene)), 1):7.3f} s")


def waves(cells: int) -> Mesh:
    line = np.linspace(-1.0, 1.0, cells + 1)
    x, y = np.meshgrid(line, line, indexing="ij")
    vertices = np.stack([x, y, 0.3 * np.sin(9.0 * x) * np.cos(7.0 * y)], axis=-1).reshape(-1, 3)
    return Mesh.from_triangles(vertices, graph_triangles(cells, cells))


def test_visible_fills() -> None:
    print("\nvisible fills of rotated boxes (to beat: .61 s and 3.7 s at 5,058 and 19,967 faces, exponent 1.3)")
    sizes, times = [], []
    for count in (425, 1700, 6700):
        painted = paint(rotated_boxes(count), smooth=False)
        fills = painted.layers[0].fills[0]
        regions = visible_fills(fills, painted.page_from_world)
        sizes.append(len(fills))
        times.append(cpu_seconds(lambda f=fills, p=painted: visible_fills(f, p.page_from_world), 1))
        print(f"  {len(fills):>9,} faces, {len(regions):>9,} regions: {times[-1]:7.3f} s")
    print(growth(sizes, times))


def test_polygons_clipped_in_pairs() -> None:
    print("\nquadrilaterals clipped by hexagons, pair by pair")
    sizes, times = [], []
    for count in (20000, 140000):
        random = np.random.default_rng(0)
        corners = []
        for size in (4, 6):
            angle = np.linspace(0.0, 2.0 * np.pi, size, endpoint=False)
            circle = np.stack([np.cos(angle), np.sin(angle)])[:, None]
            corners += [(circle + random.uniform(-1, 1, (2, count, 1))).reshape(2, -1), np.arange(count + 1) * size]
        sizes.append(count)
        times.append(cpu_seconds(lambda c=corners: clipped_by_convex(*c)))
        print(f"  {count:>9,}: {times[-1]:7.3f} s")
    print(growth(sizes, times))


def test_a_camera_within_a_crowd() -> None:
    scene = rotated_boxes(20000)
    view = look(scene, Camera(tuple(scene.bounds.mean(axis=0)), tuple(scene.bounds[1])))
    print(f"\n20,000 boxes seen from among them: {cpu_seconds(lambda: painters_order(view)):7.3f} s")

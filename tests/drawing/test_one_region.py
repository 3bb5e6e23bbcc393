"""Coplanar faces of one item are one region, however they are cut, with all that lies on them."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from scipy.ndimage import maximum_filter, minimum_filter

import vectorplot as vp
from vectorplot.backends.cairo import drawing_pixels
from vectorplot.drawing.fills import FillKind, Fills
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.regions import polygons_of
from vectorplot.testing.shapes import box

SUN = vp.Light((-4, -5, 6), parallel=True, intensity=0.8)
SKY = vp.Light((4, -5, 6), parallel=True, intensity=0.4)
CAMERA = vp.Camera((9, -14, 11), (2, 1, 0.5), fov_deg=30.0)
PAGE = vp.Page(90.0, 70.0, 4.0)


def cut_up(mesh: Mesh, count: int) -> Mesh:
    """Every quadrilateral as a grid of pairs of triangles, with common corners."""
    grid = np.linspace(0.0, 1.0, count + 1)
    quads = mesh.vertices[mesh.corners].reshape(-1, 4, 3)
    u, v = np.meshgrid(grid, grid, indexing="ij")
    places = quads[:, None, None, 0] + u[..., None] * (quads[:, 1] - quads[:, 0])[:, None, None]
    places = (places + v[..., None] * (quads[:, 3] - quads[:, 0])[:, None, None]).reshape(-1, 3)
    corner = np.arange(len(places)).reshape(-1, count + 1, count + 1)
    a, b, c, d = corner[:, :-1, :-1], corner[:, 1:, :-1], corner[:, 1:, 1:], corner[:, :-1, 1:]
    faces = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    vertices, number = np.unique(np.round(places, 9), axis=0, return_inverse=True)
    return Mesh.from_triangles(vertices, number.ravel()[faces])


def boxes(count: int) -> vp.Scene:
    corners = [((1.6 * k, 0.0, 0.0), (1.6 * k + 1.0, 1.0, 1.0 + 0.3 * k)) for k in range(3)]
    items = [
        vp.Item(f"BOX{k}", box(*ends), colour) for k, (ends, colour) in enumerate(zip(corners, COLOURS, strict=True))
    ]
    items.append(vp.Item("FLOOR", box((-1, -1, -0.1), (6, 3, 0)), "gray"))
    return vp.Scene(tuple(vp.Item(i.name, cut_up(i.shape, count) if count else i.shape, i.colour) for i in items))


COLOURS = ("red", "green", "blue")


def painted(scene: vp.Scene, *lights: vp.Light) -> tuple[vp.Drawing, Fills]:
    drawing = vp.paint(scene, CAMERA, page=PAGE, lights=lights, smooth=False)
    return drawing, drawing.layers[0].fills[0]


@pytest.mark.hard(74)
@pytest.mark.parametrize("count", [1, 5])
def test_faces_of_one_plane_are_one_polygon(count: int) -> None:
    _, fills = painted(boxes(count))
    assert np.bincount(fills.item).tolist() == [3, 3, 3, 3]


@pytest.mark.slow
@pytest.mark.hard(74)
@pytest.mark.parametrize("lights", [(SUN,), (SUN, SKY)], ids=["one light", "two lights"])
def test_shadows_on_planes_in_pieces_are_those_on_whole_planes(lights: tuple[vp.Light, ...]) -> None:
    whole, fills = painted(boxes(0), *lights)
    pieces, cut = painted(boxes(5), *lights)
    assert len(cut) <= 2 * len(fills)
    one, other = (drawing_pixels(drawing, dpi=300).mean(axis=2) for drawing in (whole, pieces))
    # Borders of two colours may be stroked by the one or by the other: inside of them nothing differs, no line is seen.
    inside = maximum_filter(one, 7) - minimum_filter(one, 7) <= 2.0
    assert inside.mean() > 0.8 and np.abs(one - other)[inside].max() <= 2.0


@pytest.mark.hard(74)
def test_a_plane_with_a_hole_is_one_region_cut_open() -> None:
    sheet = cut_up(Mesh.from_polygons(np.array([[0, 0, 0], [6, 0, 0], [6, 6, 0], [0, 6, 0]], float), [[0, 1, 2, 3]]), 6)
    middle = sheet.vertices[sheet.corners].reshape(-1, 3, 3).mean(axis=1)
    kept = (np.abs(middle[:, :2] - 3.0).max(axis=1) > 1.0).nonzero()[0]
    faces = sheet.corners.reshape(-1, 3)[kept]
    ring = vp.Item("RING", Mesh.from_triangles(sheet.vertices, faces), "gray")
    fills = (
        vp.paint(vp.Scene((ring,)), vp.Camera((3, 2.9, 20), (3, 3, 0), fov_deg=30.0), page=PAGE, smooth=False)
        .layers[0]
        .fills[0]
    )
    assert len(fills) == 2
    polygons = polygons_of(fills.points.T, fills.offsets)
    region = shapely.union_all(polygons)
    assert shapely.area(polygons).sum() == pytest.approx(region.area) and len(region.interiors) == 1


@pytest.mark.hard(74)
def test_transparent_planes_and_patterns_stay() -> None:
    glass = vp.Item("GLASS", cut_up(box((0, 0, 0), (1, 1, 1)), 3), "cyan", vp.Material("transparent"))
    _, fills = painted(vp.Scene((glass,)))
    assert (fills.kind == FillKind.GLASS).all() and (fills.opacity == 0.5).all()

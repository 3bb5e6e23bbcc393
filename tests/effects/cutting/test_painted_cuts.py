"""Cuts in painted pictures: plane faces that they make or clip have one shade, and what is round keeps its gradient."""

from __future__ import annotations

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.arrays import Floats
from vectorplot.drawing.fills import Fills
from vectorplot.effects import cut_scene
from vectorplot.geometry import box
from vectorplot.geometry.mesh import Mesh
from vectorplot.scene import Cut
from vectorplot.surfaces import Capped, Cone, Sphere, rod
from vectorplot.testing.shapes import rotation

EYE = np.array([7.0, -11.0, 8.0])
SUN = vp.Light((1.0, -2.0, 3.0), parallel=True, intensity=1.0)
PAGE = vp.Page(101.6, 76.2, 0.0)


def plate(*holes: tuple[float, float, float]) -> Mesh:
    """A plate of 6 by 4 by 1 of triangles, with round holes at x, y of a radius."""
    import shapely

    flat = shapely.box(-3.0, -2.0, 3.0, 2.0)
    for x, y, radius in holes:
        flat = flat.difference(shapely.Point(x, y).buffer(radius, 12))
    parts = shapely.get_parts(shapely.constrained_delaunay_triangles(flat))
    places, which = np.unique(
        shapely.get_coordinates(parts).reshape(-1, 4, 2)[:, :3].reshape(-1, 2), axis=0, return_inverse=True
    )
    top = which.reshape(-1, 3)
    a, b, c = places[top].transpose(1, 0, 2)
    turn = (b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0] < 0.0
    top[turn] = top[turn][:, ::-1]
    sides = np.concatenate([top[:, [0, 1]], top[:, [1, 2]], top[:, [2, 0]]])
    once = {tuple(side) for side in sides.tolist()}
    start, end = np.array([side for side in sides.tolist() if tuple(side[::-1]) not in once]).T
    count = len(places)
    walls = [
        np.stack([start + count, end, start], axis=1)[:, ::-1],
        np.stack([start + count, end + count, end], axis=1)[:, ::-1],
    ]
    vertices = np.concatenate([np.column_stack([places, np.full(count, z)]) for z in (0.0, 1.0)])
    return Mesh.from_triangles(vertices, np.concatenate([top[:, ::-1], top + count, *walls]))


BODIES = {
    "plate": (plate((-1.5, 0.5, 0.8), (1.2, -0.4, 0.6)), ("y < 0.3",)),
    "plate along": (plate((-1.5, 0.5, 0.8), (1.2, -0.4, 0.6)), ("z > 0.5",)),
    "plate corner": (plate((-1.5, 0.5, 0.8), (1.2, -0.4, 0.6)), ("x > 1, y < -0.3", "y < -1.7")),
    "box": (box((4.0, 4.0, 2.0)), ("x > 2, y < 1", "2x - y + 2z > 3")),
    "can": (rod((0.0, 0.0, 0.0), (0.0, 0.0, 3.0), 2.0), ("x > 0, y < 1.6",)),
    "cone": (Capped(Cone(0.8, -3.0, -1.0, (0.0, 0.0, 3.0))), ("x > 0.2, y < 0.1",)),
    "ball": (Sphere(2.5), ("x > 0, y < 0.5", "z > 2")),
}
ROUND = ("can", "cone", "ball")
PLACES = {"as it is": (1.0, None), "small and turned": (1e-4, 5), "large and turned": (1e5, 8)}


def cut_scene_of(body: str, place: str) -> tuple[vp.Scene, vp.Camera]:
    """A body that is cut, turned about the origin with the eye and scaled."""
    shape, cuts = BODIES[body]
    scale, seed = PLACES[place]
    turn = np.eye(3) if seed is None else rotation(np.random.default_rng(seed))
    matrix = np.eye(4)
    matrix[:3, :3] = scale * turn
    light = vp.Light(tuple((turn @ SUN.position).tolist()), parallel=True, intensity=1.0)
    whole = vp.Scene((vp.Item("A", shape, "gray"),), (), cuts=tuple(Cut.of(cut) for cut in cuts))
    scene = cut_scene(whole.transformed(matrix))
    eye, target = (tuple((matrix[:3, :3] @ place).tolist()) for place in (EYE, np.array([0.5, 0.0, 1.0])))
    # Far behind: otherwise planes reach through most of the depth of the picture, and their shades vary with it.
    behind = np.eye(4)
    behind[:3, 3] = -2.0 * EYE
    speck = vp.Item("SPECK", box((0.01, 0.01, 0.01)).transformed(matrix @ behind), "gray")
    return vp.Scene((*scene.items, speck), (light,)), vp.Camera(eye, target, fov_deg=32.0)


def colours(fills: Fills, item: int) -> Floats:
    own = np.repeat(fills.item == item, np.diff(fills.offsets))
    return np.unique(fills.colours[own], axis=0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("body", "place"),
    [
        *((body, place) for body in BODIES if body not in ROUND for place in PLACES),
        *((body, "as it is") for body in ROUND),
    ],
)
def test_faces_of_cuts_have_the_shade_that_they_have_where_every_plane_has_one(body: str, place: str) -> None:
    scene, camera = cut_scene_of(body, place)
    # Of round bodies there are enough faces.
    fine = 0.5 if body in ROUND else 0.02
    smooth, flat = (
        vp.paint(scene, camera, page=PAGE, smooth=smooth, shadows="none", tolerance_mm=fine).layers[0].fills[0]
        for smooth in (True, False)
    )
    faces = [k for k, item in enumerate(scene.items) if item.is_cut_face and len(colours(flat, k))]
    assert faces
    for item in faces:
        assert np.array_equal(colours(smooth, item), colours(flat, item))
    # On what is round there are more shades than planes.
    assert body not in ROUND or len(colours(smooth, 0)) > 20

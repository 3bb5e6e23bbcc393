"""Smooth surfaces painted in bands of equal shade: against rays, and against triangles with gradients."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely
from support.body_colours import assert_shown
from support.top_fills import colours_at, fills_of, top_at

import vectorplot as vp
from vectorplot.accuracy.of_surfaces import covered
from vectorplot.drawing.fills import FillKind
from vectorplot.geometry import box as box_at_origin
from vectorplot.geometry import ragged
from vectorplot.save import write
from vectorplot.scene import look
from vectorplot.shading.shade_bands import _doubled_areas, _opened, _rings_within
from vectorplot.surfaces import Sphere, Torus, rod
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.surface import Domain
from vectorplot.visibility.painter.image_faces import image_faces
from vectorplot.visibility.painter.painters_order import picture_layers

CAMERAS = {"central": vp.Camera((10, -8, 6)), "parallel": vp.Camera((10, -8, 6), parallel=True)}
LAMPS = (vp.Light((5, -6, 7)), vp.Light((-1, -1, 1), parallel=True))

BESIDE_MM = 0.12
"""Nearer than this to an outline, or the border of a shadow, the one or the other may be painted."""


def box(size, origin=(0.0, 0.0, 0.0)):
    x, y, z = origin
    return box_at_origin(size, placement=(1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, z))


FLOOR = vp.Item("FLOOR", box((8, 8, 0.3), origin=(-4, -4, -1.8)), "lightgray")
PIERCED = {
    "rods": (rod((0, 0, 0), (3, 0, 0), 0.3), rod((1, -1, 0), (1, 2, 0), 0.3)),
    "rod in a ball": (rod((-3, 0, 0), (3, 0, 0), 0.3), Sphere(1.0)),
    "box in a ball": (Sphere(1.0), box((1, 1, 1), origin=(0.5, -0.5, -0.5))),
}


def scene_of(*shapes, lights=(), floor=False):
    items = [vp.Item(f"BODY{k}", shape, ("blue", "red", "green")[k % 3]) for k, shape in enumerate(shapes)]
    return vp.Scene((*((FLOOR,) if floor else ()), *items), lights)


def rings(count, seed=3):
    """Tori in a heap, some of which pierce each other."""
    random = np.random.default_rng(seed)
    side = 0.8 * (6.0 * count) ** (1.0 / 3.0)
    shapes = []
    for _ in range(count):
        turned = np.linalg.qr(random.normal(size=(3, 3)))[0]
        tube = Torus(1.0, random.uniform(0.2, 0.4))
        shapes.append(PlacedSurface(tube, turned * np.linalg.det(turned), random.uniform(-side, side, 3)))
    return shapes


def hill():
    return surface_of_function(lambda u, v: (u, v, np.sin(2.0 * u) * np.cos(2.0 * v)), Domain(-2.0, 2.0, -2.0, 2.0))


def with_triangles(scene):
    """The same scene, which groups keep from being painted in bands."""
    return replace(scene, items=tuple(replace(item, group="ALL") for item in scene.items))


def places_on(fills, count=3000):
    low, high = fills.points.min(axis=0), fills.points.max(axis=0)
    return low + np.random.default_rng(1).random((count, 2)) * (high - low)


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("camera", list(CAMERAS))
@pytest.mark.parametrize("lights", [(), LAMPS[:1], LAMPS], ids=["none", "one", "two"])
@pytest.mark.parametrize("name", list(PIERCED))
def test_bodies_that_pierce_others_are_seen_as_rays_see_them(name, lights, camera):
    scene = scene_of(*PIERCED[name], lights=lights, floor=True)
    drawing = vp.paint(scene, CAMERAS[camera])
    fills = fills_of(drawing)
    assert not scene.lights or (fills.kind == FillKind.BAND).any()
    bodies = np.array([not isinstance(item.shape, vp.Mesh) for item in scene.items])
    assert_shown(
        scene,
        CAMERAS[camera],
        drawing,
        places_on(fills),
        beside_mm=BESIDE_MM,
        shaded=bodies,
        share=0.98,
        steps=5.0,
        rarely=20.0,
    )


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("lights", [(), LAMPS[:1], LAMPS], ids=["none", "one", "two"])
@pytest.mark.parametrize(
    "shapes",
    [(Torus(1.5, 0.5),), rings(4), (hill(),), (hill(), Torus(1.0, 0.4))],
    ids=["torus", "heap", "hill", "both"],
)
def test_bands_show_what_triangles_with_gradients_show(shapes, lights):
    scene = scene_of(*shapes, lights=lights, floor=True)
    one, other = (fills_of(vp.paint(some, CAMERAS["central"])) for some in (scene, with_triangles(scene)))
    assert (one.kind == FillKind.BAND).any() and not (other.kind == FillKind.BAND).any()
    places = places_on(one, 6000)
    tops = [top_at(fills, places) for fills in (one, other)]
    both = np.flatnonzero((tops[0] >= 0) & (tops[1] >= 0))
    items = [fills.item[top[both]] for fills, top in zip((one, other), tops, strict=True)]
    same = both[items[0] == items[1]]
    assert len(same) > 0.99 * np.maximum((tops[0] >= 0).sum(), (tops[1] >= 0).sum())
    colours = [colours_at(fills, top[same], places[same]) for fills, top in zip((one, other), tops, strict=True)]
    off = np.abs(colours[0] - colours[1]).max(axis=1)
    assert np.quantile(off, 0.5) <= 2.0 and np.quantile(off, 0.97) <= 6.0


@pytest.mark.slow
@pytest.mark.parametrize("shapes", [(Torus(1.5, 0.5),), rings(4)], ids=["torus", "heap"])
def test_nothing_shines_through_between_bands(shapes):
    fills = fills_of(vp.paint(scene_of(*shapes, lights=LAMPS[:1]), CAMERAS["central"]))
    seen = shapely.get_parts(covered(fills.points, fills.offsets))
    holes = np.concatenate([[shapely.Polygon(ring).area for ring in part.interiors] for part in seen])
    assert not ((holes > 4e-3) & (holes < 1.0)).any()


def test_black_has_one_shade():
    fills = fills_of(vp.paint(vp.Scene((vp.Item("RING", Torus(1.0, 0.4), "black"),)), CAMERAS["central"]))
    assert (fills.kind == FillKind.BAND).all() and not fills.colours.any()


@pytest.mark.slow
def test_any_number_of_threads_makes_the_same_bytes():
    scene = scene_of(*rings(2), lights=LAMPS[:1])
    one, other = (write(vp.paint(scene, CAMERAS["central"], jobs=jobs), "svg") for jobs in (1, 3))
    assert one == other


@pytest.mark.slow
def test_few_bytes_make_a_heap():
    scene = scene_of(*rings(3), lights=LAMPS[:1])
    one, other = (len(write(vp.paint(some, CAMERAS["central"]), "svg")) for some in (scene, with_triangles(scene)))
    assert one < 0.5 * other


@pytest.mark.parametrize(
    "scene",
    [
        vp.Scene((vp.Item("RING", Torus(1.0, 0.4), material=vp.Material("transparent")),)),
        vp.Scene((vp.Item("RING", Torus(1.0, 0.4)),), (vp.Light((3, 2, 1), colour="red"),)),
        vp.Scene((vp.Item("RING", Torus(1.0, 0.4)),), (vp.Light((3, 2, 1), fading=True),)),
    ],
    ids=["transparent", "coloured light", "fading light"],
)
def test_what_bands_cannot_show_has_triangles(scene):
    fills = fills_of(vp.paint(scene, CAMERAS["central"], tolerance_mm=0.2))
    assert len(fills) and not (fills.kind == FillKind.BAND).any()


# Layers of a picture.


def stack(*lows):
    """Unit squares in one view, each above the one before, with their lower left corners at some places."""
    squares = [((x, y, z), (x + 1, y, z), (x + 1, y + 1, z), (x, y + 1, z)) for z, (x, y) in enumerate(lows)]
    mesh = vp.Mesh.from_polygons(np.reshape(squares, (-1, 3)), np.arange(4 * len(lows)).reshape(-1, 4))
    view = look(vp.Scene((vp.Item("SQUARES", mesh),)), vp.Camera.view("top"))
    return image_faces(view, np.arange(len(lows))), view.tolerance


def test_what_nothing_covers_is_in_the_first_layer():
    faces, tolerance = stack((0, 0), (0.5, 0), (1.2, 0), (5, 0))
    assert picture_layers(faces, np.arange(4), tolerance).tolist() == [2, 1, 0, 0]


def test_what_only_touches_is_in_one_layer():
    faces, tolerance = stack((0, 0), (1, 0), (0, 1), (1, 1))
    assert picture_layers(faces, np.arange(4), tolerance).tolist() == [0, 0, 0, 0]


def test_polygons_of_one_number_are_in_one_layer():
    faces, tolerance = stack((0, 0), (5, 0), (0.5, 0))
    assert picture_layers(faces, np.array([0, 0, 1]), tolerance).tolist() == [1, 1, 0]


# Rings and their holes as polygons.


def squares(*sides):
    """Rings about the origin, of so long sides, those of negative ones clockwise."""
    corners = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) / 2.0
    parts = [abs(side) * (corners if side > 0 else corners[::-1]) for side in sides]
    return np.concatenate(parts).T, np.arange(0, 4 * len(sides) + 1, 4)


def test_rings_within_others_are_found():
    page, offsets = squares(8.0, 4.0, 2.0, 6.0)
    every = np.arange(4)
    around, within = _rings_within(page, offsets, np.array([0, 0, 0, 1]), every, every)
    assert sorted(zip(around.tolist(), within.tolist(), strict=True)) == [(0, 1), (0, 2), (1, 2)]


def test_rings_are_cut_open_to_their_holes():
    page, offsets = squares(8.0, -4.0, 2.0)
    corner, ends, of = _opened(offsets, np.array([0, 1, 2]), np.array([0, 0, 2]))
    assert of.tolist() == [0, 2] and np.diff(ends).tolist() == [11, 4]
    assert (_doubled_areas(page[:, corner], ends) / 2.0).tolist() == [64.0 - 16.0, 4.0]
    # The way to the hole is gone twice, once each way.
    ring = corner[: ends[1]]
    steps = list(zip(ring.tolist(), ring[ragged.following(ends[:2])].tolist(), strict=True))
    assert (0, 4) in steps and (4, 0) in steps

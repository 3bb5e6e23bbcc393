"""Bodies that meet in other curves than circles: traced, and hidden like all else."""

from __future__ import annotations

import numpy as np
import pytest
from support.body_rays import body_sight, off_surface, unit_body

from vectorplot.geometry.camera import Camera
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.capped_bodies import Capped, rod
from vectorplot.surfaces.quadrics import Cone, Cylinder, Ellipsoid, Sphere
from vectorplot.testing.shapes import box
from vectorplot.words import LineKind

PAIRS = {
    "rods": (rod((-2, 0, 0), (2, 0, 0), 0.5), rod((0, -2, 0.1), (0, 2, 0.2), 0.4)),
    "equal rods": (rod((-2, 0, 0), (2, 0, 0), 0.5), rod((0, -2, 0), (0, 2, 0), 0.5)),
    "a rod in a ball": (Sphere(1.0), rod((-0.3, 0, -2), (0.4, 0.2, 2), 0.4)),
    "a ball in a cone": (Capped(Cone.standing(1.0, 2.0)), Sphere(0.8, (0.6, 0.3, 0.8))),
    "a chimney on a dome": (Capped(Sphere(1.2), (0, np.pi / 2)), Capped(Cylinder(0.4, -1, 3, (0.5, 0, 0)))),
    "ellipsoids": (Ellipsoid((1, 2, 1.2)), Ellipsoid((2, 1, 0.8), (0.2, 0.1, 0.3))),
}

PLATE = (np.array([-3.0, -3.0, -0.1]), np.array([3.0, 3.0, 0.15]))


def strokes_of(drawing):
    return [(paths, k) for layer in drawing.layers for paths in layer.strokes for k in range(len(paths))]


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("name", PAIRS)
def test_every_point_is_hidden_by_as_many_items_as_rays_meet(name, parallel):
    shapes = PAIRS[name]
    bodies = [unit_body(shape) for shape in shapes]
    items = [*(Item(str(k), shape) for k, shape in enumerate(shapes)), Item("plate", box(*PLATE))]
    camera = Camera((5, -8, 6), (0, 0, 0), parallel=parallel)
    drawing = draw(Scene(tuple(items)), camera, hidden="solid", curves="polyline")
    points, counts, met = [], [], []
    for paths, k in strokes_of(drawing):
        own = paths.points3d[paths.offsets[k] : paths.offsets[k + 1]]
        inner = own[1:-1] if paths.smooth[k] else 0.5 * (own[1:] + own[:-1])
        points.append(inner)
        counts += [paths.hidden_by[k]] * len(inner)
        met += [paths.kind[k] == LineKind.INTERSECTION] * len(inner)
    points, counts, met = np.concatenate(points), np.array(counts), np.array(met)
    off = np.stack([off_surface(body, (points - body.centre) @ np.linalg.inv(body.frame)) for body in bodies])
    on_plate = np.abs(np.maximum(PLATE[0] - points, points - PLATE[1]).max(axis=1)) < 1e-9
    # Curves of two of them lie on both.
    assert ((off < 1e-9).sum(axis=0) + on_plate)[met].min() == 2 and met.sum() > 100
    truth = body_sight(camera, points, bodies, [PLATE])
    sure = truth.sure & ~on_plate & (off.min(axis=0) < 1e-7)
    assert sure.sum() > 200
    assert (counts[sure] == truth.hidden_by[sure]).all()


@pytest.mark.slow
def test_bonds_of_an_atom_meet_inside_of_it_where_nobody_looks():
    places = np.array([(0, 0, 0), (1.5, 0, 0), (-0.7, 1.3, 0), (-0.5, -0.9, 1.0), (-0.4, -0.6, -1.3)])
    atoms = [Item(f"atom {k}", Sphere(0.4, place)) for k, place in enumerate(places)]
    bonds = [Item(f"bond {k}", rod(places[0], places[k], 0.1)) for k in range(1, 5)]
    camera = Camera((3, -9, 4), (0, 0, 0))
    visible = draw(Scene((*atoms, *bonds)), camera)
    every = draw(Scene((*atoms, *bonds)), camera, hidden="solid")

    def meetings(drawing, hidden):
        return sum(
            paths.kind[k] == LineKind.INTERSECTION and (paths.hidden_by[k] > 0) == hidden
            for paths, k in strokes_of(drawing)
        )

    # Eight circles, and hidden ones where rods meet each other.
    assert meetings(visible, True) == 0 and 4 <= meetings(visible, False) <= 8
    assert meetings(every, True) > 4

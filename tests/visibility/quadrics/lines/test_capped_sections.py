"""Plane sections and isophotes of frusta and parts of balls: where they lie, all of them, and what hides them."""

from __future__ import annotations

import numpy as np
import pytest
from support.body_rays import body_sight, off_surface, unit_body

from vectorplot.geometry.camera import Camera
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import Section, SurfaceLines, even_cosines
from vectorplot.scene.view import look
from vectorplot.surfaces.capped_bodies import Capped, Frustum
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import Cone, Cylinder, Sphere
from vectorplot.visibility.polyhedra.hidden_lines import unhidden
from vectorplot.visibility.quadrics.closed_forms import closed_forms
from vectorplot.words import LineKind

EVERY = [
    Capped(Cylinder(0.7, 0.0, 1.4)),
    Capped(Cone.standing(0.8, 1.3)),
    Capped(Frustum(0.3, 0.9, 1.1)),
    Capped(Frustum(0.9, 0.2, 1.2)),
    Capped(Cone(0.5, 0.0, 1.2)),
    Capped(Sphere(0.8), (-0.4, 0.5 * np.pi)),
    Capped(Sphere(0.8), (-0.9, 0.3)),
]

TOWARDS = np.array([0.3, -0.8, 0.5])


def row_of_bodies(sections, isophotes, oblique):
    """All kinds side by side, turned every way, each with the planes that sections(body) gives."""
    rng = np.random.default_rng(7)
    items, bodies = [], []
    for number, shape in enumerate(EVERY):
        matrix, _ = np.linalg.qr(rng.normal(size=(3, 3)))
        if oblique:
            matrix = matrix @ (np.eye(3) + 0.2 * rng.normal(size=(3, 3)))
        placed = PlacedSurface(shape, matrix, np.array([1.9 * number, 0.4 * (number % 3), 0.0]))
        bodies.append(unit_body(placed))
        curves = SurfaceLines(sections=sections(bodies[-1]), isophotes=isophotes)
        items.append(Item(str(number), placed, curves=curves, lines=("section", "isophote")))
    return Scene(tuple(items), lights=(Light(tuple(TOWARDS.tolist()), parallel=True),)), bodies


def planes_of(body):
    """Families across the axis, along it, along a ruling, tilted less than rulings, and more; one through the apex."""
    axis = body.frame[2] / np.linalg.norm(body.frame[2])
    side = np.cross(axis, [0.3, 0.5, 0.8])
    side /= np.linalg.norm(side)
    ruling = body.frame[2] + (body.radii[1] - body.radii[0]) * body.frame[0]
    normals = [axis, side, np.cross(ruling, body.frame[1]), axis + 0.3 * side, axis + 1.5 * side]
    middle = body.centre + 0.5 * (body.low + body.high) * body.frame[2]
    found = []
    for normal in normals:
        normal = normal / np.linalg.norm(normal)
        tip = float(normal @ (body.centre + body.frame[2]))
        steps = float(normal @ middle) + 0.17 * np.arange(-4, 5)
        found.append(Section(tuple(normal.tolist()), (*steps.tolist(), tip)))
    return tuple(found)


def chords(drawing, item):
    """(n,3) starts and ends of chords drawn on an item."""
    found = [np.zeros((2, 0, 3))]
    for layer in drawing.layers:
        for paths in layer.strokes:
            for k in np.flatnonzero(paths.item == item).tolist():
                own = paths.points3d[paths.offsets[k] : paths.offsets[k + 1]]
                own = np.concatenate([own, own[:1]]) if paths.closed[k] else own
                found.append(np.stack([own[:-1], own[1:]]))
    return np.concatenate(found, axis=1)


def on_rulings(body, sections, turn):
    """(k,3) points in which planes of sections cut rulings of a frustum at some angles."""
    z = np.tile([[0.0], [1.0]], len(turn))
    radius = body.radii[0] + (body.radii[1] - body.radii[0]) * z
    one, two = np.stack([radius * np.cos(turn), radius * np.sin(turn), z], axis=2) @ body.frame + body.centre
    found = []
    for section in sections:
        normal, offset = np.array(section.normal), np.array(section.offsets)[:, None]
        below, rise = one @ normal - offset, (two - one) @ normal
        part = -below / np.where(np.abs(rise) > 1e-6, rise, 1e-300)
        k = np.nonzero((part > 1e-9) & (part < 1.0 - 1e-9))
        found.append(one[k[1]] + part[k][:, None] * (two - one)[k[1]])
    return np.concatenate(found)


def distances(points, start, end):
    """(k,) from points to the nearest chord."""
    way = end - start
    square = np.maximum((way * way).sum(axis=1), 1e-300)
    part = np.clip(((points[:, None] - start) * way).sum(axis=2) / square, 0.0, 1.0)
    return np.linalg.norm(points[:, None] - start - part[..., None] * way, axis=2).min(axis=1)


def arcs_of(scene, camera):
    """The conics of a scene: of each item nine points on every one, in the world."""
    view = look(scene, camera)
    kinds = frozenset({LineKind.SECTION, LineKind.ISOPHOTE})
    forms = closed_forms(scene, view, kinds, lambda bodies, arcs, sides: unhidden(arcs))
    arcs, every = forms.arcs, np.arange(len(forms.arcs))
    parts = [arcs.at(every, arcs.low + part * (arcs.high - arcs.low))[0] for part in np.linspace(0.0, 1.0, 9)]
    world = [forms.bodies.sight.points_of_view(points) @ view.axes * view.scale + view.centre for points in parts]
    return np.stack(world, axis=1), arcs.item, forms.items


VIEWS = [((14, -12, 9), False), ((-3, 11, -4), True)]


@pytest.mark.parametrize("oblique", [False, True])
@pytest.mark.parametrize(("eye", "parallel"), VIEWS)
def test_sections_lie_in_their_planes_and_on_their_bodies(eye, parallel, oblique):
    scene, bodies = row_of_bodies(planes_of, (), oblique)
    points, item, closed = arcs_of(scene, Camera(eye, (6, 0, 0), parallel=parallel))
    assert closed == set(range(len(bodies)))
    for number, body in enumerate(bodies):
        own = points[item == number]
        flat = own.reshape(-1, 3)
        assert off_surface(body, (flat - body.centre) @ np.linalg.inv(body.frame)).max() < 1e-12
        heights = np.concatenate(
            [own @ np.array(s.normal) - np.array(s.offsets)[:, None, None] for s in scene.items[number].curves.sections]
        )
        # Each arc as a whole in one plane.
        assert np.abs(heights).max(axis=2).min(axis=0).max() < 1e-12


@pytest.mark.slow
@pytest.mark.parametrize(("oblique", "view"), [(False, 1), (True, 0)])
def test_sections_are_all_there_and_hidden_by_what_rays_meet(oblique, view):
    eye, parallel = VIEWS[view]
    scene, bodies = row_of_bodies(planes_of, (), oblique)
    camera = Camera(eye, (6, 0, 0), parallel=parallel)
    drawing = draw(scene, camera, hidden="none", curves="polyline")
    rng = np.random.default_rng(3)
    looked = 0
    for number, body in enumerate(bodies):
        start, end = chords(drawing, number)
        if not body.is_round:
            points = on_rulings(body, scene.items[number].curves.sections, rng.uniform(0.0, 2.0 * np.pi, 30))
            truth = body_sight(camera, points, bodies)
            # But for the last that is seen of a tip.
            away = np.linalg.norm(points - body.centre - body.frame[2], axis=1) > 0.02
            shown = points[truth.sure & (truth.hidden_by == 0) & away]
            looked += len(shown)
            assert distances(shown, start, end).max() < 4e-3
        middle = 0.5 * (start + end)
        truth = body_sight(camera, middle, bodies)
        inner = np.linalg.norm(end - start, axis=1) > 0.02
        on = off_surface(body, (middle - body.centre) @ np.linalg.inv(body.frame)) < 1e-9
        assert (truth.hidden_by[truth.sure & inner & on] == 0).all()
    assert looked > 500


@pytest.mark.parametrize(("eye", "parallel"), VIEWS)
def test_isophotes_have_their_angle_with_the_light(eye, parallel):
    asked = even_cosines(9)
    scene, bodies = row_of_bodies(lambda body: (), asked, False)
    points, item, closed = arcs_of(scene, Camera(eye, (6, 0, 0), parallel=parallel))
    assert closed == set(range(len(bodies)))
    light = TOWARDS / np.linalg.norm(TOWARDS)
    rng = np.random.default_rng(5)
    for number, body in enumerate(bodies):
        unit = (points[item == number].reshape(-1, 3) - body.centre) @ np.linalg.inv(body.frame)
        cosine = cosines_on(body, unit, light)
        off = np.abs(cosine[:, None] - np.array(asked))
        assert off.min(axis=1).max() < 1e-10
        # All those that occur anywhere on the mantle.
        turn, z = rng.uniform(0.0, 2.0 * np.pi, 20000), rng.uniform(body.low, body.high, 20000)
        radius = np.sqrt(1.0 - z * z) if body.is_round else body.radii[0] + (body.radii[1] - body.radii[0]) * z
        every = cosines_on(body, np.stack([radius * np.cos(turn), radius * np.sin(turn), z], axis=1), light)
        there = [k for k, c in enumerate(asked) if every.min() + 1e-2 < c < every.max() - 1e-2]
        assert len(there) > 2 and set(there) <= set(off.argmin(axis=1).tolist())


def cosines_on(body, unit, light):
    """(k,) of the angles between the light and the outward normals at points of the unit body's mantle."""
    growth = 0.0 if body.is_round else body.radii[1] - body.radii[0]
    radius = np.hypot(unit[:, 0], unit[:, 1])
    rise = unit[:, 2] if body.is_round else -growth * radius
    outward = np.stack([unit[:, 0], unit[:, 1], rise], axis=1)[radius > 1e-6] @ np.linalg.inv(body.frame).T
    return outward @ light / np.linalg.norm(outward, axis=1)

"""Curves of smooth surfaces, alone and among polyhedra, against brute-force rays and against themselves."""

from __future__ import annotations

import warnings
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from support.analytic_sight import sheets_in_front
from support.effort import several
from support.smooth_scenes import few, implicit_surfaces, mixed_scenes, single_surfaces, special_views, views
from support.smooth_seen import Chords, chords_seen

from vectorplot.drawing.drawing import Drawing
from vectorplot.errors import InputWarning
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.pictures.draw import draw
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import Sphere
from vectorplot.testing import assert_drawing_is_right
from vectorplot.testing.shapes import box
from vectorplot.words import LineKind

SINGLE, IMPLICIT, MIXED = single_surfaces(), implicit_surfaces(), mixed_scenes()
SCENES = {**SINGLE, **IMPLICIT, **MIXED}

NOT_KNOWN = 3e-6
"""Clearance, as a part of the extent, below which rays leave a point open."""


SAMPLES = several(160, long=250)
"""Points of each scene: a hundredth of the lines drawn wrong is found with four chances in five."""


@cache
def two_views(name: str) -> tuple[Camera, ...]:
    """A central and a parallel one: what a scene looks like from there is found once for all tests."""
    return tuple(views(SCENES[name], 2, len(name)))


@cache
def chords_of(name: str, view: int) -> Chords:
    return chords_seen(SCENES[name], two_views(name)[view])


@cache
def drawing_of(name: str, view: int) -> Drawing:
    return draw(SCENES[name], two_views(name)[view], hidden="solid")


def assert_right(name: str) -> None:
    """As rays see it; and behind no more items than there are, a surface that is in front of itself being one. From an
    eye or in parallel, one scene thus and the next one so, or both ways."""
    most = sum(item.hides for item in SCENES[name].items)
    for view in (list(SCENES).index(name) % 2,) if several(1, long=2) == 1 else (0, 1):
        drawing, scene, camera = drawing_of(name, view), SCENES[name], two_views(name)[view]
        counts = np.concatenate([paths.hidden_by for layer in drawing.layers for paths in layer.strokes])
        assert len(counts) and counts.max() <= most
        compared = assert_drawing_is_right(drawing, scene, camera, samples=SAMPLES, seed=view, clearance=NOT_KNOWN)
        assert compared > SAMPLES // 3


@pytest.mark.slow
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("name", SINGLE)
def test_a_surface_as_rays_see_it(name: str) -> None:
    assert_right(name)


@pytest.mark.slow
@pytest.mark.spread(parts=2)
@pytest.mark.parametrize("name", IMPLICIT)
def test_an_implicit_surface_as_rays_see_it(name: str) -> None:
    assert_right(name)


@pytest.mark.slow
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("name", MIXED)
def test_surfaces_and_polyhedra_as_rays_see_them(name: str) -> None:
    assert_right(name)


CLOSED_FORMS = ["torus", "sphere", "hyperbolic paraboloid", "hyperboloid", "cylinder"]


@pytest.mark.slow
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_views_along_axes_and_rulings_as_in_closed_form(name: str) -> None:
    scene, compared = SINGLE[name], 0
    shape = scene.items[0].shape
    # Along the z-axis from an eye and in parallel, from the other sides in turn.
    for camera in (view for k, view in enumerate(special_views(scene)) if k in (4, 5) or k // 2 % 2 == k % 2):
        chords = chords_seen(scene, camera)
        # Chords are beside the surface, their ends on it: a chord tells of the end it shares with another.
        inner = np.flatnonzero((chords.end[:-1] == chords.start[1:]).all(axis=1))
        inner = inner[chords.hidden_by[inner] == chords.hidden_by[inner + 1]]
        sheets, sure = sheets_in_front(shape, camera, chords.end[inner])
        wrong = np.flatnonzero(sure & ((sheets > 0) != (chords.hidden_by[inner] > 0)))
        compared += int(sure.sum())
        assert not len(wrong), f"{len(wrong)} of {sure.sum()}, {chords.end[inner[wrong[0]]]}, {camera}"
    assert compared > 2500


@pytest.mark.slow
def test_a_flat_graph_along_its_axis_as_rays_see_it() -> None:
    for seed, camera in enumerate(list(special_views(SINGLE["ripple"]))[1 : several(2, long=6) : 2]):
        drawing = draw(SINGLE["ripple"], camera, hidden="solid")
        assert_drawing_is_right(drawing, SINGLE["ripple"], camera, samples=200, seed=seed, clearance=NOT_KNOWN)


def assert_same_lengths(one: Chords, two: Chords, *, scale: float = 1.0, tolerance: float = 1e-6) -> None:
    """Equal lengths of each kind behind equal numbers of items, relative to all of them."""
    expected, found = one.lengths(), two.lengths() / scale
    worst = np.abs(expected - found).max() / expected.sum()
    assert worst < tolerance, f"lengths of kinds by number of items in front differ by {worst:.2g} of all"


def moved(scene: Scene, camera: Camera, scale: float, offset: np.ndarray) -> tuple[Scene, Camera]:
    """Scene, lights and camera, scaled and shifted."""
    items = []
    for item in scene.items:
        if isinstance(item.shape, Mesh):
            whole = np.eye(4)
            whole[:3, :3], whole[:3, 3] = scale * np.eye(3), offset
            items.append(replace(item, shape=item.shape.transformed(whole)))
        else:
            items.append(replace(item, shape=PlacedSurface(item.shape, scale * np.eye(3), offset)))
    eye, target = (tuple((scale * np.asarray(p) + offset).tolist()) for p in (camera.eye, camera.target))
    return replace(scene, items=tuple(items)), Camera(eye, target, camera.up, 0.0, camera.fov_deg, camera.parallel)


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize(("scale", "offset"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
@pytest.mark.parametrize("name", ["linked tori", "torus and box"])
def test_size_and_place_change_nothing(name: str, scale: float, offset: float) -> None:
    # One scene from an eye, the other one in parallel.
    view = ["linked tori", "torus and box"].index(name)
    there = moved(MIXED[name], two_views(name)[view], scale, offset * np.array([1.0, -1.0, 1.0]))
    assert_same_lengths(chords_of(name, view), chords_seen(*there), scale=scale, tolerance=1e-5)


@pytest.mark.slow
@pytest.mark.spread(parts=3)
@pytest.mark.parametrize("name", ["linked tori", "torus and box", "far behind"])
def test_the_order_of_items_changes_nothing(name: str) -> None:
    scene = MIXED[name]
    turned = replace(scene, items=scene.items[::-1])
    for view, camera in enumerate(two_views(name)[: several(1, long=2)]):
        assert_same_lengths(chords_of(name, view), chords_seen(turned, camera))


@pytest.mark.slow
def test_what_stands_behind_changes_nothing_in_front() -> None:
    scene = MIXED["linked tori"]
    for view, camera in enumerate(two_views("linked tori")[: several(1, long=2)]):
        away = np.asarray(camera.target) - 12.0 * camera.direction
        low, high = away - 2.0, away + 2.0
        behind = replace(scene, items=(*scene.items, Item("ball", Sphere(1.0, away)), Item("box", box(low, high))))
        before, after = chords_of("linked tori", view), chords_seen(behind, camera)
        own = after.item < len(scene.items)
        kept = Chords(*(getattr(after, name)[own] for name in ("start", "end", "kind", "item", "hidden_by")))
        # The picture is larger now, and so are the chords that are near enough to the curves.
        assert_same_lengths(before, kept, tolerance=1e-4)


@pytest.mark.slow
def test_what_stands_in_front_only_hides() -> None:
    scene = MIXED["spheres piercing"]
    for view, camera in enumerate(two_views("spheres piercing")[: several(1, long=2)]):
        front = replace(scene, items=(*scene.items, Item("ball", Sphere(0.6, 2.8 * camera.direction))))
        before, after = chords_of("spheres piercing", view), chords_seen(front, camera)
        own = after.item < len(scene.items)
        kept = Chords(*(getattr(after, name)[own] for name in ("start", "end", "kind", "item", "hidden_by")))
        assert np.isclose(kept.length.sum(), before.length.sum(), rtol=1e-4)
        visible, counted = (chords.lengths().sum(axis=0) for chords in (before, kept))
        assert (np.cumsum(counted) <= np.cumsum(visible) + 1e-4 * visible.sum()).all()
        assert counted[0] < visible[0]


@pytest.mark.slow
def test_what_does_not_occlude_hides_nothing() -> None:
    scene = MIXED["linked tori"]
    glass = replace(scene, items=tuple(replace(item, occludes=False) for item in scene.items))
    for camera in views(glass, several(1, long=2), 8):
        assert (chords_seen(glass, camera).hidden_by == 0).all()


@pytest.mark.slow
def test_a_drawing_without_hidden_lines_shows_what_nothing_hides() -> None:
    for view, name in enumerate(("torus", "torus and box")):
        every, seen = drawing_of(name, view), draw(SCENES[name], two_views(name)[view])
        lengths = []
        for drawing in (every, seen):
            total = np.zeros(len(LineKind))
            for layer in drawing.layers:
                for paths in layer.strokes:
                    for k in np.flatnonzero(paths.hidden_by == 0):
                        points = paths.points[paths.offsets[k] : paths.offsets[k + 1]]
                        points = np.concatenate([points, points[:1]]) if paths.closed[k] else points
                        total[paths.kind[k]] += np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
            lengths.append(total)
        assert np.allclose(*lengths, rtol=1e-5, atol=0.02)


@pytest.mark.slow
def test_a_sphere_shows_half_of_itself() -> None:
    scene = Scene((Item("ball", Sphere(1.0), curves=few(12, 9)),), lights=(Light((1.0, 1.0, 1.0), parallel=True),))
    camera = Camera((5.0, 3.0, 2.0), parallel=True)
    chords = chords_seen(scene, camera)
    contour = chords.kind == LineKind.CONTOUR
    assert (chords.hidden_by[contour] == 0).all()
    assert np.isclose(chords.length[contour].sum(), 2.0 * np.pi, rtol=1e-4)
    middle = 0.5 * (chords.start + chords.end)[~contour] @ camera.direction
    sure = np.abs(middle) > 1e-3
    assert np.array_equal(chords.hidden_by[~contour][sure] == 0, middle[sure] > 0.0)


@pytest.mark.slow
def test_a_picture_of_a_very_small_part_costs_no_more_than_others_and_says_that_it_is_coarse() -> None:
    camera = Camera((8.0, -16.0, 11.0), parallel=True, height=1e-9)
    with pytest.warns(InputWarning, match="so small a part"):
        draw(SINGLE["torus"], camera, fit=False, lines="contour,isophote")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(draw(SINGLE["torus"], camera, lines="contour,isophote").layers) > 1

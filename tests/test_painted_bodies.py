"""Balls, rods and other quadric bodies painted in bands of equal shade, against rays and the package's own shades."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely
from support.body_colours import assert_shown
from support.top_fills import fills_of, top_at

import vectorplot as vp
from vectorplot.accuracy.of_surfaces import covered
from vectorplot.drawing.drawing import Drawing
from vectorplot.drawing.fills import FillKind
from vectorplot.scene.placement import default_camera
from vectorplot.shading import shade_bands
from vectorplot.shading.shade_bands import ROUNDED_MM
from vectorplot.surfaces import Capped, Ellipsoid, Frustum, Sphere, rod

CENTRAL, PARALLEL = vp.Camera((10, -8, 6)), vp.Camera((10, -8, 6), parallel=True)
LAMPS = (vp.Light((5, -6, 7)), vp.Light((-1, -1, 1), parallel=True), vp.Light((3, -3, 2)))
COLOURS = ("gray", "blue", "red", "green", "yellow", "cyan")
ROUND = (Sphere(1.0, (3, 0, 0)), Ellipsoid((1, 2, 0.5)), rod((0, 0, 1), (1, 2, 3), 0.3))
FRUSTUM = Capped(Frustum(1.0, 0.4, 2.0, (0, 5, 0)))

BESIDE_MM = 0.06
"""Nearer than this to the outline of a body, or the border of a shadow, the one or the other may be painted."""


def scene_of(*shapes, word="normal", lights=()):
    items = (vp.Item(f"BODY{k}", shape, COLOURS[k % 6], vp.Material(word)) for k, shape in enumerate(shapes))
    return vp.Scene(tuple(items), lights)


def heap(seed, count=30):
    """Balls that pierce each other."""
    random = np.random.default_rng(seed)
    return scene_of(*(Sphere(random.uniform(0.3, 1.0), tuple(random.random(3) * 3.5)) for _ in range(count)))


def molecule(seed, count=24):
    """Balls on a bent grid, with rods between some of them."""
    random = np.random.default_rng(seed)
    places = np.array([(k % 3, k // 3 % 3, k // 9) for k in range(count)]) * 1.5 + random.normal(size=(count, 3)) * 0.15
    radii = 0.4 + 0.05 * (np.arange(count) % 3)
    rods = []
    for k in range(count - 1):
        way = places[k + 1] - places[k]
        if k % 3 < 2:
            way /= np.linalg.norm(way)
            rods.append(rod(places[k] + 0.5 * radii[k] * way, places[k + 1] - 0.5 * radii[k + 1] * way, 0.1))
    balls = (Sphere(r, tuple(p)) for r, p in zip(radii, places, strict=True))
    return scene_of(*balls, *rods)


def looked_at(scene, camera, count=4000, **options) -> tuple[Drawing, np.ndarray]:
    """A picture in bands, and places on it."""
    drawing = vp.paint(scene, camera, **options)
    fills = fills_of(drawing)
    assert (fills.kind == FillKind.BAND).all()
    low, high = fills.points.min(axis=0), fills.points.max(axis=0)
    places = low + np.random.default_rng(1).random((count, 2)) * (high - low)
    return drawing, places


def assert_right(scene, camera, *, steps, rarely, **options):
    """The right body everywhere but beside outlines, in the right shade: 99 of 100 places within so many of 255 steps,
    and all but what lies beside the borders of shadows within others."""
    drawing, places = looked_at(scene, camera, **options)
    every = np.ones(len(scene.items), dtype=bool)
    assert_shown(
        scene, camera, drawing, places, beside_mm=BESIDE_MM, shaded=every, share=0.99, steps=steps, rarely=rarely
    )
    return drawing


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("camera", [CENTRAL, PARALLEL], ids=["central", "parallel"])
@pytest.mark.parametrize("lights", [(), LAMPS[:1], LAMPS], ids=["none", "one", "three"])
@pytest.mark.parametrize("word", ["normal", "shiny", "mat", "metallic", "plastic", "wood"])
def test_bands_have_the_shades_of_the_surfaces(word, lights, camera):
    assert_right(scene_of(*ROUND, FRUSTUM, word=word, lights=lights), camera, steps=3.0, rarely=16.0)


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("parallel", [False, True], ids=["central", "parallel"])
@pytest.mark.parametrize("lights", [(), LAMPS[1:]], ids=["none", "two"])
@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("made", [heap, molecule])
def test_bodies_that_pierce_each_other_are_seen_as_rays_see_them(made, seed, lights, parallel):
    scene = replace(made(seed), lights=lights)
    camera = replace(default_camera(scene), parallel=parallel)
    assert_right(scene, camera, steps=5.0, rarely=20.0)


@pytest.mark.parametrize("eye", [(6, 3, 4), (-6, 3, 2), (0, 0, 9), (8, 0.5, 0.2)])
def test_rods_side_by_side_leave_balls_beside_their_middles(eye):
    balls = Sphere(0.425), Sphere(0.38, (1.2, 0, 0))
    rods = (rod((0.3, y, 0), (0.9, y, 0), 0.07) for y in (-0.1, 0.1))
    assert_right(scene_of(*balls, *rods), vp.Camera(eye), steps=5.0, rarely=20.0)


@pytest.mark.slow
@pytest.mark.parametrize("word", ["normal", "shiny", "mat"])
@pytest.mark.parametrize("width", [30, 100, 200])
def test_nothing_shines_through_between_bands(word, width):
    drawing = vp.paint(scene_of(Sphere(2.0), word=word, lights=LAMPS[:1]), CENTRAL, width=width)
    fills = fills_of(drawing)
    parts = shapely.get_parts(covered(fills.points, fills.offsets))
    body = parts[shapely.area(parts).argmax()]
    # Rounded corners may leave slits, but nothing apart from the body.
    assert body.buffer(ROUNDED_MM).covers(shapely.union_all(parts))
    assert shapely.area(shapely.Polygon(body.exterior)) - body.area < 1e-3


@pytest.mark.parametrize("factor", [1e-6, 1e6])
def test_size_does_not_count(factor):
    assert_same_fills(molecule(3), replace(molecule(3), items=tuple(i.scaled(factor) for i in molecule(3).items)))


def test_place_does_not_count():
    moved = (item.moved(1e6, 1e6, 1e6) for item in molecule(3).items)
    assert_same_fills(molecule(3), replace(molecule(3), items=tuple(moved)))


def assert_same_fills(one, other):
    """The same bodies and colours at nearly all places: where corners are rounded they may be left out, or not."""
    first, second = (fills_of(vp.paint(scene, default_camera(scene))) for scene in (one, other))
    low, high = first.points.min(axis=0), first.points.max(axis=0)
    assert (
        np.abs(second.points.min(axis=0) - low).max() < 1e-6 and np.abs(second.points.max(axis=0) - high).max() < 1e-6
    )
    places = low + np.random.default_rng(2).random((4000, 2)) * (high - low)
    tops = [top_at(fills, places) for fills in (first, second)]
    seen = [fills.colours[fills.offsets[np.maximum(top, 0)]] for fills, top in zip((first, second), tops, strict=True)]
    assert ((tops[0] < 0) == (tops[1] < 0)).all()
    assert (seen[0] != seen[1]).any(axis=1).mean() < 0.002


def test_rods_that_begin_in_the_middle_of_one_ball_are_beside_each_other():
    ways = np.concatenate([np.eye(3), -np.eye(3)])
    rods = (rod((0, 0, 0), tuple(2.0 * way), 0.2) for way in ways)
    scene = scene_of(Sphere(0.6), *rods, *(Sphere(0.4, tuple(2.0 * way)) for way in ways), lights=LAMPS[:1])
    assert_right(scene, CENTRAL, steps=3.0, rarely=12.0)


@pytest.mark.slow
def test_jobs_make_the_same_picture(monkeypatch):
    monkeypatch.setattr(shade_bands, "CHARTS_AT_ONCE", 8)
    one, several = (fills_of(vp.paint(replace(heap(5, 30), lights=LAMPS), jobs=jobs)) for jobs in (1, 3))
    assert (one.points == several.points).all() and (one.colours == several.colours).all()


@pytest.mark.parametrize(
    ("shapes", "eye", "lights"),
    [
        pytest.param((Sphere(1.0),), (1.02, 0, 0), (), id="eye beside a ball"),
        pytest.param((Sphere(1.0), Sphere(0.5, (2, 0, 0))), (10, -8, 6), (vp.Light((0.2, 0, 0)),), id="lamp in a ball"),
        pytest.param(
            (Sphere(1.0), Sphere(0.5, (2, 0, 0))), (10, -8, 6), (vp.Light((10, -8, 6)),), id="lamp at the eye"
        ),
        pytest.param((Sphere(1e-3), Sphere(1.0, (5, 0, 0))), (10, -8, 6), (), id="tiny"),
        pytest.param((Sphere(1.0), Sphere(1.0, (2, 0, 0))), (10, -8, 6), (), id="balls that touch"),
        pytest.param((Sphere(1.0), Sphere(0.5, (0.5, 0, 0))), (10, -8, 6), (), id="one in the other, touching"),
        pytest.param((rod((0, 0, 0), (10, -8, 6), 0.3),), (20, -16, 12), (), id="rod seen along its axis"),
        pytest.param((Capped(Frustum(1.0, 0.0, 2.0)),), (10, -8, 2), (), id="cone"),
    ],
)
def test_special_places_are_painted_in_bands(shapes, eye, lights):
    assert_right(scene_of(*shapes, lights=lights), vp.Camera(eye), steps=2.0, rarely=10.0)


def test_black_has_one_band_and_nothing_is_off():
    scene = vp.Scene((vp.Item("BALL", Sphere(1.0), "black"),))
    assert_right(scene, CENTRAL, steps=0.0, rarely=0.0)


@pytest.mark.parametrize(
    "scene",
    [
        pytest.param(scene_of(Sphere(1.0), word="transparent"), id="transparent"),
        pytest.param(scene_of(rod((0, 0, 0), (3, 0, 0), 0.3), rod((1, -1, 0), (1, 2, 0), 0.3)), id="rods that cross"),
        pytest.param(scene_of(rod((-3, 0, 0), (3, 0, 0), 0.3), Sphere(1.0)), id="rod through a ball"),
        pytest.param(scene_of(Sphere(1.0), lights=(vp.Light((3, 2, 1), colour="red"),)), id="coloured light"),
        pytest.param(scene_of(Sphere(1.0), lights=(vp.Light((3, 2, 1), fading=True),)), id="fading light"),
        pytest.param(scene_of(Sphere(6.0, (8, -6, 5))), id="eye in a ball"),
    ],
)
def test_what_bands_cannot_show_has_facets(scene):
    reports = []
    fills = fills_of(vp.paint(scene, CENTRAL, tolerance_mm=0.2, explain=reports.append))
    ran = {report.name for report in reports}
    assert len(fills) and "facets" in ran and "bands" not in ran


def test_flat_pictures_have_triangles():
    assert not (fills_of(vp.paint(scene_of(Sphere(1.0)), smooth=False, tolerance_mm=0.2)).kind == FillKind.BAND).any()


def test_a_picture_ends_at_its_margin():
    drawing = vp.paint(scene_of(Sphere(3.0, (3, 5, 0)), Sphere(1.0)), vp.Camera((10, -8, 6), fov_deg=10), fit=False)
    points = fills_of(drawing).points
    assert (
        points.min() >= 10.0 - 1e-9
        and (points.max(axis=0) <= (drawing.width_mm - 10.0 + 1e-9, drawing.height_mm - 10.0 + 1e-9)).all()
    )
    assert (fills_of(drawing).kind == FillKind.BAND).all()


@pytest.mark.parametrize("suffix", ["svg", "pdf", "ps", "png", "json"])
def test_all_formats_write_them(suffix, tmp_path):
    vp.save(vp.paint(heap(4, 6), width=60), tmp_path / f"heap.{suffix}")
    assert (tmp_path / f"heap.{suffix}").stat().st_size > 1000


def test_few_bytes_make_a_ball(tmp_path):
    vp.save(vp.paint(scene_of(Sphere(1.0)), width=40), tmp_path / "ball.svg")
    assert (tmp_path / "ball.svg").stat().st_size < 40_000

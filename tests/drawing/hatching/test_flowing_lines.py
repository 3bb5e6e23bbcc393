"""Hatching that flows: along its field, evenly apart, as dark as the light leaves it."""

from __future__ import annotations

import io
import itertools
from dataclasses import replace

import cairo
import numpy as np
import pytest

import vectorplot as vp
from vectorplot import features
from vectorplot.backends.cairo import png_bytes
from vectorplot.drawing.hatching import _farthest_first, place_ranks
from vectorplot.features.mesh_streamlines import evenly_spaced_mesh_curves
from vectorplot.features.surface_points import Sites
from vectorplot.geometry import box
from vectorplot.io.scene_language import parse_scene
from vectorplot.pictures.followed_lines import field_of
from vectorplot.scene import terrain_mesh
from vectorplot.surfaces import Domain, Sphere, graph, terrain

SUN = vp.Light((2.0, -3.0, 4.0), parallel=True, intensity=1.0)
CAMERA = vp.Camera((3.0, -6.0, 3.0), parallel=True, height=2.2)
PAGE = vp.Page(66.0, 66.0, 0.0)


def strokes(drawing):
    return [
        paths.points3d[paths.offsets[k] : paths.offsets[k + 1]]
        for layer in drawing.layers
        if layer.name.startswith("hatch")
        for paths in layer.strokes
        for k in range(len(paths))
    ]


def test_the_first_lines_of_parallel_ones_are_evenly_apart_and_so_are_all():
    lines = np.arange(64)
    x = np.repeat(lines, 30).astype(float)
    where = np.stack([x, np.tile(np.arange(30.0), 64)], axis=1)
    ranks = place_ranks(where, np.repeat(lines, 30), np.ones(64 * 30), 1.0, 64.0 * 30.0)[::30]
    for share in (0.125, 0.25, 0.5, 0.75, 1.0):
        drawn = lines[ranks < share]
        assert len(drawn) == pytest.approx(64 * share, abs=4 + 64 * share * 0.12)
        assert np.diff(drawn).max() <= 2.0 / share, "no gap is wider than two of them"


def test_where_lines_run_together_only_some_go_on():
    angles = np.linspace(-0.5, 0.5, 41)
    far = np.linspace(1.0, 41.0, 81)
    where = np.stack([np.outer(np.sin(angles), far), np.outer(np.cos(angles), far)], axis=2).reshape(-1, 2)
    ranks = place_ranks(where, np.repeat(np.arange(41), 81), np.full(41 * 81, 0.5), 1.0, 0.5 * 40.0**2)
    ranks = ranks.reshape(41, 81)
    counts = (ranks < 1.0).sum(axis=0)
    assert counts[-1] >= 38
    # On an arc of radius 11 there is room for 11 lines, and some that are a little nearer.
    assert 9 <= counts[20] <= 18
    assert (np.diff(counts) >= -3).all()


def test_the_next_line_is_always_the_one_that_is_farthest_from_all_before():
    random = np.random.default_rng(5)
    lines = random.uniform(0.0, 1.0, (70, 1, 2)) + np.linspace(0.0, 0.2, 10)[:, None] * random.normal(size=(70, 1, 2))
    order = _farthest_first(lines.reshape(-1, 2), 10 * np.arange(70), np.full(70, 10))
    away = np.full((70, 10), np.inf)
    for before, now in itertools.pairwise(order.tolist()):
        away = np.minimum(away, np.linalg.norm(lines[:, :, None] - lines[before], axis=-1).min(axis=2))
        away[before] = 0.0
        assert now == np.argmax(away.mean(axis=1))


def test_no_lines_have_no_ranks():
    assert not len(place_ranks(np.zeros((0, 6)), np.zeros(0, dtype=int), np.zeros(0), 1.0, 1.0))


@pytest.mark.slow
@pytest.mark.parametrize("along", ["slope", "level"])
def test_strokes_follow_their_field_and_are_long_enough(along):
    hill = vp.Item("HILL", graph(lambda x, y: 0.6 * x * x + 0.3 * y, Domain(-1, 1, -1, 1)))
    hatch = vp.Hatching("even", spacing_mm=2.0, along=along)
    drawing = vp.draw(vp.Scene((hill,)), "top", page="80x80", lines="none", hatch=hatch, curves="polyline")
    found = strokes(drawing)
    assert len(found) > 15
    for line in found:
        way = np.diff(line, axis=0)
        middle = 0.5 * (line[1:] + line[:-1])
        up = np.stack([1.2 * middle[:, 0], np.full(len(middle), 0.3)], axis=1)
        turned = up[:, ::-1] * (-1.0, 1.0) if along == "level" else up
        off = way[:, 0] * turned[:, 1] - way[:, 1] * turned[:, 0]
        assert np.abs(off).max() < 3e-3 * np.linalg.norm(turned, axis=1).max()
        assert np.linalg.norm(way, axis=1).sum() * 30.0 > 5.9


@pytest.mark.slow
@pytest.mark.parametrize("along", ["slope", "isophotes"])
def test_a_combed_ball_is_as_dark_as_the_light_leaves_it(along):
    ball = vp.Scene((vp.Item("ball", Sphere(1.0)),), (SUN,))
    hatch = vp.Hatching("tone", spacing_mm=1.0, width_mm=0.3, along=along)
    coarse = {"curves": "polyline", "tolerance_mm": 0.04}
    drawing = vp.draw(ball, CAMERA, page=PAGE, fit=False, lines="none", hatch=hatch, **coarse)
    surface = cairo.ImageSurface.create_from_png(io.BytesIO(png_bytes(drawing, 6.0 * 25.4)))
    size = surface.get_height()
    pixels = np.frombuffer(surface.get_data(), dtype=np.uint8).reshape(size, surface.get_width(), 4)
    ink = 1.0 - pixels[..., 0].ravel() / 255.0
    rows, columns = np.indices((size, size))
    x, y = ((np.stack([columns, size - rows]) * 66.0 / size).reshape(2, -1) - 33.0) / 30.0
    r = np.hypot(x, y)
    right, up, back = CAMERA.axes
    normal = x[:, None] * right + y[:, None] * up + np.sqrt(np.maximum(1.0 - r * r, 0.0))[:, None] * back
    cosine = normal @ np.array(SUN.position) / np.linalg.norm(SUN.position)
    wanted = 0.8 * (1.0 - np.where(cosine > 0.0, cosine, -0.3 * cosine)) * hatch.darkest
    inside = r < 0.97
    assert ink[inside].mean() == pytest.approx(wanted[inside].mean(), rel=0.1)
    for quarter in (x < 0, x > 0, y < 0, y > 0):
        assert ink[inside & quarter].mean() == pytest.approx(wanted[inside & quarter].mean(), rel=0.2, abs=0.01)


def cosines(line, light, parallel):
    """(p,) of the angles between the normals of the unit sphere at points (p,3) and a light."""
    way = np.array(light) - (0.0 if parallel else line)
    return (line * way / np.linalg.norm(way, axis=-1)[..., None]).sum(axis=1)


@pytest.mark.slow
def test_along_isophotes_strokes_have_one_angle_to_the_light_that_the_item_names():
    lights = (vp.Light((9.0, 9.0, 9.0)), vp.Light((2.0, -3.0, 1.5), intensity=1.0))
    hatch = vp.Hatching("even", spacing_mm=6.0, along="isophotes")
    ball = vp.Item("BALL", Sphere(1.0), curves=vp.SurfaceLines(light=1), hatch=hatch)
    coarse = {"curves": "polyline", "tolerance_mm": 0.1}
    drawing = vp.draw(vp.Scene((ball,), lights), CAMERA, page=PAGE, fit=False, lines="none", **coarse)
    found = strokes(drawing)
    assert len(found) > 4
    assert max(np.ptp(cosines(line, lights[1].position, False)) for line in found) < 5e-3
    missing = replace(ball, curves=vp.SurfaceLines(light=2))
    with pytest.raises(vp.InputError, match="BALL: isophotes of light 2: the scene has 2 lights"):
        vp.draw(vp.Scene((missing,), lights), CAMERA, page=PAGE)


def test_what_crosses_isophotes_leads_into_the_light():
    sites = Sites(Sphere(1.0), np.array([0.4, 3.0]), np.array([0.2, -1.0]))
    (along,), (across,) = (field_of("isophotes", family, SUN).tangents(sites) for family in (0, 1))
    sun = np.array(SUN.position)
    towards = sun - (sites.points @ sun)[:, None] * sites.points
    assert np.abs((along * sun).sum(axis=1)).max() < 1e-12
    assert np.abs(across - towards / np.linalg.norm(towards, axis=1)[:, None]).max() < 1e-12


@pytest.mark.slow
def test_without_a_light_isophotes_are_of_one_from_the_upper_left():
    ball = vp.Item("BALL", Sphere(1.0), hatch=vp.Hatching("even", spacing_mm=6.0, along="isophotes"))
    coarse = {"curves": "polyline", "tolerance_mm": 0.1}
    drawing = vp.draw(vp.Scene((ball,)), CAMERA, page=PAGE, fit=False, lines="none", **coarse)
    right, up, back = CAMERA.axes
    assert max(np.ptp(cosines(line, up - right + back, True)) for line in strokes(drawing)) < 5e-3
    cubes = [vp.Item("A", box((2, 2, 2)), hatch=vp.Hatching("even", along=along)) for along in ("isophotes", "page")]
    flowing, plain = (strokes(vp.draw(vp.Scene((cube,)), page="60x60", lines="none")) for cube in cubes)
    assert len(flowing) == len(plain) > 10
    flat = vp.Item("FLAT", graph(lambda x, y: 0.3 * x + 0.1 * y, Domain(-1, 1, -1, 1)))
    hatch = vp.Hatching("even", spacing_mm=2.0, along="isophotes")
    assert not strokes(vp.draw(vp.Scene((flat,)), "top", page="60x60", lines="none", hatch=hatch))


@pytest.mark.slow
def test_terrains_are_hatched_as_water_runs_and_what_has_no_lines_along_the_page():
    x, y = np.meshgrid(np.linspace(0, 6, 16), np.linspace(0, 4, 11), indexing="ij")
    land = terrain_mesh(terrain(np.sin(x) * np.cos(y), x=(0, 6), y=(0, 4)))
    hatch = vp.Hatching("even", spacing_mm=2.0, along="slope")
    drawing = vp.draw(vp.Scene((vp.Item("LAND", land),)), "top", page="80x80", lines="none", hatch=hatch)
    found = strokes(drawing)
    rises = [np.diff(line[:, 2]) for line in found]
    # Strokes that meet in a valley are one.
    assert sum((rise >= -1e-9).all() or (rise <= 1e-9).all() for rise in rises) > 0.8 * len(found) > 10
    cubes = [vp.Item("A", box((2, 2, 2)), hatch=vp.Hatching("even", along=along)) for along in ("isophotes", "page")]
    flowing, plain = (strokes(vp.draw(vp.Scene((cube,)), page="60x60", lines="none")) for cube in cubes)
    assert len(flowing) == len(plain) > 10


@pytest.mark.slow
def test_many_lines_that_run_together_are_compared_with_few():
    x, y = np.meshgrid(np.linspace(0, 6, 19), np.linspace(0, 4, 13), indexing="ij")
    land = terrain_mesh(terrain(0.5 * np.abs(y - 2.0) + 0.2 * x, x=(0, 6), y=(0, 4)))
    curves = evenly_spaced_mesh_curves(land, features.SteepestSlope(), 0.12)
    middle = np.array([curves[k][len(curves[k]) // 2] for k in range(len(curves))])
    assert len(curves) > 30
    assert (np.abs(middle[:, 1] - 2.0) < 1e-9).sum() <= 2, "water in a valley is one line"


def test_scene_files_say_it_too():
    lit = parse_scene("A gray surface torus 3 1 hatch tone along isophotes\n")
    assert lit.items[0].hatch == vp.Hatching("tone", along="isophotes")
    scene = parse_scene("A gray box 1 1 1 hatch tone along slope spacing 2\n")
    assert scene.items[0].hatch == vp.Hatching("tone", along="slope", spacing_mm=2.0)


@pytest.mark.slow
def test_walls_are_as_dark_whatever_the_size_of_their_faces():
    drawn = []
    for size in (0.125, 1.0, 8.0):
        body = vp.Scene((vp.Item("BODY", box((2.0 * size, 2.0 * size, size))),), lights=(SUN,))
        seen = vp.draw(body, camera="iso", page=PAGE, hatch=vp.Hatching("even", along="slope", spacing_mm=2.0))
        drawn.append(len(strokes(seen)))
    assert np.ptp(drawn) <= 1
    assert drawn[0] >= 20

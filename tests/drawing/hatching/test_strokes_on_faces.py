"""Strokes as lines on faces: as dark as asked, between each other, evenly apart, none a speck, in shadows by rays."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.rough import rough_sphere

import vectorplot as vp
from vectorplot.drawing.hatching import LEAST_MM, thresholds
from vectorplot.pictures.hatching import SHORTEST, HatchedScene, _shadowed
from vectorplot.scene.placement import fitted_picture
from vectorplot.scene.view import look
from vectorplot.shading.shadow_rays import blocked_exactly
from vectorplot.surfaces import Sphere
from vectorplot.testing.shapes import box, bumpy_icosphere
from vectorplot.visibility.painter.image_faces import drawn_faces
from vectorplot.visibility.projected_faces import project_faces

SUN = vp.Light((2.0, -3.0, 4.0), parallel=True, intensity=1.0)
CAMERA = vp.Camera((3.0, -6.0, 3.0), parallel=True, height=2.2)
PAGE = vp.Page(66.0, 66.0, 0.0)
FINE = vp.Hatching("tone", spacing_mm=0.3, width_mm=0.1)


def strokes_of(drawing: vp.Drawing) -> vp.Paths:
    (paths,) = [paths for layer in drawing.layers if layer.name.startswith("hatch") for paths in layer.strokes]
    return paths


def ends_of(paths: vp.Paths) -> np.ndarray:
    """(n,2,2) the first and the last point of every stroke: they are straight."""
    return np.stack([paths.points[paths.offsets[:-1]], paths.points[paths.offsets[1:] - 1]], axis=1)


def drawn(scene: vp.Scene, hatch: vp.Hatching, **options: object) -> np.ndarray:
    view = {"camera": CAMERA, "page": PAGE, "fit": False} | options
    return ends_of(strokes_of(vp.draw(scene, lines="none", hatch=hatch, **view)))


def lines_of(ends: np.ndarray, hatch: vp.Hatching) -> np.ndarray:
    """(n,) the numbers of the lines that strokes lie on."""
    angle = np.radians(hatch.angle_deg)
    place = ends.mean(axis=1) @ (-np.sin(angle), np.cos(angle)) / hatch.spacing_mm - 0.5
    assert np.abs(place - np.rint(place)).max() < 1e-6
    return np.rint(place).astype(int)


def darkness_of_ball(places: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How dark a unit ball in the sun is at places (n,2) of the page, and how far from its middle they are."""
    right, up, back = CAMERA.axes
    x, y = ((places - 33.0) / 30.0).T
    r = np.hypot(x, y)
    normal = x[:, None] * right + y[:, None] * up + np.sqrt(np.maximum(1.0 - r * r, 0.0))[:, None] * back
    cosine = normal @ np.array(SUN.position) / np.linalg.norm(SUN.position)
    return 0.8 * (1.0 - np.where(cosine > 0.0, cosine, -0.3 * cosine)), r


@pytest.mark.slow
@pytest.mark.parametrize("shape", [Sphere(1.0), bumpy_icosphere(5, 0.0)], ids=["surface", "mesh"])
def test_strokes_on_a_ball_end_at_isophotes(shape: object) -> None:
    ends = drawn(vp.Scene((vp.Item("ball", shape),), (SUN,)), FINE)
    dark, r = darkness_of_ball(ends.reshape(-1, 2))
    least = np.repeat(thresholds(FINE, 0, lines_of(ends, FINE)), 2)
    inner = r < 0.96
    off = np.abs(dark - least)[inner]
    assert inner.sum() > 100
    assert np.median(off) < 0.003 and off.max() < 0.02


@pytest.mark.slow
@pytest.mark.parametrize("cross", [False, True])
def test_in_windows_of_five_millimetres_the_ink_is_what_the_light_asks_for(cross: bool) -> None:
    hatch = replace(FINE, cross=cross)
    ends = drawn(vp.Scene((vp.Item("ball", Sphere(1.0)),), (SUN,)), hatch)
    steps = (np.arange(200) + 0.5) / 200
    places = ends[:, None, 0] + steps[:, None] * (ends[:, 1] - ends[:, 0])[:, None]
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    angle = np.arctan2(*(ends[:, 1] - ends[:, 0]).T[::-1]) % np.pi
    window = (np.floor(places / 5.0) @ (14, 1)).astype(int).ravel()
    cover = []
    for family in (0, 1):
        mine = np.abs(angle - np.radians(45.0 + 90.0 * family)) < 0.1
        ink = np.repeat(np.where(mine, length, 0.0) * hatch.width_mm / 200, 200)
        cover.append(np.bincount(window, ink, 14 * 14) / 25.0)
    found = 1.0 - (1.0 - cover[0]) * (1.0 - cover[1])
    grid = np.arange(0.05, 70.0, 0.1)
    spots = np.stack(np.meshgrid(grid, grid, indexing="ij"), axis=-1).reshape(-1, 2)
    dark, r = darkness_of_ball(spots)
    number = (np.floor(spots / 5.0) @ (14, 1)).astype(int)
    whole = np.bincount(number, r < 0.98, 14 * 14) == 2500
    asked = np.bincount(number, dark * hatch.darkest, 14 * 14) / 2500
    assert whole.sum() > 60
    assert np.abs(found - asked)[whole].max() < 0.05
    assert abs((found - asked)[whole].mean()) < 0.005


@pytest.mark.slow
def test_darker_places_have_strokes_between_those_that_lighter_ones_have() -> None:
    ball = vp.Item("ball", Sphere(1.0))
    bright, dim = (drawn(vp.Scene((ball,), (replace(SUN, intensity=strength),)), FINE) for strength in (1.0, 0.6))
    lines = [lines_of(ends, FINE) for ends in (bright, dim)]
    assert set(lines[0].tolist()) <= set(lines[1].tolist())
    way = np.array([np.cos(np.pi / 4), np.sin(np.pi / 4)])
    for line, ends in zip(lines[0].tolist(), bright @ way, strict=True):
        same = np.sort(dim[lines[1] == line] @ way, axis=1)
        low, high = np.sort(ends) + np.array([0.01, -0.01])
        assert ((same[:, 0] <= low) & (same[:, 1] >= high)).any(), "each stroke goes on in its place"


def test_on_a_plane_face_strokes_are_evenly_apart() -> None:
    wall = vp.Scene((vp.Item("wall", box((0, 0, 0), (2, 2, 2))),), (SUN,))
    hatch = vp.Hatching("tone", spacing_mm=0.5)
    ends = ends_of(strokes_of(vp.draw(wall, vp.Camera.view("front"), page=PAGE, lines="none", hatch=hatch)))
    across = np.sort(ends.mean(axis=1) @ (-np.sin(np.pi / 4), np.cos(np.pi / 4)))
    gaps = np.diff(across)
    assert len(gaps) > 30
    assert gaps.std() < 0.01 * gaps.mean()


@pytest.mark.slow
@pytest.mark.parametrize(
    "mesh", [bumpy_icosphere(4), rough_sphere(4), rough_sphere(5)], ids=["smooth", "rough", "finer"]
)
def test_no_stroke_is_a_speck_and_few_are_short(mesh: vp.Mesh) -> None:
    hatch = vp.Hatching("tone", spacing_mm=0.6)
    ends = ends_of(strokes_of(vp.draw(vp.Scene((vp.Item("M", mesh),), (SUN,)), lines="none", hatch=hatch)))
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    assert len(length) > 200
    assert length.min() > LEAST_MM - 1e-6
    assert (length < SHORTEST * hatch.spacing_mm).mean() < 0.15


@pytest.mark.slow
@pytest.mark.parametrize(
    "light",
    [
        vp.Light((1.0, -2.0, 3.0), parallel=True),
        vp.Light((6.0, -5.0, 7.0)),
        vp.Light((0.3, 0.2, 1.2)),
        vp.Light((0.0, 0.0, 0.55)),
    ],
    ids=["sun", "lamp", "lamp among them", "lamp near one"],
)
def test_shadows_along_strokes_are_those_of_rays(light: vp.Light) -> None:
    """Against single rays, by another method: a lamp among the bodies sees them in six images."""
    items = [vp.Item("floor", box((-3, -3, -0.2), (3, 3, 0)))]
    random = np.random.default_rng(3)
    for number, (x, y) in enumerate(random.uniform(-2.5, 2.5, (9, 2)).tolist()):
        side = 0.15 + 0.02 * number
        items.append(vp.Item(f"box {number}", box((x, y, 0.05), (x + side, y + side, 0.3 + 0.1 * number))))
    scene = vp.Scene(tuple(items), (light,))
    view = look(scene, vp.Camera((6.0, -8.0, 9.0)))
    faces = project_faces(view)
    place = fitted_picture(view, PAGE, view.image)
    seen = drawn_faces(view, faces)
    hatched = HatchedScene(view, faces, np.isin(np.arange(view.face_count), seen), seen, place, None)
    mine = np.zeros(len(items), dtype=bool)
    mine[0] = True
    (pieces,) = hatched.lines(vp.Hatching("even", spacing_mm=0.7), mine, 0)
    top = np.flatnonzero(np.abs(view.world_of(pieces.start)[:, 2]) < 1e-9)
    pieces = pieces.take(top)
    of, low, high = _shadowed(view, light, pieces)
    t = random.uniform(0.0, 1.0, (len(pieces), 40))
    dark = np.zeros(t.shape, dtype=bool)
    sure = np.ones(t.shape, dtype=bool)
    for piece, first, last in zip(of.tolist(), low.tolist(), high.tolist(), strict=True):
        dark[piece] |= (t[piece] > first) & (t[piece] < last)
        sure[piece] &= np.minimum(np.abs(t[piece] - first), np.abs(t[piece] - last)) > 1e-6
    points = pieces.start[:, :, None] + t[None] * (pieces.end - pieces.start)[:, :, None]
    world = view.world_of(points.reshape(3, -1))
    corners = view.corners.reshape(-1, 4)
    triangles = np.concatenate([corners[:, :3], corners[:, [0, 2, 3]]])
    none = np.full(len(world), -1)
    asked = blocked_exactly(light, world + np.array([0.0, 0.0, 1e-7]), none, view.world_of(view.points), triangles)
    assert 0.02 < asked.mean() < 0.98
    assert (asked.reshape(t.shape) == dark)[sure].all()


@pytest.mark.slow
@pytest.mark.parametrize(("scale", "shift"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_neither_size_nor_place_changes_a_stroke(scale: float, shift: float) -> None:
    sun = replace(SUN, intensity=None)
    mesh = rough_sphere(3)
    moved = vp.Mesh(scale * mesh.vertices + shift, mesh.corners, mesh.offsets)
    hatch = vp.Hatching("tone", spacing_mm=0.8, cross=True)
    camera = vp.Camera((4.0, -6.0, 3.0))
    there = vp.Camera(tuple(scale * np.array(camera.eye) + shift), (shift, shift, shift))
    one, two = (
        drawn(vp.Scene((vp.Item("M", body),), (sun,)), hatch, camera=eye, fit=True)
        for body, eye in ((mesh, camera), (moved, there))
    )
    assert len(one) == len(two) > 150
    order = [np.lexsort(np.round(ends.reshape(-1, 4), 2).T) for ends in (one, two)]
    assert np.abs(np.sort(one[order[0]].reshape(-1)) - np.sort(two[order[1]].reshape(-1))).max() < 1e-3


def test_what_lies_in_the_plane_of_something_larger_is_hatched_in_its_place() -> None:
    def plate(low: tuple[float, float], high: tuple[float, float]) -> vp.Mesh:
        corners = [(low[0], low[1], 0.0), (high[0], low[1], 0.0), (high[0], high[1], 0.0), (low[0], high[1], 0.0)]
        return vp.Mesh.from_polygons(corners, [(0, 1, 2, 3)])

    bare = vp.Hatching("none")
    floor, hole = vp.Item("floor", plate((0, 0), (8, 6))), vp.Item("hole", plate((2, 2), (5, 4)), hatch=bare)
    for items in ((floor, hole), (hole, floor)):
        hatch = vp.Hatching("even", spacing_mm=1.0, angle_deg=0.0)
        paths = strokes_of(vp.draw(vp.Scene(items), "top", page=PAGE, lines="none", hatch=hatch))
        space = np.stack([paths.points3d[paths.offsets[:-1]], paths.points3d[paths.offsets[1:] - 1]], axis=1)
        beside = np.abs(space[:, 0, 0] - space[:, 1, 0])
        within = (space[:, 0, 1] > 2.0) & (space[:, 0, 1] < 4.0)
        assert within.sum() > 20
        assert np.unique(np.round(beside[within], 6)).tolist() == [2.0, 3.0]
        assert np.abs(beside[~within] - 8.0).max() < 1e-9


def test_what_has_no_faces_that_one_sees_has_no_strokes() -> None:
    corners = np.array([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 1.0)])
    for scene in (
        vp.Scene(()),
        vp.Scene((vp.Item("E", vp.Mesh(np.zeros((0, 3)), np.zeros(0, dtype=int), np.zeros(1, dtype=int))),)),
        vp.Scene((vp.Item("edge-on", vp.Mesh.from_triangles(corners, [(0, 1, 2)])),)),
        vp.Scene((vp.Item("line", vp.Mesh.from_triangles(corners * (1, 1, 0), [(0, 1, 2)])),)),
    ):
        for hatch in (vp.Hatching("even"), vp.Hatching("tone", cross=True, along="surface")):
            drawing = vp.draw(scene, "top", page=PAGE, lines="contour", hatch=hatch)
            assert not any(layer.name.startswith("hatch") for layer in drawing.layers if len(layer.strokes[0]))


@pytest.mark.slow
def test_the_strokes_are_the_same_on_any_number_of_threads() -> None:
    scene = vp.Scene((vp.Item("M", rough_sphere(5)),), (SUN,))
    one, two = (strokes_of(vp.draw(scene, lines="none", hatch=vp.Hatching("tone"), jobs=jobs)) for jobs in (1, 2))
    assert np.array_equal(one.points, two.points) and np.array_equal(one.points3d, two.points3d)

"""The verb draw: from a scene to strokes on a page."""

from __future__ import annotations

import sys
from dataclasses import replace
from functools import partial
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from support.drawn import drawn
from support.hard_shapes import HARD_SHAPES
from support.paths import DATA, MODELS

import vectorplot as vp
from vectorplot.drawing.drawing import Drawing, Paths
from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.io.read_file import read
from vectorplot.pictures.draw import draw
from vectorplot.pictures.pipeline import StageReport
from vectorplot.scene.item import Item, Pattern
from vectorplot.scene.page import Page
from vectorplot.scene.placement import default_camera
from vectorplot.scene.scene import Scene
from vectorplot.testing import assert_drawing_is_right, assert_drawings_equal, edge_points
from vectorplot.testing.shapes import box, rotated_boxes
from vectorplot.words import LineKind

CUBE = Scene((Item("cube", box((-1, -1, -1), (1, 1, 1)), colour="blue"),))
CAMERAS = [
    Camera((6.0, -8.0, 5.0)),
    Camera((6.0, -8.0, 5.0), (0.5, 0.2, -0.1), twist_deg=15.0, fov_deg=50.0),
    Camera((6.0, -8.0, 5.0), parallel=True, height=7.0),
]


def paths_of(drawing: Drawing) -> list[Paths]:
    return [paths for layer in drawing.layers for paths in layer.strokes]


def points_of(drawing: Drawing) -> tuple[np.ndarray, np.ndarray]:
    paths = paths_of(drawing)
    return np.concatenate([p.points for p in paths]), np.concatenate([p.points3d for p in paths])


def kinds_of(drawing: Drawing) -> set[str]:
    return {LineKind(int(kind)).word for paths in paths_of(drawing) for kind in paths.kind}


@pytest.mark.parametrize("camera", CAMERAS)
@pytest.mark.parametrize("fit", [True, False])
def test_points_are_the_images_of_their_points_in_the_world(camera: Camera, fit: bool) -> None:
    drawing = draw(rotated_boxes(8), camera, fit=fit)
    points, world = points_of(drawing)
    projected = np.column_stack([world, np.ones(len(world))]) @ drawing.page_from_world.T
    assert np.allclose(projected[:, :2] / projected[:, 3:], points, atol=1e-8)


@pytest.mark.capability("G2.1-parallel")
@pytest.mark.parametrize("camera", CAMERAS)
def test_without_fit_the_page_is_the_camera_s_picture(camera: Camera) -> None:
    page = Page(200.0, 150.0, 0.0)
    drawing = draw(CUBE, camera, page=page, fit=False)
    corners = np.array([corner for item in CUBE.items for corner in item.shape.vertices]) - camera.target
    x, y, z = (corners @ camera.axes.T).T
    factor = 1.0 if camera.parallel else camera.distance / (camera.distance - z)
    scale = page.height_mm / camera.picture_height
    expected = np.column_stack([100.0 + scale * factor * x, 75.0 + scale * factor * y])
    points, world = points_of(drawing)
    for point, place in zip(points, world, strict=True):
        nearest = np.argmin(np.linalg.norm(corners + camera.target - place, axis=1))
        if np.allclose(corners[nearest] + camera.target, place, atol=1e-9):
            assert np.allclose(expected[nearest], point, atol=1e-9)
    assert np.allclose(
        (drawing.page_from_world @ [*camera.target, 1.0])[:2],
        np.array([100.0, 75.0]) * (drawing.page_from_world @ [*camera.target, 1.0])[3],
    )


def test_with_fit_the_drawing_fills_the_page_but_for_its_margin() -> None:
    drawing = draw(CUBE, CAMERAS[0], page=Page(200.0, 100.0, 7.0))
    points, _ = points_of(drawing)
    low, high = points.min(axis=0), points.max(axis=0)
    assert np.isclose(low[1], 7.0) and np.isclose(high[1], 93.0)
    assert np.allclose((low + high) / 2.0, (100.0, 50.0))


def test_a_scene_that_reaches_behind_the_eye_shows_the_field_of_vision() -> None:
    room = Scene((Item("room", box((-5, -5, -2), (5, 5, 2))), Item("box", box((-0.5, 2, -2), (0.5, 3, -1)))))
    drawing = draw(room, Camera((0.0, -4.0, 0.0), (0.0, 3.0, -0.5), fov_deg=60.0))
    points, _ = points_of(drawing)
    assert points.min() >= 10.0 - 1e-6
    assert points[:, 0].max() <= 200.0 + 1e-6 and points[:, 1].max() <= 287.0 + 1e-6
    assert {int(i) for paths in paths_of(drawing) for i in paths.item} == {0, 1}


@pytest.mark.capability("G4.X-plotter")
@pytest.mark.parametrize("name", ["rotated boxes", "hollow tube", "interpenetrating boxes", "L-shaped prisms"])
@pytest.mark.parametrize("hidden", ["none", "solid"])
def test_every_stroke_is_as_visible_as_it_says(name: str, hidden: str) -> None:
    scene = HARD_SHAPES[name]
    camera = default_camera(scene)
    drawing = draw(scene, camera, hidden=hidden)
    points, _ = edge_points(scene, 200)
    assert assert_drawing_is_right(drawing, scene, camera, samples=300) > 0
    assert len(points)


@pytest.mark.capability("G7.2-no-double")
def test_an_edge_of_two_boxes_is_drawn_once() -> None:
    apart = Scene((Item("a", box((0, 0, 0), (1, 1, 1))), Item("b", box((1, 0, 0), (2, 1, 1)))))
    camera = Camera.view("front", (1.0, 0.5, 0.5), 5.0)
    drawing = draw(apart, camera, page=Page(220.0, 120.0, 10.0))
    length = sum(
        np.hypot(*np.diff(np.vstack([p.points[a:b], p.points[a : a + 1]]) if c else p.points[a:b], axis=0).T).sum()
        for p in paths_of(drawing)
        for a, b, c in zip(p.offsets[:-1], p.offsets[1:], p.closed, strict=True)
    )
    assert np.isclose(length, 100.0 * (2 + 2 + 3))


def test_lines_are_of_the_kinds_asked_for() -> None:
    assert kinds_of(draw(CUBE, lines=("contour",))) == {"contour"}
    assert kinds_of(draw(CUBE, lines=("edges",))) == {"edges"}
    assert kinds_of(draw(CUBE)) == {"contour", "crease"}
    assert kinds_of(draw(CUBE, crease_angle_deg=91.0)) == {"contour"}
    with pytest.raises(InputError, match="expected one of contour"):
        draw(CUBE, lines=("contours",))


def test_an_item_s_own_lines_come_first() -> None:
    own = Scene((Item("a", CUBE.items[0].shape, lines=("edges",)), *rotated_boxes(2).items))
    drawing = draw(own)
    assert {LineKind(int(k)).word for p in paths_of(drawing) for k in p.kind[p.item == 0]} == {"edges"}
    assert "contour" in kinds_of(drawing)


def test_patterns_lie_on_their_faces_and_are_hidden_with_them() -> None:
    face = int(np.argmax(CUBE.items[0].shape.face_normals[:, 2]))
    square = Pattern("square", "red", face, np.array([(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]))
    scene = Scene((Item("cube", CUBE.items[0].shape, patterns=(square,)),))
    above = draw(scene, Camera((4.0, -6.0, 5.0)))
    pattern = [
        p.points3d[a:b]
        for p in paths_of(above)
        for a, b, k in zip(p.offsets[:-1], p.offsets[1:], p.kind, strict=True)
        if k == 5
    ]
    assert len(pattern) == 1 and np.allclose(pattern[0][:, 2], 1.0) and len(pattern[0]) == 4
    assert "pattern" not in kinds_of(draw(scene, Camera((4.0, -6.0, -5.0))))


@pytest.mark.capability("G7.2-lines-on-faces")
@pytest.mark.parametrize("parallel", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_patterns_of_bodies_among_others_are_seen_where_rays_see_them(seed: int, parallel: bool) -> None:
    random = np.random.default_rng(seed)
    items, whole = [], 0.0
    for item in rotated_boxes(8, seed).items:
        shapes = []
        for face in range(6):
            outline = random.uniform(0.02, 0.08) * np.array([(-1.0, -1.0), (1.5, -0.5), (0.7, 1.0)])
            shapes.append(Pattern(f"P{face}", "red", face, outline))
            whole += np.linalg.norm(outline - np.roll(outline, 1, axis=0), axis=1).sum()
        items.append(replace(item, patterns=tuple(shapes)))
    scene = Scene(tuple(items))
    camera = Camera(tuple(random.normal(size=3) * 4.0), parallel=parallel)
    drawing = draw(scene, camera, hidden="solid", lines=("pattern",))
    assert kinds_of(drawing) == {"pattern"}
    lines = drawn(drawing)
    # Of a body one sees half of the sides at most; what is drawn of them is visible or hidden, nothing is missing.
    assert lines.length == pytest.approx(whole, rel=1e-6)
    assert 0.1 * whole < lines.visible.length < 0.6 * whole
    assert assert_drawing_is_right(drawing, scene, camera, samples=400) > 200


def test_hidden_lines_come_dashed_or_solid_on_a_layer_of_their_own() -> None:
    solid, dashed = (draw(CUBE, CAMERAS[0], hidden=how) for how in ("solid", "dashed"))
    for drawing in (solid, dashed):
        layer = drawing.layers[3]
        assert (layer.name, layer.plotted) == ("hidden", True)
        assert (layer.marks[0].hidden_by == 1).all()
    assert len(solid.layers[3].marks[0].points) == 4 or len(solid.layers[3].marks[0]) <= 3
    assert len(dashed.layers[3].marks[0]) > 20


def test_layers_by_kind_object_and_colour() -> None:
    scene = Scene((*CUBE.items, Item("red", box((2, 0, 0), (3, 1, 1)), colour="darkorange")))
    assert [layer.name for layer in draw(scene).layers] == ["visible", "contour"]
    assert [layer.name for layer in draw(scene, layers="object").layers] == ["cube", "red"]
    assert [layer.name for layer in draw(scene, layers="colour").layers] == ["blue", "darkorange"]
    with pytest.raises(InputError, match="expected one of kind, object, colour"):
        draw(scene, layers="item")


@pytest.mark.hard(55)
def test_an_empty_scene_is_an_empty_page() -> None:
    drawing = draw(Scene(()))
    assert (drawing.width_mm, drawing.height_mm, drawing.layers) == (210.0, 297.0, ())


@pytest.mark.hard(57)
def test_the_same_scene_gives_the_same_drawing() -> None:
    scene = read(DATA / "town.scene")
    one, two = draw(scene), draw(read(DATA / "town.scene"))
    for first, second in zip(paths_of(one), paths_of(two), strict=True):
        for name in ("points", "offsets", "closed", "kind", "item", "hidden_by", "points3d"):
            assert np.array_equal(getattr(first, name), getattr(second, name))


def test_refining_a_flat_face_changes_nothing() -> None:
    mesh = CUBE.items[0].shape
    fan = [[f[0], f[k], f[k + 1]] for f in mesh.polygons() for k in (1, 2)]
    triangles = Scene((Item("cube", Mesh.from_polygons(mesh.vertices, fan)),))
    for camera in CAMERAS:
        assert_drawings_equal(draw(CUBE, camera), draw(triangles, camera))


def test_the_plan_runs_what_the_scene_calls_for_and_nothing_else() -> None:
    def stages(scene: Scene, **options: object) -> list[str]:
        reports: list[StageReport] = []
        draw(scene, explain=reports.append, **options)
        return [report.name for report in reports if report.error is None]

    plain = ["look", "faces", "edges", "intersections", "frame", "visible lines", "strokes", "layers", "pen"]
    assert stages(CUBE) == plain
    assert stages(CUBE, hidden="dashed", halo_mm=1.0, lines=("edges",)) == [
        *("look", "faces", "edges", "frame", "counted lines", "halo", "strokes", "layers", "pen")
    ]
    assert "patterns" in stages(read(DATA / "patterns.scene"))


@pytest.mark.slow
def test_a_drawing_without_halo_does_not_load_the_effect() -> None:
    code = "import sys, vectorplot as vp; vp.draw(vp.Scene(())); print('vectorplot.effects.halos' in sys.modules)"
    import subprocess

    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout.strip() == "False"


def test_progress_names_the_stage_and_grows() -> None:
    seen: list[float] = []
    draw(rotated_boxes(20), progress=lambda stage, part: seen.append(part))
    assert seen == sorted(seen) and seen[0] >= 0.0 and seen[-1] == 1.0


@pytest.mark.parametrize(
    ("options", "cause"),
    [
        ({"hidden": "dotted"}, "hidden 'dotted'"),
        ({"layers": "item"}, "layers 'item'"),
        ({"halo_mm": -1.0}, "halo"),
        ({"halo_mm": float("nan")}, "halo"),
        ({"crease_angle_deg": float("nan")}, "crease angle"),
        ({"crease_angle_deg": 200.0}, "crease angle"),
    ],
)
def test_options_out_of_range_are_named(options: dict, cause: str) -> None:
    with pytest.raises(InputError, match=cause):
        draw(CUBE, **options)


@pytest.mark.parametrize("size", [1e-200, 1e-120, 1e120, 1e200])
def test_sizes_whose_products_leave_the_range_of_numbers_are_an_error(size: float) -> None:
    tiny = Scene((Item("A", box((-size, -size, -size), (size, size, size))),))
    for camera in (None, Camera((5 * size, -7 * size, 4 * size)), Camera((5.0, -7.0, 4.0))):
        with pytest.raises(InputError, match="out of range"):
            draw(tiny, camera)


def model_files() -> list[Path]:
    folder = MODELS
    return sorted(folder.glob("*.obj"))


NO_MODELS = pytest.param(None, marks=pytest.mark.skip(reason="no models"))


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::vectorplot.errors.InputWarning")
@pytest.mark.parametrize("path", model_files() or [NO_MODELS], ids=str)
@pytest.mark.parametrize("name", ["front", "back", "left", "right", "top", "slanting"])
def test_models_from_six_views_as_rays_see_them(path: Path, name: str) -> None:
    scene = read(path)
    low, high = scene.bounds
    middle, size = (low + high) / 2.0, float(np.linalg.norm(high - low))
    if name == "slanting":
        eye = middle + size * np.array([1.0, 0.7, 1.3])
        camera = Camera(tuple(eye), tuple(middle), up=(0.0, 1.0, 0.0))
    else:
        camera = Camera.view(name, tuple(middle), 2.0 * size)
    for hidden in ("none", "solid"):
        drawing = draw(scene, camera, hidden=hidden)
        assert assert_drawing_is_right(drawing, scene, camera, samples=250) > 100


def test_one_text_names_kinds_of_lines_as_on_the_command_line() -> None:
    words = draw(CUBE, lines=("contour", "crease"))
    assert_drawings_equal(draw(CUBE, lines="contour, crease"), words)
    assert not draw(CUBE, lines="none").layers


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("name", ["town", "torus", "shadows"])
@pytest.mark.parametrize("hidden", ["none", "dashed"])
def test_no_stroke_is_longer_than_asked_for_and_the_picture_is_the_same(name, hidden):
    scene = read(DATA / f"{name}.scene")
    whole, parts = (draw(scene, hidden=hidden, longest_mm=longest) for longest in (None, 15.0))
    lengths = []
    for layer in parts.layers:
        for paths in layer.strokes:
            steps = np.linalg.norm(np.diff(paths.points, axis=0), axis=1)
            lengths += [steps[a : b - 1].sum() for a, b in pairwise(paths.offsets)]
    assert 10.0 < max(lengths) <= 15.0 * (1.0 + 1e-9)
    assert_drawings_equal(whole, parts, tolerance_mm=0.05)


@pytest.mark.parametrize("longest", [0.0, -1.0, 0.5, float("nan")])
def test_longest_strokes_of_no_length_are_refused(longest):
    with pytest.raises(InputError, match="longest"):
        draw(read(DATA / "pencil.scene"), longest_mm=longest)


@pytest.mark.capability("G2.2-pyramid")
@pytest.mark.parametrize("seed", range(4))
def test_of_edges_around_the_eye_what_is_in_the_pyramid_of_sight_is_projected_and_nothing_else(seed):
    """Before the neutral plane and within the four sides: each edge clipped in space by hand."""
    random = np.random.default_rng(seed)
    eye, half = np.array([0.5, -0.3, 0.2]), np.radians(20.0)
    camera = vp.Camera(tuple(eye), tuple(eye + random.normal(size=3)), fov_deg=40.0)
    lows, sizes = random.uniform(-6, 5, (24, 3)), random.uniform(0.2, 4.0, (24, 3))
    items = tuple(vp.Item(f"B{k}", box(low, low + size)) for k, (low, size) in enumerate(zip(lows, sizes, strict=True)))
    drawing = vp.draw(vp.Scene(items), camera, page=vp.Page(100, 100, 0), fit=False, style="wireframe")
    right, up, back = camera.axes
    ends = []
    for item in items:
        for face in item.mesh.polygons():
            corners = item.mesh.vertices[face]
            ends += [(a, b) for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True) if tuple(a) < tuple(b)]
    a, b = (np.array(side) - eye for side in zip(*ends, strict=True))
    # Planes n.p >= c of the pyramid: before the eye, and its four sides.
    slope = np.tan(half)
    planes = [(-back, 0.0)] + [(-slope * back + way, 0.0) for way in (right, -right, up, -up)]
    low, high = np.zeros(len(a)), np.ones(len(a))
    for normal, height in planes:
        first, last = a @ normal - height, b @ normal - height
        with np.errstate(divide="ignore", invalid="ignore"):
            at = first / (first - last)
        low = np.where((first < 0) & (last >= 0), np.maximum(low, at), low)
        high = np.where((first >= 0) & (last < 0), np.minimum(high, at), high)
        high = np.where((first < 0) & (last < 0), -1.0, high)
    kept = high - low > 1e-9
    p, q = (a[kept] + t[kept, None] * (b - a)[kept] for t in (low, high))
    one, two = (50 + 50 * np.stack([s @ right, s @ up], axis=1) / (slope * -(s @ back))[:, None] for s in (p, q))
    paths = [paths for layer in drawing.layers for paths in layer.strokes]
    found = [points for some in paths for points in np.split(some.points, some.offsets[1:-1])]
    pieces = np.concatenate([np.stack([points[:-1], points[1:]], axis=1) for points in found])
    assert 3 < len(one) and np.abs(pieces - 50).max() < 50 + 1e-6
    drawn = np.linalg.norm(pieces[:, 1] - pieces[:, 0], axis=1).sum()
    assert drawn == pytest.approx(np.linalg.norm(two - one, axis=1).sum(), rel=1e-5)
    for end in pieces.reshape(-1, 2):
        along = np.clip(
            ((end - one) * (two - one)).sum(axis=1) / np.maximum(((two - one) ** 2).sum(axis=1), 1e-12), 0, 1
        )
        assert np.linalg.norm(one + along[:, None] * (two - one) - end, axis=1).min() < 1e-3


@pytest.mark.capability("G2.2-pyramid")
@pytest.mark.parametrize("verb", ["draw", "paint", "render"])
def test_what_is_behind_the_eye_changes_no_picture(verb):
    """Bodies wholly behind the neutral plane, whose images would be upside down amid the picture."""
    random = np.random.default_rng(3)
    camera = vp.Camera((0, -6, 1), (0, 0, 0.5), fov_deg=35.0)
    before = [vp.Item(f"A{k}", box((k - 2, 0, 0), (k - 1.3, 1, 1)), "orange") for k in range(4)]
    lows = np.stack([random.uniform(-3, 3, 9), random.uniform(-30, -8, 9), random.uniform(-3, 3, 9)], axis=1)
    behind = [vp.Item(f"B{k}", box(low, low + 1.5), "blue") for k, low in enumerate(lows)]
    light = (vp.Light((2, -3, 5), parallel=True, intensity=0.8),)
    told = {"size": (60, 40), "samples": 1} if verb == "render" else {"page": vp.Page(90, 60, 0)}
    make = partial({"draw": vp.draw, "paint": vp.paint, "render": vp.render}[verb], camera=camera, fit=False, **told)
    if verb != "draw":
        make = partial(make, shadows="none")
    alone, all_ = (make(vp.Scene(tuple(items), light)) for items in (before, before + behind))
    if verb == "render":
        # What is farther away than the box of all is darker: depths of what is seen count alone.
        covered = [(one.pixels != 255).any(axis=2) for one in (alone, all_)]
        assert covered[0].sum() > 100 and (covered[0] == covered[1]).all()
        return
    for ours, theirs in zip(alone.layers, all_.layers, strict=True):
        for one, other in zip((*ours.strokes, *ours.fills), (*theirs.strokes, *theirs.fills), strict=True):
            assert np.allclose(np.sort(one.points, axis=0), np.sort(other.points, axis=0), atol=1e-6)

"""Isophotes and plane sections that polyhedra carry, in drawings."""

from __future__ import annotations

import numpy as np
import pytest
from support.smooth_scenes import lit, views

from vectorplot.drawing.drawing import CurvedStrokes, Drawing
from vectorplot.errors import InputError
from vectorplot.features.polygonization import polygonized
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.winding import mesh_edges
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.pictures.draw import draw
from vectorplot.pictures.plan import plan_draw
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import Section, SurfaceLines
from vectorplot.surfaces.quadrics import Sphere, implicit_sphere
from vectorplot.surfaces.tori import ImplicitTorus
from vectorplot.testing import assert_drawing_is_right, curves_in_space
from vectorplot.testing.shapes import box
from vectorplot.words import FEATURE_KINDS, LineKind

CUBE = box((-1.0, -1.0, -1.0), (1.0, 1.0, 1.0))
LEVELS = SurfaceLines(sections=(Section((0.0, 0.0, 1.0), (-0.5, 0.25)),))


def lengths(drawing: Drawing, kind: str, hidden: bool) -> float:
    """Of strokes in space."""
    total = 0.0
    for layer in drawing.layers:
        for paths in layer.strokes:
            for k in np.flatnonzero((paths.kind == LineKind.from_word(kind)) & ((paths.hidden_by > 0) == hidden)):
                points = paths.points3d[paths.offsets[k] : paths.offsets[k + 1]]
                points = np.concatenate([points, points[:1]]) if paths.closed[k] else points
                total += np.linalg.norm(np.diff(points, axis=0), axis=1).sum()
    return total


@pytest.mark.capability("G9.3-sections", "G7.2-lines-on-faces")
def test_sections_of_a_cube_are_squares_half_of_which_are_seen() -> None:
    drawing = draw(Scene((Item("cube", CUBE, curves=LEVELS),)), Camera((8.0, 7.0, 3.0)), hidden="solid")
    for line in curves_in_space(drawing, kind="section"):
        assert np.isin(np.round(line[:, 2], 12), (-0.5, 0.25)).all()
        assert np.allclose(np.abs(line[:, :2]).max(axis=1), 1.0)
    assert np.isclose(lengths(drawing, "section", False), 8.0)
    assert np.isclose(lengths(drawing, "section", True), 8.0)


@pytest.mark.capability("G9.3-isophote")
def test_isophotes_across_the_faces_of_a_sphere_are_circles() -> None:
    mesh = polygonized(implicit_sphere(1.0), 40)
    lamp = Light((0.0, 0.0, 1.0), parallel=True)
    scene = Scene((Item("ball", mesh, curves=SurfaceLines(isophotes=(0.5,))),), lights=(lamp,))
    drawing = draw(scene, Camera((0.0, -9.0, 0.0), parallel=True), lines=("isophote",), hidden="solid")
    points = np.concatenate(curves_in_space(drawing, kind="isophote"))
    assert np.abs(points[:, 2] - 0.5).max() < 0.02
    seen, unseen = (lengths(drawing, "isophote", hidden) for hidden in (False, True))
    assert np.isclose(seen + unseen, 2.0 * np.pi * np.sqrt(0.75), rtol=0.05)
    assert np.isclose(seen, unseen, rtol=0.02)


@pytest.mark.slow
@pytest.mark.parametrize("lamp", [Light((1.0, 2.0, 3.0), parallel=True), Light((2.0, 3.0, 5.0))])
def test_lines_on_meshes_as_rays_see_them(lamp: Light) -> None:
    lines = SurfaceLines(isophotes=(-0.3, 0.4), sections=(Section((0.3, 0.1, 1.0), (-0.2, 0.3)),))
    scene = Scene(
        (
            Item("ring", polygonized(ImplicitTorus(2.0, 0.7), 24), curves=lines),
            Item("cube", CUBE, curves=LEVELS),
            Item("ball", Sphere(0.8, (1.0, -1.5, 0.9)), curves=SurfaceLines(4, 3)),
        ),
        lights=(lamp,),
    )
    for seed, camera in enumerate(views(scene, 2, 3)):
        drawing = draw(scene, camera, hidden="solid")
        assert_drawing_is_right(drawing, scene, camera, samples=250, seed=seed, clearance=3e-6)
        assert all(lengths(drawing, kind, hidden) > 0.5 for kind in ("isophote", "section") for hidden in (False, True))


def test_the_stage_runs_only_where_it_is_called_for() -> None:
    usual = tuple(kind for kind in LineKind if kind not in FEATURE_KINDS)

    def stages(*items: Item, kinds: tuple[LineKind, ...] = usual) -> set[str]:
        return {stage.name for stage in plan_draw(Scene(items), frozenset(kinds), "none", 0.0)}

    assert "lines on meshes" in stages(Item("cube", CUBE, curves=LEVELS))
    assert "lines on meshes" not in stages(Item("cube", CUBE))
    assert "lines on meshes" not in stages(Item("cube", CUBE, curves=SurfaceLines(3, 3)))
    assert "lines on meshes" not in stages(Item("ball", Sphere(1.0), curves=LEVELS))
    assert "lines on meshes" not in stages(Item("cube", CUBE, curves=LEVELS), kinds=(LineKind.CONTOUR,))
    assert "lines on meshes" in stages(Item("cube", CUBE), kinds=(LineKind.RIDGE,))


def test_a_light_that_is_not_there_is_an_error() -> None:
    with pytest.raises(InputError, match="cube: isophotes of light 1: the scene has 1 lights"):
        draw(lit(Item("cube", CUBE, curves=SurfaceLines(isophotes=(0.5,), light=1))))


BALL = "revolution meridian {meridian} order {order}"
WORDS = "sections normal 1 2 2 at 0.3 level_lines at -0.4, 0.55"


def ball(order: int, words: str) -> Scene:
    """A ball of faces from a scene file, with lines on it."""
    angle = np.linspace(-np.pi / 2, np.pi / 2, order // 2 + 1)
    points = [(0.0 if k in (0, order // 2) else float(np.cos(a)), float(np.sin(a))) for k, a in enumerate(angle)]
    meridian = ", ".join(f"{r!r} 0 {z!r}" for r, z in points)
    text = f"light L direction 1 -2 3\nB {BALL.format(meridian=meridian, order=order)} {words}"
    scene = parse_scene(text)
    assert parse_scene(write_scene(scene)).items[0].curves == scene.items[0].curves
    return scene


def drawn_points(drawing: Drawing, kind: LineKind) -> tuple[np.ndarray, int]:
    """Points in space of the strokes of a kind, and how many Bézier segments and arcs they leave as."""
    points, curved = [np.zeros((0, 3))], 0
    for layer in drawing.layers:
        for mark in layer.marks:
            paths = mark.paths if isinstance(mark, CurvedStrokes) else mark
            own = paths.kind == int(kind)
            points.append(paths.points3d[np.repeat(own, np.diff(paths.offsets))])
            curved += int(np.diff(mark.beziers.offsets)[own].sum()) if isinstance(mark, CurvedStrokes) else 0
    return np.concatenate(points), curved


@pytest.mark.capability("G9.3-sections", "G3.0-language")
@pytest.mark.parametrize("order", [12, 24, 48])
@pytest.mark.parametrize("camera", [Camera((4, -6, 5)), Camera((-5, -3, 4), parallel=True)])
def test_sections_of_polyhedra_in_files_have_their_points_on_edges_and_leave_smooth_on_demand(order, camera) -> None:
    straight = draw(ball(order, WORDS), camera, hidden="solid")
    smooth = draw(ball(order, WORDS + " smooth_lines"), camera, hidden="solid")
    points, none = drawn_points(straight, LineKind.SECTION)
    same, curved = drawn_points(smooth, LineKind.SECTION)
    assert none == 0 < curved
    for found in (points, same):
        planes = np.abs(found @ [1 / 3, 2 / 3, 2 / 3] - 0.3), np.abs(found[:, 2] + 0.4), np.abs(found[:, 2] - 0.55)
        assert np.min(planes, axis=0).max() < 1e-9
    mesh = ball(order, "").items[0].mesh
    ends = mesh.vertices[mesh_edges(mesh)]
    way = ends[:, 1] - ends[:, 0]
    share = np.clip(((same[:, None] - ends[:, 0]) * way).sum(axis=2) / (way * way).sum(axis=1), 0, 1)
    away = np.linalg.norm(ends[:, 0] + share[..., None] * way - same[:, None], axis=2).min(axis=1)
    assert np.quantile(away, 0.8) < 1e-9, "but for points where something begins to hide them"


@pytest.mark.capability("G9.3-sections", "G9.3-isophote")
@pytest.mark.parametrize("height", [-0.4, 0.0, 0.55])
def test_smooth_lines_come_nearer_to_the_circles_of_the_true_ball(height: float) -> None:
    camera = Camera((0, 0, 9), up=(0, 1, 0), parallel=True, height=3.0)
    drawing = draw(ball(24, f"level_lines at {height} smooth_lines"), camera, hidden="solid", lines=("section",))
    (mark,) = [mark for layer in drawing.layers for mark in layer.marks if len(mark)]
    assert isinstance(mark, CurvedStrokes)
    middle = mark.paths.points.mean(axis=0)
    corners = np.linalg.norm(mark.paths.points - middle, axis=1)
    t = np.linspace(0, 1, 9)[:, None]
    bends = [
        (1 - t) ** 3 * a + 3 * (1 - t) ** 2 * t * b + 3 * (1 - t) * t**2 * c + t**3 * d
        for a, b, c, d in mark.beziers.control
    ]
    radius = np.linalg.norm(np.concatenate(bends) - middle, axis=1)
    sagitta = corners.mean() * (1 - np.cos(np.pi / 24))
    assert np.abs(radius - corners.mean()).max() < 0.3 * sagitta


@pytest.mark.capability("G9.3-isophote", "G3.0-language")
@pytest.mark.parametrize("order", [12, 24])
@pytest.mark.parametrize("lamp", ["direction 1 -2 3", "position 2 -4 5"])
def test_isophote_edges_of_files_part_lighter_faces_from_darker_ones(order: int, lamp: str) -> None:
    scene = ball(order, "isophotes at -0.2, 0.5 lit_by L isophote_edges")
    light = parse_scene(f"light L {lamp}").lights[0]
    scene = Scene(scene.items, (light,))
    mesh = scene.items[0].mesh
    found, _ = drawn_points(draw(scene, Camera((4, -6, 5)), hidden="solid", lines=("isophote",)), LineKind.ISOPHOTE)
    nearest = np.linalg.norm(found[:, None] - mesh.vertices, axis=2).min(axis=1)
    assert np.quantile(nearest, 0.7) < 1e-9, "the way goes from vertex to vertex"
    middles = np.array([mesh.vertices[polygon].mean(axis=0) for polygon in mesh.polygons()])
    way = np.broadcast_to(light.position, middles.shape) if light.parallel else np.array(light.position) - middles
    cosine = (mesh.face_normals * way).sum(axis=1) / np.linalg.norm(way, axis=1)
    parting = set()
    edges = {}
    for face, polygon in enumerate(mesh.polygons()):
        for one, other in zip(polygon, [*polygon[1:], polygon[0]], strict=True):
            edges.setdefault(frozenset((one, other)), []).append(face)
    for edge, faces in edges.items():
        for level in (-0.2, 0.5):
            if len(faces) == 2 and (cosine[faces[0]] >= level) != (cosine[faces[1]] >= level):
                parting |= edge
    corner = np.linalg.norm(found[:, None] - mesh.vertices, axis=2).argmin(axis=1)[nearest < 1e-9]
    assert set(corner.tolist()) <= parting

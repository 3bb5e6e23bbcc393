"""What the near and the far plane of a camera leave, in every verb, from files, the command and Python."""

from dataclasses import replace

import numpy as np
import pytest
from support.hard_shapes import HARD_SHAPES

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.curves import Circle
from vectorplot.effects.cuts import between_planes, depths
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.surfaces import Sphere, Torus, implicit_sphere
from vectorplot.testing.shapes import box, without
from vectorplot.textbook.polyhedra import body_record

VERBS = ["draw", "paint", "render"]


def row(count: int = 6) -> vp.Scene:
    """Cubes behind each other along y, every one from 4k to 4k + 2."""
    return vp.Scene(tuple(vp.Item(f"B{k}", box((-1, 4 * k, -1), (1, 4 * k + 2, 1)), "blue") for k in range(count)))


def camera(**planes) -> vp.Camera:
    return vp.Camera(eye=(0.3, -10.0, 0.7), target=(0.3, 0.0, 0.7), fov_deg=40, **planes)


@pytest.mark.capability("G3.L-scene", "G3.0-language")
@pytest.mark.parametrize(("near", "far"), [(12.5, 27.5), (None, 19.0), (17.0, None), (1.0, 90.0), (33.0, 34.0)])
@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
def test_what_is_left_lies_between_the_planes_and_all_of_it_is_left(near, far, size):
    given = {name: size * depth for name, depth in (("near", near), ("far", far)) if depth}
    scaled = vp.Scene(
        tuple(vp.Item(i.name, vp.Mesh(i.mesh.vertices * size, i.mesh.corners, i.mesh.offsets)) for i in row().items)
    )
    eye = vp.Camera(eye=(0, -10 * size, 0), target=(0, 0, 0), **given)
    left = between_planes(scaled, eye)
    low, high = (near or 0.0) - 10.0, (far or 1e9) - 10.0
    for k, item in enumerate(left.items):
        start, end = max(low, 4.0 * k), min(high, 4.0 * k + 2.0)
        inside = end - start
        assert bool(item.mesh.face_count) == (inside > 0)
        if inside > 0:
            # Four sides, and the ends that are not cut off.
            ends = (start == 4.0 * k) + (end == 4.0 * k + 2.0)
            assert body_record(item.mesh).area / size**2 == pytest.approx(4 * 2 * inside + 4 * ends)
            away = depths(item.mesh.vertices, eye) / size
            assert away.min() >= (near or 0) - 1e-9 and away.max() <= (far or 1e9) + 1e-9
            assert len(item.mesh.vertices) == 8


@pytest.mark.slow
@pytest.mark.capability("G3.L-scene")
@pytest.mark.parametrize("name", sorted(HARD_SHAPES))
def test_both_sides_of_a_plane_together_have_the_area_of_the_whole(name):
    scene = HARD_SHAPES[name]
    low, high = scene.bounds
    size = float(np.ptp(scene.bounds, axis=0).max())
    middle = tuple(((low + high) / 2 + 0.037 * size).tolist())
    eye = tuple((np.array(middle) + 3 * size * np.array([0.48, -0.6, 0.64])).tolist())
    parts = [
        between_planes(scene, vp.Camera(eye=eye, target=middle, **plane))
        for plane in ({"near": 3 * size}, {"far": 3 * size})
    ]
    for number, item in enumerate(scene.items):
        areas = [body_record(part.items[number].mesh).area for part in parts]
        assert sum(areas) == pytest.approx(body_record(item.mesh).area, rel=1e-9)


@pytest.mark.capability("G3.L-scene")
def test_a_cut_body_stays_closed_but_for_the_cut():
    """Faces that shared an edge share its new vertex: the only open edges lie in the plane."""
    from vectorplot.geometry.mesh_repair import mesh_report

    body = row(1)
    (item,) = between_planes(
        body, vp.Camera(eye=(9, -7, 5), target=(0, 1, 0), near=vp.Camera((9, -7, 5), (0, 1, 0)).distance)
    ).items
    report = mesh_report(item.mesh)
    assert report.components == 1 and report.boundary_edges == 6 and report.oriented


def items_of(made) -> set[int]:
    marks = [mark for layer in made.layers for mark in (*layer.strokes, *layer.fills)]
    return {int(k) for mark in marks for k in mark.item} - {-1}


@pytest.mark.capability("G3.L-scene", "G3.0-language")
@pytest.mark.parametrize("verb", [vp.draw, vp.paint])
@pytest.mark.parametrize("parallel", [False, True])
def test_what_is_nearer_hides_nothing_and_what_is_farther_is_not_drawn(verb, parallel):
    scene = row()
    for near, far, seen in (
        (13.0, None, {1, 2, 3, 4, 5}),
        (16.5, 21, {2}),
        (None, 9.0, set()),
        (12.5, 13.5, set()),
        (12.5, 14.5, {1}),
    ):
        eye = vp.Camera(eye=(0, -10, 0), target=(0, 0, 0), parallel=parallel, near=near, far=far)
        found = items_of(verb(scene, eye))
        # What stands right behind the first that is left may be hidden by it.
        assert found <= seen and bool(found) == bool(seen) and min(found, default=0) == min(seen, default=0)


@pytest.mark.capability("G3.L-scene", "G3.0-language")
@pytest.mark.parametrize("verb", VERBS)
def test_files_and_options_say_it_alike(verb, tmp_path):
    eyes = [replace(camera(**planes), eye=(5.0, -10.0, 4.0)) for planes in ({}, {"near": 13.0, "far": 22.5})]
    texts = [write_scene(vp.Scene(row(4).items, camera=eye)) for eye in eyes]
    assert "near 13.0 far 22.5" in texts[1] and parse_scene(texts[1]).camera == eyes[1]
    made = []
    for number, (text, options) in enumerate(
        ((texts[1], []), (texts[0], ["--near", "13", "--far", "22.5"]), (texts[0], []))
    ):
        file, out = tmp_path / "a.scene", tmp_path / f"{number}.png"
        file.write_text(text, encoding="utf-8")
        size = ["--size", "80x60"] if verb == "render" else ["--page", "60x40"]
        assert run([verb, str(file), "-o", str(out), "-q", *options, *size]) == 0
        made.append(out.read_bytes())
    assert made[0] == made[1] != made[2]
    assert vp.Scene(()).camera is None and camera().near is None and camera().far is None


@pytest.mark.capability("G3.L-scene")
@pytest.mark.parametrize(
    ("words", "cause"),
    [
        ("near 0", "near 0 must be positive"),
        ("far -3", "far -3 must be"),
        ("near 5 far 5", "near 5 must be less than far 5"),
    ],
)
def test_planes_that_leave_nothing_are_told_with_file_and_line(words, cause, tmp_path, capsys):
    file = tmp_path / "a.scene"
    file.write_text(f"A box 1 1 1\ncamera eye 9 9 9 {words}", encoding="utf-8")
    assert run(["draw", str(file), "-o", str(tmp_path / "x.svg")]) == 1
    told = capsys.readouterr().err
    assert f"{file}:2: " in told and cause in told and told.count("\n") == 1


@pytest.mark.slow
@pytest.mark.parametrize("shape", [Torus(3, 1), Sphere(3.5), implicit_sphere(3.5), Circle(radius=3.5)])
def test_smooth_surfaces_and_curves_are_cut_as_bodies_are(shape):
    """What is drawn lies between the planes, comes up to both, and the parts of both sides are the whole."""
    eye = {"eye": (4.0, -9.0, 3.0), "target": (0.0, 0.0, 0.0)}
    scene, middle = vp.Scene((vp.Item("A", shape),)), vp.Camera(**eye).distance
    drawing = vp.draw(scene, vp.Camera(**eye, near=middle - 1.0, far=middle + 1.5), hidden="solid")
    points = np.concatenate([paths.points3d for layer in drawing.layers for paths in layer.strokes])
    found = depths(points, vp.Camera(**eye)) - middle
    # Rims are found to a part of the domain.
    assert -1.0 - 1e-6 < found.min() < -0.99 and 1.49 < found.max() < 1.5 + 1e-6
    assert not items_of(vp.draw(scene, vp.Camera(**eye, near=middle + 5.0)))
    assert not items_of(vp.draw(scene, vp.Camera(**eye, far=middle - 5.0)))


def test_patterns_stay_on_faces_that_are_whole():
    square = np.array([(-0.3, -0.3), (0.3, -0.3), (0.3, 0.3), (-0.3, 0.3)])
    patterns = tuple(vp.Pattern(f"P{k}", "red", k, square) for k in range(6))
    item = vp.Item("A", box((-1, 0, -1), (1, 2, 1)), patterns=patterns)
    (left,) = between_planes(vp.Scene((item,)), camera(near=11.0)).items
    (kept,) = left.patterns
    normal = item.mesh.face_normals[int(kept.name[1:])]
    assert np.allclose(left.mesh.face_normals[kept.face], normal) and abs(normal[1]) == 1.0


@pytest.mark.slow
@pytest.mark.hard(13)
@pytest.mark.parametrize("verb", [vp.draw, vp.paint, vp.render])
def test_cut_bodies_are_open_and_their_insides_are_seen(verb):
    hollow = vp.Scene(
        (
            vp.Item("A", without(box((-1, 0, -1), (1, 2, 1)), 0)),
            vp.Item("IN", box((-0.2, 0.8, -0.2), (0.2, 1.2, 0.2)), "red"),
        )
    )
    made = verb(hollow, camera(near=10.5), **({"size": (200, 150)} if verb is vp.render else {}))
    if verb is vp.render:
        reds = made.pixels.astype(int)
        assert (reds[..., 0] - reds[..., 1:].max(axis=2) > 60).sum() > 100
    else:
        assert items_of(made) == {0, 1}

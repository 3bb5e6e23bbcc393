"""Scenes of limit surfaces: exact contours in one piece, hidden as rays say, the same in every verb and file."""

import numpy as np
import pytest
from scipy.spatial import cKDTree

import vectorplot as vp
from vectorplot import geometry, surfaces
from vectorplot.cli.main import run
from vectorplot.features.feature_lines import Sight
from vectorplot.features.mesh_feature_lines import enclosed, true_contours
from vectorplot.io import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene import FaceLook, FaceLooks, Fields, subdivided_item

EYE = (7.0, 3.0, 4.0)


def ring(sides=8, around=4):
    """A cage of quads like a torus."""
    u, v = np.meshgrid(2 * np.pi * np.arange(sides) / sides, 2 * np.pi * np.arange(around) / around, indexing="ij")
    points = np.stack([(3 + np.cos(v)) * np.cos(u), (3 + np.cos(v)) * np.sin(u), 1.3 * np.sin(v)], axis=-1)
    number = np.arange(sides * around).reshape(sides, around)
    on, up = np.roll(number, -1, axis=0), np.roll(number, -1, axis=1)
    quads = np.stack([number, on, np.roll(on, -1, axis=1), up], axis=-1).reshape(-1, 4)
    return vp.Mesh.from_polygons(points.reshape(-1, 3), quads)


def lengths(shape, **how):
    """How long the lines of a picture are together, and how many."""
    drawing = vp.draw(shape, vp.Camera(EYE), page=vp.Page(100, 100), **how)
    found, count = 0.0, 0
    for part in (part for layer in drawing.layers for part in layer.strokes):
        for a, b, closed in zip(part.offsets[:-1], part.offsets[1:], part.closed, strict=True):
            ends = np.concatenate([part.points[a:b], part.points[a : a + int(closed)]])
            found, count = found + np.linalg.norm(np.diff(ends, axis=0), axis=1).sum(), count + 1
    return found, count


@pytest.mark.parametrize("sight", ["central", "parallel"])
@pytest.mark.parametrize("cage", [ring(), geometry.box((1, 2, 1))], ids=["ring", "box"])
def test_points_of_contours_are_exact(cage, sight):
    item = subdivided_item(vp.Item("it", cage))
    eye = np.array(EYE)
    looking = Sight(eye if sight == "central" else None, eye / np.linalg.norm(eye))
    known = item.normals
    found = true_contours(known.mesh, known.at_vertices, looking, enclosed(item.mesh), known.places)
    fine = known.places.surface.mesh(48 if cage.face_count < 10 else 24)
    away, near = cKDTree(fine.places).query(found.start)
    normals = np.zeros_like(fine.places)
    normals[fine.vertex] = fine.normals
    way = eye - found.start if sight == "central" else np.broadcast_to(looking.direction, found.start.shape)
    way = way / np.linalg.norm(way, axis=1, keepdims=True)
    # Beside points of a mesh that fine normals turn by as much as these are away.
    facing = (normals[near] * way).sum(axis=1)
    assert np.abs(facing).max() < 4.0 * away.max()
    ends = cKDTree(found.end).query(found.start)[0]
    assert ends.max() == 0.0, "every segment ends where another one begins"


def test_the_residual_of_contours_is_rounding():
    item = subdivided_item(vp.Item("it", ring(6, 4)))
    eye, known = np.array(EYE), item.normals
    found = true_contours(known.mesh, known.at_vertices, Sight(eye, eye), enclosed(item.mesh), known.places)
    fine = known.places.surface.mesh(16)
    # Newton's steps from the nearest vertex to the place of each point.
    first = np.full(len(fine.vertex), -1)
    first[fine.triangles.ravel()] = np.arange(fine.triangles.size)
    _, near = cKDTree(fine.places[fine.vertex]).query(found.start)
    patch = fine.patch[first[near] // 3]
    u, v = fine.parameters.reshape(-1, 2)[first[near]].T
    for _ in range(12):
        jets = known.places.surface.jets(patch, u, v)
        e, f = jets[:, 1], jets[:, 2]
        off = found.start - jets[:, 0]
        g = np.array([[(e * e).sum(1), (e * f).sum(1)], [(e * f).sum(1), (f * f).sum(1)]])
        det = g[0, 0] * g[1, 1] - g[0, 1] ** 2
        a, b = (off * e).sum(1), (off * f).sum(1)
        u = np.clip(u + (g[1, 1] * a - g[0, 1] * b) / det, 0.0, 1.0)
        v = np.clip(v + (g[0, 0] * b - g[0, 1] * a) / det, 0.0, 1.0)
    jets = known.places.surface.jets(patch, u, v)
    on = np.linalg.norm(found.start - jets[:, 0], axis=1) < 1e-10
    assert on.mean() > 0.9, "the others lie on another patch than the nearest vertex"
    normals = np.cross(jets[on, 1], jets[on, 2])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    way = eye - jets[on, 0]
    assert np.abs((normals * way).sum(axis=1) / np.linalg.norm(way, axis=1)).max() < 1e-9


def test_what_is_seen_is_what_rays_see():
    item = subdivided_item(vp.Item("ring", ring(), lines=("contour",)))
    camera = vp.Camera(EYE)
    drawing = vp.draw(vp.Scene((item,)), camera, hidden="solid", page=vp.Page(200, 200), tolerance_mm=0.005)
    fine = item.normals.places.surface.mesh(8)
    truth = vp.Mesh.from_triangles(fine.places, fine.vertex[fine.triangles])
    corners = truth.vertices[truth.corners.reshape(-1, 3)]
    eye = np.array(EYE)
    known = item.normals
    found = true_contours(known.mesh, known.at_vertices, Sight(eye, eye), enclosed(item.mesh), known.places)
    middle = 0.5 * (found.start + found.end)[::5]
    seen = np.array([not hit(corners, point, eye) for point in middle])
    assert seen.any() and not seen.all()
    from vectorplot.scene.view import look

    view = look(vp.Scene((item,)), camera)
    image = view.image_of(view.points_of(middle)).T
    shown = [(part.points[a:b], int(h)) for one in drawing.layers for part in one.strokes
             for a, b, h in zip(part.offsets[:-1], part.offsets[1:], part.hidden_by, strict=True)]  # fmt: skip
    low = image.min(axis=0), np.concatenate([p for p, _ in shown]).min(axis=0)
    size = np.ptp(np.concatenate([p for p, _ in shown]), axis=0) / np.ptp(image, axis=0)
    on_page = (image - low[0]) * size + low[1]
    points = np.concatenate([np.linspace(p[:-1], p[1:], 9).reshape(-1, 2) for p, _ in shown])
    hidden = np.concatenate([np.full(9 * (len(p) - 1), h) for p, h in shown])
    distance, near = cKDTree(points).query(on_page)
    one_kind = cKDTree(points[hidden > 0]).query(on_page)[0], cKDTree(points[hidden == 0]).query(on_page)[0]
    clear = (distance < 0.3) & (np.maximum(*one_kind) > 2.0)
    assert clear.mean() > 0.6
    assert (hidden[near[clear]] == 0).tolist() == seen[clear].tolist()


def hit(corners, point, eye):
    """Whether a triangle lies between a point on a surface and the eye, not at the point itself."""
    way = eye - point
    a, e, f = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    p = np.cross(way, f)
    det = (e * p).sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        s = point - a
        u = (s * p).sum(axis=1) / det
        q = np.cross(s, e)
        v, t = (way * q).sum(axis=1) / det, (f * q).sum(axis=1) / det
        return bool(((u >= 0) & (v >= 0) & (u + v <= 1) & (t > 0.05) & (t < 1)).any())


def test_a_ball_like_surface_has_one_closed_contour_and_no_other_line():
    scene = vp.subdivided(vp.Scene((vp.Item("ball", geometry.box((1, 1, 1))),)))
    drawing = vp.draw(scene, vp.Camera(EYE))
    strokes = [part for one in drawing.layers for part in one.strokes]
    assert sum(len(part.closed) for part in strokes) == 1 and all(part.closed.all() for part in strokes)


def test_creases_and_edges_of_the_cage_are_lines_of_their_own():
    cup = geometry.box((1, 1, 1), caps=frozenset({"bottom"}))
    smooth, sharp = (vp.subdivided(vp.Scene((vp.Item("cup", cup),)), crease_angle_deg=angle) for angle in (None, 60))
    assert lengths(smooth, lines="boundary")[1] == 1
    assert lengths(sharp, lines="crease")[1] >= 3
    assert lengths(smooth, lines="tangent")[1] > 4
    assert lengths(smooth)[0] == pytest.approx(lengths(smooth, lines="contour,boundary")[0], rel=0.02)


def test_mirrored_and_moved_limit_surfaces_are_those_of_mirrored_and_moved_cages():
    cage, matrix = ring(), np.diag([-2.0, 1.0, 1.5, 1.0])
    matrix[:3, 3] = (1, 2, 3)
    one = subdivided_item(vp.Item("it", cage)).transformed(matrix)
    two = subdivided_item(vp.Item("it", cage.transformed(matrix)))
    # Their triangles differ, and so where lines end behind them, by what these are off the surface.
    assert lengths(vp.Scene((one,)))[0] == pytest.approx(lengths(vp.Scene((two,)))[0], rel=5e-3)
    places = one.normals.places
    weights = np.full((len(places.patch), 3), 1.0 / 3.0)
    points, normals = places.above(np.arange(len(places.patch)), weights)
    corners = one.normals.mesh.vertices[one.normals.mesh.corners.reshape(-1, 3)]
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert ((flat * normals).sum(axis=1) > 0.0).all()
    assert np.abs(points - corners.mean(axis=1)).max() < 0.05


def test_looks_and_fields_go_along():
    box = geometry.box((1, 1, 1))
    item = vp.Item("box", box, face_looks=FaceLooks.of(box, {0: FaceLook("red")}),
                   fields=Fields(box, {"x": box.vertices[:, 0]}, {"face": np.arange(6.0)}))  # fmt: skip
    found = subdivided_item(item)
    assert 0.1 < (found.face_looks.of_face == 0).mean() < 0.25
    assert np.abs(found.fields.at_vertices["x"] - found.mesh.vertices[:, 0]).max() < 1e-12
    assert set(found.fields.on_faces["face"]) == set(range(6))
    assert vp.paint(vp.Scene((found,)), vp.Camera(EYE), page=vp.Page(50, 50)).layers


def test_scene_files_hold_the_cage():
    text = (
        "camera eye 7 3 4 target 0 0 0\n"
        "A box 1 1 1 subdivision catmull-clark crease_angle 80 translation 1 0 0\n"
        "B vertices 0 0 0 , 1 0 0 , 0 1 0 , 0 0 1 faces 1 3 2 , 1 2 4 , 2 3 4 , 3 1 4\n"
        "  subdivision loop creases 1 2 , 2 3 , 3 1 lines contour, crease"
    )
    scene = parse_scene(text)
    again = parse_scene(write_scene(scene))
    assert "subdivision loop creases 1 2" in write_scene(scene)
    for one, two in zip(scene.items, again.items, strict=True):
        assert np.array_equal(one.mesh.vertices, two.mesh.vertices)
        assert np.array_equal(one.drawn_edges, two.drawn_edges)
    assert len(scene.items[0].drawn_edges) and scene.items[1].lines == ("contour", "crease")


@pytest.mark.parametrize(
    ("words", "cause"),
    [
        ("B box 1 1 1 subdivision catmul", "expected catmull-clark or loop, got 'catmul'"),
        ("B box 1 1 1 subdivision loop", "B: subdivision: face 1 has 4 corners"),
        ("B box 1 1 1 subdivision catmull-clark creases 1 2 3", "two vertices each"),
        ("B box 1 1 1 subdivision catmull-clark subdivision loop", "a second 'subdivision'"),
        ("B surface sphere 1 subdivision loop", "B: subdivision is for polyhedra only"),
        (
            "B box 1 1 1 subdivision catmull-clark patterns face 1 polygon a red 0 0 , 0.1 0 , 0 0.1",
            "patterns on faces",
        ),
    ],
)
def test_wrong_words_are_one_error(words, cause):
    with pytest.raises(vp.InputError, match=cause):
        parse_scene(words)


def test_what_is_smooth_already_stays_and_what_is_no_scene_is_refused():
    scene = vp.Scene((vp.Item("ball", surfaces.Sphere(1.0)), vp.Item("box", geometry.box((1, 1, 1)))))
    once = vp.subdivided(scene)
    assert once.items[0] is scene.items[0] and once.items[1].mesh.face_count > 1000
    assert vp.subdivided(once).items[1] is once.items[1]
    with pytest.raises(TypeError, match="subdivided takes a Scene"):
        vp.subdivided(geometry.box((1, 1, 1)))


@pytest.mark.parametrize("verb", ["draw", "paint", "render"])
def test_verbs_of_the_command_know_the_option(verb, tmp_path):
    (tmp_path / "cage.off").write_text(
        "OFF\n8 6 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n"
        "4 0 3 2 1\n4 0 1 5 4\n4 1 2 6 5\n4 2 3 7 6\n4 3 0 4 7\n4 4 5 6 7\n"
    )
    out = tmp_path / ("out.png" if verb == "render" else "out.svg")
    size = ["--size", "80x60"] if verb == "render" else []
    how = ["--subdivision", "catmull-clark,120", "--quiet", *size]
    assert run([verb, str(tmp_path / "cage.off"), "-o", str(out), *how]) == 0 and out.stat().st_size > 200

"""Verbs take whatever has a shape, and say in one sentence what they do not take."""

from __future__ import annotations

import warnings
from dataclasses import dataclass, field
from types import SimpleNamespace

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.curves import Circle
from vectorplot.geometry import box
from vectorplot.io.anything import scene_of
from vectorplot.surfaces import Domain, Torus, implicit_sphere

CUBE = box((1, 1, 1))
TRIANGLES = np.array([(0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2)])
CORNERS = np.array([(0.0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)])


@dataclass(frozen=True)
class Surface:
    """What programs of one's own have: a domain, and points."""

    domain: Domain = field(default_factory=lambda: Domain(0.0, 1.0, 0.0, 1.0))

    def points(self, u, v):
        return np.stack([u, v, u * v], axis=-1)


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "die.scene"
    path.write_text("DIE red box 1 1 1")
    return path


def tetrahedra():
    """Two that share a face: six triangles are seen."""
    return np.array([(0, 1, 2, 3), (1, 2, 3, 4)])


@pytest.mark.parametrize(
    ("shown", "name"),
    [
        (vp.Item("cube", CUBE), "cube"),
        (CUBE, "mesh"),
        (Torus(3, 1), "torus"),
        (implicit_sphere(1.0), "quadric"),
        (Circle(), "circle"),
        (Surface(), "surface"),
        ((CORNERS, TRIANGLES), "mesh"),
        ((CORNERS, TRIANGLES.tolist()), "mesh"),
        (SimpleNamespace(vertices=CORNERS, faces=TRIANGLES), "mesh"),
        (SimpleNamespace(points=CORNERS, cells=[SimpleNamespace(type="triangle", data=TRIANGLES)]), "mesh"),
        (SimpleNamespace(points=CORNERS, cells={"triangle": TRIANGLES, "line": [(0, 1)]}), "mesh"),
    ],
    ids=lambda value: value if isinstance(value, str) else type(value).__name__,
)
def test_everything_with_a_shape_is_a_scene(shown, name):
    (item,) = scene_of(shown).items
    assert item.name == name


def test_paths_are_read(file):
    assert [scene_of(path).items[0].name for path in (file, str(file))] == ["DIE", "DIE"]


def test_lists_are_put_together_and_names_told_apart(file):
    lamp = vp.Scene((vp.Item("mesh", CUBE),), (vp.Light((1, 1, 1)),), vp.Camera((3, 2, 1)), title="Cube")
    scene = scene_of([CUBE, lamp, file, (Torus(), (CORNERS, TRIANGLES))])
    assert [item.name for item in scene.items] == ["mesh", "mesh 2", "DIE", "torus", "mesh 3"]
    assert (len(scene.lights), scene.camera, scene.title) == (1, lamp.camera, "Cube")
    assert [item.name for item in scene_of({"ring": Torus(), "two": [CUBE, CUBE]}).items] == [
        "ring",
        "two mesh",
        "two mesh 2",
    ]


def test_scenes_of_other_libraries_are_their_meshes():
    part = SimpleNamespace(vertices=CORNERS, faces=TRIANGLES)
    assert len(scene_of(SimpleNamespace(geometry={}, dump=lambda: [part, part])).items) == 2


def test_volumes_show_their_outer_faces():
    points = np.vstack([CORNERS, (1, 1, 1)])
    mesh = scene_of(SimpleNamespace(points=points, cells=[("tetra", tetrahedra())])).items[0].mesh
    assert (mesh.face_count, mesh.is_closed) == (6, True)
    with pytest.raises(vp.InputError, match="'knot': expected some of triangle, quad"):
        scene_of(SimpleNamespace(points=points, cells=[("knot", [[0, 1]])]))


def test_arrays_are_welded_and_turned_outwards():
    soup = CORNERS[TRIANGLES.ravel()]
    with pytest.warns(vp.InputWarning, match="mesh: welded 8 vertices"):
        mesh = scene_of((soup, np.arange(12).reshape(4, 3)[:, ::-1])).items[0].mesh
    assert mesh.is_closed and len(mesh.vertices) == 4 and (mesh.area_vectors.sum(axis=0) < 1e-12).all()
    assert float(np.einsum("ij,ij->", mesh.vertices[mesh.corners[::3]], mesh.area_vectors)) > 0.0


@pytest.mark.parametrize("shown", [3, None, 1.5, [1], object(), np.zeros((3, 3)), b"file.stl", {"a": 2}])
@pytest.mark.parametrize("verb", [vp.draw, vp.paint, vp.render, scene_of])
def test_what_has_no_shape_is_a_type_error_in_one_sentence(verb, shown):
    with pytest.raises(TypeError, match=r"^expected a path, Scene, .*, or a list of these, not \w+( of shape .*)?$"):
        verb(shown)


def test_a_drawing_that_was_saved_has_no_shapes(tmp_path):
    with pytest.raises(vp.InputError, match=r"x\.json: a drawing that was saved"):
        vp.draw(tmp_path / "x.json")


def test_cameras_and_pages_are_words_too():
    drawing = vp.draw(CUBE, "iso", page="A5 landscape")
    assert (drawing.width_mm, drawing.height_mm) == (210.0, 148.0)
    assert vp.draw(CUBE, "top", page="60x50").width_mm == 60.0
    assert vp.draw(CUBE, "top", page="60x50 Portrait").width_mm == 50.0
    assert vp.render(CUBE, "front", size=(20, 10)).columns == 20
    with pytest.raises(vp.InputError, match="did you mean 'front'"):
        vp.paint(CUBE, "fornt")
    with pytest.raises(vp.InputError, match="page 'A4 across'"):
        vp.paint(CUBE, page="A4 across")
    for wrong in ({"camera": 3}, {"page": (210, 297)}):
        with pytest.raises(TypeError, match=r"is a (Camera|Page) or"):
            vp.draw(CUBE, **wrong)


def test_pictures_save_themselves(tmp_path):
    vp.draw(CUBE, "iso", page="A6").save(tmp_path / "cube.svg")
    vp.render(CUBE, size=(8, 8)).save(tmp_path / "cube.png")
    assert {path.name for path in tmp_path.iterdir()} == {"cube.svg", "cube.png"}


def test_lists_that_hold_themselves_are_refused():
    ring = []
    ring.append([ring])
    with pytest.raises(TypeError, match="holds itself"):
        vp.draw(ring)
    names = {}
    names["a"] = names
    with pytest.raises(TypeError, match="holds itself"):
        vp.draw(names)


def test_an_array_that_is_nothing_is_told_with_its_shape():
    with pytest.raises(TypeError, match=r"ndarray of shape \(7, 3\)"):
        vp.draw(np.zeros((7, 3)))


@pytest.mark.parametrize(("relief", "factor"), [(0.02, 50.0), (1.0, 1.0), (600.0, 1e-3)])
def test_heights_that_would_be_a_plain_or_needles_are_scaled_as_those_of_files(relief, factor):
    heights = np.zeros((5, 9))
    heights[2, 4] = relief
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        scene = scene_of(heights)
    assert np.ptp(scene.bounds, axis=0).tolist() == pytest.approx([4.0, 8.0, relief * factor])
    assert [f"drawn {factor:g} times as high" in str(one.message) for one in told] == [True] * (factor != 1.0)


def test_points_are_told_how_they_become_a_curve():
    with pytest.raises(TypeError, match=r"spline_curve\(points, AkimaSpline\(\)\) is the curve through points"):
        vp.draw(np.arange(30.0).reshape(10, 3))
    with pytest.raises(TypeError, match=r"not ndarray of shape \(2, 10, 3\)$"):
        vp.draw(np.zeros((2, 10, 3)))


@pytest.mark.parametrize(
    "make",
    [
        lambda faces: vp.Mesh.from_triangles(np.eye(3), faces),
        lambda faces: vp.Mesh.from_polygons(np.eye(3), faces),
        lambda faces: vp.draw((np.eye(3), faces)),
        lambda faces: vp.draw((np.eye(3), np.array(faces))),
    ],
)
def test_indices_are_whole_numbers(make):
    make([[0.0, 1.0, 2.0]])
    for bad in (1.7, np.nan, np.inf):
        with pytest.raises(vp.InputError, match="no index of a vertex"):
            make([[0, bad, 2]])


def test_a_tube_about_points_is_that_about_the_spline_through_them():
    from vectorplot.curves import CubicSpline, spline_curve

    points = np.array([(0, 0, 0), (2, 1, 0), (4, 0, 1), (6, 2, 2.0)])
    tube, same = vp.tube(points, 0.2), vp.tube(spline_curve(points, CubicSpline()), 0.2)
    at = np.array([0.3]), np.array([0.5])
    assert np.array_equal(tube.shape.points(*at), same.shape.points(*at))
    assert vp.tube([*points.tolist(), points[0].tolist()], 0.2).shape.domain.closed_v
    for bad in (np.zeros((4, 2)), "points", 3.0):
        with pytest.raises(vp.InputError, match="a tube needs a curve"):
            vp.tube(bad, 0.2)


def test_what_is_too_large_is_told_without_a_warning_of_arrays():
    from vectorplot.surfaces import Torus

    for shape in (vp.Mesh.from_triangles(np.eye(3), [(0, 1, 2)]), Torus(3, 1)):
        with pytest.raises(vp.InputError):
            vp.draw(vp.Item("a", shape).scaled(1e300))
        with pytest.raises(vp.InputError):
            vp.draw(vp.Item("a", shape).scaled(1e300).scaled(1e300))

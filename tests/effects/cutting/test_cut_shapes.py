"""Curves and implicit surfaces that are cut; what only annotates stays whole; cuts go through their own items."""

import warnings

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.curves import Circle, Helix, Line
from vectorplot.curves.cut_curve import CutCurve, parts_outside
from vectorplot.effects import cut_scene
from vectorplot.errors import InputError
from vectorplot.features import polygonized
from vectorplot.geometry import box
from vectorplot.geometry.mesh_cuts import HalfSpaces
from vectorplot.io import parse_scene
from vectorplot.io.anything import scene_of
from vectorplot.io.scene_writer import write_scene
from vectorplot.surfaces import ImplicitTorus, Torus, implicit_sphere
from vectorplot.surfaces.implicit import CutImplicit
from vectorplot.testing import assert_drawing_is_right

CAMERA = vp.Camera((7.0, -11.0, 6.0), (0.0, 0.0, 0.0))
BEFORE = HalfSpaces(((0.0, -1.0, 0.0),), (0.0,))


def of_curve(curve, text="y < 0", **words):
    return cut_scene(vp.cut(vp.Scene((vp.Item("C", curve),)), text, **words), CAMERA).items


def test_curves_end_on_the_plane():
    left = of_curve(Helix(2.0, 0.3, start=-20.0, end=20.0))[0].shape
    turns = np.arange(-6.0, 7.0, 2.0) * np.pi
    parts = np.stack([turns, np.minimum(turns + np.pi, 20.0)], axis=1)
    np.testing.assert_allclose(left.parts, parts, atol=1e-12)
    drawing = vp.draw(vp.Scene((vp.Item("C", left),)), CAMERA, curves="polyline")
    strokes = next(layer for layer in drawing.layers if layer.name == "curve").strokes[0]
    ends = np.concatenate([strokes.points3d[strokes.offsets[:-1]], strokes.points3d[strokes.offsets[1:] - 1]])
    assert len(strokes) == 7 and np.sort(np.abs(ends[:, 1]))[-2] < 1e-12


def test_a_curve_that_dips_through_a_plane_between_two_places_is_cut_there():
    # The arc below the plane is a quarter of what is between two places at which one looks.
    deep, first = 2e-8, 5e-4
    low = Circle((0.0, 1.0 - deep, 0.0), 1.0, start=first, end=first + 2.0 * np.pi)
    parts = parts_outside(low, (BEFORE,))
    half = np.arccos(1.0 - deep)
    np.testing.assert_allclose(parts, [[first, 1.5 * np.pi - half], [1.5 * np.pi + half, low.end]], atol=1e-7)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_a_curve_in_the_plane_and_one_behind_it_stay_what_they_are(scale):
    flat = Line.through((-scale, 0, 0), (scale, 0, 0))
    assert of_curve(flat)[0].shape is flat
    assert of_curve(Line.through((0, scale, 0), (0, 2 * scale, 0)))[0].shape.end == 1.0
    with pytest.warns(vp.InputWarning, match="takes everything away"):
        gone = of_curve(Line.through((0, -scale, 0), (0, -2 * scale, 0)))
    assert not gone[0].mesh.face_count
    touching = Circle((0, scale, 0), scale)
    np.testing.assert_allclose(parts_outside(touching, (BEFORE,)), [[0.0, 2.0 * np.pi]])


def test_a_corner_is_taken_out_of_a_ring_and_becomes_a_ghost():
    left, ghost = of_curve(Circle(radius=2.0), "x > 0, y > 0", away="ghost")
    np.testing.assert_allclose(left.shape.parts, [[np.pi / 2, 2 * np.pi]])
    np.testing.assert_allclose(ghost.shape.parts, [[0.0, np.pi / 2]])
    assert ghost.lines == ("ghost",) and isinstance(ghost.shape.moved(0, 0, 1).curve, CutCurve)


def test_axes_and_dimensions_stay_whole_without_a_word():
    scene = scene_of([vp.Item("B", box((2, 2, 2))), vp.axes(3.0), vp.dimension((0, 0, 0), (2, 0, 0), (0, -1, 0))])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        after = cut_scene(vp.cut(scene, "x < 1", away="ghost"), CAMERA)
    assert [item.shape for item in after.items[1 : len(scene)]] == [item.shape for item in scene.items[1:]]
    assert [item.name for item in after.items[len(scene) :]] == ["B cut", "B ghost"]


@pytest.mark.slow
def test_implicit_surfaces_end_on_the_plane_and_show_their_true_section():
    ring = vp.Scene((vp.Item("T", ImplicitTorus(3.0, 1.0).moved(0.0, 0.2, 0.0)),))
    half = vp.cut(ring, "y < 0.2")
    face = next(item for item in cut_scene(half, CAMERA).items if item.is_cut_face)
    area = float(np.linalg.norm(face.mesh.area_vectors, axis=1).sum()) / 2.0
    assert area == pytest.approx(2.0 * np.pi, rel=2e-4)
    drawing = vp.draw(half, CAMERA, lines="contour,cut", curves="polyline")
    points = {layer.name: np.concatenate([one.points3d for one in layer.strokes]) for layer in drawing.layers}
    x, y, z = points["cut"].T
    assert np.abs(y - 0.2).max() < 1e-9 and np.abs((np.abs(x) - 3.0) ** 2 + z**2 - 1.0).max() < 1e-4
    assert len(points["hatch"]) and len(points["contour"]) and points["contour"][:, 1].min() > 0.2 - 1e-6


@pytest.mark.slow
def test_implicit_surfaces_end_on_oblique_planes_and_at_corners_as_parametrised_ones_do():
    text = "x + y > 0.1, z > 0.2"
    (cut,) = vp.cut(vp.Scene((vp.Item("T", ImplicitTorus(3.0, 1.0)),)), text).cuts
    region, areas = cut.region(CAMERA), []
    for shape in (ImplicitTorus(3.0, 1.0), Torus(3.0, 1.0)):
        ring = cut_scene(vp.cut(vp.Scene((vp.Item("T", shape),)), text), CAMERA)
        areas.append([np.linalg.norm(one.mesh.area_vectors, axis=1).sum() for one in ring.items if one.is_cut_face])
        if shape.__class__ is Torus:
            continue
        assert isinstance(ring.items[0].shape, CutImplicit)
        drawing = vp.draw(ring, CAMERA, lines="contour,cut", curves="polyline", tolerance_mm=0.1)
        assert assert_drawing_is_right(drawing, ring, CAMERA, samples=100) > 80
        points = {layer.name: np.concatenate([one.points3d for one in layer.strokes]) for layer in drawing.layers}
        assert np.abs(region.heights(points["cut"])).min(axis=0).max() < 1e-9
        assert region.heights(points["contour"]).min(axis=0).max() < 1e-9 and len(points["hatch"])
        x, y, z = points["contour"].T
        assert np.abs((np.hypot(x, y) - 3.0) ** 2 + z**2 - 1.0).max() < 1e-9
    np.testing.assert_allclose(areas[0], areas[1], rtol=1e-4)


def test_what_planes_leave_of_implicit_surfaces_ends_at_corners_in_single_points():
    region = HalfSpaces(((0.6, 0.0, 0.8), (0.0, 1.0, 0.0)), (0.1, 0.2))
    mesh = polygonized(CutImplicit(implicit_sphere(1.0), (region,)), 12)
    np.testing.assert_allclose(np.linalg.norm(mesh.vertices, axis=1), 1.0, atol=1e-12)
    heights = region.heights(mesh.vertices)
    assert heights.min(axis=0).max() < 1e-12
    assert ((np.abs(heights) < 1e-12).all(axis=0)).sum() == 2
    moved = CutImplicit(implicit_sphere(1.0), (), region).turned((0, 0, 1), 30.0).moved(1.0, 2.0, 3.0)
    other = polygonized(moved, 12)
    assert moved.within.heights(other.vertices).min() > -1e-12 and 0 < other.face_count < mesh.face_count


@pytest.mark.slow
def test_planes_that_miss_an_implicit_surface_leave_it_what_it_is_or_nothing():
    ball = vp.Scene((vp.Item("B", implicit_sphere(1.0)),))
    assert cut_scene(vp.cut(ball, "x + y > 1.5"), CAMERA).items[0].shape is ball.items[0].shape
    assert not cut_scene(vp.cut(ball, "x + y > -1.5"), CAMERA).items[0].mesh.face_count


def test_cuts_go_through_the_items_of_their_own_scene():
    cut = vp.cut(vp.Scene((vp.Item("B", box((2, 2, 2))),)), "y < 1")
    other = vp.Scene((vp.Item("B", box((2, 2, 2)).moved(3, 0, 0)),))
    for shown, name, place in (([other, cut], "B 2", 1), ({"one": cut, "two": other}, "one", 0)):
        scene = scene_of(shown)
        assert scene.cuts[0].items == (name,) == parse_scene(write_scene(scene)).cuts[0].items
        low = [item.shape.bounds[0, 1] for item in cut_scene(scene, CAMERA).items[:2]]
        assert low == [1.0 if k == place else 0.0 for k in range(2)]


def test_a_cut_of_some_items_leaves_the_others_whole():
    text = 'A box 2 2 2  S box 0.5 0.5 3 translation 0.5 0.5 -0.5  cut "y < 0.7" of "A"'
    after = cut_scene(parse_scene(text), CAMERA)
    assert [item.shape.bounds[0, 1] for item in after.items] == [0.7, 0.5, 0.7]
    by_python = vp.cut(parse_scene("A box 2 2 2  S box 1 1 1"), "y < 0.7", items=["A"])
    assert by_python.cuts[0].items == ("A",)
    with pytest.raises(InputError, match="item 'T': expected one of A, S"):
        vp.cut(by_python, "y < 0.7", items=["T"])
    with pytest.raises(InputError, match="expected names of items in quotes behind 'of'"):
        parse_scene('A box 2 2 2  cut "y < 0.7" of A')
    with pytest.raises(InputError, match=r"2: cut: item 'LIP': .*did you mean 'LID'"):
        parse_scene('LID box 2 2 2\ncut "y < 0.7" of "LIP"')

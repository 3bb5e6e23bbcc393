"""Items in one place: those that cannot be seen cost nothing, and pictures stay the same."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.pace import cpu_seconds
from support.top_fills import assert_same_picture

import vectorplot as vp
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.polylines import segments
from vectorplot.geometry.rotations import rotation_z
from vectorplot.scene.view import NOTHING, are_in_one_place, fingerprint, first_coincident, look, without_coincident
from vectorplot.surfaces import Domain, Sphere, Torus, graph
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.testing.shapes import box

CAMERA = vp.Camera((9.0, -8.0, 6.0), (0.0, 0.0, 0.0))


def scene_of(*items: vp.Item) -> vp.Scene:
    return vp.Scene(items, lights=(vp.Light((5.0, -2.0, 9.0)),))


@pytest.mark.slow
@pytest.mark.parametrize("shape", [lambda: Torus(2.0, 0.7), lambda: box((-1, -1, -1), (1, 1, 1))])
def test_a_hundred_in_one_place_are_painted_as_the_last_one(shape) -> None:
    floor = vp.Item("floor", box((-3, -3, -1.5), (3, 3, -1.2)))
    many = [vp.Item(f"B{k}", shape(), ("red", "green", "blue")[k % 3]) for k in range(100)]
    one = vp.paint(scene_of(floor, many[-1]), CAMERA, tolerance_mm=0.2)
    all_of_them = vp.paint(scene_of(floor, *many), CAMERA, tolerance_mm=0.2)
    assert len(one.layers[0].marks[0]) == len(all_of_them.layers[0].marks[0])
    assert_same_picture(one, all_of_them)
    assert all_of_them.items[-1] == "B99"


def test_only_what_hides_all_of_it_takes_the_place_of_another() -> None:
    cube, other = box((0, 0, 0), (1, 1, 1)), box((0, 0, 0), (1, 1, 1 + 1e-15 * 8))
    plain = vp.Item("A", cube)
    glass = vp.Item("B", cube, material=vp.Material(opacity=0.5))
    wire = vp.Item("C", cube, occludes=False)
    for items in ((plain, glass), (plain, wire), (plain, vp.Item("D", other)), (plain,)):
        scene = scene_of(*items)
        assert without_coincident(scene) is scene
    left = without_coincident(scene_of(glass, wire, plain, replace(plain, colour="red")))
    assert [item.mesh.face_count for item in left.items] == [0, 0, 0, 6]


def turned(shape, angle: float, axis=(0.0, 0.0, 0.0)) -> PlacedSurface:
    """Turned about a parallel of the z-axis by degrees."""
    matrix, axis = rotation_z(np.radians(angle)), np.array(axis)
    return PlacedSurface(shape, matrix, axis - axis @ matrix)


@pytest.mark.parametrize("angle", [30.0, 77.0, 180.0])
def test_surfaces_turned_in_themselves_are_in_one_place(angle: float) -> None:
    for shape, axis in ((Torus(1.4, 0.4, (1e3, 0, 2)), (1e3, 0, 0)), (Sphere(2.0, (0, 5, 0)), (0, 5, 0))):
        same, other = turned(shape, angle, axis), turned(shape, angle, np.add(axis, (1e-4, 0.0, 0.0)))
        assert are_in_one_place(shape, same) and are_in_one_place(same, shape)
        assert not are_in_one_place(shape, other) and not are_in_one_place(other, shape)


def test_surfaces_that_share_a_part_only_are_not_in_one_place() -> None:
    whole, half = (graph(lambda x, y: x * y, Domain(0.0, 1.0, 0.0, end)) for end in (1.0, 0.5))
    assert not are_in_one_place(whole, half) and not are_in_one_place(half, whole)
    assert not are_in_one_place(Torus(1.4, 0.4), Torus(1.4, 0.4 + 1e-6))


@pytest.mark.slow
def test_of_turned_tori_the_last_one_is_painted_and_rendered() -> None:
    torus = Torus(1.4, 0.4)
    one, other = vp.Item("A", torus, "red"), vp.Item("B", turned(torus, 30.0), "blue")
    for first, last in ((one, other), (other, one)):
        both, alone = scene_of(first, last), scene_of(last)
        fills = [vp.paint(scene, CAMERA, tolerance_mm=0.5).layers[0].fills[0] for scene in (both, alone)]
        # The boxes of both scenes differ in the last digits: a triangle may be divided in one of them only.
        assert abs(len(fills[0]) - len(fills[1])) <= 0.01 * len(fills[1])
        assert np.ptp([some.colours.mean(axis=0) for some in fills], axis=0).max() < 1.0
        pixels = [vp.render(scene, CAMERA, size=(40, 30), samples=1).pixels for scene in (both, alone)]
        assert np.ptp(np.array(pixels, dtype=int), axis=0).max() < 3


def test_shapes_are_the_same_where_all_their_numbers_are() -> None:
    assert fingerprint(Torus(2.0, 0.7)) == fingerprint(Torus(2.0, 0.7)) != fingerprint(Torus(2.0, 0.71))
    assert fingerprint(box((0, 0, 0), (1, 1, 1))) != fingerprint(box((0, 0, 0), (1, 1, 2)))
    assert fingerprint(len) == fingerprint(len) != fingerprint(abs)


def in_one_place(*shapes, hides=None):
    hides = [True] * len(shapes) if hides is None else hides
    items = [vp.Item(str(k), shape, occludes=hide) for k, (shape, hide) in enumerate(zip(shapes, hides, strict=True))]
    return look(vp.Scene(tuple(items)), CAMERA)


def test_bodies_in_one_place_are_told_from_those_that_only_begin_there() -> None:
    one, two, long = box((0, 0, 0), (1, 1, 1)), box((0, 0, 0), (1, 1, 2)), box((0, 0, 0), (1, 1, 1 + 1e-12))
    turned = Mesh(one.vertices, np.roll(one.corners, 4), one.offsets)
    view = in_one_place(one, two, one, NOTHING, two, one, long, NOTHING, turned)
    assert first_coincident(view).tolist() == [0, 1, 0, 3, 1, 0, 6, 7, 8]


def test_a_body_that_hides_nothing_is_no_twin_of_one_that_does() -> None:
    one = box((0, 0, 0), (1, 1, 1))
    assert first_coincident(in_one_place(one, one, one, one, hides=[False, True, False, True])).tolist() == [0, 1, 0, 1]


def test_no_bodies_or_one() -> None:
    assert first_coincident(in_one_place()).tolist() == []
    assert first_coincident(in_one_place(box((0, 0, 0), (1, 1, 1)))).tolist() == [0]


@pytest.mark.parametrize("hidden", ["none", "solid"])
def test_copies_of_bodies_change_no_picture(hidden) -> None:
    # A block that two others pierce, each of them several times in its place.
    shapes = [box((0, 0, 0), (2, 2, 2)), box((1, 1, 1), (3, 3, 3)), box((-1, 0.5, 0.5), (4, 0.8, 0.8))]
    once, often = (
        vp.draw(vp.Scene(tuple(vp.Item(str(k), shapes[k]) for k in which)), CAMERA, hidden=hidden)
        for which in ([0, 1, 2], [0, 1, 2, 1, 0, 0, 2, 1, 0, 2, 2])
    )
    for one, other in zip(once.layers, often.layers, strict=True):
        assert np.allclose(sides_of(one.strokes), sides_of(other.strokes), rtol=0.0, atol=1e-6)


def sides_of(strokes):
    """(s,4) the sides of strokes, sorted, each from left to right."""
    ends = np.concatenate([paths.points[segments(paths)] for paths in strokes])
    swap = (ends[:, 0, 0] > ends[:, 1, 0])[:, None, None]
    return np.array(sorted(np.round(np.where(swap, ends[:, ::-1], ends), 6).reshape(-1, 4).tolist()))


def test_hundreds_of_bodies_in_one_place_take_hardly_longer_than_one() -> None:
    # What pairs of pairs of faces would take: minutes.
    one = box((0, 0, 0), (1, 1, 1))
    with cpu_seconds(5.0):
        vp.draw(vp.Scene(tuple(vp.Item(str(k), one) for k in range(500))))

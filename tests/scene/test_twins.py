"""Items in one place: those that cannot be seen cost nothing, and pictures stay the same."""

from __future__ import annotations

from dataclasses import replace

import pytest
from support.top_fills import assert_same_picture

import vectorplot as vp
from vectorplot.scene.twins import fingerprint, without_twins
from vectorplot.surfaces import Torus
from vectorplot.testing.shapes import box

CAMERA = vp.Camera((9.0, -8.0, 6.0), (0.0, 0.0, 0.0))


def scene_of(*items: vp.Item) -> vp.Scene:
    return vp.Scene(items, lights=(vp.Light((5.0, -2.0, 9.0)),))


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
        assert without_twins(scene) is scene
    left = without_twins(scene_of(glass, wire, plain, replace(plain, colour="red")))
    assert [item.mesh.face_count for item in left.items] == [0, 0, 0, 6]


def test_shapes_are_the_same_where_all_their_numbers_are() -> None:
    assert fingerprint(Torus(2.0, 0.7)) == fingerprint(Torus(2.0, 0.7)) != fingerprint(Torus(2.0, 0.71))
    assert fingerprint(box((0, 0, 0), (1, 1, 1))) != fingerprint(box((0, 0, 0), (1, 1, 2)))
    assert fingerprint(len) == fingerprint(len) != fingerprint(abs)

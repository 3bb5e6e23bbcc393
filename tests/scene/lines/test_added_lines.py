"""Lines that are added to whole scenes."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot import geometry
from vectorplot.errors import InputError
from vectorplot.scene.added_lines import even_sections, round_sections, with_lines
from vectorplot.scene.surface_lines import Section, SurfaceLines
from vectorplot.surfaces import Sphere

BOX = vp.Item("box", geometry.box((1, 1, 3)))


@pytest.mark.parametrize("size", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("away", [0.0, 1e6])
def test_planes_divide_the_whole_and_go_from_item_to_item(size, away):
    ball = vp.Item("ball", Sphere(1.0)).moved(5.0, 0.0, 0.0)
    shown = vp.Scene((BOX, ball)).scaled(size).moved(away * size, 0.0, 0.0)
    x = np.array(even_sections(shown, (1, 0, 0), 5).offsets) / size - away
    assert np.allclose(x, np.arange(1, 6), atol=1e-8)
    z = np.array(even_sections(shown, (0, 0, -2), 3).offsets) / size
    assert np.allclose(z, [-2.0, -1.0, 0.0], atol=1e-8)


def test_oblique_planes_divide_what_is_there_and_not_its_box():
    tip = vp.Mesh.from_triangles([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 2, 1), (0, 1, 3), (1, 2, 3)])
    found = even_sections(vp.Scene((vp.Item("tip", tip),)), (1, 1, 1), 1)
    assert np.allclose(found.offsets, [0.5 / np.sqrt(3.0)], rtol=1e-12)
    found = even_sections(vp.Scene((vp.Item("ball", Sphere(1.0)),)), (1, 1, 1), 1)
    assert np.allclose(found.offsets, [0.0], atol=1e-9)


def test_level_lines_have_round_heights_and_every_fifth_is_an_index_line():
    index, others = round_sections(vp.Scene((BOX.moved(0.0, 0.0, 7.0),)), count=30)
    assert index.index and not others.index
    assert index.offsets == (7.5, 8.0, 8.5, 9.0, 9.5)
    assert len(others.offsets) == 24
    (along_y,) = round_sections(vp.Scene((BOX,)), (0, 1, 0), 4, every=0)
    assert along_y.normal == (0.0, 1.0, 0.0) and along_y.offsets == (0.2, 0.4, 0.6, 0.8)


def test_what_items_ask_for_stays_and_curves_stay_as_they_are():
    own = SurfaceLines(columns=3, isophotes=(0.0, 0.5), sections=(Section((0, 0, 1), (1.0,)),))
    ball = vp.Item("ball", Sphere(1.0), lines=("contour",), curves=own)
    line = vp.Item("line", vp.curves.Circle((0, 0, 0), 1.0))
    found = with_lines(vp.Scene((ball, line)), sections=(Section((0, 0, 1), (1.0, 0.5)),), isophotes=(0.5, -0.5)).items
    assert found[0].curves.columns == 3 and found[0].curves.isophotes == (0.0, 0.5, -0.5)
    assert [one.offsets for one in found[0].curves.sections] == [(1.0,), (0.5,)]
    assert found[0].lines == ("contour", "isophote", "section")
    assert found[1] is line


def test_an_item_gets_the_planes_that_reach_it():
    low, high = with_lines(
        vp.Scene((BOX, BOX.moved(0.0, 0.0, 10.0))), sections=(Section((0, 0, 1), (-1.0, 0.0, 2.0, 5.0, 11.0)),)
    ).items
    assert low.curves.sections == (Section((0, 0, 1), (0.0, 2.0)),)
    assert high.curves.sections == (Section((0, 0, 1), (11.0,)),)


def test_scenes_without_extent_and_too_many_planes_are_refused():
    flat = vp.Scene((vp.Item("flat", vp.Mesh.from_triangles([(0, 0, 9), (1, 0, 9), (0, 1, 9)], [(0, 1, 2)])),))
    for shown in (flat, vp.Scene(())):
        with pytest.raises(InputError, match="sections: the scene has no extent"):
            even_sections(shown, (0, 0, 1), 5)
        with pytest.raises(InputError, match="level lines: the scene has no extent"):
            round_sections(shown)
    half = tuple(float(k) for k in range(6000))
    with pytest.raises(InputError, match="sections: 12000 of them, expected at most 10000"):
        with_lines(flat, sections=(Section((0, 0, 1), half), Section((1, 0, 0), half)))
    for count in (0, 10_001):
        with pytest.raises(InputError, match="expected 1 to 10000"):
            even_sections(flat, (1, 0, 0), count)
        with pytest.raises(InputError, match="expected 1 to 10000"):
            round_sections(flat, (1, 0, 0), count)


def test_planes_that_are_all_beside_the_scene_are_told():
    with pytest.warns(vp.InputWarning, match="beside the scene: it reaches from 0 to 3 along"):
        with_lines(vp.Scene((BOX,)), sections=(Section((0, 0, 1), (5.0, 7.0)),))

"""Level lines at round heights, and index lines among them, on every kind of shape."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.errors import InputError
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene.surface_lines import round_heights
from vectorplot.scene.terrains import level_sections
from vectorplot.surfaces.quadrics import Sphere
from vectorplot.surfaces.tori import ImplicitTorus, Torus
from vectorplot.testing import curves_in_space

UP = (0.0, 0.0, 1.0)


@pytest.mark.parametrize(("low", "high"), [(0, 1), (-3, 4), (1e-7, 3e-7), (1e9, 1e9 + 70), (-2345, 8848.86)])
def test_heights_are_round_and_inside(low, high):
    for count in (1, 2, 5, 20, 100):
        heights = np.array(round_heights(low, high, count))
        assert ((heights > low) & (heights < high)).all()
        assert 0.5 * count <= len(heights) + 1
        assert len(heights) <= 2 * count + 1
        if len(heights) > 1:
            digits = (heights[1] - heights[0]) / 10.0 ** np.floor(np.log10(heights[1] - heights[0]) + 1e-6)
            assert np.isclose(digits, [1, 2, 5], rtol=1e-6).any()
    assert round_heights(2.0, 2.0) == ()


def test_index_lines_are_multiples_of_steps_or_counted():
    def index(heights, every):
        return [part.offsets for part in level_sections(heights, every) if part.index]

    assert index(np.arange(-30, 31, 10), 2) == [(-20.0, 0.0, 20.0)]
    assert index([0.3, 0.4, 0.5, 0.6], 5) == [(0.5,)]
    assert index([1, 2, 4, 8, 16, 32], 3) == [(4.0, 32.0)]
    assert index([1, 2, 3], 0) == []
    with pytest.raises(InputError, match="every -1"):
        level_sections([1.0], -1)


def test_a_plane_is_drawn_once_and_heavy():
    lines = vp.SurfaceLines(sections=(vp.Section(UP, (1, 2)), vp.Section((0, 0, -1), (-2.0, -3.0), index=True)))
    assert [part.offsets for part in lines.sections] == [(1.0,), (-2.0, -3.0)]


SHAPES = {
    "mesh": vp.Mesh.from_triangles(
        [(-1, -1, -1), (1, -1, -1), (0, 1, -1), (0, 0, 1.2)], [(0, 1, 3), (1, 2, 3), (2, 0, 3)]
    ),
    "ball": Sphere(1.2),
    "torus": Torus(1.0, 0.9),
    "implicit": ImplicitTorus(1.0, 0.9),
}


@pytest.mark.slow
@pytest.mark.parametrize("shape", SHAPES)
def test_index_lines_are_of_their_own_kind_on_every_shape(shape):
    lines = vp.SurfaceLines(sections=level_sections([-0.5, -0.25, 0.0, 0.25, 0.5], 2))
    item = vp.Item("SHAPE", SHAPES[shape], curves=lines)
    drawing = vp.draw(vp.Scene((item,)), vp.Camera((3, -5, 4)))
    for kind, heights in (("index", {-0.5, 0.0, 0.5}), ("section", {-0.25, 0.25})):
        found = np.concatenate(curves_in_space(drawing, kind=kind))[:, 2]
        assert {min(heights, key=lambda h, z=z: abs(z - h)) for z in found.tolist()} == heights
        assert min(abs(z - h) for z in found.tolist() for h in heights) < 1e-9
    widths = {layer.name: layer.pen.width_mm for layer in drawing.layers}
    assert widths["index"] > widths["section"]
    only = vp.draw(vp.Scene((item,)), vp.Camera((3, -5, 4)), lines="index")
    assert not curves_in_space(only, kind="section")


def test_index_lines_in_scene_files():
    scene = parse_scene("BALL surface sphere 1 level_lines 9 index 3 sections x at 0.1, 0.2, 0.7 index 2")
    heavy = [part.offsets for part in scene.items[0].curves.sections if part.index]
    assert heavy == [pytest.approx((-0.6, 0.0, 0.6)), (0.2,)]
    again = parse_scene(write_scene(scene))
    assert again.items[0].curves.sections == scene.items[0].curves.sections
    with pytest.raises(InputError, match="index: every 0, expected 1 or more"):
        parse_scene("BALL surface sphere 1 level_lines 9 index 0")

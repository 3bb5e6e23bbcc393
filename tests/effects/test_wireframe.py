"""Wireframes by every way they are asked for: all edges once, in the shades of palettes, near ones brighter."""

from dataclasses import replace

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.drawing.drawing import Drawing
from vectorplot.geometry.solids import revolution
from vectorplot.geometry.winding import mesh_edges
from vectorplot.shading.palettes import palette
from vectorplot.surfaces.quadrics import Sphere, implicit_sphere
from vectorplot.surfaces.tori import Torus
from vectorplot.testing import assert_drawings_equal
from vectorplot.testing.shapes import box
from vectorplot.words import WIRES

COLOURS = ("orange", "lightcyan", "darkgreen", "gray", "#3366cc")
VIEWS = [vp.Camera(eye=eye, target=(1, 1, 1)) for eye in ((14, -17, 11), (-20, -9, 3), (2, 3, 31), (5, -9, -13))]
VIEWS.append(vp.Camera(eye=(31, 23, 11), target=(1, 1, 1), parallel=True))


def double_pyramid(number: int) -> vp.Mesh:
    return revolution([(0, 0, -2), (number + 1, 0, 0), (0, 0, 3)], 4 + number)


def bodies() -> vp.Scene:
    """Boxes and double pyramids that hide each other and themselves."""
    rng = np.random.default_rng(4)
    items = []
    for number, colour in enumerate(COLOURS):
        low = rng.uniform(-5, 5, 3)
        high = low + rng.uniform(1, 4, 3)
        shape = box(tuple(low), tuple(high)) if number % 2 else double_pyramid(number)
        items.append(vp.Item(f"BODY{number}", shape, colour))
    return vp.Scene(tuple(items))


def edges_of(scene: vp.Scene) -> np.ndarray:
    """(e,2,3) both ends of every edge of every item."""
    return np.concatenate([item.mesh.vertices[mesh_edges(item.mesh)] for item in scene.items])


def segments(drawing: Drawing) -> tuple[np.ndarray, np.ndarray]:
    """(s,2,3) the ends in space of every straight piece that is drawn, and (s,) the shade its layer is named after."""
    ends, shades = [], []
    for layer in drawing.layers:
        for paths in layer.strokes:
            for k in range(len(paths)):
                line = paths.points3d[paths.offsets[k] : paths.offsets[k + 1]]
                line = np.vstack([line, line[:1]]) if paths.closed[k] else line
                ends.append(np.stack([line[:-1], line[1:]], axis=1))
                shades += [int(layer.name.split()[-1])] * (len(line) - 1)
    return np.concatenate(ends), np.array(shades)


def matched(drawn: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """(s,) which edge each piece is, forwards or backwards."""
    away = np.abs(drawn[:, None] - edges[None]).max(axis=(2, 3))
    back = np.abs(drawn[:, None, ::-1] - edges[None]).max(axis=(2, 3))
    away = np.minimum(away, back)
    assert away.min(axis=1).max() < 1e-9
    return away.argmin(axis=1)


@pytest.mark.capability("G4.4-wireframe")
@pytest.mark.parametrize("camera", VIEWS)
@pytest.mark.parametrize("style", ["wireframe", "depth-cue"])
def test_every_edge_is_one_line_from_every_side(camera, style):
    scene = bodies()
    edges = edges_of(scene)
    drawn, _ = segments(vp.draw(scene, camera, style=style))
    assert len(drawn) == len(edges)
    assert sorted(matched(drawn, edges)) == list(range(len(edges)))


@pytest.mark.capability("G4.4-wireframe")
@pytest.mark.parametrize("count", range(1, len(COLOURS) + 1))
def test_all_edges_have_the_middle_shade_of_their_objects_palette(count):
    scene = vp.Scene(bodies().items[:count])
    sheet, *layers = vp.draw(scene, VIEWS[0], style="wireframe").layers
    assert [layer.name for layer in layers] == [f"{colour} 16" for colour in COLOURS[:count]]
    for layer, colour in zip(layers, COLOURS, strict=False):
        assert layer.pen.colour == "#" + bytes(palette(colour)[16]).hex()
    assert not sheet.plotted and sheet.fills[0].colours[0].tolist() == palette("gray")[0].tolist()


@pytest.mark.capability("G4.4-depthcue")
@pytest.mark.parametrize("camera", VIEWS)
def test_every_edge_has_the_mean_shade_of_the_depths_of_its_ends(camera):
    scene = bodies()
    drawn, shade = segments(vp.draw(scene, camera, style="depth-cue"))
    depth = -(drawn @ camera.axes[2])
    vertices = -(scene.vertices @ camera.axes[2])
    part = 0.2 + 0.8 * (vertices.max() - depth) / np.ptp(vertices)
    assert np.abs(shade - 32 * part.mean(axis=1)).max() <= 1.0
    assert shade.max() > 0.8 * 31 and shade.min() >= 6


@pytest.mark.capability("G4.4-depthcue")
def test_the_nearest_edge_is_the_brightest_and_drawn_last_and_the_farthest_keeps_a_fifth():
    posts = [vp.Item(f"POST{k}", box((0, 3 * k, 0), (1, 3 * k + 0.001, 1)), "yellow") for k in range(9)]
    drawing = vp.draw(vp.Scene(tuple(posts)), vp.Camera(eye=(9, -60, 20), target=(0, 12, 0)), style="depth-cue")
    shades = [int(layer.name.split()[1]) for layer in drawing.layers[1:]]
    assert shades == sorted(shades) and shades[0] == 6 and shades[-1] >= 30
    nearest, farthest = drawing.layers[-1].strokes[0], drawing.layers[1].strokes[0]
    assert set(nearest.item) == {0} and set(farthest.item) == {8}


@pytest.mark.capability("G4.4-depthcue")
@pytest.mark.parametrize("reach", [1e2, 1e4, 1e6])
def test_depths_are_limited_to_four_distances_behind_the_target(reach):
    road = vp.Scene((vp.Item("ROAD", box((-1, 0, -1), (1, reach, 0))),))
    drawing = vp.draw(road, vp.Camera(eye=(0.3, -10, 3), target=(0, 0, 0)), style="depth-cue")
    drawn, shade = segments(drawing)
    near = np.ptp(drawn[:, :, 1], axis=1) + np.abs(drawn[:, 0, 1]) < 1e-9
    assert near.sum() == 4 and shade[near].min() >= 30
    assert shade[np.abs(drawn[:, :, 1] - reach).max(axis=1) < 1e-9 * reach].max() <= 6


@pytest.mark.slow
@pytest.mark.capability("G4.4-wireframe", "G4.4-depthcue")
def test_smooth_surfaces_and_curves_are_seen_through():
    ring = vp.Item("RING", Torus(3.0, 1.0), "blue")
    scene = vp.Scene((ring, vp.Item("BLOCK", box((-9, -9, 2), (9, 9, 3)))))
    camera = vp.Camera(eye=(3, -4, 30))
    for style in ("wireframe", "depth-cue"):
        drawing = vp.draw(scene, camera, style=style)
        assert {int(i) for layer in drawing.layers for paths in layer.strokes for i in paths.item} == {0, 1}
        assert drawing.layers[1].pen.colour != drawing.layers[-1].pen.colour
    plain = vp.draw(scene, camera)
    assert {int(i) for layer in plain.layers for paths in layer.strokes for i in paths.item} == {1}


@pytest.mark.slow
@pytest.mark.capability("G4.4-wireframe", "G4.4-depthcue")
@pytest.mark.spread
@pytest.mark.parametrize("style", ["wireframe", "depth-cue"])
@pytest.mark.parametrize("camera", [vp.Camera(eye=(3, -4, 30)), vp.Camera(eye=(30, 0, 0), parallel=True)])
def test_smooth_surfaces_are_drawn_as_if_none_of_them_hid_anything(style, camera):
    curves = vp.SurfaceLines(columns=5, rows=4)
    ring = vp.Item("RING", Torus(3.0, 1.0), curves=curves)
    ball = vp.Item("BALL", Sphere(2.0), curves=curves)
    knot = vp.Item("KNOT", implicit_sphere(2.5))
    block = vp.Item("BLOCK", box((-9, -9, 2), (9, 9, 3)))
    stages = []
    drawn = vp.draw(vp.Scene((ring, ball, knot, block)), camera, style=style, explain=stages.append)
    assert "smooth surfaces" not in {stage.name for stage in stages}
    clear = vp.Scene(tuple(replace(item, occludes=False) for item in (ring, ball, knot, block)))
    assert_drawings_equal(drawn, vp.draw(clear, camera, lines=WIRES), 0.05)


@pytest.mark.capability("G4.4-wireframe", "G4.4-depthcue")
@pytest.mark.parametrize("style", ["wireframe", "depth-cue"])
def test_the_command_knows_the_styles(style, tmp_path, capsys):
    out = tmp_path / "out.svg"
    assert run(["draw", "data/pencil.scene", "-o", str(out), "--style", style]) == 0
    assert "background" in out.read_text()
    assert run(["draw", "data/pencil.scene", "-o", str(out), "--style", style, "--hidden", "dashed"]) == 1
    assert f"hidden does not go with the style {style}" in capsys.readouterr().err
    assert run(["draw", "data/pencil.scene", "-o", str(out), "--style", "wire"]) == 2


def test_the_scenes_own_background_is_behind_a_wireframe():
    scene = vp.Scene(bodies().items, background="lightblue")
    sheet = vp.draw(scene, style="wireframe").layers[0].fills[0]
    assert sheet.colours[0].tolist() == palette("lightblue")[-1].tolist()


@pytest.mark.hard(55)
def test_an_empty_scene_gives_an_empty_sheet():
    assert len(vp.draw(vp.Scene(()), style="depth-cue").layers) == 1


def test_an_unknown_style_is_an_error():
    with pytest.raises(vp.InputError, match="style 'wires': expected one of plain, wireframe, depth-cue"):
        vp.draw(bodies(), style="wires")

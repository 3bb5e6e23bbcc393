"""Lines by depth: divided where the steps are, a fifth of pens at the far end, alike in verbs, files and readers."""

import subprocess
from dataclasses import replace

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.cli.main import run
from vectorplot.curves import Helix, Line
from vectorplot.io import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.scene import DepthCue, look
from vectorplot.surfaces import Sphere
from vectorplot.testing.shapes import box

CAMERA = vp.Camera((4.0, -9.0, 5.0))
BOXES = vp.Scene(tuple(vp.Item(f"BOX{k}", box((0, 3 * k, 0), (1, 3 * k + 1, 1 + k))) for k in range(3)))


def pieces(drawing):
    """(s,2,2) and (s,2,3): both ends of all pieces of strokes on the page and in space; (s,) their steps."""
    page, space, steps = [], [], []
    for layer in drawing.layers:
        step = int(layer.name.rpartition(" depth ")[2]) if " depth " in layer.name else 1
        for paths in layer.strokes:
            for begin, end, closed in zip(paths.offsets[:-1], paths.offsets[1:], paths.closed, strict=True):
                index = np.r_[begin:end, begin] if closed else np.r_[begin:end]
                page.append(np.stack([paths.points[index[:-1]], paths.points[index[1:]]], axis=1))
                space.append(np.stack([paths.points3d[index[:-1]], paths.points3d[index[1:]]], axis=1))
                steps += [step] * (len(index) - 1)
    return np.concatenate(page), np.concatenate(space), np.array(steps)


def imaged(drawing, points):
    rows = np.concatenate([points, np.ones((*points.shape[:-1], 1))], axis=-1) @ drawing.page_from_world.T
    return rows[..., :2] / rows[..., 3:]


@pytest.mark.capability("G4.4-depthcue")
@pytest.mark.parametrize("camera", [CAMERA, vp.Camera((4.0, -9.0, 5.0), parallel=True)], ids=["central", "parallel"])
def test_strokes_are_divided_exactly_where_the_steps_are_and_none_is_lost(camera):
    plain = vp.draw(BOXES, camera)
    cued = vp.draw(BOXES, camera, depth_cue="width,4")
    assert np.array_equal(plain.page_from_world, cued.page_from_world)
    page, space, step = pieces(cued)
    depth = look(BOXES, camera).points_of(space.reshape(-1, 3))[2].reshape(-1, 2)
    level = 4.0 * (depth - depth.min()) / np.ptp(depth)
    assert (level.max(axis=1) <= 5.0 - step + 1e-8).all() and (level.min(axis=1) >= 4.0 - step - 1e-8).all()
    assert set(step) == {1, 2, 3, 4}
    assert abs(imaged(cued, space) - page).max() < 1e-9
    lengths = [np.hypot(*(ends[:, 1] - ends[:, 0]).T).sum() for ends in (page, pieces(plain)[0])]
    assert lengths[0] == pytest.approx(lengths[1], rel=1e-9)
    order = [int(layer.name[-1]) if " depth " in layer.name else 1 for layer in cued.layers]
    assert order == sorted(order, reverse=True)


@pytest.mark.capability("G4.4-depthcue")
def test_what_is_farthest_has_a_fifth_of_its_pen_and_its_colour():
    drawing = vp.draw(BOXES, CAMERA, pens="contour=0.5:#c86400", depth_cue="width,shade", background="#000064")
    pens = {layer.name: layer.pen for layer in drawing.layers if layer.name.startswith("contour")}
    shares = (1.0, 0.8, 0.6, 0.4, 0.2)
    for number, share in enumerate(shares, start=1):
        pen = pens["contour" if number == 1 else f"contour depth {number}"]
        assert pen.width_mm == pytest.approx(0.5 * share)
        mixed = [round(share * ink + (1.0 - share) * paper) for ink, paper in ((200, 0), (100, 0), (0, 100))]
        assert pen.colour == "#{:02x}{:02x}{:02x}".format(*mixed)
    for word, width, colour in (("width", 0.1, "#c86400"), ("shade", 0.5, "#f4e0cc")):
        one = vp.draw(BOXES, CAMERA, pens="contour=0.5:#c86400", depth_cue=word)
        (pen,) = [layer.pen for layer in one.layers if layer.name == "contour depth 5"]
        assert (pen.width_mm, pen.colour) == (pytest.approx(width), colour)


def test_a_plotter_takes_five_pens_for_one_colour():
    drawing = vp.draw(vp.geometry.box((1.0, 1.0, 1.0)), style="plotter", layers="colour", depth_cue="width")
    assert [layer.pen.width_mm for layer in drawing.layers] == pytest.approx([0.06, 0.12, 0.18, 0.24, 0.3])


def test_curves_keep_their_tolerance_and_hidden_lines_their_dashes():
    coil = vp.Scene((vp.Item("COIL", Helix(1.0, 0.1)), vp.Item("BALL", Sphere(0.9))))
    drawing = vp.draw(coil, CAMERA, depth_cue="width,6", curves="bezier", hidden="dashed")
    page, space, step = pieces(drawing)
    # Divided strokes end on the chords, which are within half of the tolerance.
    assert abs(imaged(drawing, space) - page).max() < 0.01
    depth = look(coil, CAMERA).points_of(space.reshape(-1, 3))[2].reshape(-1, 2)
    level = 6.0 * (depth - depth.min()) / np.ptp(depth)
    assert (level.max(axis=1) <= 7.0 - step + 0.01).all() and (level.min(axis=1) >= 6.0 - step - 0.01).all()
    names = [layer.name for layer in drawing.layers]
    assert any(name.startswith("hidden") for name in names) and "curve" in names


def test_without_depth_nothing_changes_and_lines_between_two_steps_stay_whole():
    flat = vp.Scene((vp.Item("FLAT", box((0, 0, 0), (1, 1, 1))),))
    from_above = vp.Camera((0.5, 0.5, 9), (0.5, 0.5, 0), up=(0, 1, 0), parallel=True)
    drawing = vp.draw(flat, from_above, depth_cue="width")
    assert [layer.name for layer in drawing.layers if len(layer.strokes[0])] == ["contour"]
    assert not vp.draw(vp.Scene(()), depth_cue="width").layers
    # The rails from x = 0 to 8 rise by rounding at the depth where two of two steps meet.
    ends = [((0, 0, z), (8, 0, z)) for z in (0.0, 2.0)] + [((0, 0, 1), (8, 0, 1))]
    rails = vp.Scene(tuple(vp.Item(f"RAIL{k}", Line.through(*pair)) for k, pair in enumerate(ends)))
    tilted = rails.turned("x", 37.0).scaled(1e6)
    eye = np.array([0.0, -np.sin(np.radians(37.0)), np.cos(np.radians(37.0))])
    drawn = vp.draw(tilted, vp.Camera(tuple(1e7 * eye), up=(1, 0, 0), parallel=True), depth_cue="width,2")
    assert sum(len(paths) for layer in drawn.layers for paths in layer.strokes) <= 3


@pytest.mark.slow
@pytest.mark.capability("G4.4-depthcue")
def test_paint_and_render_and_scene_files_understand_it_alike():
    said = replace(BOXES, depth_cue=DepthCue(("width", "shade"), 3))
    assert "depth_cue width shade 3" in write_scene(said)
    assert parse_scene(write_scene(said)).depth_cue == said.depth_cue
    assert parse_scene("depth_cue shade").depth_cue == DepthCue(("shade",), 5)
    for verb in (vp.draw, vp.paint):
        one, other = (
            verb(said, CAMERA, lines="contour"),
            verb(BOXES, CAMERA, lines="contour", depth_cue="width,shade,3"),
        )
        names = [layer.name for layer in one.layers if layer.name != "fills"]
        assert names == [layer.name for layer in other.layers if layer.name != "fills"]
        assert names == ["contour depth 3", "contour depth 2", "contour"]
        off = verb(said, CAMERA, lines="contour", depth_cue="none")
        assert not any(" depth " in layer.name for layer in off.layers)
    own = {"size": (80, 60), "samples": 1, "lines": "contour", "lights": ()}
    pixels, plain = vp.render(said, CAMERA, **own).pixels, vp.render(BOXES, CAMERA, **own).pixels
    assert np.array_equal(pixels, vp.render(BOXES, CAMERA, depth_cue="width,shade,3", **own).pixels)
    changed = (pixels != plain).any(axis=2).mean(axis=1)
    assert changed[:20].max() > 0.0 and changed[50:].max() == 0.0, "lines that are far away stand high in the picture"


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ("thin", "expected one of width, shade"),
        ("", "expected one of width, shade"),
        ("width,1", "1 steps, expected 2 to 32"),
        ("width,33", "33 steps, expected 2 to 32"),
        ("4", "expected width or shade"),
    ],
)
def test_what_is_no_depth_cue_is_told(wrong, told):
    for verb in (vp.draw, vp.paint, vp.render):
        with pytest.raises(vp.InputError, match=told):
            verb(BOXES, depth_cue=wrong)


def test_where_it_does_not_go_is_told(tmp_path, capsys):
    with pytest.raises(vp.InputError, match="depth_cue does not go with the style wireframe"):
        vp.draw(BOXES, style="wireframe", depth_cue="width")
    with pytest.raises(vp.InputError, match="does not go with fills that are erasing"):
        vp.paint(BOXES, fills="erasing", depth_cue="width")
    for text, told in (("depth_cue 3", "expected 'width' or 'shade', got '3'"), ("depth_cue width 99", "2 to 32")):
        with pytest.raises(vp.InputError, match=f"line 1.*{told}|:1: .*{told}"):
            parse_scene(text)
    (tmp_path / "boxes.scene").write_text(write_scene(BOXES))
    base = ["draw", str(tmp_path / "boxes.scene"), "-o", str(tmp_path / "boxes.svg")]
    assert run([*base, "--panorama", "2,2,3", "--depth-cue", "width"]) == 2
    assert "--depth-cue does not go with --panorama" in capsys.readouterr().err
    assert run([*base, "--depth-cue", "wide"]) == 2
    assert "expected one of width, shade" in capsys.readouterr().err


def test_steps_of_a_layer_that_is_not_plotted_are_not_plotted():
    drawing = vp.draw(BOXES, CAMERA, depth_cue="width", unplotted="contour")
    assert {layer.name.split()[0]: layer.plotted for layer in drawing.layers} == {"contour": False, "visible": True}


@pytest.mark.capability("G4.4-depthcue")
@pytest.mark.parametrize("word", ["svg", "pdf"])
def test_readers_see_finer_and_paler_lines_farther_away(word, tmp_path):
    posts = [vp.Item(f"POST{k}", Line.through((2.0 * k, 3.0 * k, 0), (2.0 * k, 3.0 * k, 4.0))) for k in range(3)]
    camera = vp.Camera((0, -50, 2), (3, 0, 2), parallel=True)
    file = tmp_path / f"posts.{word}"
    vp.draw(vp.Scene(tuple(posts)), camera, page="60x60", pens="2.0", depth_cue="width,shade,3").save(file)
    out = tmp_path / "read.png"
    if word == "svg":
        subprocess.run(["rsvg-convert", "-d", "254", "-p", "254", "-b", "white", file, "-o", out], check=True)
    else:
        subprocess.run(["pdftoppm", "-r", "254", "-png", "-singlefile", file, out.with_suffix("")], check=True)
    import cairo

    image = cairo.ImageSurface.create_from_png(str(out))
    gray = np.frombuffer(image.get_data(), np.uint8).reshape(image.get_height(), -1, 4)[300, : image.get_width(), 1]
    ink = 255 - gray.astype(int)
    edges = np.flatnonzero(np.diff(np.concatenate([[0], ink > 25, [0]]).astype(int)))
    widths, places = edges[1::2] - edges[::2], (edges[1::2] + edges[::2]) // 2
    # At 10 pixels to the millimetre: pens of 2, 1.2 and 0.4 mm, of 100, 60 and 20 percent of black.
    assert abs(widths - [20, 12, 4]).max() <= 1
    assert abs(ink[places] - [255, 153, 51]).max() <= 3

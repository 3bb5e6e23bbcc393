"""All verbs fit the same to a page: curves that are drawn beside faces as well as these."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.curves import Circle, Helix, Line
from vectorplot.geometry import box
from vectorplot.surfaces import Sphere

CURVES = {
    "circle": lambda r: Circle(tuple(r.normal(size=3)), 3.0 + r.uniform(), tuple(r.normal(size=3))),
    "line": lambda r: Line.through(-4.0 * r.uniform(0.5, 1, 3), 5.0 * r.uniform(0.5, 1, 3)),
    "helix": lambda r: Helix(0.3 + r.uniform(), 0.2, start=-9.0, end=14.0),
    "hidden": lambda r: Line.through((0.2, 0.2, 0.2), 0.3 + 0.5 * r.uniform(size=3)),
}
BODIES = {"cube": box((1, 1, 1)), "ball": Sphere(1.0)}


def _scene(body, curve, seed):
    random = np.random.default_rng(seed)
    items = (vp.Item("body", BODIES[body], "blue"), vp.Item("curve", CURVES[curve](random), "red"))
    way = random.normal(size=3)
    eye = tuple(14.0 * way / np.sqrt((way * way).sum()))
    return vp.Scene(items), vp.Camera(eye, (0.2, 0.1, 0.0), parallel=seed % 2 == 0)


def _corners(picture):
    """(2,8) where the corners of a box are on the page."""
    corners = np.array([(x, y, z, 1.0) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]).T
    place = np.einsum("ij,jk->ik", picture.page_from_world, corners)
    return place[:2] / place[3]


@pytest.mark.parametrize("curve", list(CURVES))
@pytest.mark.parametrize("body", list(BODIES))
def test_paintings_and_drawings_have_the_same_place(body, curve):
    scene, camera = _scene(body, curve, len(curve))
    lines = "contour,boundary,crease,curve"
    drawn = vp.draw(scene, camera, page="100x80", lines=lines)
    for fills in ("painted", "erasing") if body == "cube" else ("painted",):
        painted = vp.paint(scene, camera, page="100x80", lines=lines, fills=fills)
        assert np.abs(_corners(drawn) - _corners(painted)).max() < 0.1


@pytest.mark.parametrize("curve", list(CURVES))
def test_pictures_of_pixels_have_all_lines(curve):
    scene, camera = _scene("cube", curve, 3)
    image = vp.render(scene, camera, size=(90, 70), lines="curve", samples=1, background="#ffffff")
    pixels = np.asarray(image.pixels)
    border = np.concatenate([pixels[0], pixels[-1], pixels[:, 0], pixels[:, -1]])
    assert (border == 255).all()


def test_curves_that_are_not_drawn_take_no_room():
    scene, camera = _scene("cube", "circle", 1)
    alone = vp.Scene(scene.items[:1])
    one, two = (_corners(vp.paint(some, camera, page="100x80")) for some in (scene, alone))
    assert np.abs(one - two).max() < 1e-6


ANNOTATIONS = {
    "axes": "axes 4",
    "numbered axes": "axes 4 5 6 ticks 1",
    "arrow": 'arrow "F" from 0 0 1 to 0 0 5',
    "dimension": "dimension from 0 0 0 to 1 0 0 offset 0 -3 0",
    "leader": 'leader "text" at 1 1 1 to 4 4 4',
    "centre line": "centre_line from 0 0 -3 to 0 0 4",
    "centre mark": "centre_mark at 0 0 0 radius 5",
    "label": 'label L "text" at 1 1 6',
}


@pytest.mark.parametrize("page", ["100x80", "fit"])
@pytest.mark.parametrize("note", list(ANNOTATIONS))
def test_paintings_and_drawings_have_the_same_place_beside_annotations(tmp_path, note, page):
    (tmp_path / "a.scene").write_text(f"A gray box 1 1 1\n{ANNOTATIONS[note]}\n")
    scene = vp.read(tmp_path / "a.scene")
    drawn, painted = vp.draw(scene, page=page), vp.paint(scene, page=page)
    assert (drawn.width_mm, drawn.height_mm) == pytest.approx((painted.width_mm, painted.height_mm), abs=0.01)
    assert np.abs(_corners(drawn) - _corners(painted)).max() < 0.01


SHOWN = {
    "cube": lambda: (vp.Item("body", BODIES["cube"], "black"),),
    "ball": lambda: (vp.Item("body", BODIES["ball"], "black"),),
    "helix": lambda: (vp.Item("body", BODIES["cube"], "black"), vp.Item("curve", Helix(2.0, 0.2, end=14.0), "black")),
    "axes": lambda: (vp.Item("body", BODIES["cube"], "black"), *vp.axes(4).items),
}


@pytest.mark.parametrize("camera", [vp.Camera((9, -7, 4)), vp.Camera((9, -7, 40), (0.3, 0.2, 0.4), parallel=True)])
@pytest.mark.parametrize("margin", [0, 13])
@pytest.mark.parametrize("shown", list(SHOWN))
def test_pixels_and_strokes_on_pages_of_one_margin_fill_the_same_frame(shown, margin, camera):
    scene, lines = vp.Scene(SHOWN[shown]()), "contour,boundary,crease,curve"
    drawn = vp.draw(scene, camera, page=vp.Page(160, 120, margin), lines=lines)
    points = np.concatenate([marks.points for layer in drawn.layers for marks in layer.strokes])
    image = vp.render(
        scene, camera, size=(160, 120), margin_pixels=margin, lines=lines, samples=1, background="#ffffff"
    )
    rows, columns = np.nonzero((np.asarray(image.pixels) < 250).any(axis=2))
    found = np.array([columns.min(), 120 - rows.max() - 1, columns.max() + 1, 120 - rows.min()])
    assert np.abs(found - np.concatenate([points.min(axis=0), points.max(axis=0)])).max() < 2.0


def test_a_picture_of_pixels_has_a_margin_of_its_shorter_side():
    scene = vp.Scene(SHOWN["cube"]())
    usual, said = (vp.render(scene, size=(200, 100), samples=1, **told).pixels for told in ({}, {"margin_pixels": 3.0}))
    assert (np.asarray(usual) == np.asarray(said)).all()
    for margin in (-1.0, 50.0, np.nan):
        with pytest.raises(vp.InputError, match="margin"):
            vp.render(scene, size=(200, 100), margin_pixels=margin)

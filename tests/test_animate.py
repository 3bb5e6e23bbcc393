"""The verb animate, and what films are saved as: real readers open them."""

import pickle
import subprocess
import xml.etree.ElementTree as ET

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.animation.animation import MODES
from vectorplot.animation.animation_file import parse_animation
from vectorplot.animation.correspondence import half_extents, steady_fit
from vectorplot.backends.cairo import drawing_pixels, pdf_pages_bytes
from vectorplot.backends.svg import animated_svg_bytes, svg_bytes
from vectorplot.geometry import box
from vectorplot.io import parse_scene
from vectorplot.surfaces import Sphere

SVG = "{http://www.w3.org/2000/svg}"
DICE = parse_scene(
    "camera eye 9 -12 7 target 1.5 0 0 light direction 2 -9 9"
    " DIE red box solid 2 2 2   BRICK blue box solid 1 3 1 translation 3 0 0"
)


def film(text="frames 4 azimuth linear at 0 0 at 1 60", **given):
    return vp.animate(parse_animation(text, DICE), **{"page": "100x80", **given})


def strokes(drawing):
    """Layer, kinds, items and ends in the world of all strokes, in their order."""
    return [(layer.name, paths) for layer in drawing.layers for paths in layer.strokes if len(paths)]


@pytest.mark.slow
def test_one_fit_holds_for_the_whole_film():
    whole = film()
    pages = [drawing.page_from_world for drawing in whole]
    # The target stays in the middle of the page, at one scale.
    for page in pages:
        middle = page @ (1.5, 0, 0, 1)
        assert np.allclose(middle[:2] / middle[3], (50, 40))
    reached = np.array([half_extents(*whole.view(frame)) for frame in range(4)]).max(axis=0)
    assert whole.zoom == pytest.approx(80 / min(80 / (2 * reached[0]), 60 / (2 * reached[1])), rel=0.01)
    points = np.concatenate([paths.points for drawing in whole for _, paths in strokes(drawing)])
    low, high = points.min(axis=0), points.max(axis=0)
    assert (low >= 9.99).all() and (high <= (90.01, 70.01)).all()
    assert min((low - (10, 10)).min(), ((90, 70) - high).min()) < 0.3


def test_the_camera_s_own_scale_and_pages_of_a_width():
    assert film(fit=False).zoom == 1.0
    narrow = film(page=None, width=60).picture(0)
    assert narrow.width_mm == 60.0 and narrow.height_mm < 80.0
    inside = vp.Camera((1.0, 1.0, 1.0), (5.0, 1.0, 1.0))
    page, zoom = steady_fit([(DICE, inside)], vp.Page(100, 80))
    assert (page, zoom) == (vp.Page(100, 80), pytest.approx(80 / 60))
    assert steady_fit([], vp.Page(100, 80))[1] == pytest.approx(80 / 60)
    ball = vp.Scene((vp.Item("ball", Sphere(1.0)),))
    sides = half_extents(ball, vp.Camera((0, -10, 0), parallel=True, height=4.0))
    assert sides == pytest.approx((0.25, 0.25), rel=0.003)


def test_scenes_without_a_camera_are_seen_from_one_place():
    die = vp.Item("die", box((1, 1, 1)))
    for camera in (None, "front"):
        moving = vp.animate(vp.Animation(lambda time: die.moved(4 * time), frames=3), camera=camera, page="100x80")
        cameras = {moving.view(frame)[1] for frame in range(3)}
        assert len(cameras) == 1 and cameras.pop().target == (2.5, 0.5, 0.5)
    with pytest.raises(vp.InputError, match="did you mean 'front'"):
        vp.animate(vp.Animation(lambda time: die), camera="frnt")


@pytest.mark.capability("GA.4-anim")
@pytest.mark.parametrize("mode", MODES)
def test_a_frame_is_what_its_verb_makes_of_the_scene(mode):
    moving = film("frames 3 item DIE translation at 0 0 0 0 at 1 1 0 0", mode=mode, size=(60, 40), fit=False)
    scene, camera = moving.view(1)
    assert scene.items[0].mesh.bounds[0, 0] == 0.5
    told = {**MODES[mode].options, "fit": False}
    made = moving.picture(1)
    if mode == "pixels":
        assert np.array_equal(made.pixels, vp.render(scene, camera, size=(60, 40), **told).pixels)
        return
    verb = vp.draw if MODES[mode].verb == "draw" else vp.paint
    alone = verb(scene, camera, page="100x80", **told)
    assert [layer.name for layer in made.layers] == [layer.name for layer in alone.layers]
    for one, other in zip(made.layers, alone.layers, strict=True):
        marks = zip([*one.strokes, *one.fills], [*other.strokes, *other.fills], strict=True)
        assert all(np.array_equal(np.unique(a.points, axis=0), np.unique(b.points, axis=0)) for a, b in marks)


def test_strokes_are_the_same_in_the_same_order_from_frame_to_frame():
    """What a pen draws in one go depends on the picture: where three edges meet it would now join these, now those."""
    moving = parse_animation("frames 3 item all rotation z linear at 0 0 at 1 12", DICE)
    whole = vp.animate(moving, page="100x80")

    def ends(frame):
        """Layer, item, kind and ends, turned back, of each stroke."""
        drawing, angle = whole.picture(frame), -np.radians(6.0 * frame)
        turn = np.array([(np.cos(angle), np.sin(angle)), (-np.sin(angle), np.cos(angle))])
        found = []
        for name, paths in strokes(drawing):
            home = np.column_stack([paths.points3d[:, :2] @ turn, paths.points3d[:, 2]])
            home = np.round(home[np.stack([paths.offsets[:-1], paths.offsets[1:] - 1], axis=1)], 6) + 0.0
            columns = zip(paths.item.tolist(), paths.kind.tolist(), home.tolist(), strict=True)
            found += [(name, *column) for column in columns]
        return found

    assert len(ends(0)) == 8
    assert ends(0) == ends(1) == ends(2)


def test_frames_are_the_same_whoever_makes_them_and_in_whatever_order():
    moving = film()
    again = pickle.loads(pickle.dumps(moving))
    assert svg_bytes(again.picture(2)) == svg_bytes(moving.picture(2))


@pytest.mark.slow
def test_a_page_for_each_frame(tmp_path):
    film(title="Dice").save(tmp_path / "film.pdf")
    told = subprocess.run(["pdfinfo", tmp_path / "film.pdf"], capture_output=True, text=True, check=True).stdout
    assert "Pages:           4" in told
    subprocess.run(["pdftoppm", "-r", "30", "-png", tmp_path / "film.pdf", tmp_path / "page"], check=True)
    pages = sorted(tmp_path.glob("page-*.png"))
    assert len(pages) == 4 and len({page.read_bytes() for page in pages}) == 4
    assert pdf_pages_bytes(film()) == pdf_pages_bytes(film())


def test_a_moving_svg_has_every_frame_once_and_no_script(tmp_path):
    drawings = list(film())
    (tmp_path / "film.svg").write_bytes(animated_svg_bytes([*drawings, drawings[0]], 5.0, "Dice & more"))
    root = ET.parse(tmp_path / "film.svg").getroot()
    groups = root.findall(f"{SVG}g")
    assert len(groups) == 4 and root.find(f"{SVG}title").text == "Dice & more"
    assert [group.get("visibility") for group in groups] == [None, "hidden", "hidden", "hidden"]
    moves = [group.find(f"{SVG}animate") for group in groups]
    assert moves[0].get("values") == "visible;hidden;visible" and moves[0].get("keyTimes") == "0;0.2;0.8"
    assert moves[2].get("values") == "hidden;visible;hidden" and moves[2].get("keyTimes") == "0;0.4;0.6"
    assert {move.get("dur") for move in moves} == {"1s"}
    assert not [one for one in root.iter() if one.tag.endswith("script")]
    ids = [one.get("id") for one in root.iter() if one.get("id")]
    assert len(ids) == len(set(ids))
    # What knows no animation shows the first frame.
    vp.save(drawings[0], tmp_path / "first.svg")
    for name in ("film", "first"):
        subprocess.run(["rsvg-convert", tmp_path / f"{name}.svg", "-o", tmp_path / f"{name}.png"], check=True)
    assert (tmp_path / "film.png").read_bytes() == (tmp_path / "first.png").read_bytes()


@pytest.mark.slow
@pytest.mark.parametrize("suffix", ["mp4", "webm", "gif"])
def test_a_video_is_read_back(suffix, tmp_path):
    av = pytest.importorskip("av")
    vp.save(film("frames 4 frames_per_second 10 azimuth at 0 0 at 1 60", page="61x41"), tmp_path / f"film.{suffix}")
    with av.open(str(tmp_path / f"film.{suffix}")) as video:
        frames = [frame.to_ndarray(format="rgb24") for frame in video.decode(video=0)]
        assert float(video.streams.video[0].average_rate) == pytest.approx(10.0)
    still = film(page="61x41").picture(0)
    wanted = drawing_pixels(still)
    assert len(frames) == 4
    assert np.abs(frames[0][: len(wanted), : wanted.shape[1]].astype(int) - wanted).mean() < 4.0


@pytest.mark.slow
def test_a_folder_holds_a_file_for_each_frame(tmp_path):
    film().save(f"{tmp_path}/new/")
    assert sorted(path.name for path in (tmp_path / "new").iterdir()) == [f"000{k}.svg" for k in (1, 2, 3, 4)]
    film(mode="pixels", size=(30, 20)).save(tmp_path)
    assert len(list(tmp_path.glob("000?.png"))) == 4


def test_what_cannot_be_saved_is_told(tmp_path, monkeypatch):
    with pytest.raises(vp.InputError, match=r"frames are written as \.pdf, \.svg, \.mp4"):
        vp.save(film(), tmp_path / "film.ps")
    with pytest.raises(vp.InputError, match="frames of pixels do not go into a file of the format pdf"):
        vp.save(film(mode="pixels", size=(30, 20)), tmp_path / "film.pdf")
    monkeypatch.setitem(__import__("sys").modules, "av", None)
    with pytest.raises(
        vp.InputError, match=r"^a video needs av: pip install '\.\[video\]' in the checkout of vectorplot$"
    ):
        vp.save(film(), tmp_path / "film.mp4")
    assert not list(tmp_path.iterdir())


def test_frames_of_pixels_have_a_margin_as_pictures_have():
    die = vp.Item("die", box((1, 1, 1)), "black")
    for margin in (0.0, 12.0):
        moving = vp.animate(
            vp.Animation(lambda time: die), mode="pixels", size=(80, 60), margin_pixels=margin, samples=1
        )
        rows, columns = np.nonzero((moving.picture(0).pixels < 250).any(axis=2))
        beside = min(rows.min(), columns.min(), 59 - rows.max(), 79 - columns.max())
        assert abs(beside - margin) <= 2

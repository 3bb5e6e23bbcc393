"""Rendered pictures against closed forms: spheres, shadows, mirrors, glass; and what the plan runs and loads."""

from __future__ import annotations

import io
import struct
import sys
from dataclasses import replace

import numpy as np
import pytest
from support.rendered import SIZE, SUN, coloured_boxes, grown, levels, sphere

import vectorplot as vp
from vectorplot import render as render_verb
from vectorplot.errors import InputError
from vectorplot.pictures.pipeline import StageReport
from vectorplot.pictures.render import render
from vectorplot.save import write
from vectorplot.scene.placement import default_camera
from vectorplot.shading import scene_pixels
from vectorplot.shading.illumination import AMBIENT, DARK_SIDE, DIRECT_SHARE, FINISHES
from vectorplot.shading.palettes import PALETTE_LIMITS, palette
from vectorplot.surfaces.tori import Torus
from vectorplot.testing.shapes import box


def sphere_rays(camera, size):
    """Points of the unit sphere seen through the centres of pixels, and which pixels see it, well inside."""
    columns, rows = size
    row, column = np.indices((rows, columns))
    half = np.tan(np.radians(camera.fov_deg) / 2.0)
    x = (column - (columns - 1) / 2.0) * 2.0 * half / rows
    y = -(row - (rows - 1) / 2.0) * 2.0 * half / rows
    right, up, back = camera.axes
    way = x[..., None] * right + y[..., None] * up - back
    way /= np.linalg.norm(way, axis=-1)[..., None]
    eye = np.asarray(camera.eye)
    along = way @ eye
    root = along**2 - eye @ eye + 1.0
    inside = root > 0.05
    t = -along - np.sqrt(np.where(inside, root, 0.0))
    return eye + t[..., None] * way, inside


CAMERA = vp.Camera((3.0, -6.0, 2.0), fov_deg=25.0)


@pytest.mark.slow
@pytest.mark.capability("G8.5-phong", "G4.5-lambert")
@pytest.mark.parametrize("word", ["normal", "metallic", "plastic", "wood"])
def test_a_sphere_has_the_shades_of_its_true_normals(word):
    image = render(vp.Scene((sphere(word=word),), (SUN,)), CAMERA, size=SIZE, fit=False)
    normal, inside = sphere_rays(CAMERA, SIZE)
    light = np.array(SUN.position) / np.linalg.norm(SUN.position)
    cosine = normal @ light
    finish = FINISHES[word]
    lambert = np.where(cosine > 0.0, np.abs(cosine), 0.0) ** finish.exponent
    lambert = np.where(cosine > 0.0, lambert, DARK_SIDE * np.abs(cosine) ** finish.exponent)
    to_eye = np.asarray(CAMERA.eye) - normal
    to_eye /= np.linalg.norm(to_eye, axis=-1)[..., None]
    mirrored = 2.0 * cosine[..., None] * normal - light
    beta = np.maximum((mirrored * to_eye).sum(axis=-1), 0.0) * (cosine > 0.0)
    total = finish.diffuse * lambert + finish.highlight * 0.1 * beta**finish.sharpness
    depth = normal @ CAMERA.direction
    # The box about the sphere is what depths run over; its corners are in view coordinates those of the mesh.
    cue = AMBIENT * (depth + 1.0) / 2.0
    expected = 255.0 * np.clip(DIRECT_SHARE * np.minimum(total, 1.0) + cue, 0.0, 1.0)
    off = np.abs(levels(image) - expected)[inside]
    assert inside.mean() > 0.1
    # A sharp highlight is as wide as a few facets.
    assert np.quantile(off, 0.99) < (4.0 if finish.sharpness < 50.0 else 12.0)


@pytest.mark.parametrize("shadows", ["none", "exact"])
def test_lines_over_the_picture_agree_with_the_depth_buffer(shadows):
    items = (
        vp.Item("A", box((-1, -1, -1), (1, 1, 1)), "yellow"),
        vp.Item("B", box((0, -2, -0.5), (2, 0.5, 2)), "cyan"),
    )
    scene = vp.Scene(items, (SUN,))
    camera = vp.Camera((5, -9, 6), fov_deg=30)
    plain = render(scene, camera, size=SIZE, shadows=shadows, samples=1).pixels.astype(int)
    kinds = ("contour", "crease", "intersection")
    drawn = render(scene, camera, size=SIZE, shadows=shadows, samples=1, lines=kinds).pixels
    line = (drawn == 0).all(axis=2)
    assert line.sum() > 300
    assert (drawn[~line] == plain[~line]).all()
    # Where the visible item or the shade jumps there is a line, and there alone.
    jump = np.zeros(line.shape, dtype=bool)
    for axis in (0, 1):
        step = np.abs(np.diff(plain, axis=axis)).max(axis=2) > 12
        jump[(slice(1, None), slice(None))[:: 1 - 2 * axis]] |= step
        jump[(slice(None, -1), slice(None))[:: 1 - 2 * axis]] |= step
    if shadows == "none":
        near_line, near_jump = grown(line), grown(jump)
        assert (jump & ~near_line).sum() < 0.01 * jump.sum()
        assert (line & ~near_jump).sum() < 0.03 * line.sum()


@pytest.mark.slow
def test_pictures_say_what_their_colours_and_their_size_are():
    image = render(vp.Scene((sphere(),)), size=(30, 20))
    png = image.png()
    assert png[37:41] == b"sRGB" and png[50:54] == b"pHYs"
    assert struct.unpack(">IIB", png[54:63]) == (round(150 / 0.0254), round(150 / 0.0254), 1)
    assert replace(image, dpi=300.0).png()[54:58] == struct.pack(">I", 11811)
    plate = vp.paint(vp.Scene((sphere(),)), page=vp.Page(40, 30, 2))
    assert write(plate, "png")[33:67] == png[33:67], "drawings saved as pixels say the same"


def test_two_samples_a_side_and_the_mean_of_their_light():
    scene = vp.Scene((vp.Item("A", box((-1, -1, -1), (1, 1, 1)), "#000000"),))
    usual, two, one = (render(scene, size=(80, 60), samples=n).pixels for n in (None, 2, 1))
    assert (usual == two).all() and not (one == two).all()
    # Of black and white a quarter, a half and three quarters: of the light, not of the numbers.
    assert set(np.unique(two).tolist()) == {0, 137, 188, 225, 255}


@pytest.mark.slow
@pytest.mark.capability("G7.3-strips")
def test_pictures_in_bands_are_the_whole_ones(monkeypatch):
    scene = replace(coloured_boxes(), lights=(SUN,))
    options = {"size": (97, 61), "samples": 3, "shadows": "buffer"}
    whole = render(scene, **options)
    monkeypatch.setattr(sys.modules["vectorplot.pictures.pixels"], "BAND_PIXELS", 97 * 9 * 4)
    monkeypatch.setattr(scene_pixels, "POINTS_AT_ONCE", 500)
    bands = render(scene, **options)
    assert (whole.pixels == bands.pixels).all()


def test_samples_are_averaged_and_edges_get_softer():
    scene = vp.Scene((vp.Item("A", box((-1, -1, -1), (1, 1, 1)), "#000000"),))
    coarse, fine = (levels(render(scene, size=(60, 45), samples=n)) for n in (1, 4))
    assert len(np.unique(fine)) > len(np.unique(coarse))
    assert np.abs(coarse - fine).mean() < 10.0


@pytest.mark.hard(18, 19)
@pytest.mark.parametrize(("scale", "shift"), [(1e-6, 0.0), (1e6, 0.0), (1.0, 1e6)])
def test_scale_and_place_change_nothing(scale, shift):
    def picture_of(scale, shift):
        place = np.diag([scale, scale, scale, 1.0])
        place[:3, 3] = shift
        items = (
            vp.Item("A", box((-1, -1, -1), (1, 1, 1)).transformed(place), "yellow"),
            vp.Item("B", box((0.5, -2, -1), (0.8, -1.5, 1)).transformed(place), "cyan"),
        )
        lamp = vp.Light(tuple(scale * np.array((-3.0, -6.0, 5.0)) + shift), intensity=0.8)
        camera = vp.Camera(tuple(scale * np.array((4.0, -7.0, 5.0)) + shift), (shift, shift, shift))
        return render(vp.Scene(items, (lamp,)), camera, size=SIZE, shadows="exact").pixels.astype(int)

    assert (np.abs(picture_of(scale, shift) - picture_of(1.0, 0.0)).max(axis=2) > 2).mean() < 2e-3


@pytest.mark.hard(32)
def test_the_order_of_items_changes_nothing():
    scene = replace(coloured_boxes(), lights=(SUN,))
    turned = replace(scene, items=scene.items[::-1])
    one, other = (render(s, size=SIZE, shadows="buffer").pixels.astype(int) for s in (scene, turned))
    assert (np.abs(one - other).max(axis=2) > 1).mean() < 1e-3


@pytest.mark.slow
def test_smooth_surfaces_show_no_facets():
    scene = vp.Scene((vp.Item("RING", Torus(3.0, 1.2), "gray"),), (SUN,))
    image = levels(render(scene, vp.Camera((0, -12, 9), fov_deg=40), size=(240, 180)))
    inside = image < 255
    inner = ~grown(~inside) & ~grown(grown(np.abs(np.diff(image, axis=1, prepend=image[:, :1])) > 40))
    across = np.abs(np.diff(image, n=2, axis=1))[:, :-1]
    assert np.quantile(across[inner[:, 1:-2]], 0.99) < 8.0


class EnoughIsKnown(Exception):
    """The rest of a picture need not be rendered."""


@pytest.mark.slow
@pytest.mark.parametrize("camera", [vp.Camera((0, -12, 9), fov_deg=170), vp.Camera((0, -1200, 900))])
def test_triangles_are_small_in_fitted_pictures_from_afar_too(camera):
    counts = []
    for eye in (vp.Camera((0, -12, 9), fov_deg=30), camera):
        scene = vp.Scene((vp.Item("RING", Torus(3.0, 1.2), "gray"),), (SUN,))
        stages = {}

        def told(report: StageReport, found: dict[str, int] = stages) -> None:
            found.setdefault(report.name, report.count)
            if report.name == "look":
                raise EnoughIsKnown

        with pytest.raises(EnoughIsKnown):
            render(scene, eye, size=(400, 300), explain=told)
        counts.append(stages["look"])
    assert counts[1] > 0.7 * counts[0]


@pytest.mark.slow
def test_meshes_look_round_up_to_the_crease_angle():
    from vectorplot.testing.shapes import torus_mesh

    scene = vp.Scene((vp.Item("RING", torus_mesh(36, 18), "gray"),), (SUN,))
    camera = default_camera(scene)
    round_, flat = (
        levels(render(scene, camera, size=(240, 180), crease_angle_deg=angle, background="gray"))
        for angle in (30.0, 0.0)
    )
    # Within a flat face nothing changes, from face to face much does; a round one changes a little everywhere.
    jumps = [(np.abs(np.diff(image, axis=1)) > 6.0).mean() for image in (round_, flat)]
    assert jumps[0] < 0.5 * jumps[1]


@pytest.mark.slow
def test_the_background_is_the_scenes_or_the_users():
    scene = vp.Scene((sphere("blue"),), background="yellow")
    assert render(scene, size=(20, 20)).pixels[0, 0].tolist() == palette("yellow")[-1].tolist()
    assert render(scene, size=(20, 20), background="#102030").pixels[0, 0].tolist() == [16, 32, 48]
    assert render(replace(scene, background=None), size=(20, 20)).pixels[0, 0].tolist() == [255, 255, 255]
    assert "blue" in PALETTE_LIMITS
    with pytest.raises(InputError, match="colour"):
        render(scene, background="mauve")


@pytest.mark.hard(57)
def test_the_same_scene_gives_the_same_bytes():
    scene = replace(coloured_boxes(), lights=(SUN, vp.Light((3.0, 2.0, 6.0))))
    first, second = (write(render(scene, size=(60, 45), lines=("contour",)), "png") for _ in range(2))
    assert first == second


@pytest.mark.hard(55)
def test_an_empty_scene_is_a_blank_picture():
    image = render(vp.Scene(()), vp.Camera((0, -1, 0)), size=(7, 5), shadows="buffer", lines=("contour",), samples=2)
    assert (image.pixels == 255).all()
    assert image.pixels.shape == (5, 7, 3)


@pytest.mark.slow
def test_the_picture_saves_and_shows_itself(tmp_path):
    pillow = pytest.importorskip("PIL.Image")
    scene = vp.Scene((sphere("green"),), (SUN,), title="A ball")
    image = vp.render(scene, size=(60, 40))
    vp.save(image, tmp_path / "ball.png")
    read = np.asarray(pillow.open(tmp_path / "ball.png").convert("RGB"))
    assert (read == image.pixels).all()
    assert (np.asarray(pillow.open(io.BytesIO(image._repr_png_()))) == image.pixels).all()
    assert "60 x 40" in repr(image)
    assert vp.render(scene, size=(60, 40)).png() == image.png(), "the same bytes"
    with pytest.raises(InputError, match="png"):
        vp.save(image, tmp_path / "ball.svg")
    assert callable(render_verb)


@pytest.mark.slow
@pytest.mark.capability("G8.5-coloured-light")
def test_coloured_light_colours_what_it_falls_on_and_its_highlights():
    red, cyan = (replace(SUN, colour=colour, intensity=1.0) for colour in ("#ff0000", "#00ffff"))
    item = sphere("gray", "plastic")
    white = render(vp.Scene((item,), (SUN,)), CAMERA, size=SIZE).pixels.astype(int)
    in_red = render(vp.Scene((item,), (red,)), CAMERA, size=SIZE).pixels.astype(int)
    both = render(vp.Scene((item,), (red, cyan)), CAMERA, size=SIZE).pixels.astype(int)
    ball = (white != 255).any(axis=2)
    assert (in_red[..., 0] == white[..., 0])[ball].all()
    assert (in_red[..., 1] <= white[..., 1])[ball].all()
    brightest = np.unravel_index(np.where(ball, white[..., 0], 0).argmax(), ball.shape)
    assert in_red[brightest][0] > in_red[brightest][1] + 100, "the highlight has the light's colour"
    assert (both == white)[ball].all(), "red and cyan make white"
    with pytest.raises(InputError, match="mauve"):
        render(vp.Scene((item,), (replace(SUN, colour="mauve"),)), CAMERA, size=SIZE)

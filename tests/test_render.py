"""Rendered pictures against closed forms: spheres, shadows, mirrors, glass; and what the plan runs and loads."""

from __future__ import annotations

import io
import struct
import subprocess
import sys
from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

import vectorplot as vp
from vectorplot import render as render_verb
from vectorplot.curves.circle import Circle
from vectorplot.draw import default_camera
from vectorplot.errors import InputError, InputWarning
from vectorplot.geometry.mesh import Mesh
from vectorplot.plan import StageReport, chosen_shadows, plan_render
from vectorplot.render import render
from vectorplot.save import write
from vectorplot.shading.light.illumination import AMBIENT, DARK_SIDE, DIRECT_SHARE, FINISHES
from vectorplot.shading.light.palettes import PALETTE_LIMITS, palette
from vectorplot.shading.raster import scene_pixels
from vectorplot.surfaces.families.ellipsoid import Sphere
from vectorplot.surfaces.families.spiral import spiral_surface
from vectorplot.surfaces.families.torus import Torus
from vectorplot.testing.shapes import box

SUN = vp.Light((-1.0, -2.0, 2.5), parallel=True, intensity=1.0)
SIZE = (160, 120)
FINE = (240, 180)
"""For borders of shadows."""


def sphere(colour="gray", word="normal", radius=1.0):
    return vp.Item("BALL", Sphere(radius), colour, vp.Material(word))


def levels(image):
    """(rows, columns) the level of gray."""
    return image.pixels[..., 0].astype(np.float64)


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


def blocks_on_a_floor(light):
    """Closed bodies that stand on one another."""
    random = np.random.default_rng(1)
    lows = [(x, y, 0.0) for x, y in random.uniform(-4, 4, (6, 2))]
    blocks = [box(low, np.add(low, (0.8, 0.8, 0.2 + 0.3 * k))) for k, low in enumerate(lows)]
    items = [vp.Item(f"B{k}", shape) for k, shape in enumerate([box((-6, -6, -1), (6, 6, 0)), *blocks])]
    return vp.Scene(tuple(items), (light,))


def inside_out(mesh):
    return Mesh.from_polygons(mesh.vertices, [polygon[::-1] for polygon in mesh.polygons()])


MAP_LIGHTS = {
    "sun": vp.Light((-3, -4, 4), parallel=True, intensity=1.0),
    "lamp": vp.Light((-6, -7, 9), intensity=1.0),
    "lamp amid the scene": vp.Light((0.5, 0.3, 2.5), intensity=1.0),
}


@pytest.mark.slow
@pytest.mark.capability("N6-z")
@pytest.mark.parametrize("shadows", ["buffer", "trapezoid"])
@pytest.mark.parametrize("light", MAP_LIGHTS)
def test_maps_of_what_turns_away_from_the_light_show_the_same_shadows_without_a_margin(shadows, light):
    camera = vp.Camera((6, -11, 9), (0, 0, 0), fov_deg=35)
    scene = blocks_on_a_floor(MAP_LIGHTS[light])

    def picture_of(some, **options):
        return levels(render(some, camera, size=(160, 120), samples=1, shadow_size=512, **options)).astype(int)

    exact = picture_of(scene, shadows="exact")
    away = picture_of(scene, shadows=shadows, shadow_casters="away")
    assert (np.abs(away - exact) > 20).mean() < 0.005
    turned = replace(scene, items=tuple(replace(item, shape=inside_out(item.shape)) for item in scene.items))
    assert (picture_of(turned, shadows=shadows, shadow_casters="away") == away).mean() > 0.999
    first = scene.items[1].shape
    gaping = Mesh(first.vertices, first.corners, first.offsets, np.arange(first.face_count) > 0)
    opened = replace(scene, items=(scene.items[0], vp.Item("OPEN", gaping), *scene.items[2:]))
    both = [picture_of(opened, shadows=shadows, shadow_casters=word) for word in ("all", "away")]
    assert (both[0] == both[1]).all(), "which way the faces of an open body turn nobody knows"


@pytest.mark.capability("R-nonsquare")
def test_maps_that_grow_with_what_is_in_focus_have_fewer_wrong_pixels():
    random = np.random.default_rng(1)
    blocks = [
        box((x, y, 0), (x + 0.8, y + 0.8, 0.5 + 0.2 * k)) for k, (x, y) in enumerate(random.uniform(-9, 9, (12, 2)))
    ]
    items = [vp.Item(f"B{k}", shape) for k, shape in enumerate([box((-30, -30, -1), (30, 30, 0)), *blocks])]
    scene = vp.Scene(tuple(items), (vp.Light((5, 2, 6), parallel=True, intensity=1.0),))
    camera = vp.Camera((0, -14, 5), (0, 0, 0), fov_deg=35)

    def picture_of(**options):
        return levels(render(scene, camera, size=(160, 120), fit=False, samples=1, shadow_size=64, **options)).astype(
            int
        )

    exact = picture_of(shadows="exact")
    wrong = [(np.abs(picture_of(shadows="trapezoid", shadow_focus=f) - exact) > 20).mean() for f in (None, 0.2, 0.95)]
    assert wrong[0] == wrong[1], "what is in focus has more of the map than that"
    assert wrong[2] < wrong[0]


def floor_scene(lights):
    """A ball over a square floor."""
    plate = vp.Item("FLOOR", box((-6, -6, -1.2), (6, 6, -1.0)), "gray")
    return vp.Scene((sphere(), plate), lights)


def floor_places(camera, size):
    """Points of the plane z = -1 seen through the centres of pixels, and which of them are on the floor, unhidden."""
    columns, rows = size
    row, column = np.indices((rows, columns))
    half = np.tan(np.radians(camera.fov_deg) / 2.0)
    right, up, back = camera.axes
    x, y = (column - (columns - 1) / 2.0) * 2 * half / rows, -(row - (rows - 1) / 2.0) * 2 * half / rows
    way = x[..., None] * right + y[..., None] * up - back
    eye = np.asarray(camera.eye)
    place = eye + way * ((-1.0 - eye[2]) / way[..., 2])[..., None]
    unit = way / np.linalg.norm(way, axis=-1)[..., None]
    hidden = np.linalg.norm(np.cross(eye, unit), axis=-1) < 1.02
    return place, ~hidden & (np.abs(place[..., :2]).max(axis=-1) < 5.9)


def off_the_ball(place, light):
    """How far the middle of the ball is from the rays from points to a light."""
    to_light = np.broadcast_to(light.position, place.shape) if light.parallel else np.array(light.position) - place
    return np.linalg.norm(np.cross(place, to_light / np.linalg.norm(to_light, axis=-1)[..., None]), axis=-1)


@pytest.mark.slow
@pytest.mark.capability("G8.6-shadow-buffer", "RN-in-B8.6")
@pytest.mark.parametrize("shadows", ["buffer", "trapezoid", "exact"])
@pytest.mark.parametrize("light", [SUN, vp.Light((-2.0, -4.0, 5.0), intensity=1.0)], ids=["sun", "lamp"])
def test_the_shadow_of_a_ball_is_where_geometry_puts_it(shadows, light):
    camera = vp.Camera((2.0, -9.0, 8.0), (0, 0, -1), fov_deg=35.0)
    scene = floor_scene((light,))
    with_, without = (
        levels(render(scene, camera, size=FINE, fit=False, shadows=how, shadow_size=1024)) for how in (shadows, "none")
    )
    place, floor = floor_places(camera, FINE)
    miss = off_the_ball(place, light)
    dark, lit = floor & (miss < 0.95), floor & (miss > 1.05)
    assert dark.sum() > 300
    assert (with_[dark] < 0.6 * without[dark]).all()
    assert (with_ == without)[lit].mean() > 0.999


@pytest.mark.slow
@pytest.mark.capability("G8.6-shadow-buffer")
@pytest.mark.parametrize("shadows", ["buffer", "trapezoid", "exact"])
def test_shades_fall_with_the_number_of_lights_that_are_blocked(shadows):
    lights = tuple(
        vp.Light((2.0 * np.cos(a), 2.0 * np.sin(a), 3.0), parallel=True, intensity=0.3) for a in (0.3, 1.0, 1.7)
    )
    camera = vp.Camera((0.0, -9.0, 9.0), (0, 0, -1), fov_deg=35.0)
    options = {"size": FINE, "fit": False, "samples": 1, "shadow_size": 1024}
    shaded, lit = (levels(render(floor_scene(lights), camera, shadows=how, **options)) for how in (shadows, "none"))
    place, floor = floor_places(camera, FINE)
    miss = np.array([off_the_ball(place, light) for light in lights])
    sure, blocked = floor & (np.abs(miss - 1.0) > 0.06).all(axis=0), (miss < 1.0).sum(axis=0)
    share = [(shaded / np.maximum(lit, 1.0))[sure & (blocked == count)] for count in range(4)]
    assert min(map(len, share)) > 200 and (share[0] == 1.0).all()
    assert all(more.max() < fewer.min() - 0.1 for fewer, more in pairwise(share))


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


def grown(mask):
    padded = np.pad(mask, 1)
    rows, columns = mask.shape
    return np.logical_or.reduce([padded[i : i + rows, j : j + columns] for i in range(3) for j in range(3)])


def coloured_boxes():
    """Boxes in plain colours before, beside and behind a mirror in the plane x = 0, which faces +x."""
    mirror = vp.Item("GLASS", box((-0.1, -3, -3), (0, 3, 3)), "gray", vp.Material("mirror"))
    boxes = [
        vp.Item("RED", box((1, -1, -1), (2, 0, 0)), "#ff0000"),
        vp.Item("GREEN", box((2.5, 0.5, -1), (3.5, 1.5, 1)), "#00ff00"),
        vp.Item("BLUE", box((-3, -1, -1), (-2, 1, 1)), "#0000ff"),
    ]
    return vp.Scene((mirror, *boxes))


def test_a_mirror_shows_what_mirrored_rays_meet():
    scene = coloured_boxes()
    camera = vp.Camera((7.0, -5.0, 2.5), (0, 0, 0), fov_deg=40.0)
    image = render(scene, camera, size=SIZE, fit=False).pixels.astype(int)
    columns, rows = SIZE
    row, column = np.indices((rows, columns))
    half = np.tan(np.radians(40.0) / 2.0)
    right, up, back = camera.axes
    x, y = (column - (columns - 1) / 2.0) * 2 * half / rows, -(row - (rows - 1) / 2.0) * 2 * half / rows
    way = x[..., None] * right + y[..., None] * up - back
    eye = np.asarray(camera.eye)
    boxes = [((1, -1, -1), (2, 0, 0)), ((2.5, 0.5, -1), (3.5, 1.5, 1))]

    def met(origin, way):
        """The box that a ray meets first, 0 or 1, or -1."""
        best, number = np.full(way.shape[:-1], np.inf), np.full(way.shape[:-1], -1)
        for index, (low, high) in enumerate(boxes):
            with np.errstate(divide="ignore"):
                a, b = (low - origin) / way, (high - origin) / way
            enter, leave = np.minimum(a, b).max(axis=-1), np.maximum(a, b).min(axis=-1)
            hit = (enter < leave) & (leave > 0) & (enter < best)
            best, number = np.where(hit, enter, best), np.where(hit, index, number)
        return number

    direct = met(eye, way)
    place = eye + way * (-eye[0] / way[..., 0])[..., None]
    on = (direct < 0) & (np.abs(place[..., 1]) < 2.95) & (np.abs(place[..., 2]) < 2.95)
    seen = met(place, way * (-1, 1, 1))
    strongest = image.argmax(axis=2)
    shows = np.where(image.max(axis=2) > image.min(axis=2) + 20, strongest, -1)
    right_pixels = (shows == seen)[on]
    assert on.sum() > 4000
    assert (seen[on] >= 0).sum() > 500
    assert right_pixels.mean() > 0.97
    inner = ~grown(np.abs(np.diff(np.pad(seen, ((0, 0), (1, 0)), mode="edge"), axis=1)) > 0)
    assert (shows == seen)[on & inner].mean() > 0.985
    assert not (shows == 2)[on].any(), "what is behind the mirror is not in it"


@pytest.mark.slow
def test_a_mirror_shows_glass_before_what_is_behind_it():
    plain = coloured_boxes()
    camera = vp.Camera((7.0, -5.0, 2.5), (0, 0, 0), fov_deg=40.0)
    # Beside the eye's way to the mirror, between the mirror and the boxes.
    pane = vp.Item(
        "PANE", box((0.4, -1.5, -1.5), (0.42, 0.7, 0.2)), "#000000", vp.Material(opacity=0.5), occludes=False
    )
    clear = replace(plain, items=(*plain.items, pane))
    none, veiled = (render(s, camera, size=SIZE, fit=False).pixels.astype(int) for s in (plain, clear))
    changed = (none != veiled).any(axis=2)
    alone = replace(plain, items=tuple(i for i in clear.items if i.name != "GLASS"))
    without = replace(plain, items=plain.items[1:])
    direct = (
        render(alone, camera, size=SIZE, fit=False).pixels != render(without, camera, size=SIZE, fit=False).pixels
    ).any(axis=2)
    doubled = changed & ~direct
    assert doubled.sum() > 300
    assert (veiled[doubled] <= none[doubled]).all(), "a black veil only darkens"
    assert (veiled[doubled] > 0).any(axis=1).mean() > 0.9, "and lets light through"


def test_glass_is_a_veil_before_what_is_behind_it():
    back = vp.Item("BACK", box((-2, 2, -2), (2, 2.1, 2)), "#ffffff")
    panes = [
        vp.Item(
            f"PANE{k}",
            box((-1, -k, -1), (1, 0.01 - k, 1)),
            "#000000",
            vp.Material("normal", opacity=0.5),
            occludes=False,
        )
        for k in range(2)
    ]
    camera = vp.Camera((0, -12, 0), (0, 0, 0), fov_deg=20.0)
    light = vp.Light((0, -1, 0), parallel=True, intensity=1.0)
    veiled = levels(render(vp.Scene((back, *panes), (light,)), camera, size=FINE, fit=False, shadows="none"))
    middle, rim = (90, 120), (90, 60)
    # Two panes halve the light twice: closed bodies are seen from outside only.
    assert veiled[rim] > 200.0
    assert veiled[middle] == pytest.approx(veiled[rim] / 4.0, abs=2.0)
    turned = levels(render(vp.Scene((*panes[::-1], back), (light,)), camera, size=FINE, fit=False, shadows="none"))
    assert np.abs(turned - veiled).max() <= 1.0, "whatever their order"


@pytest.mark.slow
@pytest.mark.parametrize("inside_out", [False, True])
def test_a_closed_body_is_one_veil_and_an_open_one_a_veil_for_every_layer(inside_out):
    cube = box((-1, -1, -1), (1, 1, 1))
    if inside_out:
        cube = Mesh.from_polygons(cube.vertices, [face[::-1].tolist() for face in cube.corners.reshape(-1, 4)])
    lid = Mesh(cube.vertices, cube.corners[4:], cube.offsets[:-1])
    glass = vp.Material(opacity=0.5)
    for camera in (vp.Camera((3, -7, 5)), vp.Camera((3, -7, 5), parallel=True, height=4.0)):
        pictures = [
            levels(render(vp.Scene((vp.Item("A", mesh, "black", glass),)), camera, size=(80, 60), fit=False))
            for mesh in (cube, lid)
        ]
        closed, open_ = (set(np.unique(picture).tolist()) for picture in pictures)
        assert {128.0, 255.0} <= closed and 64.0 not in closed
        assert {64.0, 128.0, 255.0} <= open_
    within = render(vp.Scene((vp.Item("A", cube, "black", glass),)), vp.Camera((0, 0.5, 0), (0, -1, 0)), fit=False)
    assert set(np.unique(within.pixels).tolist()) == {128}, "an eye in a body sees its walls"


@pytest.mark.slow
def test_a_plane_that_a_light_sees_alone_does_not_shadow_itself():
    wall = vp.Item("WALL", box((-2, 2, -2), (2, 2.1, 2)), "#ffffff")
    for place in ((0, -1, 0), (0.3, -1, 0.2), (0, -1e6, 0)):
        for samples in (1, 2, 3):
            light = vp.Light(place, parallel=True, intensity=1.0)
            camera = vp.Camera((0, -12, 0), (0, 0, 0), fov_deg=20.0)
            picture = render(vp.Scene((wall,), (light,)), camera, size=SIZE, samples=samples, shadows="buffer")
            plain = render(vp.Scene((wall,), (light,)), camera, size=SIZE, samples=samples, shadows="none")
            assert (picture.pixels == plain.pixels).all()


def test_what_is_not_rendered_is_said_in_one_line():
    rug = vp.Pattern("RUG", "red", 1, np.array([(0, 0), (0.5, 0), (0.5, 0.5)]))
    decorated = vp.Item("A", box((-1, -1, -1), (1, 1, 1)), patterns=(rug,))
    lens = vp.Item("B", box((2, -1, -1), (3, 1, 1)), material=vp.Material("transparent", refraction=1.5))
    for items, words in (
        ((decorated,), "patterns"),
        ((lens,), "refraction"),
        ((decorated, lens), "patterns.*refraction"),
    ):
        with pytest.warns(InputWarning, match=f"^not rendered: {words}") as told:
            render(vp.Scene(items), size=(20, 20))
        assert len(told) == 1
    render(vp.Scene((decorated,)), size=(20, 20), lines=("pattern",))
    reports = []
    render(replace(coloured_boxes(), lights=(SUN,)), size=(20, 20), explain=reports.append)
    assert any(report.name == "left out" and "mirrors" in report.why for report in reports)


@pytest.mark.slow
def test_pictures_say_what_their_colours_and_their_size_are():
    image = render(vp.Scene((sphere(),)), size=(30, 20))
    png = image.png()
    assert png[37:41] == b"sRGB" and png[50:54] == b"pHYs"
    assert struct.unpack(">IIB", png[54:63]) == (round(150 / 0.0254), round(150 / 0.0254), 1)
    assert replace(image, dpi=300.0).png()[54:58] == struct.pack(">I", 11811)
    plate = vp.paint(vp.Scene((sphere(),)))
    assert write(plate, "png")[33:67] == png[33:67], "drawings saved as pixels say the same"


def test_two_samples_a_side_and_the_mean_of_their_light():
    scene = vp.Scene((vp.Item("A", box((-1, -1, -1), (1, 1, 1)), "#000000"),))
    usual, two, one = (render(scene, size=(80, 60), samples=n).pixels for n in (None, 2, 1))
    assert (usual == two).all() and not (one == two).all()
    # Of black and white a quarter, a half and three quarters: of the light, not of the numbers.
    assert set(np.unique(two).tolist()) == {0, 137, 188, 225, 255}


@pytest.mark.capability("G7.3-strips")
def test_pictures_in_bands_are_the_whole_ones(monkeypatch):
    scene = replace(coloured_boxes(), lights=(SUN,))
    options = {"size": (97, 61), "samples": 3, "shadows": "buffer"}
    whole = render(scene, **options)
    monkeypatch.setattr(sys.modules["vectorplot.render"], "BAND_PIXELS", 97 * 9 * 4)
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
    image = levels(render(scene, vp.Camera((0, -12, 9), fov_deg=40), size=(400, 300)))
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
            found[report.name] = report.count
            if report.name == "look":
                raise EnoughIsKnown

        with pytest.raises(EnoughIsKnown):
            render(scene, eye, size=(400, 300), explain=told)
        counts.append(stages["look"])
    assert counts[1] > 0.7 * counts[0]


@pytest.mark.slow
def test_meshes_look_round_up_to_the_crease_angle():
    from vectorplot.testing.curved_meshes import torus_mesh

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


@pytest.mark.parametrize("shadows", ["none", "auto", "buffer", "trapezoid", "exact"])
@pytest.mark.parametrize(
    ("light", "message"),
    [
        (vp.Light((np.nan, 0, 1)), "range"),
        (vp.Light((np.inf, 0, 1), parallel=True), "range"),
        (vp.Light((1e300, 0, 1)), "range"),
        (vp.Light((0, 0, 0), parallel=True, name="SUN"), "SUN"),
    ],
)
def test_impossible_lights_are_refused(light, message, shadows):
    with pytest.raises(InputError, match=message):
        render(vp.Scene((sphere(),)), size=(20, 20), lights=[light], shadows=shadows)


@pytest.mark.parametrize("intensity", [np.nan, -1.0])
def test_impossible_intensities_are_refused(intensity):
    with pytest.raises(InputError, match="intensity"):
        vp.Light((0, 0, 9), intensity=intensity)


@pytest.mark.slow
@pytest.mark.hard(33)
@pytest.mark.parametrize("shadows", ["auto", "buffer", "trapezoid", "exact"])
def test_a_lamp_in_the_eye_shows_no_shadow_and_one_in_a_box_lights_nothing_outside(shadows):
    camera = vp.Camera((5, -9, 6), fov_deg=30)
    items = (vp.Item("A", box((-1, -1, -1), (1, 1, 1)), "cyan"), vp.Item("P", box((-4, -4, -2), (4, 4, -1))))

    def picture_of(place, shadows):
        lamp = vp.Light(place, intensity=1.0)
        return levels(render(vp.Scene(items, (lamp,)), camera, size=SIZE, fit=False, shadows=shadows, samples=1))

    eye = [picture_of(camera.eye, how) for how in (shadows, "none")]
    assert (np.abs(eye[0] - eye[1]) > 2).mean() < 2e-3
    inside = [picture_of((0.1, 0.0, 0.2), how) for how in (shadows, "exact")]
    assert (np.abs(inside[0] - inside[1]) > 2).mean() < 5e-3
    plate = (picture_of((0.1, 0.0, 0.2), "none") - inside[0]) > 2
    assert plate.sum() > 2000, "the walls of the box stop its light"


@pytest.mark.parametrize(
    "options",
    [
        {"size": (2.5, 5)},
        {"size": (float("nan"), 5)},
        {"samples": 1.5},
        {"shadow_size": 100.5},
        {"shadow_size": float("nan")},
        {"size": (0, 5)},
        {"size": (40_000, 5)},
        {"samples": 0},
        {"samples": 99},
        {"shadows": "soft"},
        {"lines": ("wobble",)},
        {"crease_angle_deg": -1.0},
        {"shadows": "buffer", "shadow_bits": 7},
        {"shadows": "buffer", "shadow_size": 10**6},
        {"shadow_casters": "front"},
        {"shadow_focus": 0.0},
        {"shadow_focus": 1.5},
        {"shadow_focus": float("nan")},
        {"size": (20_000, 20_000)},
    ],
)
def test_what_makes_no_picture_is_refused(options):
    with pytest.raises(InputError):
        render(vp.Scene((sphere(),), (SUN,)), **({"size": (20, 20)} | options))


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


def stage_names(scene, *, shadows="none", lines=False):
    return [stage.name for stage in plan_render(scene, shadows, lines)]


GLASS = vp.Item("PANE", box((-1, -1, -1), (1, 1, 1)), material=vp.Material(opacity=0.5))
PLATE = vp.Item("PLATE", box((-50, -50, -1), (50, 50, 0)))
BRICK = vp.Item("BRICK", box((-1, -1, 0), (1, 1, 1)))
FAR = vp.Camera((0, -30, 20), fov_deg=10.0)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("items", "lights", "camera", "fit", "expected", "why"),
    [
        ((BRICK,), (), FAR, True, "none", "no light"),
        ((BRICK,), (replace(SUN, intensity=0.0),), FAR, True, "none", "no light"),
        ((GLASS,), (SUN,), FAR, True, "none", "nothing"),
        ((BRICK,), (SUN,), FAR, True, "buffer", "about as far"),
        ((BRICK,), (SUN,), FAR, False, "buffer", "about as far"),
        ((PLATE, BRICK), (SUN,), vp.Camera((0, -200, 60)), True, "buffer", "about as far"),
        ((PLATE, BRICK), (SUN,), vp.Camera((0, -90, 20)), True, "trapezoid", "times as far"),
        ((PLATE, BRICK), (SUN,), vp.Camera((0, -48, -0.5)), True, "trapezoid", "amid"),
        ((PLATE, BRICK), (SUN,), vp.Camera((0, -9, 9), parallel=True), True, "buffer", "about as far"),
        ((PLATE, BRICK), (SUN,), vp.Camera((0, -9, 9), parallel=True, height=9.0), False, "trapezoid", "a part"),
        ((PLATE, BRICK), (SUN,), vp.Camera((0, -900, 90), fov_deg=1.0), False, "trapezoid", "a part"),
        ((), (SUN,), FAR, True, "none", "nothing"),
    ],
)
def test_the_view_calls_for_its_shadows(items, lights, camera, fit, expected, why):
    scene = vp.Scene(items, lights)
    word, reason = chosen_shadows(scene, camera, SIZE, fit)
    assert word == expected
    assert why in reason
    reports = []
    automatic = render(scene, camera, size=SIZE, fit=fit, explain=reports.append)
    said = [report.why for report in reports if report.name == "shadows"]
    assert said == [] if word == "none" else reason in said[0]
    assert (automatic.pixels == render(scene, camera, size=SIZE, fit=fit, shadows=word).pixels).all()


@pytest.mark.slow
def test_progress_never_goes_back(monkeypatch):
    monkeypatch.setattr(sys.modules["vectorplot.render"], "BAND_PIXELS", 240 * 20)
    told = []
    scene = replace(coloured_boxes(), lights=(SUN,))
    render(scene, size=SIZE, progress=lambda stage, part: told.append((part, stage)))
    parts = [part for part, _ in told]
    assert parts[0] == 0.0
    assert parts[-1] == pytest.approx(1.0)
    assert len(parts) > 60
    assert (np.diff(parts) > -1e-12).all(), told
    assert max(np.diff(parts)) < 0.2


def test_only_the_stages_that_the_scene_calls_for_run():
    plain = vp.Scene((vp.Item("A", box((-1, -1, -1), (1, 1, 1))),))
    assert stage_names(plain) == ["look", "triangles", "coplanar", "depth", "shading", "average"]
    assert "shadows" not in stage_names(plain, shadows="exact"), "no light that casts"
    assert "facets" in stage_names(vp.Scene((sphere(),)))
    assert "mirrors" in stage_names(coloured_boxes())
    reports = []
    render(replace(plain, lights=(SUN,)), size=(20, 20), shadows="buffer", lines=("crease",), explain=reports.append)
    assert [report.name for report in reports] == [
        *("look", "triangles", "shadows", "coplanar", "depth", "shading", "lines", "average")
    ]


@pytest.mark.slow
def test_a_plain_picture_loads_no_effect_and_nothing_heavy():
    script = """
import sys
import vectorplot as vp
from vectorplot.testing.shapes import box
vp.render(vp.Scene((vp.Item("A", box((0, 0, 0), (1, 1, 1))),), (vp.Light((1, -2, 3)),)), size=(20, 20), shadows="none")
print(*(name for name in sys.modules if name.split(".")[0] in ("cairo", "scipy", "shapely", "svgwrite", "skimage")
        or name.startswith(("vectorplot.effects", "vectorplot.backends", "vectorplot.shading.shadows.shadow",
                            "vectorplot.shading.shadows.trapezoid", "vectorplot.shading.shadows.seen"))))
"""
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    assert result.stdout.split() == []


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


SHELLS = {
    "nautilus": (Circle((1.0, 0, 0), 0.52, axis=(0, 1, 0)), 0.175),
    "snail": (Circle((0.62, 0, -1.25), 0.5, axis=(0.15, 1, 0)), 0.085),
}


@cache
def shell_seen(name, whorl, shadows):
    """The levels of a shell that begins so many whorls further, from an eye as much further away."""
    circle, growth = SHELLS[name]
    turn, size = 2.0 * np.pi * whorl, np.exp(2.0 * np.pi * growth * whorl)
    shell = spiral_surface(circle, growth, start=turn - 4.0 * np.pi, end=turn)
    lights = (vp.Light((-5, -3, 2.5), parallel=True, intensity=1.0),)
    scene = vp.Scene((vp.Item("SHELL", shell, "orange", vp.Material("plastic")),), lights)
    camera = vp.Camera(tuple(size * np.array((2.0, -5.0, 9.0))), (0, 0, 0), fov_deg=30)
    return levels(render(scene, camera, shadows=shadows, size=(90, 70), samples=1, shadow_size=256))


@pytest.mark.slow
@pytest.mark.capability("G8.6-nautilus")
@pytest.mark.parametrize("shadows", ["buffer", "trapezoid", "exact"])
@pytest.mark.parametrize("name", SHELLS)
def test_a_shell_a_whorl_further_is_the_same_picture_enlarged(shadows, name):
    """Spiral surfaces are similar to themselves; so are their shadows on themselves."""
    pictures = [[shell_seen(name, whorl, how) for how in (shadows, "none")] for whorl in (0, 1, -2)]
    for shaded, plain in pictures[1:]:
        assert np.abs(shaded - pictures[0][0]).mean() < 0.5 and np.abs(plain - pictures[0][1]).mean() < 0.3
    shaded, plain = pictures[0]
    assert (shaded <= plain + 2).all() and (shaded < plain - 10).sum() > 3, "its whorls shade each other"

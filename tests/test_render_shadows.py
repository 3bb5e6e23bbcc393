"""Shadows of rendered pictures against closed forms, and which kind of them a view calls for."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from support.rendered import FINE, GLASS, SIZE, SUN, inside_out, levels, sphere

import vectorplot as vp
from vectorplot.curves.families import Circle
from vectorplot.geometry.mesh import Mesh
from vectorplot.pictures.plan import chosen_shadows
from vectorplot.pictures.render import render
from vectorplot.surfaces.swept import spiral_surface
from vectorplot.testing.shapes import box


def blocks_on_a_floor(light):
    """Closed bodies that stand on one another."""
    random = np.random.default_rng(1)
    lows = [(x, y, 0.0) for x, y in random.uniform(-4, 4, (6, 2))]
    blocks = [box(low, np.add(low, (0.8, 0.8, 0.2 + 0.3 * k))) for k, low in enumerate(lows)]
    items = [vp.Item(f"B{k}", shape) for k, shape in enumerate([box((-6, -6, -1), (6, 6, 0)), *blocks])]
    return vp.Scene(tuple(items), (light,))


MAP_LIGHTS = {
    "sun": vp.Light((-3, -4, 4), parallel=True, intensity=1.0),
    "lamp": vp.Light((-6, -7, 9), intensity=1.0),
    "lamp amid the scene": vp.Light((0.5, 0.3, 2.5), intensity=1.0),
}


@pytest.mark.slow
@pytest.mark.capability("N6-z")
@pytest.mark.spread
@pytest.mark.parametrize("shadows", ["buffer", "trapezoid", "perspective"])
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


@pytest.mark.slow
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


@cache
def floor_seen(lights, camera, shadows):
    """The levels of its picture."""
    options = {"size": FINE, "fit": False, "samples": 1, "shadow_size": 512}
    return levels(render(floor_scene(lights), camera, shadows=shadows, **options))


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
@pytest.mark.spread
@pytest.mark.parametrize("shadows", ["buffer", "trapezoid", "perspective", "exact"])
@pytest.mark.parametrize("light", [SUN, vp.Light((-2.0, -4.0, 5.0), intensity=1.0)], ids=["sun", "lamp"])
def test_the_shadow_of_a_ball_is_where_geometry_puts_it(shadows, light):
    camera = vp.Camera((2.0, -9.0, 8.0), (0, 0, -1), fov_deg=35.0)
    with_, without = (floor_seen((light,), camera, how) for how in (shadows, "none"))
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
    shaded, lit = (floor_seen(lights, camera, how) for how in (shadows, "none"))
    place, floor = floor_places(camera, FINE)
    miss = np.array([off_the_ball(place, light) for light in lights])
    sure, blocked = floor & (np.abs(miss - 1.0) > 0.06).all(axis=0), (miss < 1.0).sum(axis=0)
    share = [(shaded / np.maximum(lit, 1.0))[sure & (blocked == count)] for count in range(4)]
    assert min(map(len, share)) > 200 and (share[0] == 1.0).all()
    assert all(more.max() < fewer.min() - 0.1 for fewer, more in pairwise(share))


@pytest.mark.slow
def test_a_plane_that_a_light_sees_alone_does_not_shadow_itself():
    wall = vp.Item("WALL", box((-2, 2, -2), (2, 2.1, 2)), "#ffffff")
    for place in ((0, -1, 0), (0.3, -1, 0.2), (0, -1e6, 0)):
        for samples in (1, 2, 3):
            light = vp.Light(place, parallel=True, intensity=1.0)
            camera = vp.Camera((0, -12, 0), (0, 0, 0), fov_deg=20.0)
            picture, plain = (
                render(vp.Scene((wall,), (light,)), camera, size=(112, 84), samples=samples, shadows=how)
                for how in ("buffer", "none")
            )
            assert (picture.pixels == plain.pixels).all()


@pytest.mark.slow
@pytest.mark.hard(33)
@pytest.mark.spread(parts=2)
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
    said = [report.why for report in reports if report.name == "shadows" and report.error is None]
    assert said == [] if word == "none" else reason in said[0]
    assert (automatic.pixels == render(scene, camera, size=SIZE, fit=fit, shadows=word).pixels).all()


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
@pytest.mark.spread
@pytest.mark.parametrize("shadows", ["buffer", "trapezoid", "exact"])
@pytest.mark.parametrize("name", SHELLS)
def test_a_shell_a_whorl_further_is_the_same_picture_enlarged(shadows, name):
    """Spiral surfaces are similar to themselves; so are their shadows on themselves: one shell grows, one shrinks."""
    (shaded, plain), (further, plain_further) = (
        [shell_seen(name, whorl, how) for how in (shadows, "none")] for whorl in (0, {"nautilus": 1, "snail": -2}[name])
    )
    assert np.abs(further - shaded).mean() < 0.5 and np.abs(plain_further - plain).mean() < 0.3
    assert (shaded <= plain + 2).all() and (shaded < plain - 10).sum() > 3, "its whorls shade each other"

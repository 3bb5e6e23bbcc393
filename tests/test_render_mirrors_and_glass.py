"""Mirrors and glass in rendered pictures, against rays and against what is behind them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.rendered import FINE, SIZE, coloured_boxes, grown, levels

import vectorplot as vp
from vectorplot.geometry.mesh import Mesh
from vectorplot.pictures.render import render
from vectorplot.testing.shapes import box


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


@pytest.mark.slow
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
    eye = vp.Camera((0, 0.5, 0), (0, -1, 0))
    within = render(vp.Scene((vp.Item("A", cube, "black", glass),)), eye, size=(80, 60), fit=False)
    assert set(np.unique(within.pixels).tolist()) == {128}, "an eye in a body sees its walls"


@pytest.mark.capability("G6.6-screen-door")
@pytest.mark.parametrize("samples", [1, 2])
@pytest.mark.parametrize(("opacity", "every"), [(0.5, 2), (0.34, 3), (0.25, 4), (0.05, 4)])
def test_sparse_glass_sets_every_nth_pixel_and_leaves_the_others(opacity: float, every: int, samples: int) -> None:
    wall = vp.Item("WALL", box((-9, 2, -9), (9, 2.1, 9)), "white")
    pane = vp.Item("PANE", box((-9, 0, -9), (9, 0.1, 9)), "blue")
    camera = vp.Camera((0.0, -8.0, 0.0), (0.0, 0.0, 0.0), fov_deg=40.0)
    bare, covered, sparse = (
        render(
            vp.Scene((wall, replace(pane, material=vp.Material("transparent", share)))),
            camera,
            size=(48, 36),
            fit=False,
            shadows="none",
            samples=samples,
            transparency="sparse",
        ).pixels.astype(int)
        for share in (0.0, 1.0, opacity)
    )
    through = np.abs(sparse - bare).max(axis=2) <= 2
    coloured = np.abs(sparse - covered).max(axis=2) <= 2
    assert (through ^ coloured).all()
    assert coloured.mean() == 1.0 / every
    assert not (coloured[:, 1:] & coloured[:, :-1]).any()


def test_what_is_opaque_or_wholly_clear_is_the_same_where_glass_is_sparse() -> None:
    scene = coloured_boxes()
    camera = vp.Camera((7.0, -5.0, 2.5), (0, 0, 0), fov_deg=40.0)
    one, other = (render(scene, camera, size=(60, 45), transparency=word).pixels for word in ("blended", "sparse"))
    assert np.array_equal(one, other)

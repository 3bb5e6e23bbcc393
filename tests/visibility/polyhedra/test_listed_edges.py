"""A list of edges chooses the edges that are drawn."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from support.drawn import drawn

import vectorplot as vp
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import write_scene
from vectorplot.testing import assert_drawings_equal

CUBE = """C gray {form} vertices 0 0 0, 2 0 0, 2 2 0, 0 2 0, 0 0 2, 2 0 2, 2 2 2, 0 2 2
edges {edges} faces 4 3 2 1, 5 6 7 8, 1 2 6 5, 2 3 7 6, 3 4 8 7, 4 1 5 8"""
RINGS = "1 2, 2 3, 3 4, 4 1, 5 6, 6 7, 7 8, 8 5"
UPRIGHTS = "1 5, 2 6, 3 7, 4 8"
CAMERA = vp.Camera((9, 7, 6), (1, 1, 1))


def cube(edges: str, form: str = "general") -> vp.Scene:
    return parse_scene(CUBE.format(edges=edges, form=form))


@pytest.mark.parametrize("form", ["general", "solid", ""])
@pytest.mark.parametrize("style", ["lines", "wireframe", "depth-cue"])
def test_a_cube_without_its_uprights_shows_eight_edges(style: str, form: str) -> None:
    how = {"hidden": "solid"} if style == "lines" else {"style": style}
    found = drawn(vp.draw(cube(RINGS, form), CAMERA, **how))
    rises = np.ptp(found.world[:, :, 2], axis=1)
    assert rises.max() < 1e-9
    assert np.isclose(found.length, 8 * 2.0)


@pytest.mark.parametrize("verb", ["draw", "paint"])
@pytest.mark.parametrize(("edges", "shown"), [(UPRIGHTS, 3), ("7 8", 1), ("1 2", 0), ("none", 0)])
def test_listed_edges_are_hidden_as_others_are(verb: str, edges: str, shown: int) -> None:
    lines = {"lines": ("contour", "crease")}
    found = drawn(getattr(vp, verb)(cube(edges), CAMERA, **lines))
    assert np.isclose(found.length, 2.0 * shown)


def test_all_edges_listed_in_any_order_are_no_list_at_all() -> None:
    listed = cube(f"5 1, {UPRIGHTS}, {RINGS}")
    bare = replace(listed, items=tuple(replace(item, drawn_edges=None) for item in listed.items))
    assert_drawings_equal(vp.draw(listed, CAMERA, hidden="dashed"), vp.draw(bare, CAMERA, hidden="dashed"))


def test_listed_flat_edges_are_drawn_as_creases() -> None:
    text = "C gray general vertices 0 0 0, 1 0 0, 2 0 0, 2 2 0, 1 2 0, 0 2 0 edges {} faces 1 2 5 6, 2 3 4 5"
    camera = vp.Camera((1, 1, 9), (1, 1, 0))
    for edges, kinds in [("2 5", {"crease"}), ("2 5, 1 2", {"crease", "boundary"}), ("1 2", {"boundary"})]:
        found = drawn(vp.draw(parse_scene(text.format(edges)), camera))
        assert {kind for kind in ("crease", "boundary", "contour") if len(found.of_kind(kind))} == kinds


@pytest.mark.parametrize("move", [lambda s: s, lambda s: s.moved(3, -1, 2).scaled(1.7), lambda s: s.turned("z", 33.0)])
def test_lists_move_with_their_bodies_and_are_cut_with_them(move: object) -> None:
    scene = vp.cut(cube(RINGS), "x + y > 2.5")
    whole = drawn(vp.draw(move(scene), vp.Camera.view("iso")))
    bare = replace(scene, items=tuple(replace(item, drawn_edges=None) for item in scene.items))
    rest = drawn(vp.draw(move(bare), vp.Camera.view("iso")))
    # Two uprights are left that are seen: those of the cut face are drawn.
    upright = (np.ptp(rest.world[:, :, 2], axis=1) > 1e-6).sum() - (np.ptp(whole.world[:, :, 2], axis=1) > 1e-6).sum()
    assert upright > 0 and len(whole.of_kind("cut")) == len(rest.of_kind("cut")) > 0


def test_lists_are_written_as_they_were_read() -> None:
    for edges in (RINGS, "none"):
        once = cube(edges)
        again = parse_scene(write_scene(once))
        assert np.array_equal(once.items[0].drawn_edges, again.items[0].drawn_edges)


DIAGONALS = "5 7, 1 3, 1 7, 2 7"
"""On the top, on the bottom, in space, and on the side x = 2, of which the camera sees the first and the last."""


@pytest.mark.capability("G3.3-edge-list")
@pytest.mark.parametrize("form", ["general", "solid"])
@pytest.mark.parametrize("verb", ["draw", "paint"])
def test_listed_segments_that_are_no_edges_are_drawn_and_hidden_too(verb: str, form: str) -> None:
    scene = cube(DIAGONALS, form)
    found = drawn(getattr(vp, verb)(scene, CAMERA, lines=("contour", "crease")))
    assert np.isclose(found.length, 2 * 8.0**0.5)
    every = drawn(vp.draw(scene, CAMERA, hidden="solid"))
    assert np.isclose(every.length, 3 * 8.0**0.5 + 12.0**0.5)
    again = parse_scene(write_scene(scene))
    assert np.array_equal(scene.items[0].added_edges, again.items[0].added_edges)


def test_listed_segments_are_cut_with_their_bodies() -> None:
    whole = cube("5 7")
    half = vp.cut(whole, "x > 0.5, y > 0.5")
    found = drawn(vp.draw(half, CAMERA, lines=("crease",), hidden="solid"))
    level = np.ptp(found.world[:, :, 2], axis=1) < 1e-9
    along = np.abs(found.world[:, :, 0] - found.world[:, :, 1]).max(axis=1) < 1e-9
    ends = found.world[level & along]
    assert np.isclose(np.hypot(*(ends[:, 1] - ends[:, 0]).T[:2]).sum(), 0.5 * 2.0**0.5)
    moved = drawn(vp.draw(whole.moved(3, 1, 0), CAMERA, lines=("crease",), hidden="solid"))
    assert np.isclose(moved.length, 8.0**0.5)


@pytest.mark.parametrize(
    ("limits", "left"), [({"near": 8.0}, 0.5), ({"far": 8.0}, 0.5), ({"near": 7.5, "far": 8.5}, 0.5)]
)
def test_listed_segments_are_cut_by_near_and_far(limits: dict[str, float], left: float) -> None:
    # Through the middle of the body, along the line of sight, and one across it.
    scene = cube("1 7")
    camera = vp.Camera((1, 1, 9), (1, 1, 1), up=(0, 1, 0), **limits)
    found = drawn(vp.draw(scene, camera, lines=("crease",), hidden="solid"))
    slant = np.ptp(found.world, axis=1).min(axis=1) > 1e-9
    assert np.isclose(
        np.sqrt(((found.world[slant][:, 1] - found.world[slant][:, 0]) ** 2).sum(axis=1)).sum(), left * 12.0**0.5
    )

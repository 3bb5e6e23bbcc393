"""Scenes written and read again."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.effort import examples
from support.paths import DATA

from vectorplot.curves.curve import is_curve
from vectorplot.errors import InputError
from vectorplot.geometry.camera import Camera
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.solids import box
from vectorplot.io.scene_language import parse_scene, read_scene
from vectorplot.io.scene_writer import curve_text, surface_text, write_scene
from vectorplot.scene.item import Item, Pattern
from vectorplot.scene.light import Light
from vectorplot.scene.material import Material
from vectorplot.scene.page import Page
from vectorplot.scene.scene import Scene
from vectorplot.words import COLOURS, MATERIALS


def words(shape):
    return curve_text(shape) if is_curve(shape) else surface_text(shape)


def plain(scene):
    """All that a scene holds, as values that compare."""
    items = [
        (
            item.name, item.colour, item.material, item.lines, item.hides,
            item.mesh.vertices.tolist(), item.mesh.polygons(),
            None if item.mesh.present is None else item.mesh.present.tolist(),
            "" if isinstance(item.shape, Mesh) else words(item.shape), item.curves,
            [(p.name, p.colour, p.face, p.points.tolist()) for p in item.patterns],
        )
        for item in scene.items
    ]  # fmt: skip
    return items, scene.lights, scene.camera, scene.page, scene.background, scene.title


# What the reader takes: no more than 1e60, and no extents below its reciprocal.
number = st.floats(min_value=-1e60, max_value=1e60).map(lambda x: x if abs(x) > 1e-40 else 0.0)
length = st.floats(1e-3, 1e4)
point = st.tuples(number, number, number)
colour = st.one_of(st.sampled_from(sorted(COLOURS)), st.sampled_from(["#102030", "#FFffFF"]))
name = st.one_of(
    st.text(max_size=12), st.sampled_from(["box", "camera", "3", "A B", "gray", "none", "HOUSE_1", '"', "#"])
)


@st.composite
def meshes(draw):
    vertices = draw(st.lists(point, max_size=7))
    face = st.lists(st.integers(0, max(len(vertices) - 1, 0)), min_size=3, max_size=5)
    faces = draw(st.lists(face, max_size=5)) if vertices else []
    present = draw(st.lists(st.booleans(), min_size=len(faces), max_size=len(faces)))
    return Mesh.from_polygons(np.array(vertices).reshape(-1, 3), faces, present=present)


@st.composite
def items(draw):
    shape = draw(meshes())
    patterns = []
    if shape.face_count:
        corner = st.tuples(number, number)
        for _ in range(draw(st.integers(0, 2))):
            points = np.array(draw(st.lists(corner, min_size=3, max_size=4)))
            patterns.append(Pattern(draw(name), draw(colour), draw(st.integers(0, shape.face_count - 1)), points))
    material = Material(
        draw(st.sampled_from(sorted(set(MATERIALS.values())))), draw(st.floats(0, 1)), draw(st.floats(0.1, 3))
    )
    lines = draw(st.one_of(st.none(), st.lists(st.sampled_from(["contour", "crease", "edges"]), max_size=3)))
    return Item(
        draw(name), shape, draw(colour), material, tuple(patterns), None if lines is None else tuple(lines),
        draw(st.booleans()),
    )  # fmt: skip


cameras = st.builds(
    Camera,
    eye=st.tuples(st.floats(1, 9), st.floats(1, 9), st.floats(1, 9)),
    up=st.one_of(st.none(), st.just((0.0, 0.1, 1.0))),
    twist_deg=st.floats(-360, 360),
    fov_deg=st.floats(1, 170),
    parallel=st.booleans(),
    height=st.one_of(st.none(), length),
)
lights = st.builds(
    Light,
    position=point.filter(any),
    parallel=st.booleans(),
    intensity=st.one_of(st.none(), st.floats(0, 1)),
    name=name,
    colour=st.sampled_from(["white", "red", "lightcyan", "#102030"]),
)
pages = st.builds(Page, st.floats(30, 2000), st.floats(30, 2000), st.floats(0, 14))
scenes = st.builds(
    Scene,
    items=st.lists(items(), max_size=3).map(tuple),
    lights=st.lists(lights, max_size=2).map(tuple),
    camera=st.one_of(st.none(), cameras),
    page=st.one_of(st.none(), pages),
    background=st.one_of(st.none(), colour),
    title=st.text(max_size=12),
)


@pytest.mark.slow
@pytest.mark.capability("G3.6-write")
@settings(max_examples=examples(150))
@given(scenes)
def test_what_is_written_is_read_again_to_the_last_bit(scene):
    text = write_scene(scene)
    again = parse_scene(text)
    assert plain(again) == plain(scene)
    assert text.isascii()
    assert write_scene(again) == text


@pytest.mark.capability("G3.6-write")
@pytest.mark.parametrize("path", sorted(DATA.glob("*.scene")), ids=lambda path: path.stem)
def test_scenes_of_the_gallery_survive_writing(path):
    scene = read_scene(path)
    assert plain(parse_scene(write_scene(scene))) == plain(scene)


def test_the_text_is_readable():
    scene = Scene((Item("TRAY", box((3, 3, 1), caps=("bottom",)), "gray"),), title="A tray")
    assert write_scene(scene).splitlines()[:4] == [
        'title "A tray"',
        "TRAY gray general normal opacity 1.0 occludes yes",
        "vertices",
        "  0.0 0.0 0.0 ,",
    ]
    assert write_scene(scene).endswith("\nremoved_faces 6\n")


def test_words_that_the_language_lacks_are_refused():
    with pytest.raises(InputError, match="material 'glass'"):
        Item("A", box((1, 1, 1)), material=Material("glass"))
    with pytest.raises(InputError, match="line kind 'ridges'"):
        Item("A", box((1, 1, 1)), lines=("ridges",))

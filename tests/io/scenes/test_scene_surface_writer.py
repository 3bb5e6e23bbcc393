"""Surfaces written into scene files and read again."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from support.sample_surfaces import FAMILIES, same_surface

from vectorplot.curves.families import Helix, Line
from vectorplot.curves.placed_curves import PlacedCurve
from vectorplot.errors import InputError
from vectorplot.io.scene_language import parse_scene
from vectorplot.io.scene_writer import surface_text, write_scene
from vectorplot.scene.item import Item
from vectorplot.scene.light import Light
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import Section, SurfaceLines
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.graphs import Disc, graph
from vectorplot.surfaces.implicit import implicit_of_function
from vectorplot.surfaces.inversion import InvertedSurface
from vectorplot.surfaces.placed_surface import PlacedImplicit, PlacedSurface
from vectorplot.surfaces.quadrics import Cylinder, Sphere
from vectorplot.surfaces.surface import Domain
from vectorplot.surfaces.swept import revolution_surface
from vectorplot.surfaces.tori import ImplicitTorus, ImplicitTorusByDistance, Torus
from vectorplot.surfaces.trimmed import TrimmedSurface
from vectorplot.testing.shapes import box

number = st.floats(-1e6, 1e6)
length = st.floats(1e-3, 1e3)
point = st.tuples(number, number, number)
FORMS = np.array([[0.0, 2.0, 0.0], [-1.0, 0.0, 0.5], [0.0, 0.0, 3.0]])


def again(shape, curves=None, lights=()):
    item = Item("A", shape) if curves is None else Item("A", shape, curves=curves)
    scene = parse_scene(write_scene(Scene((item,), lights)))
    return scene.items[0]


@pytest.mark.capability("G3.6-write")
@pytest.mark.parametrize("text", [text for text, _ in FAMILIES])
def test_what_the_language_names_is_written_and_read_again(text):
    first = parse_scene(f"A surface {text} rotation x 30 translation 1 2 3")
    written = write_scene(first)
    second = parse_scene(written)
    assert same_surface(second.items[0].shape, first.items[0].shape)
    assert write_scene(second) == written and written.isascii()


@pytest.mark.slow
@given(length, length, point, length, length)
def test_numbers_keep_every_digit(major, minor, centre, bottom, height):
    torus = again(Torus(major, minor, centre)).shape
    assert (torus.major, torus.minor, tuple(torus.centre)) == (major, minor, centre)
    pipe = again(Cylinder(major, bottom, bottom + height, centre, depth=minor)).shape
    assert (pipe.radius, pipe.depth, pipe.bottom, pipe.top) == (major, minor, bottom, bottom + height)


@given(st.floats(-7.0, 7.0), st.floats(0.01, 6.0))
def test_angles_are_right_to_rounding(start, size):
    shape = TrimmedSurface(Torus(), u=(start, start + size))
    part = again(shape).shape
    assert np.allclose(part.u, (start, start + size), rtol=4e-16, atol=0.0)


def test_angles_that_were_degrees_are_so_again():
    text = surface_text(parse_scene("A surface sphere u 10 350.1 v -33.3 77").items[0].shape)
    assert text == "sphere 1.0 u 10.0 350.1 v -33.3 77.0"


def test_places_keep_every_digit():
    for placed, whole in ((PlacedSurface, Torus()), (PlacedImplicit, ImplicitTorus())):
        shape = again(placed(whole, FORMS, (0.1, 0.2, 0.3))).shape
        assert isinstance(shape, placed)
        assert np.array_equal(shape.matrix, FORMS) and np.array_equal(shape.shift, (0.1, 0.2, 0.3))
    twice = PlacedSurface(PlacedSurface(Torus(), FORMS, (1, 2, 3)), FORMS, (4, 5, 6))
    assert same_surface(again(twice).shape, twice)


@pytest.mark.parametrize(
    "line", [Line((1, 0, -1), (0, 1, 2)), Line((1, 0.1, -1), (0.3, 1, -2), -2.0, 3.0), Line((0, 1e9, 1), (0.1, 0.1, 1))]
)
def test_lines_keep_their_parameters(line):
    assert same_surface(again(revolution_surface(line)).shape, revolution_surface(line))


@pytest.mark.slow
@given(
    st.lists(st.floats(-1.0, 1.0), max_size=4),
    st.lists(st.tuples(point.filter(any), st.lists(number, min_size=1, max_size=3)), max_size=3),
    st.integers(0, 100),
    st.integers(0, 100),
)
def test_lines_on_surfaces_are_written(cosines, sections, columns, rows):
    planes = tuple(Section(normal, tuple(offsets)) for normal, offsets in sections)
    light = 1 if cosines else None
    curves = SurfaceLines(columns, rows, tuple(cosines), light, planes)
    lights = (Light((0, 0, 1), name="2"), Light((1, 0, 1), name=""))
    assert again(Sphere(), curves, lights).curves == curves


@pytest.mark.parametrize(
    ("shape", "message"),
    [
        (graph(np.hypot, Domain(0, 1, 0, 1)), "A: function hypot is Python and no formula"),
        (surface_of_function(lambda u, v: (u, v, u * v), Domain(0, 1, 0, 1)), "Python"),
        (implicit_of_function(lambda x, y, z: x, [[0] * 3, [1] * 3]), "Python"),
        (graph(np.hypot, Disc(1.0)), "region"),
        (ImplicitTorusByDistance(), "no word for a ImplicitTorusByDistance"),
        (InvertedSurface(Sphere(), (3, 0, 0), 1.0), "inverted surface"),
        (revolution_surface(PlacedCurve(Helix(1.0, 1.0), FORMS)), "no word for the curve PlacedCurve"),
        (TrimmedSurface(Cylinder(), v=(0.0, 0.5)), "part in v of a Cylinder"),
    ],
)
def test_surfaces_that_the_language_lacks_are_refused(shape, message):
    with pytest.raises(InputError, match=message):
        write_scene(Scene((Item("A", shape),)))


def test_lines_that_cannot_be_read_again_are_not_written():
    with pytest.raises(InputError, match="A: isophotes: there is no light 3"):
        write_scene(Scene((Item("A", Torus(), curves=SurfaceLines(isophotes=(0.0,), light=2)),)))
    with pytest.raises(InputError, match=r"A: .* surfaces only"):
        write_scene(Scene((Item("A", box((0, 0, 0), (1, 1, 1)), curves=SurfaceLines(columns=2)),)))

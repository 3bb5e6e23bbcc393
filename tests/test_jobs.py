"""On however many threads a picture is made, it is the same to the last bit."""

from functools import cache

import pytest

import vectorplot as vp
from vectorplot.save import write
from vectorplot.surfaces import Sphere
from vectorplot.testing.shapes import bumpy_icosphere, rotated_boxes

LAMP = vp.Light((6.0, -5.0, 8.0))
MANY = (1, 5)


@cache
def scenes():
    small = vp.Scene((vp.Item("ball", Sphere(1.0)), vp.Item("lump", bumpy_icosphere(3))), lights=(LAMP,))
    return {"boxes": rotated_boxes(400), "lump": vp.Scene((vp.Item("lump", bumpy_icosphere(6)),)), "both": small}


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("name", list(scenes()))
@pytest.mark.parametrize("hidden", ["none", "dashed"])
def test_drawings(name, hidden):
    scene = scenes()[name]
    assert len({write(vp.draw(scene, jobs=jobs, hidden=hidden, halo_mm=0.3), "json") for jobs in MANY}) == 1


@pytest.mark.slow
def test_paintings():
    scene = scenes()["boxes"]
    made = {write(vp.paint(scene, jobs=jobs, lines="contour", tolerance_mm=1.0), "json") for jobs in MANY}
    assert len(made) == 1


@pytest.mark.slow
@pytest.mark.parametrize("shadows", ["none", "buffer", "exact"])
def test_renderings(shadows):
    scene = scenes()["both"]
    made = {
        write(vp.render(scene, jobs=jobs, size=(160, 120), samples=2, shadows=shadows, lines="contour"), "png")
        for jobs in MANY
    }
    assert len(made) == 1


@pytest.mark.slow
def test_hatching_that_flows():
    hatch = vp.Hatching("tone", along="slope")
    made = {write(vp.draw(bumpy_icosphere(2), jobs=jobs, hatch=hatch, page="64x64"), "json") for jobs in MANY}
    assert len(made) == 1


@pytest.mark.parametrize("verb", [vp.draw, vp.paint, vp.render])
def test_no_threads_are_too_few(verb):
    with pytest.raises(vp.InputError, match="0 jobs: expected 1 or more"):
        verb(scenes()["both"], jobs=0)

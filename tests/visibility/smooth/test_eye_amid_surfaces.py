"""The eye amid smooth surfaces that reach behind it: what is behind the eye hides nothing, what is before it does."""

import numpy as np
import pytest
from support.effort import several

import vectorplot as vp
from vectorplot.surfaces import Cylinder, HyperbolicParaboloid, Paraboloid, Sphere, Torus
from vectorplot.testing import assert_drawing_is_right

SHAPES = (
    *(Torus(4.0, 1.2), Cylinder(2.0, -6.0, 6.0), Sphere(3.0)),
    *(HyperbolicParaboloid(), Torus(1.5, 0.4), Paraboloid(1.0, 1.0, 1.0)),
)


def amid(seed: int) -> tuple[vp.Scene, vp.Camera]:
    """Three surfaces about an eye among them."""
    random = np.random.default_rng(seed)
    items = []
    for number, which in enumerate(random.choice(len(SHAPES), 3, replace=False)):
        x, z = random.uniform(0.0, 360.0, 2).tolist()
        item = vp.Item(f"I{number}", SHAPES[which]).turned("x", x).turned("z", z)
        items.append(item.moved(*random.uniform(-1.5, 1.5, 3).tolist()))
    eye, target = random.uniform(-1.2, 1.2, 3), random.uniform(-5.0, 5.0, 3)
    return vp.Scene(tuple(items)), vp.Camera(tuple(eye), tuple(target), fov_deg=float(random.uniform(30.0, 110.0)))


@pytest.mark.slow
@pytest.mark.parametrize("seed", several((3, 13, 17, 24), long=range(100)))
@pytest.mark.filterwarnings("ignore::vectorplot.errors.InputWarning")
def test_rays_confirm_what_an_eye_amid_surfaces_sees(seed: int) -> None:
    scene, camera = amid(seed)
    assert_drawing_is_right(vp.draw(scene, camera, hidden="solid", fit=False), scene, camera, samples=300)


@pytest.mark.parametrize("eye", [(0.3, 0.2, -2.0), (-1.5, 0.0, 1.0)])
def test_an_eye_in_a_tube_sees_nothing_of_a_ring_around_it(eye: tuple[float, float, float]) -> None:
    scene = vp.Scene((vp.Item("TUBE", Cylinder(2.0, -6.0, 6.0)), vp.Item("RING", Torus(4.0, 0.5))))
    drawing = vp.draw(scene, vp.Camera(eye, (3.0, 1.0, 0.5), fov_deg=70.0), fit=False)
    assert not any(len(mark) for layer in drawing.layers for mark in layer.strokes)

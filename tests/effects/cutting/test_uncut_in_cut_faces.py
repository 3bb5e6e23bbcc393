"""Where an uncut body comes out of the cut face of another one there is a line."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot.geometry import box
from vectorplot.surfaces import Sphere, Torus, rod

CAMERA = vp.Camera((7.0, -11.0, 6.0), (0.0, 0.0, 0.0))
INNER = {
    "ball": vp.Item("I", Sphere(0.7)).moved(3, 0, 0),
    "box": vp.Item("I", box((1, 1, 1))).moved(2.5, -0.5, -0.5),
    "cylinder": vp.Item("I", rod((3, -0.8, 0), (3, 0.8, 0), 0.6)),
    "torus": vp.Item("I", Torus(0.7, 0.25)).moved(3, 0, 0),
}
OUTER = {
    "ball": vp.Item("O", Sphere(5)),
    "box": vp.Item("O", box((10, 8, 6))).moved(-5, -4, -3),
    "torus": vp.Item("O", Torus(3, 1.5)),
}


@pytest.mark.slow
@pytest.mark.spread
@pytest.mark.parametrize("outer", OUTER)
@pytest.mark.parametrize("inner", INNER)
def test_an_uncut_body_meets_the_cut_face_it_comes_out_of(inner, outer):
    scene = vp.Scene((OUTER[outer], INNER[inner]))
    drawing = vp.draw(vp.cut(scene, "y < 0", items=["O"]), CAMERA)
    points = [one.points3d for layer in drawing.layers if layer.name == "intersection" for one in layer.strokes]
    assert points, "no line"
    found = np.concatenate(points)
    on = found[np.abs(found[:, 1]) < 1e-6]
    assert len(on) >= 3
    assert (np.abs(on[:, [0, 2]] - (3, 0)) < 1.0).all()
    assert np.ptp(on[:, 0]) > 0.8

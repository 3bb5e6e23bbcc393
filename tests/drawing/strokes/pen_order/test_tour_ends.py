import numpy as np

from vectorplot.drawing.strokes.pen_order.tour_ends import curves_through


def test_curves_that_are_put_right_are_those_found_anew():
    rng = np.random.default_rng(5)
    spots, layer = rng.random(500) + 1j * rng.random(500), np.repeat([0, 3], 250)
    before = curves_through(spots, layer)
    spots[::50] = rng.random(10) + 1j * rng.random(10)
    for anew, right in zip(curves_through(spots, layer), curves_through(spots, layer, before), strict=True):
        np.testing.assert_array_equal(right, anew)

import numpy as np
import pytest

from vectorplot.scene.page import Page
from vectorplot.scene.placement import centred, fitted

A4 = Page()


def on_page(matrix, *points):
    mapped = np.column_stack((np.array(points, dtype=float), np.ones(len(points)))) @ matrix.T
    assert np.all(mapped[:, 2] == 1.0)
    return mapped[:, :2]


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_a_fitted_picture_fills_the_page_but_for_its_margin(scale):
    low, high = np.array([-3.0, 2.0]) * scale, np.array([5.0, 4.0]) * scale
    corners = on_page(fitted(A4, low, high), low, high, (low[0], high[1]))
    np.testing.assert_allclose(corners[:2, 0], [10, 200])
    np.testing.assert_allclose(corners[:2].mean(axis=0), [105, 148.5])
    assert np.isclose(corners[1, 1] - corners[0, 1], 190 / 4)


def test_a_tall_picture_is_as_high_as_the_page_allows():
    corners = on_page(fitted(A4, np.array([0.0, 0.0]), np.array([1.0, 100.0])), (0, 0), (1, 100))
    np.testing.assert_allclose(corners[:, 1], [10, 287])


@pytest.mark.parametrize("size", [(0.0, 0.0), (0.0, 4.0), (4.0, 0.0)])
def test_a_picture_without_width_or_height_is_in_the_middle(size):
    low = np.array([7.0, -2.0])
    high = low + size
    corners = on_page(fitted(A4, low, high), low, high)
    assert np.isfinite(corners).all()
    np.testing.assert_allclose(corners.mean(axis=0), [105, 148.5])
    assert np.all(corners >= 10 - 1e-9) and np.all(corners <= np.array([200, 287]) + 1e-9)
    if max(size) > 0:
        assert np.isclose((corners[1] - corners[0]).max(), 190 if size[0] else 277)


def test_without_fit_the_origin_is_the_middle_and_the_page_is_as_high_as_the_picture():
    corners = on_page(centred(A4, 8.0, A4.height_mm), (0, 0), (0, 4), (0, -4), (4, 0))
    np.testing.assert_allclose(corners, [(105, 148.5), (105, 297), (105, 0), (105 + 148.5, 148.5)])

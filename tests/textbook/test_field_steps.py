"""Equal steps along fields: orders of accuracy, borders, seams, and fields without a sense."""

import numpy as np
import pytest

from vectorplot import features
from vectorplot.curves import Loxodrome
from vectorplot.errors import InputError
from vectorplot.surfaces import Ellipsoid, Sphere, Torus
from vectorplot.textbook import euler_curves, runge_kutta_curves

METHODS = [euler_curves, runge_kutta_curves]

COURSE = np.radians(70.0)


@pytest.mark.capability("G9.4-field")
@pytest.mark.parametrize("method, order", [(euler_curves, 1), (runge_kutta_curves, 4)])
@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_errors_at_the_end_of_a_loxodrome_fall_by_the_order_of_the_steps(method, order, scale):
    latitude = 1.0
    longitude = np.arctanh(np.sin(latitude)) * np.tan(COURSE)
    true = Loxodrome(scale, COURSE, 0.0, longitude).points(longitude)
    errors = []
    for steps in (16, 32):
        length = scale * latitude / np.cos(COURSE)
        found = method(Sphere(scale), features.loxodromes(np.pi + COURSE), (0, 0), length, steps)
        assert found.shape == (1, steps + 1, 2) and np.isfinite(found).all()
        errors.append(np.linalg.norm(Sphere(scale).points(*found[0, -1]) - true))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.1)


@pytest.mark.parametrize("method", METHODS)
def test_curves_run_on_over_seams_and_end_before_borders(method):
    east, south = features.loxodromes(-np.pi / 2), features.loxodromes(np.pi)
    round_twice = method(Sphere(), east, [(6.0, 0.0)], 4.0 * np.pi, 8)
    assert np.allclose(round_twice[0, :, 0], 6.0 + 0.5 * np.pi * np.arange(9))
    # The one that starts farther south reaches the pole first; both are there at last.
    two = method(Sphere(), south, [(1.0, 0.5), (1.0, -1.0)], 3.0, 30)
    kept = np.isfinite(two).all(axis=2)
    assert kept.sum(axis=1).tolist() == [21, 6] and (np.diff(kept.astype(int), axis=1) <= 0).all()
    assert np.nanmin(two[..., 1]) >= -0.5 * np.pi


@pytest.mark.parametrize("method", METHODS)
def test_fields_without_a_sense_are_followed_in_the_one_they_began_with(method):
    body = Ellipsoid((3.0, 2.0, 1.5))
    field = features.PrincipalDirections(1)
    found = method(body, field, [(0.4, 0.3), (2.1, -0.6)], 2.0, 40)
    moves = np.diff(np.stack([body.points(*line.T) for line in found]), axis=1)
    assert (np.einsum("ijk,ijk->ij", moves[:, :-1], moves[:, 1:]) > 0.0).all()


@pytest.mark.parametrize("method", METHODS)
def test_no_direction_no_curve(method):
    for field in (features.PrincipalDirections(), features.AsymptoticDirections()):
        found = method(Sphere(), field, [(0.3, 0.2)], 1.0, 4)
        assert found[0, 0].tolist() == [0.3, 0.2] and np.isnan(found[0, 1:]).all()


@pytest.mark.parametrize(
    "starts, length, steps, said",
    [
        ([(0.0, np.nan)], 1.0, 4, "finite"),
        ([(0.0, 1.0, 2.0)], 1.0, 4, "pairs"),
        ([(0.0, 0.0)], 0.0, 4, "length must be positive"),
        ([(0.0, 0.0)], 1.0, 0, "at least 1"),
    ],
)
def test_what_cannot_be_stepped_is_said(starts, length, steps, said):
    for method in METHODS:
        with pytest.raises(InputError, match=said):
            method(Torus(3.0, 1.0), features.loxodromes(1.0), starts, length, steps)

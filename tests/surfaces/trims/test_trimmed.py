import numpy as np
import pytest

from vectorplot.errors import InputError
from vectorplot.surfaces.quadrics import Cylinder, Sphere
from vectorplot.surfaces.surface import is_implicit, is_parametrised
from vectorplot.surfaces.tori import ImplicitTorus, Torus
from vectorplot.surfaces.trimmed import TrimmedSurface


def test_a_part_has_the_points_and_derivatives_of_the_whole():
    part = TrimmedSurface(Torus(), u=(1.0, 2.0), v=(-0.5, 0.5))
    u, v = np.array([1.0, 1.7]), np.array([0.5, -0.2])
    assert np.array_equal(part.points(u, v), Torus().points(u, v))
    for mine, whole in zip(part.partials(u, v), Torus().partials(u, v), strict=True):
        assert np.array_equal(mine, whole)
    for mine, whole in zip(part.second_partials(u, v), Torus().second_partials(u, v), strict=True):
        assert np.array_equal(mine, whole)


def test_a_part_is_closed_where_it_runs_all_round():
    d = TrimmedSurface(Torus(), u=(1.0, 1.0 + 2.0 * np.pi)).domain
    assert (d.u_start, d.closed_u, d.closed_v) == (1.0, True, True)
    d = TrimmedSurface(Torus(), v=(0.0, 6.0)).domain
    assert (d.closed_u, d.closed_v, d.v_end) == (True, False, 6.0)


def test_ranges_that_end_at_the_border_but_for_rounding_end_at_the_border():
    d = TrimmedSurface(Sphere(), v=(-np.pi / 2 * (1 + 4e-16), np.pi / 2)).domain
    assert d.v_start == -np.pi / 2 and not d.closed_v


@pytest.mark.parametrize(
    ("shape", "ranges", "message"),
    [
        (Sphere(), {"v": (-2.0, 0.0)}, "v from -2 to 0 leaves the range"),
        (Torus(), {"u": (0.0, 7.0)}, "more than one round"),
        (Cylinder(), {"v": (0.5, 0.5)}, "empty"),
        (Torus(), {"u": (np.nan, 1.0)}, "finite"),
    ],
)
def test_ranges_that_are_no_part_are_refused(shape, ranges, message):
    with pytest.raises(InputError, match=message):
        TrimmedSurface(shape, **ranges)


def test_parametrised_and_implicit_surfaces_are_told_apart():
    assert is_parametrised(TrimmedSurface(Torus())) and not is_implicit(Torus())
    assert is_implicit(ImplicitTorus()) and not is_parametrised(ImplicitTorus())

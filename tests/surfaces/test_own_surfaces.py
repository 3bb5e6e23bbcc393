"""Surfaces of classes that users write: four members, derivatives that are found, and what is wrong in one sentence."""

import numpy as np
import pytest

import vectorplot as vp
from vectorplot import features, surfaces
from vectorplot.errors import InputError
from vectorplot.save import write
from vectorplot.surfaces import Domain, Torus


class Points:
    """A ring given by its points alone."""

    domain = Domain(0.0, 2.0 * np.pi, 0.0, 2.0 * np.pi, closed_u=True, closed_v=True)

    def points(self, u, v):
        return np.stack([(3 + np.cos(v)) * np.cos(u), (3 + np.cos(v)) * np.sin(u), np.sin(v)], axis=-1)


class Partials(Points):
    def partials(self, u, v):
        by_u = np.stack([-(3 + np.cos(v)) * np.sin(u), (3 + np.cos(v)) * np.cos(u), 0 * u], axis=-1)
        return by_u, np.stack([-np.sin(v) * np.cos(u), -np.sin(v) * np.sin(u), np.cos(v)], axis=-1)


class Four(Partials):
    def second_partials(self, u, v):
        uu = np.stack([-(3 + np.cos(v)) * np.cos(u), -(3 + np.cos(v)) * np.sin(u), 0 * u], axis=-1)
        uv = np.stack([np.sin(v) * np.sin(u), -np.sin(v) * np.cos(u), 0 * u], axis=-1)
        return uu, uv, np.stack([-np.cos(v) * np.cos(u), -np.cos(v) * np.sin(u), -np.sin(v)], axis=-1)


@pytest.mark.capability("G0-own-families")
@pytest.mark.parametrize("family", [Points, Partials, Four])
def test_a_class_of_some_members_is_drawn_as_the_family_it_is(family):
    def length(shape):
        drawing = vp.draw(vp.Scene((vp.Item("A", shape),)), vp.Camera((7, -9, 6), fov_deg=40), fit=False)
        paths = [paths for layer in drawing.layers for paths in layer.strokes]
        parts = [points for some in paths for points in np.split(some.points, some.offsets[1:-1])]
        return sum(np.linalg.norm(np.diff(part, axis=0), axis=1).sum() for part in parts)

    assert length(family()) == pytest.approx(length(Torus(3.0, 1.0)), rel=2e-4)
    moved = vp.Item("A", family()).moved(1, 2, 3).turned("x", 30)
    assert write(vp.paint(vp.Scene((moved,)), tolerance_mm=0.3), "svg")


class Swapped(Four):
    def partials(self, u, v):
        return super().partials(u, v)[::-1]


class WrongSecond(Four):
    def second_partials(self, u, v):
        return tuple(-one for one in super().second_partials(u, v))


class OneVector(Points):
    def partials(self, u, v):
        return np.zeros(3)


class Columns(Points):
    def points(self, u, v):
        return super().points(u, v).T


class NoPoints:
    domain = Domain(0, 1, 0, 1)


class TupleDomain(Points):
    domain = (0, 1, 0, 1)


@pytest.mark.capability("G0-own-families")
@pytest.mark.parametrize(
    ("family", "told"),
    [
        (Swapped, r"WAVE: partials\(u, v\)\[0\] is not the derivative of points: .* at u = .*, v = "),
        (WrongSecond, r"WAVE: second_partials\(u, v\)\[0\] is not the derivative"),
        (OneVector, r"WAVE: partials\(u, v\) must return 2 arrays of shape \(n, 3\)"),
        (Columns, r"WAVE: points\(u, v\) must return shape \(n, 3\)"),
        (NoPoints, r"WAVE: a surface needs a domain .* and a method points"),
        (TupleDomain, r"WAVE: a surface needs a domain"),
    ],
)
def test_what_is_wrong_with_it_is_one_sentence(family, told):
    with pytest.raises(InputError, match=told) as caught:
        vp.Item("WAVE", family())
    assert "\n" not in str(caught.value)


def test_features_find_the_second_partials_that_a_class_lacks():
    eye, at = (8.0, 3.0, 4.0), [(0.3, 0.2), (2.0, 1.0)]
    u, v = np.array([0.3, 2.0]), np.array([0.2, 1.0])
    own = {family: family() for family in (Points, Partials, Four)}
    for asked in (
        lambda ring: features.contour(ring, eye),
        lambda ring: features.isophotes(ring, (1, 2, 3), [0.4]),
        lambda ring: features.plane_sections(ring, (0, 0, 1), [0.5]),
        lambda ring: features.integral_curves(ring, features.PrincipalDirections(1), at, length=3.0),
        lambda ring: features.geodesics(ring, at, 0.7, length=5.0),
    ):
        found = {family: asked(ring) for family, ring in own.items()}
        length = {
            family: sum(np.linalg.norm(np.diff(curves[k], axis=0), axis=1).sum() for k in range(len(curves.closed)))
            for family, curves in found.items()
        }
        assert length[Points] == pytest.approx(length[Four], rel=1e-6)
        assert length[Partials] == pytest.approx(length[Four], rel=1e-6)
    for ring in own.values():
        expected = np.cos(v) / (3.0 + np.cos(v))
        np.testing.assert_allclose(surfaces.gaussian_curvature(ring, u, v), expected, rtol=1e-9)
        forms = (features.Sites(shape, u, v).second_form for shape in (ring, Four()))
        for found, exact in zip(*forms, strict=True):
            np.testing.assert_allclose(found, exact, rtol=1e-9, atol=1e-9)


class NotAnalytic(Points):
    """The ring with points that complex steps cannot take: second derivatives are differences."""

    def points(self, u, v):
        return super().points(np.real(u), np.real(v)) + 0.0 * np.hypot(u, v)[..., None]


def test_second_partials_by_differences_are_right_to_nine_digits():
    u, v = (x.ravel() for x in np.meshgrid(np.linspace(0.1, 6.0, 9), np.linspace(0.2, 5.9, 7)))
    found = vp.Item("A", NotAnalytic()).shape.second_partials(u, v)
    for by, exact in zip(found, Four().second_partials(u, v), strict=True):
        assert np.abs(by - exact).max() < 4e-9


def test_a_placed_and_a_trimmed_surface_find_what_their_own_one_lacks():
    placed = surfaces.PlacedSurface(Points(), np.diag([1.0, 2.0, 3.0]), (1.0, 0.0, 0.0))
    assert vp.draw(vp.Item("A", placed)).layers
    assert len(features.contour(placed, (20.0, 0.0, 5.0)).closed) == len(
        features.contour(surfaces.PlacedSurface(Four(), placed.matrix, placed.shift), (20.0, 0.0, 5.0)).closed
    )
    assert vp.draw(vp.Item("A", surfaces.TrimmedSurface(Points(), u=(0.0, 2.0)))).layers

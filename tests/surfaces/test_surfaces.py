"""What all parametrised surfaces have in common: derivatives, shapes, seams, normals at poles."""

from __future__ import annotations

import numpy as np
import pytest

from vectorplot.curves.curve import Curve
from vectorplot.curves.families import Circle, Helix, Line
from vectorplot.errors import InputError
from vectorplot.geometry.rotations import rotation_about
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.graphs import Disc, graph, graph_over_disc
from vectorplot.surfaces.minimal import helicoid_to_catenoid, minimal_spiral_surface
from vectorplot.surfaces.placed_surface import PlacedSurface
from vectorplot.surfaces.quadrics import (
    Cone,
    Cylinder,
    Ellipsoid,
    HyperbolicParaboloid,
    Hyperboloid,
    HyperboloidSheet,
    Paraboloid,
    Sphere,
)
from vectorplot.surfaces.stacked import unit_normals
from vectorplot.surfaces.surface import Domain, normals
from vectorplot.surfaces.swept import (
    helical_surface,
    revolution_surface,
    rotoidal_surface,
    spiral_surface,
    translation_surface,
)
from vectorplot.surfaces.tori import Torus, dupin_cyclide

LINE = Line((2, 0.5, -1), (0.4, 1, 0.7))
CIRCLE = Circle((3, 0.2, 0.1), 0.8, (0.3, 1, 0.2))

FAMILIES = {
    "translation": lambda g: translation_surface(g, Helix(1, 0.4)),
    "revolution": revolution_surface,
    "helical": lambda g: helical_surface(g, 0.4),
    "rotoidal": lambda g: rotoidal_surface(g, 0.4, 3),
    "spiral": lambda g: spiral_surface(g, 0.1),
}
MEMBERS = {
    f"{name} {kind}": family(g)
    for name, family in FAMILIES.items()
    for kind, g in (("ruled", LINE), ("tubular", CIRCLE))
}
SURFACES = MEMBERS | {
    "sphere": Sphere(2, (1, 2, 3)),
    "ellipsoid": Ellipsoid((3, 2, 1)),
    "torus": Torus(3, 1),
    "spindle": Torus(1, 2),
    "cylinder": Cylinder(2, -1, 3, depth=1),
    "cone": Cone.standing(2, 3),
    "double cone": Cone(0.5, -1, 2),
    "hyperboloid": Hyperboloid((1, 2, 3), -2, 2),
    "sheet": HyperboloidSheet((1, 2, 3), 5),
    "paraboloid": Paraboloid(1, 2, 3),
    "saddle": HyperbolicParaboloid(1, 2, 2, 1),
    "helicoid": helicoid_to_catenoid(0.0),
    "bent": helicoid_to_catenoid(0.7),
    "catenoid": helicoid_to_catenoid(np.pi / 2),
    "minimal spiral": minimal_spiral_surface(0.2, 0.3),
    "cyclide": dupin_cyclide(3, 1, (1, 0.5, 0.2), 2),
    "placed": PlacedSurface(Torus(3, 1), 2 * rotation_about((1, 2, 3), 0.7), (1, 1, 1)),
    "graph": graph(lambda x, y: np.sin(x) * np.cos(2 * y), Domain(-1, 1, 0, 2)),
    "polar": graph_over_disc(lambda x, y: np.sin(x) * np.cos(2 * y) + x, Disc(1.5, (0.3, 0.1)), hole=0.2),
    "function": surface_of_function(lambda u, v: (u * np.cos(v), u * np.sin(v), v), Domain(0.5, 2, 0, 6)),
}
every_surface = pytest.mark.parametrize("surface", SURFACES.values(), ids=SURFACES.keys())


def inner_parameters(surface, columns=9, rows=11):
    d = surface.domain
    u = d.u_start + d.size[0] * (np.arange(columns) + 0.437) / columns
    v = d.v_start + d.size[1] * (np.arange(rows) + 0.391) / rows
    return np.meshgrid(u, v, indexing="ij")


def differences(f, h=1e-4):
    p = [f(k * h) for k in (-2, -1, 1, 2)]
    return (p[0] - 8 * p[1] + 8 * p[2] - p[3]) / (12 * h)


@every_surface
@pytest.mark.capability("G8.2-surface")
def test_partials_are_the_derivatives_of_points(surface):
    u, v = inner_parameters(surface)
    along_u, along_v = surface.partials(u, v)
    scale = max(1, np.abs(along_u).max(), np.abs(along_v).max())
    assert np.abs(along_u - differences(lambda h: surface.points(u + h, v))).max() < 1e-10 * scale
    assert np.abs(along_v - differences(lambda h: surface.points(u, v + h))).max() < 1e-10 * scale


@every_surface
def test_second_partials_are_the_derivatives_of_partials(surface):
    u, v = inner_parameters(surface)
    uu, uv, vv = surface.second_partials(u, v)
    scale = max(1, np.abs(uu).max(), np.abs(uv).max(), np.abs(vv).max())
    assert np.abs(uu - differences(lambda h: surface.partials(u + h, v)[0])).max() < 1e-9 * scale
    assert np.abs(uv - differences(lambda h: surface.partials(u, v + h)[0])).max() < 1e-9 * scale
    assert np.abs(uv - differences(lambda h: surface.partials(u + h, v)[1])).max() < 1e-9 * scale
    assert np.abs(vv - differences(lambda h: surface.partials(u, v + h)[1])).max() < 1e-9 * scale


@every_surface
def test_shapes_follow_the_parameters(surface):
    d = surface.domain
    for shape in ((), (0,), (3,), (2, 3)):
        u = np.full(shape, d.u_start + 0.4 * d.size[0])
        v = np.full(shape, d.v_start + 0.4 * d.size[1])
        results = [surface.points(u, v), *surface.partials(u, v), *surface.second_partials(u, v)]
        assert all(r.shape == (*shape, 3) for r in results)
        assert unit_normals(surface, u, v).shape == (*shape, 3)


@every_surface
def test_domain_says_where_the_surface_closes_smoothly(surface):
    d = surface.domain
    u, v = inner_parameters(surface)
    scale = np.abs(surface.points(u, v)).max()
    for closed, ends in (
        (d.closed_u, [(np.full(11, e), v[0]) for e in (d.u_start, d.u_end)]),
        (d.closed_v, [(u[:, 0], np.full(9, e)) for e in (d.v_start, d.v_end)]),
    ):
        gaps = [
            np.abs(a - b).max()
            for a, b in zip(
                (surface.points(*ends[0]), *surface.partials(*ends[0])),
                (surface.points(*ends[1]), *surface.partials(*ends[1])),
                strict=True,
            )
        ]
        assert closed == (max(gaps) < 1e-11 * scale)


@every_surface
def test_unit_normals_are_those_of_the_partials_away_from_poles(surface):
    u, v = inner_parameters(surface)
    product, unit = normals(surface, u, v), unit_normals(surface, u, v)
    assert np.allclose(np.linalg.norm(unit, axis=-1), 1, rtol=1e-14)
    assert np.abs(np.cross(product, unit)).max() < 1e-13 * np.abs(product).max()
    assert (np.einsum("...i,...i", product, unit) > 0).all()


@pytest.mark.hard(46)
@pytest.mark.parametrize(
    ("surface", "u", "v", "expected"),
    [
        (Sphere(2), [0, 1, 6], np.pi / 2, (0, 0, 1)),
        (Sphere(2), [0, 1, 6], -np.pi / 2, (0, 0, -1)),
        (Sphere(2e-6, (1, 1, 1)), [3], np.pi / 2, (0, 0, 1)),
        (Sphere(2e6), [3], np.pi / 2 - 1e-14, (0, 0, 1)),
        (Ellipsoid((3, 2, 1)), [0, 1, 6], np.pi / 2, (0, 0, 1)),
        (HyperboloidSheet((1, 2, 3), 5), [0, 2], 0, (0, 0, -1)),
        (Paraboloid(1, 2, 3), [0, 2], 0, (0, 0, -1)),
        (PlacedSurface(Sphere(1), rotation_about((1, 0, 0), np.pi / 2)), [1], np.pi / 2, (0, -1, 0)),
    ],
)
def test_limit_normals_at_poles(surface, u, v, expected):
    u = np.array(u, dtype=float)
    assert np.allclose(unit_normals(surface, u, np.full(u.shape, v)), expected, rtol=0, atol=1e-12)


@pytest.mark.hard(46)
def test_pole_of_a_surface_of_revolution_and_of_a_polar_graph():
    ball = revolution_surface(Circle((0, 0, 0), 2, (0, -1, 0), -np.pi / 2, np.pi / 2))
    d = ball.domain
    for u in (d.u_start, d.u_end):
        height = ball.points(np.array(u), np.array(0.0))
        assert np.allclose(np.abs(unit_normals(ball, np.full(3, u), np.array([0.0, 1, 2])) @ height), 2)
    dome = graph_over_disc(lambda x, y: 1 + x - x * x - 2 * y * y, Disc(1))
    assert np.allclose(unit_normals(dome, np.zeros(4), np.array([0.0, 1, 2, 3])), np.array([-1, 0, 1]) / np.sqrt(2))


@pytest.mark.hard(46)
@pytest.mark.parametrize("surface", [Sphere(2), Ellipsoid((3, 2, 1)), Cone.standing(1, 2), Torus(1, 2)])
def test_normals_run_into_the_pole_without_a_spike(surface):
    d = surface.domain
    distances = np.concatenate([[0], 10.0 ** np.arange(-300, -2, 3.3), [1e-3]])
    v = np.pi / 3 + distances if isinstance(surface, Torus) else d.v_end - distances
    unit = unit_normals(surface, np.full(len(distances), 1.0), v)
    assert np.isfinite(unit).all()
    assert np.linalg.norm(unit - unit[-1], axis=1).max() < 1e-2


def test_an_apex_has_a_normal_for_each_ruling():
    u = np.array([0.0, 1.0, 2.0])
    cone = Cone.standing(1, 1)
    assert np.allclose(unit_normals(cone, u, np.zeros(3)), unit_normals(cone, u, np.full(3, -0.5)), atol=1e-12)


def test_no_normal_where_there_is_none():
    thread = surface_of_function(lambda u, v: (u, 0 * v, 0 * v), Domain(0, 1, 0, 1))
    assert np.isnan(unit_normals(thread, np.array([0.5]), np.array([0.5]))).all()
    holed = surface_of_function(lambda u, v: (u, v, np.sqrt(u - 0.5)), Domain(0, 1, 0, 1))
    unit = unit_normals(holed, np.array([0.2, 0.8]), np.array([0.5, 0.5]))
    assert np.isnan(unit[0]).all()
    assert np.isfinite(unit[1]).all()


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_unit_normals_do_not_depend_on_scale(scale):
    for surface in (Torus(3, 1), Ellipsoid((3, 2, 1)), MEMBERS["helical tubular"]):
        u, v = inner_parameters(surface)
        scaled = PlacedSurface(surface, scale * np.eye(3), (scale, 0, 0))
        assert np.allclose(unit_normals(scaled, u, v), unit_normals(surface, u, v), rtol=0, atol=1e-13)


def test_generators_are_curves():
    generators: list[Curve] = [LINE, CIRCLE]
    assert all(g.start < g.end for g in generators)


@pytest.mark.parametrize("made", [HyperboloidSheet, Hyperboloid])
def test_a_hyperboloid_as_flat_as_no_number_tells_is_refused(made):
    with pytest.raises(InputError, match="out of range"):
        made((5.0, 10.0, 1e-308), top=1e10)

"""Surfaces as a scene file names them, and as they are made in Python."""

from __future__ import annotations

import numpy as np

from vectorplot.curves.families import Circle, Line
from vectorplot.curves.placed_curves import curve_of_function
from vectorplot.curves.splines import AkimaSpline, ApproximatingSpline, BSpline, CubicSpline, InterpolatingSpline
from vectorplot.io.scene_language import parse_scene
from vectorplot.surfaces.capped_bodies import Capped, Frustum, rod
from vectorplot.surfaces.function_surface import surface_of_function
from vectorplot.surfaces.graphs import Disc, graph, graph_over_disc
from vectorplot.surfaces.minimal import helicoid_to_catenoid, minimal_spiral_surface
from vectorplot.surfaces.quadrics import (
    Cone,
    Cylinder,
    Ellipsoid,
    HyperbolicParaboloid,
    Hyperboloid,
    HyperboloidSheet,
    Paraboloid,
    Quadric,
    Sphere,
)
from vectorplot.surfaces.splines import landscape, nurbs_surface, spline_surface
from vectorplot.surfaces.surface import Domain, hessians, is_parametrised
from vectorplot.surfaces.swept import (
    helical_surface,
    revolution_surface,
    rotoidal_surface,
    spiral_surface,
    translation_surface,
)
from vectorplot.surfaces.tori import ImplicitCyclide, ImplicitTorus, Torus, dupin_cyclide
from vectorplot.surfaces.trimmed import TrimmedSurface


def one(text):
    (item,) = parse_scene(text).items
    return item


TURN = 2.0 * np.pi
BOX = np.array([[-2.0, -2.0, -2.0], [2.0, 3.0, 2.0]])
RING = Circle((3.0, 0.0, 0.0), 0.5, (0.0, 1.0, 0.0))


def parabola(sign):
    return curve_of_function(lambda t: (t, 0 * t, t * t) if sign > 0 else (0 * t, t, -t * t), -1.0, 1.0)


GRID = np.array([[(x, y, x * y * (3 - x)) for y in (0, 1, 3)] for x in range(4)], dtype=float)
LINES = " ".join("line " + ", ".join(f"{x:g} {y:g} {z:g}" for x, y, z in line) for line in GRID)


FAMILIES = [
    ("torus", Torus(3.0, 1.0)),
    ("torus 2.5 0.5", Torus(2.5, 0.5)),
    ("torus minor 0.5 major 2.5 centre 1 2 3", Torus(2.5, 0.5, (1, 2, 3))),
    ("torus 3 1 u 0 180 v -90 90", TrimmedSurface(Torus(), (0.0, np.pi), (-np.pi / 2, np.pi / 2))),
    ("sphere 2 centre 1, 0, 0", Sphere(2.0, (1, 0, 0))),
    ("sphere v 0 90", TrimmedSurface(Sphere(), v=(0.0, np.pi / 2))),
    ("ellipsoid 3 2 1", Ellipsoid((3, 2, 1))),
    ("cylinder 2 -1 4 depth 3", Cylinder(2.0, -1.0, 4.0, depth=3.0)),
    ("cylinder 2 -1 4 capped", Capped(Cylinder(2.0, -1.0, 4.0))),
    ("frustum radii 2 1 height 3", Frustum(2.0, 1.0, 3.0)),
    ("frustum radii 2 0.5 height 3 centre 0 0 1 capped", Capped(Frustum(2.0, 0.5, 3.0, (0, 0, 1)))),
    ("sphere 2 v 0 90 capped", Capped(Sphere(2.0), (0.0, np.pi / 2))),
    ("rod radius 0.5 points 0 0 1 2 0 1", rod((0, 0, 1), (2, 0, 1), 0.5)),
    ("cone 2 3 centre 0 0 1", Cone.standing(2.0, 3.0, (0, 0, 1))),
    ("cone slope 0.5 bottom -2 top 2 depth_slope 1", Cone(0.5, -2.0, 2.0, depth_slope=1.0)),
    ("hyperboloid 1 2 3 -1.5 2", Hyperboloid((1, 2, 3), -1.5, 2.0)),
    ("hyperboloid_sheet 1 2 0.5 top 3", HyperboloidSheet((1, 2, 0.5), 3.0)),
    ("paraboloid 1 2 3", Paraboloid(1.0, 2.0, 3.0)),
    ("hyperbolic_paraboloid 1 2 width 3 depth 4", HyperbolicParaboloid(1.0, 2.0, 3.0, 4.0)),
    ("cyclide 3 1 centre 6 0 0 radius 5", dupin_cyclide(3.0, 1.0, (6, 0, 0), 5.0)),
    ("helicoid 2 angle -90 90", helicoid_to_catenoid(0.0, width=2.0, start=-np.pi / 2, end=np.pi / 2)),
    ("helicoid bending 45", helicoid_to_catenoid(np.pi / 4)),
    ("catenoid", helicoid_to_catenoid(np.pi / 2)),
    ("minimal_spiral 0.2 width 1", minimal_spiral_surface(0.2, width=1.0)),
    (
        'translation curve "t" 0 "t^2" t -1 1 path curve 0 "t" "-t^2" t -1 1',
        translation_surface(parabola(1), parabola(-1)),
    ),
    ("revolution line 1 -1 -1, 1 1 1", revolution_surface(Line.through((1, -1, -1), (1, 1, 1)))),
    ("helical 0.4 circle 0.5 centre 3 0 0 axis 0 1 0 angle 0 720", helical_surface(RING, 0.4, end=2 * TURN)),
    (
        "rotoidal 0.5 3 circle 0.5 centre 3 0 0 axis 0 1 0 angle 0 720",
        rotoidal_surface(RING, 0.5, 3.0, end=2 * TURN),
    ),
    (
        "spiral circle 0.5 centre 3 0 0 axis 0 1 0 arc 0 90 growth 0.1",
        spiral_surface(Circle((3, 0, 0), 0.5, (0, 1, 0), 0.0, np.pi / 2), 0.1),
    ),
    (
        'function "cos(u)*cosh(v)" "sin(u)*cosh(v)" "v" u 0 "2*pi" v -1 1 closed_u',
        surface_of_function(
            lambda u, v: (np.cos(u) * np.cosh(v), np.sin(u) * np.cosh(v), v), Domain(0, TURN, -1, 1, closed_u=True)
        ),
    ),
    ('graph "sin(x)*y" x -1 2 y 0 1', graph(lambda x, y: np.sin(x) * y, Domain(-1, 2, 0, 1))),
    (
        'graph "x^2 - y" disc 2 centre 1 1 hole 0.5',
        graph_over_disc(lambda x, y: x * x - y, Disc(2.0, (1.0, 1.0)), hole=0.5),
    ),
    ('implicit "x^2 + y^2 - z - 1" box -2 2 -2 3 -2 2', Quadric([1, 1, 0, 0, 0, 0, 0, 0, -1, -1], BOX)),
    ("quadric 1 2 3 4 5 6 7 8 9 10 box -2 2 -2 3 -2 2", Quadric(np.arange(1.0, 11.0), BOX)),
    ("quadric 1 1 1 0 0 0 0 0 0 -1 centre 1 1 1 box -2 2 -2 3 -2 2", Quadric([1, 1, 1, *[0] * 6, -1], BOX, (1, 1, 1))),
    ("implicit_torus 2 1 centre 0 0 1", ImplicitTorus(2.0, 1.0, (0, 0, 1))),
    ("implicit_cyclide 3 1 centre 6 0 0 radius 5", ImplicitCyclide(3.0, 1.0, (6, 0, 0), 5.0)),
    (
        "implicit_cyclide 3 1 centre 6 0 0 radius 5 box -2 2 -2 3 -2 2",
        ImplicitCyclide(3.0, 1.0, (6, 0, 0), 5.0, BOX),
    ),
    (f"spline akima {LINES}", spline_surface(GRID, AkimaSpline())),
    (f"spline {LINES} cubic closed", spline_surface(GRID, CubicSpline(closed=True))),
    (
        f"spline u approximating controls 3 order 3 v interpolating order 3 closed {LINES}",
        spline_surface(GRID, ApproximatingSpline(3, 3), InterpolatingSpline(3, closed=True)),
    ),
    (f"spline {LINES} u bspline v bspline order 2", spline_surface(GRID, BSpline(4), BSpline(2))),
    (
        f'nurbs {LINES} orders 4 2 weights 1, 1, 1, 1, "sqrt(2)/2", 1, 1, 2, 1, 1, 1, 1',
        nurbs_surface(GRID, [[1, 1, 1], [1, 0.5**0.5, 1], [1, 2, 1], [1, 1, 1]], orders=(4, 2)),
    ),
    (
        f"nurbs orders 3 3 closed_u knots_v 0, 0, 0, 1, 1, 1 {LINES}",
        nurbs_surface(GRID, orders=(3, 3), knots=(None, [0, 0, 0, 1, 1, 1]), closed=(True, False)),
    ),
    ("landscape 0 1 2, 1 4 3 x 0 10 y -5 5", landscape([[0, 1], [1, 4], [2, 3]], (0, 10), (-5, 5))),
]


def same_surface(found, wanted):
    """Whether surfaces agree in everything a drawing asks of them, the kind of object aside."""
    if not is_parametrised(wanted):
        p = np.random.default_rng(1).uniform(wanted.box[0], wanted.box[1], (50, 3))
        pairs = [
            (found.box, wanted.box),
            (found.values(p), wanted.values(p)),
            (found.gradients(p), wanted.gradients(p)),
            (hessians(found, p), hessians(wanted, p)),
        ]
    else:
        d, e = found.domain, wanted.domain
        assert (d.closed_u, d.closed_v) == (e.closed_u, e.closed_v)
        ranges = [np.array([x.u_start, x.u_end, x.v_start, x.v_end]) for x in (d, e)]
        share = np.random.default_rng(1).random((2, 50))
        u, v = e.u_start + e.size[0] * share[0], e.v_start + e.size[1] * share[1]
        pairs = [(ranges[0], ranges[1]), (found.points(u, v), wanted.points(u, v))]
        pairs += zip(found.partials(u, v), wanted.partials(u, v), strict=True)
        pairs += zip(found.second_partials(u, v), wanted.second_partials(u, v), strict=True)
    return all(np.allclose(a, b, rtol=1e-8, atol=1e-8 * max(1.0, np.abs(b).max())) for a, b in pairs)

"""A torus meets a hyperboloid: one is put into the equation of the other.

With the points x(u, v) of the hyperboloid the torus' equation is a function of u and v. Where its graph, in the second
picture, goes through height 0, the surfaces meet. Source: Glaeser, section 8.4, figure 16.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.features import zero_manifold_of_f_uv
from vectorplot.surfaces import Domain, Hyperboloid, ImplicitTorus, Torus, graph
from vectorplot.testing import assert_on_both, assert_on_surface, curves_in_space

A, B, CENTRE = 3.0, 1.2, (1.2, 0.0, 0.3)
TORUS, EQUATION = Torus(A, B, CENTRE), ImplicitTorus(A, B, CENTRE)
HYPERBOLOID = Hyperboloid((1.6, 1.6, 1.5), -3, 3)
THICK = vp.Pen(0.6)


def on_torus(u: np.ndarray, v: np.ndarray) -> np.ndarray:
    """The torus' F at points of the hyperboloid: zero where the surfaces meet."""
    x, y, z = 1.6 * np.cosh(v) * np.cos(u) - CENTRE[0], 1.6 * np.cosh(v) * np.sin(u), 1.5 * np.sinh(v) - CENTRE[2]
    return (x**2 + y**2 + z**2 + A**2 - B**2) ** 2 - 4 * A**2 * (x**2 + y**2)


def main(folder: Path) -> None:
    lines = vp.SurfaceLines(columns=24, rows=12)
    bodies = vp.Item("TORUS", TORUS, "blue", curves=lines), vp.Item("HYPERBOLOID", HYPERBOLOID, curves=lines)
    camera = vp.Camera(eye=(6, -17, 10), fov_deg=24)
    drawing = vp.draw(vp.Scene(bodies, title="Torus and hyperboloid"), camera, page=vp.Page(130, 110, 5))
    vp.save(drawing, folder / "torus_and_hyperboloid.svg")

    round_trip = HYPERBOLOID.domain
    flat = Domain(round_trip.u_start, round_trip.u_end, round_trip.v_start, round_trip.v_end)
    height = graph(lambda u, v: np.arcsinh(on_torus(u, v) / 12) / 4, flat)
    zero = vp.SurfaceLines(19, 8, sections=(vp.Section((0, 0, 1), (0,)),))
    graphs = vp.Scene((vp.Item("GRAPH", height, curves=zero),), title="Torus in hyperboloid")
    camera = vp.Camera(eye=(9, -7, 13), target=(3, 0, 0), fov_deg=24)
    level = vp.draw(graphs, camera, page=vp.Page(130, 80, 5))
    thick = (replace(layer, pen=THICK) if layer.name == "section" else layer for layer in level.layers)
    level = replace(level, layers=tuple(thick))
    vp.save(level, folder / "torus_and_hyperboloid_graph.svg")

    found = zero_manifold_of_f_uv(on_torus, HYPERBOLOID.domain, columns=32, rows=32, tolerance=1e-4)
    traced = np.concatenate([HYPERBOLOID.points(*found[k].T) for k in range(len(found))])
    assert np.abs(EQUATION.values(traced)).max() < 1e-9
    u, v, z = np.concatenate(curves_in_space(level, kind="section")).T
    assert_on_surface(HYPERBOLOID.points(u, v), EQUATION, tolerance=1e-9)
    assert np.allclose(z, 0, atol=1e-9), "the zero lines of the graph"
    assert_on_both(curves_in_space(drawing, kind="intersection"), EQUATION, HYPERBOLOID, tolerance=1e-9)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

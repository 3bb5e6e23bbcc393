"""A grid of points as splines in both directions: through the points, near them, and each direction in its own way.

Left Akima's surface, through all points of a grid; then the B-spline surface of orders 3 and 4 that the same points
draw, which keeps off them; a vessel that is periodic round its axis and a B-spline upwards. Contours, borders and
hidden lines are those of the true surfaces. Source: Glaeser, sections 9.1 and 9.2, figures 3 and 6.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import AkimaSpline, BSpline, CubicSpline
from vectorplot.surfaces import SplineSurface, spline_surface
from vectorplot.testing import assert_on_surface, curves_in_space

HEIGHTS = [[0, 0, 1, 1, 0], [0, 2, 2, 1, 0], [1, 1, 0, 0, 1], [0, 1, 3, 2, 0], [0, 0, 1, 1, -1], [1, 0, 0, 0, 0]]


def grid(shift: float) -> np.ndarray:
    """(6,5,3) points over a rectangle."""
    x, y = np.meshgrid(np.arange(6.0), np.arange(5.0), indexing="ij")
    return np.stack([x + shift, y, np.array(HEIGHTS, dtype=float)], axis=-1)


def vessel(shift: float) -> np.ndarray:
    """(6,7,3) points on rings that are not round."""
    turn = np.linspace(0, 2 * np.pi, 6, endpoint=False)[:, None]
    radius, height = np.array([0.1, 1.2, 2.2, 1.8, 0.9, 1.0, 1.6]), np.array([0, 0, 0.8, 2.2, 3.2, 4, 4.6])
    out = radius * (1.0 + 0.15 * np.cos(3 * turn))
    return np.stack(np.broadcast_arrays(out * np.cos(turn) + shift, out * np.sin(turn) + 2, height), axis=-1)


def item(name: str, surface: SplineSurface, columns: int, rows: int) -> vp.Item:
    return vp.Item(name, surface, curves=vp.SurfaceLines(columns, rows))


def main(folder: Path) -> None:
    through = spline_surface(grid(0.0), AkimaSpline())
    near = spline_surface(grid(7.0), BSpline(3), BSpline(4))
    round_ = spline_surface(vessel(15.5), CubicSpline(closed=True), BSpline(4))
    scene = vp.Scene(
        (
            item("THROUGH", through, 10, 8),
            item("NEAR", near, 10, 8),
            item("VESSEL", round_, 18, 12),
        ),
        title="Spline surfaces",
    )
    camera = vp.Camera((9, -26, 17), target=(9, 2, 0.5), fov_deg=30)
    drawing = vp.draw(scene, camera, page=vp.Page(190, 80, 5))
    vp.save(drawing, folder / "spline_surfaces.svg")

    u, v = np.meshgrid(np.arange(6.0), np.arange(5.0), indexing="ij")
    assert np.allclose(through.points(u, v), grid(0.0)), "it runs through its grid"
    assert near.points(u[:4, :2], v[:4, :2])[..., 2].max() < np.max(HEIGHTS), "it keeps within the hull of its points"
    assert_on_surface(curves_in_space(drawing, kind="parameter", item="THROUGH"), through, tolerance=1e-9)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

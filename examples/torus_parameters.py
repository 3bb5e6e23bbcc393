"""A quarter of a torus is gone: the circles of the tube, and the parallels.

u goes round the axis, v round the tube. The points fulfil both equations of the torus, with the square root and
without. Source: Glaeser, section 8.3, figure 9.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.surfaces import ImplicitTorus, ImplicitTorusByDistance, Torus, TrimmedSurface
from vectorplot.testing import assert_on_surface, curves_in_space

MAJOR, MINOR = 3.0, 1.2


def main(folder: Path) -> None:
    torus = Torus(MAJOR, MINOR)
    open_one = TrimmedSurface(torus, u=(0, 1.5 * np.pi))
    ring = vp.Item("RING", open_one, curves=vp.SurfaceLines(columns=18, rows=12))
    camera = vp.Camera(eye=(7, -14, 12), fov_deg=24)
    drawing = vp.draw(vp.Scene((ring,), title="Torus"), camera, page=vp.Page(130, 110, 5))
    vp.save(drawing, folder / "torus_parameters.svg")

    points = torus.points(*np.meshgrid(np.linspace(0, 6, 25), np.linspace(0, 6, 25)))
    for surface in (ImplicitTorus(MAJOR, MINOR), ImplicitTorusByDistance(MAJOR, MINOR)):
        assert np.abs(surface.values(points)).max() < 1e-11
        assert_on_surface(curves_in_space(drawing), surface, tolerance=1e-9)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

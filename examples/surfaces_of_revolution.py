"""Two surfaces of revolution whose generating line is not a meridian.

A straight line that is skew to the axis sweeps a hyperboloid of one sheet. A helix through the axis sweeps a surface
that, surprisingly, is a translation surface as well. Source: Glaeser, section 8.2, figure 4.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import Helix, Line
from vectorplot.surfaces import Hyperboloid, revolution_surface
from vectorplot.testing import assert_on_surface, curves_in_space

PAGE = vp.Page(90, 110, 5)


def main(folder: Path) -> None:
    hyperboloid = revolution_surface(Line.through((1, -1.2, -2), (1, 1.2, 2)))
    helix = Helix(1, 0.6, centre=(1, 0, 0), start=-np.pi, end=np.pi)
    surface = revolution_surface(helix)
    camera = vp.Camera(eye=(4, -15, 9), fov_deg=24)
    pictures = {"hyperboloid": (hyperboloid, vp.SurfaceLines(rows=36)), "helix": (surface, vp.SurfaceLines(24, 24))}
    for name, (shape, lines) in pictures.items():
        scene = vp.Scene((vp.Item(name.upper(), shape, curves=lines),), title="Surface of revolution")
        drawing = vp.draw(scene, camera, page=PAGE)
        vp.save(drawing, folder / f"surfaces_of_revolution_{name}.svg")
        if name == "hyperboloid":
            assert_on_surface(curves_in_space(drawing), Hyperboloid((1, 1, 2 / 1.2), -2, 2), tolerance=1e-9)

    t, v = np.meshgrid(np.linspace(-np.pi, np.pi, 25), np.linspace(0, 2 * np.pi, 25), indexing="ij")
    x, y, _ = np.moveaxis(surface.points(t, v), -1, 0)
    assert np.allclose(np.hypot(x, y), np.hypot(*helix.points(t[:, 0])[:, :2].T)[:, None]), "parallels are circles"
    assert np.allclose(surface.points(t, v), Helix(1, 0.6).points(t + v) + Helix(1, -0.6).points(v)), "translated"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

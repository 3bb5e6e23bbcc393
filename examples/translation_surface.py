"""The hyperbolic paraboloid as a translation surface: a parabola moved along another one.

All columns are copies of one parabola, all rows of the other, which opens the other way.
Source: Glaeser, section 8.2, figure 3.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import curve_of_function
from vectorplot.surfaces import translation_surface
from vectorplot.testing import assert_on_surface, curves_in_space


def main(folder: Path) -> None:
    standing = curve_of_function(lambda t: (t, 0 * t, 0.5 * t**2), -2, 2)
    hanging = curve_of_function(lambda t: (0 * t, t, -0.5 * t**2), -2, 2)
    surface = translation_surface(standing, hanging)
    saddle = vp.Item("SADDLE", surface, curves=vp.SurfaceLines(columns=16, rows=16))
    scene = vp.Scene((saddle,), title="Translation surface")
    camera = vp.Camera(eye=(7, -14, 7), fov_deg=24)
    drawing = vp.draw(scene, camera, page=vp.Page(130, 110, 6))
    vp.save(drawing, folder / "translation_surface.svg")

    u, v = np.meshgrid(np.linspace(-2, 2, 9), np.linspace(-2, 2, 9))
    x, y, z = np.moveaxis(surface.points(u, v), -1, 0)
    assert np.allclose(z, (x**2 - y**2) / 2)
    assert np.allclose(np.ptp(surface.points(u, v) - surface.points(u, 0 * v), axis=1), 0), "it does not depend on u"
    assert_on_surface(curves_in_space(drawing, kind="parameter"), surface, tolerance=1e-9)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

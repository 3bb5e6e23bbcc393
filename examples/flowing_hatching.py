"""Strokes that flow: an ellipsoid along its lines of curvature, a catenoid along asymptotic lines, a ring in the light.

The lines are evenly apart on the bodies; each stroke is as long as it is dark enough for it. On a minimal surface the
two families of asymptotic lines cross at right angles, and run midway between the lines of curvature.
The ring is hatched along its isophotes: along each stroke the surface has one angle to the sun.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.surfaces import Ellipsoid, Torus, helicoid_to_catenoid

PAGE = vp.Page(100, 66, 4)


def main(folder: Path) -> None:
    body = vp.Item("ELLIPSOID", Ellipsoid((3.0, 2.0, 1.4)), lines=("contour",))
    combed = vp.Hatching("tone", spacing_mm=1.2, width_mm=0.4, along="curvature")
    camera = vp.Camera(eye=(9.0, -14.0, 9.0), fov_deg=24)
    drawing = vp.draw(vp.Scene((body,)), camera, page=PAGE, hatch=combed, tolerance_mm=0.1)
    vp.save(drawing, folder / "flowing_hatching_ellipsoid.svg")

    soap = vp.Item(
        "CATENOID", helicoid_to_catenoid(np.pi / 2, width=1.2, start=-np.pi, end=np.pi), lines=("contour", "boundary")
    )
    woven = vp.Hatching("tone", spacing_mm=1.2, width_mm=0.3, along="asymptotic", cross=True)
    camera = vp.Camera(eye=(6.0, -13.0, 8.0), fov_deg=24)
    drawing = vp.draw(vp.Scene((soap,)), camera, page=vp.Page(84, 76, 4), hatch=woven, tolerance_mm=0.1)
    vp.save(drawing, folder / "flowing_hatching_catenoid.svg")

    sun = vp.Light((-1.0, -2.0, 3.0), parallel=True, intensity=1.0)
    ring = vp.Item("RING", Torus(2.2, 0.9), lines=("contour",))
    lit = vp.Hatching("tone", spacing_mm=1.5, width_mm=0.4, along="isophotes")
    camera = vp.Camera(eye=(9.0, -14.0, 9.0), fov_deg=24)
    drawing = vp.draw(vp.Scene((ring,), (sun,)), camera, page=PAGE, hatch=lit, tolerance_mm=0.1)
    vp.save(drawing, folder / "flowing_hatching_ring.svg")

    rays = np.array(sun.position) / np.linalg.norm(sun.position)
    (strokes,) = next(layer.strokes for layer in drawing.layers if layer.name == "hatch")
    for begin, end in zip(strokes.offsets[:-1], strokes.offsets[1:], strict=True):
        line = strokes.points3d[begin:end]
        middle = 2.2 * line * (1.0, 1.0, 0.0) / np.hypot(line[:, 0], line[:, 1])[:, None]
        assert np.ptp((line - middle) @ rays / 0.9) < 0.01, "one angle to the sun along each"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

"""A helicoid bends into a catenoid: of the one surface's lines become circles, of the other's straight lines.

All steps between are minimal surfaces, and no length on them changes: the surface wraps round without being stretched.
Source: Glaeser, section 8.2, figure 8.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.surfaces import first_form, gaussian_curvature, helicoid_to_catenoid, mean_curvature

STEPS = 5


def main(folder: Path) -> None:
    u, v = np.meshgrid(np.linspace(-1.2, 1.2, 9), np.linspace(0, 6, 9))
    camera = vp.Camera(eye=(6, -15, 9), fov_deg=24)
    forms = []
    for step in range(STEPS):
        surface = helicoid_to_catenoid(step / (STEPS - 1) * np.pi / 2, width=1.2, start=-np.pi, end=np.pi)
        item = vp.Item("SURFACE", surface, curves=vp.SurfaceLines(8, 32))
        drawing = vp.draw(vp.Scene((item,), title="Helicoid to catenoid"), camera, page=vp.Page(70, 100, 4))
        vp.save(drawing, folder / f"helicoid_to_catenoid_{step + 1}.svg")

        assert np.allclose(mean_curvature(surface, u, v), 0, atol=1e-12)
        assert np.allclose(gaussian_curvature(surface, u, v), -1 / np.cosh(u) ** 4)
        forms.append(np.stack(first_form(surface, u, v)))
    assert np.allclose(forms, forms[0]), "lengths on the surface stay"
    x, y, z = np.moveaxis(surface.points(u, v), -1, 0)
    assert np.allclose(np.hypot(x, y), np.cosh(z)), "a catenary turns about the axis"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

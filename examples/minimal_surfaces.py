"""A minimal spiral surface, bent in four steps without stretching.

Soap films have mean curvature zero, and so has every one of these. Lengths on the surface stay what they are while it
bends: the first fundamental form does not change. Source: Glaeser, section 8.2, figure 8.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.surfaces import first_form, mean_curvature, minimal_spiral_surface

GROWTH, STEPS = 0.12, 4


def main(folder: Path) -> None:
    u, v = np.meshgrid(np.linspace(-1, 1, 9), np.linspace(-8, 2, 9))
    forms = []
    for step in range(STEPS):
        bending = step / (STEPS - 1) * np.pi / 2
        surface = minimal_spiral_surface(GROWTH, bending, width=1.2, start=-3 * np.pi, end=np.pi)
        spiral = vp.Item("SPIRAL", surface, curves=vp.SurfaceLines(8, 48))
        camera = vp.Camera(eye=(9, -20, 14), target=tuple(surface.points(u, v).mean(axis=(0, 1))), fov_deg=24)
        drawing = vp.draw(vp.Scene((spiral,), title="Minimal spiral surface"), camera, page=vp.Page(90, 100, 4))
        vp.save(drawing, folder / f"minimal_surfaces_{step + 1}.svg")

        assert np.allclose(mean_curvature(surface, u, v), 0, atol=1e-12)
        forms.append(np.stack(first_form(surface, u, v)))
    assert np.allclose(forms, forms[0]), "lengths on the surface stay"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

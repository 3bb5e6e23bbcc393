"""A pencil being sharpened: the intersection of a hexagonal prism with a cone that moves down.

Each picture is the common part of two convex polyhedra. Where the cone cuts a side of the prism, the edge is an
arc of a hyperbola. Source: Glaeser, section 3.6, figure 6.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import has_convex_outline, polyhedron_intersection, revolution, translated
from vectorplot.textbook import body_record

PRISM = revolution([(4, 0, -14), (4, 0, 14)], 6)


def pencil(tip: float) -> vp.Mesh:
    """The prism in a cone with its tip at this height."""
    return polyhedron_intersection(PRISM, revolution([(5, 0, -20), (5, 0, tip - 11), (0, 0, tip)], 90))


def main(folder: Path) -> None:
    tips = (24.0, 21.0, 18.0, 14.0, 9.0)
    pencils = [pencil(tip) for tip in tips]
    items = [
        vp.Item(f"PENCIL{k}", replace(mesh, vertices=translated(mesh.vertices, (11.0 * k, 0, 0))))
        for k, mesh in enumerate(pencils)
    ]
    camera = vp.Camera(eye=(15, -110, 60), target=(22, 0, -2), fov_deg=24)
    scene = vp.Scene(tuple(items), title="Sharpening")
    drawing = vp.draw(scene, camera, page=vp.Page(180, 110, 6), crease_angle_deg=8)
    vp.save(drawing, folder / "sharpening.svg")

    volumes = [body_record(mesh).volume for mesh in pencils]
    assert all(has_convex_outline(mesh) for mesh in pencils)
    assert (np.diff(volumes) < 0).all() and np.isclose(volumes[0], body_record(PRISM).volume, rtol=0.05)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

"""Shadows of convex bodies: only the outline that the lamp sees is projected.

A ball of 288 faces throws a shadow of as many corners as its outline has. And a convex body throws none on itself.
Source: Glaeser, section 6.3, figure 5.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.effects import shadow_decals
from vectorplot.geometry import box, revolution, translated
from vectorplot.scene import look
from vectorplot.textbook import spatial_hull

LAMP = vp.Light((-5.0, -4.0, 9.0), intensity=0.9)
LATITUDE = np.linspace(-np.pi / 2, np.pi / 2, 13)


def placed(name: str, mesh: vp.Mesh, place: tuple[float, float, float], colour: str) -> vp.Item:
    """A body in its place."""
    return vp.Item(name, vp.Mesh(translated(mesh.vertices, place), mesh.corners, mesh.offsets), colour)


def main(folder: Path) -> None:
    meridian = np.column_stack([np.cos(LATITUDE), 0 * LATITUDE, np.sin(LATITUDE)])
    meridian[[0, -1], 0] = 0.0
    bodies = (
        placed("BALL", revolution(1.1 * meridian, 24), (-1.8, 0.2, 1.1), "orange"),
        placed("PYRAMID", revolution([(1.2, 0, 0), (0, 0, 2.4)], 5), (1.6, -1.4, 0), "green"),
        placed("BOX", box((1.2, 1.2, 2.2)), (1.3, 1.4, 0), "blue"),
    )
    floor = placed("FLOOR", box((11, 9, 0.3)), (-5, -4, -0.3), "gray")
    scene = vp.Scene((floor, *bodies), (LAMP,), title="Shadows of convex bodies")
    camera = vp.Camera(eye=(6, -15, 10), target=(0.4, 0.3, 0.4), fov_deg=32)
    vp.save(vp.paint(scene, camera, page=vp.Page(120, 85, 4)), folder / "convex_shadows.svg")

    view = look(scene, camera)
    decals = shadow_decals(view, scene.lights)
    points, on_floor = view.world_of(decals.points), view.face_item[decals.face] == 0
    shadows = [p for p, lies in zip(np.split(points, decals.offsets[1:-1]), on_floor, strict=True) if lies]
    lamp = np.array(LAMP.position)
    for body in bodies:
        outline = body.mesh.vertices[spatial_hull(body.mesh, lamp)]
        above = outline[outline[:, 2] > 1e-9]
        cast = lamp + (above - lamp) * (lamp[2] / (lamp[2] - above[:, 2]))[:, None]
        inner = cast[(cast[:, 0] < 6) & (cast[:, 1] < 5)]
        gap = min(np.linalg.norm(s[:, None] - inner, axis=2).min(axis=0).max() for s in shadows)
        assert gap < 1e-8, f"{body.name}: the corners of a shadow are those of the outline"
    assert len(shadows) == len(bodies) and len(spatial_hull(bodies[0].mesh, lamp)) < 40
    alone = look(vp.Scene((bodies[0],)), camera)
    assert len(shadow_decals(alone, scene.lights)) == 0, "none on itself"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

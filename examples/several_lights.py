"""Shadows of three lamps: their grade at a point is the number of lamps that do not shine there.

Where shadows of different lamps overlap, their common parts are painted over them, darker with each grade. Rays from
points of the floor to the lamps count again. Source: Glaeser, section 6.3, figure 6.
"""

import sys
from pathlib import Path

import numpy as np
import shapely

import vectorplot as vp
from vectorplot.drawing import Fills
from vectorplot.effects import shadow_decals
from vectorplot.scene import look
from vectorplot.shading import palette
from vectorplot.testing import visible_by_rays

DATA = Path(__file__).resolve().parent.parent / "data"
SHADES = palette("orange")[[31, 21, 11, 0]]
"""The colours of grades 0 to 3."""


def main(folder: Path) -> None:
    scene = vp.read(DATA / "shadows.scene")
    view = look(scene, vp.Camera.view("top"))
    decals = shadow_decals(view, scene.lights)
    points = view.world_of(decals.points)
    on_floor = np.flatnonzero(view.face_item[decals.face] == 0)
    on_floor = on_floor[np.argsort(decals.grade[on_floor], kind="stable")]
    parts = [points[decals.offsets[k] : decals.offsets[k + 1]] for k in on_floor]

    # A plan of the floor: what lacks one lamp, two, and all three.
    floor = Fills.flat(
        6.0 * np.array([(0.5, 0.5), (18.5, 0.5), (18.5, 14.5), (0.5, 14.5)]), np.array([0, 4]), SHADES[:1]
    )
    corners = 6.0 * (np.concatenate(parts)[:, :2] + (9.5, 7.5))
    dark = Fills.flat(corners, np.cumsum([0, *map(len, parts)]), SHADES[decals.grade[on_floor]])
    drawing = vp.Drawing(114, 90, (vp.Layer("grades", vp.Pen(), (Fills.joined(floor, dark),)),), title="Grades")
    vp.save(drawing, folder / "several_lights.svg")

    random = np.random.default_rng(3)
    sample = np.column_stack([random.uniform(-8.9, 8.9, 600), random.uniform(-6.9, 6.9, 600), np.zeros(600)])
    grade = np.zeros(len(sample), dtype=int)
    for k, part in zip(on_floor, parts, strict=True):
        grade[shapely.contains_xy(shapely.Polygon(part[:, :2]), sample[:, :2])] = decals.grade[k]
    blocked, sure = np.zeros(len(sample), dtype=int), np.ones(len(sample), dtype=bool)
    for lamp in scene.lights:
        sight = visible_by_rays(scene, vp.Camera(eye=lamp.position, target=(0, 0, 0)), sample)
        blocked += sight.hidden_by > 0
        sure &= sight.clearance > 1e-4
    above = covers_by_items(scene, sample)
    assert (grade == blocked)[sure & ~above].all() and (sure & ~above).sum() > 300
    assert set(grade[~above].tolist()) >= {0, 1, 2}


def covers_by_items(scene: vp.Scene, sample: np.ndarray) -> np.ndarray:
    """Which points of the floor something stands on."""
    below = np.zeros(len(sample), dtype=bool)
    for item in scene.items[1:]:
        vertices = item.mesh.vertices
        if vertices[:, 2].min() < 1e-6:
            low, high = vertices.min(axis=0), vertices.max(axis=0)
            below |= ((sample > low - 1e-9) & (sample < high + 1e-9))[:, :2].all(axis=1)
    return below


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

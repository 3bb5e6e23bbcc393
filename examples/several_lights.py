"""Shadows of three lamps: their grade at a point is the number of lamps that do not shine there.

Where shadows of different lamps overlap, their common parts are painted over them, darker with each grade. A ray of
each lamp, in ochre, passes the corner of the cube that casts the end of its shadow. Rays from points of the floor to
the lamps count again. Source: Glaeser, section 6.3, figure 6.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import shapely
from diagrams import INK, OCHRE, drawn, line, tinted, with_arrows, with_dots, with_faces

import vectorplot as vp
from vectorplot.effects import shadow_decals
from vectorplot.scene import look
from vectorplot.shading import palette
from vectorplot.testing import visible_by_rays

DATA = Path(__file__).resolve().parent.parent / "data"
SHADES = ["#" + "".join(f"{byte:02x}" for byte in palette("gray")[at]) for at in (30, 22, 15, 8)]
"""The colours of grades 0 to 3."""

PAGE = vp.Page(160, 128, 4)


def main(folder: Path) -> None:
    scene = vp.read(DATA / "shadows.scene")
    decals, view = shadow_decals(seen := look(scene, vp.Camera.view("top")), scene.lights), seen
    points = view.world_of(decals.points)
    on_floor = np.flatnonzero(view.face_item[decals.face] == 0)
    on_floor = on_floor[np.argsort(decals.grade[on_floor], kind="stable")]
    parts = [points[decals.offsets[k] : decals.offsets[k + 1]] for k in on_floor]

    camera = vp.Camera(eye=(9, -27, 14), target=(0, 0, 1), fov_deg=30)
    lamps = np.array([light.position for light in scene.lights])
    cube = next(item for item in scene.items if item.name == "CUBE").mesh.vertices
    # The ray of each lamp that passes over the corner of the cube which casts the end of its shadow.
    hits = cube + (cube - lamps[:, None]) * (cube[:, 2] / (lamps[:, None, 2] - cube[:, 2]))[..., None]
    length = np.linalg.norm(hits - cube, axis=2)
    last = np.where((np.abs(hits) < (9, 7, 1)).all(axis=2), length, 0.0).argmax(axis=1)
    ends = hits[np.arange(3), last]
    bodies = tuple(vp.Item(item.name, item.shape, INK) for item in scene.items)
    rays = tuple(line(f"RAY{k}", a, b, OCHRE) for k, (a, b) in enumerate(zip(lamps, ends, strict=True)))
    drawing = drawn(vp.Scene((*bodies, *rays), title="Grades"), camera, PAGE, {INK: 0.35, OCHRE: 0.5})
    white = tuple(vp.Item(item.name, item.shape, "#bcd3ea") for item in scene.items[1:])
    corners = np.array([(-9, -7, 0), (9, -7, 0), (9, 7, 0), (-9, 7, 0)], dtype=float)
    shades = [SHADES[0], *(SHADES[grade] for grade in decals.grade[on_floor])]
    drawing = with_faces(drawing, [corners, *parts], shades)
    drawing = tinted(drawing, vp.Scene(white, (vp.Light((2, -3, 5), parallel=True, intensity=1.0),)), camera)
    # The floor lies below the bodies.
    over, floor, *rest = drawing.layers
    drawing = replace(drawing, layers=(floor, over, *rest))
    drawing = with_dots(with_dots(drawing, cube[last], INK, 0.9), lamps, OCHRE, 2.6)
    drawing = with_arrows(drawing, lamps, ends, OCHRE, 3.2)
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
    below = np.zeros(len(sample), dtype=bool)
    for item in scene.items[1:]:
        low, high = item.mesh.vertices.min(axis=0), item.mesh.vertices.max(axis=0)
        below |= ((sample > low - 1e-9) & (sample < high + 1e-9))[:, :2].all(axis=1) & (low[2] < 1e-6)
    assert (grade == blocked)[sure & ~below].all() and (sure & ~below).sum() > 300
    assert set(grade[~below].tolist()) >= {0, 1, 2}


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

"""Plate: a city of towers around a park, seen from the air.

Every tower is a prism with set-backs; floors are cut by level planes. All lines are exact: what a tower hides is
gone, down to the last window sill.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import INK

import vectorplot as vp
from vectorplot.geometry import placed, prism, revolution


def tower(x: float, y: float, side: float, height: float, kind: int) -> list[vp.Mesh]:
    """A tower in up to three parts, one on the other."""
    parts, level, half = [], 0.0, side / 2
    shares = ((1.0,), (0.7, 0.3), (0.55, 0.3, 0.15))[kind % 3]
    for share in shares:
        ring = half * np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
        if kind % 5 == 3:
            turn = np.pi / 4 * (np.arange(8) + 0.5)
            ring = 1.05 * half * np.column_stack([np.cos(turn), np.sin(turn)])
        base = np.column_stack([np.add(ring, (x, y)), np.full(len(ring), level)])
        parts.append(prism(base, (0, 0, share * height)))
        level += share * height
        half *= 0.68
    if kind % 7 == 2 and height > 4:
        parts.append(
            placed(revolution([(half, 0, 0), (0, 0, 2.0 * side)], 4), (1, 0, 0, x, 0, 1, 0, y, 0, 0, 1, level))
        )
    return parts


def main(folder: Path) -> None:
    random = np.random.default_rng(20)
    items = []
    for i in range(-10, 11):
        for j in range(-10, 11):
            x, y = 2.0 * i + 0.4 * (i // 4), 2.0 * j + 0.4 * (j // 3)
            far = np.hypot(x, y)
            if far < 4.5 or (abs(i - j) < 1 and far < 30) or random.random() < 0.05:
                continue
            height = (1.6 + 13.0 * np.exp(-((far - 9.0) ** 2) / 30.0)) * random.uniform(0.35, 1.15)
            side, kind = random.uniform(1.0, 1.5), int(random.integers(0, 30))
            parts = tower(x, y, side, height, kind)
            for k, mesh in enumerate(parts):
                levels = tuple(
                    np.arange(mesh.vertices[:, 2].min() + 0.4, mesh.vertices[:, 2].max() - 0.1, 0.4).tolist()
                )
                lines = (
                    vp.SurfaceLines(sections=(vp.Section((0, 0, 1), levels),))
                    if levels and k < 3
                    else vp.SurfaceLines()
                )
                items.append(vp.Item(f"T{i},{j},{k}", mesh, curves=lines))
    pond = [(3.4 * np.cos(t), 2.6 * np.sin(t) + 0.6 * np.cos(2 * t), 0.0) for t in np.linspace(0, 2 * np.pi, 90)[:-1]]
    items.append(vp.Item("POND", vp.Mesh.from_polygons(pond, [range(len(pond))])))
    scene = vp.Scene(tuple(items), title="A city")
    camera = vp.Camera(eye=(40, -60, 50), target=(0, 0, 1.5), fov_deg=30)
    drawing = vp.draw(scene, camera, page=vp.Page(594, 420, 18))
    widths = {"visible": 0.3, "contour": 0.5, "section": 0.13, "intersection": 0.3}
    layers = tuple(replace(layer, pen=vp.Pen(widths.get(layer.name, 0.25), INK)) for layer in drawing.layers)
    vp.save(replace(drawing, layers=layers), folder / "plate_city.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

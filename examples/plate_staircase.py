"""Plate: a spiral staircase about a slender column, with its handrail and a baluster on every step.

Three turns of seventy-two wedges. Column and balusters are true cylinders: their contours are straight, their ends
ellipses.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import INK

import vectorplot as vp
from vectorplot.geometry import prism
from vectorplot.surfaces import rod

STEPS, RISE, TURN = 72, 0.2, 2 * np.pi / 24
INNER, OUTER = 0.32, 2.6


def wedge(number: int) -> vp.Mesh:
    """A step."""
    angle = number * TURN + np.linspace(0.0, TURN * 1.06, 6)
    outer = np.column_stack([OUTER * np.cos(angle), OUTER * np.sin(angle)])
    inner = np.column_stack([INNER * np.cos(angle), INNER * np.sin(angle)])[::-1]
    base = np.vstack([outer, inner])
    return prism(np.column_stack([base, np.full(len(base), number * RISE)]), (0, 0, 0.1))


def rail() -> vp.Mesh:
    """A tube along a helix over the balusters, of narrow faces."""
    u = np.linspace(0.3 * TURN, (STEPS - 0.3) * TURN, 10 * STEPS)[:, None]
    v = np.linspace(0, 2 * np.pi, 13)[None, :-1]
    radius = 2.45 + 0.05 * np.cos(v)
    points = np.stack([radius * np.cos(u), radius * np.sin(u), RISE / TURN * u + 1.08 + 0.05 * np.sin(v)], axis=-1)
    at = np.arange(points.size // 3).reshape(points.shape[:2])
    after = np.roll(at, -1, axis=1)
    cells = np.stack([at[:-1], at[1:], after[1:], after[:-1]], axis=-1).reshape(-1, 4)
    return vp.Mesh.from_polygons(points.reshape(-1, 3), cells.tolist())


def main(folder: Path) -> None:
    items = [vp.Item(f"STEP{k}", wedge(k)) for k in range(STEPS)]
    items.append(vp.Item("COLUMN", rod((0, 0, -0.4), (0, 0, STEPS * RISE + 1.4), 0.3)))
    for k in range(STEPS):
        angle = (k + 0.5) * TURN
        foot = np.array([2.45 * np.cos(angle), 2.45 * np.sin(angle), k * RISE + 0.1])
        items.append(vp.Item(f"BALUSTER{k}", rod(tuple(foot), tuple(np.add(foot, (0, 0, 0.96))), 0.022)))
    items.append(vp.Item("RAIL", rail(), lines=("contour", "boundary")))
    camera = vp.Camera(eye=(9, -22, 19), target=(0, 0, 7.2), fov_deg=36)
    drawing = vp.draw(
        vp.Scene(tuple(items), title="A staircase"), camera, page=vp.Page(260, 594, 16), tolerance_mm=0.05
    )
    widths = {"visible": 0.3, "contour": 0.45, "intersection": 0.3}
    layers = tuple(replace(layer, pen=vp.Pen(widths.get(layer.name, 0.25), INK)) for layer in drawing.layers)
    vp.save(replace(drawing, layers=layers), folder / "plate_staircase.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

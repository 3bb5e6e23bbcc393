"""A surface of revolution painted ring by ring: half of it, and all of it.

Slices between horizontal planes are painted towards the height of the eye, the eye's own last; of each slice first
what shows its far side, outer rings before inner ones. No two faces are compared, and the picture is the one that
comparing gives. Source: Glaeser, section 5.2, figure 3.
"""

import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import shapely

import vectorplot as vp
from vectorplot.drawing import Fills
from vectorplot.geometry import polygons_of
from vectorplot.scene import look
from vectorplot.shading import face_colours, face_shades, view_lights
from vectorplot.textbook import ring_order, sliced_meridian

MERIDIAN = np.array([(0, 0), (1.3, 0.2), (0.3, 0.8), (0.3, 1.6), (1.6, 2.4), (1.9, 3.6), (1.3, 4.6), (1.5, 5.2)])
ORDER = 72


def rings() -> vp.Mesh:
    """The faces band by band, as ring_order counts them."""
    line = sliced_meridian(MERIDIAN)
    azimuth = 2 * np.pi * np.arange(ORDER) / ORDER
    points = [(r * np.cos(a), r * np.sin(a), z) for r, z in line for a in azimuth]
    faces = []
    for low, high in pairwise(range(len(line))):
        for j in range(ORDER):
            after = (j + 1) % ORDER
            corners = [low * ORDER + j, low * ORDER + after, high * ORDER + after, high * ORDER + j]
            faces.append([c for c in corners if c >= ORDER] + ([0] if low == 0 else []))
    return vp.Mesh.from_polygons(points, faces)


def on_top(fills: Fills, points: np.ndarray) -> np.ndarray:
    """The last polygon painted over each of some points, -1 for none."""
    faces = polygons_of(fills.points.T, fills.offsets)
    number, over = shapely.STRtree(shapely.points(points)).query(faces, predicate="contains_properly")
    top = np.full(len(points), -1)
    np.maximum.at(top, over, number)
    return top


def turn(corners: np.ndarray) -> float:
    after = np.roll(corners, -1, axis=0)
    return float((corners[:, 0] * after[:, 1] - corners[:, 1] * after[:, 0]).sum())


def main(folder: Path) -> None:
    vase = vp.Item("VASE", rings(), "orange")
    scene = vp.Scene((vase,), (vp.Light((-4, -5, 6), parallel=True, intensity=1.0),), title="Rings")
    camera = vp.Camera(eye=(4, -11, 8), target=(0, 0, 2.4), fov_deg=30)
    view = look(scene, camera)
    lights = view_lights(view, scene.lights)
    colours = face_colours(view, scene.items, face_shades(view, scene.items, lights).total)
    # As large as the page, the insides in blue.
    low, high = view.image.min(axis=1), view.image.max(axis=1)
    points = (48, 60) + 112.0 / (high - low)[1] * (view.image.T - (low + high) / 2)
    order = ring_order(sliced_meridian(MERIDIAN), ORDER, camera.eye)
    assert (np.sort(order) == np.arange(view.face_count)).all()
    corners = [points[view.corners[view.offsets[f] : view.offsets[f + 1]]] for f in order]
    offsets = np.concatenate([[0], np.cumsum([len(c) for c in corners])])
    fills = Fills.flat(np.concatenate(corners), offsets, colours[order])
    flip = np.array([turn(c) for c in corners]) > 0
    inner = face_colours(view, (replace(vase, colour="blue"),), face_shades(view, scene.items, lights).total)
    two = Fills.flat(fills.points, offsets, np.where(flip[:, None], colours[order], inner[order]))
    for name, part in (("half", two.take(np.arange(len(fills) // 2))), ("whole", two)):
        drawing = vp.Drawing(96, 120, (vp.Layer("rings", vp.Pen(), (part,)),), title="Rings")
        vp.save(drawing, folder / f"revolution_rings_{name}.svg")

    compared = vp.paint(scene, camera, shadows="none", smooth=False)
    (others,) = compared.layers[0].fills
    scale = np.ptp(fills.points[:, 1]) / np.ptp(others.points[:, 1])
    low = others.points.min(axis=0)
    sample = np.random.default_rng(1).uniform(low, others.points.max(axis=0), (4000, 2))
    mine, theirs = on_top(fills, fills.points.min(axis=0) + scale * (sample - low)), on_top(others, sample)
    one = np.where(mine[:, None] < 0, 255, fills.colours[fills.offsets[:-1][mine]])
    two = np.where(theirs[:, None] < 0, 255, others.colours[others.offsets[:-1][theirs]])
    assert (one != two).any(axis=1).mean() < 2e-3, "the same picture, but for points on edges"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

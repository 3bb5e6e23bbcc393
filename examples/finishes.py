"""Materials: the power of the cosine, from mat to metallic, and highlights.

Mat things are bright almost up to the border of the light, metallic ones darken fast; in what is polished the eye
sees the lamp. Below each ball stands how much light goes out over the angle at which it comes in, from 0 to 90 degrees;
red is the highlight, for an
eye in front. Source: Glaeser, section 4.5, figure 4.
"""

import sys
from pathlib import Path

import numpy as np
import shapely
from diagrams import GREY, INK, RED, SKY, layer, polygons, strokes

import vectorplot as vp
from vectorplot.drawing import Fills, visible_fills
from vectorplot.geometry import polygons_of
from vectorplot.shading import FINISHES, lambert
from vectorplot.surfaces import PlacedSurface, Sphere

WORDS = ("mat", "wood", "normal", "plastic", "metallic", "shiny")
LIGHT = vp.Light((-3, -4, 4), parallel=True, intensity=1.0)
STEP_MM, RADIUS_MM, DEEP_MM = 29.0, 12.6, 22.0


def main(folder: Path) -> None:
    balls = (
        vp.Item(word, PlacedSurface(Sphere(1.0), np.eye(3), (k * STEP_MM / RADIUS_MM, 0, 0)), "blue", vp.Material(word))
        for k, word in enumerate(WORDS)
    )
    scene = vp.Scene(tuple(balls), (LIGHT,), title="Materials")
    page = vp.Page(6 * STEP_MM + 2, 68, (STEP_MM + 2) / 2 - RADIUS_MM)
    painted = vp.paint(scene, vp.Camera.view("front"), page=page, shadows="none", tolerance_mm=0.1)
    (fills,) = painted.layers[0].fills
    up = 68 - RADIUS_MM - 4 - fills.points[:, 1].mean()
    moved = Fills(**{**vars(fills), "points": np.add(fills.points, (0, up))})

    angle = np.linspace(0, np.pi / 2, 91)
    areas, axes, curves, shine = [], [], [], []
    for k, word in enumerate(WORDS):
        corner, finish = np.array([1 + STEP_MM * (k + 0.5) - RADIUS_MM, 6.0]), FINISHES[word]
        scale = (2 * RADIUS_MM / (np.pi / 2), DEEP_MM)
        light = finish.diffuse * lambert(np.cos(angle), finish.exponent)
        curve = corner + np.column_stack([angle, light]) * scale
        areas.append(np.vstack([corner, curve, np.add(corner, (2 * RADIUS_MM, 0))]))
        curves.append(curve)
        axes.append(corner + np.array([(0, DEEP_MM + 4), (0, 0), (2 * RADIUS_MM + 2, 0)]))
        if finish.highlight > 0:
            glint = light + finish.highlight * finish.weight_at(np.cos(angle)) * np.cos(angle) ** finish.sharpness
            shown = slice(0, max(2, int((glint > light + 0.01).sum())))
            shine.append(corner + (np.column_stack([angle, glint]) * scale)[shown])
    layers = (
        layer("areas", polygons(areas, SKY)),
        layer("balls", moved),
        layer("axes", strokes(axes), GREY, 0.25),
        layer("curves", strokes(curves), INK, 0.45),
        layer("highlights", strokes(shine), RED, 0.45),
    )
    vp.save(vp.Drawing(page.width_mm, 68, layers, painted.items, "Materials"), folder / "finishes.svg")

    cosine = np.linspace(0.05, 0.95, 19)
    falling = [lambert(cosine, FINISHES[word].exponent) for word in ("mat", "wood", "normal", "metallic")]
    assert (np.diff(falling, axis=0) < 0).all(), "the higher the exponent, the darker what is not lit from the front"
    seen = visible_fills(fills, painted.page_from_world)
    middle = seen.colours[seen.offsets[:-1]].mean(axis=1)
    area = shapely.area(polygons_of(seen.points.T, seen.offsets))
    brightness = [np.average(middle[seen.item == k], weights=area[seen.item == k]) for k in range(3)]
    assert brightness[0] > brightness[1] > brightness[2], "so it is in the picture: mat, wood, normal"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

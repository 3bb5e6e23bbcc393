"""Materials: the power of the cosine, from mat to metallic, and highlights.

Mat things are bright almost up to the border of the light, metallic ones darken fast; in what is polished the eye
sees the lamp. Source: Glaeser, section 4.5, figure 4.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import shapely

import vectorplot as vp
from vectorplot.geometry import polygons_of, revolution, translated
from vectorplot.shading import FINISHES, lambert

WORDS = ("mat", "wood", "normal", "plastic", "metallic", "shiny")
LATITUDE = np.linspace(-np.pi / 2, np.pi / 2, 17)
BALL = revolution(np.column_stack([np.cos(LATITUDE), 0 * LATITUDE, np.sin(LATITUDE)]), 32)
LIGHT = vp.Light((-3, -4, 4), parallel=True, intensity=1.0)


def ball(number: int, word: str) -> vp.Item:
    """A ball of some material, in a place of its own."""
    row, column = divmod(number, 3)
    shape = replace(BALL, vertices=translated(BALL.vertices, (2.3 * column, 0, -2.3 * row)))
    return vp.Item(word, shape, "blue", vp.Material(word))


def main(folder: Path) -> None:
    balls = tuple(ball(number, word) for number, word in enumerate(WORDS))
    scene = vp.Scene(balls, (LIGHT,), title="Materials")
    drawing = vp.paint(scene, vp.Camera.view("front"), page=vp.Page(110, 75, 4), shadows="none")
    vp.save(drawing, folder / "finishes.svg")

    cosine = np.linspace(0.05, 0.95, 19)
    falling = [lambert(cosine, FINISHES[word].exponent) for word in ("mat", "wood", "normal", "metallic")]
    assert (np.diff(falling, axis=0) < 0).all(), "the higher the exponent, the darker what is not lit from the front"
    (fills,) = drawing.layers[0].fills
    middle = np.add.reduceat(fills.colours.mean(axis=1), fills.offsets[:-1]) / np.diff(fills.offsets)
    area = shapely.area(polygons_of(fills.points.T, fills.offsets))
    brightness = [np.average(middle[fills.item == k], weights=area[fills.item == k]) for k in range(3)]
    assert brightness[0] > brightness[1] > brightness[2], "so it is in the picture: mat, wood, normal"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

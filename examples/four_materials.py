"""One body of revolution in four materials: plastic, metallic, wooden, and as nothing in particular.

They differ in how light falls off with its angle, and in a highlight where its reflection meets the eye.
Source: Glaeser, section 8.5, figure 18.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.curves import curve_of_function
from vectorplot.surfaces import revolution_surface

MATERIALS = ("plastic", "metallic", "wood", "normal")
LIGHT = vp.Light((-3, -4, 4), parallel=True, intensity=1.0)


def main(folder: Path) -> None:
    meridian = curve_of_function(lambda t: (0.75 + 0.32 * np.sin(1.7 * t) + 0.1 * np.cos(5 * t), 0 * t, t), -1.6, 1.6)
    body = revolution_surface(meridian)
    camera = vp.Camera(eye=(1, -10, 4), fov_deg=26)
    pictures = {}
    for word in MATERIALS:
        item = vp.Item(word.upper(), body, "orange", vp.Material(word))
        scene = vp.Scene((item,), (LIGHT,), title=word.capitalize())
        pictures[word] = vp.render(scene, camera, size=(150, 220), samples=3, shadows="none").pixels
    vp.save(vp.Image(np.concatenate(list(pictures.values()), axis=1), "Materials"), folder / "four_materials.png")

    shades = {word: picture.astype(float).mean(axis=2) for word, picture in pictures.items()}
    for number, word in enumerate(MATERIALS):
        for other in MATERIALS[number + 1 :]:
            assert np.abs(shades[word] - shades[other]).mean() > 1, "four different pictures"
    inside = shades["normal"] < 225
    spread = {word: shade[inside].std() for word, shade in shades.items()}
    assert spread["wood"] < spread["normal"], "wood is more even"
    assert np.median(shades["metallic"][inside]) < np.median(shades["wood"][inside]), (
        "metal is dark but for its highlight"
    )


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

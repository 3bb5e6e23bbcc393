"""The same scenes rendered and painted: regions have the same mean colours, from Python and from files."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pytest
from support.effort import several

import vectorplot as vp
from vectorplot.backends.cairo import png_bytes
from vectorplot.io.scene_writer import write_scene
from vectorplot.testing.shapes import box

COLUMNS, ROWS = 240, 180
PAGE = vp.Page(COLUMNS / 2.0, ROWS / 2.0, 0.0)
ABOVE = vp.Camera((0.0, 0.0, 30.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0), parallel=True, height=9.0)
ASKEW = vp.Camera((5.0, -12.0, 26.0), (0.0, 0.0, 0.0), fov_deg=18.0)
OFF = 2.5
"""Nine regions of ten may differ by so many of 255 steps, the others by twice as many."""

SUN = vp.Light((1.0, 0.4, 2.5), parallel=True, intensity=0.9)
SECOND = vp.Light((-1.2, 0.7, 2.0), parallel=True, intensity=0.6)
LAMP = vp.Light((-3.0, 2.5, 9.0), intensity=1.0)
AMID = vp.Light((0.4, -0.3, 3.2), intensity=1.0)
RED = replace(SUN, colour="#ff4040")

MATERIALS = ("normal", "mat", "wood", "metallic", "plastic", "shiny")


def tiles(word: str = "normal", colour: str = "yellow") -> list[vp.Item]:
    """Small plates beside each other: on each of them light is nearly even."""
    return [
        vp.Item(f"T{i}{j}", box((x - 0.55, y - 0.55, -0.3), (x + 0.55, y + 0.55, 0)), colour, vp.Material(word))
        for i, x in enumerate(np.arange(-4.2, 4.3, 1.2).round(2).tolist())
        for j, y in enumerate(np.arange(-3.0, 3.1, 1.2).round(2).tolist())
    ]


def over(name: str, x: float, y: float, z: float, colour: str, opacity: float = 1.0, size: float = 1.6) -> vp.Item:
    return vp.Item(name, box((x, y, z), (x + size, y + size, z + 0.3)), colour, vp.Material("normal", opacity))


BLOCK = over("BLOCK", -0.8, -0.8, 1.2, "cyan")
BALCONY = over("BALCONY", 1.5, -2.0, 1.5, "magenta", 1.0, 1.2)


def scenes() -> dict[str, vp.Scene]:
    """A table of scenes, each with one thing that both verbs have to mean alike."""
    found = {f"material {word}": vp.Scene((*tiles(word), BLOCK), (SUN,)) for word in MATERIALS}
    for opacity in (0.25, 0.5, 0.8):
        found[f"opacity {opacity}"] = vp.Scene((*tiles(), over("PANE", -1, -1, 1, "black", opacity, 2.4)), (SUN,))
        found[f"coloured shadow {opacity}"] = vp.Scene(
            (*tiles(colour="gray"), over("PANE", -1, -1, 1, "blue", opacity, 2.4), BLOCK), (SUN, SECOND)
        )
    found["two panes of one colour"] = vp.Scene(
        (*tiles(), over("P", -1, -1, 1, "green", 0.5, 2.0), over("Q", -0.4, -0.6, 2, "green", 0.5, 2.0)), (SUN,)
    )
    lights = {"sun": (SUN,), "two": (SUN, SECOND), "red and white": (RED, SECOND), "lamp": (LAMP,), "amid": (AMID,)}
    for name, some in lights.items():
        found[f"lights {name}"] = vp.Scene((*tiles(), BLOCK, BALCONY), some)
        if not some[0].parallel:
            faint = tuple(replace(light, fading=True) for light in some)
            found[f"fading {name}"] = vp.Scene((*tiles(), BLOCK, BALCONY), faint)
    found["no light"] = vp.Scene((*tiles(), BLOCK, over("PANE", 2, -2, 1, "blue", 0.4)))
    rug = vp.Item("RUG", box((-0.4, -0.4, -0.2), (0.9, 0.6, 0)), "magenta")
    found["one plane"] = vp.Scene((*tiles(), rug, BALCONY), (SUN,))
    return found


SCENES = scenes()


def painted(scene: vp.Scene, camera: vp.Camera, **options: str) -> np.ndarray:
    """(rows, columns, 3) what paint shows."""
    import cairo

    drawing = vp.paint(scene, camera, page=PAGE, fit=False, palette=256, **options)
    surface = cairo.ImageSurface.create_from_png(io.BytesIO(png_bytes(drawing, 2.0 * 25.4)))
    pixels = np.ndarray((surface.get_height(), surface.get_stride() // 4, 4), np.uint8, surface.get_data())
    return pixels[:, :COLUMNS, 2::-1].astype(float)


def rendered(scene: vp.Scene, camera: vp.Camera, **options: str) -> np.ndarray:
    """(rows, columns, 3) what render shows."""
    shadows = "exact" if scene.lights and options.get("shadows") != "none" else "none"
    picture = vp.render(scene, camera, size=(COLUMNS, ROWS), fit=False, samples=1, shadows=shadows)
    return picture.pixels.astype(float)


def regions(pixels: np.ndarray) -> np.ndarray:
    """(rows, columns) the numbers of regions that have one colour, without what is near their borders; 0 elsewhere."""
    from scipy import ndimage

    even = np.ones(pixels.shape[:2], dtype=bool)
    for axis in (0, 1):
        for step in (-2, -1, 1, 2):
            even &= (np.abs(pixels - np.roll(pixels, step, axis=axis)) <= 2.0).all(axis=2)
    labels, count = ndimage.label(even)
    sizes = np.bincount(labels.ravel(), minlength=count + 1)
    return np.where(sizes[labels] >= 25, labels, 0)


def differences(scene: vp.Scene, camera: vp.Camera, **options: str) -> np.ndarray:
    """(k,) by how much the mean colours of regions differ between the verbs."""
    one, other = painted(scene, camera, **options), rendered(scene, camera, **options)
    labels = regions(one)
    names = np.unique(labels[labels > 0])
    means = [np.stack([[p[labels == n].mean(axis=0) for n in names]])[0] for p in (one, other)]
    return np.abs(means[0] - means[1]).max(axis=1)


@pytest.mark.slow
@pytest.mark.parametrize("name", SCENES)
def test_regions_have_the_same_mean_colours_painted_and_rendered(name: str) -> None:
    ways = [(ABOVE, "auto"), (ASKEW, "auto"), (ABOVE, "none")]
    # The scenes take turns: each way comes up for every sort of them.
    for camera, shadows in ways[several(list(SCENES).index(name) % 3, long=0) :: several(3, long=1)]:
        off = differences(SCENES[name], camera, shadows=shadows)
        assert len(off) > 40
        assert np.quantile(off, 0.9) < OFF and off.max() < 2.0 * OFF


@pytest.mark.slow
@pytest.mark.parametrize("name", ["coloured shadow 0.5", "fading amid", "lights red and white", "one plane"])
def test_scenes_from_files_look_like_those_from_python(name: str, tmp_path) -> None:
    path = tmp_path / "table.scene"
    path.write_text(write_scene(SCENES[name]))
    read = vp.read(path)
    for verb in (painted, rendered):
        assert np.abs(verb(read, ABOVE) - verb(SCENES[name], ABOVE)).max() <= 1.0


def test_the_comparison_finds_what_differs() -> None:
    lit, unlit = SCENES["lights sun"], SCENES["no light"]
    one, other = painted(lit, ABOVE), rendered(unlit, ABOVE)
    labels = regions(one)
    means = [np.array([p[labels == n].mean() for n in np.unique(labels[labels > 0])]) for p in (one, other)]
    assert np.quantile(np.abs(means[0] - means[1]), 0.5) > 2.0 * OFF

"""Lambert's law: the flatter light falls in, the darker is the face.

Six sheets turn away from parallel light in steps of fifteen degrees. Each takes the shade of its palette that belongs
to the cosine of the angle between its normal and the light. Source: Glaeser, section 4.5, figure 3.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import placed
from vectorplot.shading import DIRECT_SHARE, palette

SHEET = vp.Mesh.from_polygons([(-0.9, -0.9, 0), (0.9, -0.9, 0), (0.9, 0.9, 0), (-0.9, 0.9, 0)], [(0, 1, 2, 3)])
TOWARDS = np.array([0.0, -1.0, 1.0]) / np.sqrt(2.0)
"""Where the light comes from, and the eye looks from."""


def sheet(number: int, alpha: float) -> vp.Item:
    """A sheet whose normal makes an angle with the light."""
    across = np.array([1.0, 0.0, 0.0])
    up = np.cross(TOWARDS, across)
    normal = np.cos(alpha) * TOWARDS + np.sin(alpha) * across
    side = np.cross(up, normal)
    columns = np.column_stack([side, up, normal, (2.1 * number, 0, 0)])
    return vp.Item(f"SHEET{number}", placed(SHEET, columns.ravel()), "orange")


def main(folder: Path) -> None:
    angles = np.radians(np.arange(0, 90, 15))
    sheets = tuple(sheet(number, alpha) for number, alpha in enumerate(angles))
    scene = vp.Scene(sheets, (vp.Light(tuple(TOWARDS), parallel=True, intensity=1.0),), title="Lambert's law")
    camera = vp.Camera(eye=tuple(40 * TOWARDS + (5, 0, 0)), target=(5, 0, 0), up=(0, 1, 1), parallel=True)
    drawing = vp.paint(scene, camera, page=vp.Page(150, 40, 4))
    vp.save(drawing, folder / "shading_angle.svg")

    (fills,) = drawing.layers[0].fills
    colour = {drawing.items[i]: fills.colours[at] for i, at in zip(fills.item, fills.offsets[:-1], strict=True)}
    shades = palette("orange").astype(int)
    number = [int(np.abs(shades - colour[item.name]).sum(axis=1).argmin()) for item in sheets]
    # What is nearest to the eye is a little brighter: at most by the fifth of the palette that is ambient light.
    least = np.floor((len(shades) - 1) * DIRECT_SHARE * np.cos(angles))
    assert (np.diff(number) < 0).all() and (number >= least).all()
    assert (number - least <= (len(shades) - 1) * (1 - DIRECT_SHARE) + 1).all()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

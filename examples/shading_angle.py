"""Lambert's law: the flatter light falls in, the darker is the face.

Six sheets turn away from parallel light in steps of fifteen degrees. Each takes the shade of its palette that belongs
to the cosine of the angle between its blue normal and the light; an ochre bundle of rays as wide as the first sheet
spreads over more and more of a sheet. Source: Glaeser, section 4.5, figure 3.
"""

import sys
from pathlib import Path

import numpy as np
from diagrams import BLUE, INK, OCHRE, drawn, line, outline, tinted, with_arrows

import vectorplot as vp
from vectorplot.geometry import placed
from vectorplot.shading import DIRECT_SHARE, palette

SHEET = vp.Mesh.from_polygons([(-0.8, -0.8, 0), (0.8, -0.8, 0), (0.8, 0.8, 0), (-0.8, 0.8, 0)], [(0, 1, 2, 3)])
ANGLES = np.radians(np.arange(0, 90, 15))
CAMERA = vp.Camera(eye=(16, -22, 14), parallel=True)


def main(folder: Path) -> None:
    sheets, lines, feet, normals, hits = [], [], [], [], []
    for k, alpha in enumerate(ANGLES):
        c, s = np.cos(alpha), np.sin(alpha)
        place = 2.6 * k * np.array(CAMERA.axes[0])
        normal = np.array([s, 0, c])
        shape = placed(SHEET, (c, 0, s, place[0], 0, 1, 0, place[1], -s, 0, c, place[2]))
        sheets.append(vp.Item(f"SHEET{k}", shape, "orange", lines=()))
        lines += outline(f"EDGE{k}", [*shape.vertices], INK)
        lines.append(line(f"NORMAL{k}", place, place + 1.5 * normal, BLUE))
        feet.append(place)
        normals.append(place + 1.5 * normal)
        # Rays a fifth of the sheet apart: fewer and fewer meet it.
        across = np.arange(-2, 3) * 0.36
        for x in across[np.abs(across) < 0.8 * c]:
            hits.append(place + np.array([x, 0, -x * s / c]))
            lines.append(line(f"RAY{k} {x:.2f}", hits[-1], (*hits[-1][:2], 2.4), OCHRE))

    scene = vp.Scene(tuple(sheets), (vp.Light((0, 0, 1), parallel=True, intensity=1.0),), title="Lambert's law")
    everything = vp.Scene((*sheets, *lines), title=scene.title)
    drawing = drawn(everything, CAMERA, vp.Page(180, 60, 5), {INK: 0.3, BLUE: 0.5, OCHRE: 0.3})
    drawing = tinted(drawing, scene, CAMERA, shadows="none")
    drawing = with_arrows(drawing, feet, normals, BLUE)
    drawing = with_arrows(drawing, np.add(hits, (0, 0, 1)), hits, OCHRE, 2.0)
    vp.save(drawing, folder / "shading_angle.svg")

    (fills,) = vp.paint(scene, CAMERA, shadows="none").layers[0].fills
    # A sheet that reaches far into the picture has shades that vary with the depth: the middle one counts.
    pieces = zip(fills.item, fills.offsets[:-1], fills.offsets[1:], strict=True)
    colour = {scene.items[i].name: fills.colours[a:b].mean(axis=0) for i, a, b in pieces}
    shades = palette("orange").astype(int)
    number = [int(np.abs(shades - colour[item.name]).sum(axis=1).argmin()) for item in sheets]
    # What is nearest to the eye is a little brighter: at most by the fifth of the palette that is ambient light.
    least = np.floor((len(shades) - 1) * DIRECT_SHARE * np.cos(ANGLES))
    assert (np.diff(number) < 0).all() and (number >= least).all()
    assert (number - least <= (len(shades) - 1) * (1 - DIRECT_SHARE) + 1).all()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

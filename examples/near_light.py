"""A lamp near a floor: light becomes weaker with the square of the distance.

Once the floor takes the light at its angle only, once it fades as well; what is nearest to the lamp keeps what it has.
Circles are lines of equal distance from the lamp, whose rays end on them. Source: Glaeser, section 4.5, equation 4,
figure 5.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from diagrams import INK, RED, drawn, line, outline, tinted, with_arrows, with_dots

import vectorplot as vp
from vectorplot.curves import Circle
from vectorplot.scene import look
from vectorplot.shading import face_middles, face_shades, view_lights

LAMP = vp.Light((0.0, 0.0, 2.6), intensity=1.0)
CAMERA = vp.Camera(eye=(2.5, -15, 10), target=(0, 0, 0.4), fov_deg=30)
RADII = (1.2, 2.4, 3.6, 4.8)


CORNERS = np.array([(-6, -5, 0), (6, -5, 0), (6, 5, 0), (-6, 5, 0)], dtype=float)


def grid(columns: int, rows: int) -> vp.Mesh:
    """The floor in small squares, so that light varies as it should between their corners."""
    x, y = np.meshgrid(np.linspace(-6, 6, columns + 1), np.linspace(-5, 5, rows + 1))
    at = np.arange(x.size).reshape(x.shape)
    squares = np.stack([at[:-1, :-1], at[:-1, 1:], at[1:, 1:], at[1:, :-1]], axis=-1).reshape(-1, 4)
    return vp.Mesh.from_polygons(np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()]), squares.tolist())


def tiles() -> tuple[vp.Item, ...]:
    """A floor of square tiles, each an item, one of them in the middle below the lamp."""
    places = np.arange(-6, 7)
    corners = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]) / 2
    spots = [(x, y, 0.0) for x in places for y in places]
    return tuple(vp.Item(f"T{k}", vp.Mesh.from_polygons(corners + spot, [range(4)])) for k, spot in enumerate(spots))


def main(folder: Path) -> None:
    floor = vp.Item("FLOOR", grid(48, 40), "yellow")
    turn = np.linspace(-0.4, 2 * np.pi - 0.4, len(RADII) + 1)[:-1] * 0.5
    ends = np.column_stack([RADII * np.cos(turn), RADII * np.sin(turn) - 0.3, 0 * turn])
    ends *= (np.array(RADII) / np.linalg.norm(ends, axis=1))[:, None]
    circles = [vp.Item(f"C{k}", Circle((0, 0, 0), r), INK) for k, r in enumerate(RADII)]
    rays = [line(f"RAY{k}", LAMP.position, end, RED) for k, end in enumerate(ends)]
    plumb = line("PLUMB", LAMP.position, (0, 0, 0), INK)
    edges = vp.Scene((*outline("EDGE", CORNERS, INK), *circles, *rays, plumb), title="A lamp near the floor")
    plain = vp.Scene((floor,), (LAMP,))
    fading = replace(plain, lights=(replace(LAMP, fading=True),))
    for name, scene in (("angle", plain), ("distance", fading)):
        drawing = drawn(edges, CAMERA, vp.Page(150, 92, 5), {INK: 0.18, RED: 0.4})
        drawing = tinted(drawing, scene, CAMERA, shadows="none", tolerance_mm=0.1)
        drawing = with_arrows(drawing, [LAMP.position] * len(ends), ends, RED, 3.0)
        vp.save(with_dots(drawing, [LAMP.position], RED, 2.4), folder / f"near_light_{name}.svg")

    view = look(vp.Scene(tiles()), CAMERA)
    items = tiles()
    plainly = face_shades(view, items, view_lights(view, plain.lights))
    weaker = face_shades(view, items, view_lights(view, fading.lights))
    factor = weaker.shares[0] / plainly.shares[0]
    # The lamp stands above a tile: its height is the distance of the nearest point, which keeps what it has.
    distance = np.linalg.norm(view.world_of(face_middles(view)) - LAMP.position, axis=1)
    assert np.allclose(factor, (LAMP.position[2] / distance) ** 2) and 0.98 < factor.max() <= 1.0 + 1e-12
    assert (weaker.total <= plainly.total + 1e-12).all()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

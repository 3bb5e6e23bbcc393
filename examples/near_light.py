"""A lamp near a floor: light becomes weaker with the square of the distance.

Once every tile takes the light at its angle only, once it fades as well; what is nearest to the lamp keeps what it
has. Source: Glaeser, section 4.5, equation 4, figure 5.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.scene import look
from vectorplot.shading import face_middles, face_shades, view_lights

LAMP = vp.Light((0.5, 0.5, 4.0), intensity=1.0)
COLUMNS, ROWS = 20, 12


def tiles() -> tuple[vp.Item, ...]:
    """A floor of square tiles, each an item."""
    corners = np.array([(0, 0, 0), (0.5, 0, 0), (0.5, 0.5, 0), (0, 0.5, 0)])
    places = [(0.5 * column, 0.5 * row, 0.0) for row in range(ROWS) for column in range(COLUMNS)]
    return tuple(
        vp.Item(f"TILE{k}", vp.Mesh.from_polygons(corners + place, [range(4)])) for k, place in enumerate(places)
    )


def main(folder: Path) -> None:
    camera = vp.Camera(eye=(5, -9, 9), target=(5, 2.8, 0), fov_deg=30)
    scene = vp.Scene(tiles(), (LAMP,), title="A lamp near the floor")
    drawing = vp.paint(scene, camera, page=vp.Page(110, 60, 3), shadows="none")
    vp.save(drawing, folder / "near_light_angle.svg")

    fading = replace(scene, lights=(replace(LAMP, fading=True),))
    vp.save(vp.paint(fading, camera, page=vp.Page(110, 60, 3), shadows="none"), folder / "near_light_distance.svg")

    view = look(scene, camera)
    lights, middles = view_lights(view, scene.lights), face_middles(view)
    plain = face_shades(view, scene.items, lights)
    weaker = face_shades(view, scene.items, view_lights(view, fading.lights))

    factor = weaker.shares[0] / plain.shares[0]
    # The lamp stands above a tile: its height is the distance of the nearest point, which keeps what it has.
    distance = np.linalg.norm(view.world_of(middles) - LAMP.position, axis=1)
    assert np.allclose(factor, (LAMP.position[2] / distance) ** 2) and 0.98 < factor.max() <= 1.0
    assert (weaker.total <= plain.total + 1e-12).all()


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

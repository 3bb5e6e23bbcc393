"""A plane between two bodies: the one that is not on the eye's side is painted first.

The plane is found in space, once; whoever looks from the other side has the other order. Source: Glaeser, section
5.1, figure 1, and section 5.8.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import box, placed, revolution
from vectorplot.textbook import Surroundings, separations

EYES = ((7.0, -15.0, 7.0), (-7.0, 15.0, 7.0))
LIGHT = vp.Light((-3, -5, 7), parallel=True, intensity=0.9)


def moved(mesh: vp.Mesh, x: float, y: float, degrees: float) -> vp.Mesh:
    """A mesh turned about the z-axis, and moved."""
    c, s = np.cos(a := np.radians(degrees)), np.sin(a)
    return placed(mesh, (c, -s, 0, x, s, c, 0, y, 0, 0, 1, 0))


def main(folder: Path) -> None:
    block = moved(box((3, 2, 2.5)), -1.8, -2.6, 12)
    tower = moved(revolution([(1.3, 0, 0), (1.3, 0, 2), (0, 0, 4.2)], 8), 0.3, 1.7, 0)
    apart = separations(Surroundings.of((block, tower)), np.array([0]), np.array([1]))
    assert np.isfinite(apart.planes).all() or abs(apart.info[0]) == 2
    gap = 0.25 * (block.vertices[:, 1].max() + tower.vertices[:, 1].min()) * 2.0
    pane = vp.Mesh.from_polygons([(-3.5, gap, 0), (3.5, gap, 0), (3.5, gap, 4.4), (-3.5, gap, 4.4)], [range(4)])
    clear = vp.Item("PLANE", pane, "green", vp.Material("transparent", 0.35), occludes=False)
    scene = vp.Scene((vp.Item("BLOCK", block, "orange"), vp.Item("TOWER", tower, "blue"), clear), (LIGHT,))
    for number, eye in enumerate(EYES):
        camera = vp.Camera(eye=eye, target=(0, 0, 1.6), fov_deg=26)
        drawing = vp.paint(scene, camera, page=vp.Page(100, 80, 3), shadows="none")
        vp.save(drawing, folder / f"separating_plane_{number + 1}.svg")

        (fills,) = drawing.layers[0].fills
        places = [np.flatnonzero(fills.item == item) for item in (0, 1, 2)]
        nearer, farther = (0, 1) if eye[1] < gap else (1, 0)
        assert (block.vertices[:, 1] < gap).all() and (tower.vertices[:, 1] > gap).all()
        assert places[farther].max() < places[2].min() and places[2].max() < places[nearer].min()
        assert apart.nearer(eye)[0] == (1 if nearer == 0 else -1), "the plane that was found says so too"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

"""A shadow on a face: the caster as the lamp sees it, clipped by the face, and taken back to the face along the rays.

The rays of light are drawn through the corners. All is done in the lamp's image, where both are plane polygons.
Source: Glaeser, section 6.3, figure 4.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.drawing import FillKind, Fills
from vectorplot.effects import shadow_decals
from vectorplot.scene import look

LAMP = np.array([-2.5, -3.0, 6.0])
CARD = np.array([(-1.7, -2.0, 2.6), (0.9, -1.6, 2.2), (0.5, 0.9, 2.9), (-1.2, 0.6, 3.2)])
CARD[:, 2] = 2.6 + 0.15 * CARD[:, 0] + 0.2 * CARD[:, 1]
FLOOR = np.array([(-1.0, -3.0, 0.0), (3.5, -3.0, 0.0), (3.5, 2.2, 0.0), (-1.0, 2.2, 0.0)])


def main(folder: Path) -> None:
    sheets = (("FLOOR", FLOOR, "lightgray"), ("CARD", CARD, "orange"))
    items = tuple(vp.Item(name, vp.Mesh.from_polygons(corners, [range(4)]), colour) for name, corners, colour in sheets)
    lamp = vp.Light(tuple(LAMP), intensity=1.0)
    scene = vp.Scene(items, (lamp,), title="A shadow on a face")
    camera = vp.Camera(eye=(5, -15, 8), target=(0.6, -0.8, 2.0), fov_deg=34)
    drawing = vp.paint(scene, camera, page=vp.Page(110, 100, 8), fit=False)

    view = look(scene, camera)
    decals = shadow_decals(view, (lamp,))
    (shadow,) = np.split(view.world_of(decals.points), decals.offsets[1:-1])
    hit = LAMP + (CARD - LAMP) * (LAMP[2] / (LAMP[2] - CARD[:, 2]))[:, None]
    assert np.abs(shadow[:, 2]).max() < 1e-9, "the shadow lies in the plane of the face"
    low, high = FLOOR.min(axis=0) - 1e-9, FLOOR.max(axis=0) + 1e-9
    assert ((shadow >= low) & (shadow <= high)).all(), "and inside the face"
    inner = hit[((hit >= low) & (hit <= high)).all(axis=1)]
    gap = np.linalg.norm(shadow[:, None] - inner, axis=2).min(axis=0)
    assert 0 < len(inner) < 4 and gap.max() < 1e-9, "corners lie on rays; some corners were cut off"
    back = LAMP + (shadow - LAMP) * 0.5
    normal = np.cross(CARD[1] - CARD[0], CARD[3] - CARD[0])
    through = LAMP + (back - LAMP) * (((CARD[0] - LAMP) @ normal) / ((back - LAMP) @ normal))[:, None]
    sides = np.cross(np.roll(CARD, -1, axis=0) - CARD, through[:, None] - CARD) @ normal
    assert (sides >= -1e-9).all(), "from each of its points the card hides the lamp"

    rays = np.stack([np.broadcast_to(LAMP, (4, 3)), hit], axis=1).reshape(-1, 3)
    flat = np.column_stack([rays, np.ones(8)]) @ drawing.page_from_world.T
    page = flat[:, :2] / flat[:, 3:]
    lines = Fills.flat(page, 2 * np.arange(5), np.zeros((4, 3), np.uint8), points3d=rays, kind=FillKind.EDGE)
    (layer,) = drawing.layers
    vp.save(
        replace(drawing, layers=(replace(layer, pen=vp.Pen(0.18), marks=(*layer.marks, lines)),)),
        folder / "shadow_clipping.svg",
    )


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

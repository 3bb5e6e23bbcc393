"""A shadow on a face: the caster as the lamp sees it, clipped by the face, and taken back to the face along the rays.

Rays of the lamp run through the corners of the card to the plane of the floor, where they end in the corners of its
shadow; dashed is what falls beside the floor. Source: Glaeser, section 6.3, figure 4.
"""

import sys
from pathlib import Path

import numpy as np
from diagrams import GREY, INK, OCHRE, RED, drawn, line, outline, sheet, tinted, with_arrows, with_dots

import vectorplot as vp
from vectorplot.effects import shadow_decals
from vectorplot.scene import look

LAMP = np.array([-2.5, -3.0, 6.0])
CARD = np.array([(-1.7, -2.0, 2.6), (0.9, -1.6, 2.2), (0.5, 0.9, 2.9), (-1.2, 0.6, 3.2)])
CARD[:, 2] = 2.6 + 0.15 * CARD[:, 0] + 0.2 * CARD[:, 1]
FLOOR = np.array([(-3.6, -3.6, 0.0), (3.0, -3.6, 0.0), (3.0, 2.2, 0.0), (-3.6, 2.2, 0.0)])


def main(folder: Path) -> None:
    lamp = vp.Light(tuple(LAMP), intensity=1.0)
    scene = vp.Scene((sheet("FLOOR", FLOOR, "#f1ede4"), sheet("CARD", CARD, "#f0a07a")), (lamp,))
    camera = vp.Camera(eye=(7.5, -14, 9), target=(0.6, -0.8, 2.0), fov_deg=34)

    decals = shadow_decals(look(scene, camera), (lamp,))
    (shadow,) = np.split(look(scene, camera).world_of(decals.points), decals.offsets[1:-1])
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

    beside = [part for a, b in zip(hit, np.roll(hit, -1, axis=0), strict=True) for part in dashed(a, b)]
    items = (
        *scene.items,
        *(line(f"RAY{k}", LAMP, end, OCHRE) for k, end in enumerate(hit)),
        *(line(f"BESIDE{k}", a, b, GREY) for k, (a, b) in enumerate(beside)),
        *outline("SHADOW", shadow, RED),
        *outline("EDGE", [*CARD], INK),
        *outline("BORDER", [*FLOOR], INK),
    )
    all_drawn = vp.Scene(items, title="A shadow on a face")
    widths = {OCHRE: 0.3, RED: 0.6, INK: 0.35, GREY: 0.3}
    drawing = tinted(drawn(all_drawn, camera, vp.Page(150, 120, 5), widths), scene, camera)
    drawing = with_arrows(drawing, [LAMP] * 4, hit, OCHRE)
    vp.save(with_dots(with_dots(drawing, CARD, INK), [LAMP], OCHRE, 2.4), folder / "shadow_clipping.svg")


def dashed(start, end, count=15):
    """Every other part of a segment that lies beside the floor."""
    stops = start + np.linspace(0, 1, 2 * count + 1)[:, None] * (end - start)
    beyond = (stops < FLOOR.min(axis=0) - 1e-9).any(axis=1) | (stops > FLOOR.max(axis=0) + 1e-9).any(axis=1)
    return [stops[k : k + 2] for k in range(0, 2 * count, 2) if beyond[k] and beyond[k + 1]]


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

"""A chess pawn split into convex parts, whole and pulled apart.

A body of revolution whose meridian bends inwards is not convex, but its slices between certain horizontal planes are.
Together they fill the body. Source: Glaeser, section 3.4, figure 4.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import has_convex_outline, revolution, translated
from vectorplot.textbook import body_record, convex_revolution_parts

RADII = [1.5, 1.5, 1.1, 0.55, 0.4, 0.8, 0.8, 0.45, 0.70, 0.83, 0.83, 0.70, 0]
HEIGHTS = [0, 0.4, 0.8, 1.5, 2.6, 2.8, 3, 3.15, 3.24, 3.53, 3.87, 4.16, 4.4]
PAWN = np.stack([RADII, np.zeros(len(RADII)), HEIGHTS], axis=1)
ORDER = 16


def main(folder: Path) -> None:
    body = revolution(PAWN, ORDER)
    parts = convex_revolution_parts(PAWN, ORDER)
    middle = body.vertices.mean(axis=0)
    lifts = [0.8 * (part.vertices[:, 2].mean() - middle[2]) for part in parts]
    apart = [
        replace(part, vertices=translated(part.vertices, (0, 0, lift))) for part, lift in zip(parts, lifts, strict=True)
    ]
    camera = vp.Camera(eye=(9, -16, 11), target=tuple(middle), fov_deg=24)
    whole = vp.Scene((vp.Item("PAWN", body),), title="Pawn")
    pieces = vp.Scene(tuple(vp.Item(f"PART{k}", part) for k, part in enumerate(apart)), title="Pawn in parts")
    page, lines = vp.Page(120, 130, 6), ("contour", "crease", "edges")
    vp.save(vp.draw(whole, camera, page=page, lines=lines), folder / "convex_parts_1.svg")
    vp.save(vp.draw(pieces, camera, page=page, lines=lines), folder / "convex_parts_2.svg")

    assert not has_convex_outline(body) and all(has_convex_outline(part) for part in parts)
    volumes = [body_record(part).volume for part in parts]
    assert np.isclose(sum(volumes), body_record(body).volume)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

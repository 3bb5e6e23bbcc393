"""Contours of one field of a mesh, streamlines and arrows of another one.

The fields are numbers at the vertices, as files of VTK have them: here a stream around a hill, and its speed.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.features import VectorField
from vectorplot.scene import FieldContours, FieldLines, Fields, NamedVectors, field_arrows

SIDE = 49


def ground() -> vp.Item:
    """A hill with the fields speed and stream."""
    x, y = (one.ravel() for one in np.meshgrid(np.linspace(-3, 3, SIDE), np.linspace(-3, 3, SIDE), indexing="ij"))
    far = x * x + y * y + 0.4
    place = np.arange(SIDE * SIDE).reshape(SIDE, SIDE)
    quads = np.stack([place[:-1, :-1], place[1:, :-1], place[1:, 1:], place[:-1, 1:]], axis=-1).reshape(-1, 4)
    mesh = vp.Mesh.from_polygons(np.stack([x, y, 1.2 / (1.0 + far * far)], axis=1).tolist(), quads.tolist())
    # The stream of a dipole in a wind along x.
    stream = np.stack([1.0 - (x * x - y * y) / far**2, -2.0 * x * y / far**2, 0.0 * x], axis=1)
    fields = Fields.of(mesh, {"stream": stream, "speed": np.hypot(stream[:, 0], stream[:, 1])}, {})
    assert fields is not None
    lines = vp.SurfaceLines(
        contours=(FieldContours("speed", 10),), integral=(FieldLines(VectorField(NamedVectors("stream")), 0.28),)
    )
    return vp.Item("GROUND", mesh, fields=fields, curves=lines, lines=("contour", "boundary", "section", "integral"))


def main(folder: Path) -> None:
    item = ground()
    arrows = field_arrows(item, "stream", apart=0.75, longest=0.6)
    pens = "section=0.18:#b03030,integral=0.25:#204080,label=0.3"
    drawing = vp.draw([item, arrows], vp.Camera((7, -12, 10), (0, 0, 0.2), fov_deg=25), page="160x110", pens=pens)
    vp.save(drawing, folder / "field_lines.svg")


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

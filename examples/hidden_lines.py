"""Hidden lines dashed, on a layer of their own, for another pen.

Look at the dashes: they are real strokes, and every one knows behind how many bars it lies. None is lost: what is
visible and what is hidden make up all edges of the three bars.
"""

import sys
from itertools import pairwise
from pathlib import Path

import numpy as np

import vectorplot as vp

DATA = Path(__file__).resolve().parent.parent / "data"


def edge_length(drawing: vp.Drawing) -> float:
    """Length in space of all strokes that are edges."""
    total = 0.0
    for paths in (paths for layer in drawing.layers for paths in layer.strokes):
        for (first, last), closed in zip(pairwise(paths.offsets), paths.closed, strict=True):
            points = paths.points3d[first:last]
            along = np.diff(points, axis=0, append=points[:1] if closed else points[-1:])
            total += np.linalg.norm(along, axis=1).sum()
    return float(total)


def main(folder: Path) -> None:
    bars = vp.read(DATA / "three_bars.scene")
    vp.save(vp.draw(bars, hidden="dashed"), folder / "hidden_lines.svg")

    whole = vp.draw(bars, hidden="solid")
    behind = next(layer for layer in whole.layers if layer.name == "hidden")
    assert np.concatenate([paths.hidden_by for paths in behind.strokes]).min() >= 1
    assert np.isclose(edge_length(whole), 3 * 4 * (8.4 + 1.0 + 0.5))


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

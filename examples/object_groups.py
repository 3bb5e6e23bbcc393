"""Groups of objects: first the order of the groups, then the order inside each.

A table with its things and a cupboard with its books are two groups. Few pairs are compared: groups with groups, and
the members of each among themselves. Where groups lie on each other in a circle they are taken apart. Source:
Glaeser, section 5.7, figure 12.
"""

import sys
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import box, revolution, translated
from vectorplot.scene import look
from vectorplot.textbook import demands, grouped_order, priorities, view_objects


def block(name: str, lengths: tuple[float, float, float], place: tuple[float, float, float], colour: str) -> vp.Item:
    """A box in its place."""
    mesh = box(lengths)
    return vp.Item(name, vp.Mesh(translated(mesh.vertices, place), mesh.corners, mesh.offsets), colour)


MUG = revolution([(0.4, 0, 0), (0.4, 0, 0.9)], 16)
TABLE = (
    block("TOP", (5, 3, 0.25), (-3.5, -3.5, 2), "orange"),
    *(
        block(f"LEG{k}", (0.3, 0.3, 2), p, "darkorange")
        for k, p in enumerate([(-3.3, -3.3, 0), (1, -3.3, 0), (1, -1, 0), (-3.3, -1, 0)])
    ),
    vp.Item("MUG", vp.Mesh(translated(MUG.vertices, (-0.2, -2.4, 2.25)), MUG.corners, MUG.offsets), "cyan"),
    block("BOOK", (1.4, 1, 0.3), (-2.6, -2.5, 2.25), "green"),
)
SHELF = (
    block("FOOT", (3, 1.6, 0.5), (1.4, 0.4, 0), "yellow"),
    block("BACK", (3, 0.3, 4), (1.4, 2, 0), "darkyellow"),
    *(
        block(f"VOLUME{k}", (0.35, 1, 1.4), (1.6 + 0.5 * k, 0.8, 0.5), c)
        for k, c in enumerate(("blue", "pink", "green", "magenta", "orange"))
    ),
)


def main(folder: Path) -> None:
    items = (*TABLE, *SHELF)
    scene = vp.Scene(items, (vp.Light((-4, -6, 8), parallel=True, intensity=0.9),), title="Groups")
    camera = vp.Camera(eye=(9, -15, 9), target=(0, -0.6, 1.4), fov_deg=30)
    drawing = vp.paint(scene, camera, page=vp.Page(130, 90, 4))
    vp.save(drawing, folder / "object_groups.svg")

    group = np.array([0] * len(TABLE) + [1] * len(SHELF))
    before, after = demands(priorities(view_objects(look(scene, camera))))
    found = grouped_order(len(items), before, after, group)
    place = np.argsort(found.order)
    assert not found.undone and not found.cycles
    assert (place[before] < place[after]).all(), "the order inside the groups is right too"
    assert (np.diff(group[found.order]) != 0).sum() == 1, "one group comes after the other"
    within = (group[:, None] == group).sum() - len(items)
    assert within // 2 + 1 < len(items) * (len(items) - 1) // 2, "fewer pairs"


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

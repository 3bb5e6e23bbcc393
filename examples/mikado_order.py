"""The mikado sort: take off the stick that nothing lies on, and again.

Twelve painted sticks, then seven, then three: what is gone lay above. Where three sticks lie on one another in a
circle none can be taken off; such a Gordian knot is found among all others, and named. Source: Glaeser, section 5.6,
figure 11.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

import vectorplot as vp
from vectorplot.geometry import box, placed
from vectorplot.scene import look
from vectorplot.textbook import cyclic_overlap_report, cyclic_overlaps, demands, priorities, view_objects
from vectorplot.visibility import topological_order

COLOURS = ("orange", "green", "blue", "yellow", "pink", "cyan")
STICK = placed(box((9, 0.4, 0.3)), (1, 0, 0, -4.5, 0, 1, 0, -0.2, 0, 0, 1, 0))
LIGHT = vp.Light((-5, -4, 8), parallel=True, intensity=0.9)
KNOT = vp.read(Path(__file__).resolve().parent.parent / "data" / "three_bars.scene")


def sticks(count: int) -> tuple[vp.Item, ...]:
    """Level sticks, each higher than the one before, in any direction."""
    random = np.random.default_rng(5)
    items = []
    for k in range(count):
        c, s = np.cos(a := random.uniform(0, np.pi)), np.sin(a)
        x, y = random.uniform(-1.6, 1.6, 2)
        items.append(vp.Item(f"STICK{k}", placed(STICK, (c, -s, 0, x, s, c, 0, y, 0, 0, 1, 0.45 * k)), COLOURS[k % 6]))
    return tuple(items)


def main(folder: Path) -> None:
    scene = vp.Scene(sticks(12), (LIGHT,), title="Mikado")
    camera = vp.Camera(eye=(8, -18, 34), target=(0, 0, 1), fov_deg=20)
    before, after = demands(priorities(view_objects(look(scene, camera))))
    found = topological_order(12, before, after)
    place = np.argsort(found.order)
    assert not len(found.cycle) and (place[before] < place[after]).all()
    assert (before < after).all(), "the eye is above: higher sticks come later"
    for number, left in enumerate((12, 7, 3)):
        kept = tuple(scene.items[k] for k in sorted(found.order[:left]))
        drawing = vp.paint(replace(scene, items=kept), camera, page=vp.Page(90, 80, 3))
        vp.save(drawing, folder / f"mikado_order_{number + 1}.svg")

    tangled = replace(scene, items=(*scene.items[8:], *KNOT.items))
    assert KNOT.camera is not None
    before, after = demands(priorities(view_objects(look(tangled, KNOT.camera))))
    (knot,) = cyclic_overlaps(len(tangled.items), before, after)
    (sentence,) = cyclic_overlap_report([knot], [item.name for item in tangled.items])
    assert knot.tolist() == [4, 5, 6] and all(bar.name in sentence for bar in KNOT.items)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "docs/gallery"))

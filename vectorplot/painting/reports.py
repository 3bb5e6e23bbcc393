"""What is said about the order of a painted picture: groups, slices, knots."""

from __future__ import annotations

import warnings
from collections.abc import Mapping

from vectorplot.arrays import Ints
from vectorplot.curves.curve import is_curve
from vectorplot.errors import InputWarning
from vectorplot.geometry.budget import unresolved
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import Section
from vectorplot.stages.walk import Walk
from vectorplot.visibility.painter.painters_order import Painted

MOST_NAMES = 5
"""So many items of a knot are named."""


def group_names(scene: Scene) -> list[str]:
    """The groups of what is painted: lines that belong together have no order."""
    return sorted({item.group for item in scene.items if not is_curve(item.shape)} - {""})


def tell_groups(walk: Walk, scene: Scene, painted: Painted) -> None:
    """Tell the listener which groups stay together, and which do not."""
    names = group_names(scene)
    undone = [names[k] for k in painted.undone]
    if kept := [name for name in names if name not in undone]:
        walk.tell("groups", f"{', '.join(kept)}: ordered as wholes, then within", len(kept))
    if undone:
        walk.tell("groups undone", f"{', '.join(undone)}: something else comes between", len(undone))


def tell_slices(walk: Walk, scene: Scene, sliced: Mapping[int, Section], painted: Painted) -> None:
    """Tell the listener which items are painted slice by slice, and which are not."""
    for number, planes in sliced.items():
        name = scene.items[number].name
        if number in painted.ribbons:
            count = painted.ribbons[number]
            walk.tell("ribbons", f"{name}: in {len(planes.offsets) + 1} slices, ribbon by ribbon", count)
        else:
            walk.tell("ribbons undone", f"{name}: something else is in front of it or behind it", 0)


def tell_knots(walk: Walk, scene: Scene, painted: Painted) -> None:
    """Say which items were cut because no order of whole faces was right."""
    if len(painted) > painted.uncut:
        names = _names(scene, painted.knots)
        walk.tell("cut", f"{names}: they pierce one another, or overlap in circles", len(painted) - painted.uncut)


def warn_of_guesses(scene: Scene, painted: Painted) -> None:
    """An InputWarning for all items parts of which may be painted in a wrong order, and for all around which that is
    so."""
    _warn(scene, painted.guessed, "what pierces it, or itself, takes too many cuts, and is in order by depth alone")
    _warn(scene, painted.crowded, "too many faces overlap; they, and what overlaps them, are in order by depth alone")


def warn_of_single_polygons(scene: Scene, items: Ints) -> None:
    """An InputWarning for transparent items that are blended polygon by polygon in parts."""
    _warn(scene, items, "too much that is transparent lies on one another; polygons are blended one by one, with seams")


def _warn(scene: Scene, items: Ints, text: str) -> None:
    """One InputWarning about some items, if there are any."""
    if len(items):
        warnings.warn(f"{_names(scene, items)}: {unresolved(text)}", InputWarning, stacklevel=4)


def _names(scene: Scene, items: Ints) -> str:
    """The names of some items, the first MOST_NAMES of them."""
    names = ", ".join(scene.items[number].name for number in items[:MOST_NAMES].tolist())
    return f"{names} and {len(items) - MOST_NAMES} more" if len(items) > MOST_NAMES else names

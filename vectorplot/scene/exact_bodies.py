"""Bodies that are known by their surfaces in place of the triangles that stand for them."""

from __future__ import annotations

import warnings
from collections.abc import Set
from dataclasses import replace

from vectorplot.errors import InputWarning
from vectorplot.scene.hatching import Hatching, Stippling
from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene
from vectorplot.scene.surface_lines import SurfaceLines
from vectorplot.words import LineKind


def exact_bodies(scene: Scene, kinds: Set[LineKind], hatch: Hatching | Stippling | None) -> Scene:
    """The scene with the surfaces of bodies in place of their triangles, where these are as they were read and only
    lines are asked for that surfaces have.

    kinds: unless an item has its own; hatch: how items are hatched that do not say it themselves. Warns InputWarning:
    which items stay triangles, and why.
    """
    left = dict[str, list[str]]()
    items = list[Item]()
    for item in scene.items:
        why = "" if item.exact is None else _why_not(item, kinds, hatch)
        if why:
            left.setdefault(why, []).append(item.name)
        items.append(item if item.exact is None or why else _exact(item))
    for why, names in left.items():
        warnings.warn(f"{', '.join(names)}: drawn from triangles, not exactly, for {why}", InputWarning, stacklevel=3)
    return replace(scene, items=tuple(items)) if any(item.exact is not None for item in scene.items) else scene


def _why_not(item: Item, kinds: Set[LineKind], hatch: Hatching | Stippling | None) -> str:
    """Why an item stays triangles; nothing where it does not."""
    own = kinds if item.lines is None else frozenset(map(LineKind.from_word, item.lines))
    curves, triangles_only = item.curves, {LineKind.OUTLINE, LineKind.EDGES}
    if curves.isophotes:
        triangles_only.add(LineKind.ISOPHOTE)
    if curves.sections or curves.contours:
        triangles_only.add(LineKind.SECTION)
    if curves.integral:
        triangles_only.add(LineKind.INTEGRAL)
    if item.exact is None or item.exact.mesh is not item.shape:
        return "it is cut"
    hatching = hatch if item.hatch is None else item.hatch
    if hatching is not None and hatching.by != "none":
        return "it is hatched"
    if item.material.is_mirror or item.material.refraction != 1.0:
        return "its material"
    if item.patterns or item.added_edges is not None:
        return "what lies on its faces"
    if triangles_only & own:
        return "lines of kind " + ", ".join(kind.word for kind in sorted(triangles_only & own))
    return ""


def _exact(item: Item) -> Item:
    """The item with its surfaces for a shape."""
    assert item.exact is not None
    return replace(
        item,
        shape=item.exact,
        normals=None,
        drawn_edges=None,
        tangent_edges=None,
        face_looks=None,
        fields=None,
        curves=SurfaceLines(),
        exact=None,
    )

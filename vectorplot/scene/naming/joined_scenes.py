"""Several scenes as one, whose items have names of their own."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from itertools import chain

import numpy as np

from vectorplot.scene.cuts.cut import Cut
from vectorplot.scene.item import Item
from vectorplot.scene.naming.labels import Label, renamed
from vectorplot.scene.pages.inks import Inks
from vectorplot.scene.scene import Scene


def renamed_labels(scene: Scene, items: Sequence[Item]) -> tuple[Label, ...]:
    """The labels of a scene whose items have other names now."""
    names = {old.name: new.name for old, new in zip(reversed(scene.items), reversed(items), strict=True)}
    return tuple(renamed(label, names) for label in scene.labels)


def renamed_cuts(scene: Scene, items: Sequence[Item]) -> tuple[Cut, ...]:
    """The cuts of a scene whose items have other names now: each goes through these items alone."""
    named = [[new.name for old, new in zip(scene.items, items, strict=True) if c.is_for(old.name)] for c in scene.cuts]
    return tuple(replace(cut, items=tuple(names)) for cut, names in zip(scene.cuts, named, strict=True))


def together(scenes: Sequence[Scene]) -> Scene:
    """All items and lights; cuts go through the items of their own scenes; what there can be only one of is that of the
    first scene that has it."""
    if len(scenes) == 1:
        return scenes[0]
    items = _told_apart([item for scene in scenes for item in scene.items])
    ends = np.cumsum([len(scene) for scene in scenes]).tolist()
    parts = list(zip(scenes, ends, strict=True))
    return Scene(
        items,
        tuple(light for scene in scenes for light in scene.lights),
        next((scene.camera for scene in scenes if scene.camera), None),
        next((scene.page for scene in scenes if scene.page), None),
        next((scene.background for scene in scenes if scene.background), None),
        next((scene.title for scene in scenes if scene.title), ""),
        tuple(chain(*(renamed_labels(scene, items[end - len(scene) : end]) for scene, end in parts))),
        next((scene.colouring for scene in scenes if scene.colouring), None),
        next((scene.box for scene in scenes if scene.box), None),
        cuts=tuple(chain(*(renamed_cuts(scene, items[end - len(scene) : end]) for scene, end in parts))),
        exposure=next((scene.exposure for scene in scenes if scene.exposure != 1.0), 1.0),
        depth_cue=next((scene.depth_cue for scene in scenes if scene.depth_cue), None),
        inks=next((_inks(scene, items[end - len(scene) : end]) for scene, end in parts if scene.inks), None),
        explosion=next((scene.explosion for scene in scenes if scene.explosion), None),
        exaggeration=next((scene.exaggeration for scene in scenes if scene.exaggeration != 1.0), 1.0),
    )


def _inks(scene: Scene, items: Sequence[Item]) -> Inks | None:
    """The pens of a scene whose items have other names now."""
    names = {old.name: new.name for old, new in zip(reversed(scene.items), reversed(items), strict=True)}
    return None if scene.inks is None else scene.inks.renamed(names)


def _told_apart(items: Sequence[Item]) -> tuple[Item, ...]:
    """The items, those whose names came before with numbers behind them."""
    count: Counter[str] = Counter()
    taken = {item.name for item in items}
    result = []
    for item in items:
        count[item.name] += 1
        name = item.name
        if count[item.name] > 1:
            number = count[item.name]
            while f"{item.name} {number}" in taken:
                number += 1
            count[item.name], name = number, f"{item.name} {number}"
            taken.add(name)
        result.append(item if name == item.name else replace(item, name=name))
    return tuple(result)

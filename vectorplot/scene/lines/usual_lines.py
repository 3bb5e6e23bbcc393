"""What is drawn of things where nobody asks for kinds of lines."""

from __future__ import annotations

from dataclasses import replace

from vectorplot.scene.item import Item
from vectorplot.scene.scene import Scene


def with_usual_lines(scene: Scene) -> Scene:
    """The scene with the lines that are usual for its items as their own, where they have none of their own."""
    if all(item.usual_lines is None for item in scene.items):
        return scene
    return replace(scene, items=tuple(map(_usual, scene.items)))


def _usual(item: Item) -> Item:
    return replace(item, lines=item.usual_lines) if item.lines is None else item

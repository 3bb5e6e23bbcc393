"""From strokes to a drawing: their pens and layers, the paper, and what stands around the picture."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

from vectorplot.drawing.drawing import Drawing, Layer, Paths, Pen
from vectorplot.drawing.hatching.hatch_layers import hatch_layers
from vectorplot.drawing.layers import FRAME_PEN, letter_pen
from vectorplot.drawing.pens.pen_rules import PenRule, frame_pen, pen_of, rules_by_target, scaled_pen
from vectorplot.drawing.pens.sheet_layer import pen_scale, sheet_layer
from vectorplot.drawing.pens.sorted_layers import layer_words, not_plotted, sorted_layers
from vectorplot.drawing.strokes.finishing import inked
from vectorplot.scene.hatching import Hatching, Stippling
from vectorplot.scene.pages.page import Page
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.stages.around_picture import room_for_labels, titled
from vectorplot.stages.walk import Walk
from vectorplot.words import LineKind, check_colour

if TYPE_CHECKING:
    from vectorplot.drawing.lettering.scene_labels import SceneLabels
    from vectorplot.scene.depth_cue import DepthCue


PAPER = "white"
"""What strokes fade to where nobody names the colour of the paper."""


@dataclass(frozen=True)
class Finish:
    """What draw is told of pens and paper, by its keywords; look: plain, or that of a wireframe; rules: of pens, the
    last one that fits counts; curved_mm: how far fitted curves may be off strokes, None for polylines.

    Errors: InputError for a colour of the paper that is none.
    """

    look: Literal["plain", "wireframe", "depth-cue"]
    hidden: str
    layers: str
    rules: tuple[PenRule, ...]
    background: str | None
    curved_mm: float | None
    longest_mm: float | None
    title: str
    frame: bool
    unplotted: tuple[str, ...]
    text: str = "strokes"
    thin_ends: bool = False
    scale_pens: bool = False

    def __post_init__(self) -> None:
        if self.background is not None:
            check_colour(self.background, "background: ")

    @property
    def plain(self) -> bool:
        """Whether hidden lines are hidden, and pens have the colours that rules give them."""
        return self.look == "plain"

    def layered(
        self,
        walk: Walk,
        scene: Scene,
        view: View,
        strokes: Paths,
        hatches: Paths,
        hatch: Hatching | Stippling | None,
        page: Page,
    ) -> tuple[Layer, ...]:
        """Strokes of a scene, and those that hatch its faces, in layers with their pens; hatch: as of draw."""
        if self.look == "plain":
            found = walk.run("layers", _line_layers, scene, strokes, hatches, hatch, self.layers, self.rules)
        else:
            from vectorplot.effects.wireframe import wire_layers

            scene = scene if self.background is None else replace(scene, background=self.background)
            found = walk.run("layers", wire_layers, scene, view, strokes, page, self.look)
        if not self.scale_pens:
            return found
        return tuple(replace(layer, pen=scaled_pen(layer.pen, pen_scale(page))) for layer in found)

    def cued(
        self, walk: Walk, layers: tuple[Layer, ...], view: View, cue: DepthCue, placement: Placement
    ) -> tuple[Layer, ...]:
        """The layers with their strokes by depth."""
        from vectorplot.effects.depth_cues import depth_cued
        from vectorplot.shading.light.palettes import palette

        paper = palette(self.background or PAPER)[-1].tolist()
        return walk.run("depth cue", depth_cued, layers, view, cue, paper, placement.page_from_world)

    def inked(self, walk: Walk, layers: tuple[Layer, ...], placement: Placement) -> tuple[Layer, ...]:
        """The layers with strokes that are joined, fitted with curves, and in the order of a pen."""
        world = placement.page_from_world
        return walk.run("pen", inked, layers, self.hidden, world, self.curved_mm, self.longest_mm, self.thin_ends)

    def letters(self, layers: Sequence[Layer]) -> Pen:
        """The pen of letters on a drawing with such layers."""
        return pen_of(rules_by_target(self._pen_rules), letter_pen(layers), int(LineKind.LABEL), False, "")

    def labelled(
        self, layers: tuple[Layer, ...], placement: Placement, labels: SceneLabels, letters: Pen, sheet: Page
    ) -> tuple[tuple[Layer, ...], Placement]:
        """The layers with labels on top, and their place; a sheet that is cut to size has room for them."""
        by_kind = self.layers == "kind" and self.plain
        layers = labels.on_top(layers, by_kind, self.longest_mm, placement.page_from_world, letters)
        return room_for_labels(layers, placement, labels, sheet)

    def drawing(self, layers: tuple[Layer, ...], placement: Placement, scene: Scene, letters: Pen) -> Drawing:
        """The drawing: layers with a title and a frame, on their paper. letters: the pen of labels."""
        page = placement.page
        names = tuple(item.name for item in scene.items)
        border = frame_pen(self._pen_rules, replace(FRAME_PEN, colour=letters.colour))
        layers = titled(layers, placement, self.title, self.frame, border, self.longest_mm, self.text)
        if self.background is not None and self.plain:
            layers = (sheet_layer(self.background, page), *layers)
        layers = not_plotted(layers, self.unplotted, (*names, *(item.colour for item in scene.items)))
        return Drawing(page.width_mm, page.height_mm, layers, names, scene.title, placement.page_from_world)

    @property
    def _pen_rules(self) -> tuple[PenRule, ...]:
        return self.rules if self.plain else ()


def _line_layers(
    scene: Scene,
    strokes: Paths,
    hatches: Paths,
    hatch: Hatching | Stippling | None,
    layers: str,
    rules: Sequence[PenRule],
) -> tuple[Layer, ...]:
    """The layers of lines, and those of strokes that hatch faces."""
    how = [hatch if item.hatch is None else item.hatch for item in scene.items]
    names, colours = [item.name for item in scene.items], [item.colour for item in scene.items]
    behind = hatch_layers(hatches, how, colours if "colour" in layer_words(layers) else None)
    return sorted_layers(strokes, names, colours, layers, rules, behind)

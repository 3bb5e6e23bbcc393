"""The exact visible lines of a scene, and its labels, in their places on a picture of its faces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from vectorplot.drawing.drawing import Layer, Paths, Pen
from vectorplot.drawing.strokes.finishing import inked
from vectorplot.linework.labels_in_place import labels_in_place
from vectorplot.linework.lines_in_place import lines_in_place, with_smooth_surfaces
from vectorplot.scene.depth_cue import DepthCue
from vectorplot.scene.naming.annotations import only_annotations
from vectorplot.scene.naming.label_anchors import LabelAnchors
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.stages.walk import Walk
from vectorplot.visibility.projected_faces import ProjectedFaces
from vectorplot.words import LineKind

if TYPE_CHECKING:
    from vectorplot.drawing.lettering.scene_labels import SceneLabels

PEN = Pen()
"""What draws lines among fills."""

OUTLINES = frozenset({LineKind.CONTOUR, LineKind.BOUNDARY})
"""What labels keep off where no lines are drawn."""


@dataclass(frozen=True, eq=False)
class Ruler:
    """How the lines of a scene come to be on a picture of its faces. view: of the latter, surfaces as triangles; faces:
    its faces in the image, where they are known; all else as of draw, in the units of the placement's page."""

    scene: Scene
    view: View
    faces: ProjectedFaces | None
    placement: Placement
    crease_angle_deg: float
    tolerance_mm: float
    budget: float

    def found(self, kinds: frozenset[LineKind], progress: Callable[[float], None]) -> Paths:
        """The visible lines, as they come; of no kinds those of annotations."""
        return self._found(self.scene if kinds else only_annotations(self.scene), kinds, progress)

    def labels(
        self, anchors: LabelAnchors, strokes: Paths | None, text: str = "strokes", mm: float = 1.0
    ) -> SceneLabels:
        """The labels of the scene, apart from strokes, or where there are none from its contours; text: a word of
        LETTERS; mm: how long a millimetre is in units of the page."""
        strokes = self._found(self.scene, OUTLINES, None) if strokes is None else strokes
        return labels_in_place(self.scene, *self._view, self.placement, anchors, strokes, text=text, mm=mm)

    def layers(
        self, layers: Sequence[Layer], walk: Walk, cue: DepthCue | None, paper: Sequence[int]
    ) -> tuple[Layer, ...]:
        """Layers of visible lines as a pen draws them, by depth too where there is a cue; paper: its colour."""
        world = self.placement.page_from_world
        return inked(self.cued(layers, walk, cue, paper), "none", world, self.tolerance_mm)

    def cued(
        self, layers: Sequence[Layer], walk: Walk, cue: DepthCue | None, paper: Sequence[int]
    ) -> tuple[Layer, ...]:
        """Layers of lines, their strokes by depth where there is a cue."""
        if cue is None or not walk.calls_for("depth cue"):
            return tuple(layers)
        from vectorplot.effects.depth_cues import depth_cued

        return walk.run("depth cue", depth_cued, tuple(layers), self.view, cue, paper, self.placement.page_from_world)

    def strokes(self, scene: Scene, kinds: frozenset[LineKind]) -> Paths:
        """The visible lines as polylines. scene: this one, whatever patterns it has."""
        found = self._found(scene, kinds, None)
        (layer,) = inked((Layer("", PEN, (found,)),), "none", self.placement.page_from_world)
        return layer.strokes[0]

    def _found(self, scene: Scene, kinds: frozenset[LineKind], progress: Callable[[float], None] | None) -> Paths:
        return lines_in_place(
            scene,
            *self._view,
            self.placement,
            kinds,
            crease_angle_deg=self.crease_angle_deg,
            tolerance_mm=self.tolerance_mm,
            budget=self.budget,
            progress=progress,
        )

    @cached_property
    def _view(self) -> tuple[View, ProjectedFaces]:
        return with_smooth_surfaces(self.scene, self.view, self.faces)

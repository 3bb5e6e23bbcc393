"""The labels of a scene on a picture of it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vectorplot.drawing.drawing import Paths
from vectorplot.scene.naming.label_anchors import LabelAnchors
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.visibility.projected_faces import ProjectedFaces

if TYPE_CHECKING:
    from vectorplot.drawing.lettering.scene_labels import SceneLabels


def labels_in_place(
    scene: Scene,
    view: View,
    faces: ProjectedFaces,
    placement: Placement,
    anchors: LabelAnchors,
    strokes: Paths,
    hidden: str = "none",
    style: str = "plain",
    text: str = "strokes",
    *,
    mm: float = 1.0,
) -> SceneLabels:
    """The labels of a scene where a picture of it has its place on the page, and the numbers of its level lines.

    anchors: what they name in the scene as it was given; strokes: of the picture; hidden, style, text: as of draw; mm:
    how long a millimetre is in units of the page.
    """
    from vectorplot.drawing.lettering.labels.seen_labels import seen_labels
    from vectorplot.drawing.lettering.level_numbers import level_numbers
    from vectorplot.drawing.lettering.scene_labels import labels_on_page, with_letters

    seen = seen_labels(scene, view, faces, placement, anchors, style != "plain", mm)
    named = labels_on_page(seen, placement, strokes, hidden, text, mm)
    return with_letters(named, level_numbers(scene, strokes, text, mm), placement, mm)

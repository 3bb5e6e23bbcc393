"""The labels that a picture shows."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.scene.naming.label_anchors import LabelAnchors
from vectorplot.scene.naming.labels import OnPage
from vectorplot.scene.placement import Placement
from vectorplot.scene.scene import Scene
from vectorplot.scene.view import View
from vectorplot.visibility.hidden_points import points_hidden_by
from vectorplot.visibility.projected_faces import ProjectedFaces


@dataclass(frozen=True, eq=False)
class SeenLabels:
    """Labels that a picture shows: anchors; points (l,2) on the page, by how many items (l,) each is hidden."""

    anchors: LabelAnchors
    points: Floats
    hidden_by: Ints

    def chosen(self, which: Ints) -> SeenLabels:
        """Some of them, in this order."""
        given = self.anchors
        labels, courses = (tuple(row[k] for k in which.tolist()) for row in (given.labels, given.courses))
        return SeenLabels(LabelAnchors(labels, given.points[which], courses), self.points[which], self.hidden_by[which])


def seen_labels(
    scene: Scene, view: View, faces: ProjectedFaces, placement: Placement, anchors: LabelAnchors, wires: bool, mm: float
) -> SeenLabels:
    """The labels on the page of which what they name is before the eye and on the page.

    anchors: of the scene as it was read; wires: nothing hides anything; mm: how long a millimetre is in
    units of the page.
    """
    on_page = np.array([isinstance(label.at, OnPage) for label in anchors.labels], dtype=np.bool_)
    inside = np.flatnonzero(~on_page)
    points = view.points_of(anchors.points[inside])
    ahead = view.depth_of(points) > view.near
    inside, points = inside[ahead], points.compress(ahead, axis=1)
    found = np.full((len(anchors), 2), np.nan)
    found[inside] = placement.on_page(view.image_of(points))
    for number in np.flatnonzero(on_page).tolist():
        at = anchors.labels[number].at
        assert isinstance(at, OnPage)
        found[number] = at.x_mm * mm, at.y_mm * mm
    hidden = np.zeros(len(anchors), dtype=np.intp)
    if not wires and len(inside):
        hidden[inside] = points_hidden_by(scene, view, faces, points)
    page = placement.page
    with np.errstate(invalid="ignore"):
        shown = ((found >= 0.0) & (found <= (page.width_mm, page.height_mm))).all(axis=1)
    return SeenLabels(anchors, found, hidden).chosen(np.flatnonzero(shown | on_page))

"""The edges of meshes that are taken for smooth shapes."""

from __future__ import annotations

from collections.abc import Collection

import numpy as np

from vectorplot.features.meshes.edges import Edges, Faces, mesh_edges
from vectorplot.geometry import records
from vectorplot.words import LineKind


def smooth_mesh_edges(faces: Faces, kinds: Collection[LineKind], crease_angle_deg: float) -> Edges:
    """What mesh_edges gives, but contours are only those of them that are creases: all others run across faces."""
    contours = mesh_edges(faces, set(kinds) & {LineKind.CONTOUR}, crease_angle_deg)
    others = mesh_edges(faces, set(kinds) - {LineKind.CONTOUR}, crease_angle_deg)
    creases = mesh_edges(faces, {LineKind.CREASE}, crease_angle_deg)
    keys = [edges.start * faces.points.shape[1] + edges.end for edges in (contours, others, creases)]
    sharp = np.isin(keys[0], keys[2])
    rest = ~np.isin(keys[1], keys[0][sharp])
    return records.joined([records.some(contours, sharp), records.some(others, rest)])

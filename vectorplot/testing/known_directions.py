"""Curves that say themselves in which directions they run, as the assertions take them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.drawing.drawing import Drawing
from vectorplot.features.integral.sites import unit
from vectorplot.features.parametric.surface_curves import SurfaceCurves
from vectorplot.geometry.vectors import cross, dot, norm
from vectorplot.painting.flowing_lines import on_page
from vectorplot.surfaces.surface import Surface
from vectorplot.testing.curve_points import Curves


@dataclass(frozen=True, eq=False)
class KnownDirections:
    """Points (k,3) of curves, and unit vectors (k,3) in which they run; or, where these are known from a picture only,
    to which they are at right angles: normals of the planes through the eye in which they run."""

    points: Floats
    directions: Floats
    normal: bool

    def sines(self, tangents: Floats) -> Floats:
        """(...,k) of the angles by which unit tangents (...,k,3) are off, in space."""
        if self.normal:
            return np.abs(dot(tangents, self.directions))
        return norm(cross(tangents, np.broadcast_to(self.directions, tangents.shape)))


def known_directions(points: Curves | SurfaceCurves, surface: Surface) -> KnownDirections | None:
    """What curves on a surface, or the smooth strokes of a drawing, say of their directions; None where they say
    nothing."""
    if isinstance(points, SurfaceCurves):
        along_u, along_v = surface.partials(points.u, points.v)
        found = points.directions[:, :1] * along_u + points.directions[:, 1:] * along_v
        return _known(points.points, found, normal=False)
    if not isinstance(points, Drawing):
        return None
    every = [paths for layer in points.layers for paths in layer.strokes if len(paths)]
    if not every:
        return None
    at = np.concatenate([np.repeat(paths.points3d, 2, axis=0) for paths in every])
    angle = np.concatenate([paths.directions.ravel() for paths in every])
    # How the page sees the axes of space: what it sees of a tangent is this times the tangent.
    ways = np.stack([on_page(at, axis, points.page_from_world) for axis in np.eye(3)], axis=-1)
    cosine, sine = np.cos(angle)[:, None], np.sin(angle)[:, None]
    return _known(at, cosine * ways[:, 1] - sine * ways[:, 0], normal=True)


def _known(points: Floats, vectors: Floats, *, normal: bool) -> KnownDirections | None:
    directions = unit(vectors)
    known = np.isfinite(directions).all(axis=1)
    return KnownDirections(points[known], directions[known], normal) if known.any() else None

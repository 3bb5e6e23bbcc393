"""Faces as planes of their own, in which regions on them can be united and cut."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.scene.view import View
from vectorplot.visibility.projected_faces import newell


@dataclass(frozen=True, eq=False)
class FaceFrames:
    """Frames of faces (n,), in any order: origin (3,n) a corner of each; along, left (3,n) unit vectors across its
    normal, so that what turns left in its plane is wound as the face."""

    origin: Floats
    along: Floats
    left: Floats

    @classmethod
    def of(cls, view: View, face: Ints) -> FaceFrames:
        """The frames of faces of a view, which have an area."""
        normal, _, first = newell(view, face)
        normal /= np.sqrt((normal * normal).sum(axis=0))
        axis = np.eye(3)[:, np.argmin(np.abs(normal), axis=0)]
        along = np.cross(axis, normal, axis=0)
        along /= np.sqrt((along * along).sum(axis=0))
        return cls(view.points[:, first], along, np.cross(normal, along, axis=0))

    def flat(self, points: Floats, owner: Ints) -> Floats:
        """(2,c) points (3,c) of the view in the frames owner (c,)."""
        arm = points - self.origin[:, owner]
        return np.stack([(arm * self.along[:, owner]).sum(axis=0), (arm * self.left[:, owner]).sum(axis=0)])

    def lifted(self, flat: Floats, owner: Ints) -> Floats:
        """(3,c) points of the view, of points (2,c) of the frames owner (c,)."""
        x, y = flat
        return np.asarray(self.origin[:, owner] + x * self.along[:, owner] + y * self.left[:, owner])

"""Places on surfaces and in faces of meshes, and what is known there of tangent planes and how the surface bends."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Floats
from vectorplot.errors import InputError
from vectorplot.geometry.components import all_finite
from vectorplot.geometry.vectors import cross, dot
from vectorplot.surfaces.jets import FirstJets, SecondJets, first_jets, second_jets
from vectorplot.surfaces.surface import Surface


class TangentPlanes(ABC):
    """Places in space with a tangent plane at each: of a surface (`Sites`), or of the faces of a mesh (`FaceSites`).

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> issubclass(features.Sites, features.TangentPlanes), issubclass(features.FaceSites, features.TangentPlanes)
    (True, True)
    """

    @property
    @abstractmethod
    def points(self) -> Floats:
        """(k,3) in world coordinates."""

    @property
    @abstractmethod
    def normals(self) -> Floats:
        """(k,3) unit normals; NaN where there is no tangent plane."""

    def tangential(self, vectors: Floats) -> Floats:
        """(k,3) the parts of vectors (k,3) in the tangent planes."""
        return np.asarray(vectors - dot(vectors, self.normals)[:, None] * self.normals)

    def turned(self, tangents: Floats, angle: float) -> Floats:
        """(k,3) tangent vectors turned about the normals, counter-clockwise seen from their tips."""
        return np.asarray(np.cos(angle) * tangents + np.sin(angle) * cross(self.normals, tangents))


@dataclass(frozen=True, eq=False)
class Sites(TangentPlanes):
    """Places on a surface, with its tangent planes there.

    Parameters
    ----------
    surface : Surface
        With its partials and second partials.
    u, v : (k,) array of float
        Parameters, within the domain.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> sites = features.Sites(surfaces.Cylinder(), np.array([0.0]), np.array([0.5]))
    >>> (sites.normals + 0.0).tolist()
    [[1.0, 0.0, 0.0]]
    """

    surface: Surface
    u: Floats
    v: Floats

    @cached_property
    def _second_jets(self) -> SecondJets:
        return second_jets(self.surface, self.u, self.v)

    @cached_property
    def _jets(self) -> FirstJets:
        # With second derivatives these have come as well.
        known = self.__dict__.get("_second_jets")
        return first_jets(self.surface, self.u, self.v) if known is None else known[:3]

    @property
    def points(self) -> Floats:
        """(k,3) in world coordinates."""
        return self._jets[0]

    @cached_property
    def planes(self) -> tuple[Floats, Floats, Floats]:
        """Derivatives by u and by v, and unit normals, (k,3) each; no normals at poles and singular points, and none in
        holes, where formulas of derivatives may go on."""
        points, along_u, along_v = self._jets
        across = cross(along_u, along_v)
        if not np.isfinite(points).all():
            across[~all_finite(points)] = np.nan
        return along_u, along_v, unit(across)

    @property
    def normals(self) -> Floats:
        """(k,3) unit normals."""
        return self.planes[2]

    @cached_property
    def first_form(self) -> tuple[Floats, Floats, Floats]:
        """E, F, G (k,)."""
        along_u, along_v, _ = self.planes
        return dot(along_u, along_u), dot(along_u, along_v), dot(along_v, along_v)

    @cached_property
    def second_form(self) -> tuple[Floats, Floats, Floats]:
        """L, M, N (k,); with derivatives that are found at once where this is asked for first."""
        if "_jets" in self.__dict__:
            uu, uv, vv = self.surface.second_partials(self.u, self.v)
        else:
            uu, uv, vv = self._second_jets[3:]
        normals = self.normals
        return dot(normals, uu), dot(normals, uv), dot(normals, vv)

    def steps(self, tangents: Floats) -> tuple[Floats, Floats]:
        """du and dv (k,) that move along tangent vectors (k,3); not finite at poles and singular points."""
        e, f, g = self.first_form
        along_u, along_v, _ = self.planes
        a, b = dot(tangents, along_u), dot(tangents, along_v)
        area = e * g - f * f
        with np.errstate(all="ignore"):
            return (g * a - f * b) / area, (e * b - f * a) / area

    def bends(self, tangents: Floats) -> Floats:
        """(k,) normal curvatures in the directions of unit tangent vectors (k,3)."""
        return self.bends_along(*self.steps(tangents))

    def bends_along(self, du: Floats, dv: Floats) -> Floats:
        """(k,) normal curvatures where du and dv (k,) move by unit tangent vectors."""
        p, m, q = self.second_form
        with np.errstate(all="ignore"):
            return np.asarray((p * du + 2.0 * m * dv) * du + q * dv * dv)


def on_surface(planes: TangentPlanes, what: str) -> Sites:
    """The places, which must be those of a surface with parameters.

    Errors: InputError for those of a mesh.
    """
    if not isinstance(planes, Sites):
        raise InputError(f"{what}: only surfaces with parameters u and v have them, no meshes")
    return planes


def unit(vectors: Floats) -> Floats:
    """(...,3) vectors divided by their lengths; NaN where they have none."""
    with np.errstate(all="ignore"):
        return np.asarray(vectors / np.sqrt(dot(vectors, vectors))[..., None])

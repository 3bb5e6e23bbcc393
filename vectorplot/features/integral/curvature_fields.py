"""The directions in which a surface bends most, least, and not at all."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.feature_lines.bending import principal_axes
from vectorplot.features.integral.bent_faces import BentFaces
from vectorplot.features.integral.face_sites import FaceSites
from vectorplot.features.integral.sites import Sites, TangentPlanes, on_surface, unit
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.vectors import cross
from vectorplot.tolerances.of_values import BEYOND_NOISE, UMBILIC


@dataclass(frozen=True)
class PrincipalDirections:
    """The directions of the principal curvatures: those of lines of curvature.

    Parameters
    ----------
    family : 1 or 2
        The lines along which the normal curvature is larger (1), or smaller (2); it is positive where the surface
        bends towards its normal.

    Raises
    ------
    InputError
        For another number.

    Notes
    -----
    Not directed. A curve through an umbilic, where all directions are principal ones, goes straight on; beyond it, it
    may be of the other family. Degenerate: no curve begins at an umbilic, and none on a sphere or in a plane.

    In a face of a mesh they are those of the mean of the curvature tensors at its corners, which are fitted to the
    normals around them, on one side of creases. On finer and finer meshes of a smooth surface they come near its own by
    the square of the edges. There is none where the curvatures differ by less than four times what the fit may be wrong
    by: curves on meshes end at umbilics and where it is flat.

    Source: for meshes, Rusinkiewicz, Estimating curvatures and their derivatives on triangle meshes, 2004; Goldfeather
    and Interrante, 2004.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> sites = features.Sites(surfaces.Cylinder(), np.array([0.0]), np.array([0.5]))
    >>> np.abs(features.PrincipalDirections(1).tangents(sites)[0]).round(9).tolist()  # straight: 0 is more than -1
    [[0.0, 0.0, 1.0]]
    """

    family: int = 1
    directed: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if self.family not in (1, 2):
            raise InputError(f"lines of curvature: family {self.family!r}, expected 1 or 2")

    def tangents(self, sites: TangentPlanes) -> Floats:
        """(2,k,3) unit tangent vectors, those of the family first."""
        (most, least), _ = principal(sites, "lines of curvature")
        return np.stack([most, least] if self.family == 1 else [least, most])


@dataclass(frozen=True)
class AsymptoticDirections:
    """The directions in which the normal curvature is zero: those of asymptotic lines.

    Parameters
    ----------
    family : 1 or 2
        The lines to the left (1), or right (2), of those along which the normal curvature is largest, by less than a
        right angle.

    Raises
    ------
    InputError
        For another number.

    Notes
    -----
    Not directed. Degenerate: no direction where the Gaussian curvature is positive: the solution is not real there; and
    where the surface is flat. In faces of meshes as `PrincipalDirections`; a curvature that is less than it may be
    wrong by is zero there: asymptotic lines of a cylinder are the straight lines on it.

    Examples
    --------
    >>> import numpy as np
    >>> from vectorplot import features, surfaces
    >>> saddle = surfaces.graph(lambda x, y: x * y, surfaces.Domain(-1, 1, -1, 1))
    >>> sites = features.Sites(saddle, np.array([0.0]), np.array([0.0]))
    >>> np.abs(features.AsymptoticDirections(1).tangents(sites)).round(6).tolist()
    [[[0.0, 1.0, 0.0]]]
    """

    family: int = 1
    directed: ClassVar[bool] = False

    def __post_init__(self) -> None:
        if self.family not in (1, 2):
            raise InputError(f"asymptotic lines: family {self.family!r}, expected 1 or 2")

    def tangents(self, sites: TangentPlanes) -> Floats:
        """(1,k,3) unit tangent vectors."""
        (most, least), (largest, smallest) = principal(sites, "asymptotic lines")
        with np.errstate(all="ignore"):
            ahead, aside = np.sqrt(-smallest), np.sqrt(largest)
        side = 1.0 if self.family == 1 else -1.0
        return unit(ahead[:, None] * most + side * aside[:, None] * least)[None]


Principal = tuple[tuple[Floats, Floats], tuple[Floats, Floats]]
"""The unit vectors (k,3) along which the normal curvature is largest, and those a quarter turn to the left of them,
along which it is smallest; and both curvatures (k,). No directions at umbilics."""


def principal(sites: TangentPlanes, what: str) -> Principal:
    """Principal directions and curvatures at places on a surface or in faces.

    Errors: InputError for places in faces of which nothing is known but their planes.
    """
    if not isinstance(sites, FaceSites):
        return _principal_on_surface(on_surface(sites, what))
    if sites.bent is None or sites.faces is None:
        raise InputError(f"{what}: planes of faces do not say how a mesh bends: expected face_sites(mesh)")
    return _principal_in_faces(sites, sites.bent, sites.faces)


def _principal_in_faces(sites: FaceSites, bent: BentFaces, faces: Ints) -> Principal:
    """As the mesh bends, where that is more than it may be wrong by; curvatures that are less are zero."""
    least = np.eye(3)[np.abs(np.nan_to_num(sites.normals)).argmin(axis=1)]
    along = unit(cross(sites.normals, least))
    aside = cross(sites.normals, along)
    form, wrong = bent.forms(faces, along, aside)
    with np.errstate(all="ignore"):
        largest, smallest, axis, _ = principal_axes(form)
        most = axis[:, :1] * along + axis[:, 1:] * aside
        noise = BEYOND_NOISE * wrong
        most = np.where((largest - smallest > noise)[:, None], most, np.nan)
        largest, smallest = (np.where(np.abs(each) > noise, each, 0.0) for each in (largest, smallest))
    return (most, cross(sites.normals, most)), (largest, smallest)


def _principal_on_surface(sites: Sites) -> Principal:
    """By the fundamental forms."""
    (p, m, q), (e, f, g) = sites.second_form, sites.first_form
    along_u, _, normals = sites.planes
    with np.errstate(all="ignore"):
        # Of the frame of x_u and what is at right angles to it.
        area = e * g - f * f
        straight = p / e
        mixed = (m - f * straight) / np.sqrt(area)
        across = (e * q - 2.0 * f * m + f * f * straight) / area
        half, mean = 0.5 * (straight - across), 0.5 * (straight + across)
        apart = np.hypot(half, mixed)
        angle = 0.5 * arctan2(mixed, half)
        known = apart > UMBILIC * np.maximum(np.abs(straight), np.abs(across))
        first = unit(along_u)
        most = np.cos(angle)[:, None] * first + np.sin(angle)[:, None] * cross(normals, first)
    most = np.where(known[:, None], most, np.nan)
    return (most, cross(normals, most)), (mean + apart, mean - apart)

"""Coordinates in which curves run over a surface, and places on surfaces and meshes with their tangent planes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from vectorplot.arrays import Floats, Ints
from vectorplot.errors import InputError
from vectorplot.features.curve_tracing import poles
from vectorplot.features.holes import near_to, wrapped
from vectorplot.features.mesh_edge_lines import apart_at_creases
from vectorplot.features.mesh_feature_lines import noisy_bending
from vectorplot.features.mesh_lines import face_triangles
from vectorplot.geometry import ragged
from vectorplot.geometry.algebra import matmul
from vectorplot.geometry.elementary import arctan2
from vectorplot.geometry.mesh import Mesh
from vectorplot.geometry.vectors import all_finite, cross, dot, from_components
from vectorplot.geometry.winding import face_barycentres
from vectorplot.surfaces.function_surface import with_derivatives
from vectorplot.surfaces.surface import Domain, FirstJets, SecondJets, Surface, first_jets, is_parametrised, second_jets
from vectorplot.tolerances import AT_POLE, LEAST_DIVISOR

# Coordinates in which curves run over a surface: its parameters, and round its poles others, in which it is smooth.

NEAR, FAR = 0.08, 0.12
"""Parts of the domain: nearer to a pole a curve changes to the coordinates round it, farther it changes back."""

MAIN = -1
"""The chart of the parameters themselves."""

NO_CHARTS = np.zeros(0, dtype=np.intp)


def check_parametrised(surface: object) -> None:
    """Errors: InputError for what has no parameters u and v; meshes have functions of their own."""
    if not is_parametrised(surface):
        raise InputError(f"integral curves: {type(surface).__name__} is no surface with parameters u and v")


@dataclass(frozen=True, eq=False)
class Charts:
    """The charts of a surface. Round a pole that the other parameter closes, a place is known by rho cos(theta) and rho
    sin(theta): rho is the way of a parameter from the pole, theta the other one as an angle.

    domain: of the surface; axis (p,): the parameter that is constant at each pole, 0 or 1; place (p,): its value there;
    inwards (p,): 1 or -1; size (p,): the range of that parameter; start, period (p,): of the other one.
    """

    domain: Domain
    axis: Ints
    place: Floats
    inwards: Floats
    size: Floats
    start: Floats
    period: Floats

    def round_poles(self, chart: Ints) -> Ints:
        """Which of charts (k,) are not the parameters themselves."""
        return (chart != MAIN).nonzero()[0] if len(self.axis) else NO_CHARTS

    def parameters(self, chart: Ints, at: Floats) -> Floats:
        """(k,2) u and v, those round poles of one period only; chart (k,), at (k,2)."""
        near = self.round_poles(chart)
        if not len(near):
            return at
        result, c, p = at.copy(), chart[near], at[near]
        axis = self.axis[c]
        rho = np.hypot(p[:, 0], p[:, 1])
        turn = arctan2(p[:, 1], p[:, 0]) / (2.0 * np.pi)
        result[near, axis] = self.place[c] + self.inwards[c] * rho
        result[near, 1 - axis] = self.start[c] + self.period[c] * turn
        return result

    def coordinates(self, chart: Ints, places: Floats) -> Floats:
        """(k,2) the coordinates in charts (k,) of u and v (k,2)."""
        near = self.round_poles(chart)
        if not len(near):
            return places
        result = places.copy()
        rho, theta = self._polar(chart[near], *places[near].T)
        result[near] = from_components(rho * np.cos(theta), rho * np.sin(theta))
        return result

    def rates(self, chart: Ints, u: Floats, v: Floats, du: Floats, dv: Floats) -> Floats:
        """(k,2) how coordinates change where u and v (k,) change by du and dv (k,)."""
        result = from_components(du, dv)
        near = self.round_poles(chart)
        if len(near):
            c = chart[near]
            rho, theta = self._polar(c, u[near], v[near])
            along, turn = self._polar_steps(c, result[near])
            cosine, sine = np.cos(theta), np.sin(theta)
            result[near] = from_components(along * cosine - rho * turn * sine, along * sine + rho * turn * cosine)
        return result

    def steps(self, chart: Ints, u: Floats, v: Floats, rates: Floats) -> Floats:
        """(k,2) how u and v (k,) change where coordinates change by rates (k,2)."""
        near = self.round_poles(chart)
        if not len(near):
            return rates
        result, c, d = rates.copy(), chart[near], rates[near]
        rho, theta = self._polar(c, u[near], v[near])
        axis, cosine, sine = self.axis[c], np.cos(theta), np.sin(theta)
        result[near, axis] = self.inwards[c] * (d[:, 0] * cosine + d[:, 1] * sine)
        turn = (d[:, 1] * cosine - d[:, 0] * sine) / np.maximum(rho, LEAST_DIVISOR)
        result[near, 1 - axis] = turn * self.period[c] / (2.0 * np.pi)
        return result

    def better(self, chart: Ints, places: Floats) -> Ints:
        """(k,) the charts to go on in from u and v (k,2)."""
        result = chart
        for pole in range(len(self.axis)):
            part = np.abs(places[:, self.axis[pole]] - self.place[pole]) / self.size[pole]
            result = np.where((result == pole) & (part > FAR), MAIN, result)
            result = np.where((result == MAIN) & (part < NEAR), pole, result)
        return np.asarray(result, dtype=np.intp)

    def within(self, places: Floats) -> tuple[Floats, Floats]:
        """u and v (k,) of places (k,2) within the domain, those beyond a border on it."""
        d = self.domain
        return self._between(places, (d.u_start, d.u_end), (d.v_start, d.v_end))

    def inside(self, places: Floats) -> tuple[Floats, Floats]:
        """u and v (k,) within the domain, and beside poles, where the surface has no tangent plane."""
        return self._between(places, *self._beside_poles)

    def beyond(self, places: Floats) -> Floats:
        """(k,) by what part of the domain places (k,2) are beyond the nearest border that a curve cannot cross;
        negative inside."""
        result = np.full(len(places), -np.inf)
        for axis, border, outwards, size in self._walls:
            result = np.maximum(result, outwards * (places[:, axis] - border) / size)
        return result

    def near_to(self, places: Floats, others: Floats) -> Floats:
        """(k,2) the places, in closed directions whole periods away, that are nearest to others (k,2)."""
        return near_to(self.domain, places, others)

    @cached_property
    def _borders(self) -> tuple[tuple[int, float, float, float], ...]:
        """Where the domain ends that is not closed: the parameter that is constant there, 0 or 1, its value, 1 where it
        grows to the outside or -1, and its range."""
        d = self.domain
        both = ((d.u_start, d.u_end, d.closed_u), (d.v_start, d.v_end, d.closed_v))
        return tuple(
            (axis, border, outwards, high - low)
            for axis, (low, high, closed) in enumerate(both)
            for border, outwards in ((low, -1.0), (high, 1.0))
            if not closed
        )

    @cached_property
    def _walls(self) -> tuple[tuple[int, float, float, float], ...]:
        """Those of the borders that are no poles."""
        own = set(zip(self.axis.tolist(), self.place.tolist(), strict=True))
        return tuple(border for border in self._borders if border[:2] not in own)

    @cached_property
    def _beside_poles(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """The ranges of u and of v without what is at poles."""
        d = self.domain
        ends = [[d.u_start, d.u_end], [d.v_start, d.v_end]]
        for axis, place, inwards, size in zip(self.axis, self.place, self.inwards, self.size, strict=True):
            ends[axis][0 if inwards > 0.0 else 1] = float(place + inwards * AT_POLE * size)
        return (ends[0][0], ends[0][1]), (ends[1][0], ends[1][1])

    def _between(self, places: Floats, us: tuple[float, float], vs: tuple[float, float]) -> tuple[Floats, Floats]:
        """u and v (k,) of places (k,2), in closed directions within a period, else between two values."""
        d = self.domain
        u, v = wrapped(d, places[:, 0], places[:, 1])
        u = u if d.closed_u else np.minimum(np.maximum(u, us[0]), us[1])
        v = v if d.closed_v else np.minimum(np.maximum(v, vs[0]), vs[1])
        return u, v

    def _polar(self, chart: Ints, u: Floats, v: Floats) -> tuple[Floats, Floats]:
        across, along = np.where(self.axis[chart] == 0, (u, v), (v, u))
        rho = (across - self.place[chart]) * self.inwards[chart]
        return rho, (along - self.start[chart]) / self.period[chart] * 2.0 * np.pi

    def _polar_steps(self, chart: Ints, steps: Floats) -> tuple[Floats, Floats]:
        row, axis = np.arange(len(chart)), self.axis[chart]
        return steps[row, axis] * self.inwards[chart], steps[row, 1 - axis] / self.period[chart] * 2.0 * np.pi


def charts(surface: Surface) -> Charts:
    """The charts of a surface; a pole that the other parameter does not close round is a border like others."""
    domain = surface.domain
    closed, starts = (domain.closed_u, domain.closed_v), (domain.u_start, domain.v_start)
    found = [pole for pole in poles(surface) if closed[1 - pole.axis]]
    return Charts(
        domain,
        np.array([pole.axis for pole in found], dtype=np.intp),
        np.array([pole.place for pole in found], dtype=np.float64),
        np.array([pole.inwards for pole in found], dtype=np.float64),
        np.array([pole.size for pole in found], dtype=np.float64),
        np.array([starts[1 - pole.axis] for pole in found], dtype=np.float64),
        np.array([domain.size[1 - pole.axis] for pole in found], dtype=np.float64),
    )


# Places on surfaces and in faces of meshes, and what is known there of tangent planes and how the surface bends.


class TangentPlanes(ABC):
    """Places in space with a tangent plane at each: of a surface (`Sites`), or of the faces of a mesh (`FaceSites`)."""

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

    def __post_init__(self) -> None:
        object.__setattr__(self, "surface", with_derivatives(self.surface))

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


# How the faces of a mesh bend, where it is smooth but for creases.

USUAL_CREASE_DEG = 25.0
"""Edges at which faces turn by more are creases, where nothing is said: as in drawings."""

TRUST_AT_RIMS = 1.0 / 1024.0
"""How much a normal at a border counts beside those of inner vertices: where there are some, nothing that is seen."""


@dataclass(frozen=True, eq=False)
class BentFaces:
    """A mesh, and how it bends beside the edges at which faces turn by more than an angle."""

    mesh: Mesh
    crease_angle_deg: float = USUAL_CREASE_DEG

    def __post_init__(self) -> None:
        if not 0.0 <= self.crease_angle_deg <= 180.0:
            raise InputError(f"a crease angle of {self.crease_angle_deg:g} degrees: expected 0 to 180")

    @cached_property
    def tensors(self) -> tuple[Floats, Floats]:
        """(f,3,3) the curvature tensors of faces, positive where they bend towards their normals, the means of those at
        their corners; and by how much (f,) curvatures may be wrong.

        Source: Rusinkiewicz (2004), section 3, for means of tensors: directions have no sense, and no means.
        """
        mesh = self.mesh
        if not len(mesh.corners):
            return np.zeros((mesh.face_count, 3, 3)), np.full(mesh.face_count, np.inf)
        smooth = apart_at_creases(mesh, self.crease_angle_deg)
        faces = face_triangles(smooth)
        trust = _trust(len(smooth.vertices), faces.triangles)
        bending, noise = noisy_bending(faces, trust)
        axes = np.stack([bending.along, bending.aside], axis=1)
        p, m, q = bending.second.T
        forms = np.stack([np.stack([p, m], axis=1), np.stack([m, q], axis=1)], axis=1)
        own = (matmul(matmul(np.swapaxes(axes, 1, 2), forms), axes)).reshape(-1, 9)
        corner, owner = smooth.corners, ragged.owner(np.diff(mesh.offsets))
        # Where some corners are not at rims, the others do not count.
        best = np.maximum.reduceat(trust[corner], mesh.offsets[:-1])
        used = np.flatnonzero(trust[corner] == best[owner])
        corner, owner = corner[used], owner[used]
        count = np.bincount(owner, minlength=mesh.face_count)
        means = [np.bincount(owner, each[corner], mesh.face_count) / count for each in (*own.T, noise)]
        return np.stack(means[:-1], axis=1).reshape(-1, 3, 3), means[-1]

    def forms(self, faces: Ints, along: Floats, aside: Floats) -> tuple[Floats, Floats]:
        """(k,3) the second fundamental forms p, m, q of faces (k,), by unit vectors (k,3) in their planes; and by how
        much (k,) curvatures may be wrong."""
        tensors, wrong = self.tensors
        turned = np.einsum("kij,kj->ki", tensors[faces], along)
        p, m = dot(turned, along), dot(turned, aside)
        q = dot(np.einsum("kij,kj->ki", tensors[faces], aside), aside)
        return np.stack([p, m, q], axis=1), wrong[faces]


def _trust(count: int, triangles: Ints) -> Floats:
    """(n,) how much the normals at vertices count: those at borders and creases, which have faces on one side only, are
    off by the edges themselves, those of inner vertices by their square."""
    sides = np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    key, uses = np.unique(sides[:, 0] * count + sides[:, 1], return_counts=True)
    rim = np.concatenate(np.divmod(key[uses == 1], count))
    trust = np.ones(count)
    trust[rim] = TRUST_AT_RIMS
    return trust


# The faces of a mesh as places with tangent planes.


@dataclass(frozen=True, eq=False)
class FaceSites(TangentPlanes):
    """Places in faces, one in each, with the planes of the faces: where fields are asked for directions of faces.

    centres: (f, 3) in world coordinates; facing: (f, 3) unit normals; bent: how the mesh bends: fields that go by
    curvatures need it; faces: (f,) in which of its faces each place is.
    """

    centres: Floats
    facing: Floats
    bent: BentFaces | None = None
    faces: Ints | None = None

    @property
    def points(self) -> Floats:
        """(f,3) in world coordinates."""
        return self.centres

    @property
    def normals(self) -> Floats:
        """(f,3) unit outer normals."""
        return self.facing


def face_sites(mesh: Mesh, crease_angle_deg: float = USUAL_CREASE_DEG) -> FaceSites:
    """The barycentres of the faces of a mesh, with their planes, and how the mesh bends.

    Parameters
    ----------
    mesh : Mesh
        With f faces.
    crease_angle_deg : float
        At edges where faces turn by more, 0 to 180 degrees, the mesh is not smooth.

    Returns
    -------
    FaceSites
        f of them.

    Raises
    ------
    InputError
        For an angle that is not within 0 and 180.

    Examples
    --------
    >>> from vectorplot import features, geometry
    >>> features.face_sites(geometry.box((2, 2, 2))).normals[4:].tolist()
    [[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]
    """
    bent = BentFaces(mesh, crease_angle_deg)
    return FaceSites(face_barycentres(mesh), unit(mesh.face_normals), bent, np.arange(mesh.face_count))
